"""The gears as solid bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from nicegui import ui
from nicegui.element import Element

__all__ = ["THREE", "BodiesView"]

THREE = ui.scene
"""Whose package of three.js the script of this element imports."""


class BodiesView(Element, component="gear_bodies.js", esm={"gear-surfaces": "surfaces"}):
    """Bodies, whose surfaces are sent once as long as they are seen; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["words"] = label, words

    def show(
        self, number: int, bodies: Sequence[dict[str, Any]], surfaces: Mapping[str, bytes], error: float, why_not: str
    ) -> None:
        """Show bodies, or say why there are none; `number` is higher each time, `error` that of the surfaces (mm).

        `surfaces` are those that the bodies before have not had. They are sent as they are, and not as text of a script.
        """
        sent = {"number": number, "bodies": bodies, "surfaces": surfaces, "error": error, "whyNot": why_not}
        self.client.outbox.enqueue_message("gear_bodies", sent, self.client.id)
