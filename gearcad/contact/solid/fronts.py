"""Elimination part by part (multifrontal Cholesky): nodes go and leave their stiffness, and loads, to those around them.

Fronts are dense, and BLAS works in place: matrices lie column by column, of symmetric ones the lower triangle, loads row by
row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from threading import Lock
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.dense import factorise, solve_above, solve_aside, subtract_product, subtract_square
from gearcad.contact.solid.dissection import Box, SolidPart
from gearcad.errors import SolverError
from gearcad.threads import on_all_cores

__all__ = ["Blocks", "Elimination", "Front", "Store", "node_dofs"]


_APART = 0.5
"""Of all operations, the most in a part that is eliminated beside others."""


def node_dofs(nodes: Wholes) -> Wholes:
    """Dofs (..., 3 n) of nodes (..., n)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


@dataclass(frozen=True)
class Front:
    """One step: nodes that go, those that take over their load, L of the matrix of the first, L^-1 times that across.

    Loads and displacements are rows, three of each node, its own nodes first.
    """

    own: Wholes
    aside: Wholes
    lower: Floats
    across: Floats

    def forward(self, loads: Floats) -> None:
        """Make L^-1 times the loads of its own nodes, and what is left of them for the others, of loads (n, m)."""
        solved, left = np.split(loads.T, [3 * len(self.own)], axis=1)  # rows of C are columns of Fortran
        solve_aside(self.lower, solved, transposed=True)
        subtract_product(left, solved, self.across, transposed=False)

    def backward(self, moved: Floats) -> None:
        """Make displacements of its own nodes of what `forward` made there - 0 where there is no load - and of the others'."""
        solved, aside = np.split(moved.T, [3 * len(self.own)], axis=1)
        subtract_product(solved, aside, self.across, transposed=True)
        solve_aside(self.lower, solved, transposed=False)


class Blocks(NamedTuple):
    """A symmetric matrix on dofs that go and others: [[own, across], [across.T, rest]]."""

    own: Floats
    across: Floats
    rest: Floats

    def eliminated(self) -> Blocks:
        """L (see `dense`), L^-1 across, and the matrix on the others, all in place.

        Raises SolverError if it is not positive definite.
        """
        if not len(self.own):
            return self
        if failed := factorise(self.own):
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised (its minor {failed})")
        if len(self.rest):
            solve_above(self.own, self.across)
            subtract_square(self.across, self.rest)
        return self


class Store:
    """Memory of matrices that stay: one piece for so many numbers, which the system gets back as a whole."""

    def __init__(self, numbers: int) -> None:
        self._left, self._lock = np.zeros(numbers), Lock()

    def zeros(self, rows: int, columns: int) -> Floats:
        """A matrix (rows, columns)."""
        with self._lock:
            taken, self._left = np.split(self._left, [rows * columns])
        return taken.reshape(rows, columns, order="F")


class _Room:
    """Memory of matrices that have gone, for those to come: what the system gives is cleared page by page, and slow."""

    def __init__(self) -> None:
        self._left: list[Floats] = []

    def zeros(self, size: int) -> Floats:
        """A matrix (size, size)."""
        fitting = [each for each in self._left if each.size >= size**2]
        if fitting:
            chosen = min(fitting, key=len)
            self._drop(chosen)
            chosen[: size**2] = 0.0
        else:
            if self._left:
                self._drop(max(self._left, key=len))
            chosen = np.zeros(size**2)
        return chosen[: size**2].reshape(size, size, order="F")

    def _drop(self, chosen: Floats) -> None:
        self._left = [each for each in self._left if each is not chosen]

    def take_back(self, matrix: Floats) -> None:
        """One that `zeros` gave, which nobody needs any more."""
        base = matrix.base
        assert base is not None
        self._left.append(base)


@dataclass
class Elimination:
    """Of the parts of a mesh of so many `nodes`: `nodes_of` gives those (m, 20) of the hexahedra of a box, `matrices_of` their
    matrices (m, 60, 60). What stays is in `store`; `done` hears the operations of each part.
    """

    nodes: int
    nodes_of: Callable[[Box], Wholes]
    matrices_of: Callable[[Box], Floats]
    store: Store
    done: Callable[[float], None]
    fronts: list[Front] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._places = np.full(self.nodes, -1)  # but for the nodes of the part that is put together
        self._room = _Room()

    def on_all_cores(self, part: SolidPart) -> Floats:
        """`eliminated`, the greater parts of it side by side."""
        apart = _apart(part, _APART * part.all_flops)

        def work(each: SolidPart) -> tuple[list[Front], Floats]:
            helper = replace(self, fronts=[])
            return helper.fronts, helper.eliminated(each)

        known = {}
        for each, (fronts, matrix) in zip(apart, on_all_cores(work, apart), strict=True):
            self.fronts += fronts
            known[id(each)] = matrix
        matrix = self.eliminated(part, known)
        self._room = _Room()
        return matrix

    def eliminated(self, part: SolidPart, known: dict[int, Floats] | None = None) -> Floats:
        """The matrix, its lower triangle only, on the dofs of the nodes that a part leaves; `known` are those of some parts of
        it, by their identities, and go.
        """
        known = {} if known is None else known
        if id(part) in known:
            return known.pop(id(part))
        blocks = self._assembled(part, known).eliminated()
        if len(part.own):
            self.fronts.append(Front(part.own, part.aside, blocks.own, blocks.across))
        self.done(part.flops)
        return blocks.rest

    def _assembled(self, part: SolidPart, known: dict[int, Floats]) -> Blocks:
        from gearcad.contact.solid.assembling import add_block, add_hexahedra

        given = [(each, self.eliminated(each, known)) for each in part.parts]
        own, rest = 3 * len(part.own), 3 * len(part.aside)
        blocks = Blocks(self.store.zeros(own, own), self.store.zeros(own, rest), self._room.zeros(rest))
        every = np.r_[part.own, part.aside]
        self._places[every] = np.arange(len(every))
        while given:
            each, matrix = given.pop()
            add_block(matrix, self._places[each.aside], *blocks)
            self._room.take_back(matrix)
        if part.box is not None:
            add_hexahedra(self.matrices_of(part.box), self._places[self.nodes_of(part.box)], *blocks)
        self._places[every] = -1
        return blocks


def _apart(part: SolidPart, most: float) -> list[SolidPart]:
    """The parts of one, or of its parts, that are no more than so many operations."""
    if part.all_flops <= most or not part.parts:
        return [part]
    return [each for one in part.parts for each in _apart(one, most)]
