"""Panel of what the hand does in the section: handles of inputs, measures, and the tool that generates the teeth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from gearcad.core.errors import GearcadError
from gearcad.core.records import JsonObject
from gearcad.designs.design import Design
from gearcad.page.components.elements import SectionToolsView
from gearcad.page.panels import Panel
from gearcad.page.panels.section_handles import SectionGear, drawn_text, handles_of, section_gears
from gearcad.page.panels.sheet_content import called
from gearcad.page.section_measures import Asked, SectionMode, asked_of, gaps_of, pins_at, thickness_at, tool_at
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench

_FIRST_STEP = 1_000_000
"""Steps of drags are numbered from here down, apart from those of fields and of other diagrams."""

_MOST_AT_ONCE = 2
"""Largest number of gears whose handles are drawn at the same time; of more, those of the chosen gear are."""


class SectionToolsPanel(Panel[JsonObject]):
    """What is drawn over the section in the chosen mode; calls `change` with what a handle writes, one step for each drag."""

    def __init__(self, bench: Workbench, change: Callable[[Mapping[str, str], int], None], words: PageWords) -> None:
        self._bench, self._change, self._words = bench, change, words
        self._mode, self._asked = SectionMode.LOOK, Asked()
        self.look: Callable[[], None] = lambda: None
        self._view = SectionToolsView(self._choose, self._drawn, _own(words))

    def find(self, design: Design) -> JsonObject:
        mode, asked, tables = self._mode, self._asked, self._bench.tables
        gears = section_gears(design, tables)
        names = [called(self._words, each.name) for each in gears]
        found: JsonObject = {"mode": mode.value, "gears": names, "handles": [], "lines": []}
        if not gears:
            return found
        number = min(asked.gear, len(names) - 1)
        gear = gears[number].gear
        found |= {"gear": number, "body": gears[number].body}
        if mode is SectionMode.DRAW:
            only = number if len(gears) > _MOST_AT_ONCE else None
            handles = handles_of(design, tables, only)
            found["handles"] = [handle | {"words": self._called(handle["key"], gears)} for handle in handles]
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

    def _called(self, key: str, gears: Sequence[SectionGear]) -> str:
        """Return the words of a handle: the gear and the quantity."""
        table, _, name = key.rpartition(".")
        said = {
            "tip_diameter": self._words["tip diameter"],
            "profile_shift": self._words["profile shift coefficient"],
            "centre_distance": self._words["centre distance"],
            "mounting_distance": self._words["mounting distance to reference line"],
            "tip_alteration": self._words["tip alteration coefficient"],
        }[name]
        owner = next((each.name for each in gears if each.table == table), "rack" if table == "rack" else "")
        return f"{called(self._words, owner)}: {said}" if owner else said

    def _choose(self, told: Mapping[str, Any]) -> None:
        """Take another mode, or what is asked for in it."""
        modes = {each.value: each for each in SectionMode}
        self._mode = modes.get(str(told.get("mode")), SectionMode.LOOK)
        self._asked = asked_of(told)
        self.look()

    def _drawn_text(self, told: Mapping[str, Any]) -> dict[str, str]:
        """Return what a handle says as the text of its key."""
        return drawn_text(self._bench.design, self._bench.tables, str(told.get("key")), told.get("value"))

    def _drawn(self, told: Mapping[str, Any]) -> None:
        """Write what a handle says."""
        step, texts = told.get("step"), self._drawn_text(told)
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
