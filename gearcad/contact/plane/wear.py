"""Worn flanks of plane sections: depth as cubic splines over the roll, and what Archard's law takes off in a mesh cycle.

A flank that carries F' (N/mm) while it slides by ds (mm) against its mate loses the area k F' ds (mm²) of its section. Pressure
and sliding are those of the loaded contact. The splines add up to 1 at every place, and what is lost is shared by their values
there: so a profile holds all of the volume that was taken off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.plane.pair import KnownContacts, PlanePair
from gearcad.contact.shared.line_of_action import LineOfAction, TransverseFlank
from gearcad.core.records import Floats, PerGear, Role, freeze
from gearcad.geometry.tooth_friction import sliding_levers

_DEGREE = 3
_SWEEP = (np.arange(5) + 0.5) / 5 - 0.5
"""Places of a contact between its position and its neighbours, in steps from one to the next."""


@dataclass(frozen=True)
class WearGrid:
    """Cubic splines over the roll lengths (mm) of a flank, from `first` to `last`, between so many `spans`."""

    first: float
    last: float
    base_radius: float
    spans: int

    @cached_property
    def knots(self) -> Floats:
        """Knots (mm of roll), those at both ends as often as the splines need them."""
        inner = np.linspace(self.first, self.last, self.spans + 1)
        found: Floats = np.r_[np.full(_DEGREE, self.first), inner, np.full(_DEGREE, self.last)]
        return found

    @cached_property
    def areas(self) -> Floats:
        """Area (n,) in mm² under each spline of height 1 mm: along the flank, whose length grows by s/r_b of the roll s."""
        inner = np.linspace(self.first, self.last, self.spans + 1)
        nodes, weights = np.polynomial.legendre.leggauss(4)
        half = (inner[1:] - inner[:-1])[:, None] / 2
        places = (inner[1:] + inner[:-1])[:, None] / 2 + half * nodes
        lengths = half * weights * places / self.base_radius
        found: Floats = self.values(places.ravel()).T @ lengths.ravel()
        return found

    def values(self, lengths: Floats) -> Floats:
        """Return the splines (m, n) at roll lengths (m,); places beyond the ends count as the ends."""
        from scipy.interpolate import BSpline

        inside = np.clip(lengths, self.first, self.last)
        found: Floats = BSpline.design_matrix(inside, self.knots, _DEGREE).toarray()
        return found


@dataclass(frozen=True)
class WornFlank(TransverseFlank):
    """A flank that has lost some depth (mm), as coefficients (n,) of the splines of its `grid`, behind its own form."""

    grid: WearGrid
    worn: Floats

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import BSpline

        return BSpline(self.grid.knots, self.worn, _DEGREE)

    def depth(self, lengths: Floats) -> Floats:
        lost: Floats = self._spline(np.clip(lengths, self.grid.first, self.grid.last))
        return super().depth(lengths) + lost


@dataclass(frozen=True, eq=False)
class WornLine(LineOfAction):
    """The line of action of worn flanks, none of which is an involute."""

    @property
    def exact(self) -> bool:
        """False: wear leaves no involute."""
        return False


def worn_pair(model: PlanePair, grids: PerGear[WearGrid], worn: PerGear[Floats]) -> PlanePair:
    """Return the same bodies with flanks that have lost `worn` (mm), coefficients of their grids; the bodies stay as stiff."""
    line = model.line
    flanks = PerGear.each(
        lambda role: WornFlank(line.flanks.pick(role).form, line.flanks.pick(role).height, grids.pick(role), worn.pick(role))
    )
    made = WornLine(line.whole, line.pitch, flanks, line.module, line.proud)
    return replace(model, line=made, known=KnownContacts())


def flank_grids(model: PlanePair, spans: int) -> PerGear[WearGrid]:
    """Return the grids of both flanks of a pair."""
    return PerGear.each(lambda role: _grid(model.line.flanks.pick(role), spans))


def _grid(flank: TransverseFlank, spans: int) -> WearGrid:
    return WearGrid(flank.first, flank.last, flank.base_radius, spans)


@dataclass(frozen=True, kw_only=True)
class CycleWear:
    """Loss of both flanks in one passage of a tooth through the mesh, for a wear coefficient of 1 mm²/N.

    `lost` are the areas (n,) in mm² at the splines of each gear's flank, `work` (N, per mm of width and mm of sliding) the sum
    of force times sliding: a flank loses as much as that, whatever its splines.
    """

    lost: PerGear[Floats]
    work: float

    def __post_init__(self) -> None:
        freeze(self)


def cycle_wear(cycle: PlaneCycle, grids: PerGear[WearGrid]) -> CycleWear:
    """Return what the even positions of a cycle take off both flanks; each stands for the turn from one to the next."""
    pair = cycle.model.gear_pair
    step = 2 * math.pi / pair.pinion.teeth / len(cycle.positions)
    lost = grids.map(lambda grid: np.zeros(grid.spans + _DEGREE))
    work = 0.0
    for position in cycle.positions:
        for contact in position.contacts:
            taken = contact.force * float(sliding_levers(pair, contact.place)) * step
            work += taken
            for role, places, weights in _places(cycle, contact, step):
                lost.pick(role)[:] += taken * (weights @ grids.pick(role).values(places))
    return CycleWear(lost=lost, work=work)


def _places(cycle: PlaneCycle, contact: PlanePairContact, step: float) -> Iterator[tuple[Role, Floats, Floats]]:
    """Yield the roll lengths (m,) of a gear's flank that a contact passes around a position, and their parts of it (m,).

    The edge of a tip keeps its place on its own flank.
    """
    sweep = cycle.model.base_radius * step * _SWEEP
    pressed = contact.pressures > 0
    weights = np.repeat(contact.pressures[pressed], len(_SWEEP))
    for role in Role:
        own = sweep if contact.arms.pick(role) == 1 else 0 * sweep
        yield role, (contact.pair.cells.lengths.pick(role)[pressed][:, None] + own).ravel(), weights / weights.sum()
