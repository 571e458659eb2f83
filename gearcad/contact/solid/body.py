"""A solid gear body: equal tooth sectors, each condensed to its cuts, the loaded one and its neighbours expanded again.

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
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.shared.chain import Cuts
from gearcad.contact.solid.around import Around, ring_around, sides_around
from gearcad.contact.solid.condensation import Forward
from gearcad.contact.solid.half_turn import PARITIES
from gearcad.contact.solid.hub import rigid_motions
from gearcad.contact.solid.sector import SolidSector
from gearcad.material import Material
from gearcad.meshing.section.swept import SweptMesh
from gearcad.progress import Share, unheard
from gearcad.threads import cores, on_all_cores, one_thread

__all__ = ["Moved", "SolidBody", "SolidSector", "assemble_body"]


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
        """Displacements of the nodes `wanted` (n,) of each tooth, and torques, by loads (3 k, m) in N at nodes (k,) of tooth 0.

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
        """Keep nothing of what solutions are made of: the next one makes it again."""
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
        """Every tooth, and the displacements (3 n, m) of nodes of it, in polar axes at the cuts."""
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
        """What `backward` needs of loads, and of the forces of the hub as the sector sees them."""
        if not self.sector.free:
            return solved
        even = (self.sector.hub_parities == PARITIES[0])[:, None]
        ours = self.sector.hub_forward.times(-hub * even, -hub * ~even)
        return ours if solved is None else solved.plus(ours)


def _some_at_a_time(loads: int) -> list[slice]:
    """Parts of so many loads, of about equal length: half of what is solved at once, less where more cores share it."""
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
    """A ring of `teeth` equal sectors, or a body of `held` teeth (odd, at least 3), its outer cuts as `cuts` says.

    The bore of a ring may be `free`; `condensed` and `solved` hear how much of the condensation is done, and of a solution.
    """
    rest = (teeth if held is None else held) - 1
    # Where the ring has fewer teeth than are asked for, those on both sides would be the same.
    sector = SolidSector(mesh, material, free, condensed)
    return SolidBody(sector, rest, held is not None, cuts, min(neighbours, rest // 2), solved)
