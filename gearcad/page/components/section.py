"""The transverse section of the mesh."""

from __future__ import annotations

from typing import Any

from nicegui.element import Element

__all__ = ["SectionView"]


class SectionView(Element, component="gear_section.js"):
    """Draws what `gearcad.page.panels.section` finds; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str) -> None:
        super().__init__()
        self._props["label"] = label

    def show(self, content: dict[str, Any] | None) -> None:
        self.run_method("show", content)

    def keep(self, content: dict[str, Any] | None) -> None:
        """The same of a kept design, whose outlines are drawn as thin lines."""
        self.run_method("keep", content)

    def pose(self, turn: float) -> None:
        self.run_method("pose", turn)
