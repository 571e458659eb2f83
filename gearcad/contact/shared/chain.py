"""Substructures: equal tooth sectors in a row, condensed to the cuts at both ends (static condensation, Guyan 1965).

That makes a full ring as cheap as a few teeth.

The dofs of a cut are radial, tangential and, in solid bodies, axial, node by node, so the matrices of all sectors are the same
and need no turning.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats

__all__ = ["Chain", "Cuts", "condensed", "cut_held", "polar_turn"]


class Cuts(Enum):
    """What holds the outer cuts of a body that is not a full ring."""

    FIXED = "fixed"
    SLIDING = "sliding"
    FREE = "free"


@dataclass(frozen=True)
class Chain:
    """Sectors in a row, condensed: symmetric matrix on [cut behind, cut ahead, hub] (N/mm, N, N mm).

    The hub's dofs are its turn, or the forces with which it follows the body (see `support`), as the first sector sees them;
    `onward` turns them to what the sector after the last one sees. In the plane all of it is per mm of width.
    """

    matrix: Floats
    onward: Floats = field(default_factory=lambda: np.eye(1))

    @property
    def cut(self) -> int:
        """Dofs of one cut."""
        return (len(self.matrix) - len(self.onward)) // 2

    @cached_property
    def _double(self) -> Chain:
        return self.followed_by(self)

    def followed_by(self, other: Chain) -> Chain:
        """This chain and the other one ahead of it, the cut between them condensed."""
        n, hub = self.cut, len(self.onward)
        keep = 2 * n + hub  # behind, ahead, hub, and last the cut between
        both = np.zeros((keep + n, keep + n))
        first = np.r_[0:n, keep : keep + n, 2 * n : keep]
        second = np.r_[keep : keep + n, n : 2 * n, 2 * n : keep]
        both[np.ix_(first, first)] += self.matrix
        both[np.ix_(second, second)] += other.seen(self.onward)
        return Chain(condensed(both, keep), other.onward @ self.onward)

    def seen(self, turn: Floats) -> Floats:
        """The matrix on the hub's dofs from which `turn` makes those that the first sector sees."""
        hub = len(self.onward)
        matrix = self.matrix.copy()
        matrix[:, -hub:] = matrix[:, -hub:] @ turn
        matrix[-hub:] = turn.T @ matrix[-hub:]
        return matrix

    def repeated(self, times: int) -> Chain:
        """So many of this chain in a row, by doubling."""
        result, power = None, self
        while times:
            if times & 1:
                result = power if result is None else result.followed_by(power)
            times >>= 1
            power = power._double if times else power
        assert result is not None  # times is at least 1
        return result

    def ended(self, cuts: Cuts, radii: Floats, *, ahead: bool) -> Floats:
        """This chain, ahead of other sectors or behind them, its far cut held: matrix on [the cut to them, turn of the hub].

        `radii` (mm) are those of the nodes of a cut. The hub is one that turns with the bore.
        """
        n, components = self.cut, self.cut // len(radii)
        near, far = (np.arange(n), np.arange(n, 2 * n)) if ahead else (np.arange(n, 2 * n), np.arange(n))
        tangential = np.arange(n) % components == 1
        kept = far[~cut_held(cuts, n, components)]
        motions = np.zeros((2 * n + 1, n + 1 + len(kept)))
        motions[near, np.arange(n)] = 1
        motions[-1, n] = 1
        motions[kept, n + 1 + np.arange(len(kept))] = 1
        if cuts is not Cuts.FREE:
            motions[far[tangential], n] = radii
        return condensed(motions.T @ self.matrix @ motions, n + 1)


def polar_turn(angles: Floats, components: int) -> Any:
    """Matrix (scipy CSR) from radial and tangential dofs of nodes at `angles` (n,) in rad to those along x and y.

    Of three `components` the third, along the axis, stays. An angle of 0 leaves a node as it is.
    """
    import scipy.sparse

    cosine, sine = np.cos(angles), np.sin(angles)
    diagonal = np.stack([cosine, cosine, *(components - 2) * [np.ones(len(angles))]], -1).ravel()
    upper, lower = np.zeros(len(diagonal) - 1), np.zeros(len(diagonal) - 1)
    upper[::components], lower[::components] = -sine, sine
    return scipy.sparse.diags([diagonal, upper, lower], [0, 1, -1], format="csr")


def cut_held(cuts: Cuts, dofs: int, components: int) -> NDArray[np.bool_]:
    """Which dofs (n,) of a cut are held."""
    if cuts is Cuts.SLIDING:
        tangential: NDArray[np.bool_] = np.arange(dofs) % components == 1
        return tangential
    return np.full(dofs, cuts is Cuts.FIXED)


def condensed(matrix: Floats, keep: int) -> Floats:
    """The symmetric matrix with the dofs from `keep` on free of load."""
    inner = np.linalg.solve(matrix[keep:, keep:], matrix[keep:, :keep])
    reduced: Floats = matrix[:keep, :keep] - matrix[:keep, keep:] @ inner
    return (reduced + reduced.T) / 2
