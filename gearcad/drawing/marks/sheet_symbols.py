"""The symbol beside the title block: method of projection (ISO 5456-2). Lengths in mm of paper."""

from __future__ import annotations

from gearcad.drawing.marks.centres import centre_line
from gearcad.drawing.options import Projection
from gearcad.drawing.shapes import Circle, Figure, Pen, Point, Polyline

__all__ = ["projection_symbol"]


def projection_symbol(projection: Projection, at: Point = (0.0, 0.0), *, height: float = 8.0) -> Figure:
    """A truncated cone from its side and from its small end; its left end, on the axis, at `at`.

    First angle: the cone at the left with its small end at the left, its rings at the right; third angle: they at the left.
    """
    big, small, length, air = height / 2, height / 4, height, 0.5 * height
    over = 0.25 * height
    cone_left, rings = over, over + length + air + big
    if projection is Projection.THIRD:
        cone_left, rings = over + 2 * big + air, over + big
    corners = [(cone_left, -small), (cone_left, small), (cone_left + length, big), (cone_left + length, -big)]
    width = length + air + 2 * big + 2 * over
    return Figure.of(
        Polyline.straight(corners, Pen.SYMBOL, closed=True),
        Circle((rings, 0.0), big, Pen.SYMBOL),
        Circle((rings, 0.0), small, Pen.SYMBOL),
        centre_line((0.0, 0.0), (rings, 0.0), (width, 0.0)),
        centre_line((rings, -big - over), (rings, 0.0), (rings, big + over)),
    ).moved(*at)
