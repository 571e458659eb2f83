"""What cuts the fillets of the virtual spur gear: the gear's own tool, in its normal section."""

from __future__ import annotations

import math
from dataclasses import replace

from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.shaper import ShaperTip
from gearcad.geometry.trochoid import FilletTool, ToolTip
from gearcad.rating.virtual import VirtualGear

__all__ = ["virtual_tool"]


def virtual_tool(gear: Gear, virtual: VirtualGear) -> FilletTool:
    """The tip of the tool, set to cut the virtual gear; of a spur gear its very own.

    A hob stays what it is; a shaper cutter becomes its own virtual spur gear, with z_0 z_n/z teeth, the same shift and corner.
    Raises GeometryError where that cannot reach the virtual gear's root.
    """
    tool = gear.profile.tool
    if not gear.helix_angle:
        return tool
    if isinstance(tool, ToolTip):
        return replace(tool, helix_angle=0.0, reference_radius=virtual.reference_diameter / 2)
    return _virtual_shaper(gear, virtual, tool.radius) if isinstance(tool, ShaperTip) else tool


def _virtual_shaper(gear: Gear, virtual: VirtualGear, radius: float) -> ShaperTip:
    """With a corner of `radius` (mm). Without cutter the gear's own counterpart, at its axis."""
    m, angle, own = gear.normal_module, math.radians(virtual.pressure_angle), gear.cutter.teeth is None
    z_n = virtual.teeth
    z_0 = abs(z_n) if gear.cutter.teeth is None else gear.cutter.teeth * z_n / gear.teeth
    shift = -gear.profile_shift if own else gear.cutter.profile_shift
    apart = 0.0 if own else _centre_distance(gear, virtual, z_0)
    root = abs(virtual.reference_diameter + gear.root_diameter - gear.reference_diameter) / 2
    thickness = m * (math.pi / 2 + 2 * shift * math.tan(angle)) + gear.tooth_thinning
    tip = ShaperTip(
        radius=radius,
        base_radius=z_0 * m / 2 * math.cos(angle),
        base_half_angle=thickness / (m * z_0) + involute(virtual.pressure_angle),
        helix_angle=0.0,
        centre_distance=apart,
        root_radius=root,
        teeth=abs(z_n),
        cutter_teeth=z_0,
        internal=gear.internal,
    )
    if not tip.feasible:
        raise _unreachable(gear)
    return tip


def _centre_distance(gear: Gear, virtual: VirtualGear, cutter_teeth: float) -> float:
    """a_0 (mm), by inv alpha_w0 = inv alpha_n + 2 tan alpha_n (x + x_0)/(z_n + z_n0)."""
    teeth, angle = virtual.teeth + cutter_teeth, math.radians(virtual.pressure_angle)
    shift = gear.profile_shift + gear.cutter.profile_shift
    working = involute(virtual.pressure_angle) + 2 * math.tan(angle) * shift / teeth
    if working <= 0:
        raise _unreachable(gear)
    apart = abs(teeth) * gear.normal_module / 2
    return apart * math.cos(angle) / math.cos(math.radians(inverse_involute(working)))


def _unreachable(gear: Gear) -> GeometryError:
    permitted = "must be others for a rating: in the normal section the cutter does not reach the root of the virtual gear"
    return GeometryError("cutter.teeth", gear.cutter.teeth, permitted)
