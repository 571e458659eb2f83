"""Both: a number of a rating that holds for both gears, or a list [pinion, wheel]."""

from __future__ import annotations

from typing import Any

from gearcad.errors import ParameterError
from gearcad.per_gear import PerGear

__all__ = ["Both", "both", "take_both"]

Both = float | tuple[float, float]


def both(value: Both) -> PerGear[float]:
    """The numbers of both gears."""
    return PerGear(*value) if isinstance(value, tuple) else PerGear(value, value)


def take_both(instance: Any, *fields: str) -> None:
    """Let lists among fields of a frozen object be pairs of floats. Raises ParameterError for one of another length."""
    for field in fields:
        value = getattr(instance, field)
        if not isinstance(value, list | tuple):
            continue
        if len(value) != len(PerGear._fields):
            raise ParameterError(field, list(value), "must be a number for both gears, or a list [pinion, wheel]")
        object.__setattr__(instance, field, tuple(map(float, value)))
