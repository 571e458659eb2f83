"""Which tool cuts the teeth of a gear: the counterpart of its rack, a shaper cutter, or nothing but a fillet of its own.

A tooth that is thinned comes from a thicker tooth of the tool. Angles are radians in here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

from gearcad.geometry.bracketed import root_between
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.shaper import ShaperTip
from gearcad.geometry.trochoid import FilletTool, ToolTip
from gearcad.notice import Notice

__all__ = [
    "corner_notices",
    "corner_radius",
    "fillet_tool",
    "full_corner_radius",
    "generating_involute",
    "line_of_generation",
    "shaped",
    "shaper_tip",
]

_ROUNDING = 1e-14
"""Share by which the full radius is taken less, for both corners to fit."""


def shaped(gear: GearData) -> bool:
    """Whether its fillets are those of a cutter's corner, not of a rack: on rings, and where a shaper cutter is named."""
    return gear.internal or gear.cutter.teeth is not None


def fillet_tool(gear: GearData) -> FilletTool:
    """The rounded tip of what cuts the fillets, once the tool is known to be feasible."""
    if shaped(gear):
        return shaper_tip(gear, corner_radius(gear))
    m, shift = gear.normal_module, gear.profile_shift * gear.normal_module
    return ToolTip.cutting(
        normal_module=m,
        pressure_angle=math.radians(gear.rack.pressure_angle),
        helix_angle=math.radians(gear.helix_angle),
        reference_radius=gear.reference_diameter / 2,
        depth=gear.dedendum * m - shift,
        shift=shift,
        radius=gear.root_radius * m,
        thinning=gear.tooth_thinning,
    )


def generating_involute(gear: GearData, teeth: int) -> float:
    """inv alpha_w0 = inv alpha_t + 2 tan alpha_n (x + x_0)/(z + z_0); not above 0 where a cutter of z_0 teeth cannot work."""
    shift = 2 * math.tan(math.radians(gear.rack.pressure_angle)) * (gear.profile_shift + gear.cutter.profile_shift)
    return involute(gear.transverse_pressure_angle) + shift / (gear.teeth + teeth)


def line_of_generation(gear: GearData, teeth: int) -> float:
    """a_0 sin alpha_w0 (mm): the line of action between the base circles of the gear and a cutter of z_0 teeth."""
    working = math.radians(inverse_involute(generating_involute(gear, teeth)))
    return abs(1 + teeth / gear.teeth) * abs(gear.base_diameter) / 2 * math.tan(working)


def shaper_tip(gear: GearData, radius: float) -> ShaperTip:
    """The cutter's corner of a radius in normal modules, as it is set to reach the root circle.

    Without a cutter that of the ring's own counterpart, which has |z| teeth, the profile shift -x and the ring's axis.
    """
    m, teeth, own = gear.normal_module, gear.cutter.teeth or gear.tooth_count, gear.cutter.teeth is None
    angle, root = math.radians(gear.transverse_pressure_angle), abs(gear.root_diameter) / 2
    apart = 0.0 if own else _centre_distance(gear, teeth)
    shift = -gear.profile_shift if own else gear.cutter.profile_shift
    thickness = m * (math.pi / 2 + 2 * shift * math.tan(math.radians(gear.rack.pressure_angle))) + gear.tooth_thinning
    return ShaperTip(
        radius=radius * m,
        base_radius=teeth * gear.transverse_module / 2 * math.cos(angle),
        base_half_angle=thickness / (m * teeth) + involute(gear.transverse_pressure_angle),
        helix_angle=math.radians(gear.helix_angle),
        centre_distance=apart,
        root_radius=root,
        teeth=gear.tooth_count,
        cutter_teeth=teeth,
        internal=gear.internal,
    )


def _centre_distance(gear: GearData, teeth: int) -> float:
    """a_0 = |z + z_0| m_t cos alpha_t/(2 cos alpha_w0), a magnitude (mm)."""
    working = math.radians(inverse_involute(generating_involute(gear, teeth)))
    angle = math.radians(gear.transverse_pressure_angle)
    return abs(gear.teeth + teeth) * gear.transverse_module / 2 * math.cos(angle) / math.cos(working)


@lru_cache(maxsize=4)
def full_corner_radius(gear: GearData) -> float:
    """Largest radius of the corner (in normal modules), where both corners of the cutter's tip meet: psi_M = 0.

    Negative where even a sharp cutter's flanks meet before its tip circle, or that lies inside its base circle.
    """
    sharp, m = shaper_tip(gear, 0.0), gear.normal_module
    most = (sharp.tip_radius - sharp.base_radius) / m * (1 - _ROUNDING)
    if most < 0 or sharp.middle_angle < 0:
        return -1.0

    def room(radius: float) -> float:
        return shaper_tip(gear, radius).middle_angle

    if room(most) >= 0:  # the corner then reaches down to the cutter's base circle
        return most

    return root_between(room, 0.0, most, xtol=1e-15, rtol=8.9e-16) * (1 - _ROUNDING)


def corner_radius(gear: GearData) -> float:
    """Radius of the corner in normal modules: the cutter's own, else the rack's or the full one, whichever is smaller."""
    if gear.cutter.tip_radius is not None:
        return gear.cutter.tip_radius
    full = full_corner_radius(gear)
    return full if gear.rack.root_radius == "full" else min(float(gear.rack.root_radius), full)


def corner_notices(gear: GearData) -> Iterator[Notice]:
    """What was taken for a corner that was not given: no cutter at all, and the full radius instead of the rack's."""
    if not shaped(gear):
        return
    radius, rack = corner_radius(gear), gear.rack.root_radius
    full = gear.cutter.tip_radius is None and rack != "full" and radius < float(rack)
    instead = f", the full radius: the rack's {rack:g} does not fit" if full else ""
    size = f"{radius:.4g} m_n ({radius * gear.normal_module:.4g} mm){instead}"
    if gear.cutter.teeth is None:
        yield Notice("form-root", f"form root: no cutter given; the radius of the fillet is {size}")
    elif full:
        yield Notice("full-radius", f"cutter: the radius of its tip corner is {size}")
