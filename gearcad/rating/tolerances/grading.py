"""How tolerances grow with their grade, what they are rounded to, and the means of ranges; of numbers and of arrays."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gearcad.rating.factors.elementwise import Values, number_or_array

__all__ = ["graded", "mean_of_range"]

_FIFTH = 5
"""The grade that equations hold for."""


def graded(fifth: Values, grade: int) -> Values:
    """A tolerance of grade 5 in another, √2 times as much from each to the next.

    It is rounded as the standard has it: to whole µm above 10, to halves from 5 on, to tenths below.
    """
    exact = fifth * math.sqrt(2) ** (grade - _FIFTH)
    step = np.where(np.greater(exact, 10), 1.0, np.where(np.greater_equal(exact, 5), 0.5, 0.1))
    return number_or_array(exact, np.round(np.floor(exact / step + 0.5) * step, 1))


def mean_of_range(values: Values, limits: Sequence[float]) -> Values:
    """Geometric mean of the range that holds a value, whose upper limit belongs to it; beyond the last one it stays."""
    upper = np.searchsorted(limits[1:], values) + 1
    table = np.asarray(limits, dtype=float)
    middle = np.sqrt(table[upper - 1] * table[np.minimum(upper, len(table) - 1)])
    return number_or_array(values, np.where(np.less_equal(values, table[-1]), middle, values))
