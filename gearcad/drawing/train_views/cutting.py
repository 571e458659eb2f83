"""Where a bent section is cut: from the axis up, and along another radius (ISO 128-3). Lengths in mm of paper."""

from __future__ import annotations

import math

from gearcad.drawing.marks import arrow, centre_line
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Point, Shape, Text

__all__ = ["LETTER", "cutting_line"]

LETTER = "A"

_STROKE, _CORNER, _STEM = 8.0, 4.0, 9.0


def cutting_line(turn: float, distance: float, reach: float, looking: int) -> Figure:
    """Thick ends at `reach` from the axis: above it, and in the direction `turn` (radians); a thick corner at the axis.

    At a `distance` along that direction is the axis of a planet, whose centre line this is too. `looking` is -1 to the left,
    1 to the right: where one looks at the upper half, the other one being turned into its plane.
    """
    shapes: list[Shape] = []
    for angle, side in ((math.pi / 2, 1.0), (turn, -1.0)):
        way = math.cos(angle), math.sin(angle)
        across = looking * side * way[1], -looking * side * way[0]
        shapes += _end(way, across, reach)
        shapes.append(Line((0.0, 0.0), _along(way, _CORNER), Pen.OUTLINE))
        if side < 0:
            shapes += centre_line(_along(way, _CORNER), _along(way, distance), _along(way, reach)).shapes
    return Figure(tuple(shapes))


def _end(way: Point, across: Point, reach: float) -> list[Shape]:
    """A thick end, the arrow at it, and the letter beside the arrow."""
    tip = _along(way, reach + _STROKE / 2)
    foot = tip[0] - _STEM * across[0], tip[1] - _STEM * across[1]
    place = foot[0] + 5.0 * way[0], foot[1] + 5.0 * way[1]
    return [
        Line(_along(way, reach), _along(way, reach + _STROKE), Pen.OUTLINE),
        Line(foot, tip, Pen.SYMBOL),
        arrow(tip, across, Pen.SYMBOL),
        Text(LETTER, place, 5.0, Anchor.MIDDLE, pen=Pen.TEXT),
    ]


def _along(way: Point, by: float) -> Point:
    return by * way[0], by * way[1]
