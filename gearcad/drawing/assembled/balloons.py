"""Balloons: item numbers in rings, each with a leader that ends in a dot on its part (ISO 6433). Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from gearcad.drawing.assembled.hiding import Polygon, within
from gearcad.drawing.assembled.section import Across
from gearcad.drawing.marks import Side
from gearcad.drawing.shapes import Anchor, Box, Circle, Figure, Line, Pen, Point, Polyline, Text

__all__ = ["balloons", "dots"]

_RADIUS = 5.0
_APART = 2 * _RADIUS + 2.5
"""Least distance of the middles of two rings in a row."""

_DOT = 0.25
"""Radius of a circle whose line fills it."""

_OUT = (14.0, 24.0, 36.0, 50.0)
"""From the outlines to the row of rings."""

_SLANTS = (6.0, -6.0, 12.0, -12.0, 0.0, 20.0, -20.0, 30.0, -30.0)
"""How far along its side a ring stands from its dot if it can: leaders should be neither level nor upright."""

_SIDES = ((Side.LEFT, Side.ABOVE), (Side.LEFT,), (Side.ABOVE,), (Side.LEFT, Side.RIGHT, Side.ABOVE), (Side.RIGHT,))

_PLACES = ((0.5, 0.5), (0.25, 0.5), (0.75, 0.5), (0.5, 0.75), (0.5, 0.25), (0.1, 0.5), (0.9, 0.5))
"""Where in the box of an area a dot may be."""


def dots(areas: Sequence[Polygon], across: Across) -> tuple[Point, ...]:
    """Points on paper in areas of a section."""
    found = []
    for area in areas:
        box = Box.around(area)
        points = ((box.left + x * box.width, box.bottom + y * box.height) for x, y in _PLACES)
        found += [across.point(point) for point in points if within(point, area)]
    return tuple(found)


def balloons(parts: Mapping[int, Sequence[Point]], around: Box) -> Iterator[Figure]:
    """All item numbers of a view beside its outlines, in rows that clear each other; by ways that are best first.

    `parts` has points on each part by its item number, `around` is the box of the outlines.
    """
    for out in _OUT:
        for sides in _SIDES:
            for slant in _SLANTS:
                yield _in_rows(parts, around, sides, slant, out)


def _in_rows(parts: Mapping[int, Sequence[Point]], around: Box, sides: Sequence[Side], slant: float, out: float) -> Figure:
    """Each number on the side that is nearest to a point of its part."""
    rows: dict[Side, list[tuple[float, int, Point]]] = {}
    for number, points in parts.items():
        depths = [(abs(_edge(around, side) - side.out(dot)), order, dot) for order, side in enumerate(sides) for dot in points]
        _, order, dot = min(depths, key=lambda each: (round(each[0], 3), each[1], -each[2][1]))
        rows.setdefault(sides[order], []).append((sides[order].along(dot), number, dot))
    figure = Figure()
    for side, row in rows.items():
        row.sort()
        level = _edge(around, side) + side.outwards * out
        for (_, number, dot), along in zip(row, _spread([along + slant for along, _, _ in row]), strict=True):
            figure += _drawn(str(number), dot, side.point(along, level))
    return figure


def _spread(wanted: Sequence[float]) -> list[float]:
    """Places in a row, rising as those wanted do, far enough apart, and on the mean where those are."""
    places: list[float] = []
    for each in wanted:
        places.append(max(each, places[-1] + _APART) if places else each)
    back = sum(place - each for place, each in zip(places, wanted, strict=True)) / len(places)
    return [place - back for place in places]


def _edge(box: Box, side: Side) -> float:
    return {Side.LEFT: box.left, Side.RIGHT: box.right, Side.ABOVE: box.top, Side.BELOW: box.bottom}[side]


def _drawn(number: str, dot: Point, ring: Point) -> Figure:
    share = 1.0 - _RADIUS / math.dist(dot, ring)
    end = dot[0] + share * (ring[0] - dot[0]), dot[1] + share * (ring[1] - dot[1])
    return Figure.of(
        Circle(dot, _DOT, Pen.OUTLINE),
        Line(dot, end, Pen.SYMBOL),
        Polyline(((ring[0] - _RADIUS, ring[1], 1.0), (ring[0] + _RADIUS, ring[1], 1.0)), Pen.SYMBOL, closed=True),
        Text(number, ring, 5.0, Anchor.MIDDLE, pen=Pen.TEXT),
    )
