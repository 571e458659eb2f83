"""A solid gear body: the loaded tooth in full, all others condensed to the cuts beside it.

The inner circle, and a cut that is held, belong to a rigid hub with one dof, its turn: the row of that dof is the torque.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.chain import Chain, Cuts, cut_held
from gearcad.ltca.direct import Factor, factorise
from gearcad.ltca.hexahedra import layer_matrices
from gearcad.ltca.swept import SweptMesh
from gearcad.material import Material
from gearcad.meshing.outline import Side

__all__ = ["Moved", "SolidBody", "SolidSector", "assemble_body", "chain_of"]

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

    @cached_property
    def inside(self) -> Indices:
        """All other dofs."""
        return np.setdiff1d(np.arange(self.dofs), np.r_[self.behind, self.ahead, self.hub])

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
    def matrix(self) -> Any:
        """The whole matrix (scipy CSR) with polar cuts."""
        return (self.cut_turn.T @ self.stiffness() @ self.cut_turn).tocsr()

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


def chain_of(sector: SolidSector) -> Chain:
    """One sector condensed to its cuts and the hub: eliminated slab by slab along the axis, by dense blocks."""
    import scipy.linalg

    mesh, matrix = sector.mesh, sector.matrix
    kept = np.r_[sector.behind, sector.ahead]
    count = len(kept) + 1
    motions = np.zeros((sector.dofs, 1))
    motions[:, 0] = sector.hub_turn
    hub = matrix @ motions
    reduced = np.zeros((count, count))
    reduced[:-1, :-1] = matrix[kept][:, kept].toarray()
    reduced[:-1, -1:] = hub[kept]
    reduced[-1:, :-1] = hub[kept].T
    reduced[-1, -1] = (motions.T @ hub).item()
    slab = np.full(sector.dofs, -1)
    slab[sector.inside] = np.repeat(_slabs(mesh), 3)[sector.inside]
    carried: Floats | None = None  # what the slabs so far have left on the next one: [its own block, on the kept dofs]
    coupling = np.zeros((0, count))
    for k in range(mesh.layers + 1):
        own, after = np.flatnonzero(slab == k), np.flatnonzero(slab == k + 1)
        block = matrix[own][:, own].toarray()
        aside = np.c_[matrix[own][:, kept].toarray(), hub[own]]
        if carried is not None:
            block += carried
            aside += coupling
        # [block aside; aside.T reduced]: with block = L L.T what stays is reduced - (L^-1 aside).T (L^-1 aside).
        lower = scipy.linalg.cholesky(block, lower=True, overwrite_a=True)
        across = matrix[own][:, after].toarray()
        both = scipy.linalg.solve_triangular(lower, np.c_[across, aside], lower=True, overwrite_b=True)
        change = both.T @ both
        inner = len(after)
        carried, coupling = -change[:inner, :inner], -change[:inner, inner:]
        reduced -= change[inner:, inner:]
    return Chain((reduced + reduced.T) / 2)


def _slabs(mesh: SweptMesh) -> Indices:
    """The slab (n,) of each node: a plane and the nodes half-way up to the next."""
    section = mesh.section
    planes = np.repeat(np.arange(mesh.layers + 1), len(section.points))
    result: Indices = np.r_[planes, np.repeat(np.arange(mesh.layers), section.vertices)]
    return result


class Moved(NamedTuple):
    """Displacements of teeth -k ... k (2 k + 1, dofs, m) in mm, in each tooth's turning axes, and torques on the hub (N mm)."""

    displacements: Floats
    torques: Floats


@dataclass(frozen=True)
class SolidBody:
    """A body, factorised: tooth 0 in full, and `neighbours` on each side whose displacements are wanted.

    `rest` sectors beside tooth 0 make up the ring or, `held`, stand half on each side of it, their outer cuts as `cuts` says.
    """

    sector: SolidSector
    chain: Chain
    rest: int
    held: bool
    cuts: Cuts
    neighbours: int

    @cached_property
    def _around(self) -> Floats:
        """What stands beside tooth 0: matrix on [its cut behind, its cut ahead, turn of the hub]."""
        n = self.chain.cut
        if not self.held:
            swap = np.r_[n : 2 * n, 0:n, 2 * n]
            result: Floats = self.chain.repeated(self.rest).matrix[np.ix_(swap, swap)]
            return result
        side = self.chain.repeated(self.rest // 2)
        both = np.zeros((2 * n + 1, 2 * n + 1))
        for dofs, ahead in ((np.r_[n : 2 * n], True), (np.r_[0:n], False)):
            place = np.r_[dofs, 2 * n]
            both[np.ix_(place, place)] += side.ended(self.cuts, self.sector.cut_radii, ahead=ahead)
        return both

    @cached_property
    def _free(self) -> Indices:
        sector = self.sector
        return np.sort(np.r_[sector.inside, sector.behind, sector.ahead])

    @cached_property
    def _hub_row(self) -> Floats:
        """Torque on the hub by displacements of the free dofs, negative."""
        row = self.sector.matrix @ self.sector.hub_turn
        row[np.r_[self.sector.behind, self.sector.ahead]] += self._around[:-1, -1]
        result: Floats = row[self._free]
        return result

    @cached_property
    def _coupled(self) -> Factor:
        """Tooth 0 with the others beside it."""
        import scipy.sparse

        cuts, size = np.r_[self.sector.behind, self.sector.ahead], self.sector.dofs
        around = self._around[:-1, :-1]
        beside = scipy.sparse.csr_matrix(
            (around.ravel(), (np.repeat(cuts, len(cuts)), np.tile(cuts, len(cuts)))), shape=(size, size)
        )
        return factorise((self.sector.matrix + beside)[self._free][:, self._free])

    @cached_property
    def _inner(self) -> Factor:
        """A tooth whose cuts are held."""
        inside = self.sector.inside
        return factorise(self.sector.matrix[inside][:, inside])

    def solve(self, loads: Floats) -> Moved:
        """Displacements and torques by loads (dofs, m) in N on tooth 0, in its turning axes."""
        sector, turn = self.sector, self.sector.cut_turn
        solved = self._coupled.solve((turn.T @ loads)[self._free])
        moved = np.zeros((2 * self.neighbours + 1, sector.dofs, loads.shape[1]))
        moved[self.neighbours][self._free] = solved
        torques = -(self._hub_row @ solved)
        own = moved[self.neighbours]
        for sense in (1, -1):
            near, far = own[sector.ahead if sense > 0 else sector.behind], own[sector.behind if sense > 0 else sector.ahead]
            for k in range(1, self.neighbours + 1):
                beyond = self._next_cut(near, far, k, sense)
                behind, ahead = (near, beyond) if sense > 0 else (beyond, near)
                moved[self.neighbours + sense * k] = self._interior(behind, ahead)
                near = beyond
        return Moved(np.stack([turn @ each for each in moved]), torques)

    def _next_cut(self, near: Floats, far: Floats, k: int, sense: int) -> Floats:
        """Displacements of the far cut of the k-th tooth ahead (or behind), from those of its near cut.

        `far` is the other cut of tooth 0, at which a full ring ends.
        """
        n = self.chain.cut
        before, after = slice(0, n), slice(n, 2 * n)
        if sense < 0:
            before, after = after, before
        single = self.chain.matrix
        stiffness, force = single[after, after].copy(), -single[after, before] @ near
        left = self.rest - k if not self.held else self.rest // 2 - k
        free = np.ones(n, bool)
        if left and not self.held:
            onward = self.chain.repeated(left).matrix
            stiffness += onward[before, before]
            force -= onward[before, after] @ far
        elif left:
            stiffness += self.chain.repeated(left).ended(self.cuts, self.sector.cut_radii, ahead=sense > 0)[:-1, :-1]
        elif not self.held:
            return far
        else:
            free = ~cut_held(self.cuts, n, 3)
        moved = np.zeros_like(near)
        moved[free] = np.linalg.solve(stiffness[np.ix_(free, free)], force[free])
        return moved

    def _interior(self, behind: Floats, ahead: Floats) -> Floats:
        """Displacements (dofs, m) of a tooth without load, from those of its cuts."""
        sector = self.sector
        moved = np.zeros((sector.dofs, behind.shape[1]))
        moved[sector.behind], moved[sector.ahead] = behind, ahead
        moved[sector.inside] = -self._inner.solve((sector.matrix @ moved)[sector.inside])
        return moved


def assemble_body(
    fine: SweptMesh, coarse: SweptMesh, teeth: int, neighbours: int, material: Material, held: int | None, cuts: Cuts
) -> SolidBody:
    """Tooth 0 from the fine mesh, the other teeth of the ring condensed from the coarse one.

    `held` None makes the full ring, else a body of so many teeth (odd, 3 or more), its outer cuts as `cuts` says.
    """
    rest = (teeth if held is None else held) - 1
    # Where the ring has fewer teeth than are asked for, those on both sides would be the same.
    neighbours = min(neighbours, rest // 2)
    chain = chain_of(SolidSector(coarse, material))
    return SolidBody(SolidSector(fine, material), chain, rest, held is not None, cuts, neighbours)
