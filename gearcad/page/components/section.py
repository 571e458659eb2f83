"""The transverse section of the mesh."""

from __future__ import annotations

from typing import Any

from nicegui.element import Element

__all__ = ["SectionView"]


class SectionView(Element, component="gear_section.js"):
    """Draws what `gearcad.page.panels.section_content` finds; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["words"] = label, words

    def show(self, content: dict[str, Any] | None, kept: dict[str, Any] | None) -> None:
        self.run_method("show", content, kept)
