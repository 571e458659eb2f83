"""Plane linear elasticity of a sector mesh: the stiffness of its elements, per mm of face width."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.contact.plane.dissection import node_dofs
from gearcad.material import Material
from gearcad.meshing.section import SectorMesh
from gearcad.meshing.section.shapes import TRIANGLE_PLACES, TRIANGLE_WEIGHTS, triangle_shapes, triangle_slopes

__all__ = ["Plane", "PlaneElasticity", "element_forces", "element_mass", "element_stiffness"]


class Plane(Enum):
    """Strain: a wide gear; stress: a thin one."""

    STRAIN = "plane strain"
    STRESS = "plane stress"


@dataclass(frozen=True)
class PlaneElasticity:
    """Material and plane state; the two constants in which all plane problems look like plane stress."""

    material: Material
    plane: Plane = Plane.STRAIN

    @property
    def modulus(self) -> float:
        """E' (MPa): E in plane stress, E/(1 - nu^2) in plane strain."""
        nu = self.material.poisson_ratio
        return self.material.youngs_modulus / (1 - nu**2 if self.plane is Plane.STRAIN else 1.0)

    @property
    def ratio(self) -> float:
        """nu': nu in plane stress, nu/(1 - nu) in plane strain."""
        nu = self.material.poisson_ratio
        return nu / (1 - nu) if self.plane is Plane.STRAIN else nu

    @property
    def lame(self) -> tuple[float, float]:
        """lambda, mu (MPa) of the plane problem."""
        return self.modulus * self.ratio / (1 - self.ratio**2), self.modulus / 2 / (1 + self.ratio)


def element_stiffness(mesh: SectorMesh, elasticity: PlaneElasticity, elements: Wholes | None = None) -> Floats:
    """Stiffness (m, 12, 12) in N/mm per mm of width of all elements, or of some: x and y of each of its nodes in turn."""
    gradients, weights = _integrated(mesh, elements)
    slopes = gradients.reshape(len(gradients), 12, -1)
    products = ((slopes * weights[:, None]) @ slopes.swapaxes(1, 2)).reshape(-1, 6, 2, 6, 2)
    lame, shear = elasticity.lame
    # Integrals of lambda div u div v + mu (grad u + grad u^T) : grad v.
    local = lame * products + shear * products.swapaxes(2, 4)
    along = products[:, :, 0, :, 0] + products[:, :, 1, :, 1]
    for direction in (0, 1):
        local[:, :, direction, :, direction] += shear * along
    return local.reshape(-1, 12, 12)


def element_mass(mesh: SectorMesh, elements: Wholes | None = None) -> Floats:
    """Integrals of N^T N (m, 12, 12) in mm² over all elements, or some, by the same dofs."""
    _, weights = _integrated(mesh, elements)
    shapes = triangle_shapes(TRIANGLE_PLACES)
    local = np.zeros((len(weights), 6, 2, 6, 2))
    for direction in (0, 1):
        local[:, :, direction, :, direction] = np.einsum("eq,qa,qb->eab", weights, shapes, shapes)
    return local.reshape(-1, 12, 12)


def element_forces(triangles: Wholes, matrices: Floats, moved: Floats) -> Floats:
    """Forces (2 n, k) of elements (m, 6) with their matrices (m, 12, 12) by displacements (2 n, k) of all nodes."""
    dofs = node_dofs(triangles)
    moves: Bools = np.any(moved, axis=1)
    strained = moves[dofs].any(axis=1)
    dofs = dofs[strained]
    each = (matrices[strained] @ moved[dofs]).reshape(dofs.size, moved.shape[1])
    order = np.argsort(dofs, axis=None, kind="stable")
    found, begin = np.unique(dofs.ravel()[order], return_index=True)
    forces = np.zeros_like(moved)
    forces[found] = np.add.reduceat(each[order], begin) if len(begin) else 0.0
    return forces


def _integrated(mesh: SectorMesh, elements: Wholes | None) -> tuple[Floats, Floats]:
    """Of elements, where they are integrated: slopes (m, 6, 2, places) of their shape functions, and weights (m, places) in
    mm².
    """
    corners = mesh.points[mesh.triangles if elements is None else mesh.triangles[elements]]
    local = triangle_slopes(TRIANGLE_PLACES).transpose(2, 0, 1)
    (x_s, y_s), (x_t, y_t) = (np.moveaxis(along @ corners, -1, 0) for along in local)
    area = x_s * y_t - y_s * x_t
    by_s, by_t = (along.T[None] for along in local)
    gradients = np.stack(
        [
            by_s * (y_t / area)[:, None] - by_t * (y_s / area)[:, None],
            by_t * (x_s / area)[:, None] - by_s * (x_t / area)[:, None],
        ],
        axis=2,
    )
    return gradients, np.abs(area) * TRIANGLE_WEIGHTS / 2
