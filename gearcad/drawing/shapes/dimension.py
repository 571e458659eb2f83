"""Dimension: a size with its line, arrows and text; CAD programs take it as one. Lengths in mm of paper."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import Self

from gearcad.drawing.shapes.box import Box
from gearcad.drawing.shapes.shapes import Point, Segment, Shape

__all__ = ["Dimension", "Measured"]


class Measured(Enum):
    """What a dimension says of two points."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"


@dataclass(frozen=True)
class Dimension(Shape):
    """What one sees of a dimension are its `parts`: lines, arrows and texts.

    A CAD program that draws it anew has the points `first` and `second` that are measured, a point `line` of the dimension
    line, and `words` as its dimensions hold them ("%%c40 H7 {\\S+0.025^0;}"; "<>" stands for what it measures).
    `scale` is mm of paper for a mm of the part, None for that of the sheet: details have their own.
    """

    measured: Measured
    first: Point
    second: Point
    line: Point
    words: str
    parts: tuple[Shape, ...]
    scale: float | None = None

    def moved(self, across: float, up: float) -> Self:
        first, second, line = ((x + across, y + up) for x, y in (self.first, self.second, self.line))
        return replace(self, first=first, second=second, line=line, parts=tuple(each.moved(across, up) for each in self.parts))

    @property
    def box(self) -> Box:
        return Box.of_all(part.box for part in self.parts)

    @property
    def segments(self) -> list[Segment]:
        return [segment for part in self.parts for segment in part.segments]
