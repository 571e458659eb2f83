"""What can be run, how far it is, and what came of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui.element import Element

__all__ = ["RunsView"]


class RunsView(Element, component="gear_runs.js"):
    """Calls `start(kind)` and `cancel(number)`; `words` are the page's own."""

    def __init__(self, start: Callable[[str], None], cancel: Callable[[int], None], words: dict[str, str], limits: str) -> None:
        super().__init__()
        self._props["words"], self._props["limits"] = words, limits
        self.on("start", lambda event: start(str(event.args.get("kind"))))
        self.on("cancel", lambda event: cancel(int(event.args.get("number", -1))))

    def show(self, **state: Any) -> None:
        """`kinds` that can be started, `runs` in their order, `stale` numbers, `tables` of figures, a fault's `line`."""
        self.run_method("show", state)

    def tell(self, number: int, told: dict[str, Any]) -> None:
        """How far a run is."""
        self.run_method("tell", number, told)
