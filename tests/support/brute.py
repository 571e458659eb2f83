"""Witnesses of plane contact: flanks meshed so finely that elements carry it, and the matrix of a whole section."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import scipy.sparse

from gearcad.contact.plane.flank import PlaneCompliance, flank_of
from gearcad.contact.plane.ring import Ring
from gearcad.contact.plane.sector import PlaneElasticity, element_stiffness, node_dofs
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.sector import SectorMesh


@dataclass(frozen=True)
class NodalCompliance(PlaneCompliance):
    """Responses to unit loads that fall off linearly from each vertex of the flank to the next: `weights` (nodes, vertices).

    What moves is averaged with the same weights, so the responses are symmetric (Galerkin).
    """

    weights: Floats

    edge_taken_off: ClassVar[bool] = False

    @property
    def resolution(self) -> float:
        """An edge of the flank (mm): narrower cells would tell nothing more, and their pressures would swing."""
        return float(np.diff(self.flank.arc(self.loads)).max())

    def by_unit_loads(self, lengths: Floats) -> Floats:
        """Linear between vertices."""
        teeth = range(-self.neighbours, self.neighbours + 1)
        tables = np.stack([self.weights.T @ self._normal(tooth) for tooth in teeth])
        result: Floats = np.einsum("nv,tvm->ntm", _between(self.loads, lengths), tables, optimize=True)
        return result

    def parts_of_loads(self, lengths: Floats) -> Floats:
        """Linear between vertices."""
        return _between(self.loads, lengths)


def _between(vertices: Floats, at: Floats) -> Floats:
    """Weights (n, m) of linear interpolation between m vertices at n places."""
    return np.stack([np.interp(at, vertices, unit) for unit in np.eye(len(vertices))], -1)


def nodal_compliance(gear: Gear, ring: Ring, elasticity: PlaneElasticity) -> NodalCompliance:
    """Solve the body for a load at every vertex of the flank; in place of `flank_compliance` in `flexible_pair`.

    Edges of the flank want to be a ninth of the half width of contact.
    """
    mesh = ring.sector.mesh
    flank = flank_of(gear, mesh)
    weights = _hats(flank.arc(flank.lengths))
    inward = flank.inward(flank.lengths)
    forces = np.zeros((2 * len(mesh.points), weights.shape[1]))
    forces[2 * flank.nodes], forces[2 * flank.nodes + 1] = inward[:, :1] * weights, inward[:, 1:] * weights
    displacements, torques = ring.solve(forces)
    nothing = np.zeros_like(forces)
    hub_forces = ring.hub_forces(forces) if ring.support.floats else None
    lengths = flank.lengths[::2]
    return NodalCompliance(flank, ring, elasticity, lengths, displacements, nothing, torques, hub_forces, weights)


def _hats(arc: Floats) -> Floats:
    """Consistent nodal forces (nodes, vertices) of unit loads on quadratic edges, each linear from a vertex to the next."""
    edges = np.diff(arc[::2])
    weights = np.zeros((len(arc), len(edges) + 1))
    for edge, length in enumerate(edges):
        for vertex, near in ((edge, 2 * edge), (edge + 1, 2 * edge + 2)):
            weights[near, vertex] += length / 6
            weights[2 * edge + 1, vertex] += length / 3
    result: Floats = weights / weights.sum(axis=0)
    return result


def stiffness_matrix(mesh: SectorMesh, elasticity: PlaneElasticity, elements: Wholes | None = None) -> Any:
    """Stiffness (scipy CSR, N/mm per mm of width) of the mesh or some elements; dof 2 n is node n in x, 2 n + 1 in y."""
    triangles = mesh.triangles if elements is None else mesh.triangles[elements]
    return summed(triangles, element_stiffness(mesh, elasticity, elements), len(mesh.points))


def summed(triangles: Wholes, matrices: Floats, nodes: int) -> Any:
    """Matrices of elements (m, 12, 12) summed up (scipy CSR, (2 nodes, 2 nodes))."""
    dofs = node_dofs(triangles)
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None])
    return scipy.sparse.csr_matrix((matrices.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * nodes, 2 * nodes))


def tip_loads(mesh: SectorMesh) -> Floats:
    """Unit loads along x and y (2 n, 2) at the tip of a left flank."""
    tip = mesh.sides[OutlineSide.LEFT_FLANK][0]
    loads = np.zeros((2 * len(mesh.points), 2))
    loads[2 * tip, 0], loads[2 * tip + 1, 1] = 1, 1
    return loads
