"""Elimination part by part (multifrontal Cholesky): nodes go and leave their stiffness, and loads, to those around them.

Fronts are dense, and BLAS works in place: matrices lie column by column, of symmetric ones the lower triangle, loads row by
row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.dissection import Box, SolidPart
from gearcad.errors import SolverError

__all__ = ["Blocks", "Elimination", "Front", "node_dofs"]


def node_dofs(nodes: Wholes) -> Wholes:
    """Dofs (..., 3 n) of nodes (..., n)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


@dataclass(frozen=True)
class Front:
    """One step: dofs that go, those that take over their load, L with L L.T the matrix of the first, L^-1 times that across."""

    own: Wholes
    aside: Wholes
    lower: Floats
    across: Floats

    def forward(self, left: Floats) -> Floats:
        """L^-1 times the loads (n, m) of its own dofs; those of all dofs, `left` (dofs, m), get what is left of them."""
        solved = self._solved(left[self.own], transposed=1)
        left[self.aside] -= self.across.T @ solved
        return solved

    def backward(self, solved: Floats | None, moved: Floats) -> None:
        """Displacements of its own dofs in those of all, `moved` (dofs, m), by what `forward` gave: None stands for no load."""
        right = self.across @ moved[self.aside]
        np.negative(right, out=right) if solved is None else np.subtract(solved, right, out=right)
        moved[self.own] = self._solved(right, transposed=0)

    def _solved(self, right: Floats, transposed: int) -> Floats:
        from scipy.linalg.blas import dtrsm

        # From the right: rows of C are columns of Fortran.
        turned: Floats = dtrsm(1.0, self.lower, right.T, side=1, lower=1, trans_a=transposed, overwrite_b=1)
        return turned.T


class Blocks(NamedTuple):
    """A symmetric matrix on dofs that go and others: [[own, across], [across.T, rest]]."""

    own: Floats
    across: Floats
    rest: Floats

    @classmethod
    def zeros(cls, own: int, rest: int) -> Blocks:
        """Of so many dofs."""
        return cls(*(np.zeros(shape, order="F") for shape in ((own, own), (own, rest), (rest, rest))))

    def eliminated(self) -> Blocks:
        """L, L^-1 across, and the matrix on the others, all in place. Raises SolverError if it is not positive definite."""
        from scipy.linalg.blas import dsyrk, dtrsm
        from scipy.linalg.lapack import dpotrf

        if not len(self.own):
            return self
        lower, failed = dpotrf(self.own, lower=1, clean=0, overwrite_a=1)
        if failed:
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised (its minor {failed})")
        if not len(self.rest):
            return Blocks(lower, self.across, self.rest)
        across = dtrsm(1.0, lower, self.across, lower=1, overwrite_b=1)
        return Blocks(lower, across, dsyrk(-1.0, across, beta=1.0, c=self.rest, trans=1, lower=1, overwrite_c=1))


@dataclass
class Elimination:
    """Of the parts of a mesh of so many `nodes`: `nodes_of` gives those (m, 20) of the hexahedra of a box, `matrices_of` their
    matrices (m, 60, 60). `done` hears the operations of each part.
    """

    nodes: int
    nodes_of: Callable[[Box], Wholes]
    matrices_of: Callable[[Box], Floats]
    done: Callable[[float], None]
    fronts: list[Front] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._places = np.full(self.nodes, -1)  # but for the nodes of the part that is put together

    def eliminated(self, part: SolidPart) -> Floats:
        """The matrix, its lower triangle only, on the dofs of the nodes that a part leaves."""
        blocks = self._assembled(part).eliminated()
        if len(part.own):
            self.fronts.append(Front(node_dofs(part.own), node_dofs(part.aside), blocks.own, blocks.across))
        self.done(part.flops)
        return blocks.rest

    def _assembled(self, part: SolidPart) -> Blocks:
        from gearcad.contact.solid.assembling import add_block, add_hexahedra

        given = [(each, self.eliminated(each)) for each in part.parts]
        blocks = Blocks.zeros(3 * len(part.own), 3 * len(part.aside))
        every = np.r_[part.own, part.aside]
        self._places[every] = np.arange(len(every))
        while given:
            each, matrix = given.pop()
            add_block(matrix, self._places[each.aside], *blocks)
        if part.box is not None:
            add_hexahedra(self.matrices_of(part.box), self._places[self.nodes_of(part.box)], *blocks)
        self._places[every] = -1
        return blocks
