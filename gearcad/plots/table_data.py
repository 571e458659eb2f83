"""Data of a picture: chosen columns of the results.csv that a batch wrote."""

from __future__ import annotations

import csv
import difflib
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from gearcad.core import symbols
from gearcad.core.errors import ParameterError, SpecError, format_number, shown_path
from gearcad.designs.cells import plain_number, plain_text
from gearcad.designs.keys import KEYS
from gearcad.designs.variations import column_symbol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Column", "Points", "opened_records", "read_points"]

_STATUS = "status"
_MAIN_TABLES = ("pair", "gear")
_MOST_SUGGESTED = 6
_ALIKE = 0.7
"""Spellings less alike have nothing to do with each other: epsilon and pinion."""

_WHAT = "give the results.csv of `gearcad batch`"


@dataclass(frozen=True)
class Column:
    """One quantity at every point: its key in the table, and its values, all numbers or all texts."""

    key: str
    values: tuple[float, ...] | tuple[str, ...]

    @property
    def is_text(self) -> bool:
        """True for a column of texts."""
        return isinstance(self.values[0], str)

    @property
    def numbers(self) -> NDArray[np.float64]:
        """The values of a column of numbers."""
        import numpy as np

        return np.array(self.values, np.float64)


@dataclass(frozen=True, kw_only=True)
class Points:
    """The rows that are ok and have all values asked for: y over x, and a third quantity. `omitted` counts the others."""

    name: str
    x: Column
    y: Column
    third: Column | None = None
    omitted: int = 0


def read_points(path: Path | str, x: str, y: str, *, colour: str | None = None, contour: str | None = None) -> Points:
    """Return the points of the results at `path`; the third quantity is that of `colour`, which may be a text, or of `contour`.

    A key may lack its beginning if it fits one column all the same; one of [pair] or [gear] goes first. Raises SpecError for
    the file, ParameterError for a key.
    """
    if colour is not None and contour is not None:
        raise ParameterError("contour", contour, "cannot stand beside colour; give one of them")
    path = Path(path)
    asked = {"x": x, "y": y, "colour": colour, "contour": contour}
    with _opened(path) as (headings, records):
        keys = {role: _find_key(role, key, headings) for role, key in asked.items() if key is not None}
        rows, omitted = _complete_rows(records, headings, list(keys.values()))
    if not rows:
        wanted = ", ".join(keys.values())
        raise SpecError(f"{path}: has nothing to draw: no row is ok and has a value of each of {wanted} ({omitted} left out)")
    columns = {}
    for place, (role, key) in enumerate(keys.items()):
        texts = {number: cells[place] for number, cells in rows.items()}
        columns[role] = _colour_column(key, texts) if role == "colour" else _numbers(path, key, texts)
    third = columns.get("colour", columns.get("contour"))
    return Points(name=_name(path), x=columns["x"], y=columns["y"], third=third, omitted=omitted)


@contextmanager
def _opened(path: Path) -> Iterator[tuple[list[str], Iterator[list[str]]]]:
    """The headings and the other records of the file; whatever is wrong with it becomes a SpecError."""
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            raise SpecError(f"{shown_path(path)}: must be an ordinary file; {_WHAT}")
        with path.open(encoding="utf-8-sig", newline="") as file, opened_records(file, str(path)) as opened:
            yield opened
    except OSError as error:
        raise SpecError(f"{shown_path(path)}: cannot be read ({error.strerror}); {_WHAT}") from error
    except UnicodeDecodeError as error:
        raise SpecError(f"{path}: is no table of results, for it is not CSV in UTF-8 ({error}); {_WHAT}") from error


@contextmanager
def opened_records(file: TextIO, name: str) -> Iterator[tuple[list[str], Iterator[list[str]]]]:
    """The headings of the results in a file that messages call `name`, and its other records, with decimal points.

    Raises SpecError for what is no table of results.
    """
    try:
        decimal_comma = _STATUS in file.readline().strip().split(";")
        file.seek(0)
        records = csv.reader(file, delimiter=";" if decimal_comma else ",")
        headings = next(records, [])
        if _STATUS not in headings:
            raise SpecError(f"{name}: is no table of results, for it has no column {_STATUS}; {_WHAT}")
        yield headings, (list(map(_with_point, cells)) for cells in records) if decimal_comma else records
    except csv.Error as error:
        raise SpecError(f"{name}: is no table of results, for it is not CSV in UTF-8 ({error}); {_WHAT}") from error


def _with_point(cell: str) -> str:
    """Return a number with a decimal comma as one with a point; a text as it is."""
    pointed = cell.replace(",", ".")
    return cell if plain_number(pointed) is None else pointed


def _find_key(role: str, asked: str, headings: Sequence[str]) -> str:
    """Return the heading that was meant."""
    for key in (asked, *(f"{table}.{asked}" for table in _MAIN_TABLES)):
        if key in headings:
            return key
    fitting = [heading for heading in headings if heading.endswith(f".{asked}")]
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        raise ParameterError(role, asked, f"could be {' or '.join(fitting)}; write the one in full")
    raise ParameterError(role, asked, f"no such column; {_hint(asked, headings)}")


def _hint(asked: str, headings: Sequence[str]) -> str:
    """Return a hint for an unknown column: similar headings, or where to find the columns."""
    if near := _near(asked, headings):
        return f"did you mean {' or '.join(near[:_MOST_SUGGESTED])}?"
    checked = any(heading.startswith("check.") for heading in headings)
    if not checked and _near(asked, [f"check.{key}" for key in (*KEYS["check"], *symbols.CHECK, *symbols.CHECK_COLUMNS)]):
        return "figures of a check are there after `gearcad batch --do check`"
    return "columns.csv beside the file explains them all"


def _near(asked: str, headings: Sequence[str]) -> list[str]:
    """Return the headings with the symbol that was asked for, or that contain it, are spelt alike,
    or have most of its words.
    """
    last = asked.rpartition(".")[2]
    written = {heading: found[1].symbol for heading in headings if (found := column_symbol(heading)) is not None}
    if near := [heading for heading, symbol in written.items() if symbol and _spelt(symbol) == _spelt(asked)]:
        return near
    if near := [heading for heading in headings if asked.lower() in heading.lower() or heading.endswith(f".{last}")]:
        return near
    spellings: dict[str, list[str]] = {}
    for heading in headings:
        for spelling in {heading, heading.partition(".")[2], heading.rpartition(".")[2]}:
            spellings.setdefault(spelling, []).append(heading)
    if alike := difflib.get_close_matches(asked.lower(), spellings, n=1, cutoff=_ALIKE):
        return spellings[alike[0]]
    shared = {heading: len(_words(asked) & _words(heading)) for heading in headings}
    most = max(shared.values(), default=0)
    return [heading for heading, number in shared.items() if number == most and most > 1]


def _spelt(symbol: str) -> str:
    """Return a symbol as one types it: ε_α, eps_alpha and epsilonalpha are the same."""
    named = "".join(sign if sign.isascii() else unicodedata.name(sign, sign).rpartition(" ")[2] for sign in symbol)
    return "".join(sign for sign in named.lower().replace("epsilon", "eps") if sign.isalnum())


def _words(key: str) -> set[str]:
    return {word for word in re.split(r"[._\s]+", key.lower()) if word}


def _complete_rows(records: Iterator[list[str]], headings: Sequence[str], keys: list[str]) -> tuple[dict[int, list[str]], int]:
    """Return the cells under `keys` of each good row by its number, and how many rows are not good."""
    status, *places = (headings.index(key) for key in (_STATUS, *keys))
    rows: dict[int, list[str]] = {}
    omitted = 0
    for number, cells in enumerate(records, 2):
        good = len(cells) > max(status, *places) and cells[status] == "ok" and all(cells[place] for place in places)
        if good:
            rows[number] = [cells[place] for place in places]
        elif cells:
            omitted += 1
    return rows, omitted


def _numbers(path: Path, key: str, texts: Mapping[int, str]) -> Column:
    values = []
    for row, text in texts.items():
        value = plain_number(text)
        if value is None:
            raise SpecError(
                f"{path} row {row}: {key} = {format_number(text)}: must be a number to be drawn; take another column"
            )
        values.append(value)
    return Column(key, tuple(values))


def _colour_column(key: str, texts: Mapping[int, str]) -> Column:
    """Return the numbers if all are, else texts as they were before an apostrophe kept a spreadsheet from running them."""
    numbers = [value for text in texts.values() if (value := plain_number(text)) is not None]
    if len(numbers) == len(texts):
        return Column(key, tuple(numbers))
    return Column(key, tuple(plain_text(text) for text in texts.values()))


def _name(path: Path) -> str:
    """Return a name for the results: batch writes results.csv into a folder named after the table."""
    folder = path.resolve().parent.name
    return folder if path.stem == "results" and folder else path.stem
