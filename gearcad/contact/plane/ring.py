"""Plane gear body: a ring of equal tooth sectors, some in full and the rest condensed; responses round a rim that bends.

A cut that is held belongs to the rigid hub. Of a ring on bolts only the sectors that have one are held.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.contact.plane.sector import Arrived, PlaneElasticity, Sector, chain_of, hub_seen_by, make_sector, rigid_motions
from gearcad.contact.shared.bodies import Chain, Cuts, Support
from gearcad.core.records import Floats, Wholes
from gearcad.meshing.sector import SectorMesh


@dataclass(frozen=True)
class Ring:
    """The assembled body, condensed: `dofs` (sectors, 2 n) numbers the dofs of each sector in full, -1 for those of the hub.

    Sectors in full are tooth -count ... count; the middle one is tooth 0. `parts` are these, each held by the hub or not;
    `cuts` (k,) the dofs between them, to which they are condensed, and `matrix` (k, k) is that of the whole body on them.
    `hub` (dofs, hub) and `hub_matrix` are those of the hub, and `motions` (dofs, 3) the rigid motions of a body whose hub
    follows it; the hub of another stands still.
    """

    sector: Sector
    dofs: Wholes
    parts: tuple[Sector, ...]
    cuts: Wholes
    matrix: Floats
    hub: Floats
    hub_matrix: Floats
    motions: Floats | None
    support: Support
    chain: Chain | None

    def solve(self, loads: Floats) -> tuple[Floats, Floats]:
        """Return the displacements (sectors, 2 n, m) in the frame of each sector (mm) and torques on the hub (m,) (N mm per
        mm).

        `loads` (2 n, m) act on tooth 0, in x and y of its frame (N per mm of width).
        """
        right = self._on_dofs(loads)
        if self.motions is None:
            solved = self._solved(right)
            torques: Floats = -(self.hub[:, 0] @ solved)
        else:
            forces = self.hub_forces(loads)
            solved = self._solved(right - self.hub @ forces)
            grip = self.hub.T @ self.motions
            moved = self.hub.T @ solved + self.hub_matrix @ forces
            solved -= self.motions @ np.asarray(np.linalg.solve(grip, moved), float)
            torques = grip[:, 0] @ forces
        padded = np.r_[solved, np.zeros((1, loads.shape[1]))]  # dof -1: the hub stands still
        displacements = np.stack([self.sector.axes.plain(padded[row])[: len(loads)] for row in self.dofs])
        return displacements, torques

    def _solved(self, right: Floats) -> Floats:
        """Return the displacements (dofs, m) by forces (dofs, m)."""
        padded = np.r_[right, np.zeros((1, right.shape[1]))]
        left, arrived = np.zeros_like(padded), dict[int, Arrived]()
        left[self.cuts] = right[self.cuts]
        for place, (part, row) in enumerate(zip(self.parts, self.dofs, strict=True)):
            loads = part.inside(padded[row])
            if loads.any():
                arrived[place] = part.condensed.forward(loads)
                np.add.at(left, row[part.condensed.kept], part.at_cuts.polar(arrived[place].loads))
        moved = np.zeros_like(padded)
        moved[self.cuts] = np.linalg.solve(self._sprung, left[self.cuts])
        for place, (part, row) in enumerate(zip(self.parts, self.dofs, strict=True)):
            kept = part.condensed.kept
            at_cuts = moved[row[kept]]
            inner = part.condensed.backward(part.at_cuts.plain(at_cuts), arrived.get(place))
            inner[kept] = at_cuts
            moved[row] = inner
            moved[-1] = 0.0
        result: Floats = moved[:-1]
        return result

    @cached_property
    def _sprung(self) -> Floats:
        """Matrix. For a body that nothing holds, add three springs at motions that balanced loads do not excite."""
        if self.motions is None:
            return self.matrix
        import scipy.linalg

        _, _, order = scipy.linalg.qr(self.motions[self.cuts].T, mode="economic", pivoting=True)
        springs = np.zeros(len(self.cuts))
        springs[order[:3]] = self.matrix.diagonal()[order[:3]]
        return self.matrix + np.diag(springs)

    def hub_forces(self, loads: Floats) -> Floats:
        """Return the dofs (3, m) of a hub that follows the bore, which balance loads (2 n, m) on tooth 0."""
        assert self.motions is not None  # the hub of a bore that is held has none
        return np.asarray(np.linalg.solve(self.motions.T @ self.hub, self.motions.T @ self._on_dofs(loads)), float)

    def _on_dofs(self, loads: Floats) -> Floats:
        given = np.zeros((self.sector.dofs, loads.shape[1]))
        given[: len(loads)] = loads
        middle = self.dofs[len(self.dofs) // 2]
        free = middle >= 0
        right = np.zeros((len(self.hub), loads.shape[1]))
        np.add.at(right, middle[free], self.sector.axes.polar(given)[free])
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
    """Return the tooth 0 and `neighbours` on each side from the fine mesh, the rest of the ring of `teeth` from the coarse one.

    `held` None makes the full ring, else a body of so many teeth (odd, at least those in full), its outer cuts as `cuts` says,
    whose bore must be held.
    """
    support = support or Support()
    full, offsets = 2 * neighbours + 1, range(-neighbours, neighbours + 1)
    rest = (teeth if held is None else held) - full
    sector = make_sector(fine, elasticity, support)
    motions = _hub_motions(sector, offsets, support, cuts if held is not None and not rest else Cuts.FREE)
    numbers = _number(sector, motions.held, closed=held is None and not rest)
    count = int(numbers.max()) + 1
    hub, hub_matrix = np.zeros((count + 1, sector.hub.shape[1])), np.zeros_like(sector.hub_matrix)
    for row, turn, tooth in zip(numbers, motions.turn, offsets, strict=True):
        forces = sector.hub @ hub_seen_by(tooth, support) if support.floats else sector.forces(turn[:, None])
        np.add.at(hub, row, forces)  # the last row collects what acts on the hub itself
    let_go = sector.let_go() if support.bolts else sector
    parts = tuple(sector if support.holds(tooth) else let_go for tooth in offsets)
    blocks = [(row[part.condensed.kept], part.cut_matrix) for part, row in zip(parts, numbers, strict=True)]
    other = make_sector(coarse, elasticity, support) if rest else None
    chain = chain_of(other, hub_seen_by(1, support)) if other else None
    between = chain_of(other.let_go(), hub_seen_by(1, support)) if other and support.bolts else None
    for dofs, matrix in _joints(sector, chain, between, support, numbers, rest, held is None, cuts):
        n = len(dofs)
        blocks.append((dofs, matrix[:n, :n]))
        np.add.at(hub, dofs, matrix[:n, n:])
        hub_matrix += matrix[n:, n:]
    at_cuts, matrix = _joined(blocks)
    rigid = _rigid(sector, numbers, support, count) if support.floats else None
    return Ring(sector, numbers, parts, at_cuts, matrix, hub[:-1], hub_matrix, rigid, support, chain)


def _joined(blocks: list[tuple[Wholes, Floats]]) -> tuple[Wholes, Floats]:
    """Return the dofs (k,) of matrices, each once, and the sum (k, k) of all; dof -1 is left out."""
    every = np.unique(np.concatenate([dofs for dofs, _ in blocks]))
    matrix = np.zeros((len(every), len(every)))
    for dofs, block in blocks:
        places = np.searchsorted(every, dofs)
        np.add.at(matrix, (places[:, None], places), block)
    first = int(every[0] < 0)
    return every[first:], matrix[first:, first:]


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
    """Return dofs and matrices of the body beyond the sectors in full, each matrix on [dofs, hub as tooth 0 sees it].

    `chain` is a sector that is held, `between` one that stands between bolts; they are None where there are none.
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
    own = sector.axes.polar(rigid_motions(sector.whole.points).reshape(-1, 3))
    for place, row in enumerate(numbers):
        found[row] = own @ hub_seen_by(place - len(numbers) // 2, support)
    return found


class _HubMotions(NamedTuple):
    """Dofs of each sector in full: which of them are held, and how all move when the hub turns by 1 rad."""

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


class SurfaceStresses(NamedTuple):
    """Stresses (n,) in MPa at points of a surface: sums of `factors` (n, k) with the displacements of `dofs` (n, k)."""

    dofs: Wholes
    factors: Floats

    def by(self, moved: Floats) -> Floats:
        """Return the stresses (n, m) in MPa by displacements (dofs, m)."""
        result: Floats = np.einsum("nk,nkm->nm", self.factors, moved[self.dofs])
        return result


def far_responses(ring: Ring, rows: SurfaceStresses, displacements: Floats, forces: Floats) -> list[Floats]:
    """Return the stresses (n, m) in MPa by `rows` of every tooth that does not stand in full.

    `displacements` (sectors, 2 nodes, m) are those of the teeth in full, `forces` (3, m) those of the hub. The teeth follow
    counter-clockwise from the last of those in full.
    """
    sector, chain = ring.sector, ring.chain
    if chain is None:
        return []
    across = _from_cuts(ring, rows)
    count, teeth = len(displacements), ring.support.teeth
    beyond = [chain]  # so many sectors in a row
    for _ in range(teeth - count - 1):
        beyond.append(chain.followed_by(beyond[-1]))
    n = chain.cut
    near, end = sector.axes.polar(displacements[-1])[sector.ahead], sector.axes.polar(displacements[0])[sector.behind]
    found = []
    for tooth in range(count // 2 + 1, teeth - count // 2):
        left = teeth - count // 2 - 1 - tooth
        hub, after = hub_seen_by(tooth, ring.support) @ forces, end
        if left:
            onward = beyond[left - 1].matrix
            known = chain.matrix[n : 2 * n] @ np.r_[near, 0 * near, hub]
            known += onward[:n] @ np.r_[0 * near, end, hub_seen_by(tooth + 1, ring.support) @ forces]
            after = -np.linalg.solve(chain.matrix[n : 2 * n, n : 2 * n] + onward[:n, :n], known)
        found.append(across @ np.r_[near, after, hub])
        near = after
    return found


def _from_cuts(ring: Ring, rows: SurfaceStresses) -> Floats:
    """Return the stresses (n, cuts and hub) by `rows` of a sector in full, by displacements of its cuts and forces of its hub.

    Each is for a unit displacement or force.
    """
    sector = ring.sector
    kept = sector.condensed.kept
    cuts, hub = np.r_[sector.behind, sector.ahead], sector.hub.shape[1]
    at_cuts = np.zeros((len(kept), len(cuts) + hub))
    at_cuts[np.searchsorted(kept, cuts), np.arange(len(cuts))] = 1.0
    loads = np.c_[np.zeros((sector.dofs, len(cuts))), -sector.inside(sector.hub)]
    moved = sector.condensed.backward(sector.at_cuts.plain(at_cuts), sector.condensed.forward(loads))
    return rows.by(moved)
