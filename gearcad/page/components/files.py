"""The menu of files: what is opened, saved, taken along."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from nicegui.element import Element

__all__ = ["FilesView"]


class FilesView(Element, component="gear_files.js"):
    """Calls `asked(what, told)`; files that are opened go to `address`. `words` are the page's own."""

    def __init__(self, asked: Callable[[str, Mapping[str, Any]], None], address: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"], self._props["address"] = words, address
        self.on("asked", lambda event: asked(str(event.args.get("what")), event.args))

    def show(self, **state: Any) -> None:
        """What it has: `specs`, `tables`, `starters`, `makes`; what is `making`, `saved` or `taken`; the `line` of a fault."""
        self.run_method("show", state)

    def close(self) -> None:
        """What was chosen is seen behind it."""
        self.run_method("close")

    def follow(self, link: str) -> None:
        """The link that holds the design goes into the address; "" where none can."""
        self.run_method("follow", link)
