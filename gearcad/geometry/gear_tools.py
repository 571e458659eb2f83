"""Tools that cut the teeth of a gear: rack or hob, shaper cutter, and one that cuts before the flanks are finished.

A tooth that is thinned comes from a thicker tooth of the tool. Angles are radians in here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

from gearcad.core.errors import GeometryError, at_least, at_most
from gearcad.core.records import Notice
from gearcad.geometry.cutter_flank import CutterFlank
from gearcad.geometry.fillets import FilletTool, ShaperTip, ToolTip
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.involute import inverse_involute, involute, root_between
from gearcad.geometry.premachining import WHEEL_TIP
from gearcad.geometry.root_outline import FlankInvolute, OutlineFault, RootOutline, RootTools, Wheel

_ROUNDING = 1e-14
"""Share by which the full radius is taken less, for both corners to fit."""


def shaped(gear: GearData) -> bool:
    """Return whether the fillets are those of a cutter's corner, not of a rack: on rings,
    and where a shaper cutter is named.
    """
    return gear.internal or gear.root_cutter.teeth is not None


def fillet_tool(gear: GearData) -> FilletTool:
    """Return the rounded tip of what cuts the fillets, once the tool is known to be feasible."""
    if shaped(gear):
        return shaper_tip(gear, corner_radius(gear))
    if gear.premachining.present:
        return precut_tip(gear)
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


def tool_pressure_angle(gear: GearData) -> float:
    """Return the normal pressure angle (degrees) of the tool: the gear's, or a smaller one of a hob with a short lead.

    m_0 cos alpha_n0 = m_n cos alpha_n. Raises GeometryError for a tool that does not cut this pitch.
    """
    pre, own = gear.premachining, gear.rack.pressure_angle
    pitch = gear.normal_module * math.cos(math.radians(own))
    if pre.tool_pressure_angle is None:
        if pre.tool_module is None:
            return own
        if not pitch < pre.tool_module <= gear.normal_module:
            permitted = f"must be above {at_least(pitch)} and at most {gear.normal_module:g} mm: m_0 cos α_n0 = m_n cos α_n"
            raise GeometryError("premachining.tool_module", pre.tool_module, permitted, "mm")
        return math.degrees(math.acos(pitch / pre.tool_module))
    if pre.tool_pressure_angle > own:
        permitted = f"must be at most {own:g} deg, the gear's: a hob with a short lead has less"
        raise GeometryError("premachining.tool_pressure_angle", pre.tool_pressure_angle, permitted, "deg")
    module = pitch / math.cos(math.radians(pre.tool_pressure_angle))
    if pre.tool_module is not None and not math.isclose(pre.tool_module, module, rel_tol=1e-6):
        permitted = f"must be {module:.8g} mm, or be left out: m_0 cos α_n0 = m_n cos α_n"
        raise GeometryError("premachining.tool_module", pre.tool_module, permitted, "mm")
    return pre.tool_pressure_angle


def precut_tip(gear: GearData) -> ToolTip:
    """Return the tip of the hob that cuts before finishing, set to these teeth.

    It rolls on the circle r_0 = r_b/cos alpha_t0, that of the gear's reference unless the hob has a short lead.
    u_c = e_0/2 - (e - rho) tan a_0 - (q - p_r + rho)/cos a_0 with the normal space width e_0 of the finished teeth there.
    """
    pre, m = gear.premachining, gear.normal_module
    own, degrees = gear.rack.pressure_angle, tool_pressure_angle(gear)
    angle, radius = math.radians(degrees), gear.root_radius * m
    helix, rolling = math.radians(gear.helix_angle), gear.reference_diameter / 2
    space = (math.pi * m - gear.normal_tooth_thickness) / 2
    if degrees != own:
        helix = math.asin(math.sin(math.radians(gear.base_helix_angle)) / math.cos(angle))
        transverse = math.atan(math.tan(angle) / math.cos(helix))
        rolling = gear.base_diameter / 2 / math.cos(transverse)
        half = math.radians(gear.base_half_angle) - (math.tan(transverse) - transverse)
        space = rolling * math.cos(helix) * (math.pi / gear.teeth - half)
    depth = rolling - gear.root_diameter / 2
    residual = pre.protuberance - gear.stock
    u = space - (depth - radius) * math.tan(angle) - (radius - residual) / math.cos(angle)
    return ToolTip(
        radius=radius,
        u=u,
        v=radius - depth,
        pressure_angle=angle,
        helix_angle=helix,
        reference_radius=rolling,
        protuberance=pre.protuberance,
        protuberance_angle=None if pre.protuberance_angle is None else math.radians(pre.protuberance_angle),
    )


def chamfering_ramp(gear: GearData) -> FlankInvolute | None:
    """Return the involute that the ramp of a semi-topping tool cuts at the tips; None without one.

    The ramp begins on the flank of the tool at a height over its reference line, which is x m_n outside the reference circle.
    """
    ramp, tool = gear.premachining.semi_topping, fillet_tool(gear) if gear.premachining.present else None
    if ramp.angle is None or ramp.height is None or not isinstance(tool, ToolTip):
        return None
    slope, cosine, r = math.tan(math.radians(ramp.angle)), math.cos(tool.helix_angle), tool.reference_radius
    start = gear.reference_diameter / 2 + gear.profile_shift * gear.normal_module + ramp.height - r
    u = tool.flank_at(start) - start * slope
    transverse = math.atan(slope / cosine)
    half = math.pi / gear.teeth - u / (cosine * r) + math.tan(transverse) - transverse
    return FlankInvolute(r * math.cos(transverse), half)


def wheel_tip_radius(gear: GearData) -> float:
    """Return the radius (mm) of the tip of the finishing wheel: as given, or a fifth of the normal module."""
    given = gear.finishing.wheel_tip_radius
    return WHEEL_TIP * gear.normal_module if given is None else given


def _check_end(gear: GearData, end: float) -> None:
    """Raise GeometryError unless a finished flank can end at a diameter (mm), between base circle and tip."""
    inner, outer = sorted((abs(gear.base_diameter), abs(gear.tip_diameter)))
    if gear.internal:
        inner, outer = abs(gear.tip_diameter), abs(gear.root_diameter)
    if end * gear.teeth <= 0 or not inner < abs(end) < outer:
        side = -1 if gear.internal else 1
        low, high = sorted((side * inner, side * outer))
        circles = "root and tip" if gear.internal else "base and tip"
        permitted = f"must be above {at_least(low)} and below {at_most(high)} mm, between the {circles} circle"
        raise GeometryError("finishing.end_diameter", end, permitted, "mm")


def finishing_wheel(gear: GearData) -> Wheel | None:
    """Return the wheel that finishes the flanks; None where it runs free of the root."""
    finishing = gear.finishing
    if finishing.end_diameter is None:
        return None
    _check_end(gear, finishing.end_diameter)
    end, radius = abs(finishing.end_diameter) / 2, wheel_tip_radius(gear)
    if finishing.kind == "form" or gear.internal:
        return Wheel(end, radius)
    angle, base = math.radians(gear.rack.pressure_angle), gear.base_diameter / 2
    r, sine = gear.reference_diameter / 2, math.sin(math.radians(gear.transverse_pressure_angle))
    flank_depth = (r * sine - math.sqrt((end - base) * (end + base))) * sine
    depth = flank_depth + radius * (1 - math.sin(angle))
    space = (math.pi * gear.normal_module - gear.normal_tooth_thickness) / 2
    u = space - (depth - radius) * math.tan(angle) - radius / math.cos(angle)
    if u < 0:
        most = radius + u * math.cos(angle) / (1 - math.sin(angle))
        permitted = f"must be at most {at_most(max(most, 0.0))} mm, the full radius between the flanks there"
        raise GeometryError("finishing.wheel_tip_radius", radius, permitted, "mm")
    rolling = ToolTip(
        radius=radius,
        u=u,
        v=radius - depth,
        pressure_angle=angle,
        helix_angle=math.radians(gear.helix_angle),
        reference_radius=r,
    )
    return Wheel(end, radius, rolling)


def finished_flank(gear: GearData) -> FlankInvolute:
    """Return the involute of the finished flanks."""
    half = math.radians(-gear.base_half_angle if gear.internal else gear.base_half_angle)
    return FlankInvolute(abs(gear.base_diameter) / 2, half, gear.internal)


def root_outline(gear: GearData) -> RootOutline | None:
    """Return the root of teeth that are cut before they are finished; None where one tool makes all.

    Raises GeometryError where the two tools leave no such root.
    """
    pre = gear.premachining
    if not pre.present:
        return None
    after = finished_flank(gear)
    tool, straight = fillet_tool(gear), None
    if isinstance(tool, ShaperTip) and pre.protuberance:
        outside = pre.protuberance / (tool.base_radius * math.cos(math.radians(gear.base_helix_angle)))
        straight = CutterFlank(tool, outside)
    tools = RootTools(tool, math.pi / gear.tooth_count, gear.internal, straight)
    before = after._replace(base_half_angle=after.base_half_angle + gear.stock_angle)
    bulges = pre.protuberance - gear.stock, pre.protuberance
    try:
        return tools.finished(before, after, bulges, finishing_wheel(gear))
    except OutlineFault as fault:
        raise _no_outline(gear, fault.what) from None


def _no_outline(gear: GearData, what: str) -> GeometryError:
    """Return the error for a root that the tools do not leave."""
    pre, end = gear.premachining, gear.finishing.end_diameter
    if what == "protuberance_angle":
        permitted = "must be less: the flank of the protuberance does not come out of the flank above the base circle"
        return GeometryError("premachining.protuberance_angle", pre.protuberance_angle, permitted, "deg")
    if what == "protuberance":
        permitted = "must be less, or cutter_teeth fewer: the corner of the cutter still cuts the flank behind the pitch point"
        return GeometryError("premachining.protuberance", pre.protuberance, permitted, "mm")
    if what == "end_diameter":
        left = gear.stock - pre.protuberance
        permitted = f"must be given: the tool leaves {left:.6g} mm of stock at the root, and the wheel must end above it"
        return GeometryError("finishing.end_diameter", end, permitted, "mm")
    radius, across = wheel_tip_radius(gear), 1 - math.sin(math.radians(gear.rack.pressure_angle))
    if radius * across <= (left := gear.stock - pre.protuberance):
        permitted = f"must be above {at_least(left / across)} mm: the rounding of the wheel ends in the stock that is left"
        return GeometryError("finishing.wheel_tip_radius", radius, permitted, "mm")
    permitted = "must be nearer to the tip: the rounding of the wheel reaches into the root that is cut before"
    return GeometryError("finishing.end_diameter", end, permitted, "mm")


def generating_involute(gear: GearData, teeth: int) -> float:
    """inv alpha_w0 = inv alpha_t + 2 tan alpha_n (x + x_0)/(z + z_0); not above 0 where a cutter of z_0 teeth cannot work."""
    shift = 2 * math.tan(math.radians(gear.rack.pressure_angle)) * (gear.profile_shift + gear.root_cutter.profile_shift)
    return involute(gear.transverse_pressure_angle) + shift / (gear.teeth + teeth)


def line_of_generation(gear: GearData, teeth: int) -> float:
    """a_0 sin alpha_w0 (mm): the line of action between the base circles of the gear and a cutter of z_0 teeth."""
    working = math.radians(inverse_involute(generating_involute(gear, teeth)))
    return abs(1 + teeth / gear.teeth) * abs(gear.base_diameter) / 2 * math.tan(working)


def shaper_tip(gear: GearData, radius: float) -> ShaperTip:
    """Return the cutter's corner of a radius in normal modules, as it is set to reach the root circle.

    Without a cutter that of the ring's own counterpart, which has |z| teeth, the profile shift -x and the ring's axis.
    """
    cutter, pre = gear.root_cutter, gear.premachining
    m, teeth, own = gear.normal_module, cutter.teeth or gear.tooth_count, cutter.teeth is None
    angle, root = math.radians(gear.transverse_pressure_angle), abs(gear.root_diameter) / 2
    apart = 0.0 if own else _centre_distance(gear, teeth)
    shift = -gear.profile_shift if own else cutter.profile_shift
    thickness = m * (math.pi / 2 + 2 * shift * math.tan(math.radians(gear.rack.pressure_angle))) + gear.root_thinning
    base, half_angle = teeth * gear.transverse_module / 2 * math.cos(angle), involute(gear.transverse_pressure_angle)
    if pre.present:
        half_angle += (pre.protuberance - gear.stock) / (base * math.cos(math.radians(gear.base_helix_angle)))
    return ShaperTip(
        radius=radius * m,
        base_radius=base,
        base_half_angle=thickness / (m * teeth) + half_angle,
        helix_angle=math.radians(gear.helix_angle),
        centre_distance=apart,
        root_radius=root,
        teeth=gear.tooth_count,
        cutter_teeth=teeth,
        internal=gear.internal,
        protuberance_angle=None if pre.protuberance_angle is None else math.radians(pre.protuberance_angle),
    )


def _centre_distance(gear: GearData, teeth: int) -> float:
    """a_0 = |z + z_0| m_t cos alpha_t/(2 cos alpha_w0), a magnitude (mm)."""
    working = math.radians(inverse_involute(generating_involute(gear, teeth)))
    angle = math.radians(gear.transverse_pressure_angle)
    return abs(gear.teeth + teeth) * gear.transverse_module / 2 * math.cos(angle) / math.cos(working)


@lru_cache(maxsize=4)
def full_corner_radius(gear: GearData) -> float:
    """Return the largest radius of the corner (in normal modules), where both corners of the cutter's tip meet: psi_M = 0.

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
    """Return the radius of the corner in normal modules: the cutter's own, else the rack's or the full one, whichever is
    smaller.
    """
    if gear.root_cutter.tip_radius is not None:
        return gear.root_cutter.tip_radius
    full = full_corner_radius(gear)
    return full if gear.rack.root_radius == "full" else min(float(gear.rack.root_radius), full)


def corner_notices(gear: GearData) -> Iterator[Notice]:
    """Yield a notice if the radius of the cutter's corner was assumed: no cutter is given, or the full radius replaces the
    rack's.
    """
    if not shaped(gear):
        return
    radius, rack = corner_radius(gear), gear.rack.root_radius
    full = gear.root_cutter.tip_radius is None and rack != "full" and radius < float(rack)
    instead = f", the full radius: the rack's {rack:g} does not fit" if full else ""
    size = f"{radius:.4g} m_n ({radius * gear.normal_module:.4g} mm){instead}"
    if gear.root_cutter.teeth is None:
        yield Notice("form-root", f"form root: no cutter given; the radius of the fillet is {size}")
    elif full:
        yield Notice("full-radius", f"cutter: the radius of its tip corner is {size}")
