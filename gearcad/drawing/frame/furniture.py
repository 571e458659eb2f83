"""All that frames the views of a sheet, each part in its place: border, title block, lists, table, notes. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from gearcad.drawing.frame.border import border, free_area, inside_frame
from gearcad.drawing.frame.data_table import TableRow, data_table
from gearcad.drawing.frame.framed import Framed
from gearcad.drawing.frame.lists import PartLine, parts_list, revisions
from gearcad.drawing.frame.notes import common_notes, notes
from gearcad.drawing.frame.sizes import DataTableSizes
from gearcad.drawing.frame.template import SheetTemplate
from gearcad.drawing.frame.title_block import title_block
from gearcad.drawing.options import DrawingOptions, SheetSize
from gearcad.drawing.shapes import Box, Figure
from gearcad.drawing.words import Words
from gearcad.notice import Notice

__all__ = ["Furnished", "Furniture"]

_GAP = 4.0
"""Between parts, and from the frame to the notes."""

_MANY = 12
"""Rows of a table that is not drawn in two columns where these are narrower than they should be."""

_ONCE = ("material", "heat_treatment")
"""Keys of rows that title blocks have, too."""

_LEAST_NOTES = 60.0
"""Width of the narrowest notes beside the title block; on narrower sheets they stand above it."""


@dataclass(frozen=True)
class Furnished:
    """A sheet without its views: `free` is where these may stand, but for the boxes that are `taken`."""

    figure: Figure = field(repr=False)
    free: Box
    taken: tuple[Box, ...]
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Furniture:
    """What stands on a sheet beside views, whatever the size of the sheet.

    `notes` come before those of the options; the common ones (edges, standards) before both. `table_title` and `rows` are the
    gear data table.
    """

    options: DrawingOptions
    template: SheetTemplate
    words: Words
    rows: Sequence[TableRow] = ()
    table_title: str = ""
    notes: Sequence[str] = ()
    parts: Sequence[PartLine] = ()

    def on(self, size: SheetSize, values: Mapping[str, str]) -> Furnished:
        """All of it on a sheet, the paper's lower left corner at (0, 0); `values` as of `title_values`.

        The table is in lower rows or in several columns where it would not have room above the title block, and without
        what stands in that. Nothing is `free` where it has no room at all.
        """
        frame = inside_frame(size, self.template.frame)
        stack = self._stack(values, frame)
        texts = self._notes(frame, stack.box)
        above = texts if not texts.empty and texts.box.bottom > stack.box.top else stack
        table = self._table(self._rows(values), frame, frame.top - above.box.top - _GAP)
        parts = [each for each in (stack, table, texts) if not each.empty]
        taken = tuple(each.box for each in parts)
        figure = border(size, self.template.frame, taken)
        notices = tuple(notice for each in parts for notice in each.notices)
        crowded = any(one.meets(other) for one in taken for other in taken if one is not other)
        outside = any(not frame.grown(1e-6).holds(each) for each in taken)
        free = free_area(size, self.template.frame)
        if crowded or outside:
            free = Box(free.left, free.bottom, free.left, free.bottom)
        return Furnished(Figure.of(figure, *(each.figure for each in parts)), free, taken, notices)

    def _stack(self, values: Mapping[str, str], frame: Box) -> Framed:
        """Title block, parts list and revisions upon each other, in the lower right corner."""
        block = title_block(values, self.template, self.words, self.options.projection)
        found = block.moved(frame.right, frame.bottom)
        for each in (
            parts_list(self.parts, self.template, self.words),
            revisions(self.options.changes, self.template, self.words),
        ):
            found = found if each.empty else found + each.moved(frame.right, found.box.top)
        return found

    def _rows(self, values: Mapping[str, str]) -> list[TableRow]:
        """Those of the table: a sheet says material and treatment once, in its title block if that has cells for them."""
        titled = {name for cell in self.template.cells.values() for name in cell.names if values.get(name)}
        return [row for row in self.rows if row.key not in titled or row.key not in _ONCE]

    def _table(self, rows: Sequence[TableRow], frame: Box, room: float) -> Framed:
        """The gear data table in the upper right corner, in the first form that is no higher than `room`."""
        table = Framed()
        for sizes, columns, low in self._forms(len(rows), frame.width):
            table = data_table(rows, self.table_title, sizes, columns=columns, low=low)
            if table.empty or table.box.height <= room:
                break
        return table.moved(frame.right, frame.top)

    def _forms(self, rows: int, width: float) -> Iterator[tuple[DataTableSizes, int, bool]]:
        """Sizes, number of columns, and whether rows are low; on narrow paper two columns as wide as that for many rows."""
        sizes = self.template.data_table
        most = int(width / sizes.width)
        if most < 2 and rows > _MANY:
            yield sizes.narrowed(width / 2), 2, True
        yield from ((sizes, columns, low) for columns in range(1, max(most, 1) + 1) for low in (False, True))

    def _notes(self, frame: Box, stack: Box) -> Framed:
        """The notes left of the title block, else above what stands on that."""
        lines = [*common_notes(self.options, self.template, self.words), *self.notes, *self.options.notes]
        beside = stack.left - frame.left - 2 * _GAP
        if beside >= _LEAST_NOTES:
            width = min(beside, self.template.notes.width)
            return notes(lines, self.template, width).moved(frame.left + _GAP, frame.bottom + _GAP)
        return notes(lines, self.template, frame.width - 2 * _GAP).moved(frame.left + _GAP, stack.top + _GAP)
