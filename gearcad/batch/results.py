"""The table of results: one line per row of the design table, in its order, as CSV and - with pyarrow - as Parquet."""

from __future__ import annotations

import csv
import importlib.util
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, Protocol

from gearcad.batch.row import Record
from gearcad.output import staged_files
from gearcad.spec.cells import guarded_text, list_text
from gearcad.spec.table import Row

__all__ = ["RESULTS", "Results", "write_results"]

RESULTS = "results.csv"
PARQUET = "results.parquet"

_ROWS_PER_GROUP = 300
"""What Parquet holds in memory before it writes: more rows make smaller files, fewer a smaller process."""


class Results(Protocol):
    """Something that yields every row with its record, again on each call."""

    def results(self) -> Iterator[tuple[Row, Record]]: ...


def write_results(journal: Results, folder: Path, workspace: Path) -> list[Path]:
    """Write results.csv (UTF-8, comma, decimal point), and results.parquet where pyarrow is installed, by way of `workspace`.

    Texts that a spreadsheet would run as a formula get an apostrophe in front. Raises OutputError.
    """
    columns = _columns(journal)
    with staged_files(folder, workspace) as staging:
        _write_csv(journal, columns, staging / RESULTS)
        if importlib.util.find_spec("pyarrow") is not None:
            _write_parquet(journal, columns, staging / PARQUET)
        return [folder / file.name for file in sorted(staging.iterdir())]


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
    given = {key: list_text(value) if isinstance(value, tuple) else value for key, value in row.values.items()}
    inputs = {key: record.values.get(key, given.get(key)) for key in row.columns if key not in ("", "name")}
    derived = {key: value for key, value in record.values.items() if key not in inputs}
    return states, files, inputs, derived


def _cells(row: Row, record: Record) -> dict[str, Any]:
    return {heading: value for group in _groups(row, record) for heading, value in group.items()}


def _columns(journal: Results) -> dict[str, type]:
    """Headings in order, group by group, and the one type (int, float, bool or str) that holds all cells of each."""
    columns: list[dict[str, type | None]] = [{}, {}, {}, {}]
    for row, record in journal.results():
        for kinds, cells in zip(columns, _groups(row, record), strict=True):
            for heading, value in cells.items():
                kinds[heading] = _common(kinds.get(heading), None if value is None else type(value))
    return {heading: kind or str for kinds in columns for heading, kind in kinds.items()}


def _common(one: type | None, other: type | None) -> type | None:
    """The type that holds cells of both; None for that of no cell."""
    if one is None or other is None or one is other:
        return one or other
    return float if {one, other} == {int, float} else str


def _write_csv(journal: Results, columns: Iterable[str], path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row, record in journal.results():
            cells = _cells(row, record)
            writer.writerow([_text(cells.get(heading)) for heading in columns])


def _text(value: Any) -> str:
    """A cell of the CSV: a number with all its digits, a text made harmless."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return guarded_text(value)
    return repr(value)


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
    return None if value is None else kind(value)
