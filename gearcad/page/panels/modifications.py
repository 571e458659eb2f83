"""Panel of modifications: profile and lead diagrams with handles, and the transmission error of the plane model at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from gearcad.core.errors import ParameterError
from gearcad.core.records import JsonObject
from gearcad.core.units import UnitSystem
from gearcad.designs.design import Design
from gearcad.designs.pair_designs import PairDesign
from gearcad.page.components.elements import ModificationsView
from gearcad.page.live_modifications import QUICK, DrawnModification, drawn_gears, live_error
from gearcad.page.panels import Panel
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench

_INCH_DIGITS = 2
"""Decimals that values (mm, µm) have more where inches are typed: a whole µin has two."""


class ModificationsPanel(Panel[JsonObject | None]):
    """The flanks of a pair; calls `change` with what is drawn as it would be typed, in one step for each drag.

    While a handle moves, fewer positions are solved; when it rests, as many as in a check. `look` finds these.
    """

    def __init__(self, bench: Workbench, change: Callable[[Mapping[str, str], int], None], words: PageWords) -> None:
        self._bench, self._change, self._words = bench, change, words
        self._moving = False
        self._step: int | None = None
        self._shown: JsonObject | None = None
        self._before: JsonObject | None = None
        self._finer = 0 if words.units is UnitSystem.METRIC else _INCH_DIGITS
        self.look: Callable[[], None] = lambda: None
        self._view = ModificationsView(self._drawn, self._released, _own(words))

    def find(self, design: Design) -> JsonObject | None:
        if not isinstance(design, PairDesign):
            return None
        return {"gears": drawn_gears(design), "error": live_error(design, QUICK if self._moving else None)}

    def show(self, found: JsonObject | None) -> None:
        self._shown = found
        before = None if self._before is None else self._before["error"]
        if found is not None:
            found = found | {"error": found["error"] | {"why_not": self._words.message(found["error"]["why_not"])}}
        self._view.show(found, before)

    def clear(self) -> None:
        self._before = None
        self.show(None)

    def _drawn(self, told: Mapping[str, Any]) -> None:
        """Write what a handle or a field says; the first of a step keeps the curve before it."""
        design, step, values = self._bench.design, told.get("step"), told.get("values")
        if not isinstance(design, PairDesign) or not isinstance(values, Mapping) or not isinstance(step, int):
            return
        try:
            drawn = DrawnModification.of(str(told.get("role")), values, design, finer=self._finer)
        except ParameterError:
            return
        if step != self._step:
            self._step, self._before = step, self._shown
        self._moving = bool(told.get("moving"))
        self._change(drawn.texts, -1 - abs(step))  # steps of fields are above 0

    def _released(self) -> None:
        """Solve as many positions as a check has, because the handle rests."""
        self._moving = False
        self.look()


def _own(words: PageWords) -> dict[str, str]:
    """Return the words that the script of the modifications uses."""
    return {
        "none": words["Only a pair has flanks to modify here."],
        "gear": words["gear"],
        "pinion": words["Pinion"],
        "wheel": words["Wheel"],
        "profile": words["profile diagram"],
        "lead": words["lead diagram"],
        "roll": words["roll length"],
        "diameter": words["diameter"],
        "height": words["along the face width"],
        "root": words["root"],
        "tip": words["tip"],
        "tip_relief": words["tip relief"],
        "tip_relief_length": words["tip relief, length of roll"],
        "root_relief": words["root relief"],
        "root_relief_length": words["root relief, length of roll"],
        "profile_crowning": words["profile crowning"],
        "lead_crowning": words["lead crowning"],
        "helix_angle_modification": words["helix angle modification"],
        "end_relief": words["end relief at both ends"],
        "end_relief_length": words["end relief, length along the axis"],
        "error": words["transmission error"],
        "before": words["before"],
        "after": words["after"],
        "peak": words["transmission error, peak to peak"],
        "angle": words["roll angle"],
        "model": words["Plane model: modifications along the face width are left out; the solid check has them."],
        "hint": words["Drag a handle, or move it with the arrow keys; with Shift ten times as far."],
    }
