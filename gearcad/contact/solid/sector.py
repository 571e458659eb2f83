"""One tooth of a solid body and its share of the rest: its stiffness, and the same condensed to its cuts and its hub."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.shared.chain import polar_turn
from gearcad.contact.solid.condensation import Condensed, Forward, condense
from gearcad.contact.solid.dissection import Box, dissected
from gearcad.contact.solid.fronts import node_dofs
from gearcad.contact.solid.half_turn import PARITIES, TURNED, HalfTurn
from gearcad.contact.solid.hexahedra import layer_matrices
from gearcad.contact.solid.hub import HUB_PARITIES, bore_forces, seen_at
from gearcad.contact.solid.spans import Reversal, Span
from gearcad.material import Material
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.swept import SweptMesh
from gearcad.progress import Share, unheard

__all__ = ["SolidSector"]


class _Made(NamedTuple):
    """What comes of the condensation: itself, its `forward` of the hub's forces, and the sector as a row."""

    condensed: Condensed
    hub_forward: Forward
    span: Span


@dataclass(frozen=True)
class SolidSector:
    """One tooth and its share of the body, its vectors in the turning axes, at the cuts radial and tangential.

    Its bore is held by the hub, or `free`. `tell` hears how much of its condensation is done.
    """

    mesh: SweptMesh
    material: Material
    free: bool = False
    tell: Share = field(default=unheard, compare=False, repr=False)

    @property
    def dofs(self) -> int:
        """Dofs of the sector, hub and cuts included."""
        return 3 * self.mesh.nodes

    @cached_property
    def behind(self) -> Wholes:
        """Dofs of the cut behind, but for those on the hub."""
        return node_dofs(self.mesh.over(self._off_hub(self.mesh.section.behind)))

    @cached_property
    def ahead(self) -> Wholes:
        """Dofs of the cut ahead, but for those on the hub: the k-th meets the k-th of `behind`."""
        return node_dofs(self.mesh.over(self._off_hub(self.mesh.section.ahead)))

    def _off_hub(self, cut: Wholes) -> Wholes:
        """The nodes of a cut of the section that are not on the hub: all but the last, which lies on the bore, if that is."""
        return cut if self.free else cut[:-1]

    @cached_property
    def hub(self) -> Wholes:
        """Dofs that belong to the hub."""
        return np.empty(0, int) if self.free else node_dofs(self.mesh.over(self.mesh.side(Side.HELD)))

    @property
    def cut_radii(self) -> Floats:
        """Radii (mm) of the nodes of a cut."""
        nodes = self.mesh.over(self._off_hub(self.mesh.section.ahead))
        result: Floats = np.hypot(*self.mesh.in_section[nodes].T)
        return result

    @cached_property
    def cut_turn(self) -> Any:
        """Matrix (scipy CSR) from dofs with polar cuts to those in x, y, z of the turning axes."""
        return polar_turn(self._cut_angles, 3)

    def polar_turn_at(self, nodes: Wholes) -> Any:
        """The same of some nodes (n,)."""
        return polar_turn(self._cut_angles[nodes], 3)

    @cached_property
    def _cut_angles(self) -> Floats:
        """Angles (rad) of the nodes of the cuts, 0 for all others."""
        angles = np.zeros(self.mesh.nodes)
        for nodes in (self.mesh.section.ahead, self.mesh.section.behind):
            every = self.mesh.over(nodes)
            angles[every] = np.arctan2(*self.mesh.in_section[every].T[::-1])
        return angles

    def stiffness(self, quads: Wholes | None = None) -> Any:
        """Matrix (scipy CSR, N/mm) over the section's quadrangles, or some of them, in the turning axes."""
        import scipy.sparse

        chosen = self.mesh.section.quads if quads is None else self.mesh.section.quads[quads]
        row, column, value = [], [], []
        for layer, matrices in self._layers(chosen):
            dofs = node_dofs(self.mesh.elements(chosen, layer)).reshape(len(chosen), 60).astype(np.int32)
            row.append(np.repeat(dofs, 60, axis=1).ravel())
            column.append(np.tile(dofs, (1, 60)).ravel())
            value.append(matrices.ravel())
        triple = (np.concatenate(part) for part in (value, row, column))
        values, rows, columns = triple
        return scipy.sparse.csr_matrix((values, (rows, columns)), shape=(self.dofs, self.dofs))

    def _layers(self, quads: Wholes):  # type: ignore[no-untyped-def]
        """Each layer with the matrices of its hexahedra; equally thick layers share them."""
        known: dict[float, Floats] = {}
        for layer, thickness in enumerate(np.diff(self.mesh.planes)):
            key = round(float(thickness), 9)
            if key not in known:
                known[key] = layer_matrices(self.mesh, quads, layer, self.material)
            yield layer, known[key]

    @cached_property
    def half_turn(self) -> HalfTurn:
        """The turn that leaves the sector as it is."""
        return HalfTurn(self.mesh)

    @property
    def condensed(self) -> Condensed:
        """The sector with its hub held, condensed to its cuts."""
        return self._made.condensed

    @property
    def hub_forward(self) -> Forward:
        """What `backward` needs of the hub's forces."""
        return self._made.hub_forward

    @property
    def span(self) -> Span:
        """The sector alone as a row of sectors: on its cuts and its hub."""
        return self._made.span

    @cached_property
    def _made(self) -> _Made:
        condensed, at_cut = self._condense()
        solved, arriving = condensed.forward(self.hub_forces, np.arange(self.mesh.nodes))
        own = np.zeros((1, 1)) if self.free else self.hub_turn[None] @ self.hub_forces / 2
        inner, matrices = solved.dot(solved), []
        for parity in (0, 1):
            across = arriving[parity]
            others = self.hub_parities != PARITIES[parity]
            hub = own - inner[parity]
            across[:, others] = hub[others] = hub[:, others] = 0.0
            matrices.append(np.block([[at_cut[parity], across], [across.T, hub]]))
        span = Span((matrices[0], matrices[1]), 1, self._reversal, self.seen_by, self.hub_parities)
        return _Made(condensed, solved, span)

    def _condense(self) -> tuple[Condensed, tuple[Floats, Floats]]:
        section, layers = self.mesh.section, [matrices for _, matrices in self._layers(self.mesh.section.quads)]
        held = np.empty(0, int) if self.free else self.mesh.side(Side.HELD)

        def matrices_of(box: Box) -> Floats:
            matrices = np.concatenate([layers[layer][box.quads] for layer in range(box.first, box.last)])
            return self._with_polar_cuts(box.nodes(self.mesh), matrices)

        halves = dissected(self.half_turn, np.r_[section.behind, section.ahead], held)
        return condense(self.half_turn, halves, self.behind[::3] // 3, matrices_of, self.tell)

    def _with_polar_cuts(self, nodes: Wholes, matrices: Floats) -> Floats:
        """Matrices (m, 60, 60) of hexahedra with nodes (m, 20), in dofs that are radial and tangential at the cuts."""
        angles = self._cut_angles[nodes]
        at_cut = np.flatnonzero(angles.any(axis=1))
        if not len(at_cut):
            return matrices
        turn = polar_turn(angles[at_cut].ravel(), 3)
        blocks = matrices[at_cut].reshape(-1, 60)
        half = (turn.T @ blocks).reshape(-1, 60, 60).transpose(0, 2, 1).reshape(-1, 60)
        matrices[at_cut] = (turn.T @ half).reshape(-1, 60, 60).transpose(0, 2, 1)
        return matrices

    @cached_property
    def _reversal(self) -> Reversal:
        nodes = self.half_turn.nodes[self.ahead[::3] // 3]  # of the cut behind, at whose places the nodes ahead come
        behind = self.behind[::3] // 3
        place = np.argsort(behind)
        image = place[np.searchsorted(behind, nodes, sorter=place)]
        return Reversal(node_dofs(image), np.tile(TURNED, len(image)))

    @property
    def hub_parities(self) -> Floats:
        """Which dofs of the hub move it evenly (1), and which oddly (-1)."""
        return HUB_PARITIES if self.free else HUB_PARITIES[:1]

    @property
    def seen_by(self) -> Callable[[float], Floats]:
        """Dofs of the hub as a sector so many teeth ahead sees them, from those that the loaded one sees."""
        if not self.free:
            return _seen_alike
        nodes = self.mesh.section.points[[self.mesh.section.ahead[0], self.mesh.section.behind[0]]]
        ahead, behind = np.arctan2(nodes[:, 1], nodes[:, 0])
        return partial(_seen, float(ahead - behind))

    @cached_property
    def hub_forces(self) -> Floats:
        """Forces (dofs, hub) by the hub's turn of 1 rad with all else held (N), or by each of the forces of a free bore."""
        if self.free:
            free: Floats = self.cut_turn.T @ bore_forces(self.mesh)
            return free
        near = np.flatnonzero(np.isin(self.mesh.section.quads, self.mesh.side(Side.HELD)).any(axis=1))
        result: Floats = self.cut_turn.T @ (self.stiffness(near) @ (self.cut_turn @ self.hub_turn))
        return result[:, None]

    @cached_property
    def hub_turn(self) -> Floats:
        """How the dofs of the hub move when it turns by 1 rad (mm)."""
        x, y = self.mesh.in_section.T
        motion = np.stack([-y, x, np.zeros(len(x))], -1).ravel()
        held = np.zeros(self.dofs)
        held[self.hub] = motion[self.hub]
        result: Floats = self.cut_turn.T @ held
        return result


def _seen(pitch: float, teeth: float) -> Floats:
    return seen_at(pitch * teeth)


def _seen_alike(_teeth: float) -> Floats:
    return np.eye(1)
