"""Quadratic hexahedra of a solid body: stiffness, faces with tractions, and a hub that follows a free bore.

As `contact.plane.sector` in the plane, with six dofs for three: torque, forces along x, y and z, and moments about x and y
through the middle of the face width.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.material import Material
from gearcad.meshing.fem import SWEPT, Element, quadrature, shape_slopes, shape_values, stiffness_matrices
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.sector import SweptMesh, turned

_ORDER = 5
"""Order of quadrature: 3 x 3 x 3 points. Fewer leave hexahedra with zero-energy modes, more change nothing that shows."""


def lame(material: Material) -> tuple[float, float]:
    """Lamé's constants lambda and mu (MPa)."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))


def layer_matrices(mesh: SweptMesh, quads: Wholes, layer: int, material: Material) -> Floats:
    """Matrices (m, 60, 60) of the hexahedra over section quadrangles (m, 8), in the axes that turn with the section."""
    thickness = float(mesh.planes[layer + 1] - mesh.planes[layer])
    levels = np.repeat([-0.5, 0.5, 0.0], [8, 8, 4]) * thickness
    flat = mesh.section.points[quads][:, [*range(8), *range(8), *range(4)]]
    angles = mesh.rate * levels
    places = turned(flat.reshape(-1, 2), np.tile(angles, len(quads))).reshape(len(quads), 20, 2)
    points = np.concatenate([places, np.broadcast_to(levels[:, None], (len(quads), 20, 1))], -1)
    turn = np.zeros((60, 60))
    cosine, sine = np.cos(angles), np.sin(angles)
    x = 3 * np.arange(20)
    turn[x, x], turn[x, x + 1], turn[x + 1, x], turn[x + 1, x + 1], turn[x + 2, x + 2] = cosine, -sine, sine, cosine, 1
    result: Floats = turn.T @ stiffness_matrices(SWEPT, points, lame(material), _ORDER) @ turn
    return result


_FAR = 3
"""Gauss points each way on a face, far from a singular point."""

_CLOSE = 1.5
"""A face is near if it is within so many of its own sizes."""


@cache
def _rule(count: int) -> tuple[Floats, Floats, Floats]:
    """Shape functions (points, 8), their slopes (2, points, 8), and weights of `count` x `count` Gauss points."""
    places, weights = quadrature("quad8", 2 * count - 1)
    return shape_values("quad8", places), shape_slopes("quad8", places).swapaxes(0, 1), weights


@dataclass(frozen=True)
class QuadraticFaces:
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
        """Return the forces (n, 3) on the nodes that are `used` of a traction field that is singular at one point; `near` Gauss
        points each way around it.
        """
        distance = np.linalg.norm(self._centres - singular_at, axis=-1)
        close = np.flatnonzero(distance < (1 + _CLOSE) * self._sizes)
        nodal = _rule(_FAR)[0].T @ traction(*self._far)
        nodal[close] = _rule(near)[0].T @ traction(*self._gauss(close, near))
        result: Floats = self._sums[1] @ nodal.reshape(-1, 3)
        return result

    def among(self, nodes: Wholes) -> QuadraticFaces:
        """Return the faces all of whose nodes are among some."""
        chosen = np.isin(self.nodes, nodes).all(axis=1)
        return QuadraticFaces(self.nodes[chosen], self.points[chosen])

    def smooth_forces(self, mesh: SweptMesh, traction: Callable[[Floats, Floats], Floats]) -> Floats:
        """Return the nodal forces (n, 3, ...) of a smooth traction field."""
        nodal = np.einsum("qa,mqc...->mac...", _rule(_FAR)[0], traction(*self._far))
        used, sums = self._sums
        result = np.zeros((mesh.nodes, *nodal.shape[2:]))
        result[used] = (sums @ nodal.reshape(self.nodes.size, -1)).reshape(-1, *nodal.shape[2:])
        return result


def summing(nodes: Wholes) -> tuple[Wholes, Any]:
    """Return the nodes (n,) that elements use, sorted, and the matrix (scipy CSR, n x elements' nodes) that sums values at
    them.
    """
    import scipy.sparse

    used, index = np.unique(nodes, return_inverse=True)
    entries = (np.ones(nodes.size), (index.ravel(), np.arange(nodes.size)))
    return used, scipy.sparse.csr_matrix(entries, shape=(len(used), nodes.size))


def boundary_faces(mesh: SweptMesh, quads: Wholes) -> QuadraticFaces:
    """Return the faces around the hexahedra over some section quadrangles: sides of all layers, and both ends."""
    section = mesh.section.quads[quads]
    edges = section[:, np.array(Element.QUAD8.shape.faces)].reshape(-1, 3)
    _, index, times = np.unique(edges[:, 2], return_index=True, return_counts=True)
    once = edges[index[times == 1]]
    found = [mesh.side_faces(once, layer) for layer in range(mesh.layers)]
    top = section + mesh.plane(mesh.layers)
    bottom = (section + mesh.plane(0))[:, [0, 3, 2, 1, 7, 6, 5, 4]]
    nodes = np.concatenate([*found, top, bottom])
    return QuadraticFaces(nodes, mesh.points[nodes])


HUB_PARITIES = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
"""Parities of the dofs of a hub: 1 for those that a half turn about the middle of a tooth leaves unchanged, -1 for those that
it reverses.
"""


def rigid_motions(points: Floats, middle: float) -> Floats:
    """Return the displacements (..., 3, 6) of points (..., 3) in mm by the dofs of the hub as motions of 1 rad or 1 mm.

    `middle` (mm) is the height of the axes of tilting.
    """
    x, y, z = np.moveaxis(points, -1, 0)
    zero, one, up = np.zeros_like(x), np.ones_like(x), z - middle
    motions = [(-y, x, zero), (one, zero, zero), (zero, one, zero), (zero, zero, one), (zero, -up, y), (up, zero, -x)]
    return np.stack([np.stack(motion, -1) for motion in motions], -1)


def bore_forces(mesh: SweptMesh) -> Floats:
    """Return the nodal forces (3 nodes, 6) in the turning axes, by tractions on the bore like a rigid motion's part along its
    surface.
    """
    section = mesh.section
    inner = np.isin(section.quads, mesh.side(OutlineSide.HELD))
    faces = boundary_faces(mesh, np.flatnonzero(inner.sum(axis=1) >= _ON_ARC)).among(mesh.over(mesh.side(OutlineSide.HELD)))
    middle = (mesh.planes[0] + mesh.planes[-1]) / 2

    def sheared(points: Floats, normals: Floats) -> Floats:
        area = np.linalg.norm(normals, axis=-1)[..., None, None]
        outward = points * [1.0, 1.0, 0.0] / np.hypot(points[..., :1], points[..., 1:2])
        motions = rigid_motions(points, middle)
        along: Floats = motions - outward[..., None] * np.einsum("...c,...cj->...j", outward, motions)[..., None, :]
        along *= area
        return along

    forces = faces.smooth_forces(mesh, sheared)
    turning: Floats = mesh.to_turning(forces).reshape(-1, forces.shape[-1])
    return turning


_ON_ARC = 3
"""Nodes of a quadrangle on the bore if an edge of it is."""


def seen_at(angle: float) -> Floats:
    """Return the matrix (6, 6) from the hub's dofs as the loaded sector sees them to those of a sector turned by an angle
    (rad).
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    seen = np.eye(6)
    for first in (1, 4):
        seen[first : first + 2, first : first + 2] = [[cosine, sine], [-sine, cosine]]
    return seen
