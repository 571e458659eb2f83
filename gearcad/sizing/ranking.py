"""Which variants are better: by a criterion, ties by mass, safety and place; and which are on the front of mass and safety."""

from __future__ import annotations

from typing import Any

import numpy as np

from gearcad.arrays import Bools, Floats, Indices, Wholes
from gearcad.sizing.rated import Rated
from gearcad.sizing.task import Criterion

__all__ = ["NEARLY", "best_of_each", "front", "lightest_of_each", "ranked"]

NEARLY, _BAND = 1.005, 0.002
"""How many times as heavy as the lightest is as good as that, where x_1 < x_2 is avoided; by what part of the lightest masses
count as equal, where sliding is less."""

_DIGITS = 9
"""Significant figures by which variants are told apart: what is beyond is rounding, and ties are decided by place."""


def ranked(rated: Rated, criterion: Criterion) -> Indices:
    """Places of variants, best first."""
    return np.lexsort(_keys(rated, criterion)[::-1])


def _keys(rated: Rated, criterion: Criterion) -> tuple[np.ndarray[Any, Any], ...]:
    """The criterion, no finer than matters, so that what is as good in it goes by mass."""
    first = {
        Criterion.MASS: rated.mass,
        Criterion.SAFETY: np.round(-rated.margin, 3),
        Criterion.QUIET: np.round(rated.ripple, 2),
        Criterion.SLIDING: np.round(rated.sliding, 2),
        Criterion.SCUFFING: np.round(rated.temperature),
    }[criterion]
    return _figures(first), _figures(rated.mass), _figures(-rated.margin), _figures(rated.sliding), rated.order


def _figures(values: Floats) -> Floats:
    """Values without the digits that are rounding."""
    with np.errstate(divide="ignore"):
        size = np.where(values == 0, 0.0, np.floor(np.log10(np.abs(values))))
    step = 10.0 ** (size - _DIGITS + 1)
    return np.where(np.isfinite(values), np.round(values / step) * step, np.inf)


def best_of_each(rated: Rated, group: Wholes, criterion: Criterion) -> Rated:
    """The best of each group, such as of the same teeth and module, in order of the groups."""
    order = ranked(rated, criterion)
    _, first = np.unique(group[order], return_index=True)
    return rated.picked(order[first])


def lightest_of_each(rated: Rated, group: Wholes) -> Rated:
    """The lightest of each group; of those nearly as light, x_1 >= x_2 first, as q' is stated for it, then least sliding."""
    groups, place = np.unique(group, return_inverse=True)
    least = np.full(len(groups), np.inf)
    np.minimum.at(least, place, rated.mass)
    excess = rated.mass / least[place] - 1
    there = np.flatnonzero(excess <= NEARLY - 1)
    near, place = rated.picked(there), place[there]
    uneven = near.pairs.shifts.pinion < near.pairs.shifts.wheel - 1e-9
    bands = np.floor(excess[there] / _BAND + 1e-9)
    order = np.lexsort((_figures(near.mass), _figures(near.sliding), bands, uneven, place))
    _, first = np.unique(place[order], return_index=True)
    return near.picked(order[first])


def front(rated: Rated) -> Bools:
    """Where nothing is both lighter and safer: the front of mass and margin; of variants that are equal in both the first."""
    mass, margin = _figures(rated.mass), _figures(rated.margin)
    order = np.lexsort((rated.order, -margin, mass))
    best = np.maximum.accumulate(margin[order])
    before = np.concatenate([[-np.inf], best[:-1]])
    result = np.zeros(len(order), bool)
    result[order] = margin[order] > before
    return result
