"""Files: specs are opened and saved, what is made of a design is taken along, and the address holds the design."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from nicegui import background_tasks, ui

from gearcad.designs.starters import NO_DESIGNS, starter_text, starters
from gearcad.errors import GearcadError, printable
from gearcad.page.components.files import FilesView
from gearcad.page.folder import LARGEST_SPEC, LARGEST_TABLE, SPECS, TABLES, Folder, TakenError, text_of
from gearcad.page.given import await_files
from gearcad.page.links import pack
from gearcad.page.run import Run, State
from gearcad.page.run_kinds import DOWNLOADS
from gearcad.page.runs import Runs
from gearcad.page.words import Words
from gearcad.page.workbench import Workbench

__all__ = ["FilesPanel"]

_REST = 0.4
"""Seconds without a change after which the address follows."""

_LOOK = 0.25

Opened = Callable[[str, str], None]
"""Called with a text and what it is called by."""


class FilesPanel:
    """Follows the workbench. `opened` takes a spec's text and name, `tabled` the name and text of a table of results."""

    def __init__(self, key: str, bench: Workbench, words: Words, opened: Opened, tabled: Opened) -> None:
        self._key, self._bench, self._words, self._opened, self._tabled = key, bench, words, opened, tabled
        self._folder, self._runs = Folder(bench.folder), Runs()
        self._view = FilesView(self._asked, f"/given/{key}", _words(words))
        self._names = _names(words)
        self._run: Run | None = None
        self._timer = ui.timer(_LOOK, self._look, active=False)
        self._task: asyncio.Task[None] | None = None
        self._linked = ""
        self._client = ui.context.client
        await_files(key, {"spec": (LARGEST_SPEC, self._given_spec), "table": (LARGEST_TABLE, self._given_table)})

    def follow(self) -> None:
        """Let the address hold the design, once nobody types any more."""
        if self._bench.text != self._linked:
            if self._task is not None:
                self._task.cancel()
            self._task = background_tasks.create(self._link(self._bench.text))

    def close(self) -> None:
        """The tab was closed."""
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
            self._view.show(line=str(error))

    def _asked(self, what: str, told: Mapping[str, Any]) -> None:
        """What was chosen in the menu; what is wrong with it is a line there."""
        name = str(told.get("name", ""))
        ways: dict[str, Callable[[], None]] = {
            "look": self._show,
            "open": lambda: self._take(self._folder.spec(name), Path(name).stem),
            "begin": lambda: self._take(starter_text(name)[1], Path(starter_text(name)[0]).stem),
            "table": lambda: self._given_table(name, self._folder.find(name, TABLES, LARGEST_TABLE).read_bytes()),
            "spec": lambda: ui.download(self._bench.text.encode(), f"{self._bench.design.name}.toml", "application/toml"),
            "save": lambda: self._save(name, replace=told.get("replace") is True),
            "make": lambda: self._make(str(told.get("kind"))),
            "stop": lambda: None if self._run is None else self._runs.cancel(self._run),
        }
        self._view.show(line="", taken="", saved="")
        try:
            ways.get(what, lambda: None)()
        except TakenError as error:
            self._view.show(taken=str(error))
        except GearcadError as error:
            self._view.show(line=str(error))
        except OSError as error:
            self._view.show(line=error.strerror or str(error))

    def _show(self) -> None:
        design = self._bench.design
        self._view.show(
            specs=self._folder.specs(),
            tables=self._folder.names(TABLES),
            starters=[{"name": name, "words": words} for name, words in starters().items() if _is_spec(name)],
            makes=[{"key": key, "words": self._names[key]} for key, kind in DOWNLOADS.items() if kind.accepts(design)],
            name=design.name,
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
                self._view.show(line=str(error))

    def _given_table(self, name: str, content: bytes) -> None:
        with self._client:
            try:
                self._tabled(content.decode("utf-8-sig"), printable(name))
                self._view.close()
            except UnicodeDecodeError:
                self._view.show(line=f"{printable(name)}: is no table of results, for it is not CSV in UTF-8")
            except GearcadError as error:
                self._view.show(line=str(error))

    def _save(self, name: str, *, replace: bool) -> None:
        self._view.show(saved=self._folder.save(name, self._bench.text, replace=replace), specs=self._folder.specs())

    def _make(self, kind: str) -> None:
        bench = self._bench
        if kind in DOWNLOADS and DOWNLOADS[kind].accepts(bench.design):
            if bench.fault is not None and bench.fault.written:
                self._view.show(line=bench.fault.line)
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
        self._view.show(making="", line=run.line if run.state is State.FAILED else "")
        if run.state is State.DONE:
            ui.download.from_url(f"/made/{self._runs.key}/{run.number}")


def _is_spec(name: str) -> bool:
    return starter_text(name)[0].endswith(SPECS) and name not in NO_DESIGNS


def _stem(name: str) -> str:
    """What a browser calls a file, without its end; it names nothing until it is written into a spec."""
    return name.removesuffix(SPECS[0])


def _names(words: Words) -> dict[str, str]:
    return {
        "step": "STEP",
        "stl": "STL",
        "3mf": "3MF",
        "glb": "GLB",
        "dxf": words["contours (DXF)"],
        "csv": words["points (CSV)"],
        "drawing-pdf": words["drawing (PDF)"],
        "drawing-dxf": words["drawing (DXF)"],
        "drawing-svg": words["drawing (SVG)"],
        "data": words["data (JSON)"],
    }


def _words(words: Words) -> dict[str, str]:
    return {
        "file": words["File"],
        "open": words["Open"],
        "browse": words["a file of this computer"],
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
    }
