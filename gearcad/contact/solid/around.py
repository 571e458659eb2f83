"""What stands beside the loaded tooth of a solid body: the rest of a ring, or teeth on each side up to cuts that are held.

Rows are put together from the far end on, so the cuts of the nearest teeth are known on the way back.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.chain import Chain, Cuts, cut_held
from gearcad.contact.solid.half_turn import PARITIES
from gearcad.contact.solid.spans import Inside, Span, eliminated, joined

__all__ = ["Around", "RingAround", "SidesAround"]


class Around(Protocol):
    """What stands beside tooth 0, even and odd."""

    def matrix(self, parity: int) -> Floats:
        """Matrix (n + hub, n + hub) on the cut behind tooth 0 and the hub; the energy is as of a Span."""
        ...

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        """Displacements (n, m) of the cuts ahead of teeth 0, 1 ... by those of the cut behind tooth 0 and the hub (hub, m)."""
        ...


@dataclass(frozen=True)
class RingAround:
    """The rest of a ring: so many sectors, of which those of `neighbours` on each side are told."""

    sector: Span
    rest: int
    neighbours: int

    @cached_property
    def _row(self) -> tuple[Span, list[Inside]]:
        """All of it, and how the cuts inside follow each other, from tooth 0 on."""
        left = self.rest - 2 * self.neighbours
        row, inside = self.sector.repeated(left) if left else None, []
        for _ in range(self.neighbours):
            row, each = joined(self.sector, row)
            inside.append(each)
        assert row is not None  # there is a rest
        return row, inside[::-1]

    @property
    def _seen(self) -> Floats:
        """The hub's dofs from the middle of the rest, which is opposite to tooth 0."""
        return self.sector.seen((self.rest + 1) / 2)

    def matrix(self, parity: int) -> Floats:
        n, given, seen = self.sector.cut, self._row[0].matrices[parity], self._seen
        across = PARITIES[parity] * self.sector.reversal.rows(given[:n, n:]) @ seen
        return np.block([[self.sector.reversal.both(given[:n, :n]), across], [across.T, seen.T @ given[n:, n:] @ seen]])

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        found = [PARITIES[parity] * self.sector.reversal.rows(behind)]
        for inside in self._row[1]:
            found.append(inside.moved(np.concatenate([found[-1], self._seen @ hub]), parity))
        return found


@dataclass(frozen=True)
class SidesAround:
    """So many sectors on each side, of which those of `neighbours` are told; nodes of a cut are at `radii` (mm)."""

    sector: Span
    side: int
    neighbours: int
    held: Cuts
    radii: Floats

    @cached_property
    def _steps(self) -> list[tuple[Floats, Floats]]:
        """Matrices on the near cut of 1, 2 ... sectors up to the held one, and the hub, and L of the first cut inside."""
        n, sector = self.sector.cut, self.sector
        last = Chain(sector.matrix()).ended(self.held, self.radii, ahead=True)
        found = [(last, np.empty((0, 0)))]
        for _ in range(self.side - 1):
            inward, ends = sector.inward(0.0), sector.ends(0.0)
            inward[:, n:] += last[:n, n:]
            ends[n:, n:] += last[n:, n:]
            lower, last = eliminated(sector.reversal.both(sector.near[:, :n]) + last[:n, :n], inward, ends)
            found.append((last, lower))
        return found

    def matrix(self, parity: int) -> Floats:
        n, (given, _) = self.sector.cut, self._steps[-1]
        across = PARITIES[parity] * self.sector.reversal.rows(given[:n, n:]) * (self.sector.hub_parities == PARITIES[parity])
        return np.block([[self.sector.reversal.both(given[:n, :n]), across], [across.T, given[n:, n:]]])

    def cuts(self, behind: Floats, hub: Floats, parity: int) -> list[Floats]:
        import scipy.linalg

        n = self.sector.cut
        found = [PARITIES[parity] * self.sector.reversal.rows(behind)]
        for tooth in range(1, self.neighbours + 1):
            force = self.sector.inward(0.0)[:, :n] @ found[-1]
            if tooth < self.side:
                lower = self._steps[self.side - tooth][1]
                found.append(-scipy.linalg.cho_solve((lower, True), force, check_finite=False))
                continue
            moved, free = np.zeros_like(force), ~cut_held(self.held, n, 3)
            matrix = self.sector.reversal.both(self.sector.near[:, :n])
            moved[free] = -np.linalg.solve(matrix[np.ix_(free, free)], force[free])
            found.append(moved)
        return found
