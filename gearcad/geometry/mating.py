"""Can these two gears mesh? What both must share, the centre distance, and teeth that fit into each other.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

from gearcad.errors import GeometryError, ParameterError, format_number, require_name
from gearcad.geometry.gear import Gear
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.pair_data import PairData
from gearcad.geometry.path import farthest_centre_distance
from gearcad.geometry.shift import shift_sum_limit
from gearcad.schema import require_fields

__all__ = ["check_centre_distance", "check_inputs", "check_mates", "check_shift_sum", "check_teeth"]

ROUNDING_OVERLAP = 1e-4
"""Overlap at the working circle, in normal modules, that comes from shifts printed to four digits: reported, not refused."""

_SAME = 1e-9


def check_inputs(pair: PairData) -> None:
    """The inputs, each by itself."""
    for role, gear in pair.gears.items():
        if not isinstance(gear, Gear):
            raise ParameterError(role.value, gear, "must be a Gear")
    require_fields(pair)
    require_name("name", pair.name)


def check_mates(pair: PairData) -> None:
    """Module, pressure angle and helix angle belong together, and the gears face each other."""
    pinion, wheel = pair.gears
    for name, unit, one, other in (
        ("normal_module", "mm", pinion.normal_module, wheel.normal_module),
        ("rack.pressure_angle", "deg", pinion.rack.pressure_angle, wheel.rack.pressure_angle),
    ):
        if abs(one - other) > _SAME:
            raise GeometryError(f"wheel.{name}", other, f"must be {format_number(one)} {unit}, as on the pinion", unit)
    if abs(pinion.helix_angle + wheel.helix_angle) > _SAME:
        permitted = f"must be {format_number(-pinion.helix_angle)} deg, opposite to the pinion"
        raise GeometryError("wheel.helix_angle", wheel.helix_angle, permitted, "deg")
    if pair.common_width.width <= 0:
        most = at_most((pinion.face_width + wheel.face_width) / 2)
        permitted = f"must be between -{most} and {most} mm, for the gears to face each other"
        raise GeometryError("axial_offset", pair.axial_offset, permitted, "mm")


def check_shift_sum(pair: PairData) -> None:
    """Some centre distance must mesh without backlash, where none is given."""
    pinion, wheel = pair.gears
    least = shift_sum_limit(
        teeth=pair.gears.map(lambda gear: gear.teeth),
        helix_angle=pinion.helix_angle,
        pressure_angle=pinion.rack.pressure_angle,
    )
    if pair.profile_shift_sum <= least:
        permitted = f"must be above {at_least(least - pinion.profile_shift)}: no centre distance meshes without backlash"
        raise GeometryError("wheel.profile_shift", wheel.profile_shift, permitted)


def check_centre_distance(pair: PairData) -> None:
    """Beyond that of the base circles."""
    least = (pair.pinion.base_diameter + pair.wheel.base_diameter) / 2
    if pair.centre_distance <= least:
        permitted = f"must be above {at_least(least)} mm, where the base circles touch"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def check_teeth(pair: PairData) -> None:
    """Flanks do not overlap, tips stay off roots, and some path of contact is left between the tip form circles."""
    _check_backlash(pair)
    for role, clearance in pair.tip_clearances.items():
        if clearance <= 0:
            tip = pair.gears.pick(role).tip_diameter
            permitted = f"must be below {tip + 2 * clearance:.6f} mm: the tip reaches the {role.mate.value}'s root circle"
            raise GeometryError(f"{role.value}.tip_diameter", tip, permitted, "mm")
    farthest = farthest_centre_distance(
        pair.gears.map(lambda gear: gear.base_diameter), pair.gears.map(lambda gear: gear.tip_form_diameter)
    )
    if pair.centre_distance >= farthest:
        permitted = f"must be below {at_most(farthest)} mm, where the tips reach each other's flanks"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def _check_backlash(pair: PairData) -> None:
    backlash = pair.circumferential_backlash
    if backlash >= -ROUNDING_OVERLAP * pair.pinion.normal_module:
        return
    least = at_least(pair.centre_distance_for(pair.profile_shift_sum - pair.thinning_as_shift), digits=9)
    permitted = (
        f"must be at least {least} mm for these profile shifts and thinning, or the"
        f" shift sum at most {pair.fitting_shift_sum:.6f}: the backlash would be {backlash:.6f} mm"
    )
    raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")
