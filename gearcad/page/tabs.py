"""Panels behind each other in one place, of which one is seen."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from nicegui import ui

__all__ = ["Tabs"]


class Tabs:
    """A row of titles by their keys; what is put `under` a key is seen while its title is chosen, at first under the first."""

    def __init__(self, titles: Mapping[str, str]) -> None:
        first = next(iter(titles))
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

    @contextmanager
    def under(self, key: str) -> Iterator[None]:
        """Where elements of a key are put."""
        with self._panes[key]:
            yield

    def _choose(self, chosen: str) -> None:
        for key, pane in self._panes.items():
            pane.set_visibility(key == chosen)
