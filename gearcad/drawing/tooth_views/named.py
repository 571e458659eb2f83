"""The circles and lines of a tooth, each with its name and value beside its right end. Lengths in mm of paper."""

from __future__ import annotations

from gearcad.drawing.marks import Written, plain, symbol
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen
from gearcad.drawing.tooth_views.levels import Level
from gearcad.drawing.tooth_views.placing import Placing
from gearcad.drawing.tooth_views.spread import spread
from gearcad.drawing.words import Draughting

__all__ = ["named_levels"]

_BEYOND = 4.0
"""How far a level goes on behind the middle of the space."""

_KNEE, _SLANT = 1.0, 4.0
"""Length of the level part of what leads to a name, and width of the slanting one."""

_AIR = 1.0
_TEXT, _LINE = 2.5, 4.2
"""Height of names, and from line to line."""


def named_levels(levels: tuple[Level, ...], place: Placing, draughting: Draughting) -> Figure:
    """Each from the right flank on, the reference circle and those not on the tooth all across."""
    right = place.further(place.middle_of_space, _BEYOND)
    ends = [place.point(level.height, right) for level in levels]
    knee = max(x for x, _ in ends) + _KNEE
    rows = spread([y for _, y in ends], _LINE)
    shapes = []
    for level, (x, y), row in zip(levels, ends, rows, strict=True):
        shapes.append(Figure.of(place.level(level.height, _start(level, place), right, level.pen)))
        shapes.append(Figure.of(Line((x, y), (knee, y), Pen.THIN), Line((knee, y), (knee + _SLANT, row), Pen.THIN)))
        shapes.append(_name(level, draughting).at((knee + _SLANT + _AIR, row), Anchor.MIDDLE_LEFT))
    return Figure.of(*shapes)


def _start(level: Level, place: Placing) -> float:
    flank = place.flank(level.height)
    return -place.middle_of_space if flank is None or level.pen is Pen.CENTRE else flank


def _name(level: Level, draughting: Draughting) -> Written:
    """Its symbol and value, the value in brackets where it stands elsewhere."""
    value = draughting.words.number(level.value, level.decimals)
    prefix = "⌀" if level.symbol.startswith("d") else ""
    text = f"({prefix}{value})" if level.reference else prefix + value
    return symbol(level.symbol, _TEXT).then(plain(text, _TEXT), 1.2)
