"""Newton's rule inside a shrinking bracket, for many values at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gearcad.arrays import Floats

__all__ = ["where_root_is"]

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
