"""Balloons: item numbers in rings, each with a leader that ends in a dot on its part (ISO 6433). Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, permutations, product
from typing import NamedTuple

from gearcad.drawing.assembled.hiding import Polygon, Segment, distance, within
from gearcad.drawing.assembled.section import Across
from gearcad.drawing.marks import Side
from gearcad.drawing.shapes import Anchor, Box, Circle, Figure, Line, Pen, Point, Polyline, Text

__all__ = ["balloons", "dots"]

_RADIUS = 5.0
_APART = 2 * _RADIUS + 2.5
"""Least distance of the middles of two rings in a row."""

_DOT = 0.25
"""Radius of a circle whose line fills it."""

_OUT = (14.0, 24.0, 36.0, 50.0, 80.0)
"""From the outlines to the row of rings."""

_MOST = 40
"""So many ways are offered on which leaders cross."""

_ROUNDING = 1e-6

_SLANTS = (6.0, -6.0, 12.0, -12.0, 20.0, -20.0)
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
        inside = [point for point in points if within(point, area)]
        found += across.points(inside or area[:1])
    return tuple(found)


def balloons(parts: Mapping[int, Sequence[Point]], around: Box) -> Iterator[Figure]:
    """All item numbers of a view beside its outlines, in rows that clear each other; by ways that are best first.

    `parts` has points on each part by its item number, `around` is the box of the outlines.
    """
    ways = (_in_rows(parts, around, *way) for way in product(_OUT, _SIDES, _SLANTS))
    crossing: list[tuple[int, list[_Balloon]]] = []
    for way in (way for way in ways if not _hit(way)):
        if crossings := _crossings(way):
            crossing.append((crossings, way))
        else:
            yield _drawn(way)
    for _, way in sorted(crossing, key=lambda each: each[0])[:_MOST]:
        yield _drawn(way)


class _Balloon(NamedTuple):
    """An item number, the point on its part, the middle of its ring."""

    number: int
    dot: Point
    ring: Point


def _in_rows(
    parts: Mapping[int, Sequence[Point]], around: Box, out: float, sides: Sequence[Side], slant: float
) -> list[_Balloon]:
    """Each number on the side that is nearest to a point of its part."""
    rows: dict[Side, list[tuple[float, int, Point]]] = {}
    for number, points in parts.items():
        depths = [(abs(_edge(around, side) - side.out(dot)), order, dot) for order, side in enumerate(sides) for dot in points]
        _, order, dot = min(depths, key=lambda each: (round(each[0], 3), each[1], -each[2][1]))
        rows.setdefault(sides[order], []).append((sides[order].along(dot), number, dot))
    found = []
    for side, row in rows.items():
        row.sort()
        level = _edge(around, side) + side.outwards * out
        places = _spread([along + slant for along, _, _ in row])
        found += [_Balloon(number, dot, side.point(along, level)) for (_, number, dot), along in zip(row, places, strict=True)]
    return found


def _spread(wanted: Sequence[float]) -> list[float]:
    """Places in a row, rising as those wanted do, far enough apart, and on the mean where those are."""
    places: list[float] = []
    for each in wanted:
        places.append(max(each, places[-1] + _APART) if places else each)
    back = sum(place - each for place, each in zip(places, wanted, strict=True)) / len(places)
    return [place - back for place in places]


def _hit(way: Sequence[_Balloon]) -> bool:
    """Whether a leader would run into the ring of another, or rings of two rows into each other."""
    return any(
        math.dist(one.ring, other.ring) < _APART - _ROUNDING or distance(other.ring, (one.dot, one.ring)) < _RADIUS + 1.0
        for one, other in permutations(way, 2)
    )


def _crossings(way: Sequence[_Balloon]) -> int:
    """How many leaders cross."""
    return sum(_cross((one.dot, one.ring), (other.dot, other.ring)) for one, other in combinations(way, 2))


def _cross(one: Segment, other: Segment) -> bool:
    """Whether the ends of each are on both sides of the other."""
    return all(_side(line, across[0]) * _side(line, across[1]) < 0 for line, across in ((one, other), (other, one)))


def _side(line: Segment, point: Point) -> float:
    """Positive at the left of a line."""
    (x, y), (to_x, to_y) = line
    return (to_x - x) * (point[1] - y) - (to_y - y) * (point[0] - x)


def _edge(box: Box, side: Side) -> float:
    return {Side.LEFT: box.left, Side.RIGHT: box.right, Side.ABOVE: box.top, Side.BELOW: box.bottom}[side]


def _drawn(way: Sequence[_Balloon]) -> Figure:
    return Figure.of(*(_drawn_one(*balloon) for balloon in way))


def _drawn_one(number: int, dot: Point, ring: Point) -> Figure:
    share = 1.0 - _RADIUS / math.dist(dot, ring)
    end = dot[0] + share * (ring[0] - dot[0]), dot[1] + share * (ring[1] - dot[1])
    return Figure.of(
        Circle(dot, _DOT, Pen.OUTLINE),
        Line(dot, end, Pen.SYMBOL),
        Polyline(((ring[0] - _RADIUS, ring[1], 1.0), (ring[0] + _RADIUS, ring[1], 1.0)), Pen.SYMBOL, closed=True),
        Text(str(number), ring, 5.0, Anchor.MIDDLE, pen=Pen.TEXT),
    )
