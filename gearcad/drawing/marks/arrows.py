"""Arrows of dimensions and leaders: closed, filled, 15 degrees (ISO 129-1). Lengths in mm of paper."""

from __future__ import annotations

import math

from gearcad.drawing.shapes import Filled, Pen, Point

__all__ = ["ARROW", "arrow"]

ARROW = 3.2
"""Length of an arrow."""

_HALF_WIDTH = ARROW * math.tan(math.radians(7.5))


def arrow(tip: Point, way: Point, pen: Pen = Pen.DIMENSION) -> Filled:
    """One with its tip at a point; `way` is where it points to (of any length but zero)."""
    length = math.hypot(*way)
    along, up = way[0] / length, way[1] / length
    base = tip[0] - ARROW * along, tip[1] - ARROW * up
    side = -_HALF_WIDTH * up, _HALF_WIDTH * along
    return Filled((tip, (base[0] + side[0], base[1] + side[1]), (base[0] - side[0], base[1] - side[1])), pen)
