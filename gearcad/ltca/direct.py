"""Direct solution of large sparse symmetric positive systems: MKL Pardiso where pypardiso is installed, else SuperLU."""

from __future__ import annotations

import weakref
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from gearcad.errors import SolverError

__all__ = ["Factor", "factorise"]

Floats = NDArray[np.float64]

_BATCH = 64
"""Right-hand sides solved at once: more need memory and bring nothing."""


class Factor(Protocol):
    """A factorised matrix."""

    def solve(self, right: Floats) -> Floats:
        """Solutions (n, m) for right-hand sides (n, m)."""


def factorise(matrix: Any) -> Factor:
    """Factorise a sparse symmetric positive definite matrix. Raises SolverError."""
    try:
        import pypardiso  # noqa: F401
    except ImportError:
        return _SuperLU(matrix)
    return _Pardiso(matrix)


class _SuperLU:
    def __init__(self, matrix: Any) -> None:
        import scipy.sparse.linalg

        try:
            self._factor = scipy.sparse.linalg.splu(
                matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True}
            )
        except RuntimeError as error:
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised ({error})") from error

    def solve(self, right: Floats) -> Floats:
        result: Floats = self._factor.solve(right)
        return result


class _Pardiso:
    _POSITIVE_DEFINITE = 2

    def __init__(self, matrix: Any) -> None:
        import pypardiso
        import scipy.sparse

        self._upper = scipy.sparse.triu(matrix, format="csr")
        self._solver = pypardiso.PyPardisoSolver(mtype=self._POSITIVE_DEFINITE)
        try:
            self._solver.factorize(self._upper)
        except pypardiso.pardiso_wrapper.PyPardisoError as error:
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised ({error})") from error

        # Memory of MKL is not Python's: it goes with this object, but not while the interpreter itself goes.
        weakref.finalize(self, self._solver.free_memory, everything=True).atexit = False

    def solve(self, right: Floats) -> Floats:
        solved = np.empty_like(right)
        for start in range(0, right.shape[1], _BATCH):
            part = np.asfortranarray(right[:, start : start + _BATCH])
            solved[:, start : start + _BATCH] = self._solver.solve(self._upper, part).reshape(part.shape)
        return solved
