"""Limits as they are printed: rounded to the side on which the printed number is itself permitted."""

from __future__ import annotations

import math

__all__ = ["at_least", "at_most"]


def at_most(value: float, digits: int = 6) -> str:
    """`value` rounded down to `digits` significant digits, for "must be at most" and "must be below"."""
    if value == 0:
        return "0"
    step = digits - 1 - math.floor(math.log10(abs(value)))
    rounded = round(value, step)
    if rounded > value:
        rounded = round(rounded - 10.0**-step, step)
    return f"{rounded:.{digits}g}"


def at_least(value: float, digits: int = 6) -> str:
    """`value` rounded up to `digits` significant digits, for "must be at least" and "must be above"."""
    mirrored = at_most(-value, digits)
    return mirrored[1:] if mirrored.startswith("-") else ("0" if value == 0 else f"-{mirrored}")
