"""Workbench: the text of a spec that is being changed key by key, with every step back; the last good design is never lost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.designs.cells import CellReader, Layout
from gearcad.designs.design import Design
from gearcad.designs.edit import edit_spec
from gearcad.designs.files import Where, tables_of_text
from gearcad.designs.keys import Cell
from gearcad.designs.named_files import files_only_in
from gearcad.designs.reader import design_from_tables
from gearcad.errors import GearcadError, SpecError

__all__ = ["Fault", "Workbench"]

_MOST_STEPS = 1000
"""Steps back that are kept: the eldest go first."""


@dataclass(frozen=True)
class Fault:
    """What is wrong with a text: the line that the command line would print, and the key at fault ("" where it is none)."""

    line: str
    key: str = ""


class Workbench:
    """One design under change: `text` is its spec, `design` the last that could be made, `fault` why the text makes none.

    `tables` are what the text says, as far as it can be read at all, and `former` what the one before said. A change is a step:
    it can be undone and redone. Files that it names must be in `folder`. Raises SpecError for a first text that makes nothing.
    """

    def __init__(self, text: str, name: str, folder: Path) -> None:
        self.name, self.folder = name, folder
        self.text = text
        self.fault: Fault | None = None
        self.tables, where = self._tables()
        self.former = self.tables
        self.design = self._design(self.tables, where)
        self._back: list[str] = []
        self._forth: list[str] = []

    @property
    def can_undo(self) -> bool:
        return bool(self._back)

    @property
    def can_redo(self) -> bool:
        return bool(self._forth)

    def change(self, given: Mapping[str, str]) -> bool:
        """Write what was typed under its keys, "" to leave a key out; whether the text is another one now.

        What makes no gear stays in the text, as its fault does; the last good design stays too. What cannot be written there
        at all is a fault, too.
        """
        try:
            text = edit_spec(self.text, {key: _value(key, typed) for key, typed in given.items()})
        except GearcadError as error:
            self.fault = Fault(str(error), next(iter(given), ""))
            return False
        return self.write(text)

    def write(self, text: str) -> bool:
        """Take another text, as a step that can be undone; whether it is another one."""
        other = text != self.text
        if other:
            self._back = [*self._back[1 - _MOST_STEPS :], self.text]
            self._forth.clear()
        self._take(text)
        return other

    def undo(self) -> None:
        """Go a step back, if there is one."""
        if self._back:
            self._forth.append(self.text)
            self._take(self._back.pop())

    def redo(self) -> None:
        """Go a step forth again, if there is one."""
        if self._forth:
            self._back.append(self.text)
            self._take(self._forth.pop())

    def _take(self, text: str) -> None:
        self.text, self.fault, self.former = text, None, self.tables
        try:
            self.tables, where = self._tables()
            self.design = self._design(self.tables, where)
        except SpecError as error:
            self.fault = Fault(str(error), error.key)
        except GearcadError as error:
            self.fault = Fault(str(error))

    def _tables(self) -> tuple[dict[str, Any], Where]:
        with files_only_in(self.folder):
            return tables_of_text(self.text, f"{self.name}.toml", self.folder)

    def _design(self, tables: dict[str, Any], where: Where) -> Design:
        with files_only_in(self.folder):
            return design_from_tables(tables, where=where, default_name=self.name)


def _value(key: str, typed: str) -> Cell | None:
    """What was typed, as a cell of a design table is read, with a decimal point or comma. Raises ParameterError."""
    return CellReader(Layout.SEMICOLON).value(key, typed, 0)
