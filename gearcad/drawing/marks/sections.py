"""Where a section is cut, and what views are called (ISO 128-3). Lengths in mm of paper."""

from __future__ import annotations

from gearcad.drawing.marks.arrows import arrow
from gearcad.drawing.marks.side import Side
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Point, Shape, Text

__all__ = ["section_arrows", "view_label"]

_STROKE, _STEM = 8.0, 9.0


def section_arrows(start: Point, end: Point, looking: Side, letter: str = "A") -> Figure:
    """Thick ends of the cutting line from `start` to `end`, arrows the way one looks, and the letter beside each.

    The line is vertical where one looks to the left or right, horizontal otherwise; `start` and `end` are outside the outline.
    """
    shapes: list[Shape] = []
    across = looking.value
    length = abs(end[0] - start[0]) + abs(end[1] - start[1])
    along = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    for point, way in ((start, -1.0), (end, 1.0)):
        tail = point[0] + way * _STROKE * along[0], point[1] + way * _STROKE * along[1]
        shapes.append(Line(point, tail, Pen.OUTLINE))
        tip = point[0] + way * _STROKE / 2 * along[0], point[1] + way * _STROKE / 2 * along[1]
        foot = tip[0] - _STEM * across[0], tip[1] - _STEM * across[1]
        shapes += [Line(foot, tip, Pen.SYMBOL), arrow(tip, across, Pen.SYMBOL)]
        place = foot[0] + 4.0 * way * along[0], foot[1] + 4.0 * way * along[1]
        shapes.append(Text(letter, place, 5.0, Anchor.MIDDLE, pen=Pen.TEXT))
    return Figure(tuple(shapes))


def view_label(words: str, above: Point, height: float = 5.0) -> Figure:
    """The name of a view ("A–A", "X (5:1)") over it: the middle of its line at a point."""
    return Figure.of(Text(words, above, height, Anchor.CENTRE, pen=Pen.TEXT))
