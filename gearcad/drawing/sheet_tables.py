"""Tables on a sheet: gear data, parts list (ISO 7573) and revisions, with texts fitted to their cells (mm)."""

from __future__ import annotations

import unicodedata
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import Protocol

from gearcad.core.records import Notice
from gearcad.drawing.annotation_text import deviations, symbol
from gearcad.drawing.options import Revision
from gearcad.drawing.shapes import STRETCH, Anchor, Box, Figure, Line, Pen, Point, Polyline, Shape, Text, text_width
from gearcad.drawing.sheet_template import LEAST, DataTableSizes, SheetTemplate
from gearcad.drawing.words import SheetWords

CLOSEST = 0.65
"""Width of the narrowest letters over that of the font."""

_HEIGHTS = (14.0, 10.0, 7.0, 5.0, 3.5, 2.5, LEAST)
"""Heights of letters by ISO 3098-1, and the smallest."""

_PITCH = 1.6
"""Distance of lines, over the height of letters."""

_ELLIPSIS = "…"


@dataclass(frozen=True)
class Fitted:
    """Lines of text with one height and width of letters; `kept` is the number of characters left if the text was shortened."""

    lines: tuple[str, ...]
    height: float
    stretch: float = STRETCH
    kept: int | None = None

    @property
    def pitch(self) -> float:
        """Distance from line to line (mm)."""
        return _PITCH * self.height

    @property
    def depth(self) -> float:
        """Height from the last line to the top of the first line's capitals (mm)."""
        return self.height + self.pitch * (len(self.lines) - 1)

    def at(self, place: Point, anchor: Anchor = Anchor.LEFT, pen: Pen = Pen.TEXT) -> Figure:
        """Return the figure of the texts, the last line at a place."""
        up = [self.pitch * (len(self.lines) - 1 - number) for number in range(len(self.lines))]
        texts = zip(self.lines, up, strict=True)
        return Figure(
            tuple(
                Text(line, (place[0], place[1] + above), self.height, anchor, pen=pen, stretch=self.stretch)
                for line, above in texts
                if line
            )
        )


def fit(text: str, room: float, height: float, *, depth: float = 0.0, least: float = LEAST, closest: float = CLOSEST) -> Fitted:
    """Return a text fitted to the width `room` (mm) and the height `depth` (mm; else one line).

    Letters are no smaller than `least`, nor narrower than `closest`. The largest possible letters are taken; of equal ones the
    fewest lines, and narrower letters rather than more lines. A text that does not fit is shortened.
    """
    measured = _Measured.of(text)
    heights = [height, *(each for each in _HEIGHTS if least < each < height), *([least] if least < height else [])]
    for each in heights:
        for count in range(1, _most_lines(each, depth) + 1):
            for stretch in _stretches(measured, room, each, count, closest):
                lines = measured.wrapped(room / (each * stretch))
                if len(lines) <= count:
                    return Fitted(lines, each, stretch)
    smallest = heights[-1]
    count = _most_lines(smallest, depth)
    lines = measured.wrapped(room / (smallest * closest), count)
    if room < text_width(_ELLIPSIS, smallest, closest):
        return Fitted(("",), smallest, closest, 0)
    return Fitted(lines, smallest, closest, sum(map(len, lines)) - 1)


def shortened_notice(key: str, text: str, fitted: Fitted, owner: str) -> tuple[Notice, ...]:
    """Return a notice that a text was shortened; empty if it was not."""
    if fitted.kept is None:
        return ()
    return (Notice("drawing-shortened", f"{owner} has room for {fitted.kept} of its {len(text)} characters", where=key),)


def _most_lines(height: float, depth: float) -> int:
    return max(1, int((depth - height) / (_PITCH * height) + 1 + 1e-9))


def _stretches(measured: _Measured, room: float, height: float, lines: int, closest: float) -> Iterator[float]:
    """Yield the widths of letters to try, the widest first."""
    yield STRETCH
    whole = measured.width * height
    if lines == 1 and whole:
        needed = room / whole * (1 - 1e-9)
        if closest <= needed < STRETCH:
            yield needed
    elif lines > 1:
        yield closest


@dataclass(frozen=True)
class _Measured:
    """A text with the places of its letters, for letters of unit height and width."""

    text: str
    places: Sequence[float]

    @classmethod
    def of(cls, text: str) -> _Measured:
        return cls(text, [0.0, *accumulate(text_width(letter, 1.0, 1.0) for letter in text)])

    @property
    def width(self) -> float:
        return self.places[-1]

    def wrapped(self, room: float, most: int | None = None) -> tuple[str, ...]:
        """Return lines no wider than `room`, broken at spaces where possible.

        There are at most `most` lines; if the text has more, the last line ends with an ellipsis.
        """
        lines: list[str] = []
        start = 0
        while start < len(self.text) or not lines:
            if most is not None and len(lines) == most - 1 and self._reach(start, room) < len(self.text):
                end = self._reach(start, room - text_width(_ELLIPSIS, 1.0, 1.0))
                return (*lines, self.text[start:end].rstrip() + _ELLIPSIS)
            end, start_of_next = self._line(start, room)
            lines.append(self.text[start:end].rstrip())
            start = start_of_next
        return tuple(lines)

    def _reach(self, start: int, room: float) -> int:
        """Return the end of the text from `start` on that has room. It is never before a mark that belongs to the letter
        before it.
        """
        end = bisect_right(self.places, self.places[start] + room + 1e-9) - 1
        while start < end < len(self.text) and _belongs(self.text[end]):
            end -= 1
        return max(end, start)

    def _line(self, start: int, room: float) -> tuple[int, int]:
        """Return the end of a line, and the start of the next."""
        end = max(self._reach(start, room), start + 1)
        if end >= len(self.text) or self.text[end] == " ":
            return end, end + 1
        space = self.text.rfind(" ", start, end)
        return (space, space + 1) if space > start else (end, end)


def _belongs(letter: str) -> bool:
    """Return whether a letter stands on, or joins, the one before it."""
    return unicodedata.combining(letter) > 0 or unicodedata.category(letter) in ("Mn", "Me", "Cf") or letter in "\ufe0f\u200d"


@dataclass(frozen=True)
class Framed:
    """A figure, and notices of the texts that were shortened in it."""

    figure: Figure = field(default_factory=Figure)
    notices: tuple[Notice, ...] = ()

    @property
    def empty(self) -> bool:
        """Whether the figure has no shapes."""
        return not self.figure.shapes

    @property
    def box(self) -> Box:
        """The smallest box that holds the figure. Raises ValueError for an empty one."""
        return self.figure.box

    def moved(self, across: float, up: float) -> Framed:
        """Return the figure moved to the right and up (mm), with its notices."""
        return Framed(self.figure.moved(across, up), self.notices)

    def __add__(self, other: Framed) -> Framed:
        return Framed(self.figure + other.figure, self.notices + other.notices)


MARGIN = 1.5
"""Distance from the side of a cell to its text."""

_CELL_AIR = 1.0
"""Least distance of texts from the lines above and below."""


def ruled(columns: Sequence[float], heights: Sequence[float]) -> Figure:
    """Return the outline and lines of a table with rows from the bottom up, its lower left corner at (0, 0)."""
    across, up = [0.0, *accumulate(columns)], [0.0, *accumulate(heights)]
    lines: list[Shape] = [Line((0.0, each), (across[-1], each), Pen.TABLE) for each in up[1:-1]]
    lines += [Line((each, 0.0), (each, up[-1]), Pen.TABLE) for each in across[1:-1]]
    return Figure((outlined(Box(0.0, 0.0, across[-1], up[-1])), *lines))


def outlined(box: Box) -> Polyline:
    """Return the thick outline of a table."""
    corners = [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]
    return Polyline.straight(corners, Pen.OUTLINE, closed=True)


def row_of_texts(texts: Sequence[str], columns: Sequence[float], height: float, text: float) -> tuple[list[Fitted], float]:
    """Return the fitted texts of a row, and its height (mm): `height`, or as much as two lines of small letters need."""
    tallest = max(height, _tall(text))
    fitted = [
        fit(each, column - 2 * MARGIN, text, depth=tallest - 2 * _CELL_AIR) for each, column in zip(texts, columns, strict=True)
    ]
    return fitted, height if all(each.depth <= height - 2 * _CELL_AIR for each in fitted) else tallest


def _tall(text: float) -> float:
    """Return the height (mm) of a row with two lines of smaller letters."""
    return 2 * _CELL_AIR + 2.6 * min(text, LEAST) + 0.1


def grid_upwards(
    rows: Sequence[Sequence[str]], keys: Sequence[str], columns: Sequence[float], height: float, text: float, owner: str
) -> Framed:
    """Return a table of texts from the bottom up, the lower left corner at (0, 0); `keys` name the rows in notices."""
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


_LEAST = 1.8
"""Height (mm) of the smallest letters."""

_LARGEST_LIMITS = 3.5
_STACKED = 1.58
"""Height of two limits one above the other, over the height of their text."""

_ROW_AIR = 0.8
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
    """Return the table under its title, the upper right corner at (0, 0), in one or several columns; `low` asks for low rows.

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
    """Return the heading: the title, and the unit of values without one; its upper left corner at (0, 0)."""
    units = fit("mm", width / 3, sizes.text)
    head = fit(title, width - 2 * MARGIN - width / 3, 1.4 * sizes.text)
    at = (MARGIN, -(sizes.heading + head.height) / 2)
    figure = head.at(at) + _right_aligned(units, width - MARGIN, -(sizes.heading + units.height) / 2)
    return Framed(figure, shortened_notice("title", title, head, "the gear data table"))


def _column(rows: Sequence[TableRow], sizes: DataTableSizes, height: float) -> Framed:
    """Return rows from the top down, the lower left corner of the last at (0, 0)."""
    found = Framed(ruled(sizes.columns, [height] * len(rows)))
    for number, row in enumerate(rows):
        found += _row(row, sizes, height).moved(0.0, height * (len(rows) - 1 - number))
    return found


def _row(row: TableRow, sizes: DataTableSizes, height: float) -> Framed:
    """Return a row of the gear data table, its lower left corner at (0, 0)."""
    starts = [0.0, *accumulate(sizes.columns)]
    rooms = [each - 2 * MARGIN for each in sizes.columns]
    depth = height - 2 * _ROW_AIR
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
    """Return the text height (mm) from which the size of limits follows: larger where limits stand without a text."""
    return sizes.text if row.text else max(sizes.text, min(_LARGEST_LIMITS, (height - 2 * _ROW_AIR) / _STACKED))


def _symbol(words: str, room: float, text: float, height: float) -> Figure:
    """Return a symbol as large as its cell permits, its subscripts above the line below."""
    sizes = [text * (1 - step / 20) for step in range(10) if text * (1 - step / 20) >= _LEAST] or [text]
    written = next((each for size in sizes if (each := symbol(words, size)).width <= room), symbol(words, sizes[-1]))
    return written.at((0.0, max((height - written.height) / 2, written.below + _ROW_AIR / 2)))


def _notices(row: TableRow, text: str, fitted: Fitted) -> tuple[Notice, ...]:
    return shortened_notice(row.key, text, fitted, "the gear data table")


def _right_aligned(fitted: Fitted, right: float, up: float) -> Figure:
    return fitted.at((right, up), Anchor.RIGHT, pen=Pen.FINE_TEXT)


@dataclass(frozen=True, kw_only=True)
class PartLine:
    """A line of the parts list: `item` is the number in the balloon."""

    item: int
    quantity: int = 1
    number: str = ""
    title: str = ""
    material: str = ""
    remarks: str = ""

    @property
    def texts(self) -> tuple[str, ...]:
        return str(self.item), str(self.quantity), self.number, self.title, self.material, self.remarks


def parts_list(parts: Sequence[PartLine], template: SheetTemplate, words: SheetWords) -> Framed:
    """Return the parts list with its heading at the bottom and the first item above it; the lower right corner at (0, 0).
    Empty without parts.
    """
    if not parts:
        return Framed()
    sizes = template.parts_list
    names = ("item", "quantity", "part_number", "part_title", "part_material", "remarks")
    rows = [tuple(words[f"frame.{name}"] for name in names), *(each.texts for each in parts)]
    keys = ["parts_list", *(f"item {each.item}" for each in parts)]
    found = grid_upwards(rows, keys, sizes.columns, sizes.row, sizes.text, "the parts list")
    return found.moved(-sum(sizes.columns), 0.0)


def revisions(changes: Sequence[Revision], template: SheetTemplate, words: SheetWords) -> Framed:
    """Return the table of revisions with its heading at the bottom and the first revision above it; the lower right corner at
    (0, 0). Empty without revisions.
    """
    if not changes:
        return Framed()
    sizes = template.revisions
    shown = changes[-sizes.most :]
    names = ("revision_index", "revision_text", "revision_date", "revision_name")
    rows = [tuple(words[f"frame.{name}"] for name in names)]
    rows += [(each.index, each.text, each.date, each.name) for each in shown]
    keys = ["revisions", *(f"revision {each.index}" for each in shown)]
    found = grid_upwards(rows, keys, sizes.columns, sizes.row, sizes.text, "the table of revisions")
    if len(shown) < len(changes):
        text = f"the table of revisions shows the last {len(shown)} of {len(changes)}"
        found += Framed(notices=(Notice("drawing-shortened", text, where="revisions"),))
    return found.moved(-sum(sizes.columns), 0.0)
