"""A swept sector divided in two, and again, until few hexahedra are left: the order in which its nodes go (nested dissection).

A part is some quadrangles of the section over some of the layers. It is divided where fewest nodes stand: along a line through
the section, or at a plane between layers. Nodes go with the part that needs them last.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.meshing.section.swept import SweptMesh

__all__ = ["SolidPart", "dissected"]


_QUADS, _LAYERS = 6, 2
"""Quadrangles and layers of a part that is not divided further."""

_DIRECTIONS, _SHARES = 16, (0.42, 0.46, 0.5, 0.54, 0.58)
"""Lines along which a division is tried: directions, and parts of the quadrangles on one side."""


@dataclass(frozen=True)
class SolidPart:
    """Hexahedra over some quadrangles of the section, from layer `first` to before `last`, in `parts` or not divided.

    `own` (n,) are the nodes that nothing else needs, `aside` (m,) those that something does; both go up.
    """

    quads: Wholes
    first: int
    last: int
    own: Wholes
    aside: Wholes
    parts: tuple[SolidPart, ...]

    @property
    def flops(self) -> float:
        """Operations of eliminating its own nodes."""
        own, aside = 3 * len(self.own), 3 * len(self.aside)
        return own**3 / 3 + own**2 * aside + own * aside**2

    @property
    def kept(self) -> int:
        """Numbers that are kept of that."""
        return 9 * len(self.own) * (len(self.own) + len(self.aside))

    def every(self) -> Iterator[SolidPart]:
        """All parts of it in the order in which they go, itself last."""
        for part in self.parts:
            yield from part.every()
        yield self


class _Line(NamedTuple):
    """The quadrangles on both sides of a line through some of the section, the free nodes on it, and the vertices of these."""

    sides: tuple[Wholes, Wholes]
    nodes: int
    vertices: int


class _Counted(NamedTuple):
    """A part, and how many of its hexahedra have each of the nodes that it leaves."""

    part: SolidPart
    times: Wholes


def dissected(mesh: SweptMesh, kept: Wholes, held: Wholes) -> SolidPart:
    """All of a mesh; nodes above the section's nodes `kept` are not to go, those above `held` are nobody's."""
    return _Dissection(mesh, kept, held).whole


@dataclass(frozen=True)
class _Dissection:
    mesh: SweptMesh
    kept: Wholes
    held: Wholes
    lines: dict[bytes, _Line] = field(default_factory=dict)

    @property
    def whole(self) -> SolidPart:
        return self._divided(np.arange(len(self.mesh.section.quads)), 0, self.mesh.layers).part

    @cached_property
    def _free(self) -> Bools:
        """Which nodes of the section are to go."""
        free = np.ones(len(self.mesh.section.points), bool)
        free[self.kept] = free[self.held] = False
        return free

    @cached_property
    def _nobodys(self) -> Bools:
        """Which nodes of the mesh are nobody's."""
        held = np.zeros(self.mesh.nodes, bool)
        held[self.mesh.over(self.held)] = True
        return held

    @cached_property
    def _uses(self) -> Wholes:
        """How many hexahedra have each node; those that are kept, one more."""
        quads, layers = self.mesh.section.quads, range(self.mesh.layers)
        every = np.concatenate([self.mesh.elements(quads, layer).ravel() for layer in layers])
        uses = np.bincount(every, minlength=self.mesh.nodes)
        uses[self.mesh.over(self.kept)] += 1
        return uses

    def _divided(self, quads: Wholes, first: int, last: int) -> _Counted:
        """What the parts leave, each divided further; or what the hexahedra have, where they are few."""
        boxes = self._parts(quads, first, last)
        if boxes:
            given = [self._divided(*box) for box in boxes]
            every = np.concatenate([each.part.aside for each in given])
            nodes, place = np.unique(every, return_inverse=True)
            times = np.bincount(place, np.concatenate([each.times for each in given])).astype(int)
        else:
            given = []
            layers = range(first, last)
            every = np.concatenate([self.mesh.elements(self.mesh.section.quads[quads], layer).ravel() for layer in layers])
            nodes, times = np.unique(every[~self._nobodys[every]], return_counts=True)
        own = times == self._uses[nodes]
        part = SolidPart(quads, first, last, nodes[own], nodes[~own], tuple(each.part for each in given))
        return _Counted(part, times[~own])

    def _parts(self, quads: Wholes, first: int, last: int) -> list[tuple[Wholes, int, int]]:
        """Quadrangles and layers on both sides of where fewest nodes stand; none if they are few."""
        layers, found = last - first, []
        if len(quads) > _QUADS:
            line = self._line(quads)
            standing = line.nodes * (layers + 1) + line.vertices * layers
            found.append((standing, [(side, first, last) for side in line.sides]))
        if layers > _LAYERS:
            standing = int(self._free[np.unique(self.mesh.section.quads[quads])].sum())
            middle = (first + last) // 2
            found.append((standing, [(quads, first, middle), (quads, middle, last)]))
        return min(found, key=lambda each: each[0])[1] if found else []

    def _line(self, quads: Wholes) -> _Line:
        """The line with the fewest nodes on it, among those that leave a fair part of the quadrangles on each side."""
        key = quads.tobytes()
        if key not in self.lines:
            section = self.mesh.section
            sides = _halves(section.points, section.quads[quads])
            first, second = (section.quads[quads[side]] for side in sides)
            nodes = np.intersect1d(first, second)
            nodes = nodes[self._free[nodes]]
            self.lines[key] = _Line((quads[sides[0]], quads[sides[1]]), len(nodes), int((nodes < section.vertices).sum()))
        return self.lines[key]


def _halves(points: Floats, quads: Wholes) -> tuple[Wholes, Wholes]:
    centres = points[quads[:, :4]].mean(axis=1)
    best: tuple[int, Wholes, Wholes] | None = None
    for angle in np.linspace(0, np.pi, _DIRECTIONS, endpoint=False):
        order = np.argsort(centres @ [np.cos(angle), np.sin(angle)], kind="stable")
        for share in _SHARES:
            count = round(share * len(order))
            first, second = order[:count], order[count:]
            shared = len(np.intersect1d(quads[first], quads[second]))
            if best is None or shared < best[0]:
                best = (shared, first, second)
    assert best is not None  # there are directions
    return best[1], best[2]
