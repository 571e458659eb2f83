"""Symbols of surface texture (ISO 21920-1, drawn as ISO 1302 did): on edges, on leaders, for the rest. Lengths in mm."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.drawing.marks.leaders import leader
from gearcad.drawing.marks.side import Side
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Point, Polyline, Shape, Text, text_width
from gearcad.drawing.words import Draughting

__all__ = ["general_roughness", "roughness", "roughness_symbol"]

_LOW, _HIGH = 1.4, 3.0
"""Heights of the two legs over that of the text (ISO 1302:2002, annex A)."""

_SLOPE = math.tan(math.radians(60.0))
_PLACES = (0.5, 0.3, 0.7, 0.15, 0.85)
"""Where along an edge a symbol may stand."""


def roughness_symbol(value: str, *, height: float = 2.5, side: Side = Side.ABOVE, count: str = "") -> Figure:
    """Removal of material required, and the value ("Ra 1.6"); its point at (0, 0), upright, or (LEFT) read from the right.

    `count` stands before it: of how many surfaces it is ("2×").
    """
    if side not in (Side.ABOVE, Side.LEFT):
        raise ValueError("A symbol would stand upside down: it needs a leader.")
    low, high = _LOW * height, _HIGH * height
    start = high / _SLOPE + 0.25 * height
    tail = start + text_width(value, height) + 0.25 * height
    check = (_at(-low / _SLOPE, low, side), (0.0, 0.0), _at(high / _SLOPE, high, side), _at(tail, high, side))
    bar = Line(_at(-low / _SLOPE, low, side), _at(low / _SLOPE, low, side), Pen.SYMBOL)
    rotation = 90.0 if side.is_upright else 0.0
    text = Text(value, _at(start, high - 1.4 * height, side), height, rotation=rotation)
    before = -low / _SLOPE - 0.3 * height - text_width(count, height)
    counted = [Text(count, _at(before, 0.3 * height, side), height, rotation=rotation)] if count else []
    return Figure.of(Polyline.straight(check, Pen.SYMBOL), bar, text, *counted)


def roughness(start: Point, end: Point, side: Side, value: str, draughting: Draughting, *, count: str = "") -> Iterator[Figure]:
    """On an edge or an extension line from `start` to `end` whose outside is at `side`; below and at the right by a leader.

    `count` says of how many such surfaces it is ("2×").
    """
    places = [(start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part) for part in _PLACES]
    if side in (Side.ABOVE, Side.LEFT):
        for place in places:
            yield roughness_symbol(value, side=side, count=count).moved(*place)
    for place in places:
        yield from _on_leader(place, side, roughness_symbol(value, count=count), draughting)


def _on_leader(place: Point, side: Side, symbol: Figure, draughting: Draughting) -> Iterator[Figure]:
    """The symbol stands on the horizontal part of a leader."""
    directions = {
        Side.ABOVE: (60.0, 120.0, 30.0, 150.0),
        Side.BELOW: (-60.0, -120.0, -30.0, -150.0),
        Side.LEFT: (135.0, -135.0, 160.0, -160.0),
        Side.RIGHT: (45.0, -45.0, 20.0, -20.0),
    }[side]
    box = symbol.box
    foot = Line((box.left, 0.0), (box.right, 0.0), Pen.DIMENSION)
    yield from leader(place, Figure.of(symbol, foot), draughting, directions)


def general_roughness(value: str, at: Point = (0.0, 0.0), *, height: float = 3.5) -> Figure:
    """That of all surfaces without another: the symbol with its value, and a bare one in brackets; its point at `at`."""
    symbol = roughness_symbol(value, height=height)
    low, high = _LOW * height, _HIGH * height
    start = symbol.box.right + 0.6 * height
    bracket = 1.4 * height
    foot = start + text_width("(", bracket) + low / _SLOPE + 0.1 * height
    bare = Polyline.straight([(foot - low / _SLOPE, low), (foot, 0.0), (foot + high / _SLOPE * 0.8, high * 0.8)], Pen.SYMBOL)
    shapes: tuple[Shape, ...] = (
        Text("(", (start, 0.4 * height), bracket),
        bare,
        Text(")", (foot + high / _SLOPE * 0.8 + 0.1 * height, 0.4 * height), bracket, Anchor.LEFT),
    )
    return Figure.of(symbol, *shapes).moved(*at)


def _at(along: float, up: float, side: Side) -> Point:
    """Turned by 90 degrees where the outside is at the left."""
    return (-up, along) if side.is_upright else (along, up)
