"""The witness of the hybrid: flanks meshed so finely that the elements carry the contact themselves, nothing taken off.

Fifty times as dear and no better; it is here to show that the hybrid is right.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gearcad.contact.plane.flank import PlaneCompliance, flank_of
from gearcad.contact.plane.ring import Ring
from gearcad.contact.plane.sector import PlaneElasticity
from gearcad.core.records import Floats
from gearcad.geometry import Gear


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
