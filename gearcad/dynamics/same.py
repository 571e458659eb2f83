"""Which resonances of several charts, and which natural modes of several models, are the same."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.train_result import TrainStudy

__all__ = ["Peak", "envelope", "joined_peaks", "peaks_of"]


_PROMINENCE = 0.005
"""How far K_v must fall on both sides of a maximum that counts."""

_REACH = 0.1
"""Relative: resonances farther apart in speed are not the same."""


class Peak(NamedTuple):
    """A maximum of K_v at a `speed` (rpm of the first pinion)."""

    speed: float
    factor: float


def envelope(study: TrainStudy) -> Floats:
    """(s, m): the greater K_v of running up and down, at the speeds of the charts."""
    return np.asarray(np.max([chart.factors for _, chart in study.charts.directions()], axis=0), float)


def peaks_of(study: TrainStudy, mesh: int) -> list[Peak]:
    """Maxima of K_v of a mesh, running up or down, by speed."""
    from scipy.signal import find_peaks

    factors, speeds = envelope(study)[:, mesh], study.speeds
    found, _ = find_peaks(factors, prominence=_PROMINENCE)
    return [Peak(float(speeds[row]), float(factors[row])) for row in found]


def joined_peaks(listed: Sequence[Sequence[Peak]], first: int) -> list[tuple[Peak | None, ...]]:
    """The same maxima of several charts side by side; those of the chart `first` are held against before all others."""
    groups: list[list[Peak | None]] = []
    for chart in sorted(range(len(listed)), key=lambda each: each != first):
        pairs = sorted(
            (apart, row, column)
            for row, group in enumerate(groups)
            for column, peak in enumerate(listed[chart])
            if (apart := _apart(group, peak)) is not None
        )
        taken = set[int]()
        for _, row, column in pairs:
            if groups[row][chart] is None and column not in taken:
                groups[row][chart] = listed[chart][column]
                taken.add(column)
        for column, peak in enumerate(listed[chart]):
            if column not in taken:
                groups.append([peak if each == chart else None for each in range(len(listed))])
    return [tuple(group) for group in groups]


def _apart(group: Sequence[Peak | None], peak: Peak) -> float | None:
    """How little a maximum is like the first of a group; None where it is out of reach."""
    known = next(each for each in group if each is not None)
    off = abs(math.log(peak.speed / known.speed)) / math.log(1 + _REACH)
    return off + abs(math.log(peak.factor / known.factor)) if off <= 1 else None
