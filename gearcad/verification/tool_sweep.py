"""Brute-force sweep of the tool that cuts a gear: hob, shaper cutter, or the counterpart of a ring.

The tool, from its definition, rolls past every point of an outline in many small steps, and the signed distance of the point
from the tool is searched for its least value. Neither the normal of the outline nor the pitch point is used, and no involute
and no trochoid.

Lengths in mm, angles in radians. Points of a plane are complex numbers. Sections are transverse; the gear stands at the origin
with the middle of a tooth space on the real axis. Radii, numbers of teeth and centre distances are magnitudes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.quantities import is_given
from gearcad.core.records import Floats
from gearcad.geometry import Gear, Rack
from gearcad.verification.tool_teeth import (
    Complexes,
    CutterBlank,
    JoinedTeeth,
    RackTooth,
    ToolTooth,
    least_of,
    peak_of,
    rolled_half_angle,
)

_STEPS = 321
"""Steps of the roll that every point of an outline sees at first."""

_MINIMA = 3
"""Number of local minima over these steps that are refined for each point."""

_MARGIN = 0.05
"""Share of the module by which the range of the roll is wider than where the tool reaches the point."""

_BEARINGS = 301
"""Places of a cutter's flank that are tried for the tooth thickness that it leaves."""


class ToolSection(NamedTuple):
    """A section of a gear and of its tool: angles by which the helix has turned the gear, and turned or moved the tool."""

    gear: float
    tool: float


@dataclass(frozen=True, kw_only=True)
class Hob:
    """A hob or rack that rolls on the reference circle of an external gear; `tip_circle` (mm) is that of its tip."""

    tooth: ToolTooth
    reference: float
    tip_circle: float
    helix: float

    def section(self, height: float) -> ToolSection:
        """Return the section at a height (mm) over z = 0."""
        moved = height * math.tan(self.helix)
        return ToolSection(moved / self.reference, moved)

    def seen(self, points: Complexes, turn: Floats, section: ToolSection) -> Complexes:
        """Return points (n, 1) of the gear in the frame of the tool when the gear has turned by angles (n, k)."""
        placed = points * np.exp(1j * turn)
        seen: Complexes = placed.imag - self.reference * turn - section.tool + 1j * (placed.real - self.reference)
        return seen

    def reach(self, radii: Floats, margin: float) -> Floats:
        """Return the greatest angle from the line of centres at which points at radii (mm) come into the tool."""
        return np.arccos(np.clip((self.tip_circle - margin) / radii, -1.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class Shaper:
    """A shaper cutter at its gear: `share` is the gear's turn for one of the cutter, `side` is 1 in a ring and else -1."""

    tooth: ToolTooth
    centre_distance: float
    tip_radius: float
    share: float
    side: int
    twist: float

    def section(self, height: float) -> ToolSection:
        """Return the section at a height (mm): the cutter has the gear's helix, of opposite hand outside a ring."""
        return ToolSection(self.twist * height, self.twist / self.share * height)

    def seen(self, points: Complexes, turn: Floats, section: ToolSection) -> Complexes:
        """Return points (n, 1) of the gear in the frame of the cutter when the gear has turned by angles (n, k)."""
        apart = self.side * (points * np.exp(1j * turn) - self.centre_distance)
        seen: Complexes = apart * np.exp(-1j * self.side * (turn / self.share + section.tool))
        return seen

    def reach(self, radii: Floats, margin: float) -> Floats:
        """Return the greatest angle from the line of centres at which points at radii (mm) come into the cutter."""
        distance = self.centre_distance
        if not distance:
            return np.zeros_like(radii)
        cosine = (radii**2 + distance**2 - (self.tip_radius + margin) ** 2) / (2 * distance * radii)
        return np.arccos(np.clip(cosine, -1.0, 1.0))


def tool_of(gear: Gear) -> Hob | Shaper:
    """Return the tool that the inputs of a gear define, set to its gear."""
    pre = gear.premachining
    if gear.internal or gear.cutter.teeth is not None or pre.cutter_teeth is not None:
        return _shaper(gear)
    return _premachining_hob(gear) if pre.present else _hob(gear)


def finishing_rack(gear: Gear, end: float, radius: float) -> Hob:
    """Return a rack that finishes the flanks of an external gear down to a circle of radius `end` (mm), its tip rounded."""
    m, helix, angle = gear.normal_module, math.radians(gear.helix_angle), math.radians(gear.rack.pressure_angle)
    cosine, line = math.cos(helix), gear.profile_shift * gear.normal_module
    reference = gear.teeth * m / cosine / 2
    transverse = math.atan(math.tan(angle) / cosine)
    base = reference * math.cos(transverse)
    # A point of the flank touches where the line of action is as deep as it: the end of the flank touches on the circle.
    depth = (reference * math.sin(transverse) - math.sqrt(max(end**2 - base**2, 0.0))) * math.sin(transverse)
    tooth = RackTooth(
        half_thickness=math.pi * m / 4 + gear.tooth_thinning / 2,
        line=line,
        tip=-depth - radius * (1 - math.sin(angle)),
        radius=radius,
        angle=angle,
        cosine=cosine,
        pitch=math.pi * m,
    )
    return Hob(tooth=tooth, reference=reference, tip_circle=reference + tooth.tip, helix=helix)


def _premachining_hob(gear: Gear) -> Hob:
    """Return the hob that cuts before finishing: its flank, its protuberance, and its ramp, as straight lines and an arc."""
    pre, m, wide = gear.premachining, gear.normal_module, math.radians(gear.rack.pressure_angle)
    helix, angle, cosine = math.radians(gear.helix_angle), wide, math.cos(math.radians(gear.helix_angle))
    own = gear.teeth * m / cosine / 2
    reference, line = own, gear.profile_shift * m
    half = math.pi * m / 4 + gear.tooth_thinning / 2
    short = pre.tool_pressure_angle
    if short is None and pre.tool_module is not None:
        short = math.degrees(math.acos(min(m * math.cos(wide) / pre.tool_module, 1.0)))
    if short is not None:  # a short lead: the space is that on the circle on which the hob rolls
        transverse = math.atan(math.tan(wide) / cosine)
        angle = math.radians(short)
        tilt = math.sin(helix) * math.cos(wide) / math.cos(angle)
        helix, cosine = math.asin(tilt), math.sqrt(1 - tilt**2)
        reference = own * math.cos(transverse) / math.cos(math.atan(math.tan(angle) / cosine))
        thick = (m * (math.pi / 2 + 2 * gear.profile_shift * math.tan(wide)) - gear.tooth_thinning) / cosine_of(gear)
        tooth = float(rolled_half_angle(np.array([reference]), own, transverse, thick)[0])
        line = own + line - reference
        half = reference * cosine * (math.pi / gear.teeth - tooth) + line * math.tan(angle)
    stock, radius = _stock(gear), (pre.tool_tip_radius or 0.0) * m
    half -= stock / math.cos(angle)
    tip, pitch = line - _addendum(gear), math.pi * m * math.cos(wide) / math.cos(angle)

    def rack(half: float, angle: float, tip: float = tip, radius: float = radius) -> RackTooth:
        return RackTooth(half_thickness=half, line=line, tip=tip, radius=radius, angle=angle, cosine=cosine, pitch=pitch)

    teeth = [rack(half, angle)]
    if pre.protuberance_angle is not None:
        steep, height = math.radians(pre.protuberance_angle), tip + radius - line
        centre = half + height * math.tan(angle) + (pre.protuberance - radius) / math.cos(angle)
        teeth.append(rack(centre - height * math.tan(steep) + radius / math.cos(steep), steep))
    if pre.semi_topping.angle is not None and pre.semi_topping.height is not None:
        ramp = math.tan(math.radians(pre.semi_topping.angle))
        at_line = half + pre.semi_topping.height * (math.tan(angle) - ramp)
        teeth.append(rack(at_line, math.atan(ramp), tip=max(tip, line - at_line / ramp), radius=0.0))
    return Hob(tooth=JoinedTeeth(tuple(teeth)), reference=reference, tip_circle=reference + tip, helix=helix)


def counterpart_of(rack: Rack) -> ToolTooth:
    """Return the space of a rack by the inputs, its middle at 0: the basic rack, or the tools that cut and finish it."""
    m, angle, pre = rack.normal_module, math.radians(rack.rack.pressure_angle), rack.premachining
    space = math.pi * m / 4 + rack.tooth_thinning / 2

    def tooth(half: float, tip: float, radius: float, lean: float = angle) -> RackTooth:
        cosine = math.cos(math.radians(rack.helix_angle))
        return RackTooth(half_thickness=half, line=0.0, tip=tip, radius=radius, angle=lean, cosine=cosine, pitch=math.pi * m)

    if not pre.present:
        tip = -rack.rack.dedendum * m
        full = rack.rack.root_radius == "full"
        at_root = space + tip * math.tan(angle)
        return tooth(space, tip, _full_radius(at_root, angle) if full else float(rack.rack.root_radius) * m)
    tip, radius, half = -_addendum(rack), (pre.tool_tip_radius or 0.0) * m, space - _stock(rack) / math.cos(angle)
    teeth = [tooth(half, tip, radius)]
    if pre.protuberance_angle is not None:
        steep, height = math.radians(pre.protuberance_angle), tip + radius
        centre = half + height * math.tan(angle) + (pre.protuberance - radius) / math.cos(angle)
        teeth.append(tooth(centre - height * math.tan(steep) + radius / math.cos(steep), tip, radius, steep))
    if pre.semi_topping.angle is not None and pre.semi_topping.height is not None:
        ramp = math.tan(math.radians(pre.semi_topping.angle))
        at_line = half + pre.semi_topping.height * (math.tan(angle) - ramp)
        teeth.append(tooth(at_line, max(tip, -at_line / ramp), 0.0, math.atan(ramp)))
    end, wheel = rack.finishing.end_depth, rack.finishing.wheel_tip_radius or 0.2 * m
    if end is None:  # the wheel runs free: its sharp tip is where the flank begins
        end, wheel = rack.profile.form_depth, 0.0
    teeth.append(tooth(space, -end - wheel * (1 - math.sin(angle)), wheel))
    return JoinedTeeth(tuple(teeth))


def _full_radius(half: float, angle: float) -> float:
    """Radius that touches both flanks and the tip: half the width at its centre is radius/cos(angle)."""
    return half / (1 / math.cos(angle) - math.tan(angle))


def cosine_of(gear: Gear) -> float:
    """Return the cosine of the helix angle."""
    return math.cos(math.radians(gear.helix_angle))


def _stock(gear: Gear | Rack) -> float:
    """Return the stock (mm) by the inputs; that of DIN 3972 is .25 or .6 of the third root of the module, times sin 20."""
    factor = {"din3972-III": 0.25, "din3972-IV": 0.6}.get(str(gear.premachining.stock))
    if factor is not None:
        return factor * float(gear.normal_module ** (1 / 3)) * math.sin(math.radians(20))
    return float(gear.premachining.stock)


def _addendum(gear: Gear | Rack) -> float:
    """Return the addendum (mm) of the tool that makes the root, by the inputs."""
    pre, m = gear.premachining, gear.normal_module
    if not pre.present:
        return gear.rack.dedendum * m
    if pre.tool_addendum is not None:
        return pre.tool_addendum * m
    return 1.25 * m + {"din3972-III": 0.25, "din3972-IV": 0.6}[str(pre.stock)] * float(m ** (1 / 3))


def _hob(gear: Gear) -> Hob:
    """Return the counterpart of the basic rack, moved out by x m_n; a thinned tooth comes from a thicker one of the tool."""
    m, helix, angle = gear.normal_module, math.radians(gear.helix_angle), math.radians(gear.rack.pressure_angle)
    reference = gear.teeth * m / math.cos(helix) / 2
    line = gear.profile_shift * m
    tip = gear.root_diameter / 2 - reference if is_given(gear.root_diameter) else line - gear.rack.dedendum * m
    half = math.pi * m / 4 + gear.tooth_thinning / 2
    at_tip = half + (tip - line) * math.tan(angle)
    full = gear.rack.root_radius == "full"
    radius = _full_radius(at_tip, angle) if full else float(gear.rack.root_radius) * m
    tooth = RackTooth(
        half_thickness=half, line=line, tip=tip, radius=radius, angle=angle, cosine=math.cos(helix), pitch=math.pi * m
    )
    return Hob(tooth=tooth, reference=reference, tip_circle=reference + tip, helix=helix)


def _shaper(gear: Gear) -> Shaper:
    """Return the shaper cutter of a gear. A ring without one has its counterpart, whose teeth fill its spaces."""
    m, helix = gear.normal_module, math.radians(gear.helix_angle)
    tangent, cosine = math.tan(math.radians(gear.rack.pressure_angle)), math.cos(helix)
    cutter, pre = gear.root_cutter, gear.premachining
    own = cutter.teeth is None
    teeth = cutter.teeth or gear.tooth_count
    shift = -gear.profile_shift if own else cutter.profile_shift
    blank = CutterBlank(
        teeth=teeth,
        module=m,
        reference=teeth * m / cosine / 2,
        angle=math.atan(tangent / cosine),
        thickness=(m * (math.pi / 2 + 2 * shift * tangent) + gear.tooth_thinning) / cosine,
        cosine=cosine,
    )
    distance = 0.0 if own else _centre_distance(gear, blank)
    tip = abs(root_radius(gear) - distance)
    if pre.present:
        normal = math.cos(math.radians(gear.rack.pressure_angle)) * cosine
        cut = replace(blank, thickness=blank.thickness - 2 * _stock(gear) / normal)
        radius = _corner_radius(gear, cut, tip)
        made: list[ToolTooth] = []
        if pre.protuberance_angle is None:
            made.append(cut.tooth(tip, radius))
        else:
            stands_out = replace(cut, thickness=cut.thickness + 2 * pre.protuberance / normal)
            made.append(stands_out.bulge(tip, radius, math.pi / 2 - math.radians(pre.protuberance_angle), cut))
            # The flank below the protuberance, up to where that stands out of it most: the rest is inside.
            share, _ = stands_out.join(tip, radius)
            made.append(cut.tooth(abs(complex(stands_out.corner(np.array([share]), tip, radius)[0])), 0.0))
        tooth: ToolTooth = JoinedTeeth(tuple(made))
    else:
        tooth = blank.tooth(tip, _corner_radius(gear, blank, tip))
    return Shaper(
        tooth=tooth,
        centre_distance=distance,
        tip_radius=tip,
        share=teeth / gear.tooth_count,
        side=1 if gear.internal else -1,
        twist=math.tan(helix) / (gear.tooth_count * m / cosine / 2),
    )


def root_radius(gear: Gear) -> float:
    """Return the radius (mm) of the root circle by the inputs: as given, or h_fP - x below the reference circle."""
    if is_given(gear.root_diameter):
        return abs(gear.root_diameter) / 2
    reference = gear.teeth * gear.normal_module / math.cos(math.radians(gear.helix_angle)) / 2
    return abs(reference - _addendum(gear) + gear.normal_module * gear.profile_shift)


def _corner_radius(gear: Gear, blank: CutterBlank, tip: float) -> float:
    """Return the radius (mm) of the cutter's corner: its own, or that of the rack as far as both corners fit the tip."""
    if gear.root_cutter.tip_radius is not None:
        return gear.root_cutter.tip_radius * gear.normal_module
    if gear.rack.root_radius != "full":
        radius = float(gear.rack.root_radius) * gear.normal_module
        if radius < tip - blank.innermost and (not radius or blank.join(tip, radius)[1] >= 0):
            return radius
    return blank.full_radius(tip)


def _centre_distance(gear: Gear, blank: CutterBlank) -> float:
    """Return the distance (mm) at which the cutter leaves the tooth thickness that the inputs define, found by trial cuts."""
    m, cosine = gear.normal_module, blank.cosine
    tangent = math.tan(math.radians(gear.rack.pressure_angle))
    thickness = m * (math.pi / 2 + 2 * gear.profile_shift * tangent) - gear.tooth_thinning
    filled = math.pi * m - thickness if gear.internal else thickness
    middle = (gear.profile.form_diameter + gear.profile.tip_form_diameter) / 4
    half = float(rolled_half_angle(np.array([middle]), gear.tooth_count * m / cosine / 2, blank.angle, filled / cosine)[0])
    wanted = half if gear.internal else math.pi / gear.tooth_count - half
    start = abs((gear.teeth + blank.teeth) * m / cosine / 2 + (gear.profile_shift + gear.root_cutter.profile_shift) * m)
    side, root = (1 if gear.internal else -1), root_radius(gear)

    def excess(distance: float) -> float:
        # A point of the cutter at the angle `bearing` from the line of centres is on the circle where its flank is wide enough.
        tip = abs(root - distance) + m
        limit = max(min(side * (middle**2 - distance**2 - tip**2) / (2 * distance * tip), 1.0), -1.0)
        bearing = math.acos(limit) * np.linspace(-1.0, 1.0, _BEARINGS)
        radii = np.sqrt(np.maximum(middle**2 - (distance * np.sin(bearing)) ** 2, 0.0))
        radii = side * (radii - distance * np.cos(bearing))
        bearing, radii = bearing[radii > blank.innermost], radii[radii > blank.innermost]
        across, along = radii * np.sin(bearing), distance + side * radii * np.cos(bearing)
        turn = bearing - blank.half_angle(radii)
        return peak_of(np.arctan2(across, along) - turn * blank.teeth / gear.tooth_count) - wanted

    one, other = start, start + 0.01 * m
    at_one, at_other = excess(one), excess(other)
    for _ in range(30):
        if at_other == at_one or abs(other - one) < 1e-13 * start:
            break
        one, other, at_one = other, other - at_other * (other - one) / (at_other - at_one), at_other
        at_other = excess(other)
    return other


# ---------------------------------------------------------------------- the sweep


def swept_distance(tool: Hob | Shaper, points: Complexes, module: float, height: float = 0.0) -> Floats:
    """Return the least signed distance (n,) in mm of points of a gear from its tool over all of the roll, negative inside.

    The points are those of the section at z = 0; gear and tool are compared in the section at a `height` (mm) over it, where
    the helix has turned both.
    """
    section = tool.section(height)
    points = points * np.exp(1j * section.gear)
    radii, angles = np.abs(points), np.angle(points)

    def distance(which: Any, turn: Floats) -> Floats:
        return tool.tooth.distance(tool.seen(points[which, None], turn, section))

    everything = np.arange(len(points))
    if isinstance(tool, Shaper) and not tool.centre_distance:
        fixed = np.full((len(points), 1), -section.gear)
        still: Floats = tool.tooth.distance(points[:, None] * np.exp(1j * fixed))[:, 0]
        return still
    reach = tool.reach(radii, _MARGIN * module)
    turns = reach[:, None] * np.linspace(-1.0, 1.0, _STEPS) - angles[:, None]
    values = distance(everything, turns)
    inner = values[:, 1:-1]
    minima = np.where((inner <= values[:, :-2]) & (inner <= values[:, 2:]), inner, np.inf)
    best: Floats = values.min(axis=1)
    places = np.argpartition(minima, _MINIMA, axis=1)[:, :_MINIMA] + 1
    which, at = np.repeat(everything, _MINIMA), places.ravel()
    real = np.isfinite(minima[which, at - 1])
    which, at = which[real], at[real]
    found = least_of(lambda turn: distance(which, turn), turns[which, at - 1], turns[which, at + 1])[1]
    np.minimum.at(best, which, found)
    return best
