"""Geometrical tolerances (ISO 1101) and datums (ISO 5459). Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum

from gearcad.drawing.marks.arrows import arrow
from gearcad.drawing.marks.side import Side
from gearcad.drawing.shapes import Anchor, Box, Circle, Figure, Filled, Line, Pen, Point, Polyline, Shape, Text, text_width

__all__ = ["FRAME_HEIGHT", "Characteristic", "datum", "tolerance_frame"]

FRAME_HEIGHT = 7.0
"""Twice that of its text."""

_TEXT = 3.5
_DATUM_LENGTHS = (3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 48.0)


class Characteristic(Enum):
    """What a geometrical tolerance limits."""

    CIRCULAR_RUNOUT = "circular run-out"
    TOTAL_RUNOUT = "total run-out"
    CYLINDRICITY = "cylindricity"
    PARALLELISM = "parallelism"
    PERPENDICULARITY = "perpendicularity"
    POSITION = "position"
    FLATNESS = "flatness"
    SYMMETRY = "symmetry"


def tolerance_frame(characteristic: Characteristic, value: str, datums: str | tuple[str, ...] = ()) -> Figure:
    """Cells for symbol, value ("0.02", "⌀0.1") and datums ("A", or ("A", "B")); the middle of its left side at (0, 0)."""
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
    """A filled triangle that stands on an edge (outside at `side`) or an extension line, and the letter in a box.

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
    """Arrows up to the right."""
    rise = 3.6
    shapes: list[Shape] = []
    for x, y in starts:
        tip = x + rise, y + rise
        shapes += [Line((x, y), tip, Pen.SYMBOL), _small_arrow(tip)]
    return tuple(shapes)


def _small_arrow(tip: Point) -> Filled:
    """Shorter than those of dimensions: a cell is small."""
    whole = arrow((0.0, 0.0), (1.0, 1.0), Pen.SYMBOL)
    return Filled(tuple((tip[0] + 0.6 * x, tip[1] + 0.6 * y) for x, y in whole.points), Pen.SYMBOL)


def _circular_runout() -> tuple[Shape, ...]:
    return _runout((-1.8, -1.8))


def _total_runout() -> tuple[Shape, ...]:
    return *_runout((-2.6, -1.8), (-0.4, -1.8)), Line((-2.6, -1.8), (-0.4, -1.8), Pen.SYMBOL)


def _cylindricity() -> tuple[Shape, ...]:
    """A circle between two slanting lines that touch it."""
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
    """Three lines, the middle one the longest."""
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
