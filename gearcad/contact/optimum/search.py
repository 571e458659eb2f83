"""The search for tip relief and crowning: least transmission error under one torque, pressure and tip edges kept in bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.optimum.lattice import Goal, Lattice, Remembered
from gearcad.contact.optimum.variants import Condition, Outcomes, Variants

__all__ = ["Found", "Search", "conditions"]


_ROUGH = 2
"""Of that many positions a survey takes one."""

_STEPS = np.array([1.0, 0.05, 1.0, 0.05, 1.0, 1.0])
_DECIMALS = 2
"""To what amounts (µm) and lengths (mm) are rounded, and to how many decimals that is."""

_OVER_PRESSURE = 10.0
_ON_EDGE = (0.1, 10.0)
"""What it costs, in deflections of the teeth, to be above the bound by all of it, and to carry all load on the edge of a tip:
where that is only unwelcome, and where it is not permitted."""

_FREE = 2e-3
"""Share of the load up to which the edges of tips count as free."""

_WITHIN = 1e-3
"""Share by which a bound may be passed over: less than the pressures are exact."""

_OUT_OF_REACH = 1.1
"""Share of a bound above which the pressures of all a survey saw leave no hope: it goes where they are low."""

_NEAR = 0.01
_NEAR_MOST = 48
"""Variants count as near the best up to this share above it; at most so many of them."""

_NEVER = 1e9
"""Score of a variant whose contact does not settle."""

_GENERATIONS = 15
_STARTS = 8
"""Generations of a survey, and from how many of its best places the search goes on."""

_MISALIGNMENT = 10.0
_PITCH_ERROR = 10.0
"""Misalignment (µm) over the common face width and pitch error (µm) of a tooth that a proposal should bear, on top of those of
the mounting.
"""


def conditions(torque: float) -> tuple[Condition, ...]:
    """What a proposal should bear: parts of the torque, the wheel's axis turned either way, and a pitch error."""
    parts = [Condition(part * torque) for part in (0.25, 0.5, 0.75, 1.0)]
    turned = [Condition(torque, misalignment=sign * _MISALIGNMENT) for sign in (1, -1)]
    return (*parts, *turned, Condition(torque, pitch_error=_PITCH_ERROR))


@dataclass(frozen=True)
class Found:
    """What a search came to: the amounts (6,), the bound (MPa), and what becomes of the flanks.

    `tried` variants were solved for it under the torque, roughly or in full, those that were known before included.
    """

    amounts: Floats
    bound: float
    outcome: Outcomes
    tried: int = 0

    @property
    def bounded(self) -> bool:
        """Whether the pressure keeps to the bound."""
        return bool(self.outcome.pressures[0] <= self.bound * (1 + _WITHIN))

    @property
    def edges_free(self) -> bool:
        """Whether the edges of the tips are out of contact."""
        return bool(self.outcome.edge_shares[0] <= _FREE)

    @property
    def peak_to_peak(self) -> float:
        """Of the transmission error (µm)."""
        return float(self.outcome.peak_to_peak[0])


@dataclass(frozen=True)
class Search:
    """Variants between `low` and `high` (6,) under a torque (N·m).

    `plain` is what becomes of the flanks without reliefs and crowning, their helix angle made up for a misalignment;
    `surveyed` are places that were solved roughly before.
    """

    variants: Variants
    torque: float
    low: Floats
    high: Floats
    start: Floats
    plain: Outcomes
    surveyed: Remembered | None = field(default=None, repr=False)

    @property
    def deflection(self) -> float:
        """The greatest transmission error (µm) of plain flanks."""
        return float(self.plain.transmission_errors.max())

    def outcomes(self, amounts: Floats, condition: Condition | None = None) -> Outcomes:
        """What becomes of variants (v, 6)."""
        return self.variants.outcomes(amounts, condition or Condition(self.torque))

    def best(self, bounds: Sequence[float]) -> Found:
        """The proposal for the first of the bounds (MPa) that can be kept, else for the last.

        Without contact on the edges of the tips, unless that costs more than half of what is gained.
        """
        for bound in bounds:
            places = self._survey(bound)
            if bound != bounds[-1] and Outcomes.from_figures(self._rough(places)).pressures.min() > _OUT_OF_REACH * bound:
                continue
            found = self._settled(bound, places)
            if found.bounded:
                break
        return replace(self._worth_its_price(found, places), tried=self._rough.count + self._full.count)

    def closer(self, angles: Floats) -> Search:
        """Return the search at further positions, at roll angles (deg); places that its survey solved are kept."""
        variants = replace(self.variants, more=(*self.variants.more, *angles.tolist()))
        return replace(self, variants=variants, surveyed=self._rough)

    def again(self, found: Found, bound: float) -> Found:
        """Return the proposal for another bound (MPa), from `found` and the best places of the survey on."""
        places = self._rough.places
        settled = self._worth_its_price(self._settled(bound, places, first=found), places)
        return replace(settled, tried=found.tried + self._full.count)

    def better(self, found: Found, bound: float, count: int) -> list[Found]:
        """Return at most `count` proposals near `found` that are better and keep to a bound (MPa), the best first."""
        places, here = self._lattice.near(_nearest(found.amounts)), _nearest(found.amounts)[None]
        goal = self._goal(self._full, bound, edges=not found.edges_free)
        values = goal.at(places)
        kept = (Outcomes.from_figures(self._full(places)).pressures <= bound) & (values < goal.at(here)[0])
        best = np.flatnonzero(kept)[np.argsort(values[kept], kind="stable")][:count]
        return [
            replace(found, amounts=each, outcome=self.outcomes(each[None]), tried=found.tried + len(places))
            for each in _amounts(places[best])
        ]

    def _worth_its_price(self, found: Found, places: Wholes) -> Found:
        """The proposal that leaves the edges of tips free, if it is worth that; else the one with contact there."""
        if found.edges_free or not found.bounded:
            return found
        strict = self._settled(found.bound, places, edges=False, first=found)
        worth = strict.peak_to_peak <= self.dearest(found.peak_to_peak)
        return strict if strict.bounded and strict.edges_free and worth else found

    def dearest(self, peak_to_peak: float) -> float:
        """What (µm) edges of tips out of contact may cost against a peak to peak: half of what that gains on plain flanks."""
        return (peak_to_peak + float(self.plain.peak_to_peak[0])) / 2

    def scores(self, found: Outcomes, bound: float, *, edges: bool) -> Floats:
        """What is to be least (v,): peak to peak of the transmission error in µm, and what broken bounds cost."""
        on_edge = self.deflection * _ON_EDGE[0 if edges else 1] * found.edge_shares
        over = self.price(found.pressures, bound)
        return np.nan_to_num(found.peak_to_peak + over + on_edge, nan=_NEVER, posinf=_NEVER)

    def price(self, pressures: Floats, bound: float) -> Floats:
        """Return what (µm) pressures (MPa) above the bound cost."""
        result: Floats = self.deflection * _OVER_PRESSURE * np.maximum(pressures / bound - 1, 0.0)
        return result

    def _survey(self, bound: float) -> Wholes:
        """Places (v, 6) all over, the most of them where variants are good."""
        return self._lattice.survey(self._goal(self._rough, bound, edges=True), _GENERATIONS, _nearest(self.start))

    def _settled(self, bound: float, places: Wholes, *, edges: bool = True, first: Found | None = None) -> Found:
        """The proposal to which the best of the places lead, and that which was found `first`."""
        lattice, goal = self._lattice, self._goal(self._full, bound, edges=edges)
        rough = self._goal(self._rough, bound, edges=edges)
        starts = lattice.best_apart(places, rough.at(places), _STARTS)
        if first is not None:
            starts = np.unique(np.vstack([_nearest(first.amounts), starts]), axis=0)
        ends = lattice.descend(goal, starts)
        values = goal.at(ends)
        while True:
            best = ends[values.argmin()]
            ends = np.unique(np.concatenate([ends, lattice.around(best)]), axis=0)
            values = goal.at(ends)
            if values.min() >= goal.at(best[None])[0]:
                break
        amounts = self._robust(ends, values, bound)
        return Found(amounts, bound, self.outcomes(amounts[None]))

    def _robust(self, places: Wholes, scores: Floats, bound: float) -> Floats:
        """Of the variants near the best: the one that bears parts of the torque and misalignment best.

        Pressure counts along, else the free play would go into crowning that nothing asks for.
        """
        pressures = Outcomes.from_figures(self._full(places)).pressures
        within = pressures <= bound * (1 + _WITHIN)
        permitted = within if within.any() else np.ones_like(within)
        near = np.flatnonzero(permitted & (scores <= (1 + _NEAR) * scores[permitted].min()))
        near = near[np.argsort(scores[near], kind="stable")][:_NEAR_MOST]
        amounts = _amounts(places[near])
        others = [each for each in conditions(self.torque) if abs(each.torque) >= abs(self.torque) / 2]
        burden = np.sum([self.outcomes(amounts, each).peak_to_peak for each in others], axis=0)
        best: Floats = amounts[np.argmin(burden * pressures[near])]
        return best

    def _goal(self, figures: Remembered, bound: float, *, edges: bool) -> Goal:
        return Goal(figures, lambda rows: self.scores(Outcomes.from_figures(rows), bound, edges=edges))

    @cached_property
    def _lattice(self) -> Lattice:
        low, high = np.ceil(self.low / _STEPS - 1e-9), np.floor(self.high / _STEPS + 1e-9)
        return Lattice(low.astype(np.int64), np.maximum(low, high).astype(np.int64))

    @cached_property
    def _full(self) -> Remembered:
        return Remembered(lambda places: self.outcomes(_amounts(places)).figures)

    @cached_property
    def _rough(self) -> Remembered:
        if self.surveyed is not None:
            return self.surveyed
        full, condition = self.variants, Condition(self.torque)
        variants = replace(full, count=full.count // _ROUGH, at_ends=full.at_ends // _ROUGH)
        return Remembered(lambda places: variants.outcomes(_amounts(places), condition).figures)


def _nearest(amounts: Floats) -> Wholes:
    """The place (6,) nearest to amounts (6,)."""
    result: Wholes = np.rint(amounts / _STEPS).astype(np.int64)
    return result


def _amounts(places: Wholes) -> Floats:
    """Amounts (v, 6) of places."""
    result: Floats = np.round(places * _STEPS, _DECIMALS)
    return result
