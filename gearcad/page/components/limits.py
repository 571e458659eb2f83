"""The shift diagram: lines and regions over two inputs, where the design stands, and sliders."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from nicegui.element import Element

__all__ = ["LimitsView"]


class LimitsView(Element, component="gear_limits.js"):
    """Calls `moved` with new values by the places of their variables. `words` are its own, in the language of the page."""

    def __init__(self, moved: Callable[[Mapping[int, float]], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("moved", lambda event: moved(_numbers(event.args)))

    def show(self, state: dict[str, Any]) -> None:
        """The `variables`, those across and up first; and `limits`, where they are other than before."""
        self.run_method("show", state)


def _numbers(said: Mapping[str, Any]) -> dict[int, float]:
    """What came from the browser, if it is numbers."""
    found = {int(at): float(value) for at, value in said.items() if str(at).isdigit() and isinstance(value, int | float)}
    return {at: value for at, value in found.items() if math.isfinite(value)}
