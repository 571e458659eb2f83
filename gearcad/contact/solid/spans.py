"""Equal sectors in a row, condensed to the cuts at both ends, for motions that are even or odd under a half turn.

The turn about the middle of a row changes its ends (see `half_turn`), so the cut behind tells all: F u are the forces there
where the cut ahead moves by the same u, turned, or by its opposite. A row is doubled, or goes on both sides of another one: any
number of sectors is a few steps away, and a cut between two equal rows is solved in two halves, for its own even and odd parts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.dense import solved_rows
from gearcad.contact.solid.fronts import Blocks
from gearcad.contact.solid.half_turn import PARITIES
from gearcad.threads import on_all_cores

__all__ = ["Inside", "Reversal", "Span", "eliminated", "joined"]


@dataclass(frozen=True)
class Reversal:
    """What the half turn makes of the dofs of a cut: those of `image` (n,), by `signs` (n,)."""

    image: Wholes
    signs: Floats

    def rows(self, values: Floats) -> Floats:
        """Values (n, ...) after the turn."""
        result: Floats = values[self.image] * self.signs.reshape(-1, *[1] * (values.ndim - 1))
        return result

    def both(self, matrix: Floats) -> Floats:
        """A matrix (n, n), its rows and columns after the turn."""
        return self.rows(self.rows(matrix).T).T

    @cached_property
    def _pairs(self) -> tuple[Wholes, Wholes]:
        """Dofs (m,) of two that change places, the first of each, and those that stay."""
        every = np.arange(len(self.image))
        return every[every < self.image], every[every == self.image]

    def part(self, values: Floats, parity: int) -> Floats:
        """Of values (n, ...) the even or odd part in an orthonormal basis of these."""
        first, alone = self._pairs
        alone = alone[self.signs[alone] == PARITIES[parity]]
        turned = PARITIES[parity] * self.signs[first].reshape(-1, *[1] * (values.ndim - 1)) * values[self.image[first]]
        return np.concatenate([(values[first] + turned) / np.sqrt(2), values[alone]])

    def whole(self, part: Floats, parity: int) -> Floats:
        """The values (n, m) of a part."""
        first, alone = self._pairs
        alone = alone[self.signs[alone] == PARITIES[parity]]
        values = np.zeros((len(self.image), part.shape[1]))
        values[first] = part[: len(first)] / np.sqrt(2)
        values[self.image[first]] = PARITIES[parity] * self.signs[first, None] * values[first]
        values[alone] = part[len(first) :]
        return values


@dataclass(frozen=True)
class Span:
    """So many `teeth` in a row: symmetric matrices (n + hub, n + hub), even and odd, on the cut behind and the hub.

    The hub's dofs are seen from the middle of the row; those of the other parity are left out, with zeros in their place.
    `seen` turns them to what one sees who is so many teeth ahead.
    """

    matrices: tuple[Floats, Floats]
    teeth: int
    reversal: Reversal
    seen: Callable[[float], Floats]
    hub_parities: Floats

    @property
    def cut(self) -> int:
        """Dofs of one cut."""
        return len(self.reversal.image)

    @property
    def near(self) -> Floats:
        """Forces (n, n + hub) at the cut behind by displacements of it and the hub, the other one held."""
        n, (even, odd) = self.cut, self.matrices
        return np.hstack([(even[:n, :n] + odd[:n, :n]) / 2, even[:n, n:] + odd[:n, n:]])

    @property
    def far(self) -> Floats:
        """Forces (n, n + hub) at the cut ahead by the same, after the turn."""
        n, (even, odd) = self.cut, self.matrices
        return np.hstack([(even[:n, :n] - odd[:n, :n]) / 2, even[:n, n:] - odd[:n, n:]])

    @property
    def hub(self) -> Floats:
        """Matrix (hub, hub) of the hub, both cuts held."""
        n, (even, odd) = self.cut, self.matrices
        result: Floats = 2 * (even[n:, n:] + odd[n:, n:])
        return result

    def matrix(self) -> Floats:
        """Matrix on [cut behind, cut ahead, hub]."""
        n, near, ahead = self.cut, self.near, self.reversal.rows(self.far)
        return np.block(
            [
                [near[:, :n], ahead[:, :n].T, near[:, n:]],
                [ahead[:, :n], self.reversal.both(near[:, :n]), ahead[:, n:]],
                [near[:, n:].T, ahead[:, n:].T, self.hub],
            ]
        )

    def ends(self, aside: float) -> Floats:
        """On the cut behind and the hub of a row that begins with this one, the cut ahead held: `aside` teeth is its middle."""
        n, near, turn = self.cut, self.near, self.seen(-aside)
        across = near[:, n:] @ turn
        return np.block([[near[:, :n], across], [across.T, turn.T @ self.hub @ turn]])

    def inward(self, aside: float) -> Floats:
        """Forces (n, n + hub) at the cut ahead by the cut behind and the hub of such a row."""
        far = self.reversal.rows(self.far)
        far[:, self.cut :] = far[:, self.cut :] @ self.seen(-aside)
        return far

    def pushed(self, ends: Floats, aside: float) -> Floats:
        """Forces (n, m) at the cut ahead by displacements of the cut behind and the hub (n + hub, m): as by `inward`."""
        n, (even, odd) = self.cut, self.matrices
        given = np.concatenate([ends[:n] / 2, self.seen(-aside) @ ends[n:]])
        return self.reversal.rows(even[:n] @ given - odd[:n] @ given)

    def repeated(self, times: int) -> Span:
        """So many of this row."""
        if times == 1:
            return self
        half = self.repeated(times // 2)
        return joined(half, self if times % 2 else None)[0]


@dataclass(frozen=True)
class Inside:
    """How the first cut inside a row that begins with `side` follows its ends; `aside` teeth is the row's middle.

    `lower` are L (see `dense`) with L L.T the matrices of that cut, even and odd, `hub` (n, hub) what else is between it and
    the hub; None where the row has only `side` twice, and `lower` are of the even and the odd part of the cut.
    """

    side: Span
    aside: float
    lower: tuple[Floats, Floats]
    hub: tuple[Floats, Floats] | None

    def moved(self, ends: Floats, parity: int) -> Floats:
        """Displacements (n, m) by those of the cut behind and the hub (n + hub, m)."""
        reversal, n = self.side.reversal, self.side.cut
        force = self.side.pushed(ends, self.aside)
        if self.hub is not None:
            force += self.hub[parity] @ ends[n:]
            return -solved_rows(self.lower[parity], force)
        part = reversal.part(force, parity)
        return -reversal.whole(solved_rows(self.lower[parity], part), parity)


def joined(side: Span, middle: Span | None) -> tuple[Span, Inside]:
    """A row on both sides of another one, or of none."""
    teeth = 2 * side.teeth + (0 if middle is None else middle.teeth)
    n, aside, reversal = side.cut, (teeth - side.teeth) / 2, side.reversal

    def of(parity: int) -> tuple[Floats, Floats]:
        ends, inward, near = side.ends(aside), side.inward(aside), side.near[:, :n]
        if middle is None:
            inner = reversal.part(reversal.part(near, parity).T, parity)
            lower, matrix = eliminated(inner, reversal.part(inward, parity), ends)
        else:
            given = middle.matrices[parity]
            inward[:, n:] += given[:n, n:]
            ends[n:, n:] += given[n:, n:]
            lower, matrix = eliminated(reversal.both(near) + given[:n, :n], inward, ends)
        others = n + np.flatnonzero(side.hub_parities != PARITIES[parity])
        matrix[others] = 0.0
        matrix[:, others] = 0.0
        return lower, matrix

    lowers, matrices = zip(*on_all_cores(of, (0, 1)), strict=True)
    whole = Span((matrices[0], matrices[1]), teeth, reversal, side.seen, side.hub_parities)
    hub = None if middle is None else (middle.matrices[0][:n, n:].copy(), middle.matrices[1][:n, n:].copy())
    return whole, Inside(side, aside, (lowers[0], lowers[1]), hub)


def eliminated(inner: Floats, across: Floats, ends: Floats) -> tuple[Floats, Floats]:
    """L (see `dense`) of a symmetric matrix (n, n), and the one (m, m) at the `ends` without its dofs.

    `across` (n, m) is between both.
    """
    from gearcad.contact.solid.assembling import fill_upper

    blocks = Blocks(*(np.asfortranarray(each) for each in (inner.T, across, ends.T))).eliminated()
    fill_upper(blocks.rest)
    return blocks.own, blocks.rest
