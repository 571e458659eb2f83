"""A gear body put together from equal tooth sectors: some in full, the rest condensed to the cuts between them.

The dofs of a cut are radial and tangential, so the matrices of all sectors are the same and need no turning. The inner circle,
and a cut that is held, belong to a rigid hub with one dof, its turn: the row of that dof is the torque on the hub.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.errors import SolverError
from gearcad.fea.chain import Chain, Cuts
from gearcad.fea.elasticity import PlaneElasticity, stiffness_matrix
from gearcad.meshing import SectorMesh
from gearcad.meshing.outline import Side

__all__ = ["Cuts", "Ring", "assemble"]

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Sector:
    """The matrix of a sector in its own frame, except for the dofs of its cuts; and how its hub nodes move with the hub."""

    mesh: SectorMesh
    matrix: Any
    hub: Floats

    @property
    def dofs(self) -> int:
        """Dofs of the sector, hub and cuts included."""
        return 2 * len(self.mesh.points)


def make_sector(mesh: SectorMesh, elasticity: PlaneElasticity) -> Sector:
    """Stiffness of the sector with polar dofs on its cuts."""
    turn = cut_turn(mesh)
    hub = np.zeros(2 * len(mesh.points))
    inner = mesh.sides[Side.INNER]
    hub[2 * inner], hub[2 * inner + 1] = -mesh.points[inner, 1], mesh.points[inner, 0]
    return Sector(mesh, (turn.T @ stiffness_matrix(mesh, elasticity) @ turn).tocsr(), turn.T @ hub)


def cut_turn(mesh: SectorMesh) -> Any:
    """Matrix (scipy CSR) from dofs with polar cuts to those in x and y of the sector's frame."""
    import scipy.sparse

    angles = np.zeros(len(mesh.points))
    for nodes in (mesh.ahead, mesh.behind):
        angles[nodes] = np.arctan2(mesh.points[nodes, 1], mesh.points[nodes, 0])
    cosine, sine = np.cos(angles), np.sin(angles)
    diagonal, upper, lower = np.repeat(cosine, 2), np.zeros(2 * len(angles) - 1), np.zeros(2 * len(angles) - 1)
    upper[::2], lower[::2] = -sine, sine
    return scipy.sparse.diags([diagonal, upper, lower], [0, 1, -1], format="csr")


def _dofs(nodes: Indices) -> Indices:
    return (2 * nodes[:, None] + np.arange(2)).ravel()


def _cut(nodes: Indices) -> Indices:
    """Dofs of a cut, radial and tangential in turn; its innermost node belongs to the hub."""
    return _dofs(nodes[:-1])


def chain_of(sector: Sector) -> Chain:
    """One sector condensed to its cuts and the hub."""
    cuts = np.r_[_cut(sector.mesh.behind), _cut(sector.mesh.ahead)]
    inside = np.setdiff1d(np.arange(sector.dofs), np.r_[cuts, _dofs(sector.mesh.sides[Side.INNER])])
    motions = np.zeros((sector.dofs, len(cuts) + 1))
    motions[cuts, np.arange(len(cuts))] = 1
    motions[:, -1] = sector.hub
    forces = sector.matrix @ motions
    matrix = motions.T @ forces - forces[inside].T @ _factorise(sector.matrix[inside][:, inside]).solve(forces[inside])
    return Chain((matrix + matrix.T) / 2)


def _factorise(matrix: Any) -> Any:
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

    Sectors in full are tooth -count ... count; the middle one is tooth 0.
    """

    sector: Sector
    dofs: Indices
    matrix: Any
    hub: Floats

    @cached_property
    def _factor(self) -> Any:
        return _factorise(self.matrix)

    def solve(self, loads: Floats) -> tuple[Floats, Floats]:
        """Displacements (sectors, 2 n, m) in the frame of each sector (mm) and torques on the hub (m,) (N mm per mm).

        `loads` (2 n, m) act on tooth 0, in x and y of its frame (N per mm of width).
        """
        turn = cut_turn(self.sector.mesh)
        middle = self.dofs[len(self.dofs) // 2]
        free = middle >= 0
        right = np.zeros((self.matrix.shape[0], loads.shape[1]))
        np.add.at(right, middle[free], (turn.T @ loads)[free])
        solved = self._factor.solve(right)
        padded = np.r_[solved, np.zeros((1, loads.shape[1]))]  # dof -1: the hub stands still
        displacements = np.stack([turn @ padded[row] for row in self.dofs])
        return displacements, -(self.hub @ solved)


def assemble(
    fine: SectorMesh, coarse: SectorMesh, teeth: int, neighbours: int, elasticity: PlaneElasticity, held: int | None, cuts: Cuts
) -> Ring:
    """Tooth 0 and `neighbours` on each side from the fine mesh, the rest of the ring of `teeth` from the coarse one.

    `held` None makes the full ring, else a body of so many teeth (odd, at least those in full), its outer cuts as `cuts` says.
    """
    import scipy.sparse

    sector, full = make_sector(fine, elasticity), 2 * neighbours + 1
    rest = (teeth if held is None else held) - full
    motions = _hub_motions(sector, full, cuts if held is not None and not rest else Cuts.FREE)
    numbers = _number(sector, motions.held, closed=held is None and not rest)
    count = int(numbers.max()) + 1
    entries = sector.matrix.tocoo()
    blocks = [(row[entries.row], row[entries.col], entries.data) for row in numbers]
    hub = np.zeros(count + 1)  # the last collects what acts on the hub itself
    for row, motion in zip(numbers, motions.turn, strict=True):
        np.add.at(hub, row, sector.matrix @ motion)
    if rest:
        chain = chain_of(make_sector(coarse, elasticity))
        behind, ahead = numbers[0][_cut(fine.behind)], numbers[-1][_cut(fine.ahead)]
        if held is None:
            joints = [(np.r_[ahead, behind], chain.repeated(rest).matrix)]
        else:
            side, radii = chain.repeated(rest // 2), np.hypot(*fine.points[fine.ahead[:-1]].T)
            joints = [(ahead, side.ended(cuts, radii, ahead=True)), (behind, side.ended(cuts, radii, ahead=False))]
        for dofs, matrix in joints:
            blocks.append((np.repeat(dofs, len(dofs)), np.tile(dofs, len(dofs)), matrix[:-1, :-1].ravel()))
            np.add.at(hub, dofs, matrix[:-1, -1])
    row, column, value = (np.concatenate(part) for part in zip(*blocks, strict=True))
    free = (row >= 0) & (column >= 0)
    matrix = scipy.sparse.csc_matrix((value[free], (row[free], column[free])), shape=(count, count))
    return Ring(sector, numbers, matrix, hub[:-1])


class _HubMotions(NamedTuple):
    """For each sector in full: which of its dofs are held, and how all move when the hub turns by 1 rad."""

    held: NDArray[np.bool_]
    turn: Floats


def _hub_motions(sector: Sector, full: int, cuts: Cuts) -> _HubMotions:
    mesh = sector.mesh
    held = np.zeros((full, sector.dofs), bool)
    held[:, _dofs(mesh.sides[Side.INNER])] = True
    turn = np.tile(sector.hub, (full, 1))
    for place, nodes in ((0, mesh.behind[:-1]), (-1, mesh.ahead[:-1])) if cuts is not Cuts.FREE else ():
        held[place, 2 * nodes + 1] = True
        held[place, 2 * nodes] |= cuts is Cuts.FIXED
        turn[place, 2 * nodes + 1] = np.hypot(*mesh.points[nodes].T)
    return _HubMotions(held, turn)


def _number(sector: Sector, held: NDArray[np.bool_], *, closed: bool) -> Indices:
    """Global dof of every dof of every sector in full; -1 for those held."""
    behind, ahead = _cut(sector.mesh.behind), _cut(sector.mesh.ahead)
    numbers = np.where(held, -1, -2)
    count = 0
    for place, row in enumerate(numbers):
        if place:
            row[behind] = numbers[place - 1][ahead]
        if closed and place == len(numbers) - 1:
            row[ahead] = numbers[0][behind]
        new = np.flatnonzero(row == -2)
        row[new] = count + np.arange(len(new))
        count += len(new)
    return numbers
