"""Tables of results as CSV files: one for each, that a spreadsheet opens."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.designs.cells import guarded_text
from gearcad.designs.csv_cells import cell_text, write_csv
from gearcad.jobs.job import Writer

__all__ = ["table_files"]


def table_files(verb: str, tables: Mapping[str, Mapping[str, NDArray[Any] | Sequence[Any]]]) -> dict[str, Writer]:
    """What writes each of a result's tables, columns by their headings: `VERB-NAME.csv`."""
    return {file_name(verb, name): partial(_write_table, columns) for name, columns in tables.items()}


def file_name(verb: str, table: str) -> str:
    """That of a table of this name."""
    return f"{verb}-{table.replace(' ', '-').replace('_', '-')}.csv"


def _write_table(columns: Mapping[str, NDArray[Any] | Sequence[Any]], path: Path) -> None:
    write_csv(zip(*map(_cells, columns.values()), strict=True), map(guarded_text, columns), path)


def _cells(values: NDArray[Any] | Sequence[Any]) -> list[str]:
    """Of a column; nan is a cell without a value."""
    if isinstance(values, np.ndarray) and values.dtype == float:
        return [repr(value) if value == value else "" for value in values.tolist()]
    listed = values.tolist() if isinstance(values, np.ndarray) else values
    return ["" if isinstance(value, float) and math.isnan(value) else cell_text(value) for value in listed]
