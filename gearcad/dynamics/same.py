"""Which resonances of several charts, and which natural modes of several trains, are the same."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.maxima import outstanding
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.eigenmodes import NaturalModes
from gearcad.dynamics.trains.train import Train

__all__ = ["Peak", "envelope", "joined_modes", "joined_peaks", "peaks_of"]


_PROMINENCE = 0.005
"""How far K_v must fall on both sides of a maximum that counts."""

_REACH = 0.1
"""Relative: resonances farther apart in speed are not the same."""


_ALIKE = 0.25
"""Of modes that are taken for the same: the square of the cosine between their shapes, by the energy of the motion."""


class Peak(NamedTuple):
    """A maximum of K_v at a `speed` (rpm of the first pinion)."""

    speed: float
    factor: float


def envelope(study: TrainStudy) -> Floats:
    """(s, m): the greater K_v of running up and down, at the speeds of the charts."""
    return np.asarray(np.max([chart.factors for _, chart in study.charts.directions()], axis=0), float)


def peaks_of(study: TrainStudy, mesh: int, prominence: float = _PROMINENCE) -> list[Peak]:
    """Maxima of K_v of a mesh, running up or down, by speed, that stand out from both sides by so much."""
    factors, speeds = envelope(study)[:, mesh], study.speeds
    return [Peak(float(speeds[row]), float(factors[row])) for row in outstanding(factors, prominence)]


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


def joined_modes(studies: Sequence[TrainStudy], first: int) -> list[tuple[int | None, ...]]:
    """Elastic modes (from 0) of several trains side by side, those that move alike; the train `first` comes before the others.

    In order of frequency, those of the first train by its own.
    """
    of = studies[first].modes
    groups: list[list[int | None]] = []
    for mode in range(of.rigid, len(of)):
        groups.append([mode if each == first else None for each in range(len(studies))])
    more: list[list[int | None]] = []
    for place, study in enumerate(studies):
        if place == first:
            continue
        matched = _matched(studies[first], study)
        for row, mode in matched.items():
            groups[row - of.rigid][place] = mode
        for mode in range(study.modes.rigid, len(study.modes)):
            if mode not in matched.values():
                more.append([mode if each == place else None for each in range(len(studies))])
    every = [*groups, *more]
    every.sort(key=lambda group: next(float(studies[at].modes.circular[mode]) for at, mode in _given(group, first)))
    return [tuple(group) for group in every]


def _given(group: Sequence[int | None], first: int) -> list[tuple[int, int]]:
    """Which trains have the mode, and theirs: the first one before others."""
    given = [(place, mode) for place, mode in enumerate(group) if mode is not None]
    return sorted(given, key=lambda each: each[0] != first)


def _matched(of: TrainStudy, other: TrainStudy) -> dict[int, int]:
    """Modes of a train and those of another one that move alike, one each."""
    from scipy.optimize import linear_sum_assignment

    alike = _alikeness(of, other)
    alike[: of.modes.rigid] = alike[:, : other.modes.rigid] = 0.0
    rows, columns = linear_sum_assignment(-alike)
    return {int(row): int(column) for row, column in zip(rows, columns, strict=True) if alike[row, column] >= _ALIKE}


def _alikeness(of: TrainStudy, other: TrainStudy) -> Floats:
    """(n, k): square of the cosine between modes, in the energy of the motion; what one train does not have stands still."""
    products = [
        _product(a, b, of.train) for a, b in ((of.modes, other.modes), (of.modes, of.modes), (other.modes, other.modes))
    ]
    both, own, others = products
    whole = np.outer(np.diag(own), np.diag(others))
    return np.asarray(np.divide(both**2, whole, out=np.zeros_like(both), where=whole > 0), float)


def _product(one: NaturalModes, two: NaturalModes, train: Train) -> Floats:
    """(n, k): sum of inertia times turn times turn over what both have."""
    found = np.zeros((len(one), len(two)))
    for inertia in train.inertias:
        if inertia.name in one.inertias and inertia.name in two.inertias:
            turns = (each.shape[:, each.inertias.index(inertia.name)] for each in (one, two))
            found += inertia.inertia * np.outer(*turns)
    for shaft in train.shafts:
        if shaft.name in one.shafts and shaft.name in two.shafts:
            a, b = (each.shaft_shape[:, each.shafts.index(shaft.name)] for each in (one, two))
            found += shaft.inertia * np.trapezoid(a[:, None] * b, one.places, axis=2)
    return found
