"""Functions of numbers, or of arrays of many variants, for formulas that serve both. Angles in radians where not said.

Numbers give a number, by the functions of `math`; where one argument is an array the others broadcast, and an array comes out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from gearcad.core.records import Bools, Floats

Numbers = float | Floats
"""One for each variant, or one that holds for all."""

Values = TypeVar("Values", float, float | Floats)
"""Numbers give a number; where one of them is an array the others broadcast against it, and an array comes out."""


def number_or_array(_: Values, found: NDArray[Any]) -> Values:
    """Return found values in the type of the values that they come from: a number for a number, else an array."""
    return cast(Values, found if found.ndim else found.item())


# ---------------------------------------------------------------------- choices


def bounded(values: Values, least: float, most: float) -> Values:
    """Return the values, limited to the range from `least` to `most`."""
    return number_or_array(values, np.clip(values, least, most))


def chosen(condition: bool | Bools, values: Values, others: Values) -> Values:
    """Return the values where the condition holds, else the others."""
    return number_or_array(values, np.where(condition, values, others))


def larger(one: Values, other: Values) -> Values:
    """Return the larger of two values."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return cast(Values, np.maximum(one, other))
    return max(one, other)


def smaller(one: Values, other: Values) -> Values:
    """Return the smaller of two values."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return cast(Values, np.minimum(one, other))
    return min(one, other)


def magnitude(values: Values) -> Values:
    """Return the magnitude (absolute value)."""
    return cast(Values, np.abs(values)) if isinstance(values, np.ndarray) else abs(values)


def with_sign(values: Values, signed: Values) -> Values:
    """Return the magnitude of values with the sign of others."""
    if isinstance(values, np.ndarray) or isinstance(signed, np.ndarray):
        return cast(Values, np.copysign(values, signed))
    return math.copysign(values, signed)


# ---------------------------------------------------------------------- powers


def power(base: Values, exponent: Values) -> Values:
    """Return a positive base raised to the exponent.

    To a type checker `**` of two numbers could be complex.
    """
    return number_or_array(base, np.power(base, exponent))


def root(values: Values) -> Values:
    """Return the square root."""
    return cast(Values, np.sqrt(values)) if isinstance(values, np.ndarray) else math.sqrt(values)


def fourth_root(values: Values) -> Values:
    """Return the fourth root; of arrays the root of the root, which takes a tenth of the time of a power."""
    if isinstance(values, np.ndarray):
        return cast(Values, np.sqrt(np.sqrt(values)))
    return math.pow(values, 0.25)


def hypot(one: Values, other: Values) -> Values:
    """Return the square root of the sum of both squares."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return cast(Values, np.hypot(one, other))
    return math.hypot(one, other)


# ---------------------------------------------------------------------- angles


def radians(angle: Values) -> Values:
    """Return an angle in radians, from degrees."""
    return cast(Values, np.radians(angle)) if isinstance(angle, np.ndarray) else math.radians(angle)


def degrees(angle: Values) -> Values:
    """Return an angle in degrees, from radians."""
    return cast(Values, np.degrees(angle)) if isinstance(angle, np.ndarray) else math.degrees(angle)


def sin(angle: Values) -> Values:
    """Return the sine."""
    return cast(Values, np.sin(angle)) if isinstance(angle, np.ndarray) else math.sin(angle)


def cos(angle: Values) -> Values:
    """Return the cosine."""
    return cast(Values, np.cos(angle)) if isinstance(angle, np.ndarray) else math.cos(angle)


def tan(angle: Values) -> Values:
    """Return the tangent."""
    return cast(Values, np.tan(angle)) if isinstance(angle, np.ndarray) else math.tan(angle)


def arcsin(sine: Values) -> Values:
    """Return the angle of a sine."""
    return cast(Values, np.arcsin(sine)) if isinstance(sine, np.ndarray) else math.asin(sine)


def arccos(cosine: Values) -> Values:
    """Return the angle of a cosine."""
    return cast(Values, np.arccos(cosine)) if isinstance(cosine, np.ndarray) else math.acos(cosine)


def arctan(tangent: Values) -> Values:
    """Return the angle of a tangent."""
    return cast(Values, np.arctan(tangent)) if isinstance(tangent, np.ndarray) else math.atan(tangent)


def arctan2(across: Values, along: Values) -> Values:
    """Return the angle of a point (along, across), from -pi to pi."""
    if isinstance(across, np.ndarray) or isinstance(along, np.ndarray):
        return cast(Values, np.arctan2(across, along))
    return math.atan2(across, along)


# ---------------------------------------------------------------------- tables


def interpolated(values: Values, points: Sequence[tuple[float, float]]) -> Values:
    """Return values interpolated linearly between points (x, y) with rising x, constant beyond them."""
    x, y = zip(*points, strict=True)
    return number_or_array(values, np.interp(values, x, y))


def interpolated_over_log(values: Values, points: Sequence[tuple[float, float]]) -> Values:
    """Return values interpolated linearly over the logarithm of x, between points (x, y) with rising x, constant beyond them.

    0 and less count as before the first point.
    """
    x, y = zip(*points, strict=True)
    return number_or_array(values, np.interp(np.log(np.maximum(values, x[0])), np.log(x), y))


def interpolated_in_logs(values: Values, points: Sequence[tuple[float, float]]) -> Values:
    """Return values interpolated linearly over the logarithms of both x and y, as `interpolated_over_log`."""
    return number_or_array(values, np.exp(interpolated_over_log(values, [(x, math.log(y)) for x, y in points])))
