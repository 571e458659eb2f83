"""Panels behind each other in one place, of which one is seen."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from nicegui import ui

__all__ = ["Tabs"]


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
        """Have what is under a key seen."""
        self._row.set_value(key)

    def on(self, key: str, do: Callable[[], None]) -> None:
        """Have something done each time that what is under a key is seen again."""
        self._on[key] = do

    @contextmanager
    def under(self, key: str) -> Iterator[None]:
        """Where elements of a key are put."""
        with self._panes[key]:
            yield

    def _choose(self, chosen: str) -> None:
        self.chosen = chosen
        for key, pane in self._panes.items():
            pane.set_visibility(key == chosen)
        if chosen in self._on:
            self._on[chosen]()
