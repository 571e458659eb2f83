"""Can this pinion and this rack mesh? What both must share, the mounting distance, and teeth that fit into each other.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math

from gearcad.errors import GeometryError, ParameterError, format_number, require_name
from gearcad.geometry.gear import Gear
from gearcad.geometry.involute import tangent_length
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.mating import ROUNDING_OVERLAP, SAME
from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_pair_data import RackPairData
from gearcad.schema import require_fields

__all__ = ["check_rack_inputs", "check_rack_mates", "check_rack_mesh"]


def check_rack_inputs(pair: RackPairData) -> None:
    """The inputs, each by itself."""
    if not isinstance(pair.pinion, Gear):
        raise ParameterError("pinion", pair.pinion, "must be a Gear")
    if not isinstance(pair.rack, Rack):
        raise ParameterError("rack", pair.rack, "must be a Rack")
    require_fields(pair)
    require_name("name", pair.name)


def check_rack_mates(pair: RackPairData) -> None:
    """An external pinion; module, pressure angle and helix angle belong together."""
    pinion, rack = pair.pinion, pair.rack
    if pinion.internal:
        raise GeometryError("pinion.teeth", pinion.teeth, "must be above 0: no rack meshes with a ring")
    if pinion.double_helix.present:
        permitted = "must be left out: a rack has one helix"
        raise GeometryError("pinion.double_helix.gap_width", pinion.double_helix.gap_width, permitted, "mm")
    for name, unit, one, other in (
        ("normal_module", "mm", pinion.normal_module, rack.normal_module),
        ("rack.pressure_angle", "deg", pinion.rack.pressure_angle, rack.rack.pressure_angle),
    ):
        if abs(one - other) > SAME:
            raise GeometryError(f"rack.{name}", other, f"must be {format_number(one)} {unit}, as on the pinion", unit)
    if abs(rack.helix_angle + pinion.helix_angle) > SAME:
        permitted = f"must be {format_number(-pinion.helix_angle)} deg, opposite to the pinion"
        raise GeometryError("rack.helix_angle", rack.helix_angle, permitted, "deg")


def check_rack_mesh(pair: RackPairData) -> None:
    """Flanks do not overlap, tips stay off roots, and some path of contact is left between the tips."""
    backlash, m = pair.circumferential_backlash, pair.pinion.normal_module
    if backlash < -ROUNDING_OVERLAP * m:
        least = at_least(pair.zero_backlash_distance, digits=9)
        shift = at_most(pair.pinion.profile_shift + (pair.mounting_distance - pair.zero_backlash_distance) / m)
        permitted = (
            f"must be at least {least} mm, or pinion.profile_shift at most {shift}: the backlash would be {backlash:.6f} mm"
        )
        raise GeometryError("mounting_distance", pair.mounting_distance, permitted, "mm")
    clearances = pair.tip_clearances
    if clearances.pinion <= 0:
        tip = pair.pinion.tip_diameter
        permitted = f"must be below {at_most(tip + 2 * clearances.pinion)} mm: the tip reaches the rack's root"
        raise GeometryError("pinion.tip_diameter", tip, permitted, "mm")
    if clearances.rack <= 0:
        most = at_most(pair.rack.tip_alteration + clearances.rack / m)
        permitted = f"must be below {most}: the tip reaches the pinion's root circle"
        raise GeometryError("rack.tip_alteration", pair.rack.tip_alteration, permitted)
    if pair.mounting_distance >= (farthest := _farthest(pair)):
        permitted = f"must be below {at_most(farthest)} mm, where the tips reach each other's flanks"
        raise GeometryError("mounting_distance", pair.mounting_distance, permitted, "mm")


def _farthest(pair: RackPairData) -> float:
    """The mounting distance at which the path of contact vanishes: the rack's tip form line through the path's last point."""
    pinion, sine = pair.pinion, math.sin(math.radians(pair.pinion.transverse_pressure_angle))
    last = tangent_length(pinion.tip_form_diameter, pinion.base_diameter)
    return pair.pitch_radius * (1 - sine**2) + last * sine + pair.rack.tip_form_height
