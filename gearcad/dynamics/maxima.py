"""Maxima of curves that are known at places: those that stand out, and the highest of those that are close together.

Those of `scipy.signal.find_peaks`, whose package takes 0.6 s to come: it brings statistics and images with it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats

__all__ = ["apart", "outstanding"]

Places = NDArray[np.intp]


def outstanding(values: Floats, prominence: float) -> Places:
    """Maxima that stand so high above the higher of the lowest values to both sides, each up to where it is higher again."""
    found = _summits(values)
    return found[[_prominence(values, place) >= prominence for place in found.tolist()]]


def apart(values: Floats, distance: int) -> Places:
    """Maxima at least so many places from each other: a lower one gives way, of two that are alike the one before."""
    found = _summits(values)
    kept = np.ones(len(found), bool)
    first, last = (np.searchsorted(found, found + reach) for reach in (1 - distance, distance))
    for peak in np.argsort(values[found], kind="stable")[::-1].tolist():
        if kept[peak]:
            kept[first[peak] : last[peak]] = False
            kept[peak] = True
    return found[kept]


def _prominence(values: Floats, place: int) -> float:
    before, behind = values[: place + 1][::-1], values[place:]
    return float(values[place] - max(_lowest(before), _lowest(behind)))


def _lowest(values: Floats) -> float:
    """Of values (n,) from a maximum on, up to where one is higher."""
    higher = np.flatnonzero(values > values[0])
    return float(values[: higher[0] if len(higher) else None].min())


def _summits(values: Floats) -> Places:
    """Where values (n,) rise before and fall behind; of those that stay alike at the top the middle, the lower of two."""
    starts = np.flatnonzero(np.r_[True, np.diff(values) != 0])
    ends, level = np.r_[starts[1:], len(values)] - 1, values[starts]
    top = np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])) + 1
    middles: Places = (starts[top] + ends[top]) // 2
    return middles
