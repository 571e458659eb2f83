"""Can these two gears mesh? What both must share, the centre distance, and teeth that fit into each other.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math

from gearcad.errors import GeometryError, ParameterError, format_number, require_name
from gearcad.geometry.centre_distance_tolerance import LARGEST_DISTANCE, require_class
from gearcad.geometry.derived import is_given
from gearcad.geometry.gear import Gear
from gearcad.geometry.internal_mating import check_interference, ring_tip_limit
from gearcad.geometry.involute import tangent_length
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.pair_data import PairData
from gearcad.geometry.path import farthest_centre_distance
from gearcad.geometry.shift import shift_sum_limit
from gearcad.per_gear import PerGear, Role
from gearcad.schema import require_fields

__all__ = [
    "check_centre_distance",
    "check_inputs",
    "check_mates",
    "check_ring",
    "check_shift_sum",
    "check_teeth",
    "check_tolerance",
    "wrong_side",
]

ROUNDING_OVERLAP = 1e-4
"""Overlap at the working circle, in normal modules, that comes from shifts printed to four digits: reported, not refused."""

SAME = 1e-9


def check_inputs(pair: PairData) -> None:
    """The inputs, each by itself."""
    for role, gear in pair.gears.items():
        if not isinstance(gear, Gear):
            raise ParameterError(role.value, gear, "must be a Gear")
    require_fields(pair)
    if is_given(distance := pair.centre_distance) and distance * (pair.pinion.teeth + pair.wheel.teeth) <= 0:
        raise wrong_side(distance, ring=pair.internal)
    if pair.centre_distance_tolerance is not None:
        require_class(pair.centre_distance_tolerance)
    require_name("name", pair.name)


def wrong_side(distance: float, *, ring: bool) -> ParameterError:
    """The error for a centre distance (mm) of the wrong sign, or 0."""
    if not ring:
        return ParameterError("centre_distance", distance, "must be a number above 0 mm", "mm")
    write = f": write {format_number(-distance)}" if distance > 0 else ""
    return ParameterError("centre_distance", distance, f"must be a number below 0 mm with a ring (ISO 21771){write}", "mm")


def check_ring(teeth: PerGear[int]) -> None:
    """If one of the gears is a ring, it is the wheel, and the pinion fits inside."""
    pinion, wheel = teeth
    if pinion < 0:
        raise GeometryError("pinion.teeth", pinion, "must be above 0: of an internal pair the ring is the wheel")
    if wheel < 0 and -wheel <= pinion:
        raise GeometryError("wheel.teeth", wheel, f"must be far below {-pinion}: the pinion stands inside the ring")


def check_mates(pair: PairData) -> None:
    """Module, pressure angle and helix angle belong together, and the gears face each other."""
    pinion, wheel = pair.gears
    check_ring(pair.gears.map(lambda gear: gear.teeth))
    for name, unit, one, other in (
        ("normal_module", "mm", pinion.normal_module, wheel.normal_module),
        ("rack.pressure_angle", "deg", pinion.rack.pressure_angle, wheel.rack.pressure_angle),
    ):
        if abs(one - other) > SAME:
            raise GeometryError(f"wheel.{name}", other, f"must be {format_number(one)} {unit}, as on the pinion", unit)
    _check_halves(pair)
    hand, words = (1, "as on the pinion of an internal pair") if wheel.internal else (-1, "opposite to the pinion")
    if abs(wheel.helix_angle - hand * pinion.helix_angle) > SAME:
        permitted = f"must be {format_number(hand * pinion.helix_angle)} deg, {words}"
        raise GeometryError("wheel.helix_angle", wheel.helix_angle, permitted, "deg")
    if pair.common_width.width <= 0:
        most = at_most((pinion.face_width + wheel.face_width) / 2)
        permitted = f"must be between -{most} and {most} mm, for the gears to face each other"
        raise GeometryError("axial_offset", pair.axial_offset, permitted, "mm")


def _check_halves(pair: PairData) -> None:
    """Both gears have two halves or none, whose teeth are offset alike and face each other in pairs."""
    pinion, wheel = pair.gears.map(lambda gear: gear.double_helix)
    if pinion.present != wheel.present:
        permitted = "must be given for both gears of a double helical pair, or for neither"
        raise GeometryError("wheel.double_helix.gap_width", wheel.gap_width, permitted, "mm")
    if not pinion.present:
        return
    wanted = pinion.offset if pair.internal else -pinion.offset
    if abs((wheel.offset - wanted + 0.5) % 1 - 0.5) > SAME:
        permitted = f"must be {format_number(wanted)}, for both halves to mesh"
        raise GeometryError("wheel.double_helix.offset", wheel.offset, permitted)
    if pair.axial_offset:
        permitted = "must be 0 mm: double helical gears centre each other"
        raise GeometryError("axial_offset", pair.axial_offset, permitted, "mm")
    if pair.common_width.width <= 0:
        most = min(gear.face_width for gear in pair.gears)
        permitted = f"must be below {at_most(most)} mm, for the halves to face each other"
        role = max(pair.gears.items(), key=lambda item: item[1].double_helix.gap_width or 0.0)[0]
        raise GeometryError(
            f"{role.value}.double_helix.gap_width", pair.gears.pick(role).double_helix.gap_width, permitted, "mm"
        )


def check_shift_sum(pair: PairData) -> None:
    """Some centre distance must mesh without backlash, where none is given."""
    pinion, wheel = pair.gears
    limit = shift_sum_limit(
        teeth=pair.gears.map(lambda gear: gear.teeth),
        helix_angle=pinion.helix_angle,
        pressure_angle=pinion.rack.pressure_angle,
    )
    if (pair.profile_shift_sum - limit) * (-1 if pair.internal else 1) <= 0:
        most = limit - pinion.profile_shift
        side = f"below {at_most(most)}" if pair.internal else f"above {at_least(most)}"
        permitted = f"must be {side}: no centre distance meshes without backlash"
        raise GeometryError("wheel.profile_shift", wheel.profile_shift, permitted)


def check_centre_distance(pair: PairData) -> None:
    """Beyond that of the base circles."""
    least = (pair.pinion.base_diameter + pair.wheel.base_diameter) / 2
    if pair.internal:
        if pair.centre_distance >= least:
            permitted = f"must be below {at_most(min(least, _nearest_to_ring(pair)))} mm, where the base circles touch"
            raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")
        return
    if pair.centre_distance <= least:
        permitted = f"must be above {at_least(least)} mm, where the base circles touch"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def check_tolerance(pair: PairData) -> None:
    """That of the centre distance keeps the axes off where base circles touch."""
    if (name := pair.centre_distance_tolerance) is None:
        return
    if abs(pair.centre_distance) > LARGEST_DISTANCE:
        permitted = f"must be left out: ISO 286 has no tolerances above {LARGEST_DISTANCE:g} mm"
        raise GeometryError("centre_distance_tolerance", name, permitted)
    touching = abs(pair.pinion.base_diameter + pair.wheel.base_diameter) / 2
    if abs(pair.centre_distance) - pair.centre_distance_allowance / 1000 <= touching:
        permitted = f"must be finer: the axes could come within {at_most(touching)} mm, where the base circles touch"
        raise GeometryError("centre_distance_tolerance", name, permitted)


def check_teeth(pair: PairData) -> None:
    """Flanks do not overlap, tips stay off roots and off each other, and some path of contact is left between them."""
    _check_backlash(pair)
    for role, clearance in pair.tip_clearances.items():
        if clearance <= 0:
            tip = pair.gears.pick(role).tip_diameter
            limit = f"below {tip + 2 * clearance:.6f}"
            if pair.internal and role is Role.WHEEL:
                limit = ring_tip_limit(pair) or limit
            permitted = f"must be {limit} mm: the tip reaches the {role.mate.value}'s root circle"
            raise GeometryError(f"{role.value}.tip_diameter", tip, permitted, "mm")
    if pair.internal:
        _check_path(pair)
        check_interference(pair)
        return
    farthest = farthest_centre_distance(
        pair.gears.map(lambda gear: gear.base_diameter), pair.gears.map(lambda gear: gear.tip_form_diameter)
    )
    if pair.centre_distance >= farthest:
        permitted = f"must be below {at_most(farthest)} mm, where the tips reach each other's flanks"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def _check_path(pair: PairData) -> None:
    """Some path of contact in a ring: E beyond A, T1T2 < t_a1 + t_a2."""
    if pair.centre_distance >= (nearest := _nearest_to_ring(pair)):
        permitted = f"must be below {at_most(nearest)} mm, where the tips reach each other's flanks"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def _nearest_to_ring(pair: PairData) -> float:
    """Centre distance (mm, negative) in a ring at which the path of contact vanishes; infinite where it never does."""
    reach = sum(tangent_length(gear.tip_form_diameter, gear.base_diameter) for gear in pair.gears)
    bases = sum(gear.base_diameter for gear in pair.gears) / 2
    return -math.hypot(bases, reach) if reach < 0 else math.inf


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
