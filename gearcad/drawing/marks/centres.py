"""Centre lines that cross: where they do, they have dashes, for dashes begin there (ISO 128-2). Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from gearcad.drawing.shapes import Arc, Box, Circle, Figure, Line, Pen, Point

__all__ = ["centre_circle", "centre_cross", "centre_line", "centre_star"]

_ON_LINE = 1e-6
"""mm from a line that are none."""


def centre_line(*points: Point) -> Figure:
    """A line from the first to the last of points in a row; others cross it at all between."""
    pieces = list(pairwise(points))
    if len(pieces) > 1:  # the first one too begins at the crossing
        pieces[0] = pieces[0][::-1]
    return Figure(tuple(Line(*piece, Pen.CENTRE) for piece in pieces))


def centre_cross(centre: Point, reach: float) -> Figure:
    """A level and an upright line, so far to each side of a centre."""
    x, y = centre
    return centre_line((x - reach, y), centre, (x + reach, y)) + centre_line((x, y - reach), centre, (x, y + reach))


def centre_star(box: Box, places: Sequence[Point], half: float) -> Figure:
    """A level and an upright line through the origin to the sides of a box, and radial ones `half` to each side of places.

    A place on one of the two has no line of its own.
    """
    level, upright = ([(0.0, 0.0), *(each for each in places if abs(each[axis]) <= _ON_LINE)] for axis in (1, 0))
    figure = centre_line((box.left, 0.0), *sorted(level), (box.right, 0.0))
    figure += centre_line((0.0, box.bottom), *sorted(upright, key=lambda each: each[1]), (0.0, box.top))
    for x, y in places:
        if min(abs(x), abs(y)) > _ON_LINE:
            inner, outer = (1 + side * half / math.hypot(x, y) for side in (-1, 1))
            figure += centre_line((inner * x, inner * y), (x, y), (outer * x, outer * y))
    return figure


def centre_circle(radius: float, places: Iterable[Point]) -> Figure:
    """A circle about the origin, on which there are places where others cross it."""
    turns = sorted(math.degrees(math.atan2(y, x)) for x, y in places)
    if len(turns) < 2:
        return Figure.of(Circle((0.0, 0.0), radius, Pen.CENTRE))
    return Figure(tuple(Arc((0.0, 0.0), radius, *ends, Pen.CENTRE) for ends in pairwise([*turns, turns[0]])))
