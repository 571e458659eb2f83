"""The inputs of a spec, as fields that the browser makes of what the schema says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui.element import Element

__all__ = ["InputsView"]


class InputsView(Element, component="spec_inputs.js"):
    """Calls `changed(key, text)` with what is typed, and `step(forth)` for keys that undo or redo.

    `words` are its own, in the language of the page.
    """

    def __init__(self, changed: Callable[[str, str], None], step: Callable[[bool], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"], self._props["tables"] = words, []
        self.on("typed", lambda event: changed(str(event.args["key"]), str(event.args["text"])))
        self.on("step", lambda event: step(bool(event.args["forth"])))

    def have(self, tables: list[dict[str, Any]]) -> None:
        """Make fields of what `gearcad.page.fields` says of the tables of a kind of design."""
        self._props["tables"] = tables
        self.update()

    def show(self, state: dict[str, Any]) -> None:
        """What is `given` and `used` under which key, which keys have `changed`, and the `fault`, if there is one.

        With `reveal` what has changed comes into sight, and what was being typed goes.
        """
        self.run_method("show", state)
