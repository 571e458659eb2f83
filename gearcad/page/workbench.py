"""Workbench: the text of a spec that is being changed key by key, with every step back; the last good design is never lost."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.designs.cells import CellReader, Layout
from gearcad.designs.design import Design
from gearcad.designs.edit import edit_spec
from gearcad.designs.files import Where, tables_of_text
from gearcad.designs.keys import Cell
from gearcad.designs.named_files import files_only_in
from gearcad.designs.reader import design_from_tables
from gearcad.errors import GearcadError, SpecError

__all__ = ["TEXT", "Fault", "Workbench"]

_MOST_STEPS = 1000
"""Steps back that are kept: the eldest go first."""

_PAUSE = 1.0
"""Seconds after which what is typed into the same field is another step."""

_AT = re.compile(r"\.toml line (\d+)")

TEXT = "text"
"""Where one types who types into the text itself."""


class Fault(NamedTuple):
    """What is wrong with a text: the line that the command line would print, and the key at fault ("" where it is none).

    What cannot be written into the text at all is not `written`: only the field has it.
    """

    line: str
    key: str = ""
    written: bool = True

    @property
    def at(self) -> int | None:
        """The line of the text that it names."""
        found = _AT.search(self.line)
        return int(found[1]) if found else None


class Workbench:
    """One design under change: `text` is its spec, `design` the last that could be made, `fault` why the text makes none.

    `tables` are what the text says, as far as it can be read at all, and `former` what the one before said. A change is a step:
    it can be undone and redone. What is typed in one place without a pause is one step. Files it names must be in `folder`.
    Raises SpecError for a first text that makes nothing.
    """

    def __init__(self, text: str, name: str, folder: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self.name, self.folder, self._clock = name, folder, clock
        self.text = text
        self.fault: Fault | None = None
        self.tables, where = self._tables()
        self.former = self.tables
        self.design = self._design(self.tables, where)
        self._back: list[str] = []
        self._forth: list[str] = []
        self._place, self._typed = "", 0.0
        self._step: int | None = None

    @property
    def can_undo(self) -> bool:
        return bool(self._back)

    @property
    def can_redo(self) -> bool:
        return bool(self._forth)

    def change(self, given: Mapping[str, str], step: int | None = None) -> bool:
        """Write what was typed under its keys, "" to leave a key out; whether the text is another one now.

        Texts of one `step` are undone together, however late they come; without a number the pause between them decides.
        What makes no gear stays in the text, as its fault does; the last good design stays too. What cannot be written there
        at all is a fault, too.
        """
        try:
            text = edit_spec(self.text, {key: _value(key, typed) for key, typed in given.items()})
        except GearcadError as error:
            self.fault = Fault(str(error), next(iter(given), ""), written=False)
            return False
        return self.write(text, " ".join(given), step)

    def write(self, text: str, place: str = "", step: int | None = None) -> bool:
        """Take another text, as a step that can be undone; whether it is another one.

        What comes from the same `place` as the last text, in the same `step` or soon after it, goes on with that step.
        """
        other, now = text != self.text, self._clock()
        if other:
            in_time = now - self._typed <= _PAUSE if step is None else step == self._step
            going_on = bool(place and self._back) and place == self._place and in_time
            if not going_on:
                self._back = [*self._back[1 - _MOST_STEPS :], self.text]
                self.former = self.tables
            self._forth.clear()
            self._place, self._step, self._typed = place, step, now
        self._take(text)
        return other

    def open(self, text: str, name: str) -> None:
        """Take another design, called `name` where its text says no other, as a step that can be undone."""
        self.name = name
        self.write(text)

    def blame(self, line: str) -> None:
        """Tell what could not be taken at all; text and design stay."""
        self.fault = Fault(line, written=False)

    def undo(self) -> None:
        """Go a step back, if there is one."""
        self._go(self._back, self._forth)

    def redo(self) -> None:
        """Go a step forth again, if there is one."""
        self._go(self._forth, self._back)

    def _go(self, these: list[str], others: list[str]) -> None:
        if these:
            others.append(self.text)
            self._place, self.former = "", self.tables
            self._take(these.pop())

    def _take(self, text: str) -> None:
        self.text, self.fault = text, None
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
