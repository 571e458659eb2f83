"""Linear dimensions (ISO 129-1): lanes beside an outline, texts within, beside or above the line. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.drawing.marks.arrows import ARROW, arrow
from gearcad.drawing.marks.side import Side
from gearcad.drawing.marks.size_text import cad_words, written_size
from gearcad.drawing.marks.written import Written
from gearcad.drawing.shapes import Anchor, Dimension, Figure, Line, Measured, Pen, Point, Shape
from gearcad.drawing.words import Draughting, Size

__all__ = ["FIRST_LANE", "LANE_PITCH", "half_dimension", "linear_dimension"]

FIRST_LANE = 10.0
"""From the outline to the first dimension line."""

LANE_PITCH = 8.5
"""From one dimension line to the next."""

_LANES = 9
_GAP, _BEYOND = 0.8, 1.5
"""Of extension lines: before they begin, and past the dimension line."""

_LIFT = 0.9
"""From the dimension line to the text above it."""

_TAIL = 3.0
"""Of a line behind an arrow that points at it from outside."""

_PAST_AXIS = 6.0
"""How far the line of a half dimension goes past the axis."""

_SHIFTS = (0.0, 0.6, -0.6)
"""Where along its line a text may stand, over the room that it has on either side of the middle."""


def linear_dimension(
    first: Point, second: Point, side: Side, size: Size, draughting: Draughting, *, clear: float
) -> Iterator[Figure]:
    """A size between two points, its line vertical (LEFT, RIGHT) or horizontal, in lanes outwards from `clear`.

    `clear` is where the outline ends on that side: an x for LEFT and RIGHT, a y for ABOVE and BELOW. What is too narrow has
    arrows from outside, and its text beside.
    """
    drawn = _Drawn(first, second, side, size, draughting)
    for lane in range(_LANES):
        yield from drawn.in_lane(clear + side.outwards * (FIRST_LANE + lane * LANE_PITCH))


def half_dimension(
    edge: Point, axis: float, side: Side, size: Size, draughting: Draughting, *, clear: float
) -> Iterator[Figure]:
    """A diameter of which only one edge is seen, as on half sections: one arrow, the line goes past the axis.

    `axis` is the axis' y for LEFT and RIGHT, its x for ABOVE and BELOW; the other edge is taken opposite.
    """
    opposite = side.point(2 * axis - side.along(edge), side.out(edge))
    drawn = _Drawn(edge, opposite, side, size, draughting)
    for lane in range(_LANES):
        yield from drawn.half_in_lane(clear + side.outwards * (FIRST_LANE + lane * LANE_PITCH), axis)


@dataclass(frozen=True)
class _Drawn:
    """A dimension to be drawn in one of many lanes."""

    first: Point
    second: Point
    side: Side
    size: Size
    draughting: Draughting

    @property
    def text(self) -> Written:
        return written_size(self.size, self.draughting.words)

    def in_lane(self, out: float) -> Iterator[Figure]:
        """All ways in one lane, best first."""
        low, high = sorted(map(self.side.along, (self.first, self.second)))
        text = self.text
        inside = high - low >= 2 * ARROW + 1.0
        room = high - low - (2 * ARROW + 1.0 if inside else 0.8) - text.width
        extensions = [self._extension(self.first, out), self._extension(self.second, out)]
        tail = 0.0 if inside else ARROW + _TAIL
        arrows = self._arrows(low, high, out, 1.0 if inside else -1.0)
        if room >= 0:
            line = self._line(low - tail, high + tail, out)
            for shift in _SHIFTS if room > 4 else _SHIFTS[:1]:
                yield self._figure(out, [line, *arrows, *extensions], text, (low + high + shift * room) / 2)
        else:
            past = max(tail, _BEYOND) + 1.0
            reach = past + text.width
            line = self._line(low - tail, high + reach, out)
            yield self._figure(out, [line, *arrows, *extensions], text, high + past + text.width / 2)
            line = self._line(low - reach, high + tail, out)
            yield self._figure(out, [line, *arrows, *extensions], text, low - past - text.width / 2)

    def half_in_lane(self, out: float, axis: float) -> Iterator[Figure]:
        """All ways in one lane, best first: the text on the edge's side, then where it needs more of the line."""
        edge, text = self.side.along(self.first), self.text
        way = 1.0 if edge > axis else -1.0
        inside = abs(edge - axis) + _PAST_AXIS >= ARROW + 1.0
        arrows = [arrow(self.side.point(edge, out), self.side.point(way if inside else -way, 0.0))]
        begin = edge if inside else edge + way * (ARROW + _TAIL)
        room = abs(edge - axis) - ARROW - 1.0 - text.width
        middle = edge - way * (ARROW + 0.5 + max(0.0, room / 2) + text.width / 2)
        past = max(_PAST_AXIS, (axis - (middle - way * (text.width / 2 + 0.5))) * way)
        shapes = [self._line(begin, axis - way * past, out), *arrows, self._extension(self.first, out)]
        yield self._figure(out, shapes, text, middle)
        begin = edge + way * (ARROW + _TAIL + text.width)
        shapes = [
            self._line(begin, axis - way * _PAST_AXIS, out),
            arrow(self.side.point(edge, out), self.side.point(-way, 0.0)),
            self._extension(self.first, out),
        ]
        yield self._figure(out, shapes, text, begin - way * text.width / 2)

    def _line(self, low: float, high: float, out: float) -> Line:
        return Line(self.side.point(low, out), self.side.point(high, out), Pen.DIMENSION)

    def _arrows(self, low: float, high: float, out: float, way: float) -> list[Shape]:
        """`way` 1: from within, -1: from outside."""
        ends = ((low, -way), (high, way))
        return [arrow(self.side.point(along, out), self.side.point(towards, 0.0)) for along, towards in ends]

    def _extension(self, point: Point, out: float) -> Line:
        """From the measured point to a little past the dimension line."""
        along, start = self.side.along(point), self.side.out(point)
        way = 1.0 if out > start else -1.0
        end = out + way * _BEYOND
        begin = start + way * min(_GAP, abs(out - start) / 2)
        return Line(self.side.point(along, begin), self.side.point(along, end), Pen.DIMENSION)

    def _figure(self, out: float, shapes: list[Shape], text: Written, middle: float) -> Figure:
        """With the text above the line: of vertical ones to its left, read from the right."""
        lift = _LIFT + text.below
        upright = self.side.is_upright
        place = (out - lift, middle) if upright else (middle, out + lift)
        texts = text.at(place, Anchor.CENTRE, 90.0 if upright else 0.0)
        measured = Measured.VERTICAL if upright else Measured.HORIZONTAL
        length = abs(self.side.along(self.second) - self.side.along(self.first)) / self.draughting.scale
        words = cad_words(self.size, self.draughting.words, length)
        on_line = self.side.point(middle, out)
        return Figure.of(Dimension(measured, self.first, self.second, on_line, words, (*shapes, *texts.shapes)))
