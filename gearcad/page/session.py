"""Session: one tab of a browser - its workbench, and the panels that follow it."""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

from nicegui import background_tasks, ui

from gearcad.designs.design import DesignKind
from gearcad.page.beside_design import BesideDesign
from gearcad.page.components.bar import BarView
from gearcad.page.following import Following
from gearcad.page.handed import Handed, hand_over, take_over
from gearcad.page.links import DESIGN, linked_bench
from gearcad.page.panels.beside import BesidePanel
from gearcad.page.panels.bodies import BodiesPanel
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


class Session:
    """Builds the page in the browser, and lets every panel follow the design.

    `open` are all that somebody has open.
    """

    open: ClassVar[set[Session]] = set()

    def __init__(self, beside: BesideDesign, words: Words, runs: Runs | None = None) -> None:
        self.bench, self.beside, self.words = beside.bench, beside, words
        bench = self.bench
        self.key = secrets.token_urlsafe(12)
        following = self._following = Following(lambda: bench.design, words["failed, and the page goes on"])
        ui.query("html").props(f"lang={words.language.value}")
        with ui.element("header").classes("bar"):
            self._bar()
        with ui.element("main").classes("panels"):
            with _region("left", words["Inputs"]):
                left = self._left = Tabs({"inputs": words["Inputs"], "text": words["Text"], "limits": words["Limits"]})
                with left.under("inputs"):
                    self._inputs = InputsPanel(self.typed, self.step, words)
                with left.under("text"):
                    self._text = TextPanel(self.written, self.step, words)
                left.on("text", lambda: self._text.follow(bench))
                if bench.design.kind is DesignKind.TRAIN:
                    left.choose("text")
                with left.under("limits"):
                    limits = following.with_line(LimitsPanel(bench, self.change, words), lambda: left.chosen == "limits")
                    left.on("limits", lambda: following.look(limits))
            with _region("middle", words["Gears"]):
                with ui.element("div").classes("view"):
                    bodies = following.with_line(BodiesPanel(words))
                with ui.element("div").classes("rolling"):
                    roll = following.with_line(RollPanel(words))
                with ui.element("div").classes("view"):
                    section = following.with_line(SectionPanel(words))
            with _region("right", words["Results"]):
                right = self._right = Tabs({"data": words["Data"], "runs": words["Runs"], "table": words["Table"]})
                with right.under("data"):
                    shares = following.with_line(SharesPanel(words))
                    strength = following.with_line(StrengthPanel(words))
                    sheet = following.with_line(SheetPanel(words))
                with right.under("runs"):
                    self._runs = RunsPanel(bench, words, runs, lambda: right.chosen == "runs")
                    right.on("runs", self._runs.expect)
                with right.under("table"):
                    self._table = TablePanel(words, bench.folder, self.opened)
        following.begin((section, roll, bodies, sheet, strength, limits, shares))
        self.open.add(self)
        ui.context.client.on_delete(self.leave)
        self.follow()
        if beside.kept is not None:
            background_tasks.create(following.compare(lambda: beside.design))

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
        words = self.words
        self._name = ui.label().classes("name").props("role=heading aria-level=1")
        self._files = FilesPanel(self.key, self.bench, words, self.opened, self.tabled)
        self._undo = self._button("undo", words["undo"], forth=False)
        self._redo = self._button("redo", words["redo"], forth=True)
        BesidePanel(self.beside, words, self.kept)
        ui.element("div").classes("rest")
        for language in Language:
            spoken = ui.button(language.value, on_click=lambda _, language=language: self.speak(language))
            spoken.props["title"] = spoken.props["aria-label"] = language.endonym
            spoken.props("flat dense").classes("language").set_enabled(language is not words.language)
        BarView(words)

    def _button(self, icon: str, words: str, *, forth: bool) -> ui.button:
        """One that undoes or redoes, and says so."""
        button = ui.button(icon=icon, on_click=lambda: self.step(forth)).props("flat dense round size=sm")
        button.props["title"] = button.props["aria-label"] = words
        return button

    def typed(self, key: str, text: str, step: int) -> None:
        """Write what was typed into the field of a key, as part of a step."""
        self.change({key: text}, step)

    def change(self, given: Mapping[str, str], step: int | None = None) -> None:
        """Write under keys of the spec what was typed or moved."""
        self.bench.change(given, step)
        self.follow()

    def written(self, text: str, step: int) -> None:
        """Take what was typed into the text, as part of a step."""
        self.bench.write(text, TEXT, step)
        self.follow()

    def opened(self, text: str, name: str) -> None:
        """Somebody opened another spec."""
        self.bench.open(text, name)
        self.follow(reveal=True)

    def kept(self) -> None:
        """Another design is beside this one, or none; it may have changed places with it."""
        self.follow(reveal=True)
        background_tasks.create(self._following.compare(lambda: self.beside.design))

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
        if self._left.chosen == "text":
            self._text.follow(self.bench)
        self._undo.set_enabled(self.bench.can_undo)
        self._redo.set_enabled(self.bench.can_redo)
        self._name.set_text(self.bench.design.name)
        self._files.follow()
        self._runs.follow()
        self._following.follow()

    def leave(self) -> None:
        """The tab was closed: what it has made goes, and what it runs ends."""
        self.open.discard(self)
        self._following.end()
        self._files.close()
        self._runs.close()

    @classmethod
    def leave_all(cls) -> None:
        """The server ends."""
        for each in tuple(cls.open):
            each.leave()


def _region(place: str, label: str) -> ui.element:
    """A part of the page that is found by its name."""
    return ui.element("section").classes(place).props(f'aria-label="{label}"')
