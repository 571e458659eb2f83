"""Leaders (ISO 129-1): a line with an arrow to what a text, a size or a tolerance frame is about. Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from gearcad.drawing.marks.arrows import arrow
from gearcad.drawing.marks.frames import datum
from gearcad.drawing.marks.side import Side
from gearcad.drawing.marks.size_text import written_size
from gearcad.drawing.marks.written import Written, plain
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Point, Shape
from gearcad.drawing.words import Draughting, Size

__all__ = ["circle_dimension", "frame_leader", "landing_of", "leader", "with_frame"]

_LENGTHS = (10.0, 15.0, 21.0, 28.0, 36.0, 46.0, 58.0, 72.0)
_LANDING = 3.0
"""Of a leader before what it leads to; a text stands upon it."""

_LIFT, _LEAST_LIFT = 0.9, 0.6
_BELOW_TEXT = 1.0
"""From the line under a text to the frame below it."""


def leader(
    tip: Point,
    what: str | Size | Written | Figure,
    draughting: Draughting,
    directions: Iterable[float] = (45.0, 135.0, -45.0, -135.0, 60.0, 120.0, -60.0, -120.0),
    *,
    lengths: Iterable[float] = _LENGTHS,
) -> Iterator[Figure]:
    """From a point in one of some directions (degrees, none of them vertical) to a text on a short line, or to a figure's side.

    A figure is joined where its own y is 0. All directions with the shortest line, then longer ones.
    """
    ways = tuple(directions)
    for length in lengths:
        for way in ways:
            yield Figure(_led(tip, way, length, _content(what, draughting)))


def circle_dimension(
    centre: Point,
    radius: float,
    size: Size,
    draughting: Draughting,
    directions: Iterable[float] = (45.0, 135.0, -45.0, -135.0, 60.0, 120.0, -60.0, -120.0, 30.0, 150.0, -30.0, -150.0),
    *,
    beyond: float = 0.0,
) -> Iterator[Figure]:
    """The diameter of a circle: an arrow at it from outside, its text at least `beyond` mm away from the circle.

    Lines and texts, no dimension of a CAD program: those that draw diameters anew put their texts across the circle.
    """
    ways, text = tuple(directions), written_size(size, draughting.words)
    for length in _LENGTHS:
        for way in ways:
            cosine, sine = math.cos(math.radians(way)), math.sin(math.radians(way))
            tip = centre[0] + radius * cosine, centre[1] + radius * sine
            yield Figure(_led(tip, way, beyond + length, text))


def landing_of(led: Figure) -> Line:
    """The line under the text of a leader, from the leader outwards."""
    return next(each for each in led.shapes if isinstance(each, Line) and each.start[1] == each.end[1])


def with_frame(led: Figure, frame: Figure) -> Figure:
    """A leader to a text, and a tolerance frame below the line of that (ISO 1101)."""
    landing, box = landing_of(led), frame.box
    to_right = landing.end[0] > landing.start[0]
    left = landing.start[0] if to_right else landing.start[0] - box.width
    return led + frame.moved(left - box.left, landing.start[1] - _BELOW_TEXT - box.top)


def frame_leader(
    tip: Point, side: Side, frame: Figure, *, clear: float | None = None, datum_letter: str = ""
) -> Iterator[Figure]:
    """A frame with a leader whose arrow is square to the edge at `tip`, whose outside is at `side`.

    The frame has the middle of its left side at (0, 0), as `tolerance_frame` makes it. Beyond `clear` (where the outline ends
    on that side) it may turn once to reach the frame. `datum_letter` is that of the surface as a datum, whose triangle stands
    below the frame (ISO 5459).
    """
    for led, placed in _framed(tip, side, frame, clear):
        box = placed.box
        below = (box.left + box.right) / 2, box.bottom
        yield led + placed + (next(datum(datum_letter, below, Side.BELOW)) if datum_letter else Figure())


def _framed(tip: Point, side: Side, frame: Figure, clear: float | None) -> Iterator[tuple[Figure, Figure]]:
    """Leaders, and the frame where each has it."""
    start = side.out(tip) if clear is None else clear
    start = start if (start - side.out(tip)) * side.outwards > 0 else side.out(tip)
    box = frame.box
    point = arrow(tip, (-side.value[0], -side.value[1]), Pen.SYMBOL)
    for length in _LENGTHS:
        end = side.point(side.along(tip), start + side.outwards * length)
        line = Line(tip, end, Pen.SYMBOL)
        if side.is_upright:
            yield Figure.of(point, line), _beside(frame, end, side.outwards)
            continue
        for across in (1.0, -1.0):
            for landing in (_LANDING, 3 * _LANDING):
                corner = end[0] + across * landing, end[1]
                yield Figure.of(point, line, Line(end, corner, Pen.SYMBOL)), _beside(frame, corner, across)
        up = box.height / 2 * side.outwards
        yield Figure.of(point, line), frame.moved(end[0] - box.width / 2, end[1] + up)


def _content(what: str | Size | Written | Figure, draughting: Draughting) -> Written | Figure:
    if isinstance(what, str):
        return plain(what)
    return written_size(what, draughting.words) if isinstance(what, Size) else what


def _led(tip: Point, way: float, length: float, what: Written | Figure) -> tuple[Shape, ...]:
    """Arrow, line, and what it leads to: upon a line if it is a text, else beside its end."""
    cosine, sine = math.cos(math.radians(way)), math.sin(math.radians(way))
    elbow = tip[0] + length * cosine, tip[1] + length * sine
    across = 1.0 if cosine >= 0 else -1.0
    shapes: list[Shape] = [arrow(tip, (-cosine, -sine)), Line(tip, elbow, Pen.DIMENSION)]
    landing = what.width + 1.0 if isinstance(what, Written) else _LANDING
    end = elbow[0] + across * landing, elbow[1]
    shapes.append(Line(elbow, end, Pen.DIMENSION))
    if isinstance(what, Written):
        place = (elbow[0] + end[0]) / 2, elbow[1] + max(_LIFT, what.below + _LEAST_LIFT)
        return (*shapes, *what.at(place, Anchor.CENTRE).shapes)
    return (*shapes, *_beside(what, end, across).shapes)


def _beside(figure: Figure, end: Point, across: float) -> Figure:
    """A figure with its left or its right side at the end of a line, which joins it where its own y is 0."""
    box = figure.box
    left = end[0] if across > 0 else end[0] - box.width
    return figure.moved(left - box.left, end[1])
