"""Shafts of a deck: beams and bearings as springs between nodes on the axis, whose sections hold the bores of gears.

CalculiX makes solids of its beams. So each beam stands in the deck as its stiffness matrix K: for i < j springs -K_ij between
two degrees of freedom (SPRING2), and the sum of each row to the ground (SPRING1); some are negative. A station of a shaft is
two nodes: one has its displacement, the other its turn (rad) in the first three degrees of freedom. Within a gear's body the
beam has the section of the bore alone, because the body around it is elements.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, TextIO

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.decks.calculix import number

if TYPE_CHECKING:
    from gearcad.shafts.beam import SteppedShaft

_DOFS = 6
_NOTHING = 1e-12
"""Spring over the greatest of its matrix below which it is left out."""

_SAME = 1e-6
"""Distance (mm) below which two heights are one."""


@dataclass(frozen=True, kw_only=True)
class DeckShaft:
    """A shaft in a deck: its `beam` has a node at each height of the nodes that it holds.

    Its axis is at (`x`, 0) mm, its left end at the height `start`; what acts on it is turned by `turn` (rad) about its axis to
    the deck's coordinates. `first` is the number (from 1) of its first node. `held` are nodes (n,) of the mesh, from 0.
    `driver` is a node whose first degree of freedom is the twist at the coupling; None where that is held.
    """

    name: str
    beam: SteppedShaft
    x: float
    start: float
    turn: float
    first: int
    held: Wholes
    driver: int | None = None

    @property
    def count(self) -> int:
        """Nodes of the shaft."""
        return 2 * len(self.beam.nodes)

    def place(self, dof: int) -> tuple[int, int]:
        """Return node and degree of freedom, from 1, of a dof (from 0) of the beam."""
        station, direction = divmod(dof, _DOFS)
        turned, axis = divmod(direction, 3)
        return self.first + 2 * station + turned, axis + 1

    @cached_property
    def _rotation(self) -> Floats:
        cosine, sine = math.cos(self.turn), math.sin(self.turn)
        return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])

    @cached_property
    def _stiffness(self) -> Floats:
        """Stiffness of the beam and its elastic bearings: N/mm, N, N mm."""
        beam = self.beam
        found = np.zeros((_DOFS * len(beam.nodes),) * 2)
        for station, part in enumerate(beam.elements):
            own = slice(_DOFS * station, _DOFS * (station + 2))
            found[own, own] += part
        for bearing in beam.bearings:
            first = _DOFS * beam.node_at(bearing.position)
            for direction, spring in enumerate(bearing.springs()):
                if math.isfinite(spring):
                    found[first + direction, first + direction] += spring
        return found

    @cached_property
    def loads(self) -> Floats:
        """Forces and moments (6 n,) on the stations in the deck's coordinates: given ones, weight, and seats off the axis."""
        found = self.beam.loads.reshape(-1, 2, 3) @ self._rotation.T
        for bearing in self.beam.bearings:
            radial = bearing.springs()[0]
            if math.isfinite(radial):
                shift = self._rotation @ [*bearing.offset, 0.0]
                found[self.beam.node_at(bearing.position), 0] += radial * shift / 1000
        return np.asarray(found.ravel(), float)

    def write_nodes(self, file: TextIO) -> None:
        """Write two nodes for each station."""
        file.write(f"*NODE, NSET={self.name}_shaft\n")
        for station, position in enumerate(self.beam.nodes.tolist()):
            for node in (self.first + 2 * station, self.first + 2 * station + 1):
                file.write(f"{node}, {number(self.x)}, 0., {number(self.start + position)}\n")

    def write_springs(self, file: TextIO, element: int) -> int:
        """Write the springs as elements from a number on, and return the next number."""
        matrix = self._stiffness
        scale = np.sqrt(np.abs(np.diag(matrix)))
        scale[scale == 0] = 1.0
        least = _NOTHING * np.outer(scale, scale)
        rows, columns = np.nonzero(np.triu(np.abs(matrix) > least, 1))
        rest = matrix.sum(axis=1)
        terms = [(self.place(i), self.place(j), -matrix[i, j]) for i, j in zip(rows.tolist(), columns.tolist(), strict=True)]
        for one, other, spring in terms:
            self._write_spring(file, "SPRING2", element, (one, other), spring)
            element += 1
        for dof in np.flatnonzero(np.abs(rest) > _NOTHING * np.abs(matrix).max(axis=1)).tolist():
            self._write_spring(file, "SPRING1", element, (self.place(dof),), float(rest[dof]))
            element += 1
        return element

    def _write_spring(self, file: TextIO, kind: str, element: int, ends: tuple[tuple[int, int], ...], spring: float) -> None:
        name = f"{self.name}_spring_{element}"
        nodes, dofs = (", ".join(str(end[k]) for end in ends) for k in (0, 1))
        file.write(f"*ELEMENT, TYPE={kind}, ELSET={name}\n{element}, {nodes}\n")
        file.write(f"*SPRING, ELSET={name}\n{dofs}\n{number(spring)}\n")

    def write_equations(self, file: TextIO, points: Floats) -> None:
        """Write equations by which held nodes move with the sections of the shaft, and the driver with its coupling."""
        file.write("*EQUATION\n")
        for node in self.held.tolist():
            x, y, z = points[node].tolist()
            station = self.beam.node_at(z - self.start)
            moved, turned = self.first + 2 * station, self.first + 2 * station + 1
            x -= self.x
            for axis, terms in ((1, ((3, y),)), (2, ((3, -x),)), (3, ((1, -y), (2, x)))):
                kept = [(dof, factor) for dof, factor in terms if abs(factor) > _NOTHING]
                lines = [f"{node + 1}, {axis}, 1.", f"{moved}, {axis}, -1."]
                lines += [f"{turned}, {dof}, {number(factor)}" for dof, factor in kept]
                file.write(f"{len(lines)}\n" + "\n".join(lines) + "\n")
        if self.driver is not None:
            node, dof = self._coupling
            file.write(f"2\n{self.driver}, 1, 1., {node}, {dof}, -1.\n")

    @property
    def _coupling(self) -> tuple[int, int]:
        return self.place(_DOFS * self.beam.node_at(self.beam.coupling) + 5)

    def write_supports(self, file: TextIO) -> None:
        """Write what rigid bearings, and the coupling of a shaft without a driver, hold."""
        file.write("*BOUNDARY\n")
        for bearing in self.beam.bearings:
            first = _DOFS * self.beam.node_at(bearing.position)
            shift = self._rotation @ [*bearing.offset, 0.0] / 1000
            for direction, spring in enumerate(bearing.springs()):
                if math.isinf(spring):
                    node, dof = self.place(first + direction)
                    value = float(shift[direction]) if direction < 2 else 0.0
                    file.write(f"{node}, {dof}, {dof}, {number(value)}\n")
        if self.driver is None:
            node, dof = self._coupling
            file.write(f"{node}, {dof}, {dof}\n")

    def write_loads(self, file: TextIO) -> None:
        """Write forces and moments as lines of *CLOAD."""
        for dof in np.flatnonzero(self.loads).tolist():
            node, axis = self.place(dof)
            file.write(f"{node}, {axis}, {number(float(self.loads[dof]))}\n")


def with_bare_section(beam: SteppedShaft, low: float, high: float, diameter: float, places: Floats) -> SteppedShaft:
    """Return a shaft with a diameter (mm) between two positions, and nodes at places (n,) in mm."""
    segments = []
    for segment, start, end in zip(beam.segments, beam.ends, beam.ends[1:], strict=False):
        cuts = [start, *(cut for cut in (low, high) if start + _SAME < cut < end - _SAME), end]
        for one, other in pairwise(cuts):
            inside = low - _SAME < (one + other) / 2 < high + _SAME
            part = replace(segment, length=other - one)
            segments.append(replace(part, outer_diameter=diameter) if inside else part)
    return replace(beam, segments=tuple(segments), places=tuple(places.tolist()))
