"""Session: one tab of a browser with its workbench and all panels."""

from __future__ import annotations

import secrets
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import ClassVar, NamedTuple

from nicegui import background_tasks, ui

from gearcad.core.units import UnitSystem, inch_units
from gearcad.designs.keys import DesignKind
from gearcad.designs.reader import kind_of
from gearcad.designs.train_designs import TrainDesign
from gearcad.jobs.draw import Draw
from gearcad.page.components.elements import BarView
from gearcad.page.fields import LIMITED
from gearcad.page.folder import DESIGN, TAB
from gearcad.page.following import Following, Tabs
from gearcad.page.panels.compare import ComparePanel
from gearcad.page.panels.drawing import DrawingPanel
from gearcad.page.panels.drawn_data import stands_of
from gearcad.page.panels.limits import LimitsPanel
from gearcad.page.panels.modifications import ModificationsPanel
from gearcad.page.panels.results import ResultsPanel
from gearcad.page.panels.runs import RunsPanel
from gearcad.page.panels.search import TaskPlace
from gearcad.page.panels.section_tools import SectionToolsPanel
from gearcad.page.panels.sheet_content import StrengthPanel
from gearcad.page.panels.spec import BesidePanel, FilesPanel, InputsPanel, TextPanel
from gearcad.page.panels.table import TablePanel
from gearcad.page.panels.tasks import TasksPanel, ask_to_replace
from gearcad.page.panels.views import BodiesPanel, RollPanel, SectionPanel, SharesPanel, SheetPanel
from gearcad.page.runs import Runs
from gearcad.page.words import PageLanguage, PageWords, language_of
from gearcad.page.workbench import TEXT, BesideDesign, linked_bench

_SECONDS = 60.0
"""Seconds until an unclaimed handover is dropped."""


class SessionHandover(NamedTuple):
    """A workbench with what is kept beside it, and the runs of its session."""

    beside: BesideDesign
    runs: Runs


_HANDOVERS: dict[str, SessionHandover] = {}


def hand_over(handed: SessionHandover) -> str:
    """Store the workbench under a secret key for a limited time."""
    key = secrets.token_urlsafe(12)
    _HANDOVERS[key] = handed
    waiting = threading.Timer(_SECONDS, _drop, (key,))
    waiting.daemon = True
    waiting.start()
    return key


def take_over(key: str) -> SessionHandover | None:
    """Return the handover that was left under a key, once; None if there is none."""
    return _HANDOVERS.pop(key, None)


class _RecentPage(NamedTuple):
    """The workbench of a page, and the last two texts that its address was given; the address follows the typing later."""

    beside: BesideDesign
    linked: tuple[str, ...]


_RECENT: dict[str, _RecentPage] = {}
"""The latest pages by the keys of their sessions, for pages that are loaded again."""

_MOST_RECENT = 64


def remember(key: str, beside: BesideDesign) -> None:
    """Keep the workbench of a session for a page that is loaded again; the eldest of too many goes."""
    _RECENT[key] = _RecentPage(beside, (beside.bench.text,))
    while len(_RECENT) > _MOST_RECENT:
        del _RECENT[next(iter(_RECENT))]


def note_link(key: str, text: str) -> None:
    """Note that the address of a page has another text now."""
    if (page := _RECENT.get(key)) is not None:
        _RECENT[key] = page._replace(linked=(*page.linked[-1:], text))


def resumed(key: str, linked: BesideDesign | None) -> BesideDesign | None:
    """Return a copy of the workbench that a session had, with its steps; None if a link has a text that its page never had.

    The text of the link may be that of the page before its last keystrokes, which the workbench has.
    """
    former = _RECENT.get(key)
    if former is None or (linked is not None and linked.bench.text not in (former.beside.bench.text, *former.linked)):
        return None
    return former.beside.copied()


def _drop(key: str) -> None:
    if (left := take_over(key)) is not None:
        left.runs.close()


class Session:
    """Page in the browser, whose panels all follow the design.

    `open` are all that somebody has open.
    """

    open: ClassVar[set[Session]] = set()

    def __init__(self, beside: BesideDesign, words: PageWords, runs: Runs | None = None) -> None:
        self.bench, self.beside, self.words = beside.bench, beside, words
        self._is_empty, self._taken = False, ""
        bench = self.bench
        self.key = secrets.token_urlsafe(12)
        remember(self.key, beside)
        self._client, self._has_browser = ui.context.client, False
        self._client.on_connect(self._connect)
        following = self._following = Following(lambda: bench.design, lambda: bench.status, words)
        ui.query("html").props(f"lang={words.language.value}").props(f'data-units="{_units_told(words.units)}"')
        with ui.element("header").classes("bar"):
            self._bar()
        with ui.element("main").classes("panels") as self._panels:
            with _region("left", words["Inputs"]):
                left = self._left = Tabs(_left_titles(words))
                with left.under("inputs"):
                    self._inputs = InputsPanel(bench, self.typed, self.hold, self.step, words)
                with left.under("text"):
                    self._text = TextPanel(self.written, self.step, words)
                left.on("text", lambda: self._text.follow(bench))
                if bench.design.kind in (DesignKind.TRAIN, DesignKind.SHAFT):
                    left.choose("text")
                with left.under("limits"):
                    limits = following.with_line(LimitsPanel(bench, self.change, words), lambda: left.chosen == "limits")
                    following.band()
                    left.on("limits", lambda: following.look(limits))
                with left.under("flanks"):
                    flanks = following.with_line(ModificationsPanel(bench, self.change, words), lambda: left.chosen == "flanks")
                    flanks.look = lambda: following.look(flanks)
                    following.band()
                    left.on("flanks", flanks.look)
            with _region("middle", words["Gears"]):
                with ui.element("div").classes("view"):
                    bodies = following.with_line(BodiesPanel(words))
                    following.band()
                    self._results = ResultsPanel(bench, words, bodies.colour)
                    self._results.legend("bodies")
                with ui.element("div").classes("rolling"):
                    roll = following.with_line(RollPanel(words))
                with ui.element("div").classes("view"):
                    section = following.with_line(SectionPanel(words))
                    following.band()
                    self._results.legend("section")
                    tools = following.with_line(SectionToolsPanel(bench, self.change, words))
                    tools.look = lambda: following.look(tools)
                self._results.place()
            with _region("right", words["Results"]):
                right = self._right = Tabs(_right_titles(words))
                with right.under("data"):
                    shares = following.with_line(SharesPanel(words))
                    strength = following.with_line(StrengthPanel(words))
                    sheet = following.with_line(SheetPanel(words))
                    following.band()
                with right.under("runs"):
                    self._runs = RunsPanel(bench, words, runs, lambda: right.chosen == "runs", self._results.follow)
                    self._results.use(self._runs.runs, self._runs.run_name)
                    right.on("runs", self._show_runs)
                with right.under("compare"):
                    compare = following.with_line(
                        ComparePanel(words, lambda: bench.name, self._beside),
                        lambda: right.chosen == "compare" and bool(beside.all),
                    )
                    following.band()
                    right.on("compare", lambda: following.look(compare))
                with right.under("tasks"):
                    taken = (self.taken, self.rewritten, self.change)
                    self._tasks = TasksPanel(TaskPlace(bench, words, self._runs.runs, *taken))
                    right.on("tasks", self._tasks.follow)
                with right.under("drawing"):
                    drawing = following.with_line(
                        DrawingPanel(words, lambda: self._files.make("drawing-pdf"), self.change),
                        lambda: right.chosen == "drawing",
                    )
                    following.band()
                    right.on("drawing", lambda: following.look(drawing))
                with right.under("table"):
                    self._table = TablePanel(words, bench.folder, self.opened)
        following.begin((section, tools, roll, sheet, bodies, strength, flanks, limits, shares, compare, drawing))
        self.open.add(self)
        ui.context.client.on_delete(self.leave)
        self.follow()
        if beside.kept is not None:
            background_tasks.create(following.compare(lambda: beside.all))

    @classmethod
    def of(cls, text: str, name: str, folder: Path) -> Session:
        """Return the page for the browser's request, with the workbench of the page that it replaces, in another language or
        other units, if any.
        """
        query, headers = ui.context.client.request.query_params, ui.context.client.request.headers
        units = UnitSystem.INCH if query.get("units") == UnitSystem.INCH.value else UnitSystem.METRIC
        words = PageWords.of(language_of(query.get("lang"), headers.get("accept-language", "")), units)
        if (found := take_over(query.get("from", ""))) is not None:
            return cls(found.beside, words, found.runs)
        linked = BesideDesign(linked_bench(query.get(DESIGN, ""), text, name, folder))
        return cls(resumed(query.get(TAB, ""), linked if DESIGN in query else None) or linked, words)

    @classmethod
    def drop_abandoned(cls) -> bool:
        """Close the eldest page that was sent and to which no browser has connected; return whether there was one."""
        abandoned = [each for each in cls.open if not each._has_browser]
        if abandoned:
            min(abandoned, key=lambda each: each._client.created)._client.delete()
        return bool(abandoned)

    def _connect(self) -> None:
        """Note that a browser shows this page."""
        self._has_browser = True

    def reopen(self, language: PageLanguage, units: UnitSystem) -> None:
        """Open the page in another language or other units, with this workbench."""
        key = hand_over(SessionHandover(self.beside, self._runs.hand_over()))
        self._files.leave_for(f"/?lang={language.value}&units={units.value}&from={key}")

    def _bar(self) -> None:
        words = self.words
        self._name = ui.label().classes("name").props("role=heading aria-level=1")
        self._files = FilesPanel(self.key, self.bench, words, self.opened, self.tabled, self.follow, note_link)
        self._undo = self._button("undo", words["undo"], forth=False)
        self._redo = self._button("redo", words["redo"], forth=True)
        self._beside = BesidePanel(self.beside, words, self.kept)
        ui.element("div").classes("rest")
        titles = {UnitSystem.METRIC: words["millimetres and newtons"], UnitSystem.INCH: words["inches and pounds"]}
        for units, title in titles.items():
            self._choice(units.value, title, words.language, units)
        for language in PageLanguage:
            self._choice(language.value.upper(), language.endonym, language, words.units)
        BarView(words)

    def _choice(self, text: str, title: str, language: PageLanguage, units: UnitSystem) -> None:
        """Make a button that opens the page in a language and in units, unless these are its own."""
        button = ui.button(text, on_click=lambda: self.reopen(language, units)).props("flat dense no-caps").classes("language")
        button.props["title"] = button.props["aria-label"] = title
        button.set_enabled((language, units) != (self.words.language, self.words.units))

    def _button(self, icon: str, words: str, *, forth: bool) -> ui.button:
        """One that undoes or redoes, and says so."""
        button = ui.button(icon=icon, on_click=lambda: self.step(forth)).props("flat dense round size=sm")
        button.props["title"] = button.props["aria-label"] = words
        return button

    def typed(self, key: str, text: str, step: int) -> None:
        """Write the text that was typed into the field of a key, as part of a step, and what follows from it."""
        self.bench.change({key: self._inputs.stored(key, text)}, step, self._inputs.holds.followers(key, text))
        self.follow()

    def hold(self, what: str) -> None:
        """Hold the centre distance, the profile shifts or the ratio, as a step."""
        self.change(self._inputs.holds.press(what))

    def change(self, given: Mapping[str, str], step: int | None = None) -> None:
        """Write values that were typed or moved under keys of the spec."""
        self.bench.change(given, step)
        self.follow()

    def written(self, text: str, step: int) -> None:
        """Take the text that was typed into the spec, as part of a step."""
        self.bench.write(text, TEXT, step)
        self.follow()

    def opened(self, text: str, name: str) -> None:
        """Take another spec that the user opened, once the user lets unsaved work go."""
        self._replace(lambda: self.bench.open(text, name))

    def taken(self, text: str, name: str) -> None:
        """Take a design that was found, as one step, once the user lets unsaved work go. It has no file yet."""

        def take() -> None:
            self._taken = text
            self.bench.open(text, name, saved="")

        self._replace(take)

    def _replace(self, take: Callable[[], None]) -> None:
        """Replace the design. If it is not saved, and was not just taken as it is, the user is asked first."""

        def answered() -> None:
            take()
            self.follow(reveal=True)

        if self.bench.is_saved or self.bench.text == self._taken:
            answered()
        else:
            ask_to_replace(self.words, answered)

    def rewritten(self, text: str) -> None:
        """Take another text of the present design, as one step."""
        self.bench.write(text)
        self.follow(reveal=True)

    def kept(self) -> None:
        """Another design is beside this one, or none; it may have changed places with it."""
        self.follow(reveal=True)
        background_tasks.create(self._following.compare(lambda: self.beside.all))

    def tabled(self, text: str, name: str) -> None:
        """Show a table of results that the user opened."""
        self._right.choose("table")
        self._table.take(text, name)

    def step(self, forth: bool) -> None:
        """Redo or undo a step."""
        (self.bench.redo if forth else self.bench.undo)()
        self.follow(reveal=True)

    def _show_runs(self) -> None:
        """Show what can be run, and the runs of all panels."""
        self._runs.expect()
        self._runs.watch()

    def follow(self, reveal: bool = False) -> None:
        """Show what the workbench has: inputs at once, all else as it is found."""
        self._inputs.follow(reveal)
        if self._left.chosen == "text":
            self._text.follow(self.bench)
        self._undo.set_enabled(self.bench.can_undo)
        self._redo.set_enabled(self.bench.can_redo)
        design = self.bench.shown_design
        self._name.set_text(self.bench.name if design is None else design.name)
        self._files.follow()
        self._runs.follow()
        self._results.follow()
        self._show_begin()
        kind = kind_of(self.bench.tables) if design is None else design.kind
        self._offer_tabs(kind)
        self._panels.classes(**{"add" if self._is_gearless() else "remove": "gearless"})
        self._following.follow()

    def _offer_tabs(self, kind: DesignKind) -> None:
        """Offer the tabs that have content for a kind of design."""
        self._left.offer({"limits": kind in LIMITED, "flanks": kind is DesignKind.PAIR})
        self._right.offer({"drawing": kind in Draw.accepts})

    def _is_gearless(self) -> bool:
        """Return whether the last good design has no gears to show."""
        design = self.bench.design
        return design.kind is DesignKind.SHAFT or (isinstance(design, TrainDesign) and stands_of(design) is None)

    def _show_begin(self) -> None:
        """Show only the ways to begin while there is no design, and all panels from the first one on."""
        is_empty = self.bench.is_empty
        if is_empty is not self._is_empty:
            self._is_empty = is_empty
            self._panels.classes(remove="" if is_empty else "empty", add="empty" if is_empty else "")
            if is_empty:
                self._right.choose("tasks")
        if self._right.chosen == "tasks":
            self._tasks.follow()

    def leave(self) -> None:
        """Remove the files and end the runs of a tab that was closed."""
        self.open.discard(self)
        self._following.end()
        self._files.close()
        self._runs.close()

    @classmethod
    def leave_all(cls) -> None:
        """Close all sessions because the server ends."""
        for each in tuple(cls.open):
            each.leave()


def _units_told(system: UnitSystem) -> str:
    """Return the units that scripts show in place of those of documents, each with its size in the latter."""
    units = {} if system is UnitSystem.METRIC else inch_units()
    return " ".join(f"{unit}|{shown.name}|{float(shown.size)!r}" for unit, shown in units.items())


def _left_titles(words: PageWords) -> dict[str, str]:
    return {"inputs": words["Inputs"], "text": words["Text"], "limits": words["Limits"], "flanks": words["Flanks"]}


def _right_titles(words: PageWords) -> dict[str, str]:
    return {
        "data": words["Data"],
        "tasks": words["Tasks"],
        "runs": words["Runs"],
        "compare": words["Compare"],
        "drawing": words["Drawing"],
        "table": words["Table"],
    }


def _region(place: str, label: str) -> ui.element:
    """A part of the page that is found by its name."""
    return ui.element("section").classes(place).props(f'aria-label="{label}"')
