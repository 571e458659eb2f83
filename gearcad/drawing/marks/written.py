"""Written: a row of texts of several heights - subscripts, stacked limits, letters in rings. Lengths in mm of paper."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from gearcad.drawing.shapes import Anchor, Box, Circle, Figure, Pen, Point, Polyline, Shape, Text, text_width
from gearcad.drawing.shapes.font import reach

__all__ = ["Written", "boxed", "deviations", "plain", "ringed", "symbol"]

_SMALL, _LEAST = 0.7, 1.8
"""Height of limit deviations and of subscripts over that of the text, and the least (mm) that one can read."""

_SUBSCRIPT_DROP = 0.3
"""How far subscripts stand below the line, over the height."""

_STACK_AIR = 0.18
"""Between the two of a stack, over the height."""

_BOX_AIR = 0.28
"""From a text to the box around it, over the height."""

_LEAST_AIR = 0.1
"""Between letters of the upper one that reach below its line ("µm") and the lower one."""

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
    """Texts, rings and boxes, by where they are along a line and above it; `height` is that of its capitals."""

    pieces: tuple[_Piece, ...]
    width: float
    height: float
    rings: tuple[_Ring, ...] = ()
    boxes: tuple[Box, ...] = ()

    def then(self, other: Written, air: float = 0.0) -> Written:
        """The other behind it, `air` between them."""
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
        """How far it reaches below its line."""
        return max(0.0, -self._box_of_one().bottom)

    @cached_property
    def above(self) -> float:
        """How far it reaches above its line."""
        return self._box_of_one().top

    def _box_of_one(self) -> Box:
        return self.at((0.0, 0.0)).box if self.pieces else Box(0.0, 0.0, 0.0, self.height)

    def at(self, place: Point, anchor: Anchor = Anchor.LEFT, rotation: float = 0.0, pen: Pen = Pen.FINE_TEXT) -> Figure:
        """It at a place; rotation 0 or 90 degrees."""
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
    """A text as it is."""
    return Written((_Piece(words, 0.0, 0.0, height),) if words else (), text_width(words, height), height)


def boxed(written: Written) -> Written:
    """A text in a box, as exact sizes have it (ISO 1101)."""
    air = _BOX_AIR * written.height
    room = plain("", written.height)
    whole = replace(room, width=air).then(written).then(replace(room, width=air))
    return replace(whole, boxes=(*whole.boxes, Box(0.0, -air, whole.width, written.height + air)))


def _corners(box: Box) -> list[Point]:
    return [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]


def ringed(letter: str, height: float = 3.5) -> Written:
    """A letter in a ring, as the E of ISO 14405-1."""
    radius, small = 0.7 * height, 0.8 * height
    start = radius - text_width(letter, small) / 2
    return Written(
        (_Piece(letter, start, (height - small) / 2, small),), 2 * radius, height, (_Ring(radius, height / 2, radius),)
    )


def deviations(upper: str, lower: str, height: float = 3.5) -> Written:
    """Limit deviations one above the other, their digits in line: a zero has no sign, and stands where digits do."""
    small = max(_SMALL * height, _LEAST)
    sign = text_width("+", small)
    starts = [0.0 if each[:1] in "+−" else sign for each in (upper, lower)]
    air = max(_STACK_AIR * height, reach(upper).below * small + _LEAST_AIR)
    ups = ((height + air) / 2, (height - air) / 2 - small)
    pieces = tuple(_Piece(each, start, up, small) for each, start, up in zip((upper, lower), starts, ups, strict=True))
    width = max(start + text_width(each, small) for each, start in zip((upper, lower), starts, strict=True))
    return Written(pieces, width, height)


def symbol(words: str, height: float = 3.5) -> Written:
    """Symbols: what follows a "_" is a subscript, up to a space or a mark ("d_b", "A_sne / A_sni")."""
    whole = plain("", height)
    for number, part in enumerate(_SYMBOL_WITH_SUBSCRIPT.split(words)):
        if part:
            whole = whole.then(_subscript(part, height) if number % 2 else plain(part, height), 0.1 * height * (number % 2))
    return whole


def _subscript(words: str, height: float) -> Written:
    small = max(_SMALL * height, _LEAST)
    return Written((_Piece(words, 0.0, -_SUBSCRIPT_DROP * height, small),), text_width(words, small), height)
