"""A solid gear body: equal tooth sectors, each condensed to its cuts, the loaded one and its neighbours expanded again.

The inner circle, and a cut that is held, belong to a rigid hub with one dof, its turn: the row of that dof is the torque.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.chain import Chain, Cuts, cut_held
from gearcad.ltca.condensation import Condensed, condense, parts_of
from gearcad.ltca.hexahedra import layer_matrices
from gearcad.ltca.swept import SweptMesh
from gearcad.material import Material
from gearcad.meshing.outline import Side

__all__ = ["Moved", "SolidBody", "SolidSector", "assemble_body"]

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class SolidSector:
    """One tooth and its share of the body, its vectors in the turning axes, at the cuts radial and tangential."""

    mesh: SweptMesh
    material: Material

    @property
    def dofs(self) -> int:
        """Dofs of the sector, hub and cuts included."""
        return 3 * self.mesh.nodes

    @cached_property
    def behind(self) -> Indices:
        """Dofs of the cut behind, but for those on the hub."""
        return _dofs(self.mesh.over(self.mesh.section.behind[:-1]))

    @cached_property
    def ahead(self) -> Indices:
        """Dofs of the cut ahead, but for those on the hub: the k-th meets the k-th of `behind`."""
        return _dofs(self.mesh.over(self.mesh.section.ahead[:-1]))

    @cached_property
    def hub(self) -> Indices:
        """Dofs on the inner circle."""
        return _dofs(self.mesh.over(self.mesh.side(Side.INNER)))

    @property
    def cut_radii(self) -> Floats:
        """Radii (mm) of the nodes of a cut."""
        nodes = self.mesh.over(self.mesh.section.ahead[:-1])
        result: Floats = np.hypot(*self.mesh.in_section[nodes].T)
        return result

    @cached_property
    def cut_turn(self) -> Any:
        """Matrix (scipy CSR) from dofs with polar cuts to those in x, y, z of the turning axes."""
        import scipy.sparse

        angles = np.zeros(self.mesh.nodes)
        for nodes in (self.mesh.section.ahead, self.mesh.section.behind):
            every = self.mesh.over(nodes)
            angles[every] = np.arctan2(*self.mesh.in_section[every].T[::-1])
        cosine, sine, z = np.cos(angles), np.sin(angles), np.ones(len(angles))
        diagonal, upper, lower = np.stack([cosine, cosine, z], -1).ravel(), np.zeros(self.dofs - 1), np.zeros(self.dofs - 1)
        upper[::3], lower[::3] = -sine, sine
        return scipy.sparse.diags([diagonal, upper, lower], [0, 1, -1], format="csr")

    def stiffness(self, quads: Indices | None = None) -> Any:
        """Matrix (scipy CSR, N/mm) over the section's quadrangles, or some of them, in the turning axes."""
        import scipy.sparse

        chosen = self.mesh.section.quads if quads is None else self.mesh.section.quads[quads]
        row, column, value = [], [], []
        for layer, matrices in self._layers(chosen):
            dofs = _dofs(self.mesh.elements(chosen, layer)).reshape(len(chosen), 60).astype(np.int32)
            row.append(np.repeat(dofs, 60, axis=1).ravel())
            column.append(np.tile(dofs, (1, 60)).ravel())
            value.append(matrices.ravel())
        triple = (np.concatenate(part) for part in (value, row, column))
        values, rows, columns = triple
        return scipy.sparse.csr_matrix((values, (rows, columns)), shape=(self.dofs, self.dofs))

    def _layers(self, quads: Indices):  # type: ignore[no-untyped-def]
        """Each layer with the matrices of its hexahedra; equally thick layers share them."""
        known: dict[float, Floats] = {}
        for layer, thickness in enumerate(np.diff(self.mesh.planes)):
            key = round(float(thickness), 9)
            if key not in known:
                known[key] = layer_matrices(self.mesh, quads, layer, self.material)
            yield layer, known[key]

    @cached_property
    def condensed(self) -> Condensed:
        """The sector with its hub held, condensed to its cuts."""
        section, held = self.mesh.section, self.mesh.side(Side.INNER)
        part = parts_of(section.points, section.quads, np.r_[section.behind, section.ahead, held])
        layers = list(self._layers(section.quads))
        local = np.full(self.dofs, -1)

        def matrix_of(quads: Indices) -> tuple[Indices, Floats]:
            elements = [_dofs(self.mesh.elements(section.quads[quads], layer)) for layer, _ in layers]
            dofs = np.setdiff1d(np.concatenate(elements), self.hub)
            local[dofs] = np.arange(len(dofs))
            size = len(dofs) + 1  # the last row and column collect what is held
            matrix = np.zeros(size * size)
            for numbers, (_, matrices) in zip(elements, layers, strict=True):
                place = local[numbers] % size
                np.add.at(matrix, (place[:, :, None] * size + place[:, None, :]).ravel(), matrices[quads].ravel())
            local[dofs] = -1
            turn = self.cut_turn[dofs][:, dofs]
            return dofs, turn.T @ (turn.T @ matrix.reshape(size, size)[:-1, :-1]).T

        return condense(part, lambda nodes: np.sort(_dofs(self.mesh.over(nodes))), matrix_of, np.r_[self.behind, self.ahead])

    @cached_property
    def chain(self) -> Chain:
        """The sector alone as a chain: on its cuts and the turn of its hub."""
        condensed = self.condensed
        solved, arriving = condensed.forward(self.hub_forces[:, None])
        count = len(condensed.kept)
        matrix = np.zeros((count + 1, count + 1))
        matrix[:-1, :-1] = condensed.matrix
        matrix[:-1, -1:] = arriving
        matrix[-1:, :-1] = arriving.T
        matrix[-1, -1] = self.hub_turn @ self.hub_forces - sum(float((each**2).sum()) for each in solved)
        return Chain(matrix)

    @cached_property
    def hub_forces(self) -> Floats:
        """Forces (dofs,) by the hub's turn of 1 rad with all else held (N)."""
        near = np.flatnonzero(np.isin(self.mesh.section.quads, self.mesh.side(Side.INNER)).any(axis=1))
        result: Floats = self.cut_turn.T @ (self.stiffness(near) @ (self.cut_turn @ self.hub_turn))
        return result

    @cached_property
    def hub_turn(self) -> Floats:
        """How the dofs of the hub move when it turns by 1 rad (mm)."""
        x, y = self.mesh.in_section.T
        motion = np.stack([-y, x, np.zeros(len(x))], -1).ravel()
        held = np.zeros(self.dofs)
        held[self.hub] = motion[self.hub]
        result: Floats = self.cut_turn.T @ held
        return result


def _dofs(nodes: Indices) -> Indices:
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


class Moved(NamedTuple):
    """Displacements of teeth -k ... k (2 k + 1, dofs, m) in mm, in each tooth's turning axes, and torques on the hub (N mm)."""

    displacements: Floats
    torques: Floats


@dataclass(frozen=True)
class SolidBody:
    """A body of equal sectors: tooth 0, and `neighbours` on each side whose displacements are wanted too.

    `rest` sectors beside tooth 0 make up the ring or, `held`, stand half on each side of it, their outer cuts as `cuts` says.
    """

    sector: SolidSector
    rest: int
    held: bool
    cuts: Cuts
    neighbours: int

    @cached_property
    def _around(self) -> Floats:
        """What stands beside tooth 0: matrix on [its cut behind, its cut ahead, turn of the hub]."""
        n = self.sector.chain.cut
        if not self.held:
            swap = np.r_[n : 2 * n, 0:n, 2 * n]
            result: Floats = self.sector.chain.repeated(self.rest).matrix[np.ix_(swap, swap)]
            return result
        side = self.sector.chain.repeated(self.rest // 2)
        both = np.zeros((2 * n + 1, 2 * n + 1))
        for dofs, ahead in ((np.r_[n : 2 * n], True), (np.r_[0:n], False)):
            place = np.r_[dofs, 2 * n]
            both[np.ix_(place, place)] += side.ended(self.cuts, self.sector.cut_radii, ahead=ahead)
        return both

    def solve(self, loads: Floats) -> Moved:
        """Displacements and torques by loads (dofs, m) in N on tooth 0, in its turning axes."""
        sector, condensed = self.sector, self.sector.condensed
        n = sector.chain.cut
        solved, arriving = condensed.forward(sector.cut_turn.T @ loads)
        cuts = np.asarray(np.linalg.solve(condensed.matrix + self._around[:-1, :-1], arriving), float)
        found = {0: condensed.backward(solved, self._placed(cuts))}
        torques = -(sector.hub_forces @ found[0] + self._around[-1, :-1] @ cuts)
        for sense in (1, -1):
            near, far = (cuts[n:], cuts[:n]) if sense > 0 else (cuts[:n], cuts[n:])
            for k in range(1, self.neighbours + 1):
                beyond = self._next_cut(near, far, k, sense)
                both = np.concatenate([near, beyond] if sense > 0 else [beyond, near])
                found[sense * k] = condensed.backward(None, self._placed(both))
                near = beyond
        ordered = [sector.cut_turn @ found[tooth] for tooth in range(-self.neighbours, self.neighbours + 1)]
        return Moved(np.stack(ordered), torques)

    def _placed(self, cuts: Floats) -> Floats:
        """Displacements (dofs, m) of nothing but the cuts."""
        moved = np.zeros((self.sector.dofs, cuts.shape[1]))
        moved[self.sector.condensed.kept] = cuts
        return moved

    def _next_cut(self, near: Floats, far: Floats, k: int, sense: int) -> Floats:
        """Displacements of the far cut of the k-th tooth ahead (or behind), from those of its near cut.

        `far` is the other cut of tooth 0, at which a full ring ends.
        """
        chain = self.sector.chain
        n = chain.cut
        before, after = slice(0, n), slice(n, 2 * n)
        if sense < 0:
            before, after = after, before
        stiffness, force = chain.matrix[after, after].copy(), -chain.matrix[after, before] @ near
        left = self.rest - k if not self.held else self.rest // 2 - k
        free = np.ones(n, bool)
        if left and not self.held:
            onward = chain.repeated(left).matrix
            stiffness += onward[before, before]
            force -= onward[before, after] @ far
        elif left:
            stiffness += chain.repeated(left).ended(self.cuts, self.sector.cut_radii, ahead=sense > 0)[:-1, :-1]
        elif not self.held:
            return far
        else:
            free = ~cut_held(self.cuts, n, 3)
        moved = np.zeros_like(near)
        moved[free] = np.linalg.solve(stiffness[np.ix_(free, free)], force[free])
        return moved


def assemble_body(mesh: SweptMesh, teeth: int, neighbours: int, material: Material, held: int | None, cuts: Cuts) -> SolidBody:
    """A ring of `teeth` equal sectors, or a body of `held` teeth (odd, at least 3), its outer cuts as `cuts` says."""
    rest = (teeth if held is None else held) - 1
    # Where the ring has fewer teeth than are asked for, those on both sides would be the same.
    return SolidBody(SolidSector(mesh, material), rest, held is not None, cuts, min(neighbours, rest // 2))
