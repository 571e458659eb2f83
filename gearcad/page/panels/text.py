"""The text of the spec, as its file has it: what is typed there is a change, and every change is seen there."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from gearcad.page.components.inputs import TextView
from gearcad.page.words import Words
from gearcad.page.workbench import Workbench

__all__ = ["TextPanel"]


class TextPanel:
    """Follows the workbench itself; calls `written(text, step)` after typing, and `step(forth)` for keys that undo or redo."""

    def __init__(self, written: Callable[[str, int], None], step: Callable[[bool], None], words: Words) -> None:
        self._written, self._newline = written, "\n"
        self._view = TextView(self._typed, step, words["text of the spec"])
        self._fault = ui.label().classes("spec-fault").props("role=alert lang=en")

    def _typed(self, text: str, step: int) -> None:
        self._written(text.replace("\n", self._newline), step)

    def follow(self, bench: Workbench) -> None:
        """Show the text, and what is wrong with it where that is."""
        self._newline = "\r\n" if "\r\n" in bench.text else "\n"
        fault = bench.fault
        self._view.show({"text": bench.text.replace("\r\n", "\n"), "line": fault.at if fault else None})
        self._fault.set_text(fault.line if fault else "")
