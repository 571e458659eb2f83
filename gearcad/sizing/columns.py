"""Columns: many variants side by side, an array for each of their quantities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np

from gearcad.arrays import Floats
from gearcad.per_gear import PerGear

__all__ = ["Columns", "Numbers"]

Numbers = float | Floats
"""One for each variant, or one that holds for all."""


@dataclass(frozen=True, kw_only=True)
class Columns:
    """Arrays of one shape as fields, some of them PerGear or other Columns; what else is a field holds for all variants."""

    def map(self, change: Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]) -> Self:
        """What a function makes of every array."""
        return type(self)(**{each.name: _changed(getattr(self, each.name), change) for each in fields(self)})

    def picked(self, which: Any) -> Self:
        """Those with these numbers, or where a mask is true; or, as with any index of numpy, the same in another shape."""
        return self.map(lambda array: array[which])

    @classmethod
    def joined(cls, parts: list[Self]) -> Self:
        """Several after each other; what holds for all is that of the first."""
        return cls(**{each.name: _joined([getattr(part, each.name) for part in parts]) for each in fields(parts[0])})


def _joined(values: list[Any]) -> Any:
    first = values[0]
    if isinstance(first, PerGear):
        return PerGear(*(_joined(list(each)) for each in zip(*values, strict=True)))
    if isinstance(first, Columns):
        return type(first).joined(values)
    return np.concatenate(values) if isinstance(first, np.ndarray) else first


def _changed(value: Any, change: Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]) -> Any:
    if isinstance(value, PerGear):
        return PerGear(*(_changed(each, change) for each in value))
    if isinstance(value, Columns):
        return value.map(change)
    return change(value) if isinstance(value, np.ndarray) else value
