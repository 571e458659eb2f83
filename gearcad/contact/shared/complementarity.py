"""Frictionless contact as a linear complementarity problem: loads that press, gaps that open, never both in one place."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.errors import SolverError

__all__ = ["complementary"]


_ROUNDS = 100
_FREE_ROUNDS = 30
"""Rounds after which the active set changes one cell at a time, which cannot cycle."""

_OPEN = -1e-12
"""Opening (mm) below which cells overlap by more than rounding."""


def complementary(matrix: Floats, gap: Floats, width: Floats, force: float, start: Bools | None = None) -> tuple[Floats, float]:
    """p >= 0, C p + g - delta w >= 0, complementary, w.p = F, by a primal-dual active set. Raises SolverError.

    The set is sought from the cells that press at the `start`, else from all: what is found is the same.
    """
    active = np.ones(len(width), bool) if start is None or not start.any() else start
    for count in range(_ROUNDS):
        pressure, approach = _equations(matrix, gap, width, force, active)
        opening = (matrix @ pressure + gap) / width - approach
        wrong = np.where(active, pressure <= 0, opening < _OPEN)
        if not wrong.any():
            return pressure, approach
        if count < _FREE_ROUNDS:
            active = active ^ wrong
        else:
            worst = np.argmin(np.where(active, pressure, np.inf)) if wrong[active].any() else np.argmin(opening)
            active[worst] = not active[worst]
        if not active.any():
            active[np.argmin(gap / width)] = True
    raise SolverError(f"the contact did not settle within {_ROUNDS} rounds")


def _equations(matrix: Floats, gap: Floats, width: Floats, force: float, active: Bools) -> tuple[Floats, float]:
    rows = np.flatnonzero(active)
    count = len(rows)
    system = np.zeros((count + 1, count + 1))
    system[:count, :count] = matrix[rows[:, None], rows]
    system[:count, count] = system[count, :count] = -width[rows]
    right = np.full(count + 1, -force)
    right[:count] = -gap[rows]
    solved = np.linalg.solve(system, right)
    pressure = np.zeros(len(width))
    pressure[rows] = solved[:count]
    return pressure, float(solved[count])
