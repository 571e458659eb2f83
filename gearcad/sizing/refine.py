"""Refinement: the best variants between the values of the ranges, in figures that one writes on a drawing.

In each cell, what is about one combination of teeth, module and helix angle, every helix angle in halves of a degree, every
shift in twentieths, every round centre distance and every face width in whole mm that can be light enough are gone through:
complete within its steps, where an iteration would stop at the first edge of K_v or K_Hbeta.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.geometry.bracketed import root_between
from gearcad.per_gear import PerGear
from gearcad.sizing.geometry import ManyPairs, shift_sum_at
from gearcad.sizing.grid import distances_within, rounded_width
from gearcad.sizing.limits import LIMITS, shift_sums_within
from gearcad.sizing.ranking import NEARLY, best_of_each, lightest_of_each, ranked
from gearcad.sizing.rated import Rated, disc_mass
from gearcad.sizing.rating import rate_many
from gearcad.sizing.task import Criterion, SizeTask

__all__ = ["least_width", "refined"]

_HELIX_STEP, _SHIFT_STEP, _FINE_SHIFT_STEP = 0.5, 0.05, 0.01

_WIDTHS, _MOST_WIDTHS = 12, 40
"""Widths of a pair that are tried at a time, and of one of which not the least is wanted."""

_EDGES = (10.0, 20.0, 40.0, 80.0, 100.0, 125.0, 160.0, 250.0, 400.0, 650.0)
"""Face widths (mm) beyond which tolerances of ISO 1328-1:1995 and DIN 3962 jump, and safeties with them."""

_AT_A_TIME = 24
"""Cells: some ten thousand pairs. Those that come later need only compete with what the first have become."""


def refined(task: SizeTask, best: Rated, most: int, tell: Callable[[float], None] = lambda _: None) -> Rated:
    """The best of the best `most` cells, best first; `best` has one variant of each.

    By mass all cells are refined, with pairs that are light enough to become one of those; else the best `most` as they are.
    `tell` hears what part is done.
    """
    by_mass = task.criterion is Criterion.MASS
    order = ranked(best, task.criterion)
    cells = best.picked(order if by_mass else order[:most])
    found = _first(task, [cells], most)
    for start in range(0, len(cells.order), _AT_A_TIME):
        tell(start / len(cells.order))
        some = cells.picked(slice(start, start + _AT_A_TIME))
        last = found.mass.max() if len(found.order) == most else np.inf
        made = _best_of(task, some, _dense(task, some), np.minimum(some.mass, last))
        found = _first(task, [found, made], most)
    shifted = _best_of(task, found, _shifted(task, found), found.mass)
    found = _of_each(task, Rated.joined([found, shifted]))
    return found.picked(ranked(found, task.criterion))


def least_width(task: SizeTask, variant: Rated) -> float:
    """Face width (mm) at which the least safety is just the one that is required; n = 1.

    A root between the width there is, which is safe, and the first half of it, or half of that, that is not.
    """

    def reserve(width: float) -> float:
        """Below 0 of too narrow a face, and of one that has no rating."""
        size = np.array([[width]])
        found = rate_many(task, variant.pairs, size, np.ones((1, 1), bool), np.zeros((1, 1), int))
        if not len(found.order):
            return -1.0
        most = task.most_temperature
        return min(float(found.margin[0]) - 1, np.inf if most is None else most / float(found.temperature[0]) - 1)

    wide = float(variant.width[0])
    if reserve(wide) <= 0:
        return wide
    narrow = wide / 2
    while reserve(narrow) > 0:
        wide, narrow = narrow, narrow / 2
    return root_between(reserve, narrow, wide, xtol=1e-6)


def _of_each(task: SizeTask, found: Rated) -> Rated:
    """The best of each cell; a cell has one `order`."""
    if task.criterion is Criterion.MASS:
        return lightest_of_each(found, found.order)
    return best_of_each(found, found.order, task.criterion)


def _first(task: SizeTask, parts: list[Rated], most: int) -> Rated:
    """The best `most` of different cells, no two of the same teeth, module and helix angle, as neighbours may be refined to."""
    found = _of_each(task, Rated.joined(parts))
    found = found.picked(ranked(found, task.criterion))
    pairs = found.pairs
    _, first = np.unique(np.column_stack([*pairs.teeth, pairs.normal_module, pairs.helix_angle]), axis=0, return_index=True)
    return found.picked(np.sort(first)[:most])


# ---------------------------------------------------------------------- pairs


def _dense(task: SizeTask, cells: Rated) -> ManyPairs:
    """All pairs of cells that are within limits; their key is the number of their cell."""
    angles = [_angles(task, float(angle)) for angle in cells.pairs.helix_angle]
    number = np.repeat(np.arange(len(angles)), list(map(len, angles)))
    many = replace(cells.pairs.picked(number), key=number, helix_angle=np.concatenate(angles))
    if task.centre_distance is None:
        teeth = many.teeth.pinion + many.teeth.wheel
        sums = shift_sums_within(task)
        place, distance = distances_within(sums, teeth, many.normal_module, many.helix_angle, many.rack.pressure_angle)
        many = replace(many.picked(place), centre_distance=distance)
    return _with_shifts(task, many, _SHIFT_STEP)


def _shifted(task: SizeTask, cells: Rated) -> ManyPairs:
    """The pairs of cells with all shifts, finely, that are within limits; their key is the number of their cell."""
    return _with_shifts(task, replace(cells.pairs, key=np.arange(len(cells.order))), _FINE_SHIFT_STEP)


def _angles(task: SizeTask, own: float) -> Floats:
    """Helix angles that are no nearer to another angle of the task than to this one."""
    given = np.array([each for each in task.helix_angles if each > 0])
    if own == 0:
        return np.zeros(1)
    steps = np.arange(np.ceil(given[0] / _HELIX_STEP), np.floor(given[-1] / _HELIX_STEP) + 1) * _HELIX_STEP
    steps = np.union1d(steps, own)
    result: Floats = steps[np.abs(steps - own) <= np.abs(steps[:, None] - given).min(axis=1) + 1e-9]
    return result


def _with_shifts(task: SizeTask, pairs: ManyPairs, step: float) -> ManyPairs:
    """Pairs at their centre distances with all shifts, where they are within limits."""
    first, last = (end / step for end in (task.shifts[0], task.shifts[-1]))
    steps = np.arange(np.ceil(first - 1e-9), np.floor(last + 1e-9) + 1) * step
    shifts = np.union1d(np.round(steps, 6), task.shifts) + 0.0  # no -0
    teeth = pairs.teeth.pinion + pairs.teeth.wheel
    total = shift_sum_at(pairs.centre_distance, teeth, pairs.normal_module, pairs.helix_angle, pairs.rack.pressure_angle)
    many = pairs.picked(np.repeat(np.arange(len(pairs.key)), len(shifts)))
    shift = np.tile(shifts, len(pairs.key))
    found = replace(many, shifts=PerGear(shift, np.repeat(total, len(shifts)) - shift))
    for met in LIMITS.values():
        found = found.picked(met(found, task))
    return found


# ---------------------------------------------------------------------- widths


def _best_of(task: SizeTask, cells: Rated, pairs: ManyPairs, most_mass: Floats) -> Rated:
    """The best of each cell that one of its pairs makes; by mass none is heavier than `most_mass` (kg) of its cell."""
    by_mass = task.criterion is Criterion.MASS
    most = most_mass if by_mass else np.full(len(cells.order), np.inf if task.max_mass is None else task.max_mass)
    parts = _lightest(task, pairs, most) if by_mass else _widest(task, pairs, most)
    return _of_each(task, Rated.joined([cells, *(replace(part, order=cells.order[part.pairs.key]) for part in parts)]))


def _ends(task: SizeTask, pairs: ManyPairs, most_mass: Floats) -> tuple[Floats, Floats]:
    """The least and the most face width of each pair (mm)."""
    ratios, d = (task.width_ratios[0], task.width_ratios[-1]), pairs.diameters.pinion
    low, most = (rounded_width(ratio * d) for ratio in ratios)
    by_mass = most_mass[pairs.key] / _mass_of_width(task, pairs)
    most = np.minimum(most, np.minimum(task.max_width_in_modules * pairs.normal_module, by_mass))
    return low, _rounded_down(most)


def _mass_of_width(task: SizeTask, pairs: ManyPairs) -> Floats:
    """kg/mm."""
    return disc_mass(pairs, np.ones(1), PerGear(*(each.density for each in task.materials)))


def _rounded_down(width: Floats) -> Floats:
    """As `rounded_width`, but never more."""
    return np.where(width < 10, np.floor(width * 10 + 1e-6) / 10, np.floor(width + 1e-6))


def _step(width: Floats) -> Floats:
    """Of face widths above one (mm)."""
    return np.where(width < 10 - 1e-6, 0.1, 1.0)


def _widest(task: SizeTask, pairs: ManyPairs, most_mass: Floats) -> Iterator[Rated]:
    """Pairs with widths from the least to the most that are safe."""
    low, high = _ends(task, pairs, most_mass)
    width = rounded_width(np.linspace(low, high, _MOST_WIDTHS, axis=1))
    yield _safe(task, pairs, width, (width >= low[:, None]) & (width <= high[:, None]))


def _lightest(task: SizeTask, pairs: ManyPairs, most_mass: Floats) -> Iterator[Rated]:
    """Pairs with the least width at which they are safe, unless others of the cell are lighter anyway.

    Between edges safeties grow with the width: at first what is safe at an edge or at the most width is found, then the width
    from which it is by ever closer widths between one that is not and one that is.
    """
    most, (low, high) = most_mass.copy(), _ends(task, pairs, most_mass * NEARLY)
    there = low <= high
    pairs, low, high = pairs.picked(there), low[there], high[there]
    edges = [edge for edge in _EDGES if np.any((low < edge) & (edge < high))]
    width = np.column_stack([low, *(np.clip(edge, low, high) for edge in edges), high])
    while len(pairs.key):
        found = _safe(task, pairs, width, np.ones(width.shape, bool))
        yield found
        np.minimum.at(most, found.pairs.key, found.mass)
        safe = _places(found, width)
        first = np.argmax(safe, axis=1)
        rows = np.arange(len(width))
        high, low = width[rows, first], width[rows, np.maximum(first - 1, 0)]
        lighter = (low + _step(low)) * _mass_of_width(task, pairs) <= most[pairs.key] * NEARLY
        left = np.any(safe, axis=1) & (first > 0) & (low + _step(low) < high - 1e-6) & lighter
        pairs, low, high = pairs.picked(left), low[left], high[left]
        width = rounded_width(np.linspace(low, high, _WIDTHS, axis=1))


def _safe(task: SizeTask, pairs: ManyPairs, width: Floats, wanted: Bools) -> Rated:
    """Those with all safeties; their order is their place in (n, w)."""
    found = rate_many(task, pairs, width, wanted, np.arange(width.size).reshape(width.shape))
    return found.picked(found.safe(task))


def _places(found: Rated, width: Floats) -> Bools:
    """Where in (n, w) they are."""
    result = np.zeros(width.shape, bool)
    result.ravel()[found.order] = True
    return result
