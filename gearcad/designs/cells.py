"""Cells of a design table: what a text, or a workbook's number, means under its key, and why it may mean nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from datetime import date
from enum import Enum
from typing import Any, NamedTuple

from gearcad.designs.column_keys import COUNTS, LISTS, TEXTS
from gearcad.designs.keys import Cell
from gearcad.designs.train_keys import general_key
from gearcad.errors import ParameterError

__all__ = [
    "CellReader",
    "Layout",
    "RawCell",
    "Unreadable",
    "guarded_text",
    "is_blank",
    "is_comment",
    "list_text",
    "nested_text",
    "plain_number",
    "plain_text",
    "texts_cell",
]


class Layout(Enum):
    """What separates the cells; the value is the separator of a text."""

    COMMA = ","
    SEMICOLON = ";"
    TAB = "\t"
    WORKBOOK = "xlsx"


class Unreadable(NamedTuple):
    """A cell of a workbook without a value for us: what it shows, and what is wrong with it."""

    shown: str
    fault: str


RawCell = str | int | float | Unreadable | None
"""A cell as the file holds it; a text file has texts only."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_GROUPED = re.compile(r"[+-]?[0-9.,]*[0-9][0-9.,]*(?:[eE][+-]?[0-9]+)?")
_MINUS_SIGN = "\N{MINUS SIGN}"
_SIGN_WORDS = {",": "a decimal comma", ".": "a decimal point"}

_MOST_EXACT = 2**53
"""Whole numbers up to here are all floats, so a spreadsheet's number can be the count that was typed."""

_SPREADSHEET_ERROR = re.compile(r"#(?:N/A|NV|[^\W\d_]+(?:/0)?[!?])")
"""#N/A, #REF!, #DIV/0! ..., and what other languages make of them: #NV, #BEZUG!, #NOM?."""

_GUARDED = re.compile(r"'+[=+\-@\t\r]")
"""A text with an apostrophe in front so that no spreadsheet runs it as a formula, as tables of results have it."""


def plain_text(cell: RawCell) -> str:
    """A cell as a text without space around it, "" for none; a workbook's 12.0 is "12"."""
    if isinstance(cell, str):
        text = cell.strip()
        return text[1:] if text.startswith("'") and _GUARDED.match(text) else text
    if cell is None:
        return ""
    if isinstance(cell, Unreadable):
        return cell.shown
    return str(int(cell)) if abs(cell) <= _MOST_EXACT and float(cell).is_integer() else repr(cell)


def plain_number(text: str) -> float | None:
    """The number that a text is; None for words, and for what is not finite."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def list_text(numbers: Iterable[float]) -> str:
    """Several numbers as one cell, which CellReader reads."""
    return " ".join(map(repr, numbers))


def nested_text(lists: Iterable[Iterable[float]]) -> str:
    """Lists of numbers as one cell: 0.1:1.25 0.9:0.8."""
    return " ".join(":".join(map(repr, each)) for each in lists)


def texts_cell(texts: Iterable[Any], key: str) -> str:
    """Texts, or lists of them, as one cell: `first note | second`, `A; first issue; 2026-01-31 | B; wider`.

    Raises ParameterError for a text that would not come back.
    """
    return " | ".join(
        "; ".join(_plain_item(each, key, "|;") for each in item)
        if isinstance(item, list | tuple)
        else _plain_item(item, key, "|")
        for item in texts
    )


def _plain_item(item: Any, key: str, marks: str) -> str:
    text = item.isoformat() if isinstance(item, date) else item
    if not isinstance(text, str):
        raise ParameterError(key, item, "must be a text")
    if any(mark in text for mark in (*marks, "\n")):
        raise ParameterError(key, item, f"cannot stand in a table: has {' or '.join(marks)} or a new line in it")
    return text


def guarded_text(text: str) -> str:
    """The text as a cell that no spreadsheet runs as a formula; `plain_text` takes the apostrophe off again."""
    return f"'{text}" if _GUARDED.match(f"'{text}") else text


def is_blank(cell: RawCell) -> bool:
    """True for a cell with nothing but space in it."""
    return cell is None or (isinstance(cell, str) and not cell.strip())


def is_comment(cells: Sequence[RawCell]) -> bool:
    """True if the first cell that is not blank begins with #, and is not one of a spreadsheet's errors such as #N/A."""
    first = next((cell for cell in cells if not is_blank(cell)), None)
    return isinstance(first, str) and first.lstrip().startswith("#") and not _is_error(first.strip())


def _is_error(text: str) -> bool:
    return text.startswith("#") and text.isupper() and _SPREADSHEET_ERROR.fullmatch(text) is not None


class CellReader:
    """Turns the cells of one table into values, in the order of the table.

    The first number with a decimal sign decides which one the table uses: 205.000 is 205 in one country and 205000 in
    another, so a table with both signs cannot be trusted.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._decimal_sign = ""
        self._decimal_place = ""

    def value(self, key: str, cell: RawCell, row: int) -> Cell | None:
        """The value of the cell under `key`, in row `row`; None for a blank cell.

        What is no number stays a text, such as "auto". Raises ParameterError for a cell that cannot be read.
        """
        text = plain_text(cell)
        if cell is None or not text:
            return None
        if isinstance(cell, Unreadable):
            raise ParameterError(key, text, cell.fault)
        if _is_error(text):
            raise ParameterError(key, text, "is an error of the spreadsheet; mend the formula and save again")
        general = general_key(key)
        if general in TEXTS or key == "name":
            return text
        if not isinstance(cell, str):
            return _checked(key, text, cell)
        if general not in LISTS or len(text.split()) < 2:
            return self._number_or_text(key, text, row)
        numbers = tuple(number for item in text.split() if isinstance(number := self._number_or_text(key, item, row), float))
        return numbers if len(numbers) == len(text.split()) else text

    def _number_or_text(self, key: str, text: str, row: int) -> Cell:
        plain = text.replace(_MINUS_SIGN, "-")
        if "," in plain:
            plain = self._with_point(key, text, plain)
        if not _NUMBER.fullmatch(plain):
            return text
        if self._layout is Layout.SEMICOLON:
            self._require_same_sign(key, text, row)
        return _checked(key, text, float(plain))

    def _with_point(self, key: str, text: str, plain: str) -> str:
        """A number with its decimal comma, where one is permitted, turned into a point; what is no number stays as it is."""
        if "." in plain and _GROUPED.fullmatch(plain):
            raise ParameterError(key, text, "has a comma and a point; write it without a thousands separator")
        pointed = plain.replace(",", ".")
        if not _NUMBER.fullmatch(pointed):
            return plain
        if self._layout is Layout.SEMICOLON:
            return pointed
        hint = "" if self._layout is Layout.WORKBOOK else " (a decimal comma needs semicolons between the cells)"
        raise ParameterError(key, text, f"must have a decimal point: write {pointed}{hint}")

    def _require_same_sign(self, key: str, text: str, row: int) -> None:
        sign = "," if "," in text else "." if "." in text else ""
        if not sign or sign == self._decimal_sign:
            return
        if not self._decimal_sign:
            self._decimal_sign, self._decimal_place = sign, f"{key} in row {row}"
            return
        first = f"{self._decimal_place} has {_SIGN_WORDS[self._decimal_sign]}"
        raise ParameterError(key, text, f"has {_SIGN_WORDS[sign]}, but {first}; write all numbers of a table alike")


def _checked(key: str, text: str, number: float) -> int | float:
    """A finite float, or a whole number where a count is meant: pandas and spreadsheets write 20.0."""
    if general_key(key) in COUNTS and abs(number) <= _MOST_EXACT and float(number).is_integer():
        return int(number)
    try:
        number = float(number)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ParameterError(key, text, "must be a smaller number")
    return number
