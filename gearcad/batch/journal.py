"""The journal of a run: rows and records on disk, so that memory does not grow with the table, and names are compared there."""

from __future__ import annotations

import pickle
import sqlite3
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from gearcad.batch.results import FILES
from gearcad.batch.row import Checked, Record, Status
from gearcad.designs.table import Row
from gearcad.errors import OutputError, format_number

__all__ = ["Journal"]


class Journal:
    """A temporary database that vanishes with the process, however that ends. Not for more than one thread."""

    def __init__(self) -> None:
        self._database = sqlite3.connect("", isolation_level=None)  # "": on disk, without a name
        self._database.execute("PRAGMA journal_mode = OFF")
        self._database.execute("BEGIN")  # and never commit: nobody reads it after us
        self._database.execute(
            "CREATE TABLE rows (number INTEGER PRIMARY KEY, name TEXT, folded TEXT UNIQUE, row BLOB, checked BLOB, record BLOB)"
        )

    def close(self) -> None:
        """Remove the database."""
        self._database.close()

    def add(self, row: Row) -> list[str]:
        """Note a row of the table; faults of its name beside the other names."""
        folded = unicodedata.normalize("NFC", row.name).casefold() or None
        taken = self._execute("SELECT number, name FROM rows WHERE folded = ?", (folded,)).fetchone()
        content = (row.number, row.name, None if taken else folded, pickle.dumps(row))
        self._execute("INSERT INTO rows (number, name, folded, row) VALUES (?, ?, ?, ?)", content)
        said = f"{row.where('name')}: name = {format_number(row.name)}"
        if taken is not None:
            number, name = taken
            same = "has it too" if name == row.name else f"has {format_number(name)}, which some file systems take for the same"
            return [f"{said}: must be unique, for it names a folder; row {number} {same}"]
        if folded in FILES:
            return [f"{said}: must be another one; this is the name of a table of results"]
        return []

    def keep(self, number: int, checked: Checked) -> None:
        """Note what the check of a row has found."""
        self._execute("UPDATE rows SET checked = ? WHERE number = ?", (pickle.dumps(checked), number))

    def finish(self, record: Record) -> None:
        """Note how a row ended."""
        self._execute("UPDATE rows SET record = ?, checked = NULL WHERE number = ?", (pickle.dumps(record), record.number))

    def open_rows(self) -> Iterator[tuple[Row, Checked]]:
        """The rows without a record, in the order of the table, with what their checks have found."""
        last = -1
        query = "SELECT number, row, checked FROM rows WHERE record IS NULL AND number > ? ORDER BY number LIMIT 1"
        while (found := self._execute(query, (last,)).fetchone()) is not None:
            last = found[0]
            yield pickle.loads(found[1]), pickle.loads(found[2]) if found[2] else Checked()

    def results(self) -> Iterator[tuple[Row, Record]]:
        """Every row and its record, in the order of the table."""
        with _writable():
            for number, row, record in self._execute("SELECT number, row, record FROM rows ORDER BY number"):
                yield pickle.loads(row), pickle.loads(record) if record else Record(number=number, status=Status.NOT_RUN)

    def _execute(self, statement: str, values: tuple[Any, ...] = ()) -> sqlite3.Cursor:
        with _writable():
            return self._database.execute(statement, values)


@contextmanager
def _writable() -> Iterator[None]:
    try:
        yield
    except sqlite3.DatabaseError as error:  # the disk for temporary files is full, or was: then the database is in pieces
        raise OutputError("temporary files", "", f"cannot be written ({error}); TMPDIR names their folder") from error
