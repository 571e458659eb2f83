"""A sector condensed to its cuts (static condensation), for even and odd motions each (see `half_turn`).

Half the sector goes part by part, once for both; then the nodes between the halves go, for each parity. Of two nodes that
change places one stands for both; of the cuts that is the one behind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from threading import Lock
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.contact.solid.dissection import Box, Halves, front_flops
from gearcad.contact.solid.fronts import Blocks, Elimination, Front, Store, node_dofs
from gearcad.contact.solid.half_turn import PARITIES, TURNED, HalfTurn
from gearcad.progress import Share
from gearcad.threads import on_all_cores

__all__ = ["Condensed", "Forward", "condense"]


class Forward(NamedTuple):
    """What `Condensed.backward` needs of loads: fronts of the half (None: no load gets there), and both on top of it."""

    half: list[Floats | None]
    top: tuple[Floats, Floats]

    def dot(self, other: Forward) -> tuple[Floats, Floats]:
        """Sums over all fronts of products, even and odd (n, m): of loads (n) with displacements by the others (m)."""
        result = []
        for parity in (0, 1):
            total = self.top[parity].T @ other.top[parity]
            for one, two in zip(self.half, other.half, strict=True):
                if one is not None and two is not None:
                    total += _of(one, parity).T @ _of(two, parity)
            result.append(total)
        return result[0], result[1]

    def times(self, even: Floats, odd: Floats) -> Forward:
        """By factors (n, m) for the even and the odd ones of n loads."""
        both = (even, odd)
        half = [None if one is None else np.hstack([_of(one, p) @ both[p] for p in (0, 1)]) for one in self.half]
        return Forward(half, (self.top[0] @ even, self.top[1] @ odd))

    def plus(self, other: Forward) -> Forward:
        """The sum."""
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
    """Nodes on top of the half, `between` both and at the `cut` behind, and those for which they stand as well: `moved`."""

    turn: HalfTurn
    between: Wholes
    cut: Wholes
    moved: Wholes

    @cached_property
    def standing(self) -> Wholes:
        """The nodes (n,) that stand for `moved`."""
        result: Wholes = self.turn.nodes[self.moved]
        return result

    @cached_property
    def places(self) -> Wholes:
        """Where the node that stands for each one of the mesh comes among those on top; -1 for all others."""
        places, every = np.full(len(self.turn.nodes), -1), np.r_[self.between, self.cut]
        places[every] = np.arange(len(every))
        places[self.moved] = places[self.standing]
        return places

    def signs(self, parity: int) -> Floats:
        """What all dofs (dofs,) of the mesh are of those that stand for them."""
        signs = np.ones((len(self.turn.nodes), 3))
        signs[self.moved] = PARITIES[parity] * TURNED
        return signs.ravel()

    def still(self, parity: int) -> Wholes:
        """Dofs of nodes on the axis that do not move."""
        alone = self.between[self.turn.on_axis[self.between]]
        return node_dofs(alone).reshape(-1, 3)[:, PARITIES[parity] * TURNED < 0].ravel()


@dataclass(frozen=True)
class Condensed:
    """The elimination: fronts of the half, and for even and odd motions those on top of it."""

    orbits: _Orbits
    half: tuple[Front, ...]
    top: tuple[Front, Front]

    @property
    def cut(self) -> Wholes:
        """Dofs of the cut behind."""
        return node_dofs(self.orbits.cut)

    def forward(self, loads: Floats, nodes: Wholes) -> tuple[Forward, tuple[Floats, Floats]]:
        """What `backward` needs of loads (3 k, m) at nodes (k,), and those (n, m) of both parities that arrive at the cut."""
        orbits, count = self.orbits, loads.shape[1]
        left = np.zeros((3 * len(orbits.turn.nodes), 2 * count))
        both, half = left.reshape(-1, 3, 2, count), loads.reshape(-1, 3, 1, count) / 2
        both[nodes] = half
        both[orbits.turn.nodes[nodes]] += half * TURNED[:, None, None] * PARITIES[:, None]
        left[node_dofs(np.flatnonzero(orbits.turn.on_axis))] /= 2
        left[node_dofs(orbits.moved)] = 0.0
        loaded: Bools = np.asarray(left.any(axis=1))
        found: list[Floats | None] = []
        for front in self.half:
            if not loaded[front.own].any():
                found.append(None)
                continue
            found.append(front.forward(left))
            loaded[front.aside] = True
        moved, standing, top, arrived = node_dofs(orbits.moved), node_dofs(orbits.standing), [], []
        for parity in (0, 1):
            own = left[:, parity * count : (parity + 1) * count]
            own[standing] += orbits.signs(parity)[moved, None] * own[moved]
            own[orbits.still(parity)] = 0.0
            top.append(self.top[parity].forward(own))
            arrived.append(own[self.cut])
        return Forward(found, (top[0], top[1])), (arrived[0], arrived[1])

    def backward(self, found: Forward | None, cuts: tuple[Floats, Floats], nodes: Wholes) -> Floats:
        """Displacements (3 n, m) of nodes by those of the cut behind of both parities; `found` None stands for no load."""
        orbits, count = self.orbits, cuts[0].shape[1]
        every = np.zeros((3 * len(orbits.turn.nodes), 2 * count))
        moved, standing = node_dofs(orbits.moved), node_dofs(orbits.standing)
        for parity in (0, 1):
            own = every[:, parity * count : (parity + 1) * count]
            own[self.cut] = cuts[parity]
            self.top[parity].backward(None if found is None else found.top[parity], own)
            own[moved] = orbits.signs(parity)[moved, None] * own[standing]
        here = self._known[nodes]
        for place in self._needed(np.where(here, nodes, orbits.turn.nodes[nodes])):
            self.half[place].backward(None if found is None else found.half[place], every)
        result = np.empty((len(nodes), 3, count))
        vectors = every.reshape(-1, 3, 2, count)
        result[here] = vectors[nodes[here]].sum(axis=2)
        there = orbits.turn.nodes[nodes[~here]]
        result[~here] = TURNED[:, None] * (vectors[there, :, 0] - vectors[there, :, 1])
        return result.reshape(-1, count)

    @cached_property
    def _known(self) -> Bools:
        """Which nodes of the mesh are of the half, or stand for others."""
        known = np.zeros(len(self.orbits.turn.nodes), bool)
        for front in self.half:
            known[front.own // 3] = True
        for nodes in (self.orbits.moved, self.orbits.between, self.orbits.cut):
            known[nodes] = True
        return known

    def _needed(self, nodes: Wholes) -> list[int]:
        """Fronts of the half, those first that went last, without which displacements of some nodes cannot be told."""
        wanted, found = np.zeros(3 * len(self._known), bool), []
        wanted[node_dofs(nodes)] = True
        for place, front in enumerate(self.half):
            if wanted[front.own].any():
                wanted[front.aside] = True
                found.append(place)
        return found[::-1]


def condense(
    turn: HalfTurn, halves: Halves, cut: Wholes, matrices_of: Callable[[Box], Floats], tell: Share
) -> tuple[Condensed, tuple[Floats, Floats]]:
    """Eliminate all nodes but those of the cut behind, `cut` (n,), and what the turn makes of them.

    Second the matrices for even and odd motions that are left on the dofs of the cut behind. Those of the cut ahead are these
    after the turn, or their opposites. The energy of a motion is the sum over both of u.T F u.

    `matrices_of` gives the matrices (m, 60, 60) of the hexahedra of a box; nodes that no part has are held. Raises SolverError
    for a matrix that is not positive definite.
    """
    from gearcad.contact.solid.assembling import add_block, add_hexahedra, fill_upper

    over, lock = 0.0, Lock()

    def done(flops: float) -> None:
        nonlocal over
        with lock:
            over += flops
            tell(min(over / halves.flops, 1.0))

    def nodes_of(box: Box) -> Wholes:
        return box.nodes(turn.mesh)

    store, between, ends = Store(halves.factors), 3 * len(halves.between), 3 * len(cut)
    elimination = Elimination(turn.mesh.nodes, nodes_of, matrices_of, store, done)
    matrix, orbits, applied = elimination.on_all_cores(halves.half), _orbits(turn, halves, cut), np.ones(1)
    given = []
    for parity in (0, 1):
        blocks = Blocks(store.zeros(between, between), store.zeros(between, ends), np.zeros((ends, ends), order="F"))
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
        _hold(blocks, np.flatnonzero(np.isin(node_dofs(halves.between), orbits.still(parity))))
        given.append(blocks)
    del matrix

    def eliminated(blocks: Blocks) -> tuple[Front, Floats]:
        own, across, rest = blocks.eliminated()
        fill_upper(rest)
        done(front_flops(len(halves.between), len(cut)))
        return Front(node_dofs(halves.between), node_dofs(cut), own, across), rest

    (even, of_even), (odd, of_odd) = on_all_cores(eliminated, given)
    return Condensed(orbits, tuple(elimination.fronts), (even, odd)), (of_even, of_odd)


def _orbits(turn: HalfTurn, halves: Halves, cut: Wholes) -> _Orbits:
    every = halves.half.aside if halves.middle is None else np.union1d(halves.half.aside, halves.middle.nodes(turn.mesh))
    standing = np.isin(every, np.r_[halves.between, cut])
    return _Orbits(turn, halves.between, cut, every[~standing & np.isin(turn.nodes[every], np.r_[halves.between, cut])])


def _hold(blocks: Blocks, dofs: Wholes) -> None:
    """Let nothing move dofs (n,) of their own."""
    blocks.own[dofs] = blocks.across[dofs] = 0.0
    blocks.own[:, dofs] = 0.0
    blocks.own[dofs, dofs] = 1.0
