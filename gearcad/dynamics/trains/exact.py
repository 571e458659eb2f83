"""Natural frequencies without discretisation: dynamic stiffness, and the count of Wittrick and Williams. In SI units.

W. H. Wittrick, F. W. Williams, A general algorithm for computing natural frequencies of elastic structures, Quart. J. Mech.
Appl. Math. 24 (1971): as many natural frequencies are below omega as the dynamic stiffness matrix has negative eigenvalues, and
the members with both ends clamped have natural frequencies below it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.dynamics.trains.parts import Parts
from gearcad.dynamics.trains.shafts import (
    clamped_modes_below,
    dynamic_inertia,
    dynamic_stiffness,
)
from gearcad.errors import SolverError

__all__ = ["SPLIT", "DynamicTrain", "dynamic_train", "natural_frequencies", "natural_shapes"]


SPLIT = (3 - math.sqrt(5)) / 2
"""A shaft with mass is cut here, so that no mode has all nodes at rest: whole half waves on both sides are impossible."""

_SAME = 1e-10
"""Relative: frequencies that are one, of several modes."""

_DOUBLINGS = 200
_HALVINGS = 200
"""More than any start needs to reach, or to tell, neighbouring floats."""


@dataclass(frozen=True, eq=False)
class DynamicTrain:
    """Nodes - the inertias, then the cuts of shafts - with `inertia` (n,), `meshes` (n, m), and the pieces of shafts between.

    `pieces` (p, 2) are the places of each piece's shaft, and of the piece on it: 0 or 1, or 0 for a shaft of one piece.
    `ends` (p, 2, n) pick the nodes at both ends of a piece, none for ground. `free` (n, r) are the turns of what nothing holds.
    """

    parts: Parts
    inertia: Floats
    meshes: Floats
    pieces: tuple[tuple[int, int], ...]
    ends: Floats
    piece_stiffness: Floats
    piece_inertia: Floats
    free: Floats

    def stiffness(self, omega: Floats) -> Floats:
        """Dynamic stiffness (q, n, n) at each of omega (q,)."""
        own = dynamic_stiffness(self.piece_stiffness, self.piece_inertia, omega[:, None])
        result: Floats = self._joined(own)
        result -= np.multiply.outer(omega**2, np.diag(self.inertia))
        result += (self.meshes * self.parts.stiffness) @ self.meshes.T
        return result

    def moving_inertia(self, omega: float) -> Floats:
        """(n, n): its quadratic form is the modal mass of a shape, the shafts' own motion included."""
        own = dynamic_inertia(self.piece_stiffness, self.piece_inertia, omega)
        return np.diag(self.inertia) + self._joined(own)

    def _joined(self, own: Floats) -> Floats:
        """(..., n, n): the matrices (..., p, 2, 2) of all pieces, put together."""
        result: Floats = (self.ends.transpose(0, 2, 1) @ own @ self.ends).sum(axis=-3)
        return result

    def count_below(self, omega: Floats) -> NDArray[np.int64]:
        """(q,): how many natural frequencies are below each of omega (q,), above 0."""
        clamped = clamped_modes_below(self.piece_stiffness, self.piece_inertia, omega[:, None]).sum(axis=1)
        negative = (np.linalg.eigvalsh(self.stiffness(omega)) < 0).sum(axis=1)
        count: NDArray[np.int64] = clamped + negative
        return count


def dynamic_train(parts: Parts, *, massless: bool = False) -> DynamicTrain:
    """Of the parts, with the mass of their shafts or without."""
    nodes = len(parts.inertias)
    pieces, joined, matrices, free = [], [], [], list(parts.free)
    for place, (shaft, (start, end)) in enumerate(zip(parts.shafts, parts.ends.tolist(), strict=True)):
        k, inertia = shaft.stiffness, 0.0 if massless else shaft.inertia
        if not inertia:
            pieces.append((place, 0))
            joined.append((start, end))
            matrices.append((k, 0.0))
            continue
        pieces += [(place, 0), (place, 1)]
        joined += [(start, nodes), (nodes, end)]
        matrices += [(k / SPLIT, inertia * SPLIT), (k / (1 - SPLIT), inertia * (1 - SPLIT))]
        free.append(parts.free[max(start, end)])
        nodes += 1
    cuts = nodes - len(parts.inertias)
    stiffness, inertias = np.array(matrices).reshape(-1, 2).T
    # The row of ground, -1, is the last one and is left away.
    ends = np.eye(nodes + 1)[np.array(joined, dtype=np.int64).reshape(-1, 2), :nodes]
    return DynamicTrain(
        parts=parts,
        inertia=np.concatenate([parts.inertia, np.zeros(cuts)]),
        meshes=np.concatenate([parts.approach, np.zeros((cuts, parts.approach.shape[1]))]),
        pieces=tuple(pieces),
        ends=ends,
        piece_stiffness=stiffness,
        piece_inertia=inertias,
        free=np.array(free),
    )


def natural_frequencies(train: DynamicTrain, count: int) -> Floats:
    """The first natural frequencies (n,) in 1/s, as many as there are up to `count`, those that are 0 among them.

    Bisection by the count finds every one, multiple ones too, as exactly as rounding leaves the dynamic stiffness. Raises
    SolverError where it does not end.
    """
    rigid = train.free.shape[1]
    if not train.piece_inertia.any():
        count = min(count, len(train.inertia))
    ranks = np.arange(rigid, count)
    if not len(ranks):
        return np.zeros(min(rigid, count))
    low, high = np.zeros(len(ranks)), np.full(len(ranks), _above(train, count))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if ((middle <= low) | (middle >= high)).all():
            return np.concatenate([np.zeros(rigid), high])
        below = train.count_below(middle) > ranks
        low, high = np.where(below, low, middle), np.where(below, middle, high)
    raise SolverError("bisection of natural frequencies did not end")


def _above(train: DynamicTrain, count: int) -> float:
    """A frequency (1/s) with `count` natural frequencies below it."""
    k = np.trace((train.meshes * train.parts.stiffness) @ train.meshes.T) + train.piece_stiffness.sum()
    omega = math.sqrt(float(k) / train.inertia.sum())
    for _ in range(_DOUBLINGS):
        if int(train.count_below(np.array([omega]))[0]) >= count:
            return omega
        omega *= 2
    raise SolverError(f"no {count} natural frequencies were found below {omega:g} 1/s")


def natural_shapes(train: DynamicTrain, omega: Floats) -> Floats:
    """Turns of the nodes (n, modes) at natural frequencies that `natural_frequencies` found, each of modal mass 1."""
    rigid = int((omega == 0).sum())
    shapes = np.zeros((len(train.inertia), len(omega)))
    if rigid:
        shapes[:, :rigid] = _of_mass_one(train.free, train.moving_inertia(0.0))
    first = rigid
    while first < len(omega):
        last = first + int((omega[first:] <= omega[first] * (1 + _SAME)).sum())
        mean = float(omega[first:last].mean())
        values, vectors = np.linalg.eigh(train.stiffness(np.array([mean]))[0])
        null = vectors[:, np.argsort(np.abs(values))[: last - first]]
        shapes[:, first:last] = _of_mass_one(null, train.moving_inertia(mean))
        first = last
    return shapes


def _of_mass_one(shapes: Floats, inertia: Floats) -> Floats:
    """Shapes of the same space (n, r), orthogonal by the inertia and of modal mass 1."""
    lower = np.linalg.cholesky(shapes.T @ inertia @ shapes)
    result: Floats = np.linalg.solve(lower, shapes.T).T
    return result
