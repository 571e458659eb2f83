"""Frictionless contact as a linear complementarity problem: the pressures of cells whose sum is given, by an active set."""

from __future__ import annotations

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Floats

_COMPLEMENTARITY_ROUNDS = 30
"""Rounds in which all wrong cells change at once: few suffice, or none does."""

_COMPLEMENTARITY_STEPS = 20
"""Largest number of steps of one cell each, per cell. Each step lowers the energy, so no set of cells comes back."""

_OPEN = -1e-12
"""Opening (mm) below which cells overlap by more than rounding."""


def complementary(matrix: Floats, gap: Floats, width: Floats, force: float, start: Bools | None = None) -> tuple[Floats, float]:
    """p >= 0, C p + g - delta w >= 0, complementary, w.p = F, by a primal-dual active set. Raises SolverError.

    The set is sought from the cells that press at the `start`, else from all: what is found is the same.
    """
    active = np.ones(len(width), bool) if start is None or not start.any() else start
    for _ in range(_COMPLEMENTARITY_ROUNDS):
        pressure, approach = _equations(matrix, gap, width, force, active)
        wrong = np.where(active, pressure <= 0, (matrix @ pressure + gap) / width - approach < _OPEN)
        if not wrong.any():
            return pressure, approach
        active = active ^ wrong
        if not active.any():
            active[np.argmin(gap / width)] = True
    return _cell_by_cell(_positive(matrix), gap, width, force)


def _positive(matrix: Floats) -> Floats:
    """Return the matrix with no eigenvalue below the size of a negative one, which is the error of all."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    if values[0] > 0:
        return matrix
    return np.asarray((vectors * np.maximum(values, -values[0])) @ vectors.T)


def _cell_by_cell(matrix: Floats, gap: Floats, width: Floats, force: float) -> tuple[Floats, float]:
    """Solve by an active set of the energy's least value under constraints, from one cell that carries all on."""
    first = int(np.argmin(gap / width))
    pressure, active = np.zeros(len(width)), np.zeros(len(width), bool)
    pressure[first], active[first] = force / width[first], True
    for _ in range(_COMPLEMENTARITY_STEPS * len(width)):
        wanted, approach = _equations(matrix, gap, width, force, active)
        lifted = active & (wanted <= 0)
        if lifted.any():
            parts = np.where(lifted, pressure / np.where(lifted, pressure - wanted, 1.0), np.inf)
            pressure = np.maximum(pressure + parts.min() * (wanted - pressure), 0.0)
            off = lifted & (parts <= parts.min())
            pressure[off], active = 0.0, active & ~off
            continue
        pressure, opening = wanted, np.where(active, 0.0, (matrix @ wanted + gap) / width - approach)
        if opening.min() >= _OPEN:
            return pressure, approach
        active[np.argmin(opening)] = True
    raise SolverError(
        "the contact did not converge: no set of cells carries the load without overlap; "
        "change load.torque or check.refinement slightly"
    )


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
