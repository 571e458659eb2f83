"""Edges of wanted lengths along a line: how many it takes, and where they end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats

__all__ = ["Grading", "graded"]


_FINE = 513
"""Points at which a line is sampled to measure and to grade it."""


@dataclass(frozen=True)
class Grading:
    """A line sampled at parameters `s` (n,): length run through (mm) and edges passed, up to each of them."""

    s: Floats
    run: Floats
    passed: Floats

    @property
    def edges(self) -> float:
        """Edges of the wanted lengths that the line takes, as a real number."""
        return float(self.passed[-1])

    def ends(self, count: int) -> Floats:
        """Parameters (count + 1,) of the ends of so many edges, all longer or shorter than wanted by the same factor."""
        return np.interp(np.linspace(0.0, self.edges, count + 1), self.passed, self.s)

    def with_middles(self, count: int) -> Floats:
        """Parameters (2 count + 1,) of the ends of so many edges, and half-way along each of them."""
        ends = self.ends(count)
        length = np.interp(ends, self.s, self.run)
        middles = np.interp((length[1:] + length[:-1]) / 2, self.run, self.s)
        return np.insert(ends, range(1, len(ends)), middles)


def graded(
    points: Callable[[Floats], Floats], size: Callable[[Floats, float], Floats], first: float = 0.0, last: float = 1.0
) -> Grading:
    """Grade a line between two parameters.

    `points` gives places (n, 2) in mm at parameters (n,); `size` the wanted edge lengths (n,) in mm at distances (n,) from the
    line's start, of its whole length.
    """
    s = np.linspace(first, last, _FINE)
    run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(points(s), axis=0).T))]
    effort = 1 / size(run, float(run[-1]))
    return Grading(s, run, np.r_[0.0, np.cumsum((effort[1:] + effort[:-1]) / 2 * np.diff(run))])
