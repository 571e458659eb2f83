"""The gear data table: words, symbol, value with its limits. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate
from typing import Protocol

from gearcad.drawing.frame.fitting import Fitted, fit, shortened_notice
from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.grid import MARGIN, outlined, ruled
from gearcad.drawing.frame.sizes import DataTableSizes
from gearcad.drawing.marks import deviations, symbol
from gearcad.drawing.shapes import Anchor, Box, Figure, Pen, text_width
from gearcad.notice import Notice

__all__ = ["TableRow", "data_table"]

_LEAST = 1.8
"""Height of the smallest letters."""

_LARGEST_LIMITS = 3.5
_STACKED = 1.58
"""How high two limits are one above the other, over the height of the text to which they belong."""

_AIR = 0.8
"""Least distance of texts from the lines above and below."""


class TableRow(Protocol):
    """A row: words, symbol ("d_b" has an index), value, and limits one above the other behind it."""

    @property
    def key(self) -> str: ...
    @property
    def words(self) -> str: ...
    @property
    def symbol(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def limits(self) -> tuple[str, str] | None: ...


def data_table(rows: Iterable[TableRow], title: str, sizes: DataTableSizes, *, columns: int = 1, low: bool = False) -> Framed:
    """The table under its title, the upper right corner at (0, 0); in several columns if asked, in `low` rows.

    A value that is too long is written smaller, then in two lines, then shortened.
    """
    listed = list(rows)
    if not listed:
        return Framed()
    height, width = sizes.least_row if low else sizes.row, sizes.width
    each = -(-len(listed) // columns)
    found = Framed()
    for number, start in enumerate(range(0, len(listed), each)):
        own = listed[start : start + each]
        found += _column(own, sizes, height).moved(number * width, (each - len(own)) * height)
    whole = width * -(-len(listed) // each)
    found = found.moved(0.0, -sizes.heading - each * height) + _heading(title, whole, sizes)
    outline = outlined(Box(0.0, -sizes.heading - each * height, whole, 0.0))
    return (found + Framed(Figure((outline,)))).moved(-whole, 0.0)


def _heading(title: str, width: float, sizes: DataTableSizes) -> Framed:
    """Title, and the unit of what has none; its upper left corner at (0, 0)."""
    units = fit("mm", width / 3, sizes.text)
    head = fit(title, width - 2 * MARGIN - width / 3, 1.4 * sizes.text)
    at = (MARGIN, -(sizes.heading + head.height) / 2)
    figure = head.at(at) + _right_aligned(units, width - MARGIN, -(sizes.heading + units.height) / 2)
    return Framed(figure, shortened_notice("title", title, head, "the gear data table"))


def _column(rows: Sequence[TableRow], sizes: DataTableSizes, height: float) -> Framed:
    """Rows from the top down; the lower left corner of as many rows as there are at (0, 0)."""
    found = Framed(ruled(sizes.columns, [height] * len(rows)))
    for number, row in enumerate(rows):
        found += _row(row, sizes, height).moved(0.0, height * (len(rows) - 1 - number))
    return found


def _row(row: TableRow, sizes: DataTableSizes, height: float) -> Framed:
    """Its lower left corner at (0, 0)."""
    starts = [0.0, *accumulate(sizes.columns)]
    rooms = [each - 2 * MARGIN for each in sizes.columns]
    depth = height - 2 * _AIR
    words = fit(row.words, rooms[0], sizes.text, depth=depth, least=_LEAST)
    found = Framed(words.at((MARGIN, (height - words.depth) / 2), pen=Pen.FINE_TEXT), _notices(row, row.words, words))
    if row.symbol:
        found += Framed(_symbol(row.symbol, rooms[1], sizes.text, height).moved(starts[1] + MARGIN, 0.0))
    left, room = starts[2] + MARGIN, rooms[2]
    if row.limits is not None:
        limits = deviations(*row.limits, _limits_height(row, sizes, height))
        room -= limits.width + 0.4 * sizes.text
    value = fit(row.text, room, sizes.text, depth=depth, least=_LEAST) if row.text else None
    if value is not None:
        figure = value.at((left, (height - value.depth) / 2), pen=Pen.FINE_TEXT)
        found += Framed(figure, _notices(row, row.text, value))
        left = max((each.box.right for each in figure.texts), default=left) + 0.4 * sizes.text
    if row.limits is not None:
        unsigned = not any(each.startswith(("+", "−")) for each in row.limits)
        back = text_width("+", 0.7 * limits.height) if unsigned else 0.0  # there is room for signs before them
        found += Framed(limits.at((left - back, (height - limits.height) / 2)))
    return found


def _limits_height(row: TableRow, sizes: DataTableSizes, height: float) -> float:
    """Of a text to which limits would belong: where there is none they are all there is to read."""
    return sizes.text if row.text else max(sizes.text, min(_LARGEST_LIMITS, (height - 2 * _AIR) / _STACKED))


def _symbol(words: str, room: float, text: float, height: float) -> Figure:
    """As large as it can be, its subscripts above the line below."""
    sizes = [text * (1 - step / 20) for step in range(10) if text * (1 - step / 20) >= _LEAST] or [text]
    written = next((each for size in sizes if (each := symbol(words, size)).width <= room), symbol(words, sizes[-1]))
    return written.at((0.0, max((height - written.height) / 2, written.below + _AIR / 2)))


def _notices(row: TableRow, text: str, fitted: Fitted) -> tuple[Notice, ...]:
    return shortened_notice(row.key, text, fitted, "the gear data table")


def _right_aligned(fitted: Fitted, right: float, up: float) -> Figure:
    return fitted.at((right, up), Anchor.RIGHT, pen=Pen.FINE_TEXT)
