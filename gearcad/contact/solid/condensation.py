"""Static condensation of a sector to its cuts, for even and odd motions, and loads carried through the fronts.

Each front has only what is its own and what it hands on, so nothing is as large as all dofs, and many loads go at once: rows
are those of a node together, and products of matrices are wide.

Half the sector goes part by part, once for both; then the nodes between the halves go, for each parity. Of two nodes that
change places one stands for both; of the cuts that is the one behind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from threading import Lock
from typing import NamedTuple

import numpy as np

from gearcad.contact.solid.dissection import PARITIES, TURNED, ElementBlock, HalfTurn, Halves, front_flops
from gearcad.contact.solid.fronts import Blocks, Elimination, EliminationStep, Store, node_dofs
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.core.runtime import Share, on_all_cores

Solved = list[Floats | None]
"""Front by front what `forward` gives; None where no load gets."""


@dataclass(frozen=True)
class FrontTree:
    """Fronts in the order in which they went, of a mesh of so many `nodes`; the nodes `top` (n,), sorted, are left."""

    fronts: tuple[EliminationStep, ...]
    top: Wholes
    nodes: int

    def forward(self, loads: Floats, at: Wholes) -> tuple[Solved, Floats]:
        """Return loads (3 k, m) at nodes (k,) in the form that `backward` needs, and what is left of them on top (3 n, m)."""
        given, count = loads.reshape(len(at), -1), loads.shape[1]
        owned, place = self._grouped(at), self._place[at]
        waiting: dict[int, Floats] = {}
        found: Solved = []

        def arrived(number: int) -> Floats:
            right = waiting.pop(number) if number in waiting else np.zeros((self._sizes[number], 3 * count))
            if (ours := owned.get(number)) is not None:
                right[place[ours]] += given[ours]
            return right

        for number, front in enumerate(self.fronts):
            if number not in owned and number not in waiting:
                found.append(None)
                continue
            right, own, above = arrived(number), len(front.own), self._above[number]
            front.forward(right.reshape(-1, count))
            found.append(right[:own].copy().reshape(-1, count))
            if above not in waiting:
                waiting[above] = np.zeros((self._sizes[above], 3 * count))
            waiting[above][self._places[number]] += right[own:]
        return found, arrived(len(self.fronts)).reshape(-1, count)

    def backward(self, top: Floats, loads: Sequence[tuple[slice, Solved]], nodes: Wholes) -> Floats:
        """Return the displacements (3 n, m) of nodes by those on top (3 k, m), and by what `forward` gave for some of the
        columns.

        They are 0 for nodes that nobody has.
        """
        count, wanted, place = top.shape[1], self._grouped(nodes), self._place[nodes]
        found = np.zeros((len(nodes), 3 * count))
        known = {len(self.fronts): top.reshape(len(self.top), -1)}
        needed = self._needed(wanted)
        followers = np.bincount(self._above[needed], minlength=len(self.fronts) + 1)

        def tell(number: int) -> None:
            if (ours := wanted.get(number)) is not None:
                found[ours] = known[number][place[ours]]
            if not followers[number]:
                del known[number]

        tell(len(self.fronts))
        for number in needed[::-1].tolist():
            front, above = self.fronts[number], int(self._above[number])
            own, moved = len(front.own), np.zeros((self._sizes[number], 3 * count))
            np.take(known[above], self._places[number], axis=0, out=moved[own:], mode="clip")
            for columns, solved in loads:
                if (ours := solved[number]) is not None:
                    moved[:own].reshape(-1, count)[:, columns] = ours
            front.backward(moved.reshape(-1, count))
            known[number] = moved
            followers[above] -= 1
            if not followers[above]:
                del known[above]
            tell(number)
        return found.reshape(-1, count)

    def has(self, nodes: Wholes) -> Bools:
        """Return which of some nodes (n,) belong to a front or to the top."""
        result: Bools = self._owner[nodes] >= 0
        return result

    @cached_property
    def _owner(self) -> Wholes:
        """The front that has each node as its own; one more where it is on top, -1 where nobody has it."""
        owner = np.full(self.nodes, -1)
        for number, front in enumerate(self.fronts):
            owner[front.own] = number
        owner[self.top] = len(self.fronts)
        return owner

    @cached_property
    def _place(self) -> Wholes:
        """Place (nodes,) of each node among those of its owner."""
        place = np.zeros(self.nodes, int)
        for nodes in (*(front.own for front in self.fronts), self.top):
            place[nodes] = np.arange(len(nodes))
        return place

    @cached_property
    def _sizes(self) -> list[int]:
        """Nodes of each front, and of the top."""
        return [*(len(front.own) + len(front.aside) for front in self.fronts), len(self.top)]

    @cached_property
    def _above(self) -> Wholes:
        """The front to which each one hands on: the first of those that have any of its nodes aside."""
        return np.array([self._owner[front.aside].min() for front in self.fronts], int)

    @cached_property
    def _places(self) -> list[Wholes]:
        """Places of the nodes aside of each front among those of the front to which it hands on."""
        found, places = [], np.zeros(self.nodes, int)
        for front, above in zip(self.fronts, self._above.tolist(), strict=True):
            every = self.top if above == len(self.fronts) else np.r_[self.fronts[above].own, self.fronts[above].aside]
            places[every] = np.arange(len(every))
            found.append(places[front.aside])
        return found

    def _grouped(self, nodes: Wholes) -> dict[int, Wholes]:
        """Return which of some nodes (n,) each front has as its own."""
        owner = self._owner[nodes]
        order = np.argsort(owner, kind="stable")
        numbers, first = np.unique(owner[order], return_index=True)
        found = dict(zip(numbers.tolist(), np.split(order, first[1:]), strict=True))
        found.pop(-1, None)
        return found

    def _needed(self, wanted: dict[int, Wholes]) -> Wholes:
        """Fronts, in order, without which displacements of what some have as their own cannot be told."""
        needed = np.zeros(len(self.fronts) + 1, bool)
        needed[list(wanted)] = True
        for number, above in enumerate(self._above.tolist()):
            needed[above] |= needed[number]
        return np.flatnonzero(needed[:-1])


class Forward(NamedTuple):
    """What `Condensed.backward` needs of loads: fronts of the half (None: no load gets there), and both on top of it."""

    half: Solved
    top: tuple[Floats, Floats]

    def dot(self, other: Forward) -> tuple[Floats, Floats]:
        """Return the sums over all fronts of products, even and odd (n, m):
        of loads (n) with displacements by the others (m).
        """
        result = []
        for parity in (0, 1):
            total = self.top[parity].T @ other.top[parity]
            for one, two in zip(self.half, other.half, strict=True):
                if one is not None and two is not None:
                    total += _of(one, parity).T @ _of(two, parity)
            result.append(total)
        return result[0], result[1]

    def times(self, even: Floats, odd: Floats) -> Forward:
        """Return the loads combined by factors (n, m) for the even and the odd ones of n loads."""
        both = (even, odd)
        half = [None if one is None else np.hstack([_of(one, p) @ both[p] for p in (0, 1)]) for one in self.half]
        return Forward(half, (self.top[0] @ even, self.top[1] @ odd))

    def plus(self, other: Forward) -> Forward:
        """Return the sum of both."""
        half = [_sum(one, two) for one, two in zip(self.half, other.half, strict=True)]
        return Forward(half, (self.top[0] + other.top[0], self.top[1] + other.top[1]))


def _sum(one: Floats | None, two: Floats | None) -> Floats | None:
    if one is None or two is None:
        return two if one is None else one
    return one + two


def _of(both: Floats, parity: int) -> Floats:
    count = both.shape[1] // 2
    return both[:, parity * count : (parity + 1) * count]


@dataclass(frozen=True)
class _Orbits:
    """The nodes `top` (n,), sorted, that the half leaves: some `between` both and at the `cut` behind, and those for which they
    stand as well: `moved`.
    """

    turn: HalfTurn
    top: Wholes
    between: Wholes
    cut: Wholes
    moved: Wholes

    @cached_property
    def every(self) -> Wholes:
        """The nodes between, then those at the cut."""
        result: Wholes = np.r_[self.between, self.cut]
        return result

    @cached_property
    def places(self) -> Wholes:
        """Places (nodes,) in `every` of the nodes that stand for those of the mesh; -1 for all others."""
        places = np.full(len(self.turn.nodes), -1)
        places[self.every] = np.arange(len(self.every))
        standing: Wholes = self.turn.nodes[self.moved]
        places[self.moved] = places[standing]
        return places

    def gathered(self, left: Floats, parity: int) -> Floats:
        """Return the loads (3 k, m) at the nodes of `every` from loads (n, 3, m) at those on top."""
        right = left[np.searchsorted(self.top, self.every)]
        right[self.places[self.moved]] += PARITIES[parity] * TURNED[:, None] * left[np.searchsorted(self.top, self.moved)]
        result: Floats = np.ascontiguousarray(right).reshape(-1, left.shape[-1])
        result[self.still(parity)] = 0.0
        return result

    def scattered(self, moved: Floats, parity: int) -> Floats:
        """Return the displacements (n, 3, ...) of the nodes on top from those (k, 3, ...) of `every`."""
        spread = np.zeros((len(self.top), *moved.shape[1:]))
        spread[np.searchsorted(self.top, self.every)] = moved
        turned = (PARITIES[parity] * TURNED).reshape(-1, *[1] * (moved.ndim - 2))
        spread[np.searchsorted(self.top, self.moved)] = turned * moved[self.places[self.moved]]
        return spread

    def signs(self, parity: int) -> Floats:
        """Return the signs (dofs,) of all dofs of the mesh as multiples of those that stand for them."""
        signs = np.ones((len(self.turn.nodes), 3))
        signs[self.moved] = PARITIES[parity] * TURNED
        return signs.ravel()

    def still(self, parity: int) -> Wholes:
        """Return the dofs, among those of every node, of nodes on the axis that do not move."""
        alone = np.flatnonzero(self.turn.on_axis[self.between])
        return node_dofs(alone).reshape(-1, 3)[:, PARITIES[parity] * TURNED < 0].ravel()


@dataclass(frozen=True)
class Condensed:
    """The elimination: fronts of the half, and for even and odd motions those on top of it."""

    orbits: _Orbits
    half: FrontTree
    top: tuple[EliminationStep, EliminationStep]

    def forward(self, loads: Floats, nodes: Wholes) -> tuple[Forward, tuple[Floats, Floats]]:
        """Return loads (3 k, m) at nodes (k,) in the form that `backward` needs, and those that arrive at the cut.

        The latter are (n, m) for each of both parities.
        """
        orbits, count = self.orbits, loads.shape[1]
        some = loads.reshape(len(nodes), -1).any(axis=1)
        nodes, half = nodes[some], loads.reshape(-1, 3, 1, count)[some] / 2
        images = orbits.turn.nodes[nodes]
        near = np.union1d(nodes, images)
        both = np.zeros((len(near), 3, 2, count))
        both[np.searchsorted(near, nodes)] = half
        both[np.searchsorted(near, images)] += half * TURNED[:, None, None] * PARITIES[:, None]
        both[orbits.turn.on_axis[near]] /= 2
        both[np.isin(near, orbits.moved)] = 0.0
        found, left = self.half.forward(both.reshape(-1, 2 * count), near)
        top, arrived = [], []
        for parity in (0, 1):
            right = orbits.gathered(left.reshape(-1, 3, 2, count)[:, :, parity], parity)
            self.top[parity].forward(right)
            solved, cut = np.split(right, [3 * len(orbits.between)])
            top.append(solved)
            arrived.append(cut)
        return Forward(found, (top[0], top[1])), (arrived[0], arrived[1])

    def backward(
        self, loads: Sequence[Forward | None], cuts: Sequence[tuple[Floats, Floats]], nodes: Wholes
    ) -> Iterator[Floats]:
        """For some teeth displacements (3 n, m) of nodes by those of the cut behind, of both parities, and by loads, if any."""
        orbits, teeth, count = self.orbits, len(cuts), cuts[0][0].shape[1]
        own = 3 * len(orbits.between)
        spread = np.zeros((len(orbits.top), 3, teeth, 2, count))
        for parity in (0, 1):
            moved = np.zeros((3 * len(orbits.every), teeth, count))
            for tooth, (given, cut) in enumerate(zip(loads, cuts, strict=True)):
                moved[own:, tooth] = cut[parity]
                if given is not None:
                    moved[:own, tooth] = given.top[parity]
            self.top[parity].backward(moved.reshape(-1, teeth * count))
            spread[:, :, :, parity] = orbits.scattered(moved.reshape(-1, 3, teeth, count), parity)
        loaded = [
            (slice(2 * count * tooth, 2 * count * (tooth + 1)), given.half)
            for tooth, given in enumerate(loads)
            if given is not None
        ]
        here = self.half.has(nodes)
        of_half = np.where(here, nodes, orbits.turn.nodes[nodes])
        found = self.half.backward(spread.reshape(-1, 2 * teeth * count), loaded, of_half)
        vectors = found.reshape(-1, 3, teeth, 2, count)
        signs = np.where(here[:, None], 1.0, TURNED)[..., None]
        odd = np.where(here, 1.0, -1.0)[:, None, None]
        for tooth in range(teeth):
            even = vectors[:, :, tooth, 0]
            yield (signs * (even + odd * vectors[:, :, tooth, 1])).reshape(-1, count)


def condense(
    turn: HalfTurn, halves: Halves, cut: Wholes, matrices_of: Callable[[ElementBlock], Floats], tell: Share
) -> tuple[Condensed, tuple[Floats, Floats]]:
    """Eliminate all nodes but those of the cut behind, `cut` (n,), and what the turn makes of them.

    Second the matrices for even and odd motions that are left on the dofs of the cut behind. Those of the cut ahead are these
    after the turn, or their opposites. The energy of a motion is the sum over both of u.T F u.

    `matrices_of` gives the matrices (m, 60, 60) of the hexahedra of a box; nodes that no part has are held. Raises SolverError
    for a matrix that is not positive definite.
    """
    from gearcad.contact.solid.kernels import add_block, add_hexahedra, fill_upper

    over, lock = 0.0, Lock()

    def done(flops: float) -> None:
        nonlocal over
        with lock:
            over += flops
            tell(min(over / halves.flops, 1.0))

    def nodes_of(box: ElementBlock) -> Wholes:
        return box.nodes(turn.mesh)

    store, between, ends = Store(halves.factors), 3 * len(halves.between), 3 * len(cut)
    elimination = Elimination(turn.mesh.nodes, nodes_of, matrices_of, store, done)
    matrix, orbits, applied = elimination.on_all_cores(halves.half), _orbits(turn, halves, cut), np.ones(1)
    given = []
    for parity in (0, 1):
        blocks = Blocks(store.zeros(between, between), store.zeros(ends, between).T, np.zeros((ends, ends), order="F"))
        signs = orbits.signs(parity)
        here = signs[node_dofs(halves.half.aside)]
        matrix *= (here * applied)[:, None]
        matrix *= here * applied
        applied = here
        add_block(matrix, orbits.places[halves.half.aside], *blocks)
        if halves.middle is not None:
            nodes = nodes_of(halves.middle)
            turned = signs[node_dofs(nodes)]
            add_hexahedra(turned[:, :, None] * matrices_of(halves.middle) * turned[:, None] / 2, orbits.places[nodes], *blocks)
        _hold(blocks, orbits.still(parity))
        given.append(blocks)
    del matrix

    def eliminated(blocks: Blocks) -> tuple[EliminationStep, Floats]:
        own, across, rest = blocks.eliminated()
        fill_upper(rest)
        done(front_flops(len(halves.between), len(cut)))
        return EliminationStep(halves.between, cut, own, across), rest

    (even, of_even), (odd, of_odd) = on_all_cores(eliminated, given)
    half = FrontTree(tuple(elimination.fronts), orbits.top, turn.mesh.nodes)
    return Condensed(orbits, half, (even, odd)), (of_even, of_odd)


def _orbits(turn: HalfTurn, halves: Halves, cut: Wholes) -> _Orbits:
    every, stand = halves.half.aside, np.r_[halves.between, cut]
    if halves.middle is not None:
        every = np.union1d(every, halves.middle.nodes(turn.mesh))
    moved = every[~np.isin(every, stand) & np.isin(turn.nodes[every], stand)]
    return _Orbits(turn, np.union1d(stand, moved), halves.between, cut, moved)


def _hold(blocks: Blocks, dofs: Wholes) -> None:
    """Let nothing move dofs (n,) of their own."""
    blocks.own[dofs] = blocks.across[dofs] = 0.0
    blocks.own[:, dofs] = 0.0
    blocks.own[dofs, dofs] = 1.0
