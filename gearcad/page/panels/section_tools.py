"""Panel of what the hand does in the section: handles of inputs, measures, and the tool that generates the teeth."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from gearcad.core.errors import GearcadError
from gearcad.core.records import JsonObject
from gearcad.designs.design import Design
from gearcad.page.components.elements import SectionToolsView
from gearcad.page.handles import (
    Asked,
    SectionMode,
    asked_of,
    drawn_text,
    gaps_of,
    gears_of,
    handles_of,
    pins_at,
    thickness_at,
    tool_at,
)
from gearcad.page.panels import Panel
from gearcad.page.panels.sheet_content import called
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench

_FIRST_STEP = 1_000_000
"""Steps of drags are numbered from here down, apart from those of fields and of other diagrams."""


class SectionToolsPanel(Panel[JsonObject]):
    """What is drawn over the section in the chosen mode; calls `change` with what a handle writes, one step for each drag."""

    def __init__(self, bench: Workbench, change: Callable[[Mapping[str, str], int], None], words: PageWords) -> None:
        self._bench, self._change, self._words = bench, change, words
        self._mode, self._asked = SectionMode.LOOK, Asked()
        self.look: Callable[[], None] = lambda: None
        self._view = SectionToolsView(self._choose, self._drawn, _own(words))

    def find(self, design: Design) -> JsonObject:
        mode, asked, gears = self._mode, self._asked, gears_of(design)
        names = [called(self._words, name) for name in gears]
        found: JsonObject = {"mode": mode.value, "gears": names, "handles": [], "lines": []}
        if not gears:
            return found
        body = min(asked.body, len(names) - 1)
        gear = [*gears.values()][body]
        found["body"] = body
        if mode is SectionMode.DRAW:
            found["handles"] = [handle | {"words": self._called(handle["key"])} for handle in handles_of(design)]
        elif mode is SectionMode.THICKNESS:
            found["thickness"] = thickness_at(gear, asked.size)
        elif mode is SectionMode.PINS:
            pins = pins_at(gear, asked.size)
            found["pins"] = pins | {"why_not": self._words.message(pins["why_not"])}
        elif mode is SectionMode.GAP:
            found["gap"] = gaps_of(design)
        elif mode is SectionMode.TOOL:
            try:
                found["tool"] = tool_at(gear)
            except (GearcadError, ArithmeticError, ValueError) as error:
                found["why_not"] = self._words.message(str(error))
        return found

    def show(self, found: JsonObject) -> None:
        self._view.show(found)

    def clear(self) -> None:
        self._view.show({"mode": self._mode.value, "gears": [], "handles": []})

    def _called(self, key: str) -> str:
        """The words of a handle: the gear and the quantity."""
        table, _, name = key.partition(".")
        said = {
            "tip_diameter": self._words["tip diameter"],
            "profile_shift": self._words["profile shift coefficient"],
            "centre_distance": self._words["centre distance"],
        }[name]
        return said if table == "pair" else f"{called(self._words, table)}: {said}"

    def _choose(self, told: Mapping[str, Any]) -> None:
        """Take another mode, or what is asked for in it."""
        modes = {each.value: each for each in SectionMode}
        self._mode = modes.get(str(told.get("mode")), SectionMode.LOOK)
        self._asked = asked_of(told)
        self.look()

    def _drawn(self, told: Mapping[str, Any]) -> None:
        """Write what a handle says."""
        step, texts = told.get("step"), drawn_text(self._bench.design, str(told.get("key")), told.get("value"))
        if texts and isinstance(step, int):
            self._change(texts, -_FIRST_STEP - abs(step))


def _own(words: PageWords) -> dict[str, str]:
    """Return the words that the script of the section's tools uses."""
    return {
        "title": words["what the mouse does in the section"],
        "look": words["look around"],
        "draw": words["draw inputs"],
        "thickness": words["measure a tooth"],
        "gap": words["measure the gap"],
        "pins": words["measure over pins"],
        "tool": words["tool at the tooth"],
        "gear": words["gear"],
        "diameter": words["diameter"],
        "pin": words["diameter of the pins"],
        "arc": words["thickness along the circle"],
        "chord": words["as a chord"],
        "over": words["over two pins"],
        "between": words["between two pins"],
        "circumferential": words["circumferential backlash"],
        "line": words["along the line of action"],
        "normal": words["normal backlash"],
        "step": words["position of the tool"],
        "play": words["let the tool roll"],
        "pause": words["stop the tool"],
    }
