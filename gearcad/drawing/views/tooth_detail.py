"""Enlarged detail of a tooth: outline, circles, tooth thickness, tip chamfer (ISO 128-3). Lengths of the part and of paper in
mm.

The outline is about the axis of a gear, or the middle of a rack's tooth on its reference line. A place has a height: a radius,
or a height over a rack's reference line. It also has a distance to the right of the middle of the tooth: an angle in radians,
or a length. The reference line is at height 0 of the paper.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from gearcad.core.records import Floats
from gearcad.drawing.annotation_text import Written, plain, symbol
from gearcad.drawing.dimensions import ARROW, arrow
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.drawing_symbols import freehand, view_label
from gearcad.drawing.options import SCALES
from gearcad.drawing.shapes import Anchor, Arc, Box, Circle, Figure, Line, Pen, Point, Polyline, Text, Vertex
from gearcad.drawing.words import Draughting
from gearcad.geometry import Gear, Rack
from gearcad.geometry.curves import PlaneCurve
from gearcad.geometry.gear_data import outer_diameter
from gearcad.geometry.rack_root import FilletArc
from gearcad.solids.files.dxf import Arcs, arcs_of, joined

ACCURACY = 0.0005
"""Greatest distance (mm of the part) of the outline from the exact curve."""

_NOTHING = 1e-9
"""Length (mm) up to which a curve counts as a point."""


def tooth_outline(gear: Gear | Rack) -> tuple[Vertex, ...]:
    """Return the outline from the middle of the left space to that of the right one, as arcs (mm). It is the exact profile
    without modifications.
    """
    half = _half_of_rack(gear) if isinstance(gear, Rack) else _half_of_gear(gear)
    x, y = half.vertices.T
    vertices = np.concatenate([half.vertices, np.stack([-x, y], -1)[-2::-1]])
    bulges = np.r_[half.bulges, half.bulges[::-1], 0.0]
    return tuple((float(x), float(y), float(bulge)) for (x, y), bulge in zip(vertices, bulges, strict=True))


def _half_of_gear(gear: Gear) -> Arcs:
    """Return the half tooth of a gear, turned from +x in the profile to +y. The flank with y > 0 is then the left one."""
    half = _arcs(gear.profile.curves)
    x, y = half.vertices.T
    return Arcs(np.stack([-y, x], -1), half.bulges)


def _half_of_rack(rack: Rack) -> Arcs:
    return _arcs(rack.profile.curves)


def _arcs(curves: Iterable[PlaneCurve]) -> Arcs:
    """Return curves in a row as arcs; lands are whole arcs."""
    return joined([_arc(curve) for curve in curves if _length(curve) > _NOTHING])


def _length(curve: PlaneCurve) -> float:
    start, end = curve.points(np.array([0.0, 1.0]))
    return math.dist(start, end)


def _arc(curve: PlaneCurve) -> Arcs:
    """Return a curve as one arc if it is an arc or a line, and involutes and trochoids as pairs of arcs."""
    ends = np.array([0.0, 1.0])
    heading: Floats = curve.direction(ends)
    if _turns_evenly(curve):
        return Arcs(curve.points(ends), np.array([math.tan((heading[1] - heading[0]) / 4)]))
    return arcs_of(curve, ACCURACY)


def _turns_evenly(curve: PlaneCurve) -> bool:
    """Return whether a curve is a line or an arc of a circle: lands, chamfers, flanks of racks, fillets of spur racks."""
    if isinstance(curve, FilletArc):
        return curve.stretch == 1
    return curve.kind.value not in ("trochoid", "involute")


_DEEPEST = 0.6
"""Greatest distance (tooth depths) of a circle from the tooth; a base circle further below the root circle is left out."""

_FORM_DECIMALS = 2
"""Decimals of the end of a rack's flank: a third one would be false, as the root radii of ISO 53 have two."""


@dataclass(frozen=True)
class Level:
    """A radius, or a height over a rack's reference line, with its symbol, its written value and its pen.

    A `reference` value stands elsewhere on the sheet, so it is in brackets here.
    """

    symbol: str
    height: float
    value: float
    pen: Pen = Pen.THIN
    reference: bool = False
    decimals: int = 3


def levels_of(gear: Gear | Rack) -> tuple[Level, ...]:
    """Return the levels on the tooth or near it, from the lowest to the highest on paper."""
    found = _rack_levels(gear) if isinstance(gear, Rack) else _gear_levels(gear)
    return tuple(sorted(found, key=lambda level: level.height))


def _gear_levels(gear: Gear) -> list[Level]:
    profile = gear.profile
    circles = [
        ("d_a", profile.tip_diameter, Pen.THIN, True),
        ("d_Fa", profile.tip_form_diameter, Pen.THIN, False),
        ("d", profile.reference_diameter, Pen.CENTRE, True),
        ("d_b", profile.base_diameter, Pen.THIN, True),
        ("d_Ff", profile.form_diameter, Pen.THIN, True),
        ("d_f", profile.root_diameter, Pen.THIN, True),
    ]
    tip, root = profile.tip_diameter, profile.root_diameter
    beyond = _DEEPEST * abs(tip - root)
    near = min(tip, root) - beyond, max(tip, root) + beyond
    if not profile.tip_chamfer:
        del circles[1]
    return [Level(symbol, size / 2, size, pen, known) for symbol, size, pen, known in circles if near[0] <= size <= near[1]]


def _rack_levels(rack: Rack) -> list[Level]:
    lines = [
        Level("h_a", rack.tip_height, rack.tip_height, reference=True),
        Level("h_Fa", rack.tip_form_height, rack.tip_form_height),
        Level("h_Ff", -rack.form_depth, rack.form_depth, decimals=_FORM_DECIMALS),
        Level("h_f", -rack.root_depth, rack.root_depth, reference=True),
    ]
    if not rack.profile.chamfered:
        del lines[1]
    return [Level("H_0", 0.0, rack.height, Pen.CENTRE, True), *lines]


_BODY = 0.5
"""Depth of the body shown below the roots, over the depth of the teeth."""

_WALL = 0.8
"""Largest share of the body's own depth that is shown."""


class Placing(ABC):
    """The placing of a tooth on paper at a scale."""

    def __init__(self, scale: float) -> None:
        self.scale = scale

    middle_of_space: float
    """Distance of the middles of both spaces from that of the tooth."""

    root: float
    """Height of the root."""

    end: float
    """Height at which the view ends, within the body."""

    @abstractmethod
    def point(self, height: float, aside: float) -> Point:
        """Return a place as a point on paper."""

    @abstractmethod
    def level(self, height: float, start: float, end: float, pen: Pen) -> Arc | Line:
        """Return a part of a circle or line from left to right."""

    @abstractmethod
    def further(self, aside: float, paper: float) -> float:
        """Return the place that is `paper` (mm of paper) further to the right on the reference line."""

    @abstractmethod
    def flank(self, height: float) -> float | None:
        """Return the place of the right flank, or its fillet, at a height; None below the root and above the tip."""

    @abstractmethod
    def outline(self) -> Polyline:
        """Return the outline of the tooth and half a space on both sides."""

    @property
    def limit(self) -> list[Point]:
        """Points along the end of the shown body, from the left end of the outline to the right one."""
        steps = [self.middle_of_space * step / 8 for step in range(-8, 9)]
        low = [self.point(self.end, aside) for aside in steps]
        return [self.point(self.root, steps[0]), *low, self.point(self.root, steps[-1])]


class OnCircles(Placing):
    """A tooth of a gear, its axis below it."""

    def __init__(self, gear: Gear, scale: float) -> None:
        super().__init__(scale)
        self._gear, self._profile = gear, gear.profile
        self._reference = gear.profile.reference_diameter / 2
        self.middle_of_space = math.pi / gear.tooth_count
        self.root = gear.profile.root_diameter / 2
        body = outer_diameter(gear) if gear.internal else gear.body.opening_diameter
        way = _WALL * (body / 2 - self.root)
        deep = _BODY * (self.root - gear.profile.tip_diameter / 2)
        self.end = self.root + min(way, deep, key=abs)

    def point(self, height: float, aside: float) -> Point:
        return self.scale * height * math.sin(aside), self.scale * (height * math.cos(aside) - self._reference)

    def level(self, height: float, start: float, end: float, pen: Pen) -> Arc:
        centre = 0.0, -self.scale * self._reference
        return Arc(centre, self.scale * height, 90 - math.degrees(end), 90 - math.degrees(start), pen)

    def further(self, aside: float, paper: float) -> float:
        return aside + paper / self.scale / self._reference

    def flank(self, height: float) -> float | None:
        low, high = sorted((self._profile.tip_diameter / 2, self.root))
        return math.radians(self._profile.half_angle(height)) if low <= height <= high else None

    def outline(self) -> Polyline:
        points = ((self.scale * x, self.scale * (y - self._reference), bulge) for x, y, bulge in tooth_outline(self._gear))
        return Polyline(tuple(points))


class OnLines(Placing):
    """Sizes of a rack's tooth, whose reference is a line."""

    def __init__(self, rack: Rack, scale: float) -> None:
        super().__init__(scale)
        self._rack = rack
        self.middle_of_space = rack.transverse_pitch / 2
        self.root = -rack.root_depth
        self.end = self.root - min(_BODY * (rack.root_depth + rack.tip_height), _WALL * (rack.height - rack.root_depth))

    def point(self, height: float, aside: float) -> Point:
        return self.scale * aside, self.scale * height

    def level(self, height: float, start: float, end: float, pen: Pen) -> Line:
        return Line(self.point(height, start), self.point(height, end), pen)

    def further(self, aside: float, paper: float) -> float:
        return aside + paper / self.scale

    def flank(self, height: float) -> float | None:
        return float(self._rack.profile.half_thickness(height)) if self.root <= height <= self._rack.tip_height else None

    def outline(self) -> Polyline:
        return Polyline(tuple((self.scale * x, self.scale * y, bulge) for x, y, bulge in tooth_outline(self._rack)))


def placing(gear: Gear | Rack, scale: float) -> Placing:
    """Return the placing of a gear's or a rack's tooth."""
    return OnLines(gear, scale) if isinstance(gear, Rack) else OnCircles(gear, scale)


def spread(wanted: Sequence[float], gap: float) -> list[float]:
    """Return places at least `gap` apart, with the least sum of squares of their distances from the wanted, rising places.

    Those that would be too near each other make a block around their mean (pool adjacent violators).

    >>> spread([0.0, 1.0, 10.0], 3.0)
    [-1.0, 2.0, 10.0]
    """
    blocks: list[tuple[float, int]] = []
    for i, place in enumerate(wanted):
        total, count = place - i * gap, 1
        while blocks and blocks[-1][0] / blocks[-1][1] > total / count:
            before, more = blocks.pop()
            total, count = total + before, count + more
        blocks.append((total, count))
    firsts = [total / count for total, count in blocks for _ in range(count)]
    return [first + i * gap for i, first in enumerate(firsts)]


_BEYOND = 4.0
"""Length of a level behind the middle of the space (mm of paper)."""

_KNEE, _SLANT = 1.0, 4.0
"""Length of the level part of the line to a name, and width of the slanting part."""

_NAME_AIR = 1.0
_NAME_TEXT, _NAME_LINE = 2.5, 4.2
"""Height of names, and distance from line to line."""


def named_levels(levels: tuple[Level, ...], place: Placing, draughting: Draughting) -> Figure:
    """Return the levels with names, each from the right flank on; the reference circle and levels off the tooth go across the
    whole tooth.
    """
    right = place.further(place.middle_of_space, _BEYOND)
    ends = [place.point(level.height, right) for level in levels]
    knee = max(x for x, _ in ends) + _KNEE
    rows = spread([y for _, y in ends], _NAME_LINE)
    shapes = []
    for level, (x, y), row in zip(levels, ends, rows, strict=True):
        shapes.append(Figure.of(place.level(level.height, _start(level, place), right, level.pen)))
        shapes.append(Figure.of(Line((x, y), (knee, y), Pen.THIN), Line((knee, y), (knee + _SLANT, row), Pen.THIN)))
        shapes.append(_name(level, draughting).at((knee + _SLANT + _NAME_AIR, row), Anchor.MIDDLE_LEFT))
    return Figure.of(*shapes)


def _start(level: Level, place: Placing) -> float:
    flank = place.flank(level.height)
    return -place.middle_of_space if flank is None or level.pen is Pen.CENTRE else flank


def _name(level: Level, draughting: Draughting) -> Written:
    """Return the symbol and value of a level, in brackets if the value stands elsewhere on the sheet."""
    value = draughting.words.number(level.value, level.decimals)
    prefix = "⌀" if level.symbol.startswith("d") else ""
    text = f"({prefix}{value})" if level.reference else prefix + value
    return symbol(level.symbol, _NAME_TEXT).then(plain(text, _NAME_TEXT), 1.2)


_SIZE_TEXT = 2.5
_SIZE_AIR = 1.2
"""Distance (mm) between texts and lines."""

_BELOW, _ABOVE = 6.0, 3.0
"""Distances of the dimension line from the reference circle, towards the root: the text stands above the line."""

_SIZE_LIFT = 0.9
"""Distance from the dimension line to the text above it."""

_OVER = 1.5
"""Length of extension lines past the dimension line."""

_TAIL = 7.0
"""Length of the lines behind arrows that stand outside."""


@dataclass(frozen=True)
class _Line:
    """The dimension line: a circle or line at `height` between the places of the flanks, `half` from the middle."""

    place: Placing
    height: float
    half: float

    def point(self, aside: float) -> Point:
        return self.place.point(self.height, aside)

    def arrow(self, end: float, tail: float) -> Figure:
        """Return an arrow that points from `tail` to `end`."""
        tip, back = self.point(end), self.point(tail)
        return Figure.of(arrow(tip, (tip[0] - back[0], tip[1] - back[1])))

    def line(self, start: float, end: float) -> Figure:
        return Figure.of(self.place.level(self.height, start, end, Pen.DIMENSION))


def thickness_dimension(gear: Gear | Rack, place: Placing, draughting: Draughting) -> Figure:
    """Return the dimension of the transverse tooth thickness: between the flanks if its text has room, else to the left of
    them.

    It is in brackets, because its limits are in the gear data. It is empty if the reference circle is not on the tooth.
    """
    reference = 0.0 if isinstance(gear, Rack) else gear.profile.reference_diameter / 2
    half = place.flank(reference)
    if half is None:
        return Figure()
    inwards = _ABOVE if place.root > reference else -_BELOW
    line = _Line(place, reference + inwards / place.scale, half)
    value = plain(draughting.words.number(gear.transverse_tooth_thickness, 3) + ")", _SIZE_TEXT)
    text = symbol("(s_t", _SIZE_TEXT).then(value, 1.0)
    room = line.point(half)[0] - line.point(-half)[0]
    over = line.height + (_OVER if inwards > 0 else -_OVER) / place.scale
    extensions = (Line(place.point(reference, side), place.point(over, side), Pen.DIMENSION) for side in (-half, half))
    return Figure.of(
        *extensions, _between(line, text) if room >= text.width + 2 * _SIZE_AIR else _dimension_at_left(line, text, room)
    )


def _between(line: _Line, text: Written) -> Figure:
    x, y = line.point(0.0)
    arrows = line.arrow(-line.half, 0.0), line.arrow(line.half, 0.0)
    return Figure.of(line.line(-line.half, line.half), *arrows, text.at((x, y + _SIZE_LIFT + text.below), Anchor.CENTRE))


def _dimension_at_left(line: _Line, text: Written, room: float) -> Figure:
    """Return the dimension with its text to the left of the half space."""
    end = line.place.further(-max(line.place.middle_of_space, line.half), -_SIZE_AIR)
    x, y = line.point(end)
    outline = (*line.place.outline().points, *line.place.limit)
    left = min([x, *(across for across, up in outline if abs(up - y) < text.height)]) - _SIZE_AIR
    words = Figure.of(Line((x, y), (left, y), Pen.DIMENSION), text.at((left - _SIZE_AIR, y), Anchor.MIDDLE_RIGHT))
    if room >= 3 * ARROW:
        arrows = line.arrow(-line.half, 0.0), line.arrow(line.half, 0.0)
        return Figure.of(line.line(end, line.half), *arrows, words)
    right = line.place.further(line.half, _TAIL)
    arrows = line.arrow(-line.half, line.place.further(-line.half, -_TAIL)), line.arrow(line.half, right)
    return Figure.of(line.line(end, right), *arrows, words)


_ROOM = (64.0, 54.0)
"""Greatest width and height of the tooth with half a space on both sides."""

_TITLE_GAP, _DETAIL_TEXT = 4.0, 2.5
_DETAIL_AIR = 1.2


def detail_scale(drawn: DrawnGear) -> float:
    """Return the largest scale of ISO 5455 at which a tooth has room."""
    place = placing(drawn.gear, 1.0)
    box = _visible_box(place)
    most = min(_ROOM[0] / box.width, _ROOM[1] / box.height)
    return next((scale for scale in SCALES.values() if scale <= most), min(SCALES.values()))


def tooth_figure(drawn: DrawnGear, draughting: Draughting, letter: str = "Z") -> Figure:
    """Return the detail at the scale of `draughting`, its reference circle at the origin, named by a letter and its scale."""
    place = placing(drawn.gear, draughting.scale)
    tooth = Figure.of(
        place.outline(),
        freehand(place.limit),
        named_levels(levels_of(drawn.gear), place, draughting),
        thickness_dimension(drawn.gear, place, draughting),
        _chamfer(drawn.gear, place, draughting),
    )
    return tooth + _title(letter, draughting.scale, tooth.box)


def _visible_box(place: Placing) -> Box:
    return Box.around((*place.outline().points, *place.limit))


def _chamfer(gear: Gear | Rack, place: Placing, draughting: Draughting) -> Figure:
    """Return a leader to the left chamfer, its height in brackets because the gear data has it; empty without a chamfer."""
    size = gear.tip_chamfer if isinstance(gear, Rack) else gear.body.tip_chamfer
    if not size:
        return Figure()
    up = not (isinstance(gear, Gear) and gear.internal)
    tip = gear.tip_height if isinstance(gear, Rack) else gear.profile.tip_diameter / 2
    at = tip - size / 2 if up else tip + size / 2
    x, y = place.point(at, -(place.flank(at) or 0.0))
    rise = 6.0 if up else -6.0
    knee = (x - 6.0, y + rise)
    text = plain(f"({draughting.words.shortest(size, 3)}×45°)", _DETAIL_TEXT)
    end = knee[0] - text.width - _DETAIL_AIR
    return Figure.of(
        Line((x, y), knee, Pen.DIMENSION),
        Line(knee, (end, knee[1]), Pen.DIMENSION),
        text.at((end, knee[1] + _DETAIL_AIR), Anchor.LEFT),
    )


def _title(letter: str, scale: float, box: Box) -> Figure:
    """Return the letter and the scale in brackets, above the detail."""
    ratio = next((name for name, value in SCALES.items() if math.isclose(value, scale)), f"{scale:g}:1")
    return view_label(f"{letter} ({ratio})", (box.middle[0], box.top + _TITLE_GAP))


DETAIL = "Z"

_LEAST_RING, _LETTER = 3.0, 5.0
"""Radius of the smallest ring, height of the letter (mm of paper)."""

_RING_AIR = 1.0
_ROUND = (150.0, 120.0, -150.0, -120.0, 30.0, 60.0, -30.0, -60.0)
"""Directions from the axis (degrees) in which a tooth of a gear may be, none of them along a centre line."""

_BESIDE = (60.0, -60.0, -90.0, 90.0, 120.0, -120.0, 0.0, 180.0)
"""Directions from the tooth of a rack to the letter."""


def detail_mark(drawn: DrawnGear, view: Figure, scale: float, letter: str = DETAIL) -> Iterator[Figure]:
    """Yield the ring and letter that mark the detail's place on a `view`, in each possible place.

    The view is along the axis, with the axis at the origin. For a rack it is the front view, with its reference line at height
    0.
    """
    gear = drawn.gear
    places = _rack_rings(gear, view, scale) if isinstance(gear, Rack) else _gear_rings(gear, scale)
    for centre, radius, (across, up) in places:
        out = radius + 0.8 * _LETTER
        text = Text(letter, (centre[0] + out * across, centre[1] + out * up), _LETTER, Anchor.MIDDLE, pen=Pen.TEXT)
        yield Figure.of(Circle(centre, radius, Pen.THIN), text)


def _gear_rings(gear: Gear, scale: float) -> Iterator[tuple[Point, float, Point]]:
    """Yield the middle and radius of rings (mm of paper), and the direction from there to the letter: off the teeth."""
    tip, root = (scale * abs(diameter) / 2 for diameter in (gear.tip_diameter, gear.root_diameter))
    side = -1.0 if gear.internal else 1.0
    for way in _ways(gear, (tip + root) / 2, _ring(tip, root) + scale * gear.body.bolt_diameter / 2, scale):
        out = math.cos(math.radians(way)), math.sin(math.radians(way))
        middle = (tip + root) / 2 * out[0], (tip + root) / 2 * out[1]
        yield middle, _ring(tip, root), (side * out[0], side * out[1])


def _ways(gear: Gear, middle: float, reach: float, scale: float) -> list[float]:
    """Return the directions of teeth, those first whose ring, at radius `middle`, is not over a bolt hole (mm of paper)."""
    count, circle = gear.body.bolt_holes, scale * gear.body.bolt_circle / 2
    if not count:
        return list(_ROUND)
    step = 360.0 / count  # the first hole is above the axis

    def overlap(way: float) -> float:
        off = math.radians((way - 90.0 + step / 2) % step - step / 2)
        return max(0.0, reach - math.hypot(circle - middle * math.cos(off), middle * math.sin(off)))

    between = [90.0 + step * (math.floor((way - 90.0) / step) + 0.5) for way in _ROUND]
    return sorted(dict.fromkeys((*_ROUND, *between)), key=overlap)


def _rack_rings(rack: Rack, view: Figure, scale: float) -> Iterator[tuple[Point, float, Point]]:
    """Yield the middle, radius and letter direction of rings on teeth with an upright centre line. The letter is beside, above
    or below.
    """
    top, root = scale * rack.tip_height, -scale * rack.root_depth
    centres = [each for each in view.shapes if isinstance(each, Line) and each.pen is Pen.CENTRE]
    middles = list(dict.fromkeys(each.start[0] for each in centres if each.start[0] == each.end[0]))
    for way in _BESIDE:
        for along in reversed(middles or [0.0]):
            yield (along, (top + root) / 2), _ring(top, root), (math.cos(math.radians(way)), math.sin(math.radians(way)))


def _ring(tip: float, root: float) -> float:
    return max(_LEAST_RING, abs(tip - root) / 2 + _RING_AIR)
