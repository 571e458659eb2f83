"""Machine code by numba. Import this room inside functions only: the import of numba takes half a second."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
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
    else:
        _forget_unreadable(made)
    return made


def _forget_unreadable(made: Any) -> None:
    """Empty the cache of a function if it names what is no more, such as a class of an older version of the package."""
    cache = made._cache
    try:
        cache._cache_file._load_index()
    except Exception:  # an index is a pickle: it may raise anything
        with suppress(OSError):
            cache.flush()


def inlined(function: Function) -> Function:
    """Return a function as machine code that is inlined into its callers.

    Passing an array to a function takes longer than using it.
    """
    made: Function = numba.njit(nogil=True, error_model="numpy", inline="always")(function)
    return made
