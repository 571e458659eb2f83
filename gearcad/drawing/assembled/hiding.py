"""What of a line polygons hide: the line in pieces, each before, on, or within them. Lengths in any one unit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from enum import Enum
from itertools import pairwise

from gearcad.drawing.shapes import Point

__all__ = ["Polygon", "Segment", "Where", "distance", "pieces", "visible", "within"]

Polygon = tuple[Point, ...]
"""Its corners in turn, the last joined to the first."""

Segment = tuple[Point, Point]

_NEAR = 1e-6
"""How near to an edge (mm) is on it."""


class Where(Enum):
    """Where a piece of a line is."""

    OUTSIDE = "outside"
    EDGE = "edge"
    """Along an edge of a polygon, within none."""

    INSIDE = "inside"


def pieces(segment: Segment, polygons: Sequence[Polygon]) -> Iterator[tuple[Segment, Where]]:
    """The pieces of a segment from its start on, neighbours of one kind as one."""
    near = [each for each in polygons if _may_meet(segment, each)]
    stops = sorted({0.0, 1.0, *(stop for polygon in near for stop in _stops(segment, polygon))})
    begin, last = 0.0, None
    for low, high in pairwise(stops):
        where = _where(_at(segment, (low + high) / 2), near)
        if last is not None and where is not last:
            yield (_at(segment, begin), _at(segment, low)), last
            begin = low
        last = where
    if last is not None:
        yield (_at(segment, begin), segment[1]), last


def visible(segments: Iterable[Segment], covers: Sequence[Polygon]) -> Iterator[Segment]:
    """What covers leave of segments behind them; along their edges nothing: these are drawn."""
    for segment in segments:
        yield from (piece for piece, where in pieces(segment, covers) if where is Where.OUTSIDE)


def _at(segment: Segment, share: float) -> Point:
    (x, y), (to_x, to_y) = segment
    return x + share * (to_x - x), y + share * (to_y - y)


def _edges(polygon: Polygon) -> Iterator[Segment]:
    return pairwise((*polygon, polygon[0]))


def _may_meet(segment: Segment, polygon: Polygon) -> bool:
    """Whether their boxes touch."""
    return all(
        min(one[axis] for one in segment) <= max(one[axis] for one in polygon) + _NEAR
        and min(one[axis] for one in polygon) <= max(one[axis] for one in segment) + _NEAR
        for axis in (0, 1)
    )


def _stops(segment: Segment, polygon: Polygon) -> Iterator[float]:
    """Where along a segment (0 to 1) it crosses edges, or corners lie on it."""
    (x, y), (to_x, to_y) = segment
    way = to_x - x, to_y - y
    length = math.hypot(*way)
    if length < _NEAR:
        return
    for (a, b), (to_a, to_b) in _edges(polygon):
        edge = to_a - a, to_b - b
        cross = way[0] * edge[1] - way[1] * edge[0]
        if abs(cross) > _NEAR * length:
            along = ((a - x) * edge[1] - (b - y) * edge[0]) / cross
            across = ((a - x) * way[1] - (b - y) * way[0]) / cross
            if _NEAR < along * length < length - _NEAR and -_NEAR <= across <= 1 + _NEAR:
                yield along
        elif abs((a - x) * way[1] - (b - y) * way[0]) <= _NEAR * length:
            for corner in ((a, b), (to_a, to_b)):
                along = ((corner[0] - x) * way[0] + (corner[1] - y) * way[1]) / length**2
                if _NEAR < along * length < length - _NEAR:
                    yield along


def _where(point: Point, polygons: Sequence[Polygon]) -> Where:
    on_edge = False
    for polygon in polygons:
        if any(distance(point, edge) <= _NEAR for edge in _edges(polygon)):
            on_edge = True
        elif within(point, polygon):
            return Where.INSIDE
    return Where.EDGE if on_edge else Where.OUTSIDE


def distance(point: Point, edge: Segment) -> float:
    """Of a point from a segment."""
    (x, y), (to_x, to_y) = edge
    way = to_x - x, to_y - y
    square = way[0] ** 2 + way[1] ** 2
    share = 0.0 if not square else max(0.0, min(1.0, ((point[0] - x) * way[0] + (point[1] - y) * way[1]) / square))
    return math.dist(point, (x + share * way[0], y + share * way[1]))


def within(point: Point, polygon: Polygon) -> bool:
    """Whether a point is in a polygon: a ray to the right crosses its edges an odd number of times."""
    x, y = point
    crossed = [
        (to_x - from_x) * (y - from_y) / (to_y - from_y) + from_x > x
        for (from_x, from_y), (to_x, to_y) in _edges(polygon)
        if (from_y > y) is not (to_y > y)
    ]
    return sum(crossed) % 2 == 1
