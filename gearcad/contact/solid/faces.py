"""The faces around some of the hexahedra of a swept mesh, and nodal forces of tractions on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.meshing.section.swept import SweptMesh

__all__ = ["Faces", "boundary_faces", "summing"]


_FAR = 3
"""Gauss points each way on a face, far from a singular point."""

_CLOSE = 1.5
"""A face is near if it is within so many of its own sizes."""


@cache
def _rule(count: int) -> tuple[Floats, Floats, Floats]:
    """Shape functions (points, 8), their slopes (2, points, 8), and weights of `count` x `count` Gauss points."""
    from skfem import ElementQuadS2

    element = ElementQuadS2()
    place, weight = np.polynomial.legendre.leggauss(count)
    x, y = (np.ravel(each) for each in np.meshgrid((place + 1) / 2, (place + 1) / 2, indexing="ij"))
    found = [element.lbasis(np.stack([x, y]), k) for k in range(8)]
    values, slopes = np.stack([each[0] for each in found], -1), np.stack([each[1] for each in found], -1)
    return values, slopes, np.outer(weight, weight).ravel() / 4


@dataclass(frozen=True)
class Faces:
    """Quadratic faces (m, 8), four vertices and the nodes between, counter-clockwise seen from outside."""

    nodes: Wholes
    points: Floats

    @cached_property
    def _centres(self) -> Floats:
        result: Floats = self.points[:, :4].mean(axis=1)
        return result

    @cached_property
    def _sizes(self) -> Floats:
        result: Floats = np.linalg.norm(self.points[:, :4] - self._centres[:, None], axis=-1).max(axis=1)
        return result

    @cached_property
    def _far(self) -> tuple[Floats, Floats]:
        return self._gauss(np.arange(len(self.nodes)), _FAR)

    def _gauss(self, faces: Wholes, count: int) -> tuple[Floats, Floats]:
        """Gauss points and normals, times the area, of some faces: (m, points, 3) each."""
        values, slopes, weights = _rule(count)
        points = values @ self.points[faces]
        first, second = (slope @ self.points[faces] for slope in slopes)
        return points, np.cross(first, second) * weights[:, None]

    @property
    def used(self) -> Wholes:
        """Nodes (n,) of the faces, sorted."""
        return self._sums[0]

    @cached_property
    def _sums(self) -> tuple[Wholes, Any]:
        return summing(self.nodes)

    def forces(self, traction: Callable[[Floats, Floats], Floats], singular_at: Floats, near: int) -> Floats:
        """Forces (n, 3) on the nodes that are `used` of a traction field that is singular at one point; `near` Gauss points
        each way around it.
        """
        distance = np.linalg.norm(self._centres - singular_at, axis=-1)
        close = np.flatnonzero(distance < (1 + _CLOSE) * self._sizes)
        nodal = _rule(_FAR)[0].T @ traction(*self._far)
        nodal[close] = _rule(near)[0].T @ traction(*self._gauss(close, near))
        result: Floats = self._sums[1] @ nodal.reshape(-1, 3)
        return result

    def among(self, nodes: Wholes) -> Faces:
        """The faces all of whose nodes are among some."""
        chosen = np.isin(self.nodes, nodes).all(axis=1)
        return Faces(self.nodes[chosen], self.points[chosen])

    def smooth_forces(self, mesh: SweptMesh, traction: Callable[[Floats, Floats], Floats]) -> Floats:
        """Nodal forces (n, 3, ...) of a smooth traction field."""
        nodal = np.einsum("qa,mqc...->mac...", _rule(_FAR)[0], traction(*self._far))
        used, sums = self._sums
        result = np.zeros((mesh.nodes, *nodal.shape[2:]))
        result[used] = (sums @ nodal.reshape(self.nodes.size, -1)).reshape(-1, *nodal.shape[2:])
        return result


def summing(nodes: Wholes) -> tuple[Wholes, Any]:
    """The nodes (n,) that elements use, sorted, and the matrix (scipy CSR, n x elements' nodes) that sums values at them."""
    import scipy.sparse

    used, index = np.unique(nodes, return_inverse=True)
    entries = (np.ones(nodes.size), (index.ravel(), np.arange(nodes.size)))
    return used, scipy.sparse.csr_matrix(entries, shape=(len(used), nodes.size))


def boundary_faces(mesh: SweptMesh, quads: Wholes) -> Faces:
    """The faces around the hexahedra over some section quadrangles: sides of all layers, and both ends."""
    section = mesh.section.quads[quads]
    edges = section[:, [[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]]].reshape(-1, 3)
    _, index, times = np.unique(edges[:, 1], return_index=True, return_counts=True)
    once = edges[index[times == 1]]
    found = [mesh.side_faces(once, layer) for layer in range(mesh.layers)]
    top = section + mesh.plane(mesh.layers)
    bottom = (section + mesh.plane(0))[:, [0, 3, 2, 1, 7, 6, 5, 4]]
    nodes = np.concatenate([*found, top, bottom])
    return Faces(nodes, mesh.points[nodes])
