"""Files of design tables: records of a text (CSV) or of the first sheet of a workbook (.xlsx).

Rows are counted as a spreadsheet shows them: a record of several lines is one row, and a first line `sep=;` is none.
"""

from __future__ import annotations

import codecs
import csv
import datetime
import io
import re
import warnings
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from gearcad.core.errors import SpecError, printable, shown
from gearcad.designs.cells import Layout, RawCell, Unreadable, is_comment
from gearcad.designs.design import UNREADABLE, WORKBOOKS, is_spec_name

_NO_VALUE = "is a formula without a value; save the workbook in a spreadsheet, or write the number"
_DATE = "is a date, which the spreadsheet made of it; format the cell as a number or a text, and enter it again"
_SAVE_ANEW = "save the table by itself as .xlsx, or as CSV UTF-8"

_SHEETS = "xl/worksheets/"
_MOST_OF_A_SHEET = 256
_MOST_OF_A_PART = 32
"""Largest parts (MB, unpacked) that are read: a sheet row by row, so this is some millions of cells, the others all at once."""

_LONGEST_RUN = 1 << 20
"""Number of bytes of XML without a tag that no permitted cell reaches."""


def open_workbook(path: Path) -> Workbook:
    """Return the workbook in a file whose parts and cells are of a size that can be read. Raises SpecError, OSError."""
    with _explained(path), zipfile.ZipFile(path) as archive:
        for part in archive.infolist():
            if part.filename.lower().endswith((".xml", ".rels")):
                _require_modest(path, archive, part)
    return Workbook(path)


def _require_modest(path: Path, archive: zipfile.ZipFile, part: zipfile.ZipInfo) -> None:
    """Raise SpecError for a part that is too large, or has a text that is; no part is unpacked beyond its declared size."""
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
        """Yield the number and cells of every row. Raises SpecError, OSError.

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
    """Return the value of a cell; `source` is the same cell with its formula, if it has one."""
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


Record = tuple[int, Sequence[RawCell]]
"""Number of the row, from 1, and its cells."""

_SEPARATOR_LINE = re.compile(r'"?sep=([,;\t])"?[\s,;]*', re.IGNORECASE)
"""A first line that Excel reads, and some programs write."""


class RecordFile(Protocol):
    """A file of records; `records` begins anew with every call. Raises SpecError for broken contents, OSError."""

    @property
    def layout(self) -> Layout: ...

    def records(self) -> Iterator[Record]: ...


def open_sheet(path: Path) -> RecordFile:
    """Return the sheet in a file: of a workbook the one in front. Raises SpecError for what is no table, OSError."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise SpecError(f"{path}: must be an ordinary file: it is read more than once")
    suffix = path.suffix.lower()
    if is_spec_name(path) and path.is_file():
        raise SpecError(f"{path}: is the spec of one design, no design table; use `gearcad build {path}`")
    if suffix in WORKBOOKS:
        return open_workbook(path)
    if suffix in UNREADABLE:
        raise SpecError(f"{path}: cannot be read; save it as CSV UTF-8, or as a workbook .xlsx")
    return _open_text(path)


@dataclass(frozen=True)
class _Text:
    """A text with separated cells; `skipped` lines stand before the first row."""

    path: Path
    encoding: str
    layout: Layout
    skipped: int

    def records(self) -> Iterator[Record]:
        with _text_file(self.path, self.encoding) as file:
            for _ in range(self.skipped):
                file.readline()
            lines = _Lines(file, self.path, self.layout.value)
            reader = csv.reader(lines, delimiter=self.layout.value, skipinitialspace=True, strict=True)
            number = 0
            while True:
                number += 1
                lines.begins_record = True
                try:
                    cells = next(reader)
                except StopIteration:
                    return
                except csv.Error as error:
                    raise SpecError(f"{self.path} row {number}: {_explain_csv(error)}") from error
                yield number, cells


class _Lines:
    """The lines of a file for csv, with comments made blank: it must not mind the quotation marks in them."""

    def __init__(self, file: io.TextIOWrapper, path: Path, separator: str) -> None:
        self._file = file
        self._path = path
        self._separator = separator
        self.begins_record = True

    def __iter__(self) -> Iterator[str]:
        for line in self._file:
            if "\0" in line:
                raise SpecError(f"{self._path}: is not a text; save it as CSV UTF-8 (a workbook is named .xlsx)")
            is_comment_row = self.begins_record and _is_comment_line(line, self._separator)
            self.begins_record = False
            yield "\n" if is_comment_row else line


def _is_comment_line(line: str, separators: str) -> bool:
    """True for a line whose first cell that is not blank begins with #, without a quotation mark in front."""
    line = line.lstrip(f" \t{separators}")
    return line.startswith("#") and is_comment(re.split(f"[{separators}]", line, maxsplit=1)[:1])


@contextmanager
def _text_file(path: Path, encoding: str) -> Iterator[io.TextIOWrapper]:
    """Yield the file, open for csv. Bytes that are not in its encoding raise a SpecError that names the place."""
    try:
        with path.open(encoding=encoding, newline="") as file:
            yield file
    except UnicodeError as error:
        raise SpecError(f"{path}{_broken_line(path, encoding)}; save it as CSV UTF-8") from error


def _broken_line(path: Path, encoding: str) -> str:
    """Return the end of a message: which line of the file is not in its encoding."""
    if encoding == "utf-8-sig":
        with path.open("rb") as file:
            for number, line in enumerate(file, 1):
                try:
                    line.decode("utf-8")
                except UnicodeDecodeError as error:
                    return f" line {number}: is not UTF-8 text (byte {error.start + 1} of the line)"
    return f": is not {encoding.upper()} text"


def _explain_csv(error: csv.Error) -> str:
    text = str(error)
    if text == "unexpected end of data":
        return "a quotation mark opens a cell here and never closes"
    if text.startswith("field larger"):
        most = csv.field_size_limit()
        return f"has a cell of more than {most} characters; does a quotation mark open and never close?"
    if text.endswith("""expected after '"'"""):
        return "a closing quotation mark must end its cell; inside a cell write the mark twice"
    return f"is not CSV ({text})"


def _open_text(path: Path) -> _Text:
    with path.open("rb") as binary:
        start = binary.read(2)
    encoding = "utf-16" if start in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) else "utf-8-sig"
    with _text_file(path, encoding) as file:
        if match := _SEPARATOR_LINE.fullmatch(file.readline().rstrip("\r\n")):
            return _Text(path, encoding, Layout(match[1]), skipped=1)
        file.seek(0)
        return _Text(path, encoding, _layout_of(_heading_line(file)), skipped=0)


def _heading_line(lines: Iterator[str]) -> str:
    """Return the first line that is neither blank nor a comment; a comment in quotation marks may have several lines."""
    in_comment = False
    for line in lines:
        start = line.lstrip(" \t,;")
        if in_comment or (start.startswith('"') and start.lstrip('" ').startswith("#")):
            in_comment ^= line.count('"') % 2 == 1
        elif line.strip(' \t,;"\r\n') and not _is_comment_line(line, ",;\t"):
            return line
    return ""


def _layout_of(heading: str) -> Layout:
    outside_quotes = re.sub('"[^"]*"?', "", heading)
    return next((layout for layout in (Layout.TAB, Layout.SEMICOLON) if layout.value in outside_quotes), Layout.COMMA)
