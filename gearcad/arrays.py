"""The arrays that cross the walls of the house, by what they hold; results whose arrays nobody can change."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["Bools", "Complexes", "Floats", "Indices", "Wholes", "distinct", "freeze"]

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]

Wholes = NDArray[np.int64]
"""Counts and numbers of things, of one size on all machines."""

Indices = NDArray[np.intp]
"""Places in arrays, of the machine's own size."""


def distinct(values: Floats) -> Floats:
    """Values (n,) in their order, each once. NumPy's own function imports all of masked arrays for that."""
    ordered = np.sort(values)
    kept: Floats = ordered[np.concatenate([[True], ordered[1:] != ordered[:-1]])]
    return kept


def freeze(result: DataclassInstance) -> None:
    """Let no array among the fields of a frozen dataclass be written to."""
    for each in fields(result):
        value = getattr(result, each.name)
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
