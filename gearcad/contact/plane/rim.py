"""Responses all round a rim that bends: of teeth too far from the load to stand in full, from the cuts between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.ring import Ring
from gearcad.contact.plane.support import hub_seen_by

__all__ = ["SurfaceStresses", "far_responses"]


class SurfaceStresses(NamedTuple):
    """Stresses (n,) in MPa at points of a surface: sums of `factors` (n, k) with the displacements of `dofs` (n, k)."""

    dofs: Wholes
    factors: Floats

    def by(self, moved: Floats) -> Floats:
        """Those (n, m) by displacements (dofs, m)."""
        result: Floats = np.einsum("nk,nkm->nm", self.factors, moved[self.dofs])
        return result


def far_responses(ring: Ring, rows: SurfaceStresses, displacements: Floats, forces: Floats) -> list[Floats]:
    """What `rows` tell of the displacements of every tooth that does not stand in full.

    `displacements` (sectors, 2 nodes, m) are those of the teeth that do, `forces` (3, m) the hub's. Each tooth has (n, m),
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
    """What `rows` tell, (n, cuts and hub), of a sector in full by the displacements of its cuts and the forces of its hub."""
    sector = ring.sector
    kept = sector.condensed.kept
    cuts, hub = np.r_[sector.behind, sector.ahead], sector.hub.shape[1]
    at_cuts = np.zeros((len(kept), len(cuts) + hub))
    at_cuts[np.searchsorted(kept, cuts), np.arange(len(cuts))] = 1.0
    loads = np.c_[np.zeros((sector.dofs, len(cuts))), -sector.inside(sector.hub)]
    moved = sector.condensed.backward(sector.at_cuts.plain(at_cuts), sector.condensed.forward(loads))
    return rows.by(moved)
