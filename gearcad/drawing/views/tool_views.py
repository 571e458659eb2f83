"""Profiles of the tools that cut and finish a gear or a rack: hob or rack in the normal section, shaper cutter, wheel.

The tip of the tool is up, its tooth centred on x = 0; y counts from its reference line, or from its reference circle on x = 0.
Lengths in mm of the tool, angles in radians.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from gearcad.core.records import Floats
from gearcad.drawing.annotation_text import Written, plain, symbol
from gearcad.drawing.dimensions import Side, leader, linear_dimension
from gearcad.drawing.drawing_symbols import freehand
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.shapes import Figure, Line, Pen, Point, Polyline, Text, Vertex
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import Gear, Rack
from gearcad.geometry.cutter_flank import CutterFlank
from gearcad.geometry.fillets import ShaperTip, ToolTip
from gearcad.geometry.gear_tools import fillet_tool, finished_flank, finishing_wheel, wheel_tip_radius
from gearcad.geometry.premachining import SemiTopping

_TEXT = 2.5
_CAPTION = 3.5
_BODY = 0.3
"""Depth of the body below the tool's root, over the depth of its teeth."""

_ROOT = 0.25
"""Depth of a root that does not cut below the gear's addendum, in normal modules."""

_RIGHT, _LEFT = (30.0, -30.0, 45.0, -45.0, 15.0, -15.0), (150.0, -150.0, 135.0, -135.0, 165.0, -165.0)
_POINTS = 41


@dataclass(frozen=True, kw_only=True)
class StraightTool:
    """A tooth of a hob, a rack or a wheel with straight flanks: half its thickness on the reference line, and its pitch.

    `angle` of the flanks, `addendum`, tip `radius`, `protuberance` and its angle `steep`, `root` below the reference line; that
    cuts the tips where it is `topping`. `stock` is what it leaves.
    """

    half: float
    pitch: float
    angle: float
    addendum: float
    radius: float
    root: float
    topping: bool = False
    protuberance: float = 0.0
    steep: float | None = None
    ramp: SemiTopping = field(default=SemiTopping())
    stock: float = 0.0

    @classmethod
    def of(cls, part: Gear | Rack) -> StraightTool:
        """Return the tool that makes the roots of a gear or a rack, by a hob or by a tool with the profile of a space."""
        pre, m = part.premachining, part.normal_module
        if isinstance(part, Rack):
            tools = part.tools
            half, depth = tools.half_pitch - tools.flank(0.0, tools.stock), tools.depth
            angle, radius = tools.angle, tools.radius
            pitch = 2 * tools.half_pitch
        else:
            tip = fillet_tool(part)
            assert isinstance(tip, ToolTip)
            line = _line_of(part, tip)
            half, depth, angle, radius = tip.flank_at(line), line - tip.v + tip.radius, tip.pressure_angle, tip.radius
            pitch = math.pi * m * math.cos(math.radians(part.rack.pressure_angle)) / math.cos(angle)
        root = part.rack.addendum * m + _ROOT * m if pre.topping is None else pre.topping
        return cls(
            half=half,
            pitch=pitch,
            angle=angle,
            addendum=depth,
            radius=radius,
            root=min(root, (pitch / 2 - half) / math.tan(angle)),
            topping=pre.topping is not None,
            protuberance=pre.protuberance,
            steep=None if pre.protuberance_angle is None else math.radians(pre.protuberance_angle),
            ramp=pre.semi_topping,
            stock=part.stock,
        )

    @classmethod
    def finishing(cls, part: Gear | Rack) -> StraightTool | None:
        """Return the wheel that finishes with straight flanks; None where it runs free of the root, or is a form wheel."""
        if isinstance(part, Rack):
            if (end := part.finishing.end_depth) is None:
                return None
            tools, radius = part.tools, part.wheel_tip_radius
            half, depth, angle, pitch = tools.half_pitch - tools.flank(0.0), end, tools.angle, 2 * tools.half_pitch
            depth += radius * (1 - math.sin(angle))
        else:
            wheel = finishing_wheel(part)
            if wheel is None or wheel.rolling is None:
                return None
            tip, radius = wheel.rolling, wheel.tip_radius
            line = _line_of(part, tip)
            half, depth = tip.flank_at(line), line - tip.v + tip.radius
            angle, pitch = tip.pressure_angle, math.pi * part.normal_module
        root = min((part.rack.addendum + _ROOT) * part.normal_module, (pitch / 2 - half) / math.tan(angle))
        return cls(half=half, pitch=pitch, angle=angle, addendum=depth, radius=radius, root=root)

    def flank(self, height: float) -> float:
        """Return half the tooth at a height over the reference line."""
        return self.half - height * math.tan(self.angle)

    @property
    def centre(self) -> Point:
        """Middle of the rounding of the tip, on the right."""
        height = self.addendum - self.radius
        return self.flank(height) + (self.protuberance - self.radius) / math.cos(self.angle), height

    def on_arc(self, theta: float) -> Point:
        """Return the point of the rounding at an angle from its top."""
        u, height = self.centre
        return u + self.radius * math.sin(theta), height + self.radius * math.cos(theta)

    @property
    def last(self) -> float:
        """Angle at which the rounding ends."""
        return math.pi / 2 - (self.angle if self.steep is None else self.steep)

    @property
    def joint(self) -> Point:
        """Place on the flank where rounding or protuberance ends."""
        x, height = self.on_arc(self.last)
        if self.steep is None:
            return x, height
        slope = math.tan(self.steep)
        at = (self.half - x - height * slope) / (math.tan(self.angle) - slope)
        return self.flank(at), at

    @property
    def right(self) -> list[Vertex]:
        """The right half from the middle of the tip to the middle of the space."""
        u, _ = self.centre
        row: list[Vertex] = [(0.0, self.addendum, 0.0), (u, self.addendum, -math.tan(self.last / 4))]
        row.append((*self.on_arc(self.last), 0.0))
        if self.steep is not None:
            row.append((*self.joint, 0.0))
        end = self.flank(-self.root)
        if self.ramp.height is not None and self.ramp.angle is not None:
            row.append((self.flank(-self.ramp.height), -self.ramp.height, 0.0))
            end = self.flank(-self.ramp.height) + (self.root - self.ramp.height) * math.tan(math.radians(self.ramp.angle))
        return [*row, (min(end, self.pitch / 2), -self.root, 0.0), (self.pitch / 2, -self.root, 0.0)]


def _line_of(gear: Gear, tip: ToolTip) -> float:
    """Return the height of the tool's reference line over the line on which it rolls: x m_n outside the reference circle."""
    return gear.reference_diameter / 2 + gear.profile_shift * gear.normal_module - tip.reference_radius


def _mirrored(right: Sequence[Vertex], scale: float) -> Polyline:
    """Return the whole profile from the right half, which begins in the middle."""
    points = [(x * scale, y * scale) for x, y, _ in right]
    bulges = [bulge for *_, bulge in right[:-1]]
    left = [(-x, y) for x, y in reversed(points)][:-1]
    row = zip([*left, *points], [*reversed(bulges), *bulges, 0.0], strict=True)
    return Polyline(tuple((x, y, bulge) for (x, y), bulge in row))


def _named(name: str, text: str) -> Written:
    return symbol(name, _TEXT).then(plain(text, _TEXT), 1.2)


def _framed(outline: Polyline, bottom: float, caption: str) -> Figure:
    """Return an outline with its body below, which ends in a wavy line, and a caption."""
    (left, low, _), (right, *_) = outline.vertices[0], outline.vertices[-1]
    body = freehand([(left, low), (left, bottom), (right, bottom), (right, low)])
    return Figure.of(outline, body, Text(caption, (left, bottom - 3 * _CAPTION), _CAPTION, pen=Pen.TEXT))


def straight_view(tool: StraightTool, draughting: Draughting, caption: str, *, wheel: bool = False) -> View:
    """Return the view of a tool with straight flanks, which may be the finishing wheel."""
    scale, words = draughting.scale, draughting.words

    def at(point: Point, side: int = 1) -> Point:
        return side * point[0] * scale, point[1] * scale

    outline = _mirrored(tool.right, scale)
    depth = tool.addendum + tool.root
    edge, top = tool.pitch / 2 * scale, tool.addendum * scale
    shapes: list[Figure | Line] = [
        _framed(outline, -(tool.root + _BODY * depth) * scale, caption),
        Line((-edge - 4.0, 0.0), (edge + 4.0, 0.0), Pen.CENTRE),
    ]
    if tool.stock:
        away = tool.stock / math.cos(tool.angle)
        low, high = -(tool.root if tool.ramp.height is None else tool.ramp.height), tool.joint[1]
        ends = [(tool.flank(each) + away, each) for each in (low, high)]
        shapes += [Line(at(ends[0], side), at(ends[1], side), Pen.HIDDEN) for side in (1, -1)]
    between = [((-tool.half, 0.0), (tool.half, 0.0), Side.ABOVE, top, 2 * tool.half)]
    between.append(((tool.half, 0.0), (tool.centre[0], tool.addendum), Side.RIGHT, edge, tool.addendum))
    if tool.topping:
        between.append(((-tool.half, 0.0), (-tool.flank(-tool.root), -tool.root), Side.LEFT, -edge, tool.root))
    if (ramp := tool.ramp.height) is not None:
        between.append(((-tool.half, 0.0), (-tool.flank(-ramp), -ramp), Side.LEFT, -edge, ramp))
    marks: list[Candidates] = [
        partial(linear_dimension, at(first), at(second), side, Size(value=round(value, 4)), draughting, clear=clear)
        for first, second, side, clear, value in between
    ]

    def note(point: Point, side: int, name: str, text: str) -> Candidates:
        ways = _RIGHT if side > 0 else _LEFT
        return partial(leader, at(point, side), _named(name, text), draughting, ways)

    middle = (tool.joint[1] - tool.root) / 2
    if tool.radius:
        marks.append(note(tool.on_arc(tool.last / 2), 1, "ρ_g" if wheel else "ρ_aP0", words.shortest(tool.radius, 4)))
    marks.append(
        note((tool.flank(middle), middle), 1, "α_n" if wheel else "α_n0", f"{words.shortest(math.degrees(tool.angle), 4)}°")
    )
    if tool.steep is not None:
        x, y = tool.on_arc(math.pi / 2 - tool.angle)
        marks.append(note((x, y), -1, "p_rP0", words.shortest(tool.protuberance, 4)))
        end, joint = tool.on_arc(tool.last), tool.joint
        steep = ((end[0] + joint[0]) / 2, (end[1] + joint[1]) / 2)
        marks.append(note(steep, -1, "α_prP0", f"{words.shortest(math.degrees(tool.steep), 4)}°"))
    if tool.stock:
        low = -tool.root / 2
        marks.append(note((tool.flank(low) + tool.stock / math.cos(tool.angle), low), -1, "q", words.shortest(tool.stock, 4)))
    if tool.ramp.angle is not None and tool.ramp.height is not None:
        part = (tool.ramp.height + tool.root) / 2
        x = tool.flank(-tool.ramp.height) + (part - tool.ramp.height) * math.tan(math.radians(tool.ramp.angle))
        marks.append(note((x, -part), 1, "α_K", f"{words.shortest(tool.ramp.angle, 4)}°"))
    return View("wheel" if wheel else "tool", Figure.of(*shapes), tuple(marks))


# ---------------------------------------------------------------------- tools with a section of circles


def _row(points: Iterable[tuple[float, float]]) -> list[Vertex]:
    return [(x, y, 0.0) for x, y in points]


def cutter_view(gear: Gear, draughting: Draughting, caption: str) -> View:
    """Return the view of a tooth of a shaper cutter in its transverse section."""
    tip, scale, words = fillet_tool(gear), draughting.scale, draughting.words
    assert isinstance(tip, ShaperTip)
    reference = tip.base_radius / math.cos(math.radians(gear.transverse_pressure_angle))
    outside = gear.premachining.protuberance / (tip.base_radius * math.cos(math.radians(gear.base_helix_angle)))
    corner = np.stack(tip.outline(np.linspace(0.0, tip.corner_end, _POINTS)), -1)
    land = np.linspace(0.0, float(np.arctan2(corner[0, 1], corner[0, 0])), _POINTS)[:-1]
    half = [tip.tip_radius * np.stack([np.cos(land), np.sin(land)], -1), corner]
    start = float(np.hypot(*corner[-1]))
    if tip.protuberance_angle is not None:
        straight = CutterFlank(tip, outside)
        along, across = straight.points(np.array([straight.last]))
        turned = (along + 1j * across) * np.exp(1j * tip.middle_angle)
        half.append(np.stack([turned.real, turned.imag], -1))
        start = float(np.abs(turned)[0])
    lowest = max(tip.base_radius, reference - 1.25 * gear.normal_module)
    radii = np.linspace(start, min(lowest, start), _POINTS)
    roll = np.sqrt(np.maximum(radii**2 - tip.base_radius**2, 0.0)) / tip.base_radius
    angles = tip.base_half_angle - outside - (roll - np.arctan(roll))
    half.append(np.stack([radii * np.cos(angles), radii * np.sin(angles)], -1))
    points = np.concatenate(half)
    right = _row(zip(points[:, 1].tolist(), (points[:, 0] - reference).tolist(), strict=True))
    outline = _mirrored(right, scale)
    bottom = (right[-1][1] - _BODY * (right[0][1] - right[-1][1])) * scale
    reach = 1.4 * right[-1][0]
    circles = [(reference, Pen.CENTRE)]
    if tip.base_radius > reference + bottom / scale:
        circles.append((tip.base_radius, Pen.THIN))
    arcs = [_circle(radius, reference, reach, scale, pen) for radius, pen in circles]

    def note(point: tuple[float, float], side: int, name: str, text: str) -> Candidates:
        place = side * point[0] * scale, point[1] * scale
        return partial(leader, place, _named(name, text), draughting, _RIGHT if side > 0 else _LEFT)

    at_side = (0.95 * reach, math.sqrt(reference**2 - (0.95 * reach) ** 2) - reference)
    marks = [note(at_side, 1, "d_0", words.number(2 * reference, 3))]
    marks.append(note((0.0, right[0][1]), 1, "d_a0", words.number(2 * tip.tip_radius, 3)))
    bend = corner[_POINTS // 2]
    if tip.radius:
        marks.append(note((float(bend[1]), float(bend[0]) - reference), 1, "ρ_a0", words.shortest(tip.radius, 4)))
    if tip.protuberance_angle is not None:
        pre, end = gear.premachining, corner[-1]
        marks.append(note((float(end[1]), float(end[0]) - reference), -1, "p_rP0", words.shortest(pre.protuberance, 4)))
        last = half[2][-1]
        middle = (float(end[1] + last[1]) / 2, float(end[0] + last[0]) / 2 - reference)
        marks.append(note(middle, -1, "α_prP0", f"{words.shortest(pre.protuberance_angle or 0.0, 4)}°"))
    return View("tool", Figure.of(_framed(outline, bottom, caption), *arcs), tuple(marks))


def _circle(radius: float, reference: float, reach: float, scale: float, pen: Pen) -> Polyline:
    across = np.linspace(-reach, reach, _POINTS)
    up = np.sqrt(radius**2 - across**2) - reference
    return Polyline.straight([(x * scale, y * scale) for x, y in zip(across.tolist(), up.tolist(), strict=True)], pen)


def form_wheel_view(gear: Gear, draughting: Draughting, caption: str) -> View | None:
    """Return the view of a form wheel: the space that it leaves, in the transverse section; None for another wheel."""
    wheel, outline = finishing_wheel(gear), gear.profile.root
    if wheel is None or wheel.rolling is not None or outline is None:
        return None
    scale, side = draughting.scale, -1 if gear.internal else 1
    flank = gear.profile.involute
    trace = wheel.trace(finished_flank(gear), math.pi / gear.tooth_count)
    s = np.linspace(0.0, 1.0, _POINTS)
    middle, reference = math.pi / gear.tooth_count, abs(gear.reference_diameter) / 2

    def seen(polar: tuple[Floats, Floats]) -> list[Vertex]:
        radius, angle = polar[0], middle - polar[1]
        across, up = radius * np.sin(angle), side * (reference - radius * np.cos(angle))
        return _row(zip(across.tolist(), up.tolist(), strict=True))

    arc, involute = seen(trace.polar(s)), seen(flank.polar(s))
    right: list[Vertex] = [(0.0, arc[0][1], 0.0), *arc, *involute[1:]]
    drawn = _mirrored(right, scale)
    bottom = (right[-1][1] - _BODY * (right[0][1] - right[-1][1])) * scale
    x, y, _ = arc[_POINTS // 2]
    text = _named("ρ_g", draughting.words.shortest(wheel_tip_radius(gear), 4))
    mark = partial(leader, (x * scale, y * scale), text, draughting, _RIGHT)
    return View("wheel", _framed(drawn, bottom, caption), (mark,))
