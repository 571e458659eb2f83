"""Tables of a shelf in CSV: a design's own, the user's, and that of gearcad; rows by their names, with places for messages."""

from __future__ import annotations

import csv
import difflib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import NamedTuple

from gearcad.core.errors import SpecError, printable, shown, shown_path


class Place(Enum):
    """Place of a table of a shelf."""

    DESIGN = "design"
    USER = "user"
    OWN = "gearcad"


@dataclass(frozen=True)
class ShelfTable:
    """A table of a shelf: where it is, its columns by their places, "" under a blank heading, and the sign between cells.

    `own_name` is the file's name where the table is that of gearcad.
    """

    path: Path
    place: Place
    own_name: str = ""
    columns: tuple[str, ...] = ()
    separator: str = ","

    @property
    def shown(self) -> str:
        """The path for messages."""
        return printable(shown_path(self.path))

    @property
    def file(self) -> str:
        """The path for documents: without the folder of a design, and from the home of a user."""
        if self.place is Place.DESIGN:
            return self.path.name
        if self.place is Place.OWN:
            return self.own_name
        try:
            return f"~/{self.path.relative_to(Path.home()).as_posix()}"
        except (ValueError, RuntimeError):  # another folder, or no home
            return str(self.path)


class ShelfName(str):
    """The name of something that a table of a shelf has, with the `folder` of the design that may have that table."""

    folder: Path = Path()

    @classmethod
    def of(cls, name: str, folder: Path) -> ShelfName:
        """Return the name as seen from a folder."""
        made = cls(name)
        made.folder = folder
        return made


class ShelfRow(NamedTuple):
    """A row of a table as it is written; `number` counts rows as a spreadsheet does."""

    number: int
    name: str
    cells: tuple[str, ...]


def read_shelf_table(
    table: ShelfTable, columns_of: Callable[[Sequence[str], str], tuple[str, ...]], example: str
) -> tuple[ShelfTable, list[ShelfRow]]:
    """Return a table with its columns, and its rows. Raises SpecError.

    `columns_of` gives the columns of the headings, with the place for messages; `example` is a key for the message about a
    table without a heading.
    """
    try:
        text = table.path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise SpecError(f"{table.shown}: is not UTF-8 text (byte {error.start}); save it as CSV UTF-8") from None
    except OSError as error:
        raise SpecError(f"{table.shown}: cannot be read ({error.strerror})") from None
    lines = text.splitlines()
    heading = next((line for line in lines if line.strip() and not line.lstrip().startswith(("#", "sep="))), "")
    separator = max(",;\t", key=heading.count)
    try:
        records = list(enumerate(csv.reader(lines, delimiter=separator), 1))
    except csv.Error as error:
        raise SpecError(f"{table.shown}: cannot be read ({error})") from None
    filled = [
        (number, cells)
        for number, cells in records
        if any(cell.strip() for cell in cells) and not cells[0].lstrip().startswith(("#", "sep="))
    ]
    if not filled:
        raise SpecError(f"{table.shown}: has no heading; must have name and keys such as {example}")
    number, headings = filled[0]
    columns = columns_of(headings, f"{table.shown} row {number}")
    named = columns.index("name")
    found = []
    for number, cells in filled[1:]:
        name = " ".join(cells[named].split()) if named < len(cells) else ""
        if not name:
            raise SpecError(f"{table.shown} row {number} column {column_letter(named)}: has no name")
        found.append(ShelfRow(number, name, tuple(cells)))
    return ShelfTable(table.path, table.place, table.own_name, columns, separator), found


def shelf_columns(
    cells: Sequence[str], where: str, known: Sequence[str], *, otherwise: str = "", needed: Sequence[str] = ("name",)
) -> tuple[str, ...]:
    """Return the column of each heading, "" of a blank one.

    Raises SpecError, one line with the place, for one that is not known, is there twice, or is needed and not there. What is
    not like any that is known is told with `otherwise`, or else with all that are known.
    """
    columns: list[str] = []
    for at, cell in enumerate(cells):
        column = cell.strip()
        if column and column not in known:
            near = difflib.get_close_matches(column, known, n=1)
            hint = f"did you mean {near[0]}?" if near else otherwise or f"permitted are {', '.join(known)}"
            raise SpecError(f"{where} column {column_letter(at)}: {shown(column)}: unknown column; {hint}")
        if column and column in columns:
            first = column_letter(columns.index(column))
            raise SpecError(f"{where} column {column_letter(at)}: {column}: is the same as column {first}")
        columns.append(column)
    for column in needed:
        if column not in columns:
            raise SpecError(f"{where}: has no column {column}; must have {', '.join(needed)}")
    return tuple(columns)


def cell_value(text: str, separator: str) -> float | str | None:
    """Return the value of a cell: a number, else a text, None for a blank one; a decimal comma where it does not separate."""
    text = text.strip()
    if not text:
        return None
    plain = text.replace("\N{MINUS SIGN}", "-")
    try:
        return float(plain if separator == "," else plain.replace(",", "."))
    except ValueError:
        return text


def column_letter(index: int) -> str:
    """Return the name that a spreadsheet gives the column of an index from 0: A ... Z, AA ..."""
    letters, index = "", index + 1
    while index:
        index, letter = divmod(index - 1, 26)
        letters = chr(ord("A") + letter) + letters
    return letters


def user_folder() -> Path:
    """Return the folder of the user's configuration, be it there or not."""
    import platformdirs

    return Path(platformdirs.user_config_dir("gearcad", appauthor=False))
