"""Sizes with the limits of their fits. Lengths in mm."""

from __future__ import annotations

from typing import Any

from gearcad.drawing.words import Size
from gearcad.errors import ParameterError
from gearcad.geometry.iso286 import LARGEST_SIZE, limit_deviations

__all__ = ["as_hole", "diameter", "half_tolerance", "toleranced"]


def toleranced(value: float, fit: str, **of_size: Any) -> Size:
    """A size with the limits of a fit by ISO 286; without one general tolerances hold.

    They hold beyond 3150 mm too, where ISO 286 ends. Where a class has no limits here, beyond 500 mm but for h, H, js and JS,
    it stands by itself.
    """
    if not fit or value > LARGEST_SIZE:
        return Size(value=value, **of_size)
    try:
        limits = limit_deviations(fit, value)
    except ParameterError:
        return Size(value=value, fit=fit, **of_size)
    return Size(value=value, fit=fit, upper=limits.upper / 1000, lower=limits.lower / 1000, **of_size)


def diameter(value: float, fit: str = "", **of_size: Any) -> Size:
    """The same of a circle."""
    return toleranced(value, fit, prefix="⌀", **of_size)


def half_tolerance(size: Size) -> float | None:
    """Half of what a size may vary, in whole µm; None without limits."""
    if size.upper is None or size.lower is None:
        return None
    return max(float(round((size.upper - size.lower) * 1000) // 2), 1.0)


def as_hole(fit: str) -> str:
    """The class of a hole with the letter of a shaft."""
    return fit.upper()
