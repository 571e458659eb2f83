"""Nested dissection of a swept tooth sector, and its symmetry under half a turn.

The axis is radial, half-way up. Every motion is the sum of one that this turn leaves as it is, an even one, and one that it
turns into its opposite, an odd one; even loads cause even motions, odd ones odd ones. So half the sector tells all, twice.

First it is divided into halves that the turn about the middle of the tooth makes of each other (see `half_turn`), and one of
them is enough. A box is some quadrangles of the section over some of the layers. It is divided where fewest nodes stand: along
a line through the section, or at a plane between layers. Nodes go with the part that needs them last.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Floats, Wholes
from gearcad.meshing.sector import SweptMesh

PARITIES = np.array([1.0, -1.0])
"""Even and odd, in the order of all that has both."""

TURNED = np.array([1.0, -1.0, -1.0])
"""Signs of the components of a vector under the half turn, along the axis and square to it: polar ones at the cuts too."""

_SAME = 1e-8
"""Differences of places, over the radius or the face width, that are rounding."""


@dataclass(frozen=True)
class HalfTurn:
    """Half turn of a swept mesh whose section is symmetric about the x axis, its layers about the middle of the face width."""

    mesh: SweptMesh

    @cached_property
    def section(self) -> Wholes:
        """The mirror image (n,) of each node of the section. Raises SolverError for a section that is not symmetric."""
        points = self.mesh.section.points
        scale = _SAME * np.abs(points).max()
        mirrored = points * [1.0, -1.0]
        order, other = (np.lexsort(np.round(each / scale).T) for each in (points, mirrored))
        image = np.empty(len(points), int)
        image[other] = order
        if np.abs(points[image] - mirrored).max() > scale:
            raise SolverError("the section of a tooth is not symmetric")
        return image

    @cached_property
    def nodes(self) -> Wholes:
        """The node (n,) at whose place each one of the mesh comes. Raises SolverError for layers that are not symmetric."""
        mesh, count = self.mesh, len(self.section)
        if np.ptp(mesh.planes + mesh.planes[::-1]) > _SAME * np.ptp(mesh.planes):
            raise SolverError("the layers of a gear are not symmetric about the middle of its face width")
        planes = [self.section + mesh.plane(mesh.layers - k) for k in range(mesh.layers + 1)]
        above = self.section[: mesh.section.vertices] + (mesh.layers + 1) * count
        middles = [above + (mesh.layers - 1 - k) * mesh.section.vertices for k in range(mesh.layers)]
        return np.concatenate([*planes, *middles])

    @cached_property
    def on_axis(self) -> Bools:
        """Mask of the nodes (n,) that stay where they are."""
        result: Bools = self.nodes == np.arange(len(self.nodes))
        return result

    def turned(self, values: Floats) -> Floats:
        """Return the loads or displacements (dofs, ...) after the turn."""
        vectors = values.reshape(len(self.nodes), 3, -1)[self.nodes]
        result: Floats = (vectors * TURNED[:, None]).reshape(values.shape)
        return result


_QUADS, _LAYERS = 6, 2
"""Quadrangles and layers of a part that is not divided further."""

_ON_AXIS = 1e-6
"""Heights of quadrangles, over the greatest, that are in the middle of the tooth."""

_DIRECTIONS, _SHARES = 16, (0.42, 0.46, 0.5, 0.54, 0.58)
"""Lines along which a division is tried: directions, and parts of the quadrangles on one side."""


class ElementBlock(NamedTuple):
    """Hexahedra over some quadrangles of the section, from layer `first` to before `last`."""

    quads: Wholes
    first: int
    last: int

    def nodes(self, mesh: SweptMesh) -> Wholes:
        """Return the nodes (m, 20) of the hexahedra, layer by layer."""
        chosen = mesh.section.quads[self.quads]
        return np.concatenate([mesh.elements(chosen, layer) for layer in range(self.first, self.last)])


@dataclass(frozen=True)
class SolidPart:
    """Part of a sector: other parts, or the hexahedra of a `box`; its own nodes `own` (n,), and those shared with others,
    `aside` (m,).

    Their numbers go up.
    """

    own: Wholes
    aside: Wholes
    parts: tuple[SolidPart, ...] = ()
    box: ElementBlock | None = None

    @property
    def flops(self) -> float:
        """Operations of eliminating its own nodes."""
        return front_flops(len(self.own), len(self.aside))

    @cached_property
    def all_flops(self) -> float:
        """Operations of eliminating its own nodes and those of all its parts."""
        return self.flops + sum(part.all_flops for part in self.parts)

    def every(self) -> Iterator[SolidPart]:
        """Yield all parts of it in the order in which they go, itself last."""
        for part in self.parts:
            yield from part.every()
        yield self


@dataclass(frozen=True)
class Halves:
    """One half of a sector, and a box of hexahedra that the turn leaves where they are, if there are any.

    `between` (n,) are the nodes that both halves share, of two that change places only one.
    """

    half: SolidPart
    middle: ElementBlock | None
    between: Wholes
    cut: int

    @cached_property
    def flops(self) -> float:
        """Operations of eliminating all: the half once, the nodes between for even and for odd motions."""
        return self.half.all_flops + 2 * front_flops(len(self.between), self.cut)

    @property
    def factors(self) -> int:
        """Numbers that are kept of that."""
        fronts = [(len(part.own), len(part.aside)) for part in self.half.every()]
        return sum(9 * own * (own + aside) for own, aside in [*fronts, *2 * [(len(self.between), self.cut)]])


def front_flops(own: int, aside: int) -> float:
    """Operations of eliminating so many nodes beside so many others."""
    first, second = 3 * own, 3 * aside
    return first**3 / 3 + first**2 * second + first * second**2


class _Line(NamedTuple):
    """The quadrangles on both sides of a line through some of the section, the free nodes on it, and the vertices of these."""

    sides: tuple[Wholes, Wholes]
    nodes: int
    vertices: int


class _Counted(NamedTuple):
    """A part, and how many of its hexahedra have each of the nodes that it leaves."""

    part: SolidPart
    times: Wholes


def dissected(turn: HalfTurn, kept: Wholes, held: Wholes) -> Halves:
    """Return the halves of a sector that are least work: of its layers, or of its section.

    Nodes above the section's nodes `kept`, those of the cuts, are not to go, those above `held` are nobody's.
    """
    dissection = _Dissection(turn.mesh, kept, held)
    return min((dissection.halves(turn, boxes, middle) for boxes, middle in _ways(turn)), key=lambda each: each.flops)


def _ways(turn: HalfTurn) -> list[tuple[list[ElementBlock], ElementBlock | None]]:
    """Boxes of one half, and what is in the middle: of the section, and of the layers, the one half-way up by its section."""
    section, layers = turn.mesh.section, turn.mesh.layers
    height = section.points[section.quads[:, :4], 1].mean(axis=1)
    every, alone = np.arange(len(section.quads)), np.abs(height) < _ON_AXIS * np.abs(height).max()
    left, middle, lower = np.flatnonzero(~alone & (height > 0)), np.flatnonzero(alone), layers // 2
    ways = [([ElementBlock(left, 0, layers)], ElementBlock(middle, 0, layers))]
    if lower:
        rest = [] if lower * 2 == layers else [ElementBlock(left, lower, lower + 1)]
        ways.append(([ElementBlock(every, 0, lower), *rest], ElementBlock(middle, lower, layers - lower)))
    return [(boxes, box if len(box.quads) and box.last > box.first else None) for boxes, box in ways]


@dataclass(frozen=True)
class _Dissection:
    mesh: SweptMesh
    kept: Wholes
    held: Wholes
    lines: dict[bytes, _Line] = field(default_factory=dict)

    def halves(self, turn: HalfTurn, boxes: list[ElementBlock], middle: ElementBlock | None) -> Halves:
        """Return the halves of a sector by boxes, which are one half, and the box in the middle if there is one."""
        given = [self._divided(box) for box in boxes]
        half = given[0] if len(given) == 1 else self._joined(given)
        nodes = half.part.aside
        if middle is not None:
            nodes = np.union1d(nodes, middle.nodes(self.mesh))
        nodes = nodes[~self._nobodys[nodes] & ~self._kept[nodes]]
        cut = int((~self._nobodys[self.mesh.over(self.kept)]).sum()) // 2
        return Halves(half.part, middle, np.unique(np.minimum(nodes, turn.nodes[nodes])), cut)

    @cached_property
    def _free(self) -> Bools:
        """Mask of the nodes of the section that are eliminated."""
        free = np.ones(len(self.mesh.section.points), bool)
        free[self.kept] = free[self.held] = False
        return free

    @cached_property
    def _kept(self) -> Bools:
        """Mask of the nodes of the mesh that are not eliminated."""
        kept = np.zeros(self.mesh.nodes, bool)
        kept[self.mesh.over(self.kept)] = True
        return kept

    @cached_property
    def _nobodys(self) -> Bools:
        """Mask of the nodes of the mesh that are held, so that they belong to no front."""
        held = np.zeros(self.mesh.nodes, bool)
        held[self.mesh.over(self.held)] = True
        return held

    @cached_property
    def _uses(self) -> Wholes:
        """Number (nodes,) of hexahedra that have each node; one more for nodes that are kept."""
        quads, layers = self.mesh.section.quads, range(self.mesh.layers)
        every = np.concatenate([self.mesh.elements(quads, layer).ravel() for layer in layers])
        uses = np.bincount(every, minlength=self.mesh.nodes)
        uses[self.mesh.over(self.kept)] += 1
        return uses

    def _divided(self, box: ElementBlock) -> _Counted:
        """Return the part of a box with the counts of the nodes that it leaves.

        It has parts, each divided further, or its hexahedra where they are few.
        """
        if boxes := self._parts(box):
            return self._joined([self._divided(each) for each in boxes])
        every = box.nodes(self.mesh).ravel()
        nodes, times = np.unique(every[~self._nobodys[every]], return_counts=True)
        own = times == self._uses[nodes]
        return _Counted(SolidPart(nodes[own], nodes[~own], box=box), times[~own])

    def _joined(self, given: list[_Counted]) -> _Counted:
        nodes, place = np.unique(np.concatenate([each.part.aside for each in given]), return_inverse=True)
        times = np.bincount(place, np.concatenate([each.times for each in given])).astype(int)
        own = times == self._uses[nodes]
        return _Counted(SolidPart(nodes[own], nodes[~own], tuple(each.part for each in given)), times[~own])

    def _parts(self, box: ElementBlock) -> list[ElementBlock]:
        """Return the boxes on both sides of where fewest nodes stand; none if hexahedra are few."""
        quads, first, last = box
        layers, found = last - first, []
        if len(quads) > _QUADS:
            line = self._line(quads)
            standing = line.nodes * (layers + 1) + line.vertices * layers
            found.append((standing, [ElementBlock(side, first, last) for side in line.sides]))
        if layers > _LAYERS:
            standing = int(self._free[np.unique(self.mesh.section.quads[quads])].sum())
            middle = (first + last) // 2
            found.append((standing, [ElementBlock(quads, first, middle), ElementBlock(quads, middle, last)]))
        return min(found, key=lambda each: each[0])[1] if found else []

    def _line(self, quads: Wholes) -> _Line:
        """Return the line with the fewest nodes on it, among those that leave a fair part of the quadrangles on each side."""
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
    nodes, place = np.unique(quads, return_inverse=True)
    by_node = np.argsort(place.ravel(), kind="stable")
    starts = np.searchsorted(place.ravel()[by_node], np.arange(len(nodes)))
    around = by_node // quads.shape[1]  # the quadrangles that have each of the nodes, node by node
    counts = [round(share * len(quads)) for share in _SHARES]
    best: tuple[int, Wholes, Wholes] | None = None
    for angle in np.linspace(0, np.pi, _DIRECTIONS, endpoint=False):
        order = np.argsort(centres @ [np.cos(angle), np.sin(angle)], kind="stable")
        rank = np.empty(len(order), int)
        rank[order] = np.arange(len(order))
        earliest, latest = (of.reduceat(rank[around], starts) for of in (np.minimum, np.maximum))
        for count in counts:
            shared = int(((earliest < count) & (latest >= count)).sum())
            if best is None or shared < best[0]:
                best = (shared, order[:count], order[count:])
    assert best is not None  # there are directions
    return best[1], best[2]
