"""The symbol beside the title block: method of projection (ISO 5456-2). Lengths in mm of paper."""

from __future__ import annotations

from gearcad.drawing.options import Projection
from gearcad.drawing.shapes import Circle, Figure, Line, Pen, Point, Polyline, Shape

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
    shapes: tuple[Shape, ...] = (
        Polyline.straight(corners, Pen.SYMBOL, closed=True),
        Circle((rings, 0.0), big, Pen.SYMBOL),
        Circle((rings, 0.0), small, Pen.SYMBOL),
        Line((0.0, 0.0), (width, 0.0), Pen.CENTRE),
        Line((rings, -big - over), (rings, big + over), Pen.CENTRE),
    )
    return Figure(shapes).moved(*at)
