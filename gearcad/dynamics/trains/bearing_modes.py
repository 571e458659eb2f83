"""The natural modes of a pair on bearings: what travels, what turns, and where their energy is."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from gearcad.arrays import Bools, Floats, freeze

__all__ = ["BearingModes", "modes_on_bearings"]


_SHAKEN = 1e-6
"""Share of its potential energy that the mesh must hold for teeth to shake a mode."""

_MOST = 0.5
"""Share of turning in the kinetic energy, or of the mesh in the potential one, from which on gears turn against each other."""

_BOTH = 0.5
"""Of the greater: travel of the other gear, by its kinetic energy, from which on both gears are said to travel."""

_STRAIGHT = 0.8
"""Of the kinetic energy of a gear's travel: what is one way or the other, and not oblique."""


@dataclass(frozen=True, eq=False)
class BearingModes:
    """The six natural modes of two gears on bearings, without damping, at the mean stiffness of the mesh, by rising frequency.

    `frequency` (6,) in Hz, `circular` in 1/s; the first is 0: the gears turn as a whole. `shape` (6, 6): of each mode how far
    the pinion travels along the line of action, across it, and turns (as the way at the base circle), then the same of the
    wheel, over the farthest of these; the flanks approach each other where the mesh gives way. `kinetic` (6, 6) are the shares
    of these in the kinetic energy, `potential` (6, 3) those of the mesh and of the bearings of pinion and wheel in the
    potential one: nothing in the first mode.
    """

    frequency: Floats
    circular: Floats
    shape: Floats
    kinetic: Floats
    potential: Floats

    def __post_init__(self) -> None:
        freeze(self)

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def shaken(self) -> Bools:
        """Which of the modes (6,) teeth can shake: those in which the mesh gives way."""
        return np.asarray(self.potential[:, 0] > _SHAKEN, bool)

    @property
    def excited(self) -> Floats:
        """Circular frequencies (6,) of those, 0 of the others."""
        return np.where(self.shaken, self.circular, 0.0)

    @property
    def words(self) -> tuple[str, ...]:
        """Of each mode, what moves most."""
        return tuple("both gears turn as a whole" if mode == 0 else self._words(mode) for mode in range(len(self)))

    def to_dict(self) -> dict[str, Any]:
        """Plain lists, under the names of the fields, and the words."""
        return {**{each.name: getattr(self, each.name).tolist() for each in fields(self)}, "words": list(self.words)}

    def _words(self, mode: int) -> str:
        shares = self.kinetic[mode].reshape(2, 3)
        if max(shares[:, 2].sum(), self.potential[mode, 0]) >= _MOST:
            return "gears turn against each other"
        travels = shares[:, :2]
        most = int(travels.sum(axis=1).argmax())
        ways = travels[most] / travels[most].sum()
        way = "along" if ways[0] > _STRAIGHT else "across" if ways[1] > _STRAIGHT else "obliquely to"
        if travels[1 - most].sum() < _BOTH * travels[most].sum():
            return f"{('pinion', 'wheel')[most]} travels {way} the line of action"
        moved = self.shape[mode].reshape(2, 3)[:, int(ways.argmax())]
        return f"both gears travel {'together' if moved.prod() > 0 else 'against each other'}, {way} the line of action"


def modes_on_bearings(stiffness: Floats, masses: Floats, springs: Floats, radii: tuple[float, float]) -> BearingModes:
    """Of a stiffness matrix (6, 6) of travels along and across and turns of both gears, in N/m and N·m/rad.

    `masses` (6,) in kg and kg·m²; `springs` (3, 6, 6) are the parts of it that mesh and bearings have; `radii` (m) those of the
    base circles.
    """
    root = np.sqrt(masses)
    squares, modes = _apart(stiffness / np.outer(root, root))
    order = np.argsort(squares, kind="stable")
    squares, moved = squares[order], (modes[:, order] / root[:, None]).T
    squares[0] = 0.0  # but for rounding: nothing holds the gears' turning
    way = moved * np.array([1.0, 1.0, radii[0], 1.0, 1.0, radii[1]])
    farthest = way[np.arange(6), np.abs(way).argmax(axis=1)]
    energy = np.einsum("nr,prs,ns->np", moved, springs, moved)
    energy[0] = 0.0
    potential = np.divide(energy, squares[:, None], out=np.zeros_like(energy), where=squares[:, None] > 0)
    omega = np.sqrt(squares)
    shape = way / farthest[:, None] + 0.0  # no -0
    return BearingModes(omega / (2 * np.pi), omega, shape, masses * moved**2, potential)


def _apart(matrix: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues and vectors, of coordinates that know nothing of each other by themselves: alike ones are not mixed."""
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(matrix != 0, directed=False)
    values, vectors = np.zeros(len(matrix)), np.zeros_like(matrix)
    for part in range(count):
        own = np.flatnonzero(label == part)
        values[own], vectors[np.ix_(own, own)] = np.linalg.eigh(matrix[np.ix_(own, own)])
    return values, vectors
