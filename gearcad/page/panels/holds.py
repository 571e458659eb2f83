"""Switches that hold the centre distance, the profile shifts or the ratio, and reasons why inputs follow from others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcad.designs.holds import HeldQuantity, HeldRatio, Mates, held_ratio, hold_of, mates_of, to_hold, unwritten_followers
from gearcad.designs.keys import Cell
from gearcad.designs.reader import kind_of
from gearcad.page.fields import table_title
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench

_DIGITS = 5
"""Significant digits of a ratio."""


class HoldSwitches:
    """The switches of one workbench. What a spec holds stands in it; only a held ratio is kept here."""

    def __init__(self, bench: Workbench, words: PageWords) -> None:
        self._bench, self._words = bench, words
        self._ratio: HeldRatio | None = None
        self._ratio_of = ""

    def followers(self, key: str, text: str) -> dict[str, str]:
        """Return the teeth that follow from what is typed for a key, by their keys; none unless a ratio is held."""
        if self._ratio is None or not _is_whole(text):
            return {}
        return {each: str(count) for each, count in self._ratio.followers(key, int(text)).items()}

    def press(self, what: str) -> dict[str, str]:
        """Hold something, or let go of a held ratio; return the values to write into the spec by their keys, as typed."""
        mates, design = self._mates(), self._bench.shown_design
        hold = next((each for each in HeldQuantity if each.value == what), None)
        if mates is None or design is None or hold is None:
            return {}
        if hold is HeldQuantity.RATIO:
            self._ratio = held_ratio(mates, design, self._bench.tables) if self._ratio is None else None
            self._ratio_of = self._bench.name
            return {}
        return {key: _typed(value) for key, value in to_hold(hold, mates, design, self._bench.tables).items()}

    def state(self) -> dict[str, Any]:
        """Return the switches for the browser, a note of what follows, and the reasons by the keys of what follows."""
        mates, tables, words = self._mates(), self._bench.tables, self._words
        if mates is None:
            self._ratio = None
            return {"holds": [], "note": [], "why": {}}
        if self._ratio is not None and (self._ratio.tables, self._ratio_of) != (mates.ratio, self._bench.name):
            self._ratio = None  # another spec was opened
        held, why = hold_of(mates, tables), self._reasons(mates, tables)
        titles = {
            HeldQuantity.CENTRE_DISTANCE: words["hold the centre distance: a profile shift follows"],
            HeldQuantity.PROFILE_SHIFTS: words["hold the profile shifts: the centre distance follows"],
            HeldQuantity.RATIO: words["hold the ratio: the number of teeth of the mate follows"],
        }
        holds = [
            {"what": hold.value, "title": title, "on": self._ratio is not None if hold is HeldQuantity.RATIO else held is hold}
            for hold, title in titles.items()
            if hold is not HeldQuantity.RATIO or mates.ratio
        ]
        return {"holds": holds, "note": self._note(mates, held), "why": why}

    def _mates(self) -> Mates | None:
        design, tables = self._bench.shown_design, self._bench.tables
        return mates_of(kind_of(tables) if design is None else design.kind, tables)

    def _reasons(self, mates: Mates, tables: Mapping[str, Any]) -> dict[str, str]:
        words = self._words
        of_distance = words["follows from teeth, module, helix angle and profile shifts"]
        of_shift = words["follows from the centre distance"]
        why = {key: of_distance if key == mates.distance else of_shift for key in unwritten_followers(mates, tables)}
        if self._ratio is not None:
            why |= dict.fromkeys(self._ratio.keys, f"{words['follows with the held ratio']} {self._ratio_text()}")
        return why

    def _note(self, mates: Mates, held: HeldQuantity | None) -> list[str]:
        """Return one sentence for each thing that follows."""
        words = self._words
        if held is HeldQuantity.CENTRE_DISTANCE:
            gears = [words[table_title(key.partition(".")[0])] for key in unwritten_followers(mates, self._bench.tables)]
            note = [f"{words['The profile shift follows']}: {', '.join(gears)}"]
        elif held is HeldQuantity.PROFILE_SHIFTS:
            of_rack = _is_of_rack(mates)
            note = [words["The mounting distance follows."] if of_rack else words["The centre distance follows."]]
        elif _is_of_rack(mates):
            note = [words["Mounting distance and profile shift are given: the backlash follows."]]
        else:
            note = [words["Centre distance and profile shifts are given: the backlash follows."]]
        return note if self._ratio is None else [*note, f"{words['The teeth of the mate follow']}: {self._ratio_text()}"]

    def _ratio_text(self) -> str:
        return "" if self._ratio is None else self._words.number(f"{abs(self._ratio.ratio):.{_DIGITS}g}")


def _is_of_rack(mates: Mates) -> bool:
    """Return whether the mate is a rack, whose distance is the mounting distance of the pinion."""
    return mates.distance.endswith(".mounting_distance")


def _is_whole(text: str) -> bool:
    return text.strip().removeprefix("-").isdecimal()


def _typed(value: Cell | None) -> str:
    """Return a value as somebody would type it; "" leaves its key out."""
    return "" if value is None else value if isinstance(value, str) else repr(value)
