"""Cells and headings of a design table: the value of a text under its key, and every fault at once."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from datetime import date
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.core.errors import ParameterError, SpecError, shown
from gearcad.core.shelf_tables import column_letter
from gearcad.designs.keys import GEARBOX_FILE, MAIN_TABLES, OF_SETS, SPEEDS, Cell, DesignKind
from gearcad.designs.shaft_keys import explain_unknown_item, is_of_list, is_of_shaft_alone, shaft_field
from gearcad.designs.train_keys import (
    COLUMNS,
    COUNTS,
    LISTS,
    PLANETARY,
    TEXTS,
    TrainKey,
    explain_unknown_column,
    general_key,
    nearest_table,
)


class Layout(Enum):
    """The kind of file that holds a table; the value is the separator of a text's cells."""

    COMMA = ","
    SEMICOLON = ";"
    TAB = "\t"
    WORKBOOK = "xlsx"


class Unreadable(NamedTuple):
    """A workbook cell without a usable value: what it shows, and why it cannot be read."""

    shown: str
    fault: str


RawCell = str | int | float | Unreadable | None
"""A cell as the file holds it; a text file has texts only."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_GROUPED = re.compile(r"[+-]?[0-9.,]*[0-9][0-9.,]*(?:[eE][+-]?[0-9]+)?")
_MINUS_SIGN = "\N{MINUS SIGN}"
_SIGN_WORDS = {",": "a decimal comma", ".": "a decimal point"}

_MOST_EXACT = 2**53
"""Greatest whole number up to which a float holds every whole number: below it a spreadsheet keeps a count as it was typed."""

_SPREADSHEET_ERROR = re.compile(r"#(?:N/A|NV|[^\W\d_]+(?:/0)?[!?])")
"""#N/A, #REF!, #DIV/0! ..., and what other languages make of them: #NV, #BEZUG!, #NOM?."""

_GUARDED = re.compile(r"'+[=+\-@\t\r]")
"""A text with an apostrophe in front so that no spreadsheet runs it as a formula, as tables of results have it."""


def plain_text(cell: RawCell) -> str:
    """Return a cell as a text without space around it, "" for none; a workbook's 12.0 is "12"."""
    if isinstance(cell, str):
        text = cell.strip()
        return text[1:] if text.startswith("'") and _GUARDED.match(text) else text
    if cell is None:
        return ""
    if isinstance(cell, Unreadable):
        return cell.shown
    return str(int(cell)) if abs(cell) <= _MOST_EXACT and float(cell).is_integer() else repr(cell)


def plain_number(text: str) -> float | None:
    """Return the number that a text stands for; None for words, and for numbers that are not finite."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def list_text(numbers: Iterable[float]) -> str:
    """Several numbers as one cell, which CellReader reads."""
    return " ".join(map(repr, numbers))


def nested_text(lists: Iterable[Iterable[float]]) -> str:
    """Return the lists of numbers as one cell: 0.1:1.25 0.9:0.8."""
    return " ".join(":".join(map(repr, each)) for each in lists)


def texts_cell(texts: Iterable[Any], key: str) -> str:
    """Return the texts, or lists of them, as one cell: `first note | second`, `A; first issue; 2026-01-31 | B; wider`.

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
    """Return the text as a cell that no spreadsheet runs as a formula; `plain_text` takes the apostrophe off again."""
    return f"'{text}" if _GUARDED.match(f"'{text}") else text


def is_blank(cell: RawCell) -> bool:
    """Return True for a cell that contains only space."""
    return cell is None or (isinstance(cell, str) and not cell.strip())


def is_comment(cells: Sequence[RawCell]) -> bool:
    """Return whether the first cell that is not blank begins with #, and is not one of a spreadsheet's errors such as #N/A."""
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
        """Return the value of the cell under `key`, in row `row`; None for a blank cell.

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
        """Return a number with its decimal comma, if permitted, turned into a point; other texts unchanged."""
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
    """Return a finite float, or a whole number where a count is meant: pandas and spreadsheets write 20.0."""
    if general_key(key) in COUNTS and abs(number) <= _MOST_EXACT and float(number).is_integer():
        return int(number)
    try:
        number = float(number)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ParameterError(key, text, "must be a smaller number")
    return number


class Decimal(Enum):
    """The decimal sign of the CSV files: one that a spreadsheet of the reader's country opens by a double click."""

    POINT = "point"
    """Decimal points, and commas between cells."""

    COMMA = "comma"
    """Decimal commas, semicolons between cells, and a mark at the beginning by which Excel recognises UTF-8."""

    @property
    def separator(self) -> str:
        """Character that separates the cells of a line: `;` with a decimal comma, `,` with a point."""
        return ";" if self is Decimal.COMMA else ","

    @property
    def encoding(self) -> str:
        """Name of the file's encoding, as Python spells it."""
        return "utf-8-sig" if self is Decimal.COMMA else "utf-8"

    def number(self, text: str) -> str:
        """Return a number, written with a point, as it appears in a cell."""
        return text.replace(".", ",") if self is Decimal.COMMA else text


def cell_text(value: Any, decimal: Decimal = Decimal.POINT) -> str:
    """Return a cell of the CSV: a number with all its digits, a text made harmless."""
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


_MAIN = DesignKind.PLANETARY.value


def kinds_of(keys: Iterable[str]) -> set[DesignKind]:
    """Return the kinds of design that full keys can make. [material] and [load] alone make none.

    A pinion may have a wheel or a rack.
    """
    keys = tuple(keys)
    if GEARBOX_FILE in keys:
        return {DesignKind.GEARBOX}
    owners = {key.partition(".")[0] for key in keys}
    planetary = {"planetary", *OF_SETS}
    paired = bool(owners & {"pair", "pinion"})
    makes = {
        DesignKind.GEAR: "gear" in owners,
        DesignKind.PAIR: "wheel" in owners or (paired and "rack" not in owners),
        DesignKind.RACK: "rack" in owners and not paired,
        DesignKind.RACK_PAIR: "rack" in owners and paired,
        DesignKind.TRAIN: any(map(_of_train, keys)),
        DesignKind.PLANETARY: bool(owners & planetary),
        DesignKind.SPLINE: "spline" in owners,
        DesignKind.SHAFT: any(map(is_of_shaft_alone, keys)),
    }
    return {kind for kind, made in makes.items() if made}


def _of_train(key: str) -> bool:
    """Return whether a key belongs to a train. A key of a train's mesh has a name between its table and itself; no key of
    [mesh] has one.
    """
    table, _, rest = key.partition(".")
    return table in ("train", "inertia", "shaft", "excitation") or (table == "mesh" and "." in rest)


def read_headings(cells: Sequence[RawCell], where: str) -> tuple[str, ...]:
    """Return the full key of every column, "name" for that of the designs, "" under a blank heading; blank ones at the end are
    cut.

    `where` names the file and row. A key without a table is one of [pair] or [gear], by what the table has. Raises
    SpecError with one line per fault.
    """
    headings = [plain_text(cell) for cell in cells]
    while headings and not headings[-1]:
        headings.pop()
    dotted = (heading for heading in headings if "." in heading and heading not in COLUMNS["gear"])
    kinds = kinds_of(map(_placed, dotted))
    if any(heading in _OF_SPLINES_ALONE for heading in headings):
        kinds = {DesignKind.SPLINE}
    if GEARBOX_FILE.partition(".")[2] in headings or GEARBOX_FILE in headings:
        kinds = {DesignKind.GEARBOX}
    places: dict[str, int] = {}
    columns, faults = [], []
    for index, heading in enumerate(headings):
        key, fault = _key_of(heading, kinds) if heading else ("", "")
        if not fault and key in places:
            fault = f"is the same as column {column_letter(places[key])} ({headings[places[key]]}); keep one of them"
        if fault:
            faults.append(f"{where} column {column_letter(index)}: {shown(heading)}: {fault}")
        elif key:
            places[key] = index
        columns.append(key)
    if "name" not in headings:
        faults.append(f"{where}: has no column name, which every table needs: it gives each design a name and a folder")
    if faults:
        raise SpecError("\n".join(faults))
    return tuple(columns)


def _placed(heading: str) -> str:
    """Return a heading with a dot with the table that it means."""
    first, _, rest = heading.partition(".")
    return heading if is_of_list(heading) else f"{nearest_table(first) or ''}.{rest}"


_OF_SPLINES_ALONE = ("designation", "nominal_diameter", "centring")
"""Keys without a table that only [spline] has."""


def _key_of(heading: str, kinds: set[DesignKind]) -> tuple[str, str]:
    """Return the full key of a heading, and a message if it is wrong."""
    if heading == "name":
        return heading, ""
    if heading in ("pair.name", "gear.name", "rack.name", "train.name", "planetary.name"):
        return "", "is the name of the design; write name"
    if DesignKind.GEARBOX in kinds:
        return heading if heading.startswith(f"{_MAIN}.") else f"{_MAIN}.{heading}", ""
    if DesignKind.TRAIN in kinds:
        return _key_of_train(heading, kinds)
    if DesignKind.PLANETARY in kinds:
        return _key_of_planetary(heading, kinds)
    table, _, field = heading.partition(".")
    if (table in COLUMNS and field in COLUMNS[table]) or shaft_field(heading) is not None:
        return heading, ""
    if is_of_list(heading):
        return "", explain_unknown_item(heading)
    mains = dict.fromkeys(MAIN_TABLES[kind][0] for kind in MAIN_TABLES if kind in kinds)
    if len(mains) > 1 and heading in COLUMNS["gear"]:
        homes = tuple(mains) if heading in COLUMNS["pair"] else (*(main for main in mains if main != "pair"), "pinion", "wheel")
        written = " or ".join(f"{owner}.{heading}" for owner in homes)
        owners = " or of a ".join(mains)
        return "", f"could be of a {owners}, and this table has both; write {written}"
    main = "pair" if "pair" in mains else next(iter(mains), "gear")
    if heading in COLUMNS[main] and len(mains) < 2:
        return f"{main}.{heading}", ""
    return "", explain_unknown_column(heading, main)


def _key_of_train(heading: str, kinds: set[DesignKind]) -> tuple[str, str]:
    """Return the full key of a heading in a table of trains, whose bare keys are those of [train];
    and what is wrong with it.
    """
    for key in (heading, f"train.{heading}"):
        if TrainKey.of(key) is not None:
            return key, ""
    table = heading.partition(".")[0]
    if len(kinds) > 1 and (table in (*COLUMNS, *PLANETARY) or heading in COLUMNS["gear"]):
        return "", "cannot stand beside keys of trains: a table holds these, or gears and pairs, or planetary trains"
    return "", explain_unknown_column(heading, "train")


def _key_of_planetary(heading: str, kinds: set[DesignKind]) -> tuple[str, str]:
    """Return the full key of a heading in a table of planetary trains, whose bare keys are those of [planetary]; and what is
    wrong.
    """
    table, _, field = heading.partition(".")
    if field in PLANETARY.get(table, ()) or (table == _MAIN and field.startswith(f"{SPEEDS}.")):
        return heading, ""
    if len(kinds) > 1 and (table in COLUMNS or heading in COLUMNS["gear"]):
        return "", "cannot stand beside keys of planetary trains: a table holds these, or gears and pairs"
    if heading in PLANETARY[_MAIN] or heading.startswith(f"{SPEEDS}."):
        return f"{_MAIN}.{heading}", ""
    return "", explain_unknown_column(heading, _MAIN)
