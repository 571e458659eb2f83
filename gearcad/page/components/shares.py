"""Load shares of planets as bars."""

from __future__ import annotations

from typing import Any

from nicegui.element import Element

__all__ = ["SharesView"]


class SharesView(Element, component="gear_shares.js"):
    """Shows what `gearcad.page.panels.shares` finds, and nothing where that is nothing."""

    def __init__(self, words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words

    def show(self, content: dict[str, Any] | None) -> None:
        self.run_method("show", content)

    def wait(self) -> None:
        """Tell that what is shown is of an older design."""
        self.run_method("wait")
