"""Section through the axes of a pair on its shafts and bearings, with the distances along the shafts.

Heights are in mm over the axis of the wheel, z is that of the assembly, to the right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from gearcad.core.records import Role
from gearcad.drawing.dimensions import Side, linear_dimension
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.shapes import Box, Figure, Line, Pen, Point, Shape
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
from gearcad.drawing.views.shaft_views import NEAR, BearingPlace, ShaftFigure, bearing_places, clipped
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import GearPair
from gearcad.solids.shaft_plan import SeatedShaft

_AT_LEFT, _AT_RIGHT = ((Side.LEFT,),), ((Side.RIGHT,),)
"""Sides of the rows of item numbers of parts at the left and at the right, best first."""

_RING_ROOM = 14.0
"""Room for a row of item numbers between the ends of the axes and the centre distance (mm of paper)."""

_TICK = 4.0
"""Length of the centre line in the middle of the face beyond the teeth (mm of paper)."""


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
        spans = [(start, end) for start, end in ((0.0, low), (high, length)) if end - start > NEAR]
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
        for each in clipped(self.seated.plan.bore, self.seated.low - z, self.seated.high - z):
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
