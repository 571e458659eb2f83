"""Symbols beside the title block: method of projection (ISO 5456-2), edges (ISO 13715). Lengths in mm of paper."""

from __future__ import annotations

from gearcad.drawing.options import Projection
from gearcad.drawing.shapes import Circle, Figure, Line, Pen, Point, Polyline, Shape, Text

__all__ = ["edge_symbol", "projection_symbol"]


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


def edge_symbol(outer: str, inner: str, at: Point = (0.0, 0.0), *, height: float = 3.5) -> Figure:
    """Edges of undefined shape: a step with an outer and an inner corner, and a symbol with its limit ("−0.3") at each.

    The lower left corner of the step at `at`.
    """
    step, arm, lead = 2.5 * height, 1.5 * height, 0.6 * height
    outline = Polyline.straight([(0.0, step), (step, step), (step, 0.0), (step + 3.5 * height, 0.0)], Pen.OUTLINE)
    marks = (_edge_mark((step, up), lead, limit, arm, height) for up, limit in ((step, outer), (0.0, inner)))
    return Figure.of(outline, *marks).moved(*at)


def _edge_mark(corner: Point, lead: float, limit: str, arm: float, height: float) -> Figure:
    """A short line from the corner, and the two arms that hold the limit."""
    across, up = corner[0] + lead, corner[1] + lead
    return Figure.of(
        Line(corner, (across, up), Pen.SYMBOL),
        Polyline.straight([(across, up + arm), (across, up), (across + arm, up)], Pen.SYMBOL),
        Text(limit, (across + 0.4 * height, up + 0.35 * height), height),
    )
