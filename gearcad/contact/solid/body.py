"""Solid gear body: equal tooth sectors condensed to their cuts, the loaded one and its neighbours expanded again.

Rows are put together from the far end on, so the cuts of the nearest teeth are known on the way back.

A bore that is held, and a cut that is, belong to a rigid hub with one dof, its turn: the row of that dof is the torque. A bore
that is free has a hub that follows it (see `hub`), whose six dofs are the forces that it gives back.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from itertools import pairwise
from threading import Lock
from typing import Any, NamedTuple, Protocol

import numpy as np

from gearcad.contact.shared.bodies import Chain, Cuts, cut_held, polar_turn
from gearcad.contact.solid.condensation import Condensed, Forward, condense
from gearcad.contact.solid.dissection import PARITIES, TURNED, ElementBlock, HalfTurn, dissected
from gearcad.contact.solid.elements import HUB_PARITIES, bore_forces, layer_matrices, rigid_motions, seen_at
from gearcad.contact.solid.fronts import Inside, Reversal, ToothSpan, eliminated, joined, node_dofs, solved_rows
from gearcad.core.records import Floats, Wholes
from gearcad.core.runtime import Share, cores, on_all_cores, one_thread, unheard
from gearcad.material import Material
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.sector import SweptMesh


class _Made(NamedTuple):
    """Results of the condensation: itself, its `forward` of the hub's forces, and the sector as a row."""

    condensed: Condensed
    hub_forward: Forward
    span: ToothSpan


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
        """Return the nodes of a cut of the section that are not on the hub: all but the last, which lies on the bore, if that
        is.
        """
        return cut if self.free else cut[:-1]

    @cached_property
    def hub(self) -> Wholes:
        """Dofs that belong to the hub."""
        return np.empty(0, int) if self.free else node_dofs(self.mesh.over(self.mesh.side(OutlineSide.HELD)))

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
        """Return the matrix (scipy CSR) of `cut_turn` for some nodes (n,)."""
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
        """Return the matrix (scipy CSR, N/mm) over the section's quadrangles, or some of them, in the turning axes."""
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
        """The loads of the hub's forces, carried through the fronts as `Condensed.backward` needs them."""
        return self._made.hub_forward

    @property
    def span(self) -> ToothSpan:
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
        span = ToothSpan((matrices[0], matrices[1]), 1, self._reversal, self.seen_by, self.hub_parities)
        return _Made(condensed, solved, span)

    def _condense(self) -> tuple[Condensed, tuple[Floats, Floats]]:
        section, layers = self.mesh.section, [matrices for _, matrices in self._layers(self.mesh.section.quads)]
        held = np.empty(0, int) if self.free else self.mesh.side(OutlineSide.HELD)

        def matrices_of(box: ElementBlock) -> Floats:
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
        """Parity of each dof of the hub: 1 where it moves the hub evenly, -1 where oddly."""
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
        near = np.flatnonzero(np.isin(self.mesh.section.quads, self.mesh.side(OutlineSide.HELD)).any(axis=1))
        result: Floats = self.cut_turn.T @ (self.stiffness(near) @ (self.cut_turn @ self.hub_turn))
        return result[:, None]

    @cached_property
    def hub_turn(self) -> Floats:
        """Displacements (dofs,) in mm of the dofs of the hub when it turns by 1 rad; 0 at all others."""
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


class Around(Protocol):
    """Response of the sectors beside tooth 0 to its motions, even and odd."""

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        """Return the displacements (n, m) of the cuts ahead of teeth 0, 1 ... by those of the cut behind tooth 0 and the hub
        (hub, m).
        """
        ...


def ring_around(sector: ToothSpan, rest: int, neighbours: int) -> tuple[Around, tuple[Floats, Floats]]:
    """Return the rest of a ring: so many sectors, of which those of `neighbours` on each side are told.

    Second its matrices (n + hub, n + hub), even and odd, on the cut behind tooth 0 and the hub, with the energy of a ToothSpan.
    """
    left = rest - 2 * neighbours
    row, inside = sector.repeated(left) if left else None, []
    for _ in range(neighbours):
        row, each = joined(sector, row)
        inside.append(each)
    assert row is not None  # there is a rest
    n, seen, reversal = sector.cut, sector.seen((rest + 1) / 2), sector.reversal

    def matrix(parity: int) -> Floats:
        given = row.matrices[parity]
        across = PARITIES[parity] * reversal.rows(given[:n, n:]) @ seen
        return np.block([[reversal.both(given[:n, :n]), across], [across.T, seen.T @ given[n:, n:] @ seen]])

    return _RingAround(sector, seen, inside[::-1]), (matrix(0), matrix(1))


@dataclass(frozen=True)
class _RingAround:
    """How the cuts `inside` follow each other, from tooth 0 on; `seen` turns the hub's dofs to those from the middle of the
    rest, which is opposite to tooth 0."""

    sector: ToothSpan
    seen: Floats
    inside: list[Inside]

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        found = [PARITIES[parity] * self.sector.reversal.rows(behind)]
        for inside in self.inside:
            found.append(inside.moved(np.concatenate([found[-1], self.seen @ hub]), parity))
        return found


def sides_around(
    sector: ToothSpan, side: int, neighbours: int, held: Cuts, radii: Floats
) -> tuple[Around, tuple[Floats, Floats]]:
    """Return the response of `side` sectors on each side of the tooth, of which those of `neighbours` are recorded. Nodes of a
    cut are at `radii` (mm).

    Second the matrices as of `ring_around`.
    """
    n, reversal = sector.cut, sector.reversal
    last, lowers = Chain(sector.matrix()).ended(held, radii, ahead=True), []
    for _ in range(side - 1):
        inward, ends = sector.inward(0.0), sector.ends(0.0)
        inward[:, n:] += last[:n, n:]
        ends[n:, n:] += last[n:, n:]
        lower, last = eliminated(reversal.both(sector.near[:, :n]) + last[:n, :n], inward, ends)
        lowers.append(lower)

    def matrix(parity: int) -> Floats:
        across = PARITIES[parity] * reversal.rows(last[:n, n:]) * (sector.hub_parities == PARITIES[parity])
        return np.block([[reversal.both(last[:n, :n]), across], [across.T, last[n:, n:]]])

    return _SidesAround(sector, side, neighbours, held, lowers), (matrix(0), matrix(1))


@dataclass(frozen=True)
class _SidesAround:
    """`lowers` are L (see `factorise`) of the first cut inside rows of 2, 3 ... sectors up to the held cut."""

    sector: ToothSpan
    side: int
    neighbours: int
    held: Cuts
    lowers: list[Floats]

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        n = self.sector.cut
        found = [PARITIES[parity] * self.sector.reversal.rows(behind)]
        for tooth in range(1, self.neighbours + 1):
            force = self.sector.inward(0.0)[:, :n] @ found[-1]
            if tooth < self.side:
                lower = self.lowers[self.side - tooth - 1]
                found.append(-solved_rows(lower, force))
                continue
            moved, free = np.zeros_like(force), ~cut_held(self.held, n, 3)
            matrix = self.sector.reversal.both(self.sector.near[:, :n])
            moved[free] = -np.linalg.solve(matrix[np.ix_(free, free)], force[free])
            found.append(moved)
        return found


_AT_ONCE, _FEWEST = 72, 8
"""The most loads for which the body is solved at once, on all cores - more take more memory - and the fewest on each."""


class Moved(NamedTuple):
    """Displacements (2 k + 1, 3 n, m) of teeth -k ... k in mm, in each one's turning axes; torques on the hub (N mm)."""

    displacements: Floats
    torques: Floats


class _Joints(NamedTuple):
    """Displacements of the cut behind tooth 0, and the hub's dofs (hub, m) as it sees them, even and odd."""

    cuts: tuple[Floats, Floats]
    hub: tuple[Floats, Floats]


class _Closed(NamedTuple):
    """The body put together: how what is beside tooth 0 follows that; of both parities the dofs of the hub that follow the
    bore, and what solves for the cut behind and these; the torque on half the hub that is held, by odd displacements of that
    cut.
    """

    around: Around
    factors: list[tuple[Wholes, Callable[[Floats], Floats]]]
    reaction: Floats


@dataclass(frozen=True)
class SolidBody:
    """A body of equal sectors: tooth 0, and `neighbours` on each side whose displacements are wanted too.

    `rest` sectors beside tooth 0 make up the ring or, `held`, stand half on each side of it, their outer cuts as `cuts` says.
    `tell` hears how much of a solution is done.
    """

    sector: SolidSector
    rest: int
    held: bool
    cuts: Cuts
    neighbours: int
    tell: Share = field(default=unheard, compare=False, repr=False)

    def solve(self, loads: Floats, wanted: Wholes | None = None, *, at: Wholes | None = None) -> Moved:
        """Return the displacements of the nodes `wanted` (n,) of each tooth, and torques, by loads (3 k, m) in N at nodes (k,)
        of tooth 0.

        None are all nodes. Loads and displacements are in the turning axes.
        """
        sector, every = self.sector, np.arange(self.sector.mesh.nodes)
        wanted, at = every if wanted is None else wanted, every if at is None else at
        found = np.empty((2 * self.neighbours + 1, 3 * len(wanted), loads.shape[1]))
        torques = np.empty(loads.shape[1])
        loaded, over, lock = sector.polar_turn_at(at).T, 0, Lock()

        def work(these: slice) -> None:
            nonlocal over
            solved, arriving = sector.condensed.forward(loaded @ loads[:, these], at)
            joints = self._joints(solved, arriving)
            torques[these] = self._torques(solved, joints)
            for tooth, moved in self._teeth(solved, joints, wanted):
                found[self.neighbours + tooth, :, these] = moved
            with lock:
                over += len(torques[these])
                self.tell(over / len(torques))

        with one_thread():  # the cores are taken by what is side by side
            _ = self._closed  # or threads would make it at the same time
            on_all_cores(work, _some_at_a_time(len(torques)))
        turn = sector.polar_turn_at(wanted)
        for each in found:
            each[:] = turn @ each
        return Moved(found, torques)

    def let_go(self) -> None:
        """Drop the parts of solutions; the next solution makes them again."""
        for each in (self, self.sector):
            for name in vars(each).keys() - {own.name for own in fields(each)}:
                del vars(each)[name]

    @cached_property
    def _closed(self) -> _Closed:
        import scipy.linalg

        span, sides = self.sector.span, (self.rest // 2, self.neighbours, self.cuts, self.sector.cut_radii)
        around, beside = sides_around(span, *sides) if self.held else ring_around(span, self.rest, self.neighbours)
        factors: list[tuple[Wholes, Callable[[Floats], Floats]]] = []
        for parity, matrix in enumerate(beside):
            matrix += span.matrices[parity]
            ours = np.flatnonzero(span.hub_parities == PARITIES[parity]) if self.sector.free else np.empty(0, int)
            every = np.r_[np.arange(span.cut), span.cut + ours]
            chosen = matrix[np.ix_(every, every)]
            if len(ours):  # forces for dofs: it is not definite
                factors.append((ours, partial(scipy.linalg.lu_solve, scipy.linalg.lu_factor(chosen))))
            else:
                factors.append((ours, partial(scipy.linalg.cho_solve, scipy.linalg.cho_factor(chosen, lower=True))))
        return _Closed(around, factors, beside[1][-1, : span.cut].copy())

    def _joints(self, solved: Forward, arriving: tuple[Floats, Floats]) -> _Joints:
        span = self.sector.span
        cuts, hubs = [], []
        given = self.sector.hub_forward.dot(solved)
        for (ours, solve), right, own in zip(self._closed.factors, arriving, given, strict=True):
            both = solve(np.concatenate([right, -own[ours]]))
            hub = np.zeros((len(span.hub_parities), right.shape[1]))
            hub[ours] = both[span.cut :]
            cuts.append(both[: span.cut])
            hubs.append(hub)
        return _Joints((cuts[0], cuts[1]), (hubs[0], hubs[1]))

    def _torques(self, solved: Forward, joints: _Joints) -> Floats:
        sector = self.sector
        if sector.free:
            turn = rigid_motions(sector.mesh.points, 0.0)[..., :1]
            per_sector = (sector.cut_turn.T @ sector.mesh.to_turning(turn).ravel()) @ sector.hub_forces
            result: Floats = (self.rest + 1) * per_sector[0] * joints.hub[1][0]
            return result
        own = sector.hub_forward.dot(solved)[1][0]
        reaction: Floats = -2 * (own + self._closed.reaction @ joints.cuts[1])
        return reaction

    def _teeth(self, solved: Forward, joints: _Joints, nodes: Wholes) -> Iterator[tuple[int, Floats]]:
        """Yield every tooth, and the displacements (3 n, m) of nodes of it, in polar axes at the cuts."""
        sector, reversal = self.sector, self.sector.span.reversal
        even, odd = (self._closed.around.cuts(joints.cuts[p], joints.hub[p], p) for p in (0, 1))
        ahead = [one + two for one, two in zip(even, odd, strict=True)]
        behind = [reversal.rows(one - two) for one, two in zip(even, odd, strict=True)]
        hub = joints.hub[0] + joints.hub[1]
        teeth, loads, cuts = [0], [self._with_hub(solved, hub)], [joints.cuts]
        for k in range(1, self.neighbours + 1):
            for tooth, near, far in ((k, ahead[k - 1], ahead[k]), (-k, behind[k], behind[k - 1])):
                turned = reversal.rows(far)
                teeth.append(tooth)
                loads.append(self._with_hub(None, sector.seen_by(tooth) @ hub))
                cuts.append(((near + turned) / 2, (near - turned) / 2))
        yield from zip(teeth, sector.condensed.backward(loads, cuts, nodes), strict=True)

    def _with_hub(self, solved: Forward | None, hub: Floats) -> Forward | None:
        """Return the loads, and the forces of the hub as the sector sees them, in the form that `backward` needs."""
        if not self.sector.free:
            return solved
        even = (self.sector.hub_parities == PARITIES[0])[:, None]
        ours = self.sector.hub_forward.times(-hub * even, -hub * ~even)
        return ours if solved is None else solved.plus(ours)


def _some_at_a_time(loads: int) -> list[slice]:
    """Return slices of about equal length of the loads: half of those solved at once, fewer if more cores share the work."""
    most = max(_AT_ONCE // max(cores(), 2), _FEWEST)
    ends = np.linspace(0, loads, math.ceil(loads / most) + 1).astype(int).tolist()
    return [slice(*each) for each in pairwise(ends)]


def assemble_body(
    mesh: SweptMesh,
    teeth: int,
    neighbours: int,
    material: Material,
    held: int | None,
    cuts: Cuts,
    *,
    free: bool = False,
    condensed: Share = unheard,
    solved: Share = unheard,
) -> SolidBody:
    """Return a ring of `teeth` equal sectors, or a body of `held` teeth (odd, at least 3), its outer cuts as `cuts` says.

    The bore of a ring may be `free`; `condensed` and `solved` hear how much of the condensation is done, and of a solution.
    """
    rest = (teeth if held is None else held) - 1
    # Where the ring has fewer teeth than are asked for, those on both sides would be the same.
    sector = SolidSector(mesh, material, free, condensed)
    return SolidBody(sector, rest, held is not None, cuts, min(neighbours, rest // 2), solved)
