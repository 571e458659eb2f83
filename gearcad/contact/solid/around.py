"""What stands beside the loaded tooth of a solid body: the rest of a ring, or teeth on each side up to cuts that are held.

Rows are put together from the far end on, so the cuts of the nearest teeth are known on the way back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.chain import Chain, Cuts, cut_held
from gearcad.contact.solid.dense import solved_rows
from gearcad.contact.solid.half_turn import PARITIES
from gearcad.contact.solid.spans import Inside, Span, eliminated, joined

__all__ = ["Around", "ring_around", "sides_around"]


class Around(Protocol):
    """How what stands beside tooth 0 follows that, even and odd."""

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        """Displacements (n, m) of the cuts ahead of teeth 0, 1 ... by those of the cut behind tooth 0 and the hub (hub, m)."""
        ...


def ring_around(sector: Span, rest: int, neighbours: int) -> tuple[Around, tuple[Floats, Floats]]:
    """The rest of a ring: so many sectors, of which those of `neighbours` on each side are told.

    Second its matrices (n + hub, n + hub), even and odd, on the cut behind tooth 0 and the hub; the energy is as of a Span.
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

    sector: Span
    seen: Floats
    inside: list[Inside]

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        found = [PARITIES[parity] * self.sector.reversal.rows(behind)]
        for inside in self.inside:
            found.append(inside.moved(np.concatenate([found[-1], self.seen @ hub]), parity))
        return found


def sides_around(sector: Span, side: int, neighbours: int, held: Cuts, radii: Floats) -> tuple[Around, tuple[Floats, Floats]]:
    """So many sectors on each side, of which those of `neighbours` are told; nodes of a cut are at `radii` (mm).

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
    """`lowers` are L (see `dense`) of the first cut inside rows of 2, 3 ... sectors up to the held cut."""

    sector: Span
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
