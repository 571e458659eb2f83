"""What is chosen of a table of results, and its brushed rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from nicegui.element import Element

__all__ = ["TableView"]


class TableView(Element, component="gear_table.js"):
    """Calls `choose(columns by axis)` and `opened(row)`; `words` are the page's own."""

    def __init__(
        self, choose: Callable[[Mapping[str, Any]], None], opened: Callable[[int], None], words: dict[str, str]
    ) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("choose", lambda event: choose(event.args))
        self.on("open", lambda event: opened(int(event.args.get("number", 0))))

    def show(self, **state: Any) -> None:
        """The table's `name`, what is `told` of it, `columns`, those `chosen`; `heads` and `rows` of the list; a `line`."""
        self.run_method("show", state)
