"""The inputs of a spec, as fields that the browser makes of what the schema says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui.element import Element
from nicegui.events import GenericEventArguments

__all__ = ["InputsView"]


class InputsView(Element, component="spec_inputs.js"):
    """Fields of a spec: calls `changed(key, text, step)` with what is typed, and `step(forth)` for keys that undo or redo.

    Changes come with numbers, and each is taken once and in order. `words` are those of the fields, in the language of the page.
    """

    def __init__(self, changed: Callable[[str, str, int], None], step: Callable[[bool], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"], self._props["tables"] = words, []
        self._heard = 0

        def typed(of: dict[str, Any]) -> None:
            changed(str(of["key"]), str(of["text"]), int(of["step"]))

        self.on("typed", lambda event: self._hear(event, typed))
        self.on("step", lambda event: self._hear(event, lambda of: step(bool(of["forth"]))))

    def _hear(self, event: GenericEventArguments, take: Callable[[dict[str, Any]], None]) -> None:
        """Take the change if its number is the next one; the browser sends those again that were lost."""
        if int(event.args["number"]) == self._heard + 1:
            self._heard += 1
            take(event.args)
        else:
            self.run_method("hear", self._heard)

    def have(self, tables: list[dict[str, Any]]) -> None:
        """Make fields of what `gearcad.page.fields` says of the tables of a kind of design."""
        self._props["tables"] = tables
        self.update()

    def show(self, state: dict[str, Any]) -> None:
        """What is `given` and `used` under which key, which keys have `changed`, and the `fault`, if there is one.

        With `reveal` what has changed comes into sight, and what was being typed goes.
        """
        self.run_method("show", state | {"heard": self._heard})
