"""Cells and files of CSV as we write them, so that a spreadsheet of the reader's country opens them."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from pathlib import Path
from typing import Any

from gearcad.designs.cells import guarded_text

__all__ = ["Decimal", "cell_text", "write_csv", "write_found_rows"]


class Decimal(Enum):
    """The decimal sign of the CSV files: one that a spreadsheet of the reader's country opens by a double click."""

    POINT = "point"
    """Cells between commas."""

    COMMA = "comma"
    """Cells between semicolons, and a mark in front by which Excel knows UTF-8."""

    @property
    def separator(self) -> str:
        """What stands between cells."""
        return ";" if self is Decimal.COMMA else ","

    @property
    def encoding(self) -> str:
        """That of the file, as Python calls it."""
        return "utf-8-sig" if self is Decimal.COMMA else "utf-8"

    def number(self, text: str) -> str:
        """A number, written with a point, as it stands in a cell."""
        return text.replace(".", ",") if self is Decimal.COMMA else text


def cell_text(value: Any, decimal: Decimal = Decimal.POINT) -> str:
    """A cell of the CSV: a number with all its digits, a text made harmless."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return guarded_text(value)
    if isinstance(value, tuple):
        return " ".join(cell_text(item, decimal) for item in value)
    return decimal.number(repr(value))


def write_csv(lines: Iterable[Sequence[str]], headings: Iterable[str], path: Path, decimal: Decimal = Decimal.POINT) -> None:
    """Write a line of headings, and lines of cells."""
    with path.open("w", encoding=decimal.encoding, newline="") as file:
        writer = csv.writer(file, delimiter=decimal.separator, lineterminator="\n")
        writer.writerow(headings)
        writer.writerows(lines)


def write_found_rows(rows: Sequence[Mapping[str, str]], comment: str, path: Path) -> None:
    """Write a design table of rows by their columns, under a comment without commas, which some programs take for cells."""
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([f"# {comment}"])
        writer.writerow(columns)
        writer.writerows([row.get(column, "") for column in columns] for row in rows)
