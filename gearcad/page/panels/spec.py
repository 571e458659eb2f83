"""Panels of the spec: inputs, text, files, and a design kept beside it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from nicegui import background_tasks, ui

from gearcad.core.errors import GearcadError, printable
from gearcad.core.units import MM_PER_INCH, ShownUnit, UnitSystem, shown_unit
from gearcad.designs.keys import GEAR_FIELDS
from gearcad.designs.reader import NOT_ON_PAGE, kind_of, starter_text, starters
from gearcad.page.components.elements import FilesView, InputsView, TextView
from gearcad.page.fields import fields_of, given_texts, ranked_fields, used_texts
from gearcad.page.folder import LARGEST_SPEC, LARGEST_TABLE, NEW, SPECS, TABLES, Folder, TakenError, pack, text_of
from gearcad.page.panels import mark_stale
from gearcad.page.panels.holds import HoldSwitches
from gearcad.page.panels.sheet_content import clause_in
from gearcad.page.run_process import DOWNLOADS
from gearcad.page.runs import Run, Runs, RunState, await_files
from gearcad.page.words import PageWords
from gearcad.page.workbench import BesideDesign, DesignStatus, Workbench
from gearcad.solids import Format

_WIDE = 3
"""Largest number of gears whose columns have room for the unit of what stands beside a value."""


class InputsPanel:
    """Follows the workbench itself, not the last good design: what is wrong must be seen where it was typed."""

    def __init__(
        self,
        bench: Workbench,
        changed: Callable[[str, str, int], None],
        hold: Callable[[str], None],
        step: Callable[[bool], None],
        words: PageWords,
    ) -> None:
        self._bench, self._words = bench, words
        self.holds = HoldSwitches(bench, words)
        own = {
            "inputs": words["inputs of the spec"],
            "search": words["find a key"],
            "nothing": words["no key has these words"],
            "textOnly": words["Inertias, shafts and meshes of a train are edited as text."],
            "out": words["leave out of the spec"],
            "shared": words["as in"],
            "fault": words["fault"],
            "faults": words["faults"],
            "or": words["or"],
            "size": words["size"],
            "hold": words["hold"],
            "first": words["Main inputs"],
        }
        self._view = InputsView(changed, hold, step, own)
        self._layout: Any = None
        self._ranked: dict[str, Any] = {}
        self._keys: frozenset[str] = frozenset()
        self._units: dict[str, ShownUnit] = {}

    def follow(self, reveal: bool = False) -> None:
        """Show what the text says, what the last good design uses where it says nothing, and what is wrong.

        With `reveal` what has changed comes into sight: it was not typed here.
        """
        bench = self._bench
        design = bench.shown_design
        layout = (kind_of(bench.tables), *bench.tables) if design is None else (design.kind, *design.gears, *bench.tables)
        if layout != self._layout:
            self._layout = layout
            self._have(fields_of(design, bench.tables))
        is_stale = bench.status is DesignStatus.LAST_GOOD
        mark_stale(self._view, f"{self._words['grey']}: {self._words['of the last good design']}" if is_stale else "")
        faults = [each._asdict() | {"line": self._words.message(each.line)} for each in bench.faults()]
        given, former = given_texts(bench.tables), given_texts(bench.former)
        all_used = {} if design is None else used_texts(design, bench.tables)
        used = {key: text for key, text in all_used.items() if key in self._keys}
        changed = sorted(key for key in given.keys() | former.keys() if given.get(key) != former.get(key))
        ranked = self._first_inputs(ranked_fields(design, bench.tables))
        own = {"given": self._shown(given), "used": self._shown(used), "faults": faults, "changed": changed, "reveal": reveal}
        self._view.show(own | ranked | self.holds.state() | {"beside": self._pitches({**used, **given})})

    def stored(self, key: str, text: str) -> str:
        """Return what was typed for a key in the units of specs. The text that is shown means the value behind it."""
        unit = self._units.get(key)
        if unit is None:
            return text
        return unit.stored(text, tuple(given_texts(each).get(key, "") for each in (self._bench.tables, self._bench.former)))

    def _shown(self, texts: Mapping[str, str]) -> dict[str, str]:
        """Return texts of values by their keys, in the units of the page."""
        return {key: self._units[key].shown(text) if key in self._units else text for key, text in texts.items()}

    def _pitches(self, modules: Mapping[str, str]) -> dict[str, Any]:
        """Return what stands beside modules in inches, by the keys of these: the normal diametral pitch (1/inch) of each."""
        if self._words.units is UnitSystem.METRIC:
            return {}
        symbol, found = GEAR_FIELDS["normal_diametral_pitch"].symbol, dict[str, Any]()
        unit = f" {symbol.unit}" if len(self._ranked["columns"]) <= _WIDE else ""
        for key in (key for row in self._ranked["rows"] for key in row["keys"] if key.endswith(".normal_module")):
            with suppress(KeyError, ValueError, ZeroDivisionError):
                pitch = self._words.number(f"{MM_PER_INCH / float(modules[key]):.5g}")
                found[key] = [*symbol.parts, (f" = {pitch}{unit}", "")]
        return found

    def _first_inputs(self, ranked: dict[str, Any]) -> dict[str, Any]:
        """Return the part of the state that says which inputs come first, if these are other ones than before."""
        ranked["columns"] = [self._words[title] for title in ranked["columns"]]
        if ranked == self._ranked:
            return {}
        self._ranked = ranked
        return {"ranked": ranked}

    def _have(self, tables: list[dict[str, Any]]) -> None:
        """Make the fields, in the language of the page."""
        words = self._words
        self._units.clear()
        self._keys = frozenset(field["key"] for table in tables for group in table["groups"] for field in group["fields"])
        for table in tables:
            table["title"] = words[table["title"]]
            for group in table["groups"]:
                group["family"] = words[group["family"]] if group["family"] else ""
                group["title"] = ": ".join(words[title] for title in group.pop("titles"))
                for field in group["fields"]:
                    field["words"] = words.divided(words[field["words"]])
                    field["source"] = clause_in(words, field["source"])
                    self._convert(field)
        self._view.have(tables)

    def _convert(self, field: dict[str, Any]) -> None:
        """Let a field have unit and bounds in the units of the page."""
        unit = shown_unit(self._words.units, field["unit"], field["key"])
        if unit is not None:
            self._units[field["key"]] = unit
            bounds = {name: field[name] for name in ("least", "most", "negative") if field[name] is not None}
            field |= {"unit": unit.name, **{name: float(f"{unit.of(bound):.6g}") for name, bound in bounds.items()}}
        field["unit"] = self._words.unit_name(field["unit"])


class TextPanel:
    """Follows the workbench itself; calls `written(text, step)` after typing, and `step(forth)` for keys that undo or redo."""

    def __init__(self, written: Callable[[str, int], None], step: Callable[[bool], None], words: PageWords) -> None:
        self._written, self._words, self._newline = written, words, "\n"
        self._view = TextView(self._typed, step, words["text of the spec"])
        self._fault = ui.label().classes("spec-fault").props("role=alert")

    def _typed(self, text: str, step: int) -> None:
        self._written(text.replace("\n", self._newline), step)

    def follow(self, bench: Workbench) -> None:
        """Show the text, and what is wrong with it where that is."""
        self._newline = "\r\n" if "\r\n" in bench.text else "\n"
        fault = bench.fault
        self._view.show({"text": bench.text.replace("\r\n", "\n"), "line": fault.at if fault else None})
        self._fault.set_text(self._words.message(fault.line) if fault else "")


class BesidePanel:
    """Menu that keeps a second design beside the first one; it calls `changed` when the kept design changes."""

    def __init__(self, beside: BesideDesign, words: PageWords, changed: Callable[[], None]) -> None:
        self._beside, self._words, self._changed = beside, words, changed
        self._files: list[str] | None = None
        with ui.element("div").classes("beside"):
            with ui.button(words["Beside"]).props("flat dense no-caps"), ui.menu().on("show", self._list) as self._menu:
                self._list()
            with ui.element("div").classes("beside-kept") as self._shown:
                self._name = ui.label()
                ui.button(words["swap"], on_click=lambda: self._do(beside.swap)).props("flat dense no-caps")
                ui.button(words["let go"], on_click=lambda: self._do(beside.let_go)).props("flat dense no-caps")
            self._line = ui.label().classes("beside-line").props("role=alert")
        self._show("")

    def _list(self) -> None:
        """List the designs that can be kept: the present one, and the specs in the folder.

        An open menu stays if these are unchanged.
        """
        files = self._beside.folder.specs()
        if files == self._files:
            return
        self._files = files
        self._menu.clear()
        with self._menu:
            ui.menu_item(self._words["keep this design"], lambda: self._do(self._beside.keep))
            for file in files:
                ui.menu_item(file, partial(self._do, partial(self._beside.open, file)))

    def _do(self, what: Callable[[], None]) -> None:
        try:
            what()
        except GearcadError as error:
            self._show(self._words.message(str(error)))
            return
        self._show("")
        self._changed()

    def swap(self, at: int) -> None:
        """Edit a kept design, and keep the edited one in its place."""
        if 0 <= at < len(self._beside.all):
            self._do(partial(self._beside.swap, at))

    def let_go(self, at: int) -> None:
        """Let a kept design go."""
        if 0 <= at < len(self._beside.all):
            self._do(partial(self._beside.let_go, at))

    def _show(self, line: str) -> None:
        kept, others = self._beside.kept, len(self._beside.all) - 1
        self._shown.set_visibility(kept is not None)
        more = f" (+{others})" if others > 0 else ""
        self._name.set_text("" if kept is None else f"{self._words['kept']}: {kept.design.name}{more}")
        self._line.set_text(line)


_REST = 0.4
"""Seconds without a change after which the address follows."""

_LOOK = 0.25

Opened = Callable[[str, str], None]
"""Function called with the text of a spec and its name."""


class FilesPanel:
    """Follows the workbench. `opened` takes a spec's text and name, `tabled` the name and text of a table of results.

    `saved` is called after the design was saved, `linked` with the key of the page and the text that its address has.
    """

    def __init__(
        self,
        key: str,
        bench: Workbench,
        words: PageWords,
        opened: Opened,
        tabled: Opened,
        saved: Callable[[], None],
        linked: Callable[[str, str], None],
    ) -> None:
        self._key, self._bench, self._words, self._opened, self._tabled = key, bench, words, opened, tabled
        self._saved, self._state = saved, ("", False)
        self._folder, self._runs = Folder(bench.folder), Runs()
        self._view = FilesView(self._asked, f"/given/{key}", key, _words(words))
        self._names = _names(words)
        self._run: Run | None = None
        self._timer = ui.timer(_LOOK, self._look, active=False)
        self._task: asyncio.Task[None] | None = None
        self._linked, self._note_link = "", linked
        self._client = ui.context.client
        await_files(key, {"spec": (LARGEST_SPEC, self._given_spec), "table": (LARGEST_TABLE, self._given_table)})

    def follow(self) -> None:
        """Show whether the design is saved, and let the address hold it, once nobody types any more."""
        state = (self._bench.name, not self._bench.is_saved)
        if state != self._state:
            self._state = state
            self._view.show(file=state[0], unsaved=state[1])
        if self._bench.text != self._linked:
            if self._task is not None:
                self._task.cancel()
            self._task = background_tasks.create(self._link(self._bench.text))

    def leave_for(self, address: str) -> None:
        """Open the page that takes the design over, without a question."""
        self._view.leave_for(address)

    def make(self, kind: str) -> None:
        """Make a file of a kind, which the browser takes when it is ready, and say so."""
        with self._client:
            ui.notify(f"{self._names[kind]}: {self._words['being computed']}")
            self._make(kind)

    def close(self) -> None:
        """Stop because the tab was closed."""
        await_files(self._key, None)
        self._runs.close()
        if self._task is not None:
            self._task.cancel()

    async def _link(self, text: str) -> None:
        await asyncio.sleep(_REST)
        self._linked = text
        try:
            self._view.follow(pack(self._bench.name, text))
        except GearcadError as error:
            self._view.follow("")
            self._view.show(line=self._words.message(str(error)))
        self._note_link(self._key, text)

    def _asked(self, what: str, told: Mapping[str, Any]) -> None:
        """Do the action chosen in the menu. A fault is shown as a line there."""
        name = str(told.get("name", ""))
        ways: dict[str, Callable[[], None]] = {
            "look": self._show,
            "open": lambda: self._take(self._folder.spec(name), Path(name).stem),
            "new": lambda: self._take("", NEW),
            "begin": lambda: self._take(starter_text(name)[1], Path(starter_text(name)[0]).stem),
            "table": lambda: self._given_table(name, self._folder.find(name, TABLES, LARGEST_TABLE).read_bytes()),
            "spec": lambda: ui.download(self._bench.text.encode(), f"{self._bench.name}.toml", "application/toml"),
            "save": lambda: self._save_as(name, replace=told.get("replace") is True),
            "save-open": self._save_open,
            "make": lambda: self._make(str(told.get("kind"))),
            "stop": lambda: None if self._run is None else self._runs.cancel(self._run),
        }
        self._view.show(line="", taken="", saved="")
        try:
            ways.get(what, lambda: None)()
        except TakenError as error:
            self._view.show(taken=self._words.message(str(error)))
        except GearcadError as error:
            self._view.show(line=self._words.message(str(error)))
        except OSError as error:
            self._view.show(line=self._words.message(error.strerror or str(error)))

    def _show(self) -> None:
        design = self._bench.shown_design
        kinds = [] if design is None else [key for key, kind in DOWNLOADS.items() if kind.accepts(design)]
        self._view.show(
            specs=self._folder.specs(),
            tables=self._folder.names(TABLES),
            starters=[
                {"name": name, "words": self._words.message(words)} for name, words in starters().items() if _is_spec(name)
            ],
            makes=[{"key": key, "words": self._names[key]} for key in kinds],
            name=self._bench.name,
        )

    def _take(self, text: str, name: str) -> None:
        self._opened(text, name)
        self._show()
        self._view.close()

    def _given_spec(self, name: str, content: bytes) -> None:
        with self._client:
            try:
                self._take(text_of(content, printable(name)), _stem(printable(name)))
            except GearcadError as error:
                self._view.show(line=self._words.message(str(error)))

    def _given_table(self, name: str, content: bytes) -> None:
        with self._client:
            try:
                self._tabled(content.decode("utf-8-sig"), printable(name))
                self._view.close()
            except UnicodeDecodeError:
                self._view.show(
                    line=self._words.message(f"{printable(name)}: is no table of results, for it is not CSV in UTF-8")
                )
            except GearcadError as error:
                self._view.show(line=self._words.message(str(error)))

    def _save_as(self, name: str, *, replace: bool) -> None:
        self._view.show(saved=self._save(name, replace=replace))

    def _save(self, name: str, *, replace: bool) -> str:
        """Save under a name, of which the file is then the one that is open, and return the name of the file."""
        bench = self._bench
        file = self._folder.save(name, bench.text, replace=replace)
        bench.note_saved(file.removesuffix(SPECS[0]), bench.text)
        self._view.show(specs=self._folder.specs(), name=bench.name)
        self._saved()
        return file

    def _save_open(self) -> None:
        """Save to the file that is open, at once if it has the text that is known of it. Otherwise the menu asks."""
        try:
            file = self._save(self._bench.name, replace=self._has_known_text())
        except (GearcadError, OSError):
            self._show()
            self._view.open()
            raise
        ui.notify(f"{self._words['saved']}: {file}")

    def _has_known_text(self) -> bool:
        """Return whether the file that is open has the text that it had when it was opened or saved."""
        try:
            return self._folder.spec(f"{self._bench.name}{SPECS[0]}") == self._bench.saved_text
        except GearcadError:
            return False

    def _make(self, kind: str) -> None:
        bench = self._bench
        if kind in DOWNLOADS and bench.shown_design is not None and DOWNLOADS[kind].accepts(bench.design):
            if bench.fault is not None and bench.fault.written:
                self._view.show(line=self._words.message(bench.fault.line))
                return
            self._run = self._runs.start(kind, bench.text, bench.name, bench.folder, {})
            self._timer.activate()
            self._look()

    def _look(self) -> None:
        """While something is being made: what; at the end the browser takes it."""
        run = self._run
        if run is None:
            return
        if not run.state.ended:
            self._view.show(making=f"{self._names[run.asked.kind]} {run.step}")
            return
        self._timer.deactivate()
        self._run = None
        self._view.show(making="", line=self._words.message(run.line) if run.state is RunState.FAILED else "")
        if run.state is RunState.DONE:
            ui.download.from_url(f"/made/{self._runs.key}/{run.number}")


def _is_spec(name: str) -> bool:
    return starter_text(name)[0].endswith(SPECS) and name not in NOT_ON_PAGE


def _stem(name: str) -> str:
    """Return the name of an uploaded file without its suffix. It names no file until it is written into a spec."""
    return name.removesuffix(SPECS[0])


def _names(words: PageWords) -> dict[str, str]:
    return {
        **{each.value: each.value.upper() for each in Format},
        "dxf": words["contours (DXF)"],
        "csv": words["points (CSV)"],
        "drawing-pdf": words["drawing (PDF)"],
        "drawing-dxf": words["drawing (DXF)"],
        "drawing-svg": words["drawing (SVG)"],
        "data": words["data (JSON)"],
    }


def _words(words: PageWords) -> dict[str, str]:
    return {
        "file": words["File"],
        "open": words["Open"],
        "browse": words["a file of this computer"],
        "new": words["new design"],
        "starters": words["starters"],
        "table": words["Table of results"],
        "save": words["Save"],
        "spec": words["download the spec"],
        "name": words["name of the file"],
        "store": words["save to the folder"],
        "replace": words["replace it"],
        "along": words["Take along"],
        "cancel": words["cancel"],
        "link": words["Link"],
        "copy": words["copy a link that holds the design"],
        "copied": words["copied"],
        "unsaved": words["not saved"],
    }
