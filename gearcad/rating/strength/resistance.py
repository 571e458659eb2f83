"""Resistance: the stress that a flank or a root bears, over its load cycles."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from gearcad.rating.factors import Points, transition
from gearcad.rating.factors.elementwise import interpolated_in_logs
from gearcad.rating.factors.life import endurance_cycles

__all__ = ["Resistance"]


@dataclass(frozen=True, kw_only=True)
class Resistance:
    """`reference` (MPa) times factors under their symbols: of static strength, and of endurance; the life factor's `points`.

    The reference is sigma_Hlim, or sigma_Flim Y_ST. The factors go over from one to the other as `transition` has it.
    """

    reference: float
    life_symbol: str
    points: Points
    static: Mapping[str, float]
    endurance: Mapping[str, float]

    def factors(self, cycles: float | None) -> dict[str, float]:
        """All factors after so many load cycles; None stands for the endurance limit, where the life factor is 1."""
        count = endurance_cycles(self.points) if cycles is None else cycles
        others = {
            symbol: transition(count, self.static[symbol], value, self.points) for symbol, value in self.endurance.items()
        }
        return {self.life_symbol: interpolated_in_logs(count, self.points), **others}

    def stress(self, cycles: float | None) -> float:
        """sigma_HG or sigma_FG (MPa) after so many load cycles."""
        return self.reference * math.prod(self.factors(cycles).values())

    @cached_property
    def curve(self) -> Points:
        """The same as straight lines in log-log: load cycles and stress (MPa) at the corners, cycles rising."""
        return tuple((cycles, self.stress(cycles)) for cycles, _ in self.points)
