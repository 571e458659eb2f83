"""Views of shafts with lengths and diameters, and the symbols of bearings.

Solid shafts are not cut lengthways (ISO 128-3); of hollow ones the upper half is. Bearings have the general simplified symbol
of ISO 8826-1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from gearcad.drawing.dimensions import Side, leader, linear_dimension
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.shapes import Box, Figure, Hatching, Line, Pen, Point, Polyline, Shape
from gearcad.drawing.views.assembly_figures import (
    BEYOND_AXIS,
    Across,
    Polygon,
    Sectioned,
    section_figure,
)
from gearcad.drawing.words import Draughting, Size
from gearcad.shafts.beam import SteppedShaft
from gearcad.solids.shaft_plan import Cylinder, TurnedPlan, diameters_within

_HATCHING = 45.0
_SPACING = 2.5
"""Distance of hatching lines (mm of paper)."""

_SYMBOL = 0.45
"""Side of the square of a bearing whose size is not known, over the diameter of its seat."""

_ARM = 0.3
"""Half the length of the lines of the cross in it, over its shorter side: they do not touch it."""

NEAR = 1e-6
"""Length (mm) below which a stretch is none, and distance to both sides of a bearing at which its seat is taken."""

_UP = (75.0, 105.0, 60.0, 120.0, 45.0, 135.0)
"""Directions of leaders from the upper edge of a shaft."""


def clipped(cylinders: Sequence[Cylinder], low: float, high: float) -> list[Cylinder]:
    """Return the parts of cylinders between two positions (mm)."""
    found = (Cylinder(each.radius, max(each.low, low), min(each.high, high)) for each in cylinders)
    return [each for each in found if each.high - each.low > NEAR]


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
        return clipped(self.plan.outside, self.low, self.high)

    @property
    def bore(self) -> list[Cylinder]:
        """Cylinders of the bore within the stretch, radius 0 where there is none."""
        return clipped(self.plan.bore, self.low, self.high)

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
        around = diameters_within(shaft, each.position - NEAR, each.position + NEAR)
        seat = min(around or [shaft.segments[0].outer_diameter])
        yield BearingPlace(start + each.position, seat / 2, _SYMBOL * seat, _SYMBOL * seat)


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
        spans = [span for span in ((0.0, toothed.left), (toothed.right, length)) if span[1] - span[0] > NEAR]
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
