"""Following: panels show what is found for a design that changes, each change beginning anew with the quickest of them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from nicegui import app, background_tasks, run, ui

from gearcad.designs.design import Design
from gearcad.page.aside import found_aside
from gearcad.page.panels import Panel

__all__ = ["Following"]

_REST = 0.3
"""Seconds without a change after which what takes long is begun."""

One = TypeVar("One", bound=Panel[Any])


class Following:
    """What was found for a design that is not the last any more is not shown. A panel that fails says so, the others go on."""

    def __init__(self, design: Callable[[], Design], failed: str) -> None:
        self._design, self._failed = design, failed
        self._faults: dict[Panel[Any], ui.label] = {}
        self._seen: dict[Panel[Any], Callable[[], bool]] = {}
        self._order: Sequence[Panel[Any]] = ()
        self._change = 0
        self._task: asyncio.Task[None] | None = None
        self._later: asyncio.Task[None] | None = None

    def with_line(self, panel: One, seen: Callable[[], bool] = lambda: True) -> One:
        """A panel, which follows while it is seen, and after it the place of the line that tells where it fails."""
        self._faults[panel] = ui.label().classes("panel-fault").props("role=alert")
        self._seen[panel] = seen
        return panel

    def begin(self, order: Sequence[Panel[Any]]) -> None:
        """Let these follow, the quickest first."""
        self._order = order

    def follow(self) -> None:
        """The design is another one."""
        self._change += 1
        if self._task is None or self._task.done():
            self._task = background_tasks.create(self._find())

    def look(self, panel: Panel[Any]) -> None:
        """A panel is seen again."""
        background_tasks.create(self._show(panel, self._design(), self._change))

    async def compare(self, kept: Callable[[], Design | None]) -> None:
        """Let panels that compare have what they show of the kept design."""
        design = kept()
        for panel in self._order:
            if panel.compares:
                found = None if design is None else await self._found(panel, design)
                if design is not kept():
                    return
                panel.keep(found[0] if found else None)
        self.follow()

    def end(self) -> None:
        """Nobody looks any more."""
        for task in (self._task, self._later):
            if task is not None:
                task.cancel()

    async def _find(self) -> None:
        """Until all panels show the last design."""
        shown = 0
        while shown != self._change:
            shown, design = self._change, self._design()
            for panel in filter(self._is_seen, self._order):
                if panel.aside(design) is not None:
                    panel.wait()
                    continue
                if not await self._show(panel, design, shown):
                    break
        if self._later is None or self._later.done():
            self._later = background_tasks.create(self._find_later())

    async def _find_later(self) -> None:
        """What takes long, of the last design: when the hand rests, and without keeping anything else waiting."""
        shown = 0
        while shown != self._change:
            shown, design = self._change, self._design()
            await asyncio.sleep(_REST)
            for panel in filter(self._is_seen, self._order):
                if shown == self._change and panel.aside(design) is not None:
                    await self._show(panel, design, shown)

    def _is_seen(self, panel: Panel[Any]) -> bool:
        return self._seen[panel]()

    async def _show(self, panel: Panel[Any], design: Design, change: int) -> bool:
        """Whether the design was still the last one when this was found."""
        found = await self._found(panel, design)
        if change == self._change and found is not None:
            panel.show(found[0])
        return change == self._change

    async def _found(self, panel: Panel[Any], design: Design) -> tuple[Any] | None:
        """What a panel finds, or None where it fails: what gearcad raises, panels tell themselves; this is a fault of ours."""
        line, aside = self._faults.get(panel), panel.aside(design)
        try:
            found = (await (run.io_bound(panel.find, design) if aside is None else found_aside(aside, design)),)
            if app.is_stopping:  # then nothing was asked of the panel
                return None
        except Exception as error:  # whatever it is: the other panels are as good as before
            if line is not None and not app.is_stopping:
                line.set_text(f"{self._failed} ({type(error).__name__}: {error})"[:300])
            return None
        if line is not None:
            line.set_text("")
        return found
