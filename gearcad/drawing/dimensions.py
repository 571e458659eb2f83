"""Dimensions and leaders (ISO 129-1), geometrical tolerances (ISO 1101) and datums (ISO 5459). Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

from gearcad.drawing.annotation_text import Written, cad_words, plain, written_size
from gearcad.drawing.shapes import (
    Anchor,
    Box,
    Circle,
    Dimension,
    Figure,
    Filled,
    Line,
    MeasuredDistance,
    Pen,
    Point,
    Polyline,
    Shape,
    Text,
    text_width,
)
from gearcad.drawing.words import Draughting, Size


class Side(Enum):
    """A side of a figure, or the side of an edge on which its outside is. The value is the direction outwards."""

    LEFT = (-1.0, 0.0)
    RIGHT = (1.0, 0.0)
    ABOVE = (0.0, 1.0)
    BELOW = (0.0, -1.0)

    @property
    def is_upright(self) -> bool:
        """Whether edges and dimension lines on this side of a view are vertical."""
        return self in (Side.LEFT, Side.RIGHT)

    @property
    def outwards(self) -> float:
        """1 or -1: the sign of a step outwards."""
        return sum(self.value)

    def point(self, along: float, out: float) -> Point:
        """Return the point at `along` (x of horizontal edges, y of vertical ones) whose other coordinate is `out`."""
        return (out, along) if self.is_upright else (along, out)

    def along(self, point: Point) -> float:
        """Return the coordinate of a point along the edge: x of horizontal edges, y of vertical ones."""
        return point[1] if self.is_upright else point[0]

    def out(self, point: Point) -> float:
        """Return the coordinate of a point across the edge: y of horizontal edges, x of vertical ones."""
        return point[0] if self.is_upright else point[1]


ARROW = 3.2
"""Length (mm) of an arrow."""

_HALF_WIDTH = ARROW * math.tan(math.radians(7.5))


def arrow(tip: Point, way: Point, pen: Pen = Pen.DIMENSION) -> Filled:
    """Return an arrow with its tip at a point; `way` is its direction (of any length but zero)."""
    length = math.hypot(*way)
    along, up = way[0] / length, way[1] / length
    base = tip[0] - ARROW * along, tip[1] - ARROW * up
    side = -_HALF_WIDTH * up, _HALF_WIDTH * along
    return Filled((tip, (base[0] + side[0], base[1] + side[1]), (base[0] - side[0], base[1] - side[1])), pen)


FRAME_HEIGHT = 7.0
"""Height of a tolerance frame: twice the height of its text."""

_TEXT = 3.5
_DATUM_LENGTHS = (3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 48.0)


class Characteristic(Enum):
    """A characteristic that a geometrical tolerance limits (ISO 1101)."""

    CIRCULAR_RUNOUT = "circular run-out"
    TOTAL_RUNOUT = "total run-out"
    CYLINDRICITY = "cylindricity"
    PARALLELISM = "parallelism"
    PERPENDICULARITY = "perpendicularity"
    POSITION = "position"
    FLATNESS = "flatness"
    SYMMETRY = "symmetry"


def tolerance_frame(characteristic: Characteristic, value: str, datums: str | tuple[str, ...] = ()) -> Figure:
    """Return a frame of cells: symbol, value ("0.02", "⌀0.1") and datums ("A", or ("A", "B")). The middle of its left side is
    at (0, 0).
    """
    half = FRAME_HEIGHT / 2
    shapes: list[Shape] = [each.moved(half, 0.0) for each in _SYMBOLS[characteristic]()]
    edge = FRAME_HEIGHT
    for text in (value, *datums):
        shapes.append(Line((edge, -half), (edge, half), Pen.SYMBOL))
        width = max(FRAME_HEIGHT, text_width(text, _TEXT) + 0.8 * _TEXT)
        shapes.append(Text(text, (edge + width / 2, 0.0), _TEXT, Anchor.MIDDLE))
        edge += width
    corners = ((0.0, -half), (edge, -half), (edge, half), (0.0, half))
    return Figure((Polyline.straight(corners, Pen.SYMBOL, closed=True), *shapes))


def datum(letter: str, on: Point, side: Side) -> Iterator[Figure]:
    """Yield a datum triangle on an edge (outside at `side`) or an extension line, with its letter in a box, in each possible
    place.

    The box is straight before it, or aside of a line that turns once.
    """
    base, high = 1.75, 3.0
    along, surface = side.along(on), side.out(on)
    corners = (side.point(along - base, surface), side.point(along + base, surface))
    top = side.point(along, surface + side.outwards * high)
    triangle = Filled((*corners, top), Pen.SYMBOL)
    half = FRAME_HEIGHT / 2
    for length in _DATUM_LENGTHS:
        out = surface + side.outwards * (high + length)
        end = side.point(along, out)
        yield Figure.of(triangle, Line(top, end, Pen.SYMBOL), _boxed(letter, side.point(along, out + side.outwards * half)))
        for aside in (3.0, -3.0, 8.0, -8.0):
            corner = side.point(along + aside, out)
            box = _boxed(letter, side.point(along + aside + (half if aside > 0 else -half), out))
            yield Figure.of(triangle, Line(top, end, Pen.SYMBOL), Line(end, corner, Pen.SYMBOL), box)


def _boxed(letter: str, middle: Point) -> Figure:
    half = FRAME_HEIGHT / 2
    box = Box(*middle, *middle).grown(half)
    corners = [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]
    return Figure.of(Polyline.straight(corners, Pen.SYMBOL, closed=True), Text(letter, middle, _TEXT, Anchor.MIDDLE))


def _runout(*starts: Point) -> tuple[Shape, ...]:
    """Return arrows up to the right, one from each start."""
    rise = 3.6
    shapes: list[Shape] = []
    for x, y in starts:
        tip = x + rise, y + rise
        shapes += [Line((x, y), tip, Pen.SYMBOL), _small_arrow(tip)]
    return tuple(shapes)


def _small_arrow(tip: Point) -> Filled:
    """Return an arrow shorter than those of dimensions, because a cell is small."""
    whole = arrow((0.0, 0.0), (1.0, 1.0), Pen.SYMBOL)
    return Filled(tuple((tip[0] + 0.6 * x, tip[1] + 0.6 * y) for x, y in whole.points), Pen.SYMBOL)


def _circular_runout() -> tuple[Shape, ...]:
    return _runout((-1.8, -1.8))


def _total_runout() -> tuple[Shape, ...]:
    return *_runout((-2.6, -1.8), (-0.4, -1.8)), Line((-2.6, -1.8), (-0.4, -1.8), Pen.SYMBOL)


def _cylindricity() -> tuple[Shape, ...]:
    """Return a circle between two slanting lines that touch it."""
    radius, lean = 1.3, 0.5  # tangent of the lines' angle to the vertical
    off = radius * (1 + lean**2) ** 0.5
    lines = (Line((x - 1.9 * lean, -1.9), (x + 1.9 * lean, 1.9), Pen.SYMBOL) for x in (-off, off))
    return Circle((0.0, 0.0), radius, Pen.SYMBOL), *lines


def _parallelism() -> tuple[Shape, ...]:
    return tuple(Line((x - 0.9, -1.8), (x + 0.9, 1.8), Pen.SYMBOL) for x in (-0.8, 0.8))


def _perpendicularity() -> tuple[Shape, ...]:
    return Line((-2.0, -1.7), (2.0, -1.7), Pen.SYMBOL), Line((0.0, -1.7), (0.0, 1.9), Pen.SYMBOL)


def _position() -> tuple[Shape, ...]:
    cross = (Line((-2.2, 0.0), (2.2, 0.0), Pen.SYMBOL), Line((0.0, -2.2), (0.0, 2.2), Pen.SYMBOL))
    return Circle((0.0, 0.0), 1.3, Pen.SYMBOL), *cross


def _flatness() -> tuple[Shape, ...]:
    corners = ((-2.4, -1.1), (1.2, -1.1), (2.4, 1.1), (-1.2, 1.1))
    return (Polyline.straight(corners, Pen.SYMBOL, closed=True),)


def _symmetry() -> tuple[Shape, ...]:
    """Return three lines, the middle one the longest."""
    rows = ((1.1, 1.2), (0.0, 2.2), (-1.1, 1.2))
    return tuple(Line((-half, y), (half, y), Pen.SYMBOL) for y, half in rows)


_SYMBOLS = {
    Characteristic.CIRCULAR_RUNOUT: _circular_runout,
    Characteristic.TOTAL_RUNOUT: _total_runout,
    Characteristic.CYLINDRICITY: _cylindricity,
    Characteristic.PARALLELISM: _parallelism,
    Characteristic.PERPENDICULARITY: _perpendicularity,
    Characteristic.POSITION: _position,
    Characteristic.FLATNESS: _flatness,
    Characteristic.SYMMETRY: _symmetry,
}


_LENGTHS = (10.0, 15.0, 21.0, 28.0, 36.0, 46.0, 58.0, 72.0)
_LANDING = 3.0
"""Length (mm) of a leader's level end before a figure; the line below a text is 1 mm longer than the text."""

_LEADER_LIFT, _LEADER_LEAST_LIFT = 0.9, 0.6
_BELOW_TEXT = 1.0
"""Distance from the line under a text to the frame below it."""


def leader(
    tip: Point,
    what: str | Size | Written | Figure,
    draughting: Draughting,
    directions: Iterable[float] = (45.0, 135.0, -45.0, -135.0, 60.0, 120.0, -60.0, -120.0),
    *,
    lengths: Iterable[float] = _LENGTHS,
) -> Iterator[Figure]:
    """Yield leaders from a point to a text on a short line, or to a figure's side.

    `directions` are in degrees, none of them vertical. A figure is joined where its own y is 0. All directions come with the
    shortest line first, then with longer ones.
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
    """Yield dimensions of a circle's diameter: an arrow at it from outside, the text at least `beyond` mm away from the
    circle.

    They are lines and texts, not dimensions of a CAD program: programs that redraw diameters put their texts across the
    circle.
    """
    ways, text = tuple(directions), written_size(size, draughting.words)
    for length in _LENGTHS:
        for way in ways:
            cosine, sine = math.cos(math.radians(way)), math.sin(math.radians(way))
            tip = centre[0] + radius * cosine, centre[1] + radius * sine
            yield Figure(_led(tip, way, beyond + length, text))


def landing_of(led: Figure) -> Line:
    """Return the line under the text of a leader, from the leader outwards."""
    return next(each for each in led.shapes if isinstance(each, Line) and each.start[1] == each.end[1])


def with_frame(led: Figure, frame: Figure) -> Figure:
    """Return a leader to a text, with a tolerance frame below the line under the text (ISO 1101)."""
    landing, box = landing_of(led), frame.box
    to_right = landing.end[0] > landing.start[0]
    left = landing.start[0] if to_right else landing.start[0] - box.width
    return led + frame.moved(left - box.left, landing.start[1] - _BELOW_TEXT - box.top)


def frame_leader(
    tip: Point, side: Side, frame: Figure, *, clear: float | None = None, datum_letter: str = ""
) -> Iterator[Figure]:
    """Yield a frame with a leader whose arrow is square to the edge at `tip`, whose outside is at `side`.

    The frame has the middle of its left side at (0, 0), as `tolerance_frame` makes it. Beyond `clear` (where the outline ends
    on that side) it may turn once to reach the frame. `datum_letter` is that of the surface as a datum, whose triangle stands
    below the frame (ISO 5459).
    """
    for led, placed in _framed(tip, side, frame, clear):
        box = placed.box
        below = (box.left + box.right) / 2, box.bottom
        yield led + placed + (next(datum(datum_letter, below, Side.BELOW)) if datum_letter else Figure())


def _framed(tip: Point, side: Side, frame: Figure, clear: float | None) -> Iterator[tuple[Figure, Figure]]:
    """Yield leaders, each with the frame in its place."""
    start = side.out(tip) if clear is None else clear
    start = start if (start - side.out(tip)) * side.outwards > 0 else side.out(tip)
    box = frame.box
    point = arrow(tip, (-side.value[0], -side.value[1]), Pen.SYMBOL)
    for length in _LENGTHS:
        end = side.point(side.along(tip), start + side.outwards * length)
        line = Line(tip, end, Pen.SYMBOL)
        if side.is_upright:
            yield Figure.of(point, line), _at_line_end(frame, end, side.outwards)
            continue
        for across in (1.0, -1.0):
            for landing in (_LANDING, 3 * _LANDING):
                corner = end[0] + across * landing, end[1]
                yield Figure.of(point, line, Line(end, corner, Pen.SYMBOL)), _at_line_end(frame, corner, across)
        up = box.height / 2 * side.outwards
        yield Figure.of(point, line), frame.moved(end[0] - box.width / 2, end[1] + up)


def _content(what: str | Size | Written | Figure, draughting: Draughting) -> Written | Figure:
    if isinstance(what, str):
        return plain(what)
    return written_size(what, draughting.words) if isinstance(what, Size) else what


def _led(tip: Point, way: float, length: float, what: Written | Figure) -> tuple[Shape, ...]:
    """Return the shapes of a leader: arrow, line and content. A text stands on the landing line, a figure beside its end."""
    cosine, sine = math.cos(math.radians(way)), math.sin(math.radians(way))
    elbow = tip[0] + length * cosine, tip[1] + length * sine
    across = 1.0 if cosine >= 0 else -1.0
    shapes: list[Shape] = [arrow(tip, (-cosine, -sine)), Line(tip, elbow, Pen.DIMENSION)]
    landing = what.width + 1.0 if isinstance(what, Written) else _LANDING
    end = elbow[0] + across * landing, elbow[1]
    shapes.append(Line(elbow, end, Pen.DIMENSION))
    if isinstance(what, Written):
        place = (elbow[0] + end[0]) / 2, elbow[1] + max(_LEADER_LIFT, what.below + _LEADER_LEAST_LIFT)
        return (*shapes, *what.at(place, Anchor.CENTRE).shapes)
    return (*shapes, *_at_line_end(what, end, across).shapes)


def _at_line_end(figure: Figure, end: Point, across: float) -> Figure:
    """Return a figure with its left or right side at the end of a line, which joins it where its own y is 0."""
    box = figure.box
    left = end[0] if across > 0 else end[0] - box.width
    return figure.moved(left - box.left, end[1])


FIRST_LANE = 10.0
"""Distance from the outline to the first dimension line."""

LANE_PITCH = 9.0
"""Distance from one dimension line to the next."""

_LANES, _NEAR = 9, 3
"""Number of lanes, and of near ones: a text moves far aside in these before it moves further out."""

_FARTHER = (7.0, 15.0, 25.0)
"""Additional distances (mm) of a text from its place, tried in this order."""

_GAP, _BEYOND = 0.8, 1.5
"""Gap before extension lines, and their length past the dimension line."""

_LIFT, _LEAST_LIFT = 0.9, 0.6
"""Distance from the dimension line to the line of the text above it, and least distance to the parts below that line."""

_TAIL = 3.0
"""Length of the line behind an arrow that points inwards from outside."""

_SHIFTS = (0.0, 0.6, -0.6)
"""Shift of a text along its line, over the room that it has on either side of the middle."""


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
    """Yield dimensions between two points in each possible place: lanes outwards from `clear`, best first.

    The dimension line is vertical (LEFT, RIGHT) or horizontal. `clear` is where the outline ends on that side: an x for LEFT
    and RIGHT, a y for ABOVE and BELOW. A narrow dimension has its arrows outside and its text beside them. `datum_letter`
    marks the axis or the middle plane as a datum. Its triangle stands on the extension line of `first`, opposite to the arrow
    or in its place (ISO 5459). A tolerance `frame`, the middle of its left side at (0, 0), stands at the end of a horizontal
    line. It applies to the middle plane (ISO 1101).
    """
    drawn = _LaneDimension(first, second, side, size, draughting, datum_letter, frame)
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
class _LaneDimension:
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
        """Yield all forms of the dimension in one lane, best first: text and arrows within, only the text within, neither
        within.
        """
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
        """Yield the dimension with its text beside the measured length, `farther` (mm) away than necessary; not where a datum
        stands.
        """
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
        """Position of the datum along the line; None without a datum."""
        return self.side.along(self.first) if self.datum_letter else None

    def _whole(self, out: float, start: float, end: float, middle: float, *, within: bool) -> Figure:
        """Return the dimension with its line from `start` to `end` and the middle of its text at `middle`."""
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
        """Return a frame at the end of the line away from the text. It has its own arrow if the dimension has none outside."""
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
        """Return an arrow for either end; none at a datum whose arrow would be outside."""
        high = max(map(self.side.along, (self.first, self.second)))
        way = 1.0 if within else -1.0
        return [
            arrow(self.side.point(each, out), self.side.point(way if each == high else -way, 0.0))
            for each in ends
            if within or each != self._with_datum
        ]

    def _extension(self, point: Point, out: float) -> Line:
        """Return the extension line from a measured point to a little past the dimension line."""
        along, start = self.side.along(point), self.side.out(point)
        way = 1.0 if out > start else -1.0
        end = out + way * _BEYOND
        begin = start + way * min(_GAP, abs(out - start) / 2)
        return Line(self.side.point(along, begin), self.side.point(along, end), Pen.DIMENSION)

    def _figure(self, out: float, shapes: list[Shape], text: Written, middle: float) -> Figure:
        """Return the dimension with its text above the line; a vertical line has it at its left, read from the right."""
        lift = max(_LIFT, text.below + _LEAST_LIFT)
        upright = self.side.is_upright
        place = (out - lift, middle) if upright else (middle, out + lift)
        texts = text.at(place, Anchor.CENTRE, 90.0 if upright else 0.0)
        measured = MeasuredDistance.VERTICAL if upright else MeasuredDistance.HORIZONTAL
        length = abs(self.side.along(self.second) - self.side.along(self.first)) / self.draughting.scale
        words = cad_words(self.size, self.draughting.words, length)
        on_line = self.side.point(middle, out)
        parts = (*shapes, *texts.shapes)
        dimension = Dimension(measured, self.first, self.second, on_line, words, parts, self.draughting.scale)
        return Figure.of(dimension, self._datum(out)) if self.datum_letter else Figure.of(dimension)

    def _datum(self, out: float) -> Figure:
        """Return the datum on the extension line of the first point, away from the second point."""
        along, other = self.side.along(self.first), self.side.along(self.second)
        away = next(
            each for each in Side if each.is_upright is not self.side.is_upright and each.outwards * (along - other) > 0
        )
        return next(datum(self.datum_letter, self.side.point(along, out), away))
