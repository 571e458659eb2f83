"""Loads and displacements carried through fronts, forward and backward (multifrontal substitution).

Each front has only what is its own and what it hands on, so nothing is as large as all dofs, and many loads go at once: rows
are those of a node together, and products of matrices are wide.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.contact.solid.fronts import Front

__all__ = ["FrontTree", "Solved"]


Solved = list[Floats | None]
"""Front by front what `forward` gives; None where no load gets."""


@dataclass(frozen=True)
class FrontTree:
    """Fronts in the order in which they went, of a mesh of so many `nodes`; the nodes `top` (n,), sorted, are left."""

    fronts: tuple[Front, ...]
    top: Wholes
    nodes: int

    def forward(self, loads: Floats, at: Wholes) -> tuple[Solved, Floats]:
        """What `backward` needs of loads (3 k, m) at nodes (k,), and what is left of them on top (3 n, m)."""
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
        """Displacements (3 n, m) of nodes by those on top (3 k, m), and by what `forward` gave for some of the columns.

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
        """Which of some nodes (n,) a front has, or the top."""
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
        """Where each node comes among its owner's."""
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
        """Where the nodes aside of each front come among those of the one to which it hands on."""
        found, places = [], np.zeros(self.nodes, int)
        for front, above in zip(self.fronts, self._above.tolist(), strict=True):
            every = self.top if above == len(self.fronts) else np.r_[self.fronts[above].own, self.fronts[above].aside]
            places[every] = np.arange(len(every))
            found.append(places[front.aside])
        return found

    def _grouped(self, nodes: Wholes) -> dict[int, Wholes]:
        """Which of some nodes (n,) each front has as its own."""
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
