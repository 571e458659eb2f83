"""Refinement: the best variants between the values of the ranges, in figures that one writes on a drawing.

Helix angles in halves of a degree, shifts in hundredths and sensible face widths around a variant are all rated, as one array:
complete within its steps, where an iteration would stop at the first edge of K_v or K_Hbeta.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcad.arrays import Floats
from gearcad.per_gear import PerGear
from gearcad.sizing.geometry import ManyPairs, shift_sum_at
from gearcad.sizing.grid import rounded_width
from gearcad.sizing.limits import LIMITS, width_within
from gearcad.sizing.ranking import ranked
from gearcad.sizing.rated import Rated
from gearcad.sizing.rating import rate_many
from gearcad.sizing.task import Criterion, SizeTask

__all__ = ["least_width", "refined"]

_HELIX_STEP, _HELIX_REACH = 0.5, 2.5
_SHIFT_STEP = 0.01
_NARROWEST, _MOST_WIDTHS = 0.7, 40
"""The least width that is tried, as a part of what is there, and how many widths up to it."""


def refined(task: SizeTask, variant: Rated) -> Rated:
    """The best around one variant, n = 1 of both; by mass that is the least width, and of those the least sliding."""
    pairs = _around(task, variant.pairs)
    if not len(pairs.key):
        return variant
    width = np.tile(_widths(float(variant.width[0])), (len(pairs.key), 1))
    column = pairs.picked((slice(None), None))
    least = rounded_width(task.width_ratios[0] * column.diameters.pinion)
    fits = width_within(width, column, task) & (width >= least)
    found = rate_many(task, pairs, width, fits, np.arange(width.size).reshape(width.shape))
    found = found.picked(found.safe(task))
    if not len(found.order):
        return variant
    found = replace(found, order=np.full_like(found.order, variant.order[0]))
    if task.criterion is Criterion.MASS:
        best = found.picked(np.lexsort((found.mass, found.sliding, found.width))[:1])
        return best if best.width[0] <= variant.width[0] else variant
    best = found.picked(ranked(found, task.criterion)[:1])
    return best if ranked(Rated.joined([variant, best]), task.criterion)[0] == 1 else variant


def least_width(task: SizeTask, variant: Rated) -> float:
    """Face width (mm) at which the least safety is just the one that is required; n = 1.

    A root between the width there is, which is safe, and the first half of it, or half of that, that is not.
    """
    from scipy.optimize import brentq

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
    return float(brentq(reserve, narrow, wide, xtol=1e-6))


def _around(task: SizeTask, pairs: ManyPairs) -> ManyPairs:
    """Those within limits with other helix angles and shifts at the same centre distance."""
    own, angles = float(pairs.helix_angle[0]), [each for each in task.helix_angles if each > 0]
    helix = np.array([own])
    if own > 0:
        steps = np.arange(np.ceil(angles[0] / _HELIX_STEP), np.floor(angles[-1] / _HELIX_STEP) + 1) * _HELIX_STEP
        helix = np.union1d(helix, steps[np.abs(steps - own) <= _HELIX_REACH])
    first, last = (round(end / _SHIFT_STEP) for end in (task.shifts[0], task.shifts[-1]))
    shift = np.union1d(pairs.shifts.pinion, np.round(np.arange(first, last + 1) * _SHIFT_STEP, 6))
    each_helix, each_shift = (each.ravel() for each in np.meshgrid(helix, shift, indexing="ij"))
    found = _moved(pairs, each_helix, each_shift)
    for met in LIMITS.values():
        found = found.picked(met(found, task))
    return found


def _moved(pairs: ManyPairs, helix: Floats, shift: Floats) -> ManyPairs:
    """One pair with other helix angles and shifts of the pinion."""
    many = pairs.picked(np.zeros(len(helix), int))
    teeth = many.teeth.pinion + many.teeth.wheel
    total = shift_sum_at(many.centre_distance, teeth, many.normal_module, helix, many.rack.pressure_angle)
    return replace(many, helix_angle=helix, shifts=PerGear(shift, total - shift))


def _widths(most: float) -> Floats:
    """Sensible face widths (mm) up to one."""
    return np.union1d(rounded_width(np.linspace(_NARROWEST * most, most, _MOST_WIDTHS)), [most])
