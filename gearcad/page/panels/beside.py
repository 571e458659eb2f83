"""Keeping a design beside the one that is edited, letting both change places, and letting it go."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from nicegui import ui

from gearcad.errors import GearcadError
from gearcad.page.beside_design import BesideDesign
from gearcad.page.words import Words

__all__ = ["BesidePanel"]


class BesidePanel:
    """Calls `changed` when another design is kept, or none."""

    def __init__(self, beside: BesideDesign, words: Words, changed: Callable[[], None]) -> None:
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
        """What can be kept: the present design, and the specs in the folder; an open menu stays unless these are others."""
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
            self._show(str(error))
            return
        self._show("")
        self._changed()

    def _show(self, line: str) -> None:
        kept = self._beside.kept
        self._shown.set_visibility(kept is not None)
        self._name.set_text("" if kept is None else f"{self._words['kept']}: {kept.design.name}")
        self._line.set_text(line)
