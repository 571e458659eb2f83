"""The greatest that quantities reach over all angles of what turns: a grid of them, then ever smaller steps round the best."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from gearcad.arrays import Floats

__all__ = ["SMALLEST_STEP", "greatest", "grid_points"]

_POINTS = (1, 360, 60, 24, 12)
"""Angles of the grid over a turn, by the number of things that turn."""

SMALLEST_STEP = 1e-4
"""Steps (rad) at which the search ends: near a maximum, a hundred-millionth of what turns."""

_CASES = 4096
"""Cases that are looked at together, for the sake of memory."""


def grid_points(turning: int) -> int:
    """Angles of the grid over a turn of each of so many things."""
    return _POINTS[turning]


def greatest(quantities: Callable[[Floats], Floats], turning: int) -> tuple[Floats, Floats]:
    """The greatest (k,) of the `quantities` (s, k) that angles (s, turning) in rad give, and the angles (k, turning) there."""
    grid = 2 * np.pi * np.array(list(product(range(grid_points(turning)), repeat=turning))) / grid_points(turning)
    values = np.vstack([quantities(grid[start : start + _CASES]) for start in range(0, len(grid), _CASES)])
    best = values.argmax(axis=0)
    angles, found = grid[best], values.max(axis=0)
    if not turning:
        return found, angles
    step = np.full(len(found), np.pi / grid_points(turning))
    around = np.vstack([np.eye(turning), -np.eye(turning)])
    while (step > SMALLEST_STEP).any():
        tried = angles[:, None] + step[:, None, None] * around
        values = quantities(tried.reshape(-1, turning)).reshape(len(found), len(around), len(found))
        own = np.einsum("kak->ka", values)
        better = own.max(axis=1) > found
        angles = np.where(better[:, None], tried[np.arange(len(found)), own.argmax(axis=1)], angles)
        found = np.where(better, own.max(axis=1), found)
        step = np.where(better, step, step / 2)
    return found, angles
