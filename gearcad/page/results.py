"""A table of results on the page: its columns of numbers, and the design of any of its rows as a spec."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from io import StringIO
from pathlib import Path
from typing import Any

from gearcad.batch.row import flat_document
from gearcad.designs.cells import CellReader, Layout, plain_number, plain_text
from gearcad.designs.design import Design, DesignKind
from gearcad.designs.headings import read_headings
from gearcad.designs.keys import MAIN_TABLES, Cell
from gearcad.designs.named_files import files_only_in
from gearcad.designs.pair_text import toml_text
from gearcad.designs.reader import nested
from gearcad.designs.table import Row
from gearcad.errors import GearcadError, SpecError
from gearcad.plots.table_data import opened_records

__all__ = ["ResultsTable", "read_results"]

MOST_ROWS = 50_000

_STATES = ("name", "status", "error", "warnings", "seconds")
"""Columns before those of files and inputs."""

_SAME = 1e-9
"""Relative deviation of a figure that is made again from the one in the table."""


@dataclass(frozen=True)
class ResultsTable:
    """The rows that are ok of a table of results, each with the number that a spreadsheet gives it."""

    name: str
    headings: tuple[str, ...]
    rows: Mapping[int, Sequence[str]] = field(repr=False)

    @cached_property
    def numbers(self) -> tuple[str, ...]:
        """Columns that hold numbers, in any row."""
        places = {heading: place for place, heading in enumerate(self.headings) if not heading.startswith("files.")}
        return tuple(
            heading
            for heading, place in places.items()
            if any(plain_number(cells[place]) is not None for cells in self.rows.values())
        )

    def points(self, *columns: str) -> Iterator[tuple[int, tuple[float, ...]]]:
        """Rows that have numbers in all of these columns: their numbers, and these."""
        places = [self.headings.index(column) for column in columns]
        for number, cells in self.rows.items():
            values = [plain_number(cells[place]) for place in places]
            if None not in values:
                yield number, tuple(value for value in values if value is not None)

    def called(self, number: int) -> str:
        """The name of the design of a row."""
        return plain_text(self.rows[number][self.headings.index("name")])

    @cached_property
    def _inputs(self) -> tuple[str, ...]:
        """The columns that can be inputs: all keys of a design behind the files, up to the first that is none.

        Derived quantities follow the inputs, and some of them have names of inputs.
        """
        found: list[str] = []
        for heading in self.headings:
            if heading in _STATES or heading.startswith("files."):
                continue
            try:
                read_headings(("name", *found, heading), self.name)
            except SpecError:
                break
            found.append(heading)
        return tuple(found)

    def spec(self, number: int, folder: Path) -> str:
        """The spec of a row: the fewest of its first columns that make its figures again. Raises SpecError.

        Files that it names must be in `folder`.
        """
        cells = {heading: cell for heading, cell in zip(self.headings, self.rows[number], strict=True) if cell}
        where, fault = f"{self.name} row {number}", "it has no inputs"
        values, reader = dict[str, Cell](), CellReader(Layout.COMMA)
        for count, key in enumerate(self._inputs, 1):
            if key not in cells:
                continue
            try:
                if (value := reader.value(key, cells[key], number)) is None:
                    continue
                values[key] = value
                row = Row(number, self.called(number), values, (), (), str(folder / self.name), ("name", *self._inputs[:count]))
                with files_only_in(folder):
                    design = row.design()
            except GearcadError as error:
                fault = str(error)
                continue
            if _explains(design, {key: cells[key] for key in self._inputs[count:] if key in cells}):
                return _text(design, values, where)
        raise SpecError(f"{where}: makes no design again: {fault}")


def read_results(text: str, name: str) -> ResultsTable:
    """A table of results, called `name`. Raises SpecError for what is none."""
    with opened_records(StringIO(text, newline=""), name) as (headings, records):
        if "name" not in headings:
            raise SpecError(f"{name}: is no table of results, for it has no column name")
        status, rows = headings.index("status"), dict[int, Sequence[str]]()
        for number, cells in enumerate(records, 2):
            if len(cells) == len(headings) and cells[status] == "ok":
                rows[number] = cells
            if len(rows) > MOST_ROWS:
                raise SpecError(f"{name}: has more than {MOST_ROWS} rows; take a part of it")
    if not rows:
        raise SpecError(f"{name}: has nothing to show: no row is ok")
    return ResultsTable(name, tuple(headings), rows)


def _explains(design: Design, cells: Mapping[str, str]) -> bool:
    """Whether the cells that could still be inputs are what the design gives by itself."""
    figures = dict(flat_document(design.to_dict()))
    return all(key in figures and _is_same(figures[key], cell) for key, cell in cells.items())


def _is_same(figure: Any, cell: str) -> bool:
    """Whether a cell of the table is a figure; several numbers, and words, are what they are."""
    number = plain_number(cell)
    if number is None or isinstance(figure, bool) or not isinstance(figure, int | float):
        return figure is not None
    return math.isclose(figure, number, rel_tol=_SAME, abs_tol=_SAME)


def _text(design: Design, values: Mapping[str, Cell], where: str) -> str:
    """The spec of these values."""
    if design.kind is DesignKind.TRAIN:
        import tomlkit

        from gearcad.designs.train_values import tables_of

        tables: dict[str, Any] = tables_of(values, lambda _key: where).tables
        tables["train"] = {"name": design.name, **tables["train"]}
        return f"# {where}\n\n{tomlkit.dumps(tables)}"
    tables = nested(values, design.kind)
    main = MAIN_TABLES[design.kind][0]
    return toml_text(tables | {main: {"name": design.name, **tables[main]}}, [where])
