"""The matrix of a whole section, which the package itself never puts together."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse

from gearcad.contact.plane.sector import PlaneElasticity, element_stiffness, node_dofs
from gearcad.core.records import Floats, Wholes
from gearcad.meshing.sector import SectorMesh


def stiffness_matrix(mesh: SectorMesh, elasticity: PlaneElasticity, elements: Wholes | None = None) -> Any:
    """Stiffness (scipy CSR, N/mm per mm of width) of the mesh or some elements; dof 2 n is node n in x, 2 n + 1 in y."""
    triangles = mesh.triangles if elements is None else mesh.triangles[elements]
    return summed(triangles, element_stiffness(mesh, elasticity, elements), len(mesh.points))


def summed(triangles: Wholes, matrices: Floats, nodes: int) -> Any:
    """Matrices of elements (m, 12, 12) summed up (scipy CSR, (2 nodes, 2 nodes))."""
    dofs = node_dofs(triangles)
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None])
    return scipy.sparse.csr_matrix((matrices.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * nodes, 2 * nodes))
