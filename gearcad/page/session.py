"""Session: one tab of a browser with its workbench and the panels that follow it."""

from __future__ import annotations

import asyncio
import secrets
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypeVar

from nicegui import app, background_tasks, run, ui

from gearcad.core.units import UnitSystem, inch_units
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.page.components.elements import BarView
from gearcad.page.folder import DESIGN, TAB
from gearcad.page.panels import Panel
from gearcad.page.panels.compare import ComparePanel
from gearcad.page.panels.drawing import DrawingPanel
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
from gearcad.page.run_process import result_in_process
from gearcad.page.runs import Runs
from gearcad.page.words import PageLanguage, PageWords, language_of
from gearcad.page.workbench import TEXT, BesideDesign, DesignStatus, KeptDesign, linked_bench

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


_RECENT: dict[str, BesideDesign] = {}
"""Workbenches of the latest pages by the keys of their sessions, for pages that are loaded again."""

_MOST_RECENT = 64


def remember(key: str, beside: BesideDesign) -> None:
    """Keep the workbench of a session for a page that is loaded again; the eldest of too many goes."""
    _RECENT[key] = beside
    while len(_RECENT) > _MOST_RECENT:
        del _RECENT[next(iter(_RECENT))]


def resumed(key: str, linked: BesideDesign | None) -> BesideDesign | None:
    """Return a copy of the workbench that a session had, with its steps, unless a link has another text; otherwise None."""
    former = _RECENT.get(key)
    if former is None or (linked is not None and former.bench.text != linked.bench.text):
        return None
    return former.copied()


def _drop(key: str) -> None:
    if (left := take_over(key)) is not None:
        left.runs.close()


class Tabs:
    """A row of titles by their keys; what is put `under` a key is seen while its title is chosen, at first under the first.

    When one is `chosen`, what is to be done `on` its key is.
    """

    def __init__(self, titles: Mapping[str, str]) -> None:
        self.chosen = first = next(iter(titles))
        self._on: dict[str, Callable[[], None]] = {}
        with (
            ui.tabs(on_change=lambda event: self._choose(event.value)).props("dense no-caps align=left").classes("tabs") as row
        ):
            for key, title in titles.items():
                ui.tab(key, title)
        self._panes = {key: ui.element("div").classes("pane") for key in titles}
        self._row = row
        row.set_value(first)

    def choose(self, key: str) -> None:
        """Show the contents under a key."""
        self._row.set_value(key)

    def on(self, key: str, do: Callable[[], None]) -> None:
        """Call a function each time that the contents under a key are shown again."""
        self._on[key] = do

    @contextmanager
    def under(self, key: str) -> Iterator[None]:
        """Put the elements made in this context into the pane of a key."""
        with self._panes[key]:
            yield

    def _choose(self, chosen: str) -> None:
        self.chosen = chosen
        for key, pane in self._panes.items():
            pane.set_visibility(key == chosen)
        if chosen in self._on:
            self._on[chosen]()


_REST = 0.3
"""Seconds without a change after which what takes long is begun."""

One = TypeVar("One", bound=Panel[Any])


class Following:
    """Updates the panels for the last design and drops results for older ones. A panel that fails shows it; others go on.

    `status` tells what the design is to the present inputs. What is of other inputs is marked, by its panel and in bands;
    of another spec nothing is shown.
    """

    def __init__(self, design: Callable[[], Design], status: Callable[[], DesignStatus], words: PageWords) -> None:
        self._design, self._failed = design, words["failed, and the page goes on"]
        self._words, self._status = words, status
        self._bands: list[ui.label] = []
        self._failing: set[Panel[Any]] = set()
        self._faults: dict[Panel[Any], ui.label] = {}
        self._seen: dict[Panel[Any], Callable[[], bool]] = {}
        self._order: Sequence[Panel[Any]] = ()
        self._change = 0
        self._task: asyncio.Task[None] | None = None
        self._later: asyncio.Task[None] | None = None
        self._kept: dict[tuple[int, int], tuple[Design, tuple[Any]]] = {}

    def with_line(self, panel: One, seen: Callable[[], bool] = lambda: True) -> One:
        """A panel, which follows while it is seen, and after it the place of the line that tells where it fails."""
        self._faults[panel] = ui.label().classes("panel-fault").props("role=alert")
        self._seen[panel] = seen
        return panel

    def band(self) -> None:
        """Make a band that says of which inputs the content beside it is, unless it is of the present ones."""
        self._bands.append(ui.label().classes("band").props("role=status"))
        self._bands[-1].set_visibility(False)

    def begin(self, order: Sequence[Panel[Any]]) -> None:
        """Let these follow, the quickest first."""
        self._order = order

    def follow(self) -> None:
        """Bring the panels up to date because the design has changed."""
        self._change += 1
        status = self._status()
        self._mark(status)
        if status is DesignStatus.OTHER:
            for panel in self._order:
                panel.clear()
        elif self._task is None or self._task.done():
            self._task = background_tasks.create(self._find())

    def _mark(self, status: DesignStatus) -> None:
        """Mark what is of other inputs than the present ones."""
        last = self._words["of the last good design"]
        stale = {
            DesignStatus.PRESENT: "",
            DesignStatus.LAST_GOOD: last,
            DesignStatus.OTHER: self._words["these inputs make no gears"],
        }
        for panel in self._order:
            panel.mark(stale[status] or (last if panel in self._failing else ""))
        for band in self._bands:
            band.set_text(stale[status])
            band.set_visibility(status is not DesignStatus.PRESENT)

    def look(self, panel: Panel[Any]) -> None:
        """Bring the panels up to date because one of them is seen again."""
        if self._status() is not DesignStatus.OTHER:
            background_tasks.create(self._show(panel, self._design(), self._change))

    async def compare(self, kept: Callable[[], tuple[KeptDesign, ...]]) -> None:
        """Let panels show their figures of the last kept design beside the others, and some panels those of all."""
        designs = kept()
        for panel in self._order:
            if not (panel.compares or panel.keeps_all):
                continue
            wanted = designs if panel.keeps_all else designs[-1:]
            found = [(each.design.name, await self._found_once(panel, each.design)) for each in wanted]
            if designs != kept():
                return
            if panel.keeps_all:
                panel.keep_all([(name, each[0]) for name, each in found if each is not None])
            else:
                panel.keep(found[0][1][0] if found and found[0][1] else None)
        self._kept = {at: each for at, each in self._kept.items() if any(each[0] is one.design for one in designs)}
        self.follow()

    async def _found_once(self, panel: Panel[Any], design: Design) -> tuple[Any] | None:
        """Return the content of a panel for a kept design, which is found once while the design is kept."""
        place = (id(panel), id(design))
        if place not in self._kept and (found := await self._found(panel, design)) is not None:
            self._kept[place] = (design, found)
        return self._kept[place][1] if place in self._kept else None

    def end(self) -> None:
        """Stop following because the tab was closed."""
        for task in (self._task, self._later):
            if task is not None:
                task.cancel()

    async def _find(self) -> None:
        """Update the panels that are seen until all show the last design. Slow panels only show that they wait."""
        shown = 0
        while shown != self._change:
            shown, design = self._change, self._design()
            if self._status() is DesignStatus.OTHER:
                continue
            for panel in filter(self._is_seen, self._order):
                if panel.aside(design) is not None:
                    panel.wait()
                    continue
                if not await self._show(panel, design, shown):
                    break
        if self._later is None or self._later.done():
            self._later = background_tasks.create(self._find_later())

    async def _find_later(self) -> None:
        """Update the slow panels for the last design after a pause in typing, without delaying the others."""
        shown = 0
        while shown != self._change:
            shown, design = self._change, self._design()
            await asyncio.sleep(_REST)
            if self._status() is DesignStatus.OTHER:
                continue
            for panel in filter(self._is_seen, self._order):
                if shown == self._change and panel.aside(design) is not None:
                    await self._show(panel, design, shown)

    def _is_seen(self, panel: Panel[Any]) -> bool:
        return self._seen[panel]()

    async def _show(self, panel: Panel[Any], design: Design, change: int) -> bool:
        """Return whether the design was still the last one when this result was found."""
        found = await self._found(panel, design)
        if change == self._change and found is not None:
            panel.show(found[0])
        return change == self._change

    async def _found(self, panel: Panel[Any], design: Design) -> tuple[Any] | None:
        """Return the content of a panel in a tuple, or None if it fails.

        Panels show gearcad's own errors themselves; any other error is a fault of the program.
        """
        line, aside = self._faults.get(panel), panel.aside(design)
        try:
            found = (await (run.io_bound(panel.find, design) if aside is None else result_in_process(aside, design)),)
            if app.is_stopping:  # then nothing was asked of the panel
                return None
        except Exception as error:  # whatever it is: the other panels are as good as before
            if line is not None and not app.is_stopping:
                line.set_text(f"{self._failed} ({type(error).__name__}: {self._words.message(str(error))})"[:300])
                self._failing.add(panel)
                self._mark(self._status())
            return None
        if line is not None:
            line.set_text("")
        if panel in self._failing:
            self._failing.discard(panel)
            self._mark(self._status())
        return found


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
                left = self._left = Tabs(
                    {"inputs": words["Inputs"], "text": words["Text"], "limits": words["Limits"], "flanks": words["Flanks"]}
                )
                with left.under("inputs"):
                    self._inputs = InputsPanel(bench, self.typed, self.hold, self.step, words)
                with left.under("text"):
                    self._text = TextPanel(self.written, self.step, words)
                left.on("text", lambda: self._text.follow(bench))
                if bench.design.kind is DesignKind.TRAIN:
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
                        DrawingPanel(words, lambda: self._files.make("drawing-pdf")), lambda: right.chosen == "drawing"
                    )
                    following.band()
                    right.on("drawing", lambda: following.look(drawing))
                with right.under("table"):
                    self._table = TablePanel(words, bench.folder, self.opened)
        following.begin((section, tools, roll, bodies, sheet, strength, flanks, limits, shares, compare, drawing))
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
        self._files = FilesPanel(self.key, self.bench, words, self.opened, self.tabled, self.follow)
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
        """Take another spec that the user opened."""
        self.bench.open(text, name)
        self.follow(reveal=True)

    def taken(self, text: str, name: str) -> None:
        """Take a design that was found, as one step. It has no file yet. Work that would be lost is asked about first."""
        bench = self.bench
        if bench.is_saved or bench.text == self._taken:
            self._take(text, name)
        else:
            ask_to_replace(self.words, lambda: self._take(text, name))

    def _take(self, text: str, name: str) -> None:
        self._taken = text
        self.bench.open(text, name, saved="")
        self.follow(reveal=True)

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
        self._following.follow()

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
