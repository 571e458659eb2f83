"""Records of the sheet that lies in front of a workbook (.xlsx), read by openpyxl row by row."""

from __future__ import annotations

import csv
import datetime
import warnings
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.designs.cells import Layout, RawCell, Unreadable
from gearcad.errors import SpecError, printable, shown

__all__ = ["Workbook", "open_workbook"]

_NO_VALUE = "is a formula without a value; save the workbook in a spreadsheet, or write the number"
_DATE = "is a date, which the spreadsheet made of it; format the cell as a number or a text, and enter it again"
_SAVE_ANEW = "save the table by itself as .xlsx, or as CSV UTF-8"

_SHEETS = "xl/worksheets/"
_MOST_OF_A_SHEET = 256
_MOST_OF_A_PART = 32
"""Largest parts (MB, unpacked) that are read: a sheet row by row, so this is some millions of cells, the others all at once."""

_LONGEST_RUN = 1 << 20
"""Bytes of XML without a tag in which no permitted cell is so long."""


def open_workbook(path: Path) -> Workbook:
    """The workbook in a file whose parts and cells are of a size that can be read. Raises SpecError, OSError."""
    with _explained(path), zipfile.ZipFile(path) as archive:
        for part in archive.infolist():
            if part.filename.lower().endswith((".xml", ".rels")):
                _require_modest(path, archive, part)
    return Workbook(path)


def _require_modest(path: Path, archive: zipfile.ZipFile, part: zipfile.ZipInfo) -> None:
    """Raise SpecError for a part that is too large, or has a text that is; no more of it is unpacked than it declares."""
    most = _MOST_OF_A_SHEET if part.filename.startswith(_SHEETS) else _MOST_OF_A_PART
    if part.file_size > most * 10**6:
        size = f"{part.file_size / 1e6:.0f} MB unpacked, of which at most {most} MB are read"
        raise SpecError(f"{printable(str(path))}: its {shown(part.filename)} has {size}; {_SAVE_ANEW}")
    with archive.open(part) as content:
        while chunk := content.read(_LONGEST_RUN):
            if len(chunk) == _LONGEST_RUN and b"<" not in chunk:
                raise SpecError(f"{printable(str(path))}: {_too_long()}")


def _too_long() -> str:
    """About a cell, in the words of a CSV's."""
    return f"has a cell of more than {csv.field_size_limit()} characters"


@dataclass(frozen=True)
class Workbook:
    """A workbook on disk."""

    path: Path

    @property
    def layout(self) -> Layout:
        """A workbook has cells, not separators."""
        return Layout.WORKBOOK

    def records(self) -> Iterator[tuple[int, Sequence[RawCell]]]:
        """Number and cells of every row. Raises SpecError, OSError.

        openpyxl gives the values of formulas or the formulas, so the file is read twice side by side: a formula that no
        spreadsheet has evaluated yet has no value, and must not pass for a blank cell.
        """
        with _rows(self.path, formulas=False) as rows, _rows(self.path, formulas=True) as written:
            for number, (row, sources) in enumerate(zip(rows, written, strict=True), 1):
                cells = [_raw(cell, source) for cell, source in zip(row, sources, strict=True)]
                if any(isinstance(cell, str) and len(cell) > csv.field_size_limit() for cell in cells):
                    raise SpecError(f"{self.path} row {number}: {_too_long()}")
                yield number, cells


def _raw(cell: Any, source: Any) -> RawCell:
    """The value of a cell; `source` is the same cell with its formula, if it has one."""
    value = cell.value
    if value is None:
        # A formula whose value is the empty text is marked as a text.
        if source.value is None or cell.data_type == "str":
            return None
        return Unreadable(str(getattr(source.value, "text", source.value)), _NO_VALUE)
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, datetime.date | datetime.time | datetime.timedelta):
        return Unreadable(str(value), _DATE)
    return value if isinstance(value, int | float) else str(value)


@contextmanager
def _rows(path: Path, *, formulas: bool) -> Iterator[Iterator[Sequence[Any]]]:
    """The rows of the sheet in front, with formulas or with their values."""
    try:
        import openpyxl
    except ImportError as error:
        raise SpecError(f'{path}: needs openpyxl: pip install "gearcad[xlsx]", or save the table as CSV UTF-8') from error
    with _explained(path):
        book = openpyxl.load_workbook(path, read_only=True, data_only=not formulas)
    try:
        sheet = book.active
        if sheet is None:
            raise SpecError(f"{path}: has no sheet in front; {_SAVE_ANEW}")
        sheet.reset_dimensions()  # some programs note a wrong size
        yield _guarded(path, sheet.rows)
    finally:
        book.close()


def _guarded(path: Path, rows: Iterator[Sequence[Any]]) -> Iterator[Sequence[Any]]:
    while True:
        with _explained(path):
            row = next(rows, None)
        if row is None:
            return
        yield row


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Turn whatever openpyxl meets inside a broken file into a SpecError, and keep its warnings about ornaments quiet."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (OSError, SpecError):
        raise
    except Exception as error:
        raise SpecError(f"{path}: is no workbook that can be read; {_SAVE_ANEW}") from error
