"""Session: one tab of a browser - its workbench, and the panels that follow it."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nicegui import background_tasks, run, ui

from gearcad.designs.design import DesignKind
from gearcad.page.beside_design import BesideDesign
from gearcad.page.handed import Handed, hand_over, take_over
from gearcad.page.links import DESIGN, linked_bench
from gearcad.page.panels import Panel
from gearcad.page.panels.beside import BesidePanel
from gearcad.page.panels.bodies import SURFACES, BodiesPanel
from gearcad.page.panels.files import FilesPanel
from gearcad.page.panels.inputs import InputsPanel
from gearcad.page.panels.limits import LimitsPanel
from gearcad.page.panels.roll import RollPanel
from gearcad.page.panels.runs import RunsPanel
from gearcad.page.panels.section import SectionPanel
from gearcad.page.panels.shares import SharesPanel
from gearcad.page.panels.sheet import SheetPanel
from gearcad.page.panels.strength import StrengthPanel
from gearcad.page.panels.table import TablePanel
from gearcad.page.panels.text import TextPanel
from gearcad.page.runs import Runs
from gearcad.page.tabs import Tabs
from gearcad.page.words import Language, Words, language_of
from gearcad.page.workbench import TEXT

__all__ = ["Session"]

_REST = 0.3
"""Seconds without a change after which what takes long is begun."""


class Session:
    """Builds the page in the browser, and lets every panel follow the design.

    What was found for a design that is not the last any more is not shown.
    """

    def __init__(self, beside: BesideDesign, words: Words, runs: Runs | None = None) -> None:
        self.bench, self.beside, self.words = beside.bench, beside, words
        bench = self.bench
        self.key = secrets.token_urlsafe(12)
        self._change = 0
        self._task: asyncio.Task[None] | None = None
        self._later: asyncio.Task[None] | None = None
        ui.query("html").props(f"lang={words.language.value}")
        with ui.element("header").classes("bar"):
            self._bar()
        with ui.element("main").classes("panels"):
            with ui.element("div").classes("left"):
                left = Tabs({"inputs": words["Inputs"], "text": words["Text"], "limits": words["Limits"]})
                with left.under("inputs"):
                    self._inputs = InputsPanel(self.typed, self.step, words)
                with left.under("text"):
                    self._text = TextPanel(self.written, self.step, words)
                if bench.design.kind is DesignKind.TRAIN:
                    left.choose("text")
                with left.under("limits"):
                    limits = LimitsPanel(bench, self.change, words)
            with ui.element("div").classes("middle"):
                bodies = BodiesPanel(self.key, words)
                roll = RollPanel(words)
                section = SectionPanel(words)
            with ui.element("div").classes("right"):
                right = self._right = Tabs({"data": words["Data"], "runs": words["Runs"], "table": words["Table"]})
                with right.under("data"):
                    shares = SharesPanel(words)
                    strength = StrengthPanel(words)
                    sheet = SheetPanel(words)
                with right.under("runs"):
                    self._runs = RunsPanel(bench, words, runs)
                with right.under("table"):
                    self._table = TablePanel(words, bench.folder, self.opened)
        self._panels: tuple[Panel[Any], ...] = (section, roll, bodies, sheet, strength, limits, shares)
        ui.context.client.on_delete(self._leave)
        self.follow()
        if beside.kept is not None:
            background_tasks.create(self._compare())

    @classmethod
    def of(cls, text: str, name: str, folder: Path) -> Session:
        """The page that the browser asks for, with the workbench that it had in the other language, if it comes from there."""
        query, headers = ui.context.client.request.query_params, ui.context.client.request.headers
        words = Words.of(language_of(query.get("lang"), headers.get("accept-language", "")))
        if (found := take_over(query.get("from", ""))) is not None:
            return cls(found.beside, words, found.runs)
        return cls(BesideDesign(linked_bench(query.get(DESIGN, ""), text, name, folder)), words)

    def speak(self, language: Language) -> None:
        """Open the page in another language, with this workbench."""
        key = hand_over(Handed(self.beside, self._runs.hand_over()))
        ui.navigate.to(f"/?lang={language.value}&from={key}")

    def _bar(self) -> None:
        self._name = ui.label().classes("name")
        self._files = FilesPanel(self.key, self.bench, self.words, self.opened, self.tabled)
        self._undo = self._button("undo", self.words["undo"], forth=False)
        self._redo = self._button("redo", self.words["redo"], forth=True)
        BesidePanel(self.beside, self.words, self.kept)
        for language in Language:
            spoken = ui.button(language.value, on_click=lambda _, language=language: self.speak(language)).props("flat dense")
            spoken.props["title"] = spoken.props["aria-label"] = language.endonym
            spoken.set_enabled(language is not self.words.language)

    def _button(self, icon: str, words: str, *, forth: bool) -> ui.button:
        """One that undoes or redoes, and says so."""
        button = ui.button(icon=icon, on_click=lambda: self.step(forth)).props("flat dense round")
        button.props["title"] = button.props["aria-label"] = words
        return button

    def typed(self, key: str, text: str) -> None:
        """Somebody typed into the field of a key."""
        self.change({key: text})

    def change(self, given: Mapping[str, str]) -> None:
        """Write under keys of the spec what was typed or moved."""
        self.bench.change(given)
        self.follow()

    def written(self, text: str) -> None:
        """Somebody typed into the text."""
        self.bench.write(text, TEXT)
        self.follow()

    def opened(self, text: str, name: str) -> None:
        """Somebody opened another spec."""
        self.bench.open(text, name)
        self.follow(reveal=True)

    def kept(self) -> None:
        """Another design is beside this one, or none; it may have changed places with it."""
        self.follow(reveal=True)
        background_tasks.create(self._compare())

    def tabled(self, text: str, name: str) -> None:
        """Somebody opened a table of results."""
        self._right.choose("table")
        self._table.take(text, name)

    def step(self, forth: bool) -> None:
        """Redo, or undo."""
        (self.bench.redo if forth else self.bench.undo)()
        self.follow(reveal=True)

    def follow(self, reveal: bool = False) -> None:
        """Show what the workbench has: inputs at once, all else as it is found."""
        self._inputs.follow(self.bench, reveal)
        self._text.follow(self.bench)
        self._undo.set_enabled(self.bench.can_undo)
        self._redo.set_enabled(self.bench.can_redo)
        self._name.set_text(self.bench.design.name)
        self._files.follow()
        self._runs.follow()
        self._change += 1
        if self._task is None or self._task.done():
            self._task = background_tasks.create(self._find())

    async def _find(self) -> None:
        """Until all panels show the last design; each change begins anew with the quickest of them."""
        shown = 0
        while shown != self._change:
            shown, design = self._change, self.bench.design
            for panel in self._panels:
                if panel.takes_long(design):
                    panel.wait()
                    continue
                found = await run.io_bound(panel.find, design)
                if shown != self._change:
                    break
                panel.show(found)
        if self._later is None or self._later.done():
            self._later = background_tasks.create(self._find_later())

    async def _find_later(self) -> None:
        """What takes long, of the last design: when the hand rests, and without keeping anything else waiting."""
        shown = 0
        while shown != self._change:
            shown, design = self._change, self.bench.design
            await asyncio.sleep(_REST)
            for panel in self._panels:
                if shown == self._change and panel.takes_long(design):
                    found = await run.io_bound(panel.find, design)
                    if shown == self._change:
                        panel.show(found)

    async def _compare(self) -> None:
        """Let panels that compare have what they show of the kept design."""
        kept = self.beside.design
        for panel in self._panels:
            if panel.compares:
                found = None if kept is None else await run.io_bound(panel.find, kept)
                if kept is not self.beside.design:
                    return
                panel.keep(found)
        self.follow()

    def _leave(self) -> None:
        """The tab was closed."""
        SURFACES.pop(self.key, None)
        self._files.close()
        self._runs.close()
