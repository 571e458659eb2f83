"""A gear body put together from equal tooth sectors: some in full, the rest condensed to the cuts between them.

The dofs of a cut are radial and tangential, so the matrices of all sectors are the same and need no turning. A bore that is
held, and a cut that is, belong to a rigid hub with one dof, its turn: the row of that dof is the torque on the hub. A bore
that is not held has a hub that follows it (see `support`): its dofs are the forces that it gives back. Of a ring on bolts only
the sectors that have one are held.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.elasticity import PlaneElasticity, stiffness_matrix
from gearcad.contact.plane.support import held_nodes, hub_seen_by, hub_tractions, rigid_motions, with_support
from gearcad.contact.shared.chain import Chain, Cuts, polar_turn
from gearcad.contact.shared.holding import Support
from gearcad.errors import SolverError
from gearcad.meshing.section import SectorMesh

__all__ = ["Ring", "Sector", "assemble", "chain_of", "factorise", "make_sector"]


@dataclass(frozen=True)
class Sector:
    """The matrix of a tooth's sector in its own frame, except for the dofs of its cuts; and what the hub does to it.

    `mesh` is the gear's, `whole` has its share of the shaft too. `held` dofs belong to the hub and move with `turn` (dofs,)
    when it turns by 1 rad; `hub` (dofs, hub) are the forces of its dofs, `hub_matrix` what they do to themselves.
    """

    mesh: SectorMesh
    whole: SectorMesh
    matrix: Any
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
        dofs = _dofs(nodes)
        return dofs[~np.isin(dofs, self.held)]

    def let_go(self) -> Sector:
        """The same sector with nothing that holds it."""
        nothing = np.zeros_like
        return replace(
            self, held=np.empty(0, int), turn=nothing(self.turn), hub=nothing(self.hub), hub_matrix=nothing(self.hub_matrix)
        )

    @cached_property
    def cut_turn(self) -> Any:
        """Matrix (scipy CSR) from dofs with polar cuts to those in x and y of the sector's frame."""
        return _cut_turn(self.whole)


def make_sector(mesh: SectorMesh, elasticity: PlaneElasticity, support: Support | None = None) -> Sector:
    """Stiffness of a sector with polar dofs on its cuts."""
    support = support or Support()
    whole = with_support(mesh, support)
    polar = _cut_turn(whole)
    stiffness = stiffness_matrix(whole, elasticity, np.arange(len(mesh.triangles)))
    if len(whole.triangles) > len(mesh.triangles):
        shaft = PlaneElasticity(support.shaft, elasticity.plane)
        stiffness = stiffness + stiffness_matrix(whole, shaft, np.arange(len(mesh.triangles), len(whole.triangles)))
    matrix = (polar.T @ stiffness @ polar).tocsr()
    held, turn = _dofs(held_nodes(mesh, support)), np.zeros(2 * len(whole.points))
    turn[held] = rigid_motions(whole.points)[..., 0].ravel()[held]
    turn = polar.T @ turn
    if support.floats:
        return Sector(mesh, whole, matrix, held, turn, polar.T @ hub_tractions(mesh, whole, support), np.zeros((3, 3)))
    hub = (matrix @ turn)[:, None]
    return Sector(mesh, whole, matrix, held, turn, hub, turn[None] @ hub)


def _cut_turn(mesh: SectorMesh) -> Any:
    angles = np.zeros(len(mesh.points))
    for nodes in (mesh.ahead, mesh.behind):
        angles[nodes] = np.arctan2(mesh.points[nodes, 1], mesh.points[nodes, 0])
    return polar_turn(angles, 2)


def _dofs(nodes: Wholes) -> Wholes:
    return (2 * nodes[:, None] + np.arange(2)).ravel()


def chain_of(sector: Sector, onward: Floats | None = None) -> Chain:
    """One sector condensed to its cuts and the hub, whose dofs the next sector sees `onward`."""
    cuts = np.r_[sector.behind, sector.ahead]
    inside = np.setdiff1d(np.arange(sector.dofs), np.r_[cuts, sector.held])
    forces = np.c_[sector.matrix[:, cuts].toarray(), sector.hub]
    matrix = np.block([[forces[cuts, : len(cuts)], sector.hub[cuts]], [sector.hub[cuts].T, sector.hub_matrix]])
    matrix -= forces[inside].T @ factorise(sector.matrix[inside][:, inside]).solve(forces[inside])
    return Chain((matrix + matrix.T) / 2, np.eye(1) if onward is None else onward)


def factorise(matrix: Any) -> Any:
    """Sparse LU for symmetric positive matrices; raises SolverError."""
    import scipy.sparse.linalg

    try:
        return scipy.sparse.linalg.splu(
            matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True}
        )
    except RuntimeError as error:
        raise SolverError(f"the stiffness matrix of a gear body could not be factorised ({error})") from error


@dataclass(frozen=True)
class Ring:
    """The assembled body, factorised: `dofs` (sectors, 2 n) numbers the dofs of each sector in full, -1 for those of the hub.

    Sectors in full are tooth -count ... count; the middle one is tooth 0. `hub` (dofs, hub) and `hub_matrix` are those of the
    hub, and `motions` (dofs, 3) the rigid motions of a body whose hub follows it; the hub of another stands still.
    """

    sector: Sector
    dofs: Wholes
    matrix: Any
    hub: Floats
    hub_matrix: Floats
    motions: Floats | None
    support: Support
    chain: Chain | None

    @cached_property
    def _factor(self) -> Any:
        if self.motions is None:
            return factorise(self.matrix)
        import scipy.linalg
        import scipy.sparse

        # Three springs hold what no load moves, as all loads are balanced.
        _, _, order = scipy.linalg.qr(self.motions.T, mode="economic", pivoting=True)
        springs = np.zeros(len(self.motions))
        springs[order[:3]] = self.matrix.diagonal()[order[:3]]
        return factorise(self.matrix + scipy.sparse.diags(springs))

    def solve(self, loads: Floats) -> tuple[Floats, Floats]:
        """Displacements (sectors, 2 n, m) in the frame of each sector (mm) and torques on the hub (m,) (N mm per mm).

        `loads` (2 n, m) act on tooth 0, in x and y of its frame (N per mm of width).
        """
        right = self._on_dofs(loads)
        if self.motions is None:
            solved: Floats = self._factor.solve(right)
            torques: Floats = -(self.hub[:, 0] @ solved)
        else:
            forces = self.hub_forces(loads)
            solved = self._factor.solve(right - self.hub @ forces)
            grip = self.hub.T @ self.motions
            moved = self.hub.T @ solved + self.hub_matrix @ forces
            solved -= self.motions @ np.asarray(np.linalg.solve(grip, moved), float)
            torques = grip[:, 0] @ forces
        padded = np.r_[solved, np.zeros((1, loads.shape[1]))]  # dof -1: the hub stands still
        displacements = np.stack([(self.sector.cut_turn @ padded[row])[: len(loads)] for row in self.dofs])
        return displacements, torques

    def hub_forces(self, loads: Floats) -> Floats:
        """Dofs (3, m) of a hub that follows the bore, which balance loads (2 n, m) on tooth 0."""
        assert self.motions is not None  # the hub of a bore that is held has none
        return np.asarray(np.linalg.solve(self.motions.T @ self.hub, self.motions.T @ self._on_dofs(loads)), float)

    def _on_dofs(self, loads: Floats) -> Floats:
        given = np.zeros((self.sector.dofs, loads.shape[1]))
        given[: len(loads)] = loads
        middle = self.dofs[len(self.dofs) // 2]
        free = middle >= 0
        right = np.zeros((self.matrix.shape[0], loads.shape[1]))
        np.add.at(right, middle[free], (self.sector.cut_turn.T @ given)[free])
        return right


def assemble(
    fine: SectorMesh,
    coarse: SectorMesh,
    teeth: int,
    neighbours: int,
    elasticity: PlaneElasticity,
    held: int | None,
    cuts: Cuts,
    support: Support | None = None,
) -> Ring:
    """Tooth 0 and `neighbours` on each side from the fine mesh, the rest of the ring of `teeth` from the coarse one.

    `held` None makes the full ring, else a body of so many teeth (odd, at least those in full), its outer cuts as `cuts` says,
    whose bore must be held.
    """
    import scipy.sparse

    support = support or Support()
    full, offsets = 2 * neighbours + 1, range(-neighbours, neighbours + 1)
    rest = (teeth if held is None else held) - full
    sector = make_sector(fine, elasticity, support)
    motions = _hub_motions(sector, offsets, support, cuts if held is not None and not rest else Cuts.FREE)
    numbers = _number(sector, motions.held, closed=held is None and not rest)
    count = int(numbers.max()) + 1
    entries = sector.matrix.tocoo()
    blocks = [(row[entries.row], row[entries.col], entries.data) for row in numbers]
    hub, hub_matrix = np.zeros((count + 1, sector.hub.shape[1])), np.zeros_like(sector.hub_matrix)
    for row, turn, tooth in zip(numbers, motions.turn, offsets, strict=True):
        forces = sector.hub @ hub_seen_by(tooth, support) if support.floats else (sector.matrix @ turn)[:, None]
        np.add.at(hub, row, forces)  # the last row collects what acts on the hub itself
    other = make_sector(coarse, elasticity, support) if rest else None
    chain = chain_of(other, hub_seen_by(1, support)) if other else None
    between = chain_of(other.let_go(), hub_seen_by(1, support)) if other and support.bolts else None
    for dofs, matrix in _joints(sector, chain, between, support, numbers, rest, held is None, cuts):
        n = len(dofs)
        blocks.append((np.repeat(dofs, n), np.tile(dofs, n), matrix[:n, :n].ravel()))
        np.add.at(hub, dofs, matrix[:n, n:])
        hub_matrix += matrix[n:, n:]
    row, column, value = (np.concatenate(part) for part in zip(*blocks, strict=True))
    free = (row >= 0) & (column >= 0)
    matrix = scipy.sparse.csc_matrix((value[free], (row[free], column[free])), shape=(count, count))
    rigid = _rigid(sector, numbers, support, count) if support.floats else None
    return Ring(sector, numbers, matrix, hub[:-1], hub_matrix, rigid, support, chain)


def _joints(
    sector: Sector,
    chain: Chain | None,
    between: Chain | None,
    support: Support,
    numbers: Wholes,
    rest: int,
    closed: bool,
    cuts: Cuts,
) -> list[tuple[Wholes, Floats]]:
    """What stands beyond the sectors in full: matrices on [dofs, hub as tooth 0 sees it].

    `chain` is a sector that is held, `between` one that stands between bolts, None where there are none.
    """
    if chain is None:
        return []
    behind, ahead = numbers[0][sector.behind], numbers[-1][sector.ahead]
    if between is not None:
        first = len(numbers) // 2 + 1
        row = (chain if support.holds(tooth) else between for tooth in range(first, first + rest))
        return [(np.r_[ahead, behind], reduce(Chain.followed_by, row).matrix)]
    if closed:
        return [(np.r_[ahead, behind], chain.repeated(rest).seen(hub_seen_by(len(numbers) // 2 + 1, support)))]
    side, radii = chain.repeated(rest // 2), np.hypot(*sector.whole.points[sector.ahead[::2] // 2].T)
    return [(ahead, side.ended(cuts, radii, ahead=True)), (behind, side.ended(cuts, radii, ahead=False))]


def _rigid(sector: Sector, numbers: Wholes, support: Support, count: int) -> Floats:
    """Rigid motions (dofs, 3) of the body - a turn, and shifts along the axes of tooth 0 - by the numbers of its dofs."""
    found = np.zeros((count, 3))
    own = sector.cut_turn.T @ rigid_motions(sector.whole.points).reshape(-1, 3)
    for place, row in enumerate(numbers):
        found[row] = own @ hub_seen_by(place - len(numbers) // 2, support)
    return found


class _HubMotions(NamedTuple):
    """For each sector in full: which of its dofs are held, and how all move when the hub turns by 1 rad."""

    held: NDArray[np.bool_]
    turn: Floats


def _hub_motions(sector: Sector, teeth: range, support: Support, cuts: Cuts) -> _HubMotions:
    on_hub = np.array([support.holds(tooth) for tooth in teeth])
    held = np.zeros((len(teeth), sector.dofs), bool)
    held[np.ix_(on_hub, sector.held)] = True
    turn = np.where(on_hub[:, None], sector.turn, 0.0)
    for place, dofs in ((0, sector.behind), (-1, sector.ahead)) if cuts is not Cuts.FREE else ():
        held[place, dofs[1::2]] = True
        held[place, dofs[::2]] |= cuts is Cuts.FIXED
        turn[place, dofs[1::2]] = np.hypot(*sector.whole.points[dofs[1::2] // 2].T)
    return _HubMotions(held, turn)


def _number(sector: Sector, held: NDArray[np.bool_], *, closed: bool) -> Wholes:
    """Global dof of every dof of every sector in full; -1 for those held."""
    numbers = np.where(held, -1, -2)
    count = 0
    for place, row in enumerate(numbers):
        if place:
            row[sector.behind] = numbers[place - 1][sector.ahead]
        if closed and place == len(numbers) - 1:
            row[sector.ahead] = numbers[0][sector.behind]
        new = np.flatnonzero(row == -2)
        row[new] = count + np.arange(len(new))
        count += len(new)
    return numbers
