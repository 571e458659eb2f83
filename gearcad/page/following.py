"""Panels that follow the design, each found anew after a change, and the tabs under which they are seen."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from nicegui import app, background_tasks, run, ui

from gearcad.designs.design import Design
from gearcad.page.panels import Panel
from gearcad.page.run_process import result_in_process
from gearcad.page.words import PageWords
from gearcad.page.workbench import DesignStatus, KeptDesign


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
            self._titles = {key: ui.tab(key, title) for key, title in titles.items()}
        self._panes = {key: ui.element("div").classes("pane") for key in titles}
        self._row = row
        row.set_value(first)

    def choose(self, key: str) -> None:
        """Show the contents under a key."""
        self._row.set_value(key)

    def offer(self, offered: Mapping[str, bool]) -> None:
        """Show or hide the titles of keys. If the chosen one is hidden, the first of all is chosen."""
        for key, is_offered in offered.items():
            self._titles[key].set_visibility(is_offered)
        if not offered.get(self.chosen, True):
            self.choose(next(iter(self._titles)))

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
