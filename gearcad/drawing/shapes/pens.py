"""Pen: the kinds of lines on a sheet, by ISO 128-2; each is a layer of the DXF. Lengths in mm."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

__all__ = ["Pen", "Stroke"]


class Stroke(NamedTuple):
    """Width of a line of group 0.5, and the lengths of its dashes and gaps in turn; none for a continuous line."""

    width: float
    dashes: tuple[float, ...] = ()


_LONG_DASH_DOT = (12.0, 3.0, 0.5, 3.0)
_DASHED = (3.0, 0.75)


class Pen(Enum):
    """With what a shape is drawn; its value is the name of a layer."""

    OUTLINE = "OUTLINE"
    """Visible edges."""

    THIN = "THIN"
    """Root circles outside, directions of flanks, construction."""

    CENTRE = "CENTRE"
    """Axes, and reference circles."""

    HIDDEN = "HIDDEN"
    """Edges behind others."""

    DIMENSION = "DIM"
    HATCH = "HATCH"
    SYMBOL = "SYMBOL"
    """Roughness, tolerance frames, datums, arrows."""

    FRAME = "FRAME"
    GRID = "GRID"
    """Fields beside the frame."""

    TABLE = "TABLE"
    """Lines within tables and title block."""

    TEXT = "TEXT"
    """Values."""

    FINE_TEXT = "TEXT_S"
    """Captions, and the text of dimensions."""

    @property
    def stroke(self) -> Stroke:
        """Width and dashes of its lines."""
        return _STROKES[self]


_STROKES = {
    Pen.OUTLINE: Stroke(0.5),
    Pen.THIN: Stroke(0.25),
    Pen.CENTRE: Stroke(0.25, _LONG_DASH_DOT),
    Pen.HIDDEN: Stroke(0.25, _DASHED),
    Pen.DIMENSION: Stroke(0.25),
    Pen.HATCH: Stroke(0.18),
    Pen.SYMBOL: Stroke(0.25),
    Pen.FRAME: Stroke(0.7),
    Pen.GRID: Stroke(0.35),
    Pen.TABLE: Stroke(0.25),
    Pen.TEXT: Stroke(0.35),
    Pen.FINE_TEXT: Stroke(0.25),
}
