"""The roll angle: bodies and section follow it in the browser."""

from __future__ import annotations

from gearcad.designs.design import Design
from gearcad.page.components.roll import RollView
from gearcad.page.panels import Panel
from gearcad.page.panels.section_content import section_of
from gearcad.page.words import Words

__all__ = ["RollPanel"]


class RollPanel(Panel[float]):
    """By how much the first gear is turned."""

    def __init__(self, words: Words) -> None:
        self._view = RollView(_own(words))
        self._shown = 0.0

    def find(self, design: Design) -> float:
        """The angular pitch of the first gear (rad); 0 where nothing turns."""
        found = section_of(design)
        return 0.0 if found is None else float(found["pitch"])

    def show(self, found: float) -> None:
        if found != self._shown:
            self._shown = found
            self._view.show(found)


def _own(words: Words) -> dict[str, str]:
    """What the script of the view says."""
    return {
        "roll": words["roll angle"],
        "turn": words["let the gears turn (space)"],
        "stop": words["stop the gears (space)"],
        "speed": words["base pitches a second"],
    }
