"""The inputs of a spec, as fields that the browser makes of what the schema says, and as its text."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments

__all__ = ["EDITOR", "InputsView", "TextView"]

EDITOR = ui.codemirror
"""The element whose package of CodeMirror the script of the text imports."""


class _Typed(Element):
    """An element whose changes come with numbers: each is taken once and in order, and answered with the last number."""

    def __init__(self, typed: Callable[[dict[str, Any]], None], step: Callable[[bool], None]) -> None:
        super().__init__()
        self._heard = 0
        self.on("typed", lambda event: self._hear(event, typed))
        self.on("step", lambda event: self._hear(event, lambda change: step(bool(change["forth"]))))

    def _hear(self, event: GenericEventArguments, take: Callable[[dict[str, Any]], None]) -> None:
        """Take the change if its number is the next one: the browser sends again what has no answer."""
        if int(event.args["number"]) == self._heard + 1:
            self._heard += 1
            take(event.args)
        self.run_method("hear", self._heard)

    def show(self, state: dict[str, Any]) -> None:
        """Show a state in which all changes are that have come."""
        self.run_method("show", state | {"heard": self._heard})


class TextView(_Typed, component="spec_text.js", esm={"gear-changes": "changes"}):
    """The text of a spec: calls `written(text, step)` with the text after typing, and `step(forth)` for keys that undo or redo.

    `show` takes a `text`, and the number of the `line` that is wrong, if there is one.
    """

    def __init__(self, written: Callable[[str, int], None], step: Callable[[bool], None], label: str) -> None:
        super().__init__(lambda change: written(str(change["text"]), int(change["step"])), step)
        self._props["label"] = label


class InputsView(_Typed, component="spec_inputs.js", esm={"gear-changes": "changes"}):
    """Fields of a spec: calls `changed(key, text, step)` with what is typed, and `step(forth)` for keys that undo or redo.

    `words` are those of the fields, in the language of the page. `show` takes what is `given` and `used` under which key, which
    keys have `changed`, and the `fault`, if there is one; with `reveal` what has changed comes into sight, and drafts go.
    """

    def __init__(self, changed: Callable[[str, str, int], None], step: Callable[[bool], None], words: dict[str, str]) -> None:
        super().__init__(lambda change: changed(str(change["key"]), str(change["text"]), int(change["step"])), step)
        self._props["words"], self._props["tables"] = words, []

    def have(self, tables: list[dict[str, Any]]) -> None:
        """Make fields of what `gearcad.page.fields` says of the tables of a kind of design."""
        self._props["tables"] = tables
        self.update()
