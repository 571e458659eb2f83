"""A sector condensed to its cuts (static condensation): part by part, nodes go and leave their load to those around them.

Fronts are dense (multifrontal Cholesky), and BLAS works in place: matrices lie column by column, loads row by row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.dissection import SolidPart
from gearcad.errors import SolverError
from gearcad.progress import Share, unheard

__all__ = ["Condensed", "condense", "node_dofs"]


def node_dofs(nodes: Wholes) -> Wholes:
    """Dofs (..., 3 n) of nodes (..., n)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


@dataclass(frozen=True)
class _Front:
    """One step: dofs that go, those that take over their load, L with L L.T the matrix of the first, L^-1 times that across."""

    own: Wholes
    aside: Wholes
    lower: Floats
    across: Floats

    def solved(self, loads: Floats) -> Floats:
        """L^-1 loads (n, m)."""
        return self._divided(loads, transposed=1)

    def moved(self, solved: Floats) -> Floats:
        """L^-T solved (n, m)."""
        return self._divided(solved, transposed=0)

    def _divided(self, right: Floats, transposed: int) -> Floats:
        from scipy.linalg.blas import dtrsm

        # From the right: rows of C are columns of Fortran.
        turned: Floats = dtrsm(1.0, self.lower, right.T, side=1, lower=1, trans_a=transposed, overwrite_b=1)
        return turned.T


@dataclass(frozen=True)
class Condensed:
    """The elimination, front by front, and what it leaves: the symmetric `matrix` on the dofs `kept`."""

    fronts: tuple[_Front, ...]
    kept: Wholes
    matrix: Floats

    def forward(self, loads: Floats) -> tuple[list[Floats], Floats]:
        """What `backward` needs of loads (dofs, m), and the loads (kept, m) that arrive at the dofs that are kept."""
        left, found = loads.copy(), []
        for front in self.fronts:
            solved = front.solved(left[front.own])
            left[front.aside] -= front.across.T @ solved
            found.append(solved)
        return found, left[self.kept]

    def backward(self, found: list[Floats] | None, moved: Floats) -> Floats:
        """Displacements (dofs, m); `moved` holds those of the kept dofs and is 0 elsewhere, `found` None stands for no load."""
        moved = moved.copy()
        for place in range(len(self.fronts) - 1, -1, -1):
            front = self.fronts[place]
            right = -(front.across @ moved[front.aside])
            if found is not None:
                right += found[place]
            moved[front.own] = front.moved(right)
        return moved


def condense(
    whole: SolidPart,
    nodes: int,
    hexahedra_of: Callable[[SolidPart], tuple[Wholes, Floats]],
    kept: Wholes,
    tell: Share = unheard,
) -> Condensed:
    """Eliminate all nodes but those of the dofs `kept`.

    `hexahedra_of` gives the nodes (m, 20) of the hexahedra of a part, of `nodes` in all, and their matrices (m, 60, 60); nodes
    that no part has are held. Raises SolverError for a matrix that is not positive definite.
    """
    elimination = _Elimination(np.full(nodes, -1), hexahedra_of, [], sum(part.flops for part in whole.every()), tell)
    matrix = elimination.eliminated(whole)
    place = np.searchsorted(node_dofs(whole.aside), kept)
    matrix += np.tril(matrix, -1).T
    return Condensed(tuple(elimination.fronts), kept, matrix[np.ix_(place, place)])


@dataclass
class _Elimination:
    """`places` are -1 for all nodes but while a part's are looked up, `done` of the operations `flops` are."""

    places: Wholes
    hexahedra_of: Callable[[SolidPart], tuple[Wholes, Floats]]
    fronts: list[_Front]
    flops: float
    tell: Share
    done: float = 0.0

    def eliminated(self, part: SolidPart) -> Floats:
        """The matrix, its lower triangle only, on the dofs of the nodes that a part leaves."""
        from scipy.linalg.blas import dsyrk, dtrsm
        from scipy.linalg.lapack import dpotrf

        own, across, rest = self._assembled(part)
        if len(own):
            lower, failed = dpotrf(own, lower=1, clean=0, overwrite_a=1)
            if failed:
                raise SolverError(f"the stiffness matrix of a gear body could not be factorised (its minor {failed})")
            across = dtrsm(1.0, lower, across, lower=1, overwrite_b=1)
            if len(rest):
                rest = dsyrk(-1.0, across, beta=1.0, c=rest, trans=1, lower=1, overwrite_c=1)
            self.fronts.append(_Front(node_dofs(part.own), node_dofs(part.aside), lower, across))
        self.done += part.flops
        self.tell(self.done / self.flops)
        return rest

    def _assembled(self, part: SolidPart) -> tuple[Floats, ...]:
        """The matrix of a part: that of its own dofs, that across and that of the others."""
        from gearcad.contact.solid.assembling import add_block, add_hexahedra

        given = [(half, self.eliminated(half)) for half in part.parts]
        count, others = 3 * len(part.own), 3 * len(part.aside)
        whole = tuple(np.zeros(shape, order="F") for shape in ((count, count), (count, others), (others, others)))
        every = np.r_[part.own, part.aside]
        self.places[every] = np.arange(len(every))
        while given:
            half, matrix = given.pop()
            add_block(matrix, self.places[half.aside], *whole)
        if not part.parts:
            nodes, matrices = self.hexahedra_of(part)
            add_hexahedra(matrices, self.places[nodes], *whole)
        self.places[every] = -1
        return whole
