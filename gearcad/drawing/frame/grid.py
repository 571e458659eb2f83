"""Tables whose texts are made to fit: letters closer or smaller, several lines, an ellipsis last. Lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise

from gearcad.drawing.frame.fitting import Fitted, fit, shortened_notice
from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.sizes import LEAST
from gearcad.drawing.shapes import Box, Figure, Line, Pen, Polyline, Shape

__all__ = ["MARGIN", "grid_upwards", "outlined", "row_of_texts", "ruled"]

MARGIN = 1.5
"""From the side of a cell to its text."""

_AIR = 1.0
"""Least distance of texts from the lines above and below."""


def ruled(columns: Sequence[float], heights: Sequence[float]) -> Figure:
    """Outline and lines of a table of rows from the bottom up, its lower left corner at (0, 0)."""
    across, up = [0.0, *accumulate(columns)], [0.0, *accumulate(heights)]
    lines: list[Shape] = [Line((0.0, each), (across[-1], each), Pen.TABLE) for each in up[1:-1]]
    lines += [Line((each, 0.0), (each, up[-1]), Pen.TABLE) for each in across[1:-1]]
    return Figure((outlined(Box(0.0, 0.0, across[-1], up[-1])), *lines))


def outlined(box: Box) -> Polyline:
    """The thick outline of a table."""
    corners = [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]
    return Polyline.straight(corners, Pen.OUTLINE, closed=True)


def row_of_texts(texts: Sequence[str], columns: Sequence[float], height: float, text: float) -> tuple[list[Fitted], float]:
    """The texts of a row as they fit, and how high it is: as high as asked, or as two lines of small letters need."""
    tallest = max(height, _tall(text))
    fitted = [
        fit(each, column - 2 * MARGIN, text, depth=tallest - 2 * _AIR) for each, column in zip(texts, columns, strict=True)
    ]
    return fitted, height if all(each.depth <= height - 2 * _AIR for each in fitted) else tallest


def _tall(text: float) -> float:
    """Of a row with two lines of smaller letters."""
    return 2 * _AIR + 2.6 * min(text, LEAST) + 0.1


def grid_upwards(
    rows: Sequence[Sequence[str]], keys: Sequence[str], columns: Sequence[float], height: float, text: float, owner: str
) -> Framed:
    """Rows of texts from the bottom up, the lower left corner at (0, 0); `keys` are what notices call the rows."""
    found: list[Framed] = []
    heights: list[float] = []
    starts = [0.0, *accumulate(columns)]
    for key, row in zip(keys, rows, strict=True):
        fitted, high = row_of_texts(row, columns, height, text)
        for (left, _), words, each in zip(pairwise(starts), row, fitted, strict=True):
            bottom = sum(heights) + (high - each.depth) / 2
            pen = Pen.TEXT if heights else Pen.FINE_TEXT  # the heading is at the bottom
            found.append(Framed(each.at((left + MARGIN, bottom), pen=pen), shortened_notice(key, words, each, owner)))
        heights.append(high)
    return sum(found, Framed(ruled(columns, heights)))
