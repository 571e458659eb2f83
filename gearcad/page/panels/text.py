"""The text of the spec, as its file has it: what is typed there is a change, and every change is seen there."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from gearcad.page.words import Words
from gearcad.page.workbench import Workbench

__all__ = ["TextPanel"]


class TextPanel:
    """Follows the workbench itself; calls `written(text)` with what is typed, and `step(forth)` for keys that undo or redo."""

    def __init__(self, written: Callable[[str], None], step: Callable[[bool], None], words: Words) -> None:
        self._written, self._newline = written, "\n"
        keys = {"Mod-z": False, "Mod-y": True, "Mod-Shift-z": True}
        self._editor = ui.codemirror(
            language="TOML",
            theme="githubLight",
            indent="  ",
            on_change=lambda event: self._typed(event.value),
            keymap={key: lambda forth=forth: step(forth) for key, forth in keys.items()},
        ).classes("spec-text")
        self._editor.props["aria-label"] = words["text of the spec"]
        self._fault = ui.label().classes("spec-fault").props("role=alert lang=en")
        self._shown = ""

    def _typed(self, text: str) -> None:
        if text != self._shown:
            self._shown = text
            self._written(text.replace("\n", self._newline))

    def follow(self, bench: Workbench) -> None:
        """Show the text, and what is wrong with it where that is."""
        self._newline = "\r\n" if "\r\n" in bench.text else "\n"
        text = bench.text.replace("\r\n", "\n")
        if text != self._shown:
            self._shown = text
            self._editor.set_value(text)
        fault = bench.fault
        self._fault.set_text(fault.line if fault else "")
        line = fault.at if fault else None
        self._editor.decorations = [] if line is None else [{"kind": "line", "line": line, "class": "wrong-line"}]
