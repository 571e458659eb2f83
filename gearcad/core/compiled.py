"""Machine code by numba. Import this room inside functions only: the import of numba takes half a second."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Return a function as machine code that lets other threads run and rounds as written; cached on disk if possible."""
    options = {"nogil": True, "error_model": "numpy"}
    try:
        made: Function = numba.njit(cache=True, **options)(function)
    except RuntimeError:  # no folder for it
        made = numba.njit(**options)(function)
    return made


def inlined(function: Function) -> Function:
    """Return a function as machine code that is inlined into its callers.

    Passing an array to a function takes longer than using it.
    """
    made: Function = numba.njit(nogil=True, error_model="numpy", inline="always")(function)
    return made
