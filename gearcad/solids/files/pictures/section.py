"""Section: the inside of closed lines in a plane, as strips from line to line."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Indices

__all__ = ["Section", "section_of"]

_SAME = 1e-9
"""Distance between levels that counts as none, as a share of the extent."""


class Section(NamedTuple):
    """Strips: lower left, lower right, upper left, upper right (n, 4, 2) as (u, v), left and right on lines, u the level."""

    strips: Floats

    @property
    def lowest(self) -> Floats:
        """The lower sides (k, 2, 2) of the strips at the lowest level."""
        sides: Floats = self.strips[self.strips[:, 0, 0] == self.strips[:, 0, 0].min(initial=np.inf)][:, :2]
        return sides


def section_of(lines: Floats) -> Section:
    """What lines (m, 2, 2), ends as (u, v), enclose by the rule of even and odd; open at a level they may be.

    Between two levels at which lines end none begins nor ends, and those that cross stand in pairs: no topology is asked for,
    so neither slim triangles nor thousands of teeth do harm.
    """
    levels, places = _levels(lines[..., 0])
    upward = np.take_along_axis(lines, np.argsort(places, axis=1)[..., None], axis=1)
    low, high = np.sort(places, axis=1).T
    line = np.repeat(np.arange(len(lines)), high - low)
    slab = np.arange(len(line)) - np.repeat(np.cumsum(high - low) - (high - low), high - low) + low[line]
    ends = np.stack([_at(upward[line], levels, low[line], high[line], slab + step) for step in (0, 1)], axis=1)
    order = np.lexsort((ends.sum(axis=1), slab))
    slab, ends = slab[order], ends[order]
    whole = np.isin(slab, np.flatnonzero(np.bincount(slab, minlength=1) % 2 == 0))
    slab, ends = slab[whole][::2], ends[whole].reshape(-1, 2, 2)  # left and right, below and above
    u = np.stack([levels[slab], levels[slab], levels[slab + 1], levels[slab + 1]], axis=1)
    v = np.stack([ends[:, 0, 0], ends[:, 1, 0], ends[:, 0, 1], ends[:, 1, 1]], axis=1)
    return Section(np.stack([u, v], axis=-1))


def _at(lines: Floats, levels: Floats, low: Indices, high: Indices, level: Indices) -> Floats:
    """Where lines (n, 2, 2) from level to level are at a level (n,)."""
    share = (levels[level] - levels[low]) / (levels[high] - levels[low])
    found: Floats = lines[:, 0, 1] * (1 - share) + lines[:, 1, 1] * share
    return found


def _levels(u: Floats) -> tuple[Floats, Indices]:
    """The levels, rising, and at which each end (m, 2) is."""
    values, places = np.unique(u.ravel(), return_inverse=True)
    if not len(values):
        return np.zeros(2), np.zeros(u.shape, np.intp)
    new = np.diff(values, prepend=-np.inf) > _SAME * max(float(np.ptp(values)), 1e-300)
    return values[new], (np.cumsum(new) - 1)[places].reshape(u.shape)
