"""The involute function and its inverse (ISO 21771: inv alpha = tan alpha - alpha)."""

from __future__ import annotations

import math
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.errors import ParameterError, SolverError

__all__ = ["inverse_involute", "involute", "involute_at_roll", "tangent_length"]

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
    """The involute where the roll angle is `roll` (rad): that is tan(alpha), so inv(alpha) = roll - atan(roll)."""
    result: NDArray[np.float64] = roll - np.arctan(roll)
    return result


def tangent_length(diameter: float, base_diameter: float) -> float:
    """Length of the base tangent out to a circle, the radius of curvature of the involute there; 0 inside the base circle.

    All in mm, signed like the diameters: negative on an internal gear.
    """
    square = max((diameter - base_diameter) * (diameter + base_diameter), 0.0)
    return math.copysign(math.sqrt(square) / 2, base_diameter)


@overload
def inverse_involute(value: float) -> float: ...
@overload
def inverse_involute(value: ArrayLike) -> NDArray[np.float64]: ...
def inverse_involute(value: ArrayLike) -> Any:
    """Pressure angle in degrees whose involute is `value` (dimensionless, >= 0), to machine precision.

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
    """The same of one value that is permitted: an array of one takes thirty times as long."""
    guess = float(np.cbrt(3 * target))
    tangent = min(target + math.pi / 2, guess * (1 + 0.4 * guess))
    for _ in range(_MAX_NEWTON_STEPS):
        slope = tangent * tangent / (1 + tangent * tangent) if tangent > 0 else 1.0
        step = (tangent - float(np.arctan(tangent)) - target) / slope
        tangent -= step
        if abs(step) <= 4e-16 * abs(tangent) + 1e-16 / slope:
            return math.degrees(float(np.arctan(tangent)))
    raise SolverError(f"inverse involute of {target!r} did not converge")  # pragma: no cover - the iteration is convex
