"""Dense factors by SciPy's BLAS and LAPACK, in place: other threads run meanwhile, which SciPy's own calls do not let them.

Matrices of doubles lie column by column, as a whole; of symmetric ones, and of factors, the lower triangle is there. A factor L
has the inverses of the blocks on its diagonal in their place: all that it solves is then products of matrices, which are up to
twice as fast as BLAS's own solutions with a triangle.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats

__all__ = ["factorise", "solve_above", "solve_aside", "solved_rows", "subtract_product", "subtract_square"]


_BLOCK = 128
"""Rows of a block on the diagonal of a factor."""

_BYTES = 8
"""Of a double."""


def factorise(matrix: Floats) -> int:
    """Make L with L L.T of a matrix (n, n); else which of its leading minors is not positive."""
    failed, whole = ctypes.c_int(0), _Part.of(matrix)
    _routine("lapack", "dpotrf", 5)(b"L", _size(whole.rows), whole.at, _size(whole.step), ctypes.byref(failed))
    if not failed.value:
        for first, last in _blocks(whole.rows):
            block = whole.some(first, last, first, last)
            arguments = (_size(block.rows), block.at, _size(block.step), ctypes.byref(failed))
            _routine("lapack", "dtrtri", 6)(b"L", b"N", *arguments)
    return failed.value


def solve_above(lower: Floats, right: Floats) -> None:
    """Make L^-1 R of R (n, m)."""
    given, result = _Part.of(lower), _Part.of(right)
    for first, last in _blocks(given.rows):
        rows = result.some(first, last, 0, result.columns)
        _subtract(rows, given.some(first, last, 0, first), result.some(0, first, 0, result.columns))
        _multiply(given.some(first, last, first, last), rows, side=b"L")


def solve_aside(lower: Floats, right: Floats, *, transposed: bool) -> None:
    """Make R L^-1, or R L^-T, of R (m, n)."""
    given, result = _Part.of(lower), _Part.of(right)
    blocks = _blocks(given.rows)
    for first, last in blocks if transposed else blocks[::-1]:
        columns, own = result.some(0, result.rows, first, last), given.some(first, last, first, last)
        if transposed:
            _subtract(columns, result.some(0, result.rows, 0, first), given.some(first, last, 0, first), turned=b"T")
            _multiply(own, columns, side=b"R", turned=b"T")
        else:
            known, across = result.some(0, result.rows, last, given.rows), given.some(last, given.rows, first, last)
            _subtract(columns, known, across)
            _multiply(own, columns, side=b"R")


def solved_rows(lower: Floats, right: Floats) -> Floats:
    """(L L.T)^-1 R of R (n, m), row by row."""
    result = np.array(right, order="C")
    solve_aside(lower, result.T, transposed=True)  # rows of C are columns of Fortran
    solve_aside(lower, result.T, transposed=False)
    return result


def subtract_product(result: Floats, first: Floats, second: Floats, *, transposed: bool) -> None:
    """Make C - A B, or C - A B.T, of C."""
    _subtract(_Part.of(result), _Part.of(first), _Part.of(second), turned=b"T" if transposed else b"N")


def subtract_square(across: Floats, rest: Floats) -> None:
    """Make C - A.T A of C (m, m) and A (n, m)."""
    given, result = _Part.of(across), _Part.of(rest)
    sizes = (_size(given.columns), _size(given.rows))
    arguments = (_number(-1.0), given.at, _size(given.step), _number(1.0), result.at, _size(result.step))
    _routine("blas", "dsyrk", 10)(b"L", b"T", *sizes, *arguments)


class _Part(NamedTuple):
    """Some rows and columns of a matrix: where the first number is, and how many numbers it is from column to column."""

    at: int
    rows: int
    columns: int
    step: int

    @classmethod
    def of(cls, matrix: Floats) -> _Part:
        """All of it."""
        assert matrix.flags.f_contiguous and matrix.dtype == float
        rows, columns = matrix.shape
        return cls(matrix.ctypes.data, rows, columns, max(rows, 1))

    def some(self, first_row: int, last_row: int, first: int, last: int) -> _Part:
        """Rows and columns from the first one to before the last one."""
        at = self.at + _BYTES * (first_row + first * self.step)
        return _Part(at, last_row - first_row, last - first, self.step)


def _blocks(rows: int) -> list[tuple[int, int]]:
    """First row, and the one after the last, of each block on the diagonal."""
    return [(first, min(first + _BLOCK, rows)) for first in range(0, rows, _BLOCK)]


def _subtract(result: _Part, first: _Part, second: _Part, *, turned: bytes = b"N") -> None:
    """Make C - A B, or C - A B.T, of C."""
    if not result.rows or not result.columns or not first.columns:
        return
    sizes = (_size(result.rows), _size(result.columns), _size(first.columns))
    factors = (_number(-1.0), first.at, _size(first.step), second.at, _size(second.step), _number(1.0))
    _routine("blas", "dgemm", 13)(b"N", turned, *sizes, *factors, result.at, _size(result.step))


def _multiply(triangle: _Part, result: _Part, *, side: bytes, turned: bytes = b"N") -> None:
    """Make A B, or with `side` R B A or B A.T, of B, with a lower triangle A."""
    if not result.rows or not result.columns:
        return
    sizes = (_size(result.rows), _size(result.columns), _number(1.0))
    _routine("blas", "dtrmm", 11)(
        side, b"L", turned, b"N", *sizes, triangle.at, _size(triangle.step), result.at, _size(result.step)
    )


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
