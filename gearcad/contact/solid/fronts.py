"""Multifrontal Cholesky of a tooth sector, with dense factors by numpy, and equal sectors in a row.

Of symmetric matrices, and of factors, the lower triangle is there. A factor L has the inverses of the blocks on its diagonal in
their place: all that it solves is then products of matrices. Products let other threads run, and are made a block at a time, so
that little memory is needed beside the matrices.

Fronts are dense. Symmetric matrices lie column by column, loads and what is across row by row.

The turn about the middle of a row changes its ends (see `half_turn`), so the cut behind tells all: F u are the forces there
where the cut ahead moves by the same u, turned, or by its opposite. A row is doubled, or goes on both sides of another one: any
number of sectors is a few steps away, and a cut between two equal rows is solved in two halves, for its own even and odd parts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from threading import Lock
from typing import NamedTuple

import numpy as np

from gearcad.contact.solid.dissection import PARITIES, ElementBlock, SolidPart
from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, Wholes
from gearcad.core.runtime import on_all_cores

_BLOCK = 192
"""Rows of a block on the diagonal of a factor."""


def factorise(matrix: Floats) -> int:
    """Make L with L L.T of a matrix (n, n) that lies column by column; else return which leading minor is not positive."""
    from scipy.linalg.lapack import dpotrf, dtrtri

    upper = matrix.T
    for first, last in _blocks(len(matrix)):
        upper[first:last, first:] -= upper[:first, first:last].T @ upper[:first, first:]
        lower, failed = dpotrf(matrix[first:last, first:last], lower=True)
        if failed:
            return first + int(failed)
        inverse = dtrtri(lower, lower=True)[0]
        matrix[first:last, first:last] = inverse
        upper[first:last, last:] = inverse @ upper[first:last, last:]
    return 0


def solve_lower(lower: Floats, right: Floats) -> None:
    """Make L^-1 R of R (n, m)."""
    for first, last in _blocks(len(lower)):
        right[first:last] -= lower[first:last, :first] @ right[:first]
        right[first:last] = lower[first:last, first:last] @ right[first:last]


def solve_upper(lower: Floats, right: Floats) -> None:
    """Make L^-T R of R (n, m)."""
    for first, last in reversed(_blocks(len(lower))):
        right[first:last] -= lower[last:, first:last].T @ right[last:]
        right[first:last] = lower[first:last, first:last].T @ right[first:last]


def solved_rows(lower: Floats, right: Floats) -> Floats:
    """Return (L L.T)^-1 R of R (n, m), row by row."""
    result = np.array(right, order="C")
    solve_lower(lower, result)
    solve_upper(lower, result)
    return result


def subtract_square(across: Floats, rest: Floats) -> None:
    """Make C - A.T A of C (m, m), which lies column by column, and A (n, m)."""
    upper = rest.T
    for first, last in _blocks(len(rest)):
        block = across[:, first:last].T
        upper[first:last, first:last] -= block @ block.T
        upper[first:last, last:] -= block @ across[:, last:]


def _blocks(rows: int) -> list[tuple[int, int]]:
    """Return the first row, and the one after the last, of each block on the diagonal."""
    return [(first, min(first + _BLOCK, rows)) for first in range(0, rows, _BLOCK)]


_APART = 0.5
"""Largest share of all operations in a part that is eliminated beside other parts."""


def node_dofs(nodes: Wholes) -> Wholes:
    """Return the dofs (..., 3 n) of nodes (..., n)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


@dataclass(frozen=True)
class EliminationStep:
    """One step: nodes that go, those that take over their load, L of the matrix of the first, L^-1 times that across.

    Loads and displacements are rows, three of each node, its own nodes first.
    """

    own: Wholes
    aside: Wholes
    lower: Floats
    across: Floats

    def forward(self, loads: Floats) -> None:
        """Make L^-1 times the loads of its own nodes, and what is left of them for the others, of loads (n, m)."""
        solved, left = np.split(loads, [3 * len(self.own)])
        solve_lower(self.lower, solved)
        left -= self.across.T @ solved

    def backward(self, moved: Floats) -> None:
        """Make displacements of its own nodes of what `forward` made there - 0 where there is no load - and of the others'."""
        solved, aside = np.split(moved, [3 * len(self.own)])
        solved -= self.across @ aside
        solve_upper(self.lower, solved)


class Blocks(NamedTuple):
    """A symmetric matrix on dofs that go and others: [[own, across], [across.T, rest]]."""

    own: Floats
    across: Floats
    rest: Floats

    def eliminated(self) -> Blocks:
        """L (see `factorise`), L^-1 across, and the matrix on the others, all in place.

        Raises SolverError if it is not positive definite.
        """
        if not len(self.own):
            return self
        if failed := factorise(self.own):
            raise SolverError(f"the stiffness matrix of a gear body could not be factorised (its minor {failed})")
        if len(self.rest):
            solve_lower(self.own, self.across)
            subtract_square(self.across, self.rest)
        return self


class Store:
    """Memory for matrices that are kept: one piece, which the system gets back as a whole."""

    def __init__(self, numbers: int) -> None:
        self._left, self._lock = np.zeros(numbers), Lock()

    def zeros(self, rows: int, columns: int) -> Floats:
        """Return a matrix (rows, columns) of zeros."""
        with self._lock:
            taken, self._left = np.split(self._left, [rows * columns])
        return taken.reshape(rows, columns, order="F")


class _Room:
    """Memory of matrices no longer needed, reused for new ones, because memory from the system is cleared page by page, which
    is slow.
    """

    def __init__(self) -> None:
        self._left: list[Floats] = []

    def zeros(self, size: int) -> Floats:
        """Return a matrix (size, size) of zeros."""
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
        """Take back a matrix that `zeros` gave and that is no longer needed."""
        base = matrix.base
        assert base is not None
        self._left.append(base)


@dataclass
class Elimination:
    """Of the parts of a mesh of so many `nodes`: `nodes_of` gives those (m, 20) of the hexahedra of a box, `matrices_of` their
    matrices (m, 60, 60). What stays is in `store`; `done` hears the operations of each part.
    """

    nodes: int
    nodes_of: Callable[[ElementBlock], Wholes]
    matrices_of: Callable[[ElementBlock], Floats]
    store: Store
    done: Callable[[float], None]
    fronts: list[EliminationStep] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._places = np.full(self.nodes, -1)  # but for the nodes of the part that is put together
        self._room = _Room()

    def on_all_cores(self, part: SolidPart) -> Floats:
        """`eliminated`, the greater parts of it side by side."""
        apart = _apart(part, _APART * part.all_flops)

        def work(each: SolidPart) -> tuple[list[EliminationStep], Floats]:
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
        """Return the matrix, its lower triangle only, on the dofs of the nodes that a part leaves; `known` are those of some
        parts of it, by their identities, and go.
        """
        known = {} if known is None else known
        if id(part) in known:
            return known.pop(id(part))
        blocks = self._assembled(part, known).eliminated()
        if len(part.own):
            self.fronts.append(EliminationStep(part.own, part.aside, blocks.own, blocks.across))
        self.done(part.flops)
        return blocks.rest

    def _assembled(self, part: SolidPart, known: dict[int, Floats]) -> Blocks:
        from gearcad.contact.solid.kernels import add_block, add_hexahedra

        given = [(each, self.eliminated(each, known)) for each in part.parts]
        own, rest = 3 * len(part.own), 3 * len(part.aside)
        blocks = Blocks(self.store.zeros(own, own), self.store.zeros(rest, own).T, self._room.zeros(rest))
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
    """Return the parts of one, or of its parts, that are no more than so many operations."""
    if part.all_flops <= most or not part.parts:
        return [part]
    return [each for one in part.parts for each in _apart(one, most)]


@dataclass(frozen=True)
class Reversal:
    """Effect of the half turn on the dofs of a cut: dof n becomes dof `image` (n,) times `signs` (n,)."""

    image: Wholes
    signs: Floats

    def rows(self, values: Floats) -> Floats:
        """Return the values (n, ...) after the turn."""
        result: Floats = values[self.image] * self.signs.reshape(-1, *[1] * (values.ndim - 1))
        return result

    def both(self, matrix: Floats) -> Floats:
        """Return a matrix (n, n), its rows and columns after the turn."""
        return self.rows(self.rows(matrix).T).T

    @cached_property
    def _pairs(self) -> tuple[Wholes, Wholes]:
        """Dofs (m,) of two that change places, the first of each, and those that stay."""
        every = np.arange(len(self.image))
        return every[every < self.image], every[every == self.image]

    def part(self, values: Floats, parity: int) -> Floats:
        """Return the even or odd part of values (n, ...) in an orthonormal basis of such values."""
        first, alone = self._pairs
        alone = alone[self.signs[alone] == PARITIES[parity]]
        turned = PARITIES[parity] * self.signs[first].reshape(-1, *[1] * (values.ndim - 1)) * values[self.image[first]]
        return np.concatenate([(values[first] + turned) / np.sqrt(2), values[alone]])

    def whole(self, part: Floats, parity: int) -> Floats:
        """Return the values (n, m) of a part."""
        first, alone = self._pairs
        alone = alone[self.signs[alone] == PARITIES[parity]]
        values = np.zeros((len(self.image), part.shape[1]))
        values[first] = part[: len(first)] / np.sqrt(2)
        values[self.image[first]] = PARITIES[parity] * self.signs[first, None] * values[first]
        values[alone] = part[len(first) :]
        return values


@dataclass(frozen=True)
class ToothSpan:
    """A row of `teeth` sectors: symmetric matrices (n + hub, n + hub), even and odd, on the cut behind and the hub.

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
        """Return the matrix on [cut behind, cut ahead, hub]."""
        n, near, ahead = self.cut, self.near, self.reversal.rows(self.far)
        return np.block(
            [
                [near[:, :n], ahead[:, :n].T, near[:, n:]],
                [ahead[:, :n], self.reversal.both(near[:, :n]), ahead[:, n:]],
                [near[:, n:].T, ahead[:, n:].T, self.hub],
            ]
        )

    def ends(self, aside: float) -> Floats:
        """Return the matrix on the cut behind and the hub of a row that begins with this one.

        The cut ahead is held. The row's middle is `aside` teeth away.
        """
        n, near, turn = self.cut, self.near, self.seen(-aside)
        across = near[:, n:] @ turn
        return np.block([[near[:, :n], across], [across.T, turn.T @ self.hub @ turn]])

    def inward(self, aside: float) -> Floats:
        """Return the forces (n, n + hub) at the cut ahead by the cut behind and the hub of such a row."""
        far = self.reversal.rows(self.far)
        far[:, self.cut :] = far[:, self.cut :] @ self.seen(-aside)
        return far

    def pushed(self, ends: Floats, aside: float) -> Floats:
        """Return the forces (n, m) at the cut ahead by displacements of the cut behind and the hub (n + hub, m): as by
        `inward`.
        """
        n, (even, odd) = self.cut, self.matrices
        given = np.concatenate([ends[:n] / 2, self.seen(-aside) @ ends[n:]])
        return self.reversal.rows(even[:n] @ given - odd[:n] @ given)

    def repeated(self, times: int) -> ToothSpan:
        """Return a row of `times` copies of this one."""
        if times == 1:
            return self
        half = self.repeated(times // 2)
        return joined(half, self if times % 2 else None)[0]


@dataclass(frozen=True)
class Inside:
    """Response of the first cut inside a row that begins with `side` to the row's ends; `aside` teeth is the row's middle.

    `lower` are L (see `factorise`) with L L.T the matrices of that cut, even and odd, `hub` (n, hub) what else is between it
    and the hub; None where the row has only `side` twice, and `lower` are of the even and the odd part of the cut.
    """

    side: ToothSpan
    aside: float
    lower: tuple[Floats, Floats]
    hub: tuple[Floats, Floats] | None

    def moved(self, ends: Floats, parity: int) -> Floats:
        """Return the displacements (n, m) by those of the cut behind and the hub (n + hub, m)."""
        reversal, n = self.side.reversal, self.side.cut
        force = self.side.pushed(ends, self.aside)
        if self.hub is not None:
            force += self.hub[parity] @ ends[n:]
            return -solved_rows(self.lower[parity], force)
        part = reversal.part(force, parity)
        return -reversal.whole(solved_rows(self.lower[parity], part), parity)


def joined(side: ToothSpan, middle: ToothSpan | None) -> tuple[ToothSpan, Inside]:
    """Return a row on both sides of another one, or of none."""
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
    whole = ToothSpan((matrices[0], matrices[1]), teeth, reversal, side.seen, side.hub_parities)
    hub = None if middle is None else (middle.matrices[0][:n, n:].copy(), middle.matrices[1][:n, n:].copy())
    return whole, Inside(side, aside, (lowers[0], lowers[1]), hub)


def eliminated(inner: Floats, across: Floats, ends: Floats) -> tuple[Floats, Floats]:
    """L (see `factorise`) of a symmetric matrix (n, n), and the one (m, m) at the `ends` without its dofs.

    `across` (n, m) is between both.
    """
    from gearcad.contact.solid.kernels import fill_upper

    blocks = Blocks(np.asfortranarray(inner.T), np.array(across), np.asfortranarray(ends.T)).eliminated()
    fill_upper(blocks.rest)
    return blocks.own, blocks.rest
