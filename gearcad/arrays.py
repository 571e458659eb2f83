"""The arrays that cross the walls of the house, by what they hold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["Bools", "Complexes", "Floats", "Indices", "Wholes"]

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]

Wholes = NDArray[np.int64]
"""Counts and numbers of things, of one size on all machines."""

Indices = NDArray[np.intp]
"""Places in arrays, of the machine's own size."""
