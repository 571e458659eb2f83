"""Blocks of quantities as tables: the data sheet, and the rating."""

from __future__ import annotations

from typing import Any

from nicegui.element import Element

__all__ = ["SheetView"]


class SheetView(Element, component="gear_sheet.js"):
    """Shows what `gearcad.page.panels.sheet_content` makes; `words` are the page's own, in its language.

    `store` is the name under which the browser keeps what is folded and what is pinned.
    """

    def __init__(self, label: str, store: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["store"], self._props["words"] = label, store, words

    def show(self, content: dict[str, Any]) -> None:
        self.run_method("show", content)

    def wait(self) -> None:
        """Tell that what is shown is of an older design."""
        self.run_method("wait")
