"""All tooth numbers within limits that are coaxial but for what profile shift takes up, one first central at a time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Indices, Wholes
from gearcad.planetary.mesh import SetType
from gearcad.planetary.search.task import MEMBERS, MOST_SHIFT_SUM, SearchTask

__all__ = ["TeethGrid", "grids"]


class TeethGrid(NamedTuple):
    """Signed numbers of teeth z_a, z_2, z_2', z_b of sets of a type, each (n,)."""

    a: Wholes
    rim_a: Wholes
    rim_b: Wholes
    b: Wholes

    def picked(self, which: Bools | Indices) -> TeethGrid:
        """Those with these numbers, or where a mask is true."""
        return TeethGrid(*(teeth[which] for teeth in self))

    @property
    def row(self) -> tuple[Wholes, Wholes, Wholes]:
        """Whole numbers by which the speeds of a, b and carrier add up to 0."""
        of_a, of_b = self.a * self.rim_b, self.rim_a * self.b
        return of_a, -of_b, of_b - of_a

    @property
    def positions(self) -> Wholes:
        """q, of which the number of planets must be a divisor."""
        return np.abs(self.row[2]) // np.gcd(self.rim_a, self.rim_b)


def grids(task: SearchTask, kind: SetType) -> Iterator[TeethGrid]:
    """The sets of a type, those with one first central at a time; i_0 = 1 is left out."""
    (low, high), ring = task.teeth, MEMBERS[kind][0].startswith("ring")
    first, last = task.ring_teeth if ring else task.teeth
    planets, most = np.arange(low, high + 1), _window(task)
    for teeth in range(first, last + 1):
        rims = planets[planets < teeth] if ring else planets
        seconds = np.zeros(1, int) if kind is SetType.A else planets
        rim_a, rim_b, offset = (each.ravel() for each in np.meshgrid(rims, seconds, np.arange(-most, most + 1)))
        if kind is SetType.A:
            rim_b = rim_a
        a = np.full_like(rim_a, -teeth if ring else teeth)
        grid = TeethGrid(a, rim_a, rim_b, _second(task, kind, a + rim_a, rim_b, offset))
        yield grid.picked(_within(task, kind, grid))


def _window(task: SearchTask) -> int:
    """How many teeth the second central can be away from the number that is coaxial without profile shift.

    A centre distance changes by less than the shift sum in modules, and a tooth is half a module of it.
    """
    first, second = task.modules
    return math.ceil(2 * MOST_SHIFT_SUM * max(first / second, 1))


def _second(task: SearchTask, kind: SetType, total: Wholes, rim_b: Wholes, offset: Wholes) -> Wholes:
    """z_b: m (z_a + z_2) and m' (z_b + z_2') are alike in size, but for the offset."""
    first, second = task.modules
    size = np.rint(np.abs(total) * (first / second)).astype(int) + offset
    return size - rim_b if kind is SetType.C else -(size + rim_b)


def _within(task: SearchTask, kind: SetType, grid: TeethGrid) -> Bools:
    """Where the second central is within its limits and outside its planets, and the set is of its type and has a ratio."""
    low, high = task.teeth if kind is SetType.C else task.ring_teeth
    size = grid.b if kind is SetType.C else -grid.b
    within: Bools = (low <= size) & (size <= high) & (grid.row[2] != 0)
    if kind is not SetType.C:
        within &= size > grid.rim_b
    if kind is SetType.B and task.modules[0] == task.modules[1]:
        within &= grid.rim_a != grid.rim_b  # else it is of type A
    return within
