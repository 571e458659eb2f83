"""The gears as solid bodies."""

from __future__ import annotations

from typing import Any

from nicegui import ui
from nicegui.element import Element

__all__ = ["THREE", "BodiesView"]

THREE = ui.scene
"""Whose package of three.js the script of this element imports."""


class BodiesView(Element, component="gear_bodies.js"):
    """A scene that comes as GLB from an address of the page's own; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str) -> None:
        super().__init__()
        self._props["label"] = label

    def show(self, url: str, axles: list[dict[str, Any]], why_not: str) -> None:
        """Show what is at an address, or without one say why nothing is; `axles` are nodes that turn, each with its ratio."""
        self.run_method("show", url, axles, why_not)

    def pose(self, turn: float) -> None:
        self.run_method("pose", turn)
