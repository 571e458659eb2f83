"""Frictionless contact of a gear pair at one position: pressures on all pairs of flanks that can touch, and the approach.

Everything is per mm of face width, in the transverse section.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.contact.plane.flank import FlankCompliance
from gearcad.errors import SolverError

__all__ = ["Cells", "ContactPair", "ContactSolution", "solve_contact"]


_ROUNDS = 100
_FREE_ROUNDS = 30
"""Rounds after which the active set changes one cell at a time, which cannot cycle."""


@dataclass(frozen=True)
class Cells:
    """Cells of constant pressure on one pair of flanks, `place` (mm) along the common tangent from the line of action.

    `pinion` and `wheel` are the roll lengths (mm) that face each other there, `gap` their distance (mm) before loading.
    """

    place: Floats
    width: float
    pinion: Floats
    wheel: Floats
    gap: Floats


@dataclass(frozen=True)
class ContactPair:
    """A pair of flanks: tooth `tooth` of the pinion (0 is the middle one), its contact at roll length `pinion` (mm).

    `added_curvature` (1/mm) is what modified flanks have more than the two involutes, where they come nearest.
    """

    tooth: int
    pinion: float
    wheel: float
    cells: Cells
    added_curvature: float = 0.0

    @property
    def radius(self) -> float:
        """Reduced radius of curvature (mm); infinite where one flank is hollower than the other is round."""
        curvature = (self.pinion + self.wheel) / (self.pinion * self.wheel) + self.added_curvature
        return 1 / curvature if curvature > 0 else math.inf


@dataclass(frozen=True)
class ContactSolution:
    """Pressures (MPa) by pair and cell, and the approach of the flanks along the line of action (mm).

    `parts` are the pinion's and the wheel's shares of the approach; what is left is gaps that were closed.
    """

    pairs: tuple[ContactPair, ...]
    pressures: tuple[Floats, ...]
    approach: float
    parts: tuple[float, float]

    @property
    def forces(self) -> Floats:
        """Normal force on each pair (N per mm)."""
        return np.array([pressure.sum() * pair.cells.width for pair, pressure in zip(self.pairs, self.pressures, strict=True)])


def solve_contact(
    pairs: tuple[ContactPair, ...], pinion: FlankCompliance, wheel: FlankCompliance, force: float
) -> ContactSolution:
    """Press the gears together with the normal force `force` (N per mm of width)."""
    sizes = [len(pair.cells.place) for pair in pairs]
    width = np.concatenate([np.full(size, pair.cells.width) for size, pair in zip(sizes, pairs, strict=True)])
    gap = np.concatenate([pair.cells.gap for pair in pairs])
    matrices = [compliance_matrix(pairs, body, gear) for gear, body in enumerate((pinion, wheel))]
    pressure, approach = complementary(matrices[0] + matrices[1], gap * width, width, force)
    first, second = (float(pressure @ matrix @ pressure) / force for matrix in matrices)
    return ContactSolution(pairs, tuple(np.split(pressure, np.cumsum(sizes)[:-1])), approach, (first, second))


def compliance_matrix(pairs: tuple[ContactPair, ...], body: FlankCompliance, gear: int) -> Floats:
    """Displacement of the flank of the pinion (0) or wheel (1) over cell i, times its width, by the pressure on cell j.

    (n, n) in mm^2/MPa.
    """
    matrix = np.block([[_block(moved, loaded, body, gear) for loaded in pairs] for moved in pairs])
    result: Floats = (matrix + matrix.T) / 2
    return result


def _block(moved: ContactPair, loaded: ContactPair, body: FlankCompliance, gear: int) -> Floats:
    # Seen from the wheel the teeth follow each other the other way round.
    apart = (moved.tooth - loaded.tooth) * (1, -1)[gear]
    if abs(apart) > body.neighbours:
        return np.zeros((len(moved.cells.place), len(loaded.cells.place)))
    places, loads = ((pair.cells.pinion, pair.cells.wheel)[gear] for pair in (moved, loaded))
    block = body.response(apart)(places, loads) * (moved.cells.width * loaded.cells.width)
    return block + _edge_block(moved.cells, body) if body.edge_taken_off and not apart else block


def _edge_block(cells: Cells, body: FlankCompliance) -> Floats:
    """The straight edge's part: k(d) integrated over both cells in closed form."""
    log = -2 / (np.pi * body.elasticity.modulus)
    constant = -(1 + body.elasticity.ratio) / (np.pi * body.elasticity.modulus)
    apart, h = cells.place[:, None] - cells.place, cells.width
    result: Floats = log * (_second(apart + h) - 2 * _second(apart) + _second(apart - h)) + constant * h * h
    return result


def _second(x: Floats) -> Floats:
    """Twice integrated ln|x|: x^2/2 (ln|x| - 3/2)."""
    size = np.abs(x)
    result: Floats = np.where(size > 0, x * x / 2 * (np.log(np.where(size > 0, size, 1.0)) - 1.5), 0.0)
    return result


def complementary(matrix: Floats, gap: Floats, width: Floats, force: float) -> tuple[Floats, float]:
    """p >= 0, C p + g - delta w >= 0, complementary, w.p = F, by a primal-dual active set. Raises SolverError."""
    active = np.ones(len(width), bool)
    for count in range(_ROUNDS):
        pressure, approach = _equations(matrix, gap, width, force, active)
        opening = (matrix @ pressure + gap) / width - approach
        wrong = np.where(active, pressure <= 0, opening < -1e-12)
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
    system[:count, :count] = matrix[np.ix_(rows, rows)]
    system[:count, count] = system[count, :count] = -width[rows]
    solved = np.linalg.solve(system, np.r_[-gap[rows], -force])
    pressure = np.zeros(len(width))
    pressure[rows] = solved[:count]
    return pressure, float(solved[count])
