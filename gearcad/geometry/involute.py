"""The involute function with its inverse, and roots of functions inside brackets. Angles in degrees, lengths in mm."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.core.errors import ParameterError, SolverError
from gearcad.core.records import Floats
from gearcad.core.values import Values, degrees, larger, root, with_sign

_MAX_NEWTON_STEPS = 60


@overload
def involute(angle: float) -> float: ...
@overload
def involute(angle: ArrayLike) -> NDArray[np.float64]: ...
def involute(angle: ArrayLike) -> Any:
    """Involute of a pressure angle, inv(alpha) = tan(alpha) - alpha.

    `angle` in degrees, scalar or array; returns the (dimensionless) involute of the same shape.
    """
    if isinstance(angle, float):
        one = math.radians(angle)
        return float(np.tan(one)) - one
    radians = np.radians(np.asarray(angle, float))
    result = np.tan(radians) - radians
    return float(result) if result.ndim == 0 else result


def involute_at_roll(roll: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the involute where the roll angle is `roll` (rad): that is tan(alpha), so inv(alpha) = roll - atan(roll)."""
    result: NDArray[np.float64] = roll - np.arctan(roll)
    return result


def tangent_length(diameter: Values, base_diameter: Values) -> Values:
    """Return the length of the base tangent out to a circle, the radius of curvature of the involute there; 0 inside the base
    circle.

    All in mm, signed like the diameters: negative on an internal gear.
    """
    square = larger((diameter - base_diameter) * (diameter + base_diameter), 0.0)
    return with_sign(root(square) / 2, base_diameter)


def base_half_angle(
    teeth: Values, normal_thickness: Values, normal_module: Values, transverse_pressure_angle: Values
) -> Values:
    """Return half tooth angle on the base circle in degrees: s_n/(m_n z) + inv alpha_t (ISO 21771)."""
    return degrees(normal_thickness / (normal_module * teeth) + involute(transverse_pressure_angle))


@overload
def inverse_involute(value: float) -> float: ...
@overload
def inverse_involute(value: ArrayLike) -> NDArray[np.float64]: ...
def inverse_involute(value: ArrayLike) -> Any:
    """Return the pressure angle in degrees whose involute is `value` (dimensionless, >= 0), to machine precision.

    Newton on t - atan t = value for t = tan alpha: convex, so every step after the first approaches from above.
    Scalar or array. Raises ParameterError for a negative value.
    """
    if isinstance(value, float) and value >= 0:
        return _inverse_of_one(value)
    target = np.asarray(value, float)
    if np.any(~(target >= 0)):
        raise ParameterError("involute", float(np.min(target)), "must be a number at least 0")
    tangent = np.minimum(target + np.pi / 2, np.cbrt(3 * target) * (1 + 0.4 * np.cbrt(3 * target)))
    for _ in range(_MAX_NEWTON_STEPS):
        slope = np.where(tangent > 0, tangent**2 / (1 + tangent**2), 1.0)
        step = (involute_at_roll(tangent) - target) / slope
        tangent = tangent - step
        if np.all(np.abs(step) <= 4e-16 * np.abs(tangent) + 1e-16 / slope):
            break
    else:  # pragma: no cover - the iteration is convex
        raise SolverError(f"inverse involute of {value!r} did not converge")
    result = np.degrees(np.arctan(tangent))
    return float(result) if result.ndim == 0 else result


def _inverse_of_one(target: float) -> float:
    """Return the inverse involute of one permitted value: an array of one takes thirty times as long."""
    guess = float(np.cbrt(3 * target))
    tangent = min(target + math.pi / 2, guess * (1 + 0.4 * guess))
    for _ in range(_MAX_NEWTON_STEPS):
        slope = tangent * tangent / (1 + tangent * tangent) if tangent > 0 else 1.0
        step = (tangent - float(np.arctan(tangent)) - target) / slope
        tangent -= step
        if abs(step) <= 4e-16 * abs(tangent) + 1e-16 / slope:
            return math.degrees(float(np.arctan(tangent)))
    raise SolverError(f"inverse involute of {target!r} did not converge")  # pragma: no cover - the iteration is convex


_MOST_STEPS = 80


def where_root_is(
    goal: Floats, last: float, root_of: Callable[[Floats], tuple[Floats, Floats]], *, resolution: float = 4e-16
) -> Floats:
    """Return the places in [0, last] where sqrt(F) is `goal` (n,), F rising from 0 at 0 with the square of the place.

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
    """Return where a function is 0 between `low` and `high`, at which its signs differ, to xtol + rtol |x|, by Brent's rule.

    The steps are those of `scipy.optimize.brentq`, whose import costs more than any gear. Raises ValueError for equal signs,
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
    """Return the step from `here` to where a line through two places, or an inverse parabola through three, is 0."""
    if before == other:
        return -f_here * (here - before) / (f_here - f_before)
    rise, fall = (f_before - f_here) / (before - here), (f_other - f_here) / (other - here)
    divisor = fall * rise * (f_other - f_before)
    return -f_here * (f_other * fall - f_before * rise) / divisor if divisor else math.inf
