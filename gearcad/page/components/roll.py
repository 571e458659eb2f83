"""How far the gears are turned: by hand, or by themselves, in the browser alone."""

from __future__ import annotations

from nicegui.element import Element

__all__ = ["RollView"]


class RollView(Element, component="gear_roll.js"):
    """A slider of the roll angle over some pitches, and a button that lets the gears turn.

    Views on the window hear the event `gear-turn`, whose `detail.turn` is how far the first gear is turned (rad).
    """

    def __init__(self, words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words

    def show(self, pitch: float) -> None:
        """Roll by pitches of so many radians of the first gear; by none nothing turns."""
        self.run_method("show", pitch)
