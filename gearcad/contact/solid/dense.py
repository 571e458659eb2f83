"""Dense factors by SciPy's BLAS and LAPACK, in place: other threads run meanwhile, which SciPy's own calls do not let them.

Matrices of doubles lie column by column, as a whole; of symmetric ones, and of factors, the lower triangle is there.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

from gearcad.arrays import Floats

__all__ = ["cholesky", "solve_above", "solve_aside", "subtract_square"]


def cholesky(matrix: Floats) -> int:
    """Make L with L L.T of a matrix (n, n); else which of its leading minors is not positive."""
    failed = ctypes.c_int(0)
    size = _size(len(matrix))
    _routine("lapack", "dpotrf", 5)(b"L", size, _at(matrix), size, ctypes.byref(failed))
    return failed.value


def solve_above(lower: Floats, right: Floats) -> None:
    """Make L^-1 R of R (n, m)."""
    _solve(b"L", b"N", lower, right)


def solve_aside(lower: Floats, right: Floats, *, transposed: bool) -> None:
    """Make R L^-1, or R L^-T, of R (m, n)."""
    _solve(b"R", b"T" if transposed else b"N", lower, right)


def _solve(side: bytes, turned: bytes, lower: Floats, right: Floats) -> None:
    rows, columns = right.shape
    if not right.size:
        return
    arguments = (_size(rows), _size(columns), _number(1.0), _at(lower), _size(len(lower)), _at(right), _size(rows))
    _routine("blas", "dtrsm", 11)(side, b"L", turned, b"N", *arguments)


def subtract_square(across: Floats, rest: Floats) -> None:
    """Make C - A.T A of C (m, m) and A (n, m)."""
    rows, columns = across.shape
    size = _size(columns)
    arguments = (size, _size(rows), _number(-1.0), _at(across), _size(rows), _number(1.0), _at(rest), size)
    _routine("blas", "dsyrk", 10)(b"L", b"T", *arguments)


@cache
def _routine(library: str, name: str, arguments: int) -> Callable[..., None]:
    from numba.extending import get_cython_function_address

    address = get_cython_function_address(f"scipy.linalg.cython_{library}", name)
    routine: Callable[..., None] = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * arguments)(address)
    return routine


def _size(value: int) -> Any:
    return ctypes.byref(ctypes.c_int(value))


def _number(value: float) -> Any:
    return ctypes.byref(ctypes.c_double(value))


def _at(matrix: Floats) -> int:
    assert matrix.flags.f_contiguous and matrix.dtype == float
    return matrix.ctypes.data
