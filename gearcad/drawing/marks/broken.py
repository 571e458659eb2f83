"""Where a view ends though the part goes on: freehand lines, and straight ones with zigzags (ISO 128-2, 01.1). mm of paper."""

from __future__ import annotations

import math
from itertools import pairwise

from gearcad.drawing.shapes import Pen, Point, Polyline, Vertex

__all__ = ["freehand", "zigzag"]

_WAVE = 4.0
"""Length of half a wave, more where a line would have more than `_MOST` of them: it is then longer than any paper."""

_MOST = 1000

_BULGE = 0.22
"""Of each half: some half a millimetre off the path."""

_TOOTH = 2.0
"""Half the height of a zigzag, and twice its width."""


def freehand(path: list[Point], *, closed: bool = False) -> Polyline:
    """A thin wavy line along a path of straight pieces; a closed one ends where it begins."""
    row = [*path, path[0]] if closed else path
    wave = max(_WAVE, sum(math.dist(*piece) for piece in pairwise(row)) / _MOST)
    vertices: list[Vertex] = []
    for (x, y), (to_x, to_y) in pairwise(row):
        halves = max(1, round(math.dist((x, y), (to_x, to_y)) / wave))
        for i in range(halves):
            side = -1 if len(vertices) % 2 else 1
            vertices.append((x + (to_x - x) * i / halves, y + (to_y - y) * i / halves, side * _BULGE))
    if not closed:
        vertices.append((*row[-1], 0.0))
    return Polyline(tuple(vertices), Pen.THIN, closed)


def zigzag(start: Point, end: Point) -> Polyline:
    """A thin straight line with a zigzag in its middle."""
    length = math.dist(start, end)
    along = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
    high = min(_TOOTH, length / 4)

    def at(place: float, aside: float) -> Point:
        """`place` from the start, `aside` to the left."""
        return start[0] + along[0] * place - along[1] * aside, start[1] + along[1] * place + along[0] * aside

    middle = length / 2
    steps = [
        (0.0, 0.0),
        (middle - high / 2, 0.0),
        (middle - high / 4, high),
        (middle + high / 4, -high),
        (middle + high / 2, 0.0),
    ]
    return Polyline.straight([at(*step) for step in (*steps, (length, 0.0))], Pen.THIN)
