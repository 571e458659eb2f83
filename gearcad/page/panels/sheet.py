"""The data sheet."""

from __future__ import annotations

from nicegui import ui

from gearcad.designs.design import Design
from gearcad.page.panels import Panel

__all__ = ["SheetPanel"]


class SheetPanel(Panel[str]):
    """Every derived quantity, as `gearcad data` prints it."""

    def __init__(self) -> None:
        self._sheet = ui.element("pre").classes("sheet")

    def find(self, design: Design) -> str:
        from gearcad.cli.datasheet import plain_datasheet

        return plain_datasheet(design, 80)

    def show(self, found: str) -> None:
        self._sheet.props["innerHTML"] = found
        self._sheet.update()
