"""Tables: rows of cells whose texts are made to fit. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from gearcad.drawing.marks.written import Written, deviations, plain, symbol
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Shape, fitted

__all__ = ["Cell", "table"]

_MARGIN = 1.5
"""Between the text of a cell and its side."""

_CLEAR = 0.3
"""Between letters that reach down, of subscripts too, and the line below them."""


@dataclass(frozen=True)
class Cell:
    """A text, symbols with subscripts if `symbolic` ("d_b"), and limit deviations behind it one above the other."""

    text: str = ""
    limits: tuple[str, str] | None = None
    symbolic: bool = False
    anchor: Anchor = Anchor.LEFT

    def written(self, height: float, room: float) -> tuple[Written, bool]:
        """No longer than `room`, and whether it was shortened for that; symbols and limits never are."""
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
    """Cells within lines, the upper left corner at (0, 0), downwards; and the texts that had to be shortened.

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
    """Higher, if it reaches below a floor."""
    return figure.moved(0.0, max(0.0, floor - figure.box.bottom)) if figure.shapes else figure
