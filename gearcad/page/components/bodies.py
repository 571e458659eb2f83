"""The gears as solid bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from nicegui import ui
from nicegui.element import Element

__all__ = ["THREE", "BodiesView"]

THREE = ui.scene
"""Whose package of three.js the script of this element imports."""


class BodiesView(Element, component="gear_bodies.js", esm={"gear-surfaces": "surfaces"}):
    """Bodies whose surfaces come from an address of the page's own; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["words"] = label, words

    def show(self, number: int, address: str, bodies: Sequence[dict[str, Any]], error: float, why_not: str) -> None:
        """Show bodies, or say why there are none; `number` is higher each time, `error` that of the surfaces (mm)."""
        self.run_method("show", number, address, bodies, error, why_not)
