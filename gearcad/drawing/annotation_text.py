"""Annotation texts: subscripts, stacked limits, sizes, and tables of texts. Lengths in mm of paper."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

from gearcad.drawing.shapes import (
    Anchor,
    Box,
    Circle,
    Figure,
    Line,
    Pen,
    Point,
    Polyline,
    Shape,
    Text,
    fitted,
    reach,
    text_width,
)
from gearcad.drawing.words import SheetWords, Size

_SMALL, _LEAST = 0.7, 1.8
"""Height of limit deviations and of subscripts over that of the text, and the least (mm) that one can read."""

_SUBSCRIPT_DROP = 0.3
"""Drop of subscripts below the line, over the height."""

_STACK_AIR = 0.18
"""Distance between the two deviations of a stack, over the height."""

_BOX_AIR = 0.28
"""Distance from a text to the box around it, over the height."""

_LEAST_AIR = 0.1
"""Distance (mm) between descending letters of the upper deviation ("µm") and the lower deviation."""

_SYMBOL_WITH_SUBSCRIPT = re.compile(r"_([^\s_,;:/()=]+)")


class _Piece(NamedTuple):
    words: str
    along: float
    up: float
    height: float


class _Ring(NamedTuple):
    along: float
    up: float
    radius: float


@dataclass(frozen=True)
class Written:
    """Texts, rings and boxes, positioned along a line and above it; `height` is the height of the capitals."""

    pieces: tuple[_Piece, ...]
    width: float
    height: float
    rings: tuple[_Ring, ...] = ()
    boxes: tuple[Box, ...] = ()

    def then(self, other: Written, air: float = 0.0) -> Written:
        """Return this text with another one behind it, `air` (mm) between them."""
        start = self.width + air
        return replace(
            self,
            pieces=self.pieces + tuple(each._replace(along=each.along + start) for each in other.pieces),
            rings=self.rings + tuple(each._replace(along=each.along + start) for each in other.rings),
            boxes=self.boxes + tuple(each.moved(start, 0.0) for each in other.boxes),
            width=start + other.width,
        )

    @cached_property
    def below(self) -> float:
        """Reach of the text below its line (mm)."""
        return max(0.0, -self._box_of_one().bottom)

    @cached_property
    def above(self) -> float:
        """Reach of the text above its line (mm)."""
        return self._box_of_one().top

    def _box_of_one(self) -> Box:
        return self.at((0.0, 0.0)).box if self.pieces else Box(0.0, 0.0, 0.0, self.height)

    def at(self, place: Point, anchor: Anchor = Anchor.LEFT, rotation: float = 0.0, pen: Pen = Pen.FINE_TEXT) -> Figure:
        """Return the figure of the text placed at `place` (mm), turned by 0 or 90 degrees."""
        cosine, sine = math.cos(math.radians(rotation)), math.sin(math.radians(rotation))
        back, down = anchor.along * self.width, anchor.up * self.height

        def turned(along: float, up: float) -> Point:
            along, up = along - back, up - down
            return place[0] + along * cosine - up * sine, place[1] + along * sine + up * cosine

        texts = (Text(each.words, turned(each.along, each.up), each.height, rotation=rotation, pen=pen) for each in self.pieces)
        rings = (Circle(turned(each.along, each.up), each.radius, pen) for each in self.rings)
        frames = (
            Polyline.straight([turned(*corner) for corner in _corners(each)], Pen.DIMENSION, closed=True) for each in self.boxes
        )
        shapes: tuple[Shape, ...] = (*texts, *rings, *frames)
        return Figure(shapes)


def plain(words: str, height: float = 3.5) -> Written:
    """Return a text without symbols or limits."""
    return Written((_Piece(words, 0.0, 0.0, height),) if words else (), text_width(words, height), height)


def boxed(written: Written) -> Written:
    """Return a text in a box, as theoretically exact dimensions have it (ISO 1101)."""
    air = _BOX_AIR * written.height
    room = plain("", written.height)
    whole = replace(room, width=air).then(written).then(replace(room, width=air))
    return replace(whole, boxes=(*whole.boxes, Box(0.0, -air, whole.width, written.height + air)))


def _corners(box: Box) -> list[Point]:
    return [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]


def ringed(letter: str, height: float = 3.5) -> Written:
    """Return a letter in a ring, as the E of ISO 14405-1."""
    radius, small = 0.7 * height, 0.8 * height
    start = radius - text_width(letter, small) / 2
    return Written(
        (_Piece(letter, start, (height - small) / 2, small),), 2 * radius, height, (_Ring(radius, height / 2, radius),)
    )


def deviations(upper: str, lower: str, height: float = 3.5) -> Written:
    """Return limit deviations one above the other, with their digits aligned. A zero has no sign and is aligned with the
    digits.
    """
    small = max(_SMALL * height, _LEAST)
    sign = text_width("+", small)
    starts = [0.0 if each[:1] in "+−" else sign for each in (upper, lower)]
    air = max(_STACK_AIR * height, reach(upper).below * small + _LEAST_AIR)
    ups = ((height + air) / 2, (height - air) / 2 - small)
    pieces = tuple(_Piece(each, start, up, small) for each, start, up in zip((upper, lower), starts, ups, strict=True))
    width = max(start + text_width(each, small) for each, start in zip((upper, lower), starts, strict=True))
    return Written(pieces, width, height)


def symbol(words: str, height: float = 3.5) -> Written:
    """Return a text with symbols: the part behind a "_" is a subscript, up to a space or a mark ("d_b", "A_sne / A_sni")."""
    whole = plain("", height)
    for number, part in enumerate(_SYMBOL_WITH_SUBSCRIPT.split(words)):
        if part:
            whole = whole.then(_subscript(part, height) if number % 2 else plain(part, height), 0.1 * height * (number % 2))
    return whole


def _subscript(words: str, height: float) -> Written:
    small = max(_SMALL * height, _LEAST)
    return Written((_Piece(words, 0.0, -_SUBSCRIPT_DROP * height, small),), text_width(words, small), height)


_AIR = 0.35
"""Distance between the parts of a size, over the height of its text."""

_MOST_DECIMALS = 4
"""Most decimals of deviations: half of a standard tolerance may end with half a micrometre (JS7 of 8: 0.0075)."""

_OF_CAD = {"\\": "\\\\", "{": "\\{", "}": "\\}", "⌀": "%%c", "±": "%%p", "°": "%%d"}


def written_size(size: Size, words: SheetWords, height: float = 3.5) -> Written:
    """Return a size as a text: value, fit, limit deviations and the E in a ring. Deviations stand one above the other, or
    behind ± if equal. An exact size is in a box.
    """
    opening, closing = ("(", ")") if size.reference else ("", "")
    air = _AIR * height
    whole = plain(opening + _nominal(size, words), height)
    if size.fit:
        whole = whole.then(plain(size.fit, height), air)
    limits = _limits(size, words)
    if limits is not None:
        alike, upper, lower = limits
        whole = whole.then(plain("±" + alike, height) if alike else deviations(upper, lower, height), air)
    if closing:
        whole = whole.then(plain(closing, height))
    if size.envelope:
        whole = whole.then(ringed("E", height), air)
    return boxed(whole) if size.exact else whole


def cad_words(size: Size, words: SheetWords, measured: float) -> str:
    """Return the text of a CAD program's dimension: "%%c<> H7 {\\S+0.025^0;}".

    "<>" stands for what it measures, where that (mm) is what the size is.
    """
    opening, closing = ("(", ")") if size.reference else ("", "")
    nominal = _nominal(size, words)
    if words.shortest(size.value, size.decimals) == words.shortest(measured, size.decimals):
        nominal = size.prefix + "<>" + size.suffix
    parts = [opening + _escaped(nominal)]
    if size.fit:
        parts.append(_escaped(size.fit))
    limits = _limits(size, words)
    if limits is not None:
        alike, upper, lower = limits
        parts.append("%%p" + alike if alike else f"{{\\H0.7x;\\S{upper}^{lower};}}")
    if size.envelope:
        parts.append("(E)")
    return " ".join(parts) + closing


def _nominal(size: Size, words: SheetWords) -> str:
    return size.prefix + words.shortest(size.value, size.decimals) + size.suffix


def _limits(size: Size, words: SheetWords) -> tuple[str, str, str] | None:
    """Return the deviation if both are alike (else ""), the upper and the lower deviation; None without deviations."""
    if size.upper is None or size.lower is None:
        return None
    decimals = max(_decimals(size.upper), _decimals(size.lower))
    upper, lower = (_deviation(each, decimals, words) for each in (size.upper, size.lower))
    alike = upper[1:] if upper.startswith("+") and lower == "−" + upper[1:] else ""
    return alike, upper, lower


def _deviation(value: float, decimals: int, words: SheetWords) -> str:
    text = words.number(value, decimals, signed=True)
    return text if text[:1] in "+−" else "0"


def _decimals(value: float) -> int:
    """Return the number of decimals that a deviation (mm) needs, at most `_MOST_DECIMALS`."""
    text = f"{value:.{_MOST_DECIMALS}f}".rstrip("0")
    return len(text) - text.index(".") - 1


def _escaped(text: str) -> str:
    return "".join(_OF_CAD.get(letter, letter) for letter in text)


_MARGIN = 1.5
"""Distance (mm) between the text of a cell and its side."""

_CLEAR = 0.3
"""Distance (mm) between descending letters or subscripts and the line below them."""


@dataclass(frozen=True)
class Cell:
    """A text, symbols with subscripts if `symbolic` ("d_b"), and limit deviations behind it one above the other."""

    text: str = ""
    limits: tuple[str, str] | None = None
    symbolic: bool = False
    anchor: Anchor = Anchor.LEFT

    def written(self, height: float, room: float) -> tuple[Written, bool]:
        """Return the text of the cell, no longer than `room` (mm), and whether it was shortened. Symbols and limits are never
        shortened.
        """
        if self.symbolic:
            return symbol(self.text, height), False
        behind = None if self.limits is None else deviations(*self.limits, height)
        left = room if behind is None else room - behind.width - 0.35 * height
        text, shortened = fitted(self.text, height, left)
        whole = plain(text, height)
        return (whole if behind is None else whole.then(behind, 0.35 * height)), shortened


def table(
    columns: Sequence[float],
    rows: Sequence[Sequence[Cell]],
    *,
    row_height: float = 6.4,
    height: float = 2.5,
    pen: Pen = Pen.FINE_TEXT,
) -> tuple[Figure, tuple[str, ...]]:
    """Return a table of cells and lines, and the texts that were shortened. The upper left corner is at (0, 0).

    `columns` are their widths; a row of one cell in a table of more columns goes over all of them.
    """
    width, bottom = sum(columns), -len(rows) * row_height
    edges = [sum(columns[:number]) for number in range(len(columns) + 1)]
    shapes: list[Shape] = []
    shortened: list[str] = []
    for number, row in enumerate(rows):
        top = -number * row_height
        shapes.append(Line((0.0, top), (width, top), Pen.TABLE))
        spans = [(0.0, width)] if len(row) == 1 < len(columns) else list(pairwise(edges))
        for cell, (left, right) in zip(row, spans, strict=True):
            shapes.append(Line((left, top), (left, top - row_height), Pen.TABLE))
            written, short = cell.written(height, right - left - 2 * _MARGIN)
            shortened += [cell.text] * short
            along = left + _MARGIN + cell.anchor.along * (right - left - 2 * _MARGIN)
            placed = written.at((along, top - (row_height + height) / 2), cell.anchor, pen=pen)
            shapes += _above(placed, top - row_height + _CLEAR).shapes
        shapes.append(Line((width, top), (width, top - row_height), Pen.TABLE))
    shapes.append(Line((0.0, bottom), (width, bottom), Pen.TABLE))
    return Figure(tuple(shapes)), tuple(shortened)


def _above(figure: Figure, floor: float) -> Figure:
    """Return the figure, moved up if it reaches below a floor (mm)."""
    return figure.moved(0.0, max(0.0, floor - figure.box.bottom)) if figure.shapes else figure
