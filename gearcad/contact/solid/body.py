"""A solid gear body: equal tooth sectors, each condensed to its cuts, the loaded one and its neighbours expanded again.

A bore that is held, and a cut that is, belong to a rigid hub with one dof, its turn: the row of that dof is the torque. A bore
that is free has a hub that follows it (see `hub`), whose six dofs are the forces that it gives back.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.chain import Cuts, cut_held
from gearcad.contact.solid.hub import rigid_motions
from gearcad.contact.solid.sector import SolidSector
from gearcad.material import Material
from gearcad.meshing.section.swept import SweptMesh
from gearcad.progress import Share, unheard

__all__ = ["Moved", "SolidBody", "SolidSector", "assemble_body"]


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
        """What stands beside tooth 0: matrix on [its cut behind, its cut ahead, hub]."""
        n, hub = self.sector.chain.cut, len(self.sector.chain.onward)
        if not self.held:
            swap = np.r_[n : 2 * n, 0:n, 2 * n : 2 * n + hub]
            result: Floats = self.sector.chain.repeated(self.rest).seen(self.sector.seen_by(1))[np.ix_(swap, swap)]
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
        cuts, hub = self._joints(solved, arriving)
        found = {0: condensed.backward(self._with_hub(solved, hub), self._placed(cuts))}
        for sense in (1, -1):
            near, far = (cuts[n:], cuts[:n]) if sense > 0 else (cuts[:n], cuts[n:])
            for k in range(1, self.neighbours + 1):
                beyond = self._next_cut(near, far, hub, k, sense)
                both = np.concatenate([near, beyond] if sense > 0 else [beyond, near])
                own = None if hub is None else self._with_hub(None, sector.seen_by(sense * k) @ hub)
                found[sense * k] = condensed.backward(own, self._placed(both))
                near = beyond
        ordered = [sector.cut_turn @ found[tooth] for tooth in range(-self.neighbours, self.neighbours + 1)]
        if hub is None:
            torques = -(sector.hub_forces[:, 0] @ found[0] + self._around[-1, :-1] @ cuts)
        else:
            turn = rigid_motions(sector.mesh.points, 0.0)[..., :1]
            per_sector = (sector.cut_turn.T @ sector.mesh.to_turning(turn).ravel()) @ sector.hub_forces
            torques = (self.rest + 1) * per_sector[0] * hub[0]
        return Moved(np.stack(ordered), torques)

    def _joints(self, solved: list[Floats], arriving: Floats) -> tuple[Floats, Floats | None]:
        """Displacements of the cuts of tooth 0, and the dofs of a hub that follows the bore."""
        count = len(arriving)
        if not self.sector.free:
            stiffness = self.sector.condensed.matrix + self._around[:count, :count]
            return np.asarray(np.linalg.solve(stiffness, arriving), float), None
        moved = sum((hub.T @ load for hub, load in zip(self.sector.hub_solved, solved, strict=True)), start=np.zeros(1))
        both = np.asarray(np.linalg.solve(self.sector.chain.matrix + self._around, np.r_[arriving, -moved]), float)
        return both[:count], both[count:]

    def _with_hub(self, solved: list[Floats] | None, hub: Floats | None) -> list[Floats] | None:
        """What `backward` needs of loads, and of the forces of the hub as the sector sees them."""
        if hub is None:
            return solved
        ours = [-each @ hub for each in self.sector.hub_solved]
        return ours if solved is None else [load + own for load, own in zip(solved, ours, strict=True)]

    def _placed(self, cuts: Floats) -> Floats:
        """Displacements (dofs, m) of nothing but the cuts."""
        moved = np.zeros((self.sector.dofs, cuts.shape[1]))
        moved[self.sector.condensed.kept] = cuts
        return moved

    def _next_cut(self, near: Floats, far: Floats, hub: Floats | None, k: int, sense: int) -> Floats:
        """Displacements of the far cut of the k-th tooth ahead (or behind), from those of its near cut and the hub's dofs.

        `far` is the other cut of tooth 0, at which a full ring ends.
        """
        chain, seen_by = self.sector.chain, self.sector.seen_by
        n = chain.cut
        before, after, own = slice(0, n), slice(n, 2 * n), slice(2 * n, None)
        if sense < 0:
            before, after = after, before
        stiffness, force = chain.matrix[after, after].copy(), -chain.matrix[after, before] @ near
        left = self.rest - k if not self.held else self.rest // 2 - k
        free = np.ones(n, bool)
        if left and not self.held:
            onward = chain.repeated(left).matrix
            stiffness += onward[before, before]
            force -= onward[before, after] @ far
            if hub is not None:
                first = k + 1 if sense > 0 else -k - left
                force -= chain.matrix[after, own] @ seen_by(sense * k) @ hub + onward[before, own] @ seen_by(first) @ hub
        elif left:
            stiffness += chain.repeated(left).ended(self.cuts, self.sector.cut_radii, ahead=sense > 0)[:-1, :-1]
        elif not self.held:
            return far
        else:
            free = ~cut_held(self.cuts, n, 3)
        moved = np.zeros_like(near)
        moved[free] = np.linalg.solve(stiffness[np.ix_(free, free)], force[free])
        return moved


def assemble_body(
    mesh: SweptMesh,
    teeth: int,
    neighbours: int,
    material: Material,
    held: int | None,
    cuts: Cuts,
    *,
    free: bool = False,
    tell: Share = unheard,
) -> SolidBody:
    """A ring of `teeth` equal sectors, or a body of `held` teeth (odd, at least 3), its outer cuts as `cuts` says.

    The bore of a ring may be `free`; `tell` hears how much of the condensation is done.
    """
    rest = (teeth if held is None else held) - 1
    # Where the ring has fewer teeth than are asked for, those on both sides would be the same.
    return SolidBody(SolidSector(mesh, material, free, tell), rest, held is not None, cuts, min(neighbours, rest // 2))
