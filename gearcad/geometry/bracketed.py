"""Roots inside brackets: Newton's rule for many values at once, Brent's for one."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import SolverError

__all__ = ["root_between", "where_root_is"]

_MOST_STEPS = 80


def where_root_is(
    goal: Floats, last: float, root_of: Callable[[Floats], tuple[Floats, Floats]], *, resolution: float = 4e-16
) -> Floats:
    """Places in [0, last] where sqrt(F) is `goal` (n,), F rising from 0 at 0 with the square of the place.

    `root_of` gives sqrt(F) and F'/2 at places. Newton's rule is on sqrt(F), which is nearly linear; it ends with a step of no
    more than `resolution` of `last`.
    """
    low, high = np.zeros_like(goal), np.full_like(goal, last)
    place: Floats = np.clip(goal / max(float(root_of(np.array([last]))[0][0]), 1e-300), 0, 1) * last
    for _ in range(_MOST_STEPS):
        value, slope = root_of(place)
        miss = value - goal
        low, high = np.where(miss < 0, place, low), np.where(miss > 0, place, high)
        step = miss * value / np.where(slope > 0, slope, 1.0)
        trial = place - step
        inside = (slope > 0) & (trial >= low) & (trial <= high)
        new: Floats = np.where(miss == 0, place, np.where(inside, trial, 0.5 * (low + high)))
        done = bool(np.all(np.abs(new - place) <= resolution * last))
        place = new
        if done:
            break
    return place


_EPSILON = 8.881784197001252e-16
"""The least relative tolerance: four roundings."""

_MOST_TRIALS = 100


def root_between(
    function: Callable[[float], float], low: float, high: float, *, xtol: float = 2e-12, rtol: float = _EPSILON
) -> float:
    """Where a function that has different signs at `low` and `high` is 0, to xtol + rtol |x|, by Brent's rule.

    Step by step that of `scipy.optimize.brentq`, whose import costs more than any gear. Raises ValueError for equal signs,
    SolverError where the tolerance is not reached.
    """
    before, here = low, high
    f_before, f_here = function(before), function(here)
    if f_before == 0:
        return before
    if f_here == 0:
        return here
    if (f_before < 0) == (f_here < 0):
        raise ValueError("the function must have different signs at both ends")
    other, f_other, last, step = 0.0, 0.0, 0.0, 0.0
    for _ in range(_MOST_TRIALS):
        if f_before != 0 and (f_before < 0) != (f_here < 0):  # the root is between the last two places
            other, f_other = before, f_before
            last = step = here - before
        if abs(f_other) < abs(f_here):
            before, here, other = here, other, here
            f_before, f_here, f_other = f_here, f_other, f_here
        least, half = (xtol + rtol * abs(here)) / 2, (other - here) / 2
        if f_here == 0 or abs(half) < least:
            return here
        trial = math.inf
        if abs(last) > least and abs(f_here) < abs(f_before):
            trial = _interpolated(before, here, other, f_before, f_here, f_other)
        if 2 * abs(trial) < min(abs(last), 3 * abs(half) - least):
            last, step = step, trial
        else:
            last = step = half
        before, f_before = here, f_here
        here += step if abs(step) > least else math.copysign(least, half)
        f_here = function(here)
    raise SolverError(f"no root to {xtol:g} between {low!r} and {high!r} in {_MOST_TRIALS} trials")


def _interpolated(before: float, here: float, other: float, f_before: float, f_here: float, f_other: float) -> float:
    """The step from `here` to where a line through two places, or an inverse parabola through three, is 0."""
    if before == other:
        return -f_here * (here - before) / (f_here - f_before)
    rise, fall = (f_before - f_here) / (before - here), (f_other - f_here) / (other - here)
    divisor = fall * rise * (f_other - f_before)
    return -f_here * (f_other * fall - f_before * rise) / divisor if divisor else math.inf
