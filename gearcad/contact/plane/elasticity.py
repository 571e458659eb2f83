"""Plane linear elasticity of a sector mesh: its stiffness matrix by scikit-fem, per mm of face width."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.material import Material
from gearcad.meshing.section import SectorMesh

__all__ = ["Plane", "PlaneElasticity", "mass_matrix", "stiffness_matrix"]


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


def stiffness_matrix(mesh: SectorMesh, elasticity: PlaneElasticity, elements: Wholes | None = None) -> Any:
    """Stiffness (scipy CSR, N/mm per mm of width) of the mesh or of some of its elements.

    Dof 2 n is node n in x, 2 n + 1 in y.
    """
    from skfem import ElementTriP2

    triangles, basis = _basis(mesh, elements, ElementTriP2())
    slopes = np.stack([shape[0].grad for shape in basis.basis])  # (6 nodes, 2 directions, elements, points)
    slopes = np.moveaxis(slopes, 2, 0).reshape(len(triangles), 12, -1)
    products = ((slopes * basis.dx[:, None]) @ slopes.swapaxes(1, 2)).reshape(-1, 6, 2, 6, 2)
    lame, shear = elasticity.lame
    # Integrals of lambda div u div v + mu (grad u + grad u^T) : grad v.
    local = lame * products + shear * products.swapaxes(2, 4)
    along = products[:, :, 0, :, 0] + products[:, :, 1, :, 1]
    for direction in (0, 1):
        local[:, :, direction, :, direction] += shear * along
    dofs = 2 * triangles[..., None] + np.arange(2)
    return _summed(local.reshape(-1, 12, 12), dofs.reshape(-1, 12), 2 * len(mesh.points))


def mass_matrix(mesh: SectorMesh, elements: Wholes | None = None) -> Any:
    """Integral of N^T N (scipy CSR, mm²) over the mesh or some of its elements, dofs as those of the stiffness."""
    from skfem import ElementTriP2

    triangles, basis = _basis(mesh, elements, ElementTriP2())
    shapes = np.stack([np.broadcast_to(shape[0].value, basis.dx.shape) for shape in basis.basis], 1)  # (elements, 6, points)
    local = (shapes * basis.dx[:, None]) @ shapes.swapaxes(1, 2)
    size, parts = 2 * len(mesh.points), 2 * triangles
    return _summed(local, parts, size) + _summed(local, parts + 1, size)


def _basis(mesh: SectorMesh, elements: Wholes | None, element: Any) -> tuple[Wholes, Any]:
    """Elements by their nodes (n, 6), and scikit-fem's shape functions of each at the points where it integrates."""
    from skfem import Basis, MeshTri2

    triangles = mesh.triangles if elements is None else mesh.triangles[elements]
    used, local = np.unique(triangles, return_inverse=True)
    return triangles, Basis(MeshTri2(mesh.points[used].T, local.reshape(triangles.shape).T), element, intorder=4)


def _summed(local: Floats, dofs: Wholes, size: int) -> Any:
    """Matrices of elements (n, k, k) with their dofs (n, k), summed up (scipy CSR, (size, size))."""
    import scipy.sparse

    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None])
    return scipy.sparse.csr_matrix((local.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
