"""Workbench: the text of a spec that is changed key by key, and a second design beside it."""

from __future__ import annotations

import copy
import re
import time
import tomllib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.core.errors import GearcadError, ParameterError, SpecError
from gearcad.designs.cells import CellReader, Layout
from gearcad.designs.design import Design, Where, files_only_in, tables_of_text
from gearcad.designs.keys import Cell
from gearcad.designs.reader import design_from_tables, edit_spec, starter_text
from gearcad.designs.train_keys import TEXTS, general_key
from gearcad.page.folder import SPECS, Folder, unpack
from gearcad.page.run_process import design_of

_MOST_STEPS = 1000
"""Steps back that are kept: the eldest go first."""

_MOST_FAULTS = 20
"""Largest number of faults that are counted."""

_PAUSE = 1.0
"""Time (s) after which further typing into the same field is another step."""

_AT = re.compile(r"\.toml line (\d+)")

TEXT = "text"
"""Place of changes that the user types into the text itself."""


class Fault(NamedTuple):
    """The fault of a text: the line that the command line would print, and the key at fault ("" where it is none).

    A fault is not `written` if the input cannot be written into the text at all: only the field has it.
    """

    line: str
    key: str = ""
    written: bool = True

    @property
    def at(self) -> int | None:
        """The line of the text that it names."""
        found = _AT.search(self.line)
        return int(found[1]) if found else None


class DesignStatus(Enum):
    """Relation of the last good design to the present inputs: made from them, from earlier ones, or from another spec."""

    PRESENT = "present"
    LAST_GOOD = "last good"
    OTHER = "other"


@dataclass
class _Source:
    """A spec that was opened or saved: its name, and the text that its file has."""

    name: str
    saved: str


class _Version(NamedTuple):
    text: str
    source: _Source


class _FieldText(NamedTuple):
    """A text in which keys that were emptied in their fields still stand, so that they keep their places and comments."""

    full: str
    emptied: frozenset[str] = frozenset()

    def changed(self, given: Mapping[str, Cell | None]) -> _FieldText:
        """Return the text with other values; None empties a key. A value that stands there stays as it is written."""
        try:
            tables = tomllib.loads(self.full)
        except (ValueError, RecursionError):  # then it cannot be edited, which the editor says
            tables = {}
        written = {key: value for key, value in given.items() if value is not None and not _stands(tables, key, value)}
        emptied = self.emptied.difference(given).union(key for key, value in given.items() if value is None)
        return _FieldText(edit_spec(self.full, written) if written else self.full, emptied)

    @property
    def text(self) -> str:
        """The text without the keys that were emptied."""
        return edit_spec(self.full, dict.fromkeys(sorted(self.emptied))) if self.emptied else self.full


def _stands(tables: Mapping[str, Any], key: str, value: Cell) -> bool:
    """Return whether nested tables have this value under a dotted key."""
    inner: Any = tables
    for part in key.split("."):
        if not isinstance(inner, Mapping) or part not in inner:
            return False
        inner = inner[part]
    return isinstance(inner, bool) is isinstance(value, bool) and bool(inner == _lists(value))


def _lists(value: Any) -> Any:
    """Return a value with the lists that TOML has in place of tuples."""
    return [*map(_lists, value)] if isinstance(value, list | tuple) else value


class Workbench:
    """One design under change: `text` is its spec, `design` the last that could be made, `fault` why the text makes none.

    `tables` are what the text says, as far as it can be read at all, and `former` what the one before said. A change is a step:
    it can be undone and redone. What is typed in one place without a pause is one step. Files it names must be in `folder`.
    `saved` is the text of the file that is open (None: this one). Raises SpecError for a first text that makes nothing. Without
    any text the workbench is empty: it waits for a design, and has none to show.
    """

    def __init__(
        self,
        text: str,
        name: str,
        folder: Path,
        clock: Callable[[], float] = time.monotonic,
        saved: str | None = None,
    ) -> None:
        self.folder, self._clock = folder, clock
        self._source = self._good_source = self._read_source = _Source(name, text if saved is None else saved)
        self.text = self._good_text = text
        self.fault: Fault | None = None
        self._where: Where | None = None
        self.tables: dict[str, Any] = {}
        if self.is_empty:
            self._good_source = _Source("", "")  # of another spec: never shown
            self.design = _unseen_design()
        else:
            self.tables, self._where = self._tables()
            self.design = self._design(self.tables, self._where)
        self.former = self._good = self.tables
        self._back: list[_Version] = []
        self._forth: list[_Version] = []
        self._place, self._typed = "", 0.0
        self._step: int | None = None
        self._fields = self._fields_before = _FieldText(text)
        self._text_of_fields = text

    @property
    def name(self) -> str:
        """Name of the file that is open, without its suffix: that of the design, where the text says no other."""
        return self._source.name

    @property
    def is_saved(self) -> bool:
        """Whether the file that is open has this text."""
        return self.text == self._source.saved

    @property
    def is_empty(self) -> bool:
        """Whether nothing was begun yet: there is no text, and no file with one."""
        return not (self.text.strip() or self._source.saved.strip())

    @property
    def saved_text(self) -> str:
        """The text that the file that is open has, as far as it is known."""
        return self._source.saved

    @property
    def status(self) -> DesignStatus:
        """What the last good design is to the inputs. An input that could not be written into the text is one of them."""
        if self._source is not self._good_source:
            return DesignStatus.OTHER
        is_unwritten = self.fault is not None and bool(self.fault.key)
        return DesignStatus.PRESENT if self.text == self._good_text and not is_unwritten else DesignStatus.LAST_GOOD

    @property
    def shown_design(self) -> Design | None:
        """The last good design; None if it is of another spec than the inputs."""
        return None if self.status is DesignStatus.OTHER else self.design

    def faults(self) -> tuple[Fault, ...]:
        """Return the fault and those that remain once each key at fault has the value of the last good design."""
        if self.fault is None or (where := self._where) is None:
            return () if self.fault is None else (self.fault,)
        found, tables = {self.fault.line: self.fault}, copy.deepcopy(self.tables)
        for _ in range(_MOST_FAULTS):
            try:
                self._design(tables, where)
                break
            except GearcadError as error:
                key = error.key if isinstance(error, SpecError) else ""
                found.setdefault(str(error), Fault(str(error), key))
                if not _restore(tables, key, self._good):
                    break
        return tuple(found.values())

    @property
    def can_undo(self) -> bool:
        return bool(self._back)

    @property
    def can_redo(self) -> bool:
        return bool(self._forth)

    def change(self, given: Mapping[str, str], step: int | None = None, followers: Mapping[str, str] | None = None) -> bool:
        """Write what was typed under its keys, "" to leave a key out, and what follows; whether the text is another one now.

        Texts of one `step` are undone together, however late they come; without a number the pause between them decides.
        What makes no gear stays in the text, as its fault does; the last good design stays too. What cannot be written there
        at all is a fault, too.
        """
        place = " ".join(given)
        if self.text != self._text_of_fields:
            self._fields = self._fields_before = _FieldText(self.text)
        before = self._fields_before if self._goes_on(place, step) else self._fields
        try:
            fields = before.changed({key: _value(key, typed) for key, typed in {**given, **(followers or {})}.items()})
            text = fields.text
        except GearcadError as error:
            self.fault = Fault(str(error), next(iter(given), ""), written=False)
            return False
        other = self.write(text, place, step)
        self._fields_before, self._fields, self._text_of_fields = before, fields, text
        return other

    def write(self, text: str, place: str = "", step: int | None = None) -> bool:
        """Take another text, as a step that can be undone; whether it is another one.

        What comes from the same `place` as the last text, in the same `step` or soon after it, goes on with that step.
        """
        if other := text != self.text:
            if not self._goes_on(place, step):
                self._remember()
            self._forth.clear()
            self._place, self._step, self._typed = place, step, self._clock()
        self._take(text)
        return other

    def open(self, text: str, name: str, saved: str | None = None) -> None:
        """Take another design, called `name` where its text says no other, as a step that can be undone.

        `saved` is the text that its file has (None: this one).
        """
        if text != self.text:
            self._remember()
            self._forth.clear()
        self._place = ""
        self._source = _Source(name, text if saved is None else saved)
        self._take(text)

    def note_saved(self, name: str, text: str) -> None:
        """Note that the file of this name has a text now; it is the one that is open."""
        renamed = name != self.name
        self._source.name, self._source.saved = name, text
        if renamed:
            self._take(self.text)

    def _goes_on(self, place: str, step: int | None) -> bool:
        """Return whether a change at a place belongs to the last step."""
        in_time = self._clock() - self._typed <= _PAUSE if step is None else step == self._step
        return bool(place and self._back) and place == self._place and in_time

    def _remember(self) -> None:
        """Make the present text one to which an undo leads."""
        self._back = [*self._back[1 - _MOST_STEPS :], _Version(self.text, self._source)]
        self.former = self.tables

    def blame(self, line: str) -> None:
        """Tell what could not be taken at all; text and design stay."""
        self.fault = Fault(line, written=False)

    def copied(self) -> Workbench:
        """Return a workbench of its own with the same text and steps."""
        other = copy.copy(self)
        own = (self._source, self._good_source, self._read_source, self._back, self._forth)
        (other._source, other._good_source, other._read_source, other._back, other._forth) = copy.deepcopy(own)
        return other

    def undo(self) -> None:
        """Go a step back, if there is one."""
        self._go(self._back, self._forth)

    def redo(self) -> None:
        """Go a step forth again, if there is one."""
        self._go(self._forth, self._back)

    def _go(self, these: list[_Version], others: list[_Version]) -> None:
        if these:
            others.append(_Version(self.text, self._source))
            self._place, self.former = "", self.tables
            version = these.pop()
            self._source = version.source
            self._take(version.text)

    def _take(self, text: str) -> None:
        self.text, self.fault = text, None
        self._where = None
        if self._source is not self._read_source or self.is_empty:
            self.tables = {}
        if self.is_empty:
            self._read_source = self._source
            return
        try:
            self.tables, where = self._tables()
            self._read_source = self._source
            self._where = where
            self.design = self._design(self.tables, where)
            self._good, self._good_text, self._good_source = self.tables, text, self._source
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


@cache
def _unseen_design() -> Design:
    """Return a design for a workbench that is empty, which shows none."""
    return design_of(starter_text("spur")[1], "none", Path())


def _restore(tables: dict[str, Any], key: str, good: Mapping[str, Any]) -> bool:
    """Give a dotted key of nested tables its value in other ones, or remove it; return whether that changes the tables."""
    *parents, name = key.split(".")
    for parent in parents:
        own, other = tables.get(parent), good.get(parent, {})
        if not isinstance(own, dict) or not isinstance(other, Mapping):
            return False
        tables, good = own, other
    former = tables.pop(name, None)
    if name in good:
        tables[name] = copy.deepcopy(good[name])
    return bool(former != tables.get(name))


def _value(key: str, typed: str) -> Cell | None:
    """Return the typed text as the value of a table cell, with a decimal point or comma, or of a switch.

    Raises ParameterError.
    """
    value = CellReader(Layout.SEMICOLON).value(key, typed, 0)
    is_switch = value in ("true", "false") and general_key(key) not in TEXTS
    return value == "true" if is_switch else value


def linked_bench(packed: str, text: str, name: str, folder: Path) -> Workbench:
    """A workbench with the design of a link, or with this text where there is none.

    What makes no gear, or is no link at all, is a fault of the text beneath it. A design that has a file of its name in the
    folder is saved if the file has its text.
    """
    saved = None
    try:
        linked, of_link = unpack(packed) if packed else (name, text)
        with suppress(GearcadError):
            saved = Folder(folder).spec(f"{linked}{SPECS[0]}") if packed else None
        return Workbench(of_link, linked, folder, saved=saved)
    except ParameterError as error:
        bench = Workbench(text, name, folder)
        bench.blame(str(error))
    except GearcadError:
        bench = Workbench(text, name, folder)
        bench.open(of_link, linked, saved)
    return bench


class KeptDesign(NamedTuple):
    """A design, the text that makes it, and its name if the text has none."""

    text: str
    name: str
    design: Design


MOST_DESIGNS = 5
"""Largest number of designs that are compared, with the one that is edited."""


class BesideDesign:
    """The designs that are kept beside that of a workbench `bench`; the last, `kept`, is shown in all panels."""

    def __init__(self, bench: Workbench) -> None:
        self.bench, self.folder = bench, Folder(bench.folder)
        self.all: tuple[KeptDesign, ...] = ()

    @property
    def kept(self) -> KeptDesign | None:
        return self.all[-1] if self.all else None

    @property
    def design(self) -> Design | None:
        return None if self.kept is None else self.kept.design

    def keep(self) -> None:
        """Keep the design that is edited. Raises SpecError while its text makes none, ParameterError beside too many."""
        self._add(self._present())

    def open(self, file: str) -> None:
        """Keep that of a spec in the folder. Raises ParameterError, SpecError."""
        text, name = self.folder.spec(file), file.removesuffix(".toml")
        self._add(KeptDesign(text, name, design_of(text, name, self.folder.path)))

    def _add(self, kept: KeptDesign) -> None:
        """Keep a design as the last one; one that is kept already only changes its place."""
        others = tuple(each for each in self.all if (each.text, each.name) != (kept.text, kept.name))
        if len(others) >= MOST_DESIGNS - 1:
            raise ParameterError("designs", len(others) + 2, f"must be at most {MOST_DESIGNS}: let go of one first")
        self.all = (*others, kept)

    def swap(self, at: int = -1) -> None:
        """Edit a kept design, as a step that can be undone, and keep the edited one. Raises SpecError if that is not a
        design.
        """
        if self.all:
            kept = self.all[at]
            self.all = _with(self.all, at, self._present())
            self.bench.open(kept.text, kept.name)

    def copied(self) -> BesideDesign:
        """Return one of its own with a copy of the workbench."""
        other = BesideDesign(self.bench.copied())
        other.all = self.all
        return other

    def let_go(self, at: int = -1) -> None:
        """Let a kept design go."""
        if self.all:
            self.all = _with(self.all, at)

    def _present(self) -> KeptDesign:
        bench = self.bench
        if bench.fault is not None and bench.fault.written:
            raise SpecError(bench.fault.line, bench.fault.key)
        return KeptDesign(bench.text, bench.name, bench.design)


def _with(kept: tuple[KeptDesign, ...], at: int, *others: KeptDesign) -> tuple[KeptDesign, ...]:
    """Return the kept designs with others in place of one of them."""
    place = range(len(kept))[at]
    return (*kept[:place], *others, *kept[place + 1 :])
