"""Linear dimensions (ISO 129-1): lanes beside an outline, texts within, beside or above the line. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from gearcad.drawing.marks.arrows import ARROW, arrow
from gearcad.drawing.marks.frames import datum
from gearcad.drawing.marks.side import Side
from gearcad.drawing.marks.size_text import cad_words, written_size
from gearcad.drawing.marks.written import Written
from gearcad.drawing.shapes import Anchor, Dimension, Figure, Line, Measured, Pen, Point, Shape
from gearcad.drawing.words import Draughting, Size

__all__ = ["FIRST_LANE", "LANE_PITCH", "linear_dimension"]

FIRST_LANE = 10.0
"""From the outline to the first dimension line."""

LANE_PITCH = 9.0
"""From one dimension line to the next."""

_LANES, _NEAR = 9, 3
"""Lanes; and those in which a text goes far aside before it goes further out."""

_FARTHER = (7.0, 15.0, 25.0)
"""How much further aside."""

_GAP, _BEYOND = 0.8, 1.5
"""Of extension lines: before they begin, and past the dimension line."""

_LIFT, _LEAST_LIFT = 0.9, 0.6
"""From the dimension line to the line of the text above it, and to what of the text is below its line."""

_TAIL = 3.0
"""Of a line behind an arrow that points at it from outside."""

_SHIFTS = (0.0, 0.6, -0.6)
"""Where along its line a text may stand, over the room that it has on either side of the middle."""


def linear_dimension(
    first: Point,
    second: Point,
    side: Side,
    size: Size,
    draughting: Draughting,
    *,
    clear: float,
    datum_letter: str = "",
    frame: Figure | None = None,
) -> Iterator[Figure]:
    """A size between two points, its line vertical (LEFT, RIGHT) or horizontal, in lanes outwards from `clear`.

    `clear` is where the outline ends on that side: an x for LEFT and RIGHT, a y for ABOVE and BELOW. What is too narrow has
    arrows from outside, and its text beside. `datum_letter` is that of the axis or the middle plane as a datum: its triangle
    stands on the extension line of `first`, opposite to the arrow or for it (ISO 5459). A tolerance `frame`, the middle of its
    left side at (0, 0), stands at the end of a horizontal line: it is of the middle plane (ISO 1101).
    """
    drawn = _Drawn(first, second, side, size, draughting, datum_letter, frame)
    outs = _lanes(side, clear)
    for out in outs[:_NEAR]:
        yield from drawn.in_lane(out)
    for farther in _FARTHER:
        for out in outs[:_NEAR]:
            yield from drawn.beside(out, farther)
    for out in outs[_NEAR:]:
        yield from drawn.in_lane(out)


def _lanes(side: Side, clear: float) -> list[float]:
    return [clear + side.outwards * (FIRST_LANE + lane * LANE_PITCH) for lane in range(_LANES)]


@dataclass(frozen=True)
class _Drawn:
    """A dimension to be drawn in one of many lanes."""

    first: Point
    second: Point
    side: Side
    size: Size
    draughting: Draughting
    datum_letter: str = ""
    frame: Figure | None = None

    @property
    def text(self) -> Written:
        return written_size(self.size, self.draughting.words)

    def in_lane(self, out: float) -> Iterator[Figure]:
        """All ways in one lane, best first: text and arrows within, only the text, neither."""
        low, high = sorted(map(self.side.along, (self.first, self.second)))
        text, tail = self.text, ARROW + _TAIL
        room = high - low - 2 * ARROW - 1.0 - text.width
        if room >= 0:
            for shift in _SHIFTS if room > 4 else _SHIFTS[:1]:
                yield self._whole(out, low, high, (low + high + shift * room) / 2, within=True)
            return
        if text.width + 1.5 <= high - low:
            yield self._whole(out, low - tail, high + tail, (low + high) / 2, within=False)
        yield from self.beside(out)

    def beside(self, out: float, farther: float = 0.0) -> Iterator[Figure]:
        """The text beside what is measured, `farther` away than it must be; not where a datum stands."""
        low, high = sorted(map(self.side.along, (self.first, self.second)))
        within = high - low >= 2 * ARROW + 1.0
        tail = 0.0 if within else ARROW + _TAIL
        past = max(tail, _BEYOND) + 1.0 + farther
        for near, other, way in ((high, low, 1.0), (low, high, -1.0)):
            if near != self._with_datum:
                start, end = sorted((near + way * (past + self.text.width), other - way * tail))
                yield self._whole(out, start, end, near + way * (past + self.text.width / 2), within=within)

    @property
    def _with_datum(self) -> float | None:
        """Where along the line a datum stands."""
        return self.side.along(self.first) if self.datum_letter else None

    def _whole(self, out: float, start: float, end: float, middle: float, *, within: bool) -> Figure:
        """With its line from `start` to `end`, and the middle of its text at `middle`."""
        ends = map(self.side.along, (self.first, self.second))
        held = self._with_datum
        if not within and held is not None:
            start, end = (max(start, held), end) if held < middle else (start, min(end, held))
        shapes = [
            self._line(start, end, out),
            *self._arrows(ends, out, within=within),
            self._extension(self.first, out),
            self._extension(self.second, out),
        ]
        figure = self._figure(out, shapes, self.text, middle)
        return figure if self.frame is None else figure + self._framed(self.frame, out, (start, end), middle, within=within)

    def _framed(self, frame: Figure, out: float, line: tuple[float, float], middle: float, *, within: bool) -> Figure:
        """A frame at the end of the line without the text, with an arrow of its own where there is none from outside."""
        low, high = sorted(map(self.side.along, (self.first, self.second)))
        way, edge, far = (-1.0, low, line[0]) if middle > high else (1.0, high, line[1])
        marks: list[Shape] = []
        if within:
            far = edge + way * (ARROW + _TAIL)
            marks = [self._line(edge, far, out), arrow(self.side.point(edge, out), self.side.point(-way, 0.0))]
        box = frame.box
        left = far if way > 0 else far - box.width
        return Figure.of(*marks, frame.moved(left - box.left, out))

    def _line(self, low: float, high: float, out: float) -> Line:
        return Line(self.side.point(low, out), self.side.point(high, out), Pen.DIMENSION)

    def _arrows(self, ends: Iterable[float], out: float, *, within: bool) -> list[Shape]:
        """At either end; a datum stands where one would be outside."""
        high = max(map(self.side.along, (self.first, self.second)))
        way = 1.0 if within else -1.0
        return [
            arrow(self.side.point(each, out), self.side.point(way if each == high else -way, 0.0))
            for each in ends
            if within or each != self._with_datum
        ]

    def _extension(self, point: Point, out: float) -> Line:
        """From the measured point to a little past the dimension line."""
        along, start = self.side.along(point), self.side.out(point)
        way = 1.0 if out > start else -1.0
        end = out + way * _BEYOND
        begin = start + way * min(_GAP, abs(out - start) / 2)
        return Line(self.side.point(along, begin), self.side.point(along, end), Pen.DIMENSION)

    def _figure(self, out: float, shapes: list[Shape], text: Written, middle: float) -> Figure:
        """With the text above the line: of vertical ones to its left, read from the right."""
        lift = max(_LIFT, text.below + _LEAST_LIFT)
        upright = self.side.is_upright
        place = (out - lift, middle) if upright else (middle, out + lift)
        texts = text.at(place, Anchor.CENTRE, 90.0 if upright else 0.0)
        measured = Measured.VERTICAL if upright else Measured.HORIZONTAL
        length = abs(self.side.along(self.second) - self.side.along(self.first)) / self.draughting.scale
        words = cad_words(self.size, self.draughting.words, length)
        on_line = self.side.point(middle, out)
        parts = (*shapes, *texts.shapes)
        dimension = Dimension(measured, self.first, self.second, on_line, words, parts, self.draughting.scale)
        return Figure.of(dimension, self._datum(out)) if self.datum_letter else Figure.of(dimension)

    def _datum(self, out: float) -> Figure:
        """On the extension line of the first point, away from the second."""
        along, other = self.side.along(self.first), self.side.along(self.second)
        away = next(
            each for each in Side if each.is_upright is not self.side.is_upright and each.outwards * (along - other) > 0
        )
        return next(datum(self.datum_letter, self.side.point(along, out), away))
