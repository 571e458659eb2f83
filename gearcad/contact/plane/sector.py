"""A tooth's sector: its stiffness, what the hub does to it, and what of both is left at its cuts.

The dofs of a cut are radial and tangential, so the matrices of all sectors are the same and need no turning. A bore that is
held belongs to a rigid hub with one dof, its turn: the row of that dof is the torque on the hub. A bore that is not held has a
hub that follows it (see `support`): its dofs are the forces that it gives back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.dissection import Dissected, dissect, node_dofs
from gearcad.contact.plane.elasticity import PlaneElasticity, element_forces, element_stiffness
from gearcad.contact.plane.support import held_nodes, hub_tractions, rigid_motions, with_support
from gearcad.contact.shared.chain import Chain
from gearcad.contact.shared.holding import Support
from gearcad.meshing.section import SectorMesh

__all__ = ["CutAxes", "Sector", "chain_of", "make_sector"]


class CutAxes(NamedTuple):
    """Nodes (k,) at the cuts of a sector, and the directions (2, 2, k) of their polar dofs: radial and tangential."""

    nodes: Wholes
    directions: Floats

    @classmethod
    def of(cls, mesh: SectorMesh) -> CutAxes:
        """Those of a mesh."""
        nodes = np.union1d(mesh.behind, mesh.ahead)
        return cls.at(nodes, mesh.points[nodes])

    @classmethod
    def at(cls, nodes: Wholes, points: Floats) -> CutAxes:
        """Of nodes at points (k, 2)."""
        angles = np.arctan2(points[:, 1], points[:, 0])
        cosine, sine = np.cos(angles), np.sin(angles)
        return cls(nodes, np.array([[cosine, sine], [-sine, cosine]]))

    def polar(self, plain: Floats) -> Floats:
        """What is along x and y (dofs, ...) with polar dofs at the cuts."""
        return self._turned(plain, self.directions)

    def plain(self, polar: Floats) -> Floats:
        """What has polar dofs at the cuts along x and y (dofs, ...)."""
        return self._turned(polar, self.directions.swapaxes(0, 1))

    def _turned(self, given: Floats, directions: Floats) -> Floats:
        found = given.copy()
        nodes = found.reshape(-1, 2, *given.shape[1:])
        nodes[self.nodes] = np.einsum("ijk,kj...->ki...", directions, nodes[self.nodes])
        return found


@dataclass(frozen=True)
class Sector:
    """The stiffness of a tooth's sector, and what the hub does to it; dofs are in its own frame, but for those of its cuts.

    `mesh` is the gear's, `whole` has its share of the shaft too, and its elements the `stiffness` (m, 12, 12) in x and y.
    `held` dofs belong to the hub and move with `turn` (dofs,) when it turns by 1 rad; `hub` (dofs, hub) are the forces of its
    dofs, `hub_matrix` what they do to themselves.
    """

    mesh: SectorMesh
    whole: SectorMesh
    axes: CutAxes
    stiffness: Floats
    held: Wholes
    turn: Floats
    hub: Floats
    hub_matrix: Floats

    @property
    def dofs(self) -> int:
        """Dofs of the sector, hub and cuts included."""
        return 2 * len(self.whole.points)

    @cached_property
    def behind(self) -> Wholes:
        """Dofs of the cut behind, radial and tangential in turn, but for those on the hub."""
        return self._free(self.whole.behind)

    @cached_property
    def ahead(self) -> Wholes:
        """Dofs of the cut ahead: the k-th meets the k-th of `behind`."""
        return self._free(self.whole.ahead)

    def _free(self, nodes: Wholes) -> Wholes:
        dofs = node_dofs(nodes)
        return dofs[~np.isin(dofs, self.held)]

    def let_go(self) -> Sector:
        """The same sector with nothing that holds it."""
        nothing = np.zeros_like
        return replace(
            self, held=np.empty(0, int), turn=nothing(self.turn), hub=nothing(self.hub), hub_matrix=nothing(self.hub_matrix)
        )

    def forces(self, moved: Floats) -> Floats:
        """Of the sector (dofs, m) by displacements (dofs, m)."""
        return self.axes.polar(element_forces(self.whole.triangles, self.stiffness, self.axes.plain(moved)))

    def inside(self, loads: Floats) -> Floats:
        """Loads (dofs, m), but for those on cuts and hub."""
        found = loads.copy()
        found[self.condensed.kept] = found[self.held] = 0.0
        return found

    @cached_property
    def condensed(self) -> Dissected:
        """The sector condensed to its cuts while its hub is held; dofs are those in x and y."""
        cuts = np.union1d(self.whole.behind, self.whole.ahead)
        return dissect(self.whole.points, self.whole.triangles, self.stiffness, cuts, self.held[::2] // 2)

    @cached_property
    def at_cuts(self) -> CutAxes:
        """Of the dofs to which it is condensed alone."""
        nodes = self.condensed.kept[::2] // 2
        return CutAxes.at(np.arange(len(nodes)), self.whole.points[nodes])

    @cached_property
    def cut_matrix(self) -> Floats:
        """What it is condensed to, on polar dofs."""
        return self.at_cuts.polar(self.at_cuts.polar(self.condensed.matrix).T).T


def make_sector(mesh: SectorMesh, elasticity: PlaneElasticity, support: Support | None = None) -> Sector:
    """Stiffness of a sector with polar dofs on its cuts."""
    support = support or Support()
    whole = with_support(mesh, support)
    stiffness = element_stiffness(whole, elasticity, np.arange(len(mesh.triangles)))
    if len(whole.triangles) > len(mesh.triangles):
        shaft = PlaneElasticity(support.shaft, elasticity.plane)
        shafts = element_stiffness(whole, shaft, np.arange(len(mesh.triangles), len(whole.triangles)))
        stiffness = np.concatenate([stiffness, shafts])
    held, turn = node_dofs(held_nodes(mesh, support)), np.zeros(2 * len(whole.points))
    turn[held] = rigid_motions(whole.points)[..., 0].ravel()[held]
    axes = CutAxes.of(whole)
    turn, nothing = axes.polar(turn), np.zeros((len(turn), 0))
    sector = Sector(mesh, whole, axes, stiffness, held, turn, nothing, np.zeros((3, 3)))
    if support.floats:
        return replace(sector, hub=axes.polar(hub_tractions(mesh, whole, support)))
    hub = sector.forces(turn[:, None])
    return replace(sector, hub=hub, hub_matrix=turn[None] @ hub)


def chain_of(sector: Sector, onward: Floats | None = None) -> Chain:
    """One sector condensed to its cuts and the hub, whose dofs the next sector sees `onward`."""
    cuts = np.r_[sector.behind, sector.ahead]
    places = np.searchsorted(sector.condensed.kept, cuts)
    arrived = sector.condensed.forward(sector.inside(sector.hub))
    hub = sector.at_cuts.polar(arrived.loads)[places] + sector.hub[cuts]
    matrix = np.block([[sector.cut_matrix[np.ix_(places, places)], hub], [hub.T, sector.hub_matrix - arrived.work]])
    return Chain((matrix + matrix.T) / 2, np.eye(1) if onward is None else onward)
