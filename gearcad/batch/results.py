"""The table of results: one line per row of the design table, in its order, as CSV and - with pyarrow - as Parquet.

Beside it, columns.csv says what its columns hold.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, Protocol

from gearcad.batch.row import Record
from gearcad.designs.columns import column_of_train, column_symbol
from gearcad.designs.csv_cells import Decimal, cell_text, write_csv
from gearcad.designs.table import Row
from gearcad.output import staged_files
from gearcad.symbols import Symbol

__all__ = ["FILES", "Decimal", "Results", "write_results"]

RESULTS = "results.csv"
COLUMNS = "columns.csv"
PARQUET = "results.parquet"
FILES = (RESULTS, COLUMNS, PARQUET)
"""What `write_results` writes: the names are not for a design, nor for the table itself."""

_ROWS_PER_GROUP = 300
"""What Parquet holds in memory before it writes: more rows make smaller files, fewer a smaller process."""


class Results(Protocol):
    """Something that yields every row with its record, again on each call."""

    def results(self) -> Iterator[tuple[Row, Record]]: ...


def write_results(journal: Results, folder: Path, workspace: Path, decimal: Decimal = Decimal.POINT) -> list[Path]:
    """Write results.csv and columns.csv, and results.parquet where pyarrow is installed, by way of `workspace`.

    Texts that a spreadsheet would run as a formula get an apostrophe in front. Raises OutputError.
    """
    columns = _columns(journal)
    found = (_cells(row, record) for row, record in journal.results())
    lines = ([cell_text(cells.get(heading), decimal) for heading in columns] for cells in found)
    with staged_files(folder, workspace) as staging:
        write_csv(lines, columns, staging / RESULTS, decimal)
        of_trains = any(heading.startswith("planetary.") for heading in columns)
        explained = map(partial(_explained, column_of_train if of_trains else column_symbol), columns)
        write_csv(explained, _EXPLAINED, staging / COLUMNS, decimal)
        if importlib.util.find_spec("pyarrow") is not None:
            _write_parquet(journal, columns, staging / PARQUET)
        return [folder / name for name in FILES if (staging / name).exists()]


def _groups(row: Row, record: Record) -> tuple[dict[str, Any], ...]:
    """One line under its headings: how the row ended, its files, its inputs, and what is derived.

    What was derived stands in the place of the input it came from, such as "auto".
    """
    states = {
        "name": row.name,
        "status": record.status.value,
        "error": record.error or None,
        "warnings": "; ".join(record.warnings) or None,
        "seconds": record.seconds,
    }
    files = {f"files.{file}": f"{row.name}/{file}" for file in record.files}
    inputs = {key: record.values.get(key, row.values.get(key)) for key in row.columns if key not in ("", "name")}
    derived = {key: value for key, value in record.values.items() if key not in inputs}
    return states, files, inputs, derived


def _cells(row: Row, record: Record) -> dict[str, Any]:
    return {heading: value for group in _groups(row, record) for heading, value in group.items()}


def _columns(journal: Results) -> dict[str, type]:
    """Headings in order, group by group, and the one type (int, float, bool or str) that holds all cells of each.

    Several numbers in a cell are a text.
    """
    columns: list[dict[str, type | None]] = [{}, {}, {}, {}]
    for row, record in journal.results():
        for kinds, cells in zip(columns, _groups(row, record), strict=True):
            for heading, value in cells.items():
                kinds[heading] = _common(kinds.get(heading), None if value is None else type(value))
    return {heading: str if kind in (None, tuple) else kind for kinds in columns for heading, kind in kinds.items()}


def _common(one: type | None, other: type | None) -> type | None:
    """The type that holds cells of both; None for that of no cell."""
    if one is None or other is None or one is other:
        return one or other
    return float if {one, other} == {int, float} else str


_EXPLAINED = ("column", "symbol", "unit", "of", "words", "source")


def _explained(symbol_of: Callable[[str], tuple[str, Symbol] | None], heading: str) -> Sequence[str]:
    """The line of columns.csv for a column."""
    if heading.startswith("files."):
        return heading, "", "", "", "path of a file, from the folder of this table", ""
    owner, symbol = symbol_of(heading) or ("", Symbol("", "", "", ""))
    return heading, symbol.symbol, symbol.unit, owner, symbol.words, symbol.source


def _write_parquet(journal: Results, columns: Mapping[str, type], path: Path) -> None:
    import pyarrow
    from pyarrow.parquet import ParquetWriter

    kinds = {int: pyarrow.int64(), float: pyarrow.float64(), bool: pyarrow.bool_(), str: pyarrow.string()}
    schema = pyarrow.schema([(heading, kinds[kind]) for heading, kind in columns.items()])
    lines = (_cells(row, record) for row, record in journal.results())
    with ParquetWriter(path, schema) as writer:
        while group := list(islice(lines, _ROWS_PER_GROUP)):
            arrays = [
                pyarrow.array([_as(kind, cells.get(heading)) for cells in group], kinds[kind])
                for heading, kind in columns.items()
            ]
            writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema))


def _as(kind: type, value: Any) -> Any:
    if isinstance(value, tuple):
        return cell_text(value)
    return None if value is None else kind(value)
