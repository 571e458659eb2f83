"""Values: a number, or an array of many variants; what formulas need of numpy, for both alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Bools, Floats

__all__ = [
    "Values",
    "bounded",
    "chosen",
    "interpolated",
    "interpolated_in_logs",
    "interpolated_over_log",
    "magnitude",
    "number_or_array",
    "power",
    "root",
]

Values = TypeVar("Values", float, float | Floats)
"""Numbers give a number; where one of them is an array the others broadcast against it, and an array comes out."""


def bounded(values: Values, least: float, most: float) -> Values:
    """Values, none below `least` and none above `most`."""
    return number_or_array(values, np.clip(values, least, most))


def chosen(condition: bool | Bools, values: Values, others: Values) -> Values:
    """The values where the condition holds, else the others."""
    return number_or_array(values, np.where(condition, values, others))


def power(base: Values, exponent: Values) -> Values:
    """Base, positive, to the exponent: `**` of two numbers could be complex to a type checker."""
    return number_or_array(base, np.power(base, exponent))


def magnitude(values: Values) -> Values:
    """Without the sign."""
    return number_or_array(values, np.abs(values))


def root(values: Values) -> Values:
    """Square root."""
    return number_or_array(values, np.sqrt(values))


def interpolated(values: Values, points: Sequence[tuple[float, float]]) -> Values:
    """Straight lines through points (x, y) with rising x, level beyond them."""
    x, y = zip(*points, strict=True)
    return number_or_array(values, np.interp(values, x, y))


def interpolated_over_log(values: Values, points: Sequence[tuple[float, float]]) -> Values:
    """Straight lines over the logarithm of x, of points with rising x, level beyond them; 0 and less are before the first."""
    x, y = zip(*points, strict=True)
    return number_or_array(values, np.interp(np.log(np.maximum(values, x[0])), np.log(x), y))


def interpolated_in_logs(values: Values, points: Sequence[tuple[float, float]]) -> Values:
    """The same over logarithms of both x and y."""
    return number_or_array(values, np.exp(interpolated_over_log(values, [(x, math.log(y)) for x, y in points])))


def number_or_array(_: Values, found: NDArray[Any]) -> Values:
    """Found values as the type of those they come from: one alone is a number, not an array."""
    return cast(Values, found if found.ndim else found.item())
