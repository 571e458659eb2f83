"""The speeds at which a machine runs under load: where its loads are told, and its models are held against each other."""

from __future__ import annotations

from enum import Enum
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.dynamics.options import DynamicsOptions
from gearcad.errors import GeometryError

__all__ = ["OperatingRange", "RangeSource", "operating_range"]


_ROUNDING = 1e-9
"""Relative, of speeds."""


class RangeSource(Enum):
    """What says where a train runs under load."""

    GIVEN = "operating range"
    SPEED = "speed of the train"
    CHART = "whole chart"


class OperatingRange(NamedTuple):
    """From `first` to `last` (rpm of the first pinion, or of a planetary train's input), and what says so."""

    first: float
    last: float
    source: RangeSource

    @property
    def words(self) -> str:
        """As a sentence has it."""
        given = {
            RangeSource.GIVEN: "the operating range",
            RangeSource.SPEED: "up to the speed of the train",
            RangeSource.CHART: "the whole chart, for no operating range is given",
        }
        return f"from {self.first:.5g} to {self.last:.5g} rpm ({given[self.source]})"

    @property
    def heading(self) -> str:
        """As a line of the screen has it, "" of the whole chart."""
        return "" if self.source is RangeSource.CHART else f"from {self.first:.5g} to {self.last:.5g} rpm "

    def rows(self, speeds: Floats) -> Bools:
        """Return which of the speeds (s,) lie in it."""
        return np.asarray((speeds >= self.first * (1 - _ROUNDING)) & (speeds <= self.last * (1 + _ROUNDING)), bool)

    def within(self, speeds: Floats) -> OperatingRange:
        """Return the range, or the whole chart of rising `speeds` (s,) where none of these lies in it."""
        if self.rows(speeds).any():
            return self
        return OperatingRange(float(speeds[0]), float(speeds[-1]), RangeSource.CHART)

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {**self._asdict(), "source": self.source.value}


def operating_range(speed: float, options: DynamicsOptions, chart: tuple[float, float]) -> OperatingRange:
    """Return it as the options give it; else from the first speed of the chart up to `speed`, or to the last of the chart.

    `speed` (rpm) is that of the load, 0 if it is not known.

    Raises GeometryError where it would end before it begins.
    """
    first, last, own = options.operating_from, options.operating_to, abs(speed)
    given = first is not None or last is not None
    end = last if last is not None else own or chart[1]
    if first is not None and first >= end:
        what = "operating_to" if last is not None else "the speed of the train" if own else "the last speed of the chart"
        raise GeometryError("operating_from", first, f"must be below {what}, {end:.5g} rpm", "rpm")
    source = RangeSource.GIVEN if given else RangeSource.SPEED if own else RangeSource.CHART
    begin = first if first is not None else chart[0] if chart[0] < end else 0.0
    return OperatingRange(begin, end, source)
