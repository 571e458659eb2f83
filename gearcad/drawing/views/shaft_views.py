"""Views of shafts: a shaft with its dimensions, and the section through the axes of a pair on its shafts and bearings.

Solid shafts are not cut lengthways (ISO 128-3); of hollow ones the upper half is. Bearings have the general simplified symbol
of ISO 8826-1. Heights are in mm over the axis of the wheel, z is that of the assembly, to the right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from gearcad.core.records import Role
from gearcad.drawing.dimensions import Side, leader, linear_dimension
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.shapes import Box, Figure, Hatching, Line, Pen, Point, Polyline, Shape
from gearcad.drawing.views.assembly_figures import (
    BEYOND_AXIS,
    Across,
    Polygon,
    Sectioned,
    balloons,
    distance_size,
    dots,
    section_figure,
    visible,
)
from gearcad.drawing.views.pair_views import PairPlaces, Placed
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import GearPair
from gearcad.shafts.beam import SteppedShaft
from gearcad.solids.shaft_plan import Cylinder, SeatedShaft, TurnedPlan, diameters_within

_HATCHING = 45.0
_SPACING = 2.5
"""Distance of hatching lines (mm of paper)."""

_SYMBOL = 0.45
"""Side of the square of a bearing whose size is not known, over the diameter of its seat."""

_ARM = 0.3
"""Half the length of the lines of the cross in it, over its shorter side: they do not touch it."""

_NEAR = 1e-6
"""Length (mm) below which a stretch is none, and distance to both sides of a bearing at which its seat is taken."""

_AT_LEFT, _AT_RIGHT = ((Side.LEFT,),), ((Side.RIGHT,),)
"""Sides of the rows of item numbers of parts at the left and at the right, best first."""

_RING_ROOM = 14.0
"""Room for a row of item numbers between the ends of the axes and the centre distance (mm of paper)."""

_TICK = 4.0
"""Length of the centre line in the middle of the face beyond the teeth (mm of paper)."""

_UP, _DOWN = (75.0, 105.0, 60.0, 120.0, 45.0, 135.0), (-75.0, -105.0, -60.0, -120.0, -45.0, -135.0)
"""Directions of leaders from the upper edge of a shaft, and from the lower one."""


def _clipped(cylinders: Sequence[Cylinder], low: float, high: float) -> list[Cylinder]:
    """Return the parts of cylinders between two positions (mm)."""
    found = (Cylinder(each.radius, max(each.low, low), min(each.high, high)) for each in cylinders)
    return [each for each in found if each.high - each.low > _NEAR]


def _upper(cylinders: Sequence[Cylinder]) -> list[Point]:
    """Return the corners (z, radius) of the upper edge of cylinders."""
    return [(z, each.radius) for each in cylinders for z in (each.low, each.high)]


@dataclass(frozen=True)
class ShaftFigure:
    """A stretch of a shaft from `low` to `high` (mm from its left end), which is at `z`; its axis is at a `height`."""

    plan: TurnedPlan
    low: float
    high: float
    z: float = 0.0
    height: float = 0.0

    @property
    def outside(self) -> list[Cylinder]:
        """Outer cylinders within the stretch."""
        return _clipped(self.plan.outside, self.low, self.high)

    @property
    def bore(self) -> list[Cylinder]:
        """Cylinders of the bore within the stretch, radius 0 where there is none."""
        return _clipped(self.plan.bore, self.low, self.high)

    @property
    def silhouette(self) -> Polygon:
        """Outline in the plane of the section."""
        upper = _upper(self.outside)
        return tuple(self._at(point) for point in (*upper, *((z, -radius) for z, radius in reversed(upper))))

    def _at(self, point: Point) -> Point:
        return point[0] + self.z, point[1] + self.height

    def middles(self) -> Iterator[Point]:
        """Yield points of each outer cylinder, above the axis and the bore."""
        bored = max(each.radius for each in self.bore)
        for each in self.outside:
            for share in (0.2, 0.5):
                yield self._at((each.low + share * (each.high - each.low), (each.radius + bored) / 2))

    def shapes(self, across: Across) -> Iterator[Shape]:
        """Yield outline, edges of shoulders, and of a hollow stretch the hatched upper half with the edges of its bore."""
        yield Polyline.straight(across.points(self.silhouette), closed=True)
        hollow = any(each.radius for each in self.bore)
        for one, other in pairwise(self.outside):
            reach = max(one.radius, other.radius)
            yield self._upright(one.high, -reach, 0.0 if hollow else reach, across)
        if not hollow:
            return
        for points in self._walls():
            area = across.points(self._at(point) for point in points)
            yield Hatching((tuple((x, y, 0.0) for x, y in area),), _HATCHING, _SPACING)
        for each in self.bore:
            if each.radius:
                ends = (self._at((each.low, each.radius)), self._at((each.high, each.radius)))
                yield Line(across.point(ends[0]), across.point(ends[1]))
        radii = [0.0, *(each.radius for each in self.bore), 0.0]
        places = [self.low, *(each.high for each in self.bore)]
        for z, (before, after) in zip(places, pairwise(radii), strict=True):
            if before != after:
                yield self._upright(z, 0.0, max(before, after), across)

    def _walls(self) -> Iterator[list[Point]]:
        """Yield the areas that are cut, between outside and bore above the axis."""
        upper, lower = _upper(self.outside), _upper(self.bore)
        yield [*upper, *reversed(lower)]

    def _upright(self, z: float, low: float, high: float, across: Across) -> Line:
        return Line(across.point(self._at((z, low))), across.point(self._at((z, high))))


class BearingPlace(NamedTuple):
    """Position of a bearing along the axis, radius of its seat, and height and width of its section (mm)."""

    position: float
    radius: float
    high: float
    width: float

    def rectangles(self, height: float) -> Iterator[tuple[Polygon, Point]]:
        """Yield the rectangles above and below a shaft whose axis is at a height (mm), each with its middle."""
        for sign in (1.0, -1.0):
            near, far = height + sign * self.radius, height + sign * (self.radius + self.high)
            left, right = self.position - self.width / 2, self.position + self.width / 2
            yield ((left, near), (right, near), (right, far), (left, far)), (self.position, (near + far) / 2)

    def symbol(self, height: float, across: Across) -> Iterator[Shape]:
        """Yield the symbol: rectangles with free-standing crosses."""
        arm = _ARM * min(self.high, self.width)
        for corners, (x, y) in self.rectangles(height):
            yield Polyline.straight(across.points(corners), closed=True)
            yield Line(across.point((x - arm, y)), across.point((x + arm, y)))
            yield Line(across.point((x, y - arm)), across.point((x, y + arm)))


def bearing_places(shaft: SteppedShaft, start: float = 0.0) -> Iterator[BearingPlace]:
    """Yield the place of each bearing, its position from `start` (mm); on a shoulder the seat is the thinner side.

    Sections are in true size where the sizes of a bearing are given, else squares.
    """
    for each in shaft.bearings:
        if (ring := each.ring) is not None:
            inner, outer, width = ring
            yield BearingPlace(start + each.position, inner / 2, (outer - inner) / 2, width)
            continue
        around = diameters_within(shaft, each.position - _NEAR, each.position + _NEAR)
        seat = min(around or [shaft.segments[0].outer_diameter])
        yield BearingPlace(start + each.position, seat / 2, _SYMBOL * seat, _SYMBOL * seat)


@dataclass(frozen=True)
class PlacedShaft:
    """A shaft in the section of its pair: where it is and how its gear is placed."""

    seated: SeatedShaft
    gear: Placed

    @property
    def figures(self) -> tuple[ShaftFigure, ...]:
        """The whole shaft; of one that is one piece with its gear what is outside of that."""
        plan, z, height, length = self.seated.plan, self.seated.z, self.gear.height, self.seated.given.length
        if not self.seated.one_piece:
            return (ShaftFigure(plan, 0.0, length, z, height),)
        low, high = self.seated.low - z, self.seated.high - z
        spans = [(start, end) for start, end in ((0.0, low), (high, length)) if end - start > _NEAR]
        return tuple(ShaftFigure(plan, start, end, z, height) for start, end in spans)

    @property
    def bearings(self) -> list[BearingPlace]:
        """Places of the bearings, z of the assembly."""
        return list(bearing_places(self.seated.given, self.seated.z))

    @property
    def middle(self) -> float:
        """Middle of the common face (z of the assembly, mm)."""
        return self.seated.z + self.seated.position

    @property
    def covers(self) -> list[Polygon]:
        """Outlines of the shaft and of the sections of its bearings."""
        sections = [corners for each in self.bearings for corners, _ in each.rectangles(self.gear.height)]
        return [*(each.silhouette for each in self.figures), *sections]

    def shapes(self, across: Across) -> Iterator[Shape]:
        """Yield the shaft, its bearings and its axis."""
        for each in self.figures:
            yield from each.shapes(across)
        if self.seated.one_piece:
            yield from self._hidden_bore(across)
        for bearing in self.bearings:
            yield from bearing.symbol(self.gear.height, across)
        ends = [across.point((self.seated.z + end, self.gear.height)) for end in (0.0, self.seated.given.length)]
        (left, y), (right, _) = sorted(ends)
        yield Line((left - BEYOND_AXIS, y), (right + BEYOND_AXIS, y), Pen.CENTRE)

    def _hidden_bore(self, across: Across) -> Iterator[Line]:
        """Yield the edges of a bore within a gear that is one piece with the shaft, dashed."""
        z = self.seated.z
        for each in _clipped(self.seated.plan.bore, self.seated.low - z, self.seated.high - z):
            if each.radius:
                for side in (1, -1):
                    ends = [(z + end, self.gear.height + side * each.radius) for end in (each.low, each.high)]
                    yield Line(across.point(ends[0]), across.point(ends[1]), Pen.HIDDEN)

    def marks(self, side: Side, clear: float, across: Across, draughting: Draughting) -> Iterator[Candidates]:
        """Yield the dimensions along the shaft: its length, and the distances of ends, bearings and the middle of the face."""
        sign, height, gear = side.outwards, self.gear.height, self.seated.gear
        shaft, start = self.seated.given, self.seated.z
        first, last = (each.radius for each in (self.seated.plan.outside[0], self.seated.plan.outside[-1]))
        ends = {0.0: first, shaft.length: last}
        stations = {each.position: each.radius + each.high for each in bearing_places(shaft)}
        stations = {self.seated.position: gear.tip_diameter / 2, **ends, **stations}
        row = sorted(stations)
        for one, other in [*pairwise(row), (0.0, shaft.length)]:
            points = [across.point((start + each, height + sign * stations[each])) for each in (one, other)]
            size = Size(value=other - one, reference=(one, other) == (0.0, shaft.length) and len(row) > 2)
            yield partial(linear_dimension, points[0], points[1], side, size, draughting, clear=clear)

    def tick(self, side: Side, across: Across) -> Line:
        """Return the centre line over the teeth in the middle of the common face."""
        x, y = across.point((self.middle, self.gear.height + side.outwards * self.seated.gear.tip_diameter / 2))
        return Line((x, y - side.outwards * _TICK), (x, y + side.outwards * _TICK), Pen.CENTRE)


def shafted_section(pair: GearPair, shafts: Sequence[SeatedShaft], items: Mapping[str, int], draughting: Draughting) -> View:
    """Return the section through both axes of a pair on its shafts and bearings, with the distances along the shafts.

    `items` are item numbers by "pinion", "wheel", the names of shafts' files, and these followed by the number of a bearing.
    """
    places = PairPlaces.of(pair)
    gears = {Role.PINION: places.pinion, Role.WHEEL: places.mate}
    placed = [PlacedShaft(each, gears[each.role]) for each in shafts]
    covers = [cover for each in placed for cover in each.covers]
    points = [point for polygon in (*covers, *(c for gear in gears.values() for c in gear.cut.covers)) for point in polygon]
    whole = Box.around(points)
    across = Across(draughting.scale, (whole.left + whole.right) / 2)
    one_piece = {each.role for each in shafts if each.one_piece}
    bodies = [_behind(gear.sectioned, covers, blank=role in one_piece) for role, gear in gears.items()]
    figure = section_figure(bodies, across)
    bare = [gear for role, gear in gears.items() if role not in {each.role for each in shafts}]
    box = Box.around(across.points(((whole.left, whole.bottom), (whole.right, whole.top))))
    figure += Figure.of(*(shape for each in placed for shape in each.shapes(across)), *_axes(bare, across))
    marks: list[Candidates] = []
    for each in placed:
        side, clear = (Side.ABOVE, box.top) if each.seated.role is Role.PINION else (Side.BELOW, box.bottom)
        figure += Figure.of(each.tick(side, across))
        marks += each.marks(side, clear, across, draughting)
    marks.append(partial(_distance, pair, places, box, draughting))
    spots = dict(_spots(gears, placed, items, across))
    right = {number: points for number, points in spots.items() if min(x for x, _ in points) > 0}
    left = {number: points for number, points in spots.items() if number not in right}
    marks += [partial(_numbers, group, box, sides) for group, sides in ((left, _AT_LEFT), (right, _AT_RIGHT)) if group]
    return View("section", figure, tuple(marks))


def _numbers(parts: Mapping[int, Sequence[Point]], box: Box, sides: Sequence[Sequence[Side]]) -> Iterator[Figure]:
    """Yield item numbers on the sides that are best, then on others."""
    yield from balloons(parts, box, sides)
    yield from balloons(parts, box)


def _behind(body: Sectioned, covers: Sequence[Polygon], *, blank: bool) -> Sectioned:
    """Return a gear without the edges that shafts hide, and without hatching where it is one piece with its shaft."""
    cut = replace(body.cut, edges=tuple(visible(body.cut.edges, covers)))
    return replace(body, cut=cut, angle=None if blank else body.angle)


def _axes(gears: Iterable[Placed], across: Across) -> Iterator[Line]:
    """Yield the axes of gears without shafts."""
    for each in gears:
        (left, y), (right, _) = sorted(across.points(((each.extent.left, each.height), (each.extent.right, each.height))))
        yield Line((left - BEYOND_AXIS, y), (right + BEYOND_AXIS, y), Pen.CENTRE)


def _distance(pair: GearPair, places: PairPlaces, box: Box, draughting: Draughting) -> Iterator[Figure]:
    """Yield dimensions of the centre distance at the ends of the axes, with room for item numbers before them."""
    for side, edge in ((Side.RIGHT, box.right), (Side.LEFT, box.left)):
        beyond = edge + side.outwards * BEYOND_AXIS
        low, high = ((beyond, draughting.scale * part.height) for part in (places.mate, places.pinion))
        yield from linear_dimension(low, high, side, distance_size(pair), draughting, clear=beyond + side.outwards * _RING_ROOM)


def _spots(
    gears: Mapping[Role, Placed], shafts: Sequence[PlacedShaft], items: Mapping[str, int], across: Across
) -> Iterator[tuple[int, Sequence[Point]]]:
    """Yield each item number with points on its part, beside axes; of bearings of one item those of all."""
    found: dict[int, list[Point]] = {}
    blank = {each.seated.role for each in shafts if each.seated.one_piece}
    for role, gear in gears.items():
        box = gear.extent
        beside = ((box.left + share * box.width, box.bottom + 0.75 * box.height) for share in (0.5, 0.25, 0.75))
        found[items[role.value]] = (
            [across.point(point) for point in beside] if role in blank else [*dots(gear.cut.areas, across)]
        )
    for each in shafts:
        found[items[each.seated.file]] = [across.point(point) for figure in each.figures for point in figure.middles()]
        for number, bearing in enumerate(each.bearings):
            aside, up = 0.35 * bearing.width, 0.35 * bearing.high  # beside the cross
            middles = [middle for _, middle in bearing.rectangles(each.gear.height)]
            spots = [across.point((x + side * aside, y + up)) for x, y in middles for side in (1, -1)]
            found.setdefault(items[f"{each.seated.file}.{number}"], []).extend(spots)
    yield from found.items()


def shaft_view(plan: TurnedPlan, draughting: Draughting, gear: Sectioned | None = None) -> View:
    """Return a shaft from the side with lengths and diameters, its left end at the left and its axis at height 0.

    `gear` is the section of a gear that is one piece with it, whose z is that from the left end.
    """
    length = plan.shaft.length
    across = Across(draughting.scale, length / 2)
    figures = [ShaftFigure(plan, 0.0, length)]
    pieces = list(plan.outside)
    shapes: list[Shape] = []
    if gear is not None:
        toothed = Box.around(point for polygon in gear.cut.covers for point in polygon)
        spans = [span for span in ((0.0, toothed.left), (toothed.right, length)) if span[1] - span[0] > _NEAR]
        figures = [ShaftFigure(plan, *span) for span in spans]
        body = Cylinder(toothed.top, toothed.left, toothed.right)
        pieces = sorted([body, *(each for figure in figures for each in figure.outside)], key=lambda each: each.low)
        shapes += section_figure([replace(gear, angle=None)], across).shapes
    for figure in figures:
        shapes += figure.shapes(across)
    half = draughting.scale * length / 2
    shapes.append(Line((-half - BEYOND_AXIS, 0.0), (half + BEYOND_AXIS, 0.0), Pen.CENTRE))
    top = draughting.scale * max(each.radius for each in pieces)
    diameters = _diameters(pieces, plan, half, across, draughting, None if gear is None else body)
    marks = [*_lengths(pieces, length, top, across, draughting), *diameters]
    return View("shaft", Figure(tuple(shapes)), (*marks, *_depths(plan, top, across, draughting)))


def _lengths(
    pieces: Sequence[Cylinder], length: float, top: float, across: Across, draughting: Draughting
) -> Iterator[Candidates]:
    """Yield the lengths below: of the whole, and of all pieces but the longest, which follows from them."""
    longest = max(pieces, key=lambda each: (each.high - each.low, -each.low))
    whole = Cylinder(min(pieces[0].radius, pieces[-1].radius), 0.0, length)
    for each in (*(piece for piece in pieces if piece is not longest), whole):
        ends = [across.point((z, -each.radius)) for z in (each.low, each.high)]
        size = Size(value=each.high - each.low)
        yield partial(linear_dimension, ends[0], ends[1], Side.BELOW, size, draughting, clear=-top)


def _diameters(
    pieces: Sequence[Cylinder],
    plan: TurnedPlan,
    half: float,
    across: Across,
    draughting: Draughting,
    toothed: Cylinder | None = None,
) -> Iterator[Candidates]:
    """Yield outer diameters: of the ends beside them, of others at leaders, that of teeth for reference; and those of bores."""
    for number, each in enumerate(pieces):
        size = Size(value=2 * each.radius, prefix="⌀", reference=each is toothed)
        side = {0: Side.LEFT, len(pieces) - 1: Side.RIGHT}.get(number)
        if side is None:
            tip = across.point(((each.low + each.high) / 2, each.radius))
            yield partial(leader, tip, size, draughting, _UP)
        else:
            yield _across_end(each.radius, side, half, size, draughting)
    for index, side in ((0, Side.LEFT), (-1, Side.RIGHT)):
        through = len(plan.bore) == 1 and index == -1
        if plan.bore[index].radius and not through:
            size = Size(value=2 * plan.bore[index].radius, prefix="⌀")
            yield _across_end(plan.bore[index].radius, side, half, size, draughting)
    for each in plan.bore[1:-1]:
        if each.radius:
            tip = across.point(((each.low + each.high) / 2, each.radius))
            yield partial(leader, tip, Size(value=2 * each.radius, prefix="⌀"), draughting, _UP)


def _across_end(radius: float, side: Side, half: float, size: Size, draughting: Draughting) -> Candidates:
    edge = side.outwards * half
    ends = [(edge, sign * draughting.scale * radius) for sign in (-1, 1)]
    return partial(linear_dimension, ends[0], ends[1], side, size, draughting, clear=edge + side.outwards * BEYOND_AXIS)


def _depths(plan: TurnedPlan, top: float, across: Across, draughting: Draughting) -> Iterator[Candidates]:
    """Yield above the depths of the steps of bores, from the end that they reach."""
    length = plan.shaft.length
    from_left = True
    for one, other in pairwise(plan.bore):
        from_left = from_left and one.radius > 0
        base = 0.0 if from_left else length
        radius = max(one.radius, other.radius)
        ends = sorted((base, one.high))
        points = [across.point((z, radius)) for z in ends]
        size = Size(value=ends[1] - ends[0])
        yield partial(linear_dimension, points[0], points[1], Side.ABOVE, size, draughting, clear=top)
