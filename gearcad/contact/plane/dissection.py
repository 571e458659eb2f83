"""A sector of triangles condensed to its cuts by nested dissection: elements are halved, and halved again, until few are left.

Nodes go with the smallest part that has all their elements, and leave their stiffness, and loads, to those around them. Fronts
are dense, and small enough for the inverse of what goes to be kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.errors import SolverError

__all__ = ["Arrived", "Dissected", "dissect", "node_dofs"]


_FEW = 24
"""Elements of a part that is not divided further."""


def node_dofs(nodes: Wholes) -> Wholes:
    """Dofs (..., 2 n) of nodes (..., n)."""
    return (2 * nodes[..., None] + np.arange(2)).reshape(*nodes.shape[:-1], 2 * nodes.shape[-1])


class _Front(NamedTuple):
    """One step: dofs that go, those that take over their load, the inverse of the matrix of the first, that times the matrix
    across.
    """

    own: Wholes
    aside: Wholes
    inverse: Floats
    across: Floats


class Arrived(NamedTuple):
    """Loads (kept, m) that arrive at the dofs that are kept, and what each front makes of them: None where none get there.

    `work` (m, m) is that of the loads on the displacements that they cause while nothing moves at the dofs that are kept.
    """

    loads: Floats
    moved: list[Floats | None]
    work: Floats


@dataclass(frozen=True)
class Dissected:
    """What is left of a mesh of so many `dofs`: its `matrix` on the dofs `kept`, which go up."""

    dofs: int
    kept: Wholes
    matrix: Floats
    fronts: list[_Front]

    def forward(self, loads: Floats) -> Arrived:
        """Loads (dofs, m) moved to the dofs that are kept."""
        left, moved = loads.copy(), list[Floats | None]()
        loaded: Bools = np.any(loads, axis=1)
        work = np.zeros((loads.shape[1], loads.shape[1]))
        for own, aside, inverse, across in self.fronts:
            if not loaded[own].any():
                moved.append(None)
                continue
            here = left[own]
            left[aside] -= across.T @ here
            loaded[aside] = True
            by_load: Floats = inverse @ here
            moved.append(by_load)
            work += here.T @ by_load
        return Arrived(left[self.kept], moved, work)

    def backward(self, at_kept: Floats, arrived: Arrived | None = None) -> Floats:
        """Displacements (dofs, m) by those of the dofs that are kept (kept, m), and by loads; none of what is held."""
        found = np.zeros((self.dofs, at_kept.shape[1]))
        found[self.kept] = at_kept
        by_loads = arrived.moved if arrived is not None else [None] * len(self.fronts)
        for (own, aside, _, across), given in zip(reversed(self.fronts), reversed(by_loads), strict=True):
            here = across @ found[aside]
            found[own] = -here if given is None else given - here
        return found


def dissect(points: Floats, triangles: Wholes, matrices: Floats, kept: Wholes, held: Wholes) -> Dissected:
    """Condense elements (m, 6) of nodes at `points` (n, 2) with their `matrices` (m, 12, 12), in x and y, to the nodes `kept`.

    Nodes `held` do not move. Raises SolverError where the others could move without a force.
    """
    order = _ordered(points[triangles[:, :3]].mean(axis=1), np.arange(len(triangles)))
    return _Dissection(triangles[order], matrices[order], len(points), kept, held).condensed()


def _ordered(centres: Floats, chosen: Wholes) -> Wholes:
    """Elements in an order in which each half is on one side of a line, across the length of where they are."""
    if len(chosen) <= _FEW:
        return chosen
    away = centres[chosen] - centres[chosen].mean(axis=0)
    (xx, xy), (_, yy) = away.T @ away
    angle = np.arctan2(2 * xy, xx - yy) / 2
    middle = len(chosen) // 2
    order = np.argpartition(away @ [np.cos(angle), np.sin(angle)], middle)
    result: Wholes = np.r_[_ordered(centres, chosen[order[:middle]]), _ordered(centres, chosen[order[middle:]])]
    return result


class _Left(NamedTuple):
    """The nodes (k,) that a part leaves, and the matrix (2 k, 2 k) on their dofs."""

    nodes: Wholes
    matrix: Floats


class _Dissection:
    """Elements in the order of their parts, and which of them are the first and the last that have each node."""

    def __init__(self, triangles: Wholes, matrices: Floats, nodes: int, kept: Wholes, held: Wholes) -> None:
        self.triangles, self.matrices, self.nodes = triangles, matrices, nodes
        number = np.arange(len(triangles)).repeat(triangles.shape[1])
        self.first, self.last = np.full(nodes, len(triangles)), np.full(nodes, -1)
        self.first[triangles.ravel()[::-1]] = number[::-1]
        self.last[triangles.ravel()] = number
        self.last[kept] = len(triangles)  # nothing has all of their elements
        self.free: Bools = np.ones(nodes, bool)
        self.free[held] = False
        self.places = np.zeros(nodes, int)
        self.fronts: list[_Front] = []

    def condensed(self) -> Dissected:
        """All of it."""
        try:
            nodes, matrix = self._eliminated(0, len(self.triangles))
        except np.linalg.LinAlgError as error:
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised ({error})") from error
        return Dissected(2 * self.nodes, node_dofs(nodes), matrix, self.fronts)

    def _eliminated(self, begin: int, end: int) -> _Left:
        """What the elements from `begin` to before `end` leave."""
        parts: list[_Left] = []
        if end - begin > _FEW:
            middle = begin + (end - begin) // 2
            parts = [self._eliminated(begin, middle), self._eliminated(middle, end)]
            every = np.unique(np.concatenate([part.nodes for part in parts]))
        else:
            every = np.unique(self.triangles[begin:end])
            every = every[self.free[every]]
        going = (self.first[every] >= begin) & (self.last[every] < end)
        own, aside = every[going], every[~going]
        self.places[own], self.places[aside] = np.arange(len(own)), np.arange(len(own), len(every))
        matrix = self._joined(parts, len(every)) if parts else self._summed(begin, end, len(every))
        count = 2 * len(own)
        rest = matrix[count:, count:]
        if count:
            inverse = np.asarray(np.linalg.inv(matrix[:count, :count]), float)
            across = inverse @ matrix[:count, count:]
            rest = rest - matrix[count:, :count] @ across
            self.fronts.append(_Front(node_dofs(own), node_dofs(aside), inverse, across))
        return _Left(aside, rest)

    def _joined(self, parts: list[_Left], count: int) -> Floats:
        """The matrix (2 n, 2 n) on so many nodes by what parts have left."""
        dofs = [node_dofs(self.places[part.nodes]) for part in parts]
        entries = [(2 * count * each[:, None] + each).ravel() for each in dofs]
        return _matrix(np.concatenate(entries), np.concatenate([part.matrix.ravel() for part in parts]), 2 * count)

    def _summed(self, begin: int, end: int, count: int) -> Floats:
        """The same by elements; what is held comes after the others, and is left out."""
        triangles, size = self.triangles[begin:end], 2 * count
        dofs = node_dofs(np.where(self.free[triangles], self.places[triangles], count))
        entries = ((size + 2) * dofs[:, :, None] + dofs[:, None]).ravel()
        return _matrix(entries, self.matrices[begin:end].ravel(), size + 2)[:size, :size]


def _matrix(entries: Wholes, values: Floats, size: int) -> Floats:
    """A matrix (size, size) of the sums of values at entries, which are counted row by row."""
    result: Floats = np.bincount(entries, values, size * size).astype(float, copy=False)
    return result.reshape(size, size)
