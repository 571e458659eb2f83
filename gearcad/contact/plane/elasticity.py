"""Plane linear elasticity of a sector mesh: its stiffness matrix by scikit-fem, per mm of face width."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from gearcad.arrays import Wholes
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
    from skfem.models.elasticity import linear_elasticity

    return _assembled(linear_elasticity(*elasticity.lame), mesh, elements)


def mass_matrix(mesh: SectorMesh, elements: Wholes | None = None) -> Any:
    """Integral of N^T N (scipy CSR, mm²) over the mesh or some of its elements, dofs as those of the stiffness."""
    from skfem import BilinearForm
    from skfem.helpers import dot

    return _assembled(BilinearForm(lambda u, v, _: dot(u, v)), mesh, elements)


def _assembled(form: Any, mesh: SectorMesh, elements: Wholes | None) -> Any:
    import scipy.sparse
    from skfem import Basis, ElementTriP2, ElementVector, MeshTri2

    triangles = mesh.triangles if elements is None else mesh.triangles[elements]
    used, local = np.unique(triangles, return_inverse=True)
    local = local.reshape(triangles.shape)
    basis = Basis(MeshTri2(mesh.points[used].T, local.T), ElementVector(ElementTriP2()), intorder=4)
    matrix = form.assemble(basis).tocoo()
    dofs = _our_dofs(basis, local, used)
    size = 2 * len(mesh.points)
    return scipy.sparse.csr_matrix((matrix.data, (dofs[matrix.row], dofs[matrix.col])), shape=(size, size))


def _our_dofs(basis: Any, triangles: Wholes, used: Wholes) -> Wholes:
    """Our number of each dof of scikit-fem, element by element."""
    ours = 2 * used[triangles].T[:, None, :] + np.arange(2)[:, None]  # (6 nodes, 2 directions, elements)
    dofs = np.empty(basis.N, int)
    dofs[basis.element_dofs] = ours.reshape(12, -1)
    return dofs
