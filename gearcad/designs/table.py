"""Design tables: one row a design, columns are the keys of a spec flattened with dots (`pinion.rack.root_radius`).

A table is read row by row, so that its length does not matter; every fault names row, column and key.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.designs.cells import CellReader, Layout, RawCell, is_blank, is_comment, plain_text
from gearcad.designs.design import Design, DesignKind, require_plain_name
from gearcad.designs.headings import column_letter, kinds_of, read_headings
from gearcad.designs.keys import Cell
from gearcad.designs.named_files import names_file, with_files_found
from gearcad.designs.reader import design_from_values
from gearcad.designs.sheets import Record, Sheet, open_sheet
from gearcad.designs.train_keys import general_key
from gearcad.designs.trials import fault_alone, missing_faults, permitted_alone
from gearcad.errors import ParameterError, SpecError, format_number, printable, shown, shown_path

__all__ = ["Row", "Table", "open_table"]

_LONGEST_SHOWN = 60
"""Most characters of a name that a message repeats."""


@dataclass(frozen=True)
class Row:
    """One design of a table: its values under their full keys, blank cells left out.

    `number` counts rows as a spreadsheet does. `faults` are whole messages about cells that could not be read, `unread` the
    keys of these; without keys it is the whole row that could not. `table` and `columns` (the keys by place, "" under a
    blank heading) locate a key in messages.
    """

    number: int
    name: str
    values: dict[str, Cell]
    faults: tuple[str, ...]
    unread: tuple[str, ...]
    table: str
    columns: tuple[str, ...]

    def where(self, key: str) -> str:
        """The place of a key for the beginning of a message: file, row, column if it has one, name of the design."""
        return _place(self.table, self.number, self._index(key), self.name)

    def design(self) -> Design:
        """The design. Raises SpecError for the first fault."""
        if self.faults:
            raise SpecError(self.faults[0], "".join(self.unread[:1]))
        self._require_name()
        values = with_files_found(self.values, Path(self.table).parent)
        return design_from_values(values, self._kind(), where=self.where, default_name=self.name)

    @property
    def inputs(self) -> dict[str, Any]:
        """All that decides what it makes: its name and values, and what stands in the files that they name."""
        files = {key: each for key, each in self.values.items() if names_file(key)}
        found = with_files_found(files, Path(self.table).parent)
        return {"name": self.name, **self.values, **{f"{key}: text": _text_of(Path(str(file))) for key, file in found.items()}}

    def all_faults(self) -> list[str]:
        """Every fault of the row that does not depend on another, from left to right; [] for a good row."""
        found = self.design_or_faults()
        return found if isinstance(found, list) else []

    def design_or_faults(self) -> Design | list[str]:
        """The design, or every fault of the row that does not depend on another, from left to right.

        They are the cells that cannot be read, or else what fails first in making the design; then every value that is
        wrong whatever the others are, and every one that is missing.
        """
        if self.faults and not self.unread:
            return list(self.faults)
        found = list(zip(self.unread, self.faults, strict=True))
        if not found:
            try:
                return self.design()
            except SpecError as error:
                found.append((error.key, str(error)))
        found += [(error.key, str(error)) for error in self._single_faults()]
        return [text for _, text in sorted(dict.fromkeys(found), key=lambda fault: self._index(fault[0]))]

    def _single_faults(self) -> Iterator[SpecError]:
        """The faults of the name, of every value by itself, and of what is missing."""
        if "name" not in self.unread:
            try:
                self._require_name()
            except SpecError as error:
                yield error
        kinds = kinds_of(self.columns)
        of = next((kind for kind in (DesignKind.TRAIN, DesignKind.PLANETARY) if kind in kinds), None)
        for key, value in self.values.items():
            if not permitted_alone(key, value, of=of) and (fault := fault_alone(key, value, self.where, of=of)):
                yield fault
        try:
            kind = self._kind()
        except SpecError as error:
            yield error
        else:
            yield from missing_faults((*self.values, *self.unread), kind, self.where)

    def _require_name(self) -> None:
        try:
            require_plain_name(self.name)
        except ParameterError as error:
            raise SpecError(f"{self.where('name')}: {error}", "name") from error

    def _kind(self) -> DesignKind:
        """What the table makes; in one of gears and pairs, what the row has values for. Raises SpecError."""
        kinds = kinds_of(self.columns)
        if len(kinds) > 1:
            filled = (*self.values, *self.unread)
            kinds = kinds_of(filled)
            if len(kinds) > 1:
                raise self._of_two_kinds(filled, kinds)
            if not kinds:
                raise SpecError(f"{self.where('')}: makes nothing: every cell of gear, pair, pinion and wheel is blank")
        return next(iter(kinds), DesignKind.GEAR)

    def _of_two_kinds(self, filled: Sequence[str], kinds: Collection[DesignKind]) -> SpecError:
        """The fault of a row whose values are of several kinds."""
        other = "gear" if DesignKind.GEAR in kinds else "wheel" if DesignKind.PAIR in kinds else "pair"
        key = next(key for key in filled if not kinds_of([key]) & kinds_of([f"{other}."]))
        made = "a gear or a pair" if other == "gear" else "one with a wheel or with a rack"
        return SpecError(f"{self.where(key)}: {key}: cannot stand beside keys of {other}: a row makes {made}", key)

    def _index(self, key: str) -> int:
        """Place from 0 of the column with the key, else with what both gears or all parts of a train share; or -1."""
        owner, _, field = key.partition(".")
        homes = (key, f"pair.{field}" if owner in ("pinion", "wheel", "rack") else general_key(key))
        return next((self.columns.index(home) for home in homes if home and home in self.columns), -1)


@dataclass(frozen=True)
class Table:
    """A design table whose heading is in order; `columns` as in Row."""

    path: Path
    columns: tuple[str, ...]
    sheet: Sheet

    @property
    def keys(self) -> tuple[str, ...]:
        """Full key of every column with a heading, in order; "name" is one."""
        return tuple(key for key in self.columns if key)

    def rows(self) -> Iterator[Row]:
        """The designs, from the first with every call. Raises SpecError where the file cannot be read on."""
        reader = CellReader(self.sheet.layout)
        with _readable(self.path):
            records = _filled(self.sheet)
            next(records, None)  # the heading
            for number, cells in records:
                yield self._row(number, cells, reader)

    def _row(self, number: int, cells: Sequence[RawCell], reader: CellReader) -> Row:
        name = self._name(cells)
        values: dict[str, Cell] = {}
        faults: list[str] = []
        unread: list[str] = []
        for index, (key, cell) in enumerate(zip(self.columns, cells, strict=False)):
            if not key or cell is None or cell == "":
                continue
            try:
                value = reader.value(key, cell, number)
            except ParameterError as error:
                faults.append(f"{_place(str(self.path), number, index, name)}: {error}")
                unread.append(key)
                continue
            if value is not None and key != "name":
                values[key] = value
        if stray := self._stray(number, cells, name):
            # The cells may have moved: none can be trusted.
            values, faults, unread = {}, [stray], []
        return Row(number, name, values, tuple(faults), tuple(unread), str(self.path), self.columns)

    def _name(self, cells: Sequence[RawCell]) -> str:
        index = self.columns.index("name")
        return plain_text(cells[index]) if index < len(cells) else ""

    def _stray(self, number: int, cells: Sequence[RawCell], name: str) -> str:
        """The fault of the first cell without a heading above it, or ""."""
        width = len(self.columns)
        for index, cell in enumerate(cells):
            if (index >= width or not self.columns[index]) and not is_blank(cell):
                hint = "; a decimal comma needs semicolons between the cells" if self.sheet.layout is Layout.COMMA else ""
                place = _place(str(self.path), number, index, name)
                return f"{place}: {format_number(plain_text(cell))}: has no heading above it{hint}"
        return ""


def open_table(path: Path | str) -> Table:
    """The design table in a CSV or .xlsx file. Raises SpecError with one line per fault of its heading."""
    path = Path(path)
    with _readable(path):
        sheet = open_sheet(path)
        heading = next(_filled(sheet), None)
    if heading is None:
        raise SpecError(f"{path}: has no heading; `gearcad new pairs` makes a table that has one")
    number, cells = heading
    return Table(path, read_headings(cells, f"{path} row {number}"), sheet)


def _text_of(file: Path) -> str:
    """What a file holds; nothing where it cannot be read, which its reader will say."""
    try:
        return file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        hint = "give a design table, or make one with `gearcad new pairs`"
        raise SpecError(f"{shown_path(path)}: cannot be read ({error.strerror or error}); {hint}") from error


def _filled(sheet: Sheet) -> Iterator[Record]:
    """The records that are neither blank nor a comment."""
    for number, cells in sheet.records():
        if not is_comment(cells) and not all(map(is_blank, cells)):
            yield number, cells


def _place(table: str, number: int, index: int, name: str) -> str:
    column = "" if index < 0 else f" column {column_letter(index)}"
    return f"{printable(table)} row {number}{column}{f' ({shown(name, _LONGEST_SHOWN)})' if name else ''}"
