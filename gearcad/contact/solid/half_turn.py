"""A tooth sector is alike when it is turned by half a turn about the middle of its tooth: then its two cuts change places.

The axis is radial, half-way up. Every motion is the sum of one that this turn leaves as it is, an even one, and one that it
turns into its opposite, an odd one; even loads cause even motions, odd ones odd ones. So half the sector tells all, twice.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.errors import SolverError
from gearcad.meshing.section.swept import SweptMesh

__all__ = ["PARITIES", "TURNED", "HalfTurn"]


PARITIES = np.array([1.0, -1.0])
"""Even and odd, in the order of all that has both."""

TURNED = np.array([1.0, -1.0, -1.0])
"""What becomes of the components of a vector, along the axis and square to it: polar ones at the cuts too."""

_SAME = 1e-8
"""Differences of places, over the radius or the face width, that are rounding."""


@dataclass(frozen=True)
class HalfTurn:
    """Of a swept mesh whose section is symmetric about the x axis, its layers about the middle of the face width."""

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
        """Which nodes (n,) stay where they are."""
        result: Bools = self.nodes == np.arange(len(self.nodes))
        return result

    def turned(self, values: Floats) -> Floats:
        """Loads or displacements (dofs, ...) after the turn."""
        vectors = values.reshape(len(self.nodes), 3, -1)[self.nodes]
        result: Floats = (vectors * TURNED[:, None]).reshape(values.shape)
        return result
