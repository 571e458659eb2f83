"""Search of tip relief and crowning: least transmission error under one torque, with bounds on pressure and tip edges.

A survey all over, by differential evolution; from the best places that lie apart a descent, by linear models of the figures: a
valley between kinks is narrower than a step along any axis, and only they know which way it runs. What is found is a place of
the lattice, so nothing is lost by rounding it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.contact.load_range import LoadRange
from gearcad.contact.modification_variants import AMOUNTS, Condition, FlankVariants, Outcomes, with_amounts
from gearcad.contact.solid.pair import KnownResponses, SolidPair
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, Wholes
from gearcad.geometry import GearPair, ReliefShape

_SOBOL = 6
"""Places of the first generation: two to the power of this."""

_SEED = 0

_APART = 0.1
"""Least distance of two starting points of a descent along some axis, as a share of the axis's length."""

_REACH, _FARTHEST = 4, 8
"""Reach of a descent along each axis, in steps: the first, and the greatest."""

_SCREENED, _SOLVED = 4000, 24
"""Numbers of places in reach that the linear model looks at, and of the most promising that are worked out."""

_LATTICE_DECIMALS = 6
"""Tolerance of figures, which are of the order of 1 to 1000."""

_WORTH = 0.05
"""Relative gain of a step from which on a descent looks farther."""


class Remembered:
    """Figures (v, m) of places (v, n), worked out once for each, to so many decimals that no rounding of a processor is left.

    Places that are equally good would else be told apart by it, and a search would go another way on another machine.
    """

    def __init__(self, work: Callable[[Wholes], Floats]) -> None:
        self._work = work
        self._known: dict[bytes, Floats] = {}

    @property
    def count(self) -> int:
        """Places that were worked out."""
        return len(self._known)

    @property
    def places(self) -> Wholes:
        """Places (v, n) whose figures were worked out."""
        return np.array([np.frombuffer(key, np.int64) for key in self._known])

    def __call__(self, places: Wholes) -> Floats:
        keys = [place.tobytes() for place in places]
        new = {key: row for row, key in enumerate(keys) if key not in self._known}
        if new:
            figures = np.round(self._work(places[list(new.values())]), _LATTICE_DECIMALS)
            self._known.update(zip(new, figures, strict=True))
        return np.array([self._known[key] for key in keys])


@dataclass(frozen=True)
class Goal:
    """The goal, which is to be least: a value (v,) of the figures (v, m) of places."""

    figures: Remembered
    value: Callable[[Floats], Floats]

    def at(self, places: Wholes) -> Floats:
        """Return the values (v,) of places (v, n)."""
        return self.value(self.figures(places))


@dataclass(frozen=True)
class _Descent:
    """Place of a descent and its reach; 0 when it is over."""

    place: Wholes
    value: float
    reach: int


@dataclass(frozen=True)
class Lattice:
    """Places (n,) between `low` and `high`, both included."""

    low: Wholes
    high: Wholes

    def survey(self, goal: Goal, generations: int, first: Wholes) -> Wholes:
        """Return the places (v, n) that differential evolution looks at, from a Sobol sequence and `first` (n,) on; the same
        each time.
        """
        from scipy.optimize import differential_evolution

        free, seen = self._free, []

        def values(columns: Floats) -> Floats:
            places = np.tile(self.low, (columns.shape[1], 1))
            places[:, free] = np.rint(columns.T)
            seen.append(places)
            return goal.at(places)

        differential_evolution(
            values,
            list(zip(self.low[free], self.high[free], strict=True)),
            init=np.vstack([self.clipped(first), self._spread()])[:, free],
            maxiter=generations,
            integrality=np.ones(len(free), bool),
            seed=_SEED,
            polish=False,
            updating="deferred",
            vectorized=True,
        )
        return self._distinct(np.concatenate(seen))

    def best_apart(self, places: Wholes, values: Floats, count: int) -> Wholes:
        """Return the best (count, n) of places that lie apart."""
        order = np.argsort(values, kind="stable")
        share, found = places / np.maximum(self.high - self.low, 1), [order[0]]
        for each in order:
            if len(found) < count and np.abs(share[found] - share[each]).max(axis=1).min() > _APART:
                found.append(each)
        return places[found]

    def descend(self, goal: Goal, starts: Wholes) -> Wholes:
        """Return the places (s, n) where descents from `starts` (s, n) end.

        No place nearby is below them, by a linear model or solved.
        """
        descents = [_Descent(*each, _REACH) for each in zip(starts, goal.at(starts).tolist(), strict=True)]
        # All of them at once: the figures are remembered, and of many places cost less.
        while any(each.reach for each in descents):
            going = [each for each in descents if each.reach]
            beside = [self._beside(each) for each in going]
            goal.at(np.concatenate(beside))
            near = [np.concatenate([self._promising(goal, *each), each[1]]) for each in zip(going, beside, strict=True)]
            goal.at(np.concatenate(near))
            stepped = iter([_stepped(each, places, goal.at(places)) for each, places in zip(going, near, strict=True)])
            descents = [next(stepped) if each.reach else each for each in descents]
        return np.array([each.place for each in descents])

    def around(self, place: Wholes) -> Wholes:
        """Return a place (n,) and all its neighbours (v, n), those in the direction of several axes included."""
        return self._in_reach(place, 1)

    def near(self, place: Wholes) -> Wholes:
        """Return the places (v, n) up to two steps away along every axis."""
        return self._in_reach(place, 2)

    def clipped(self, places: Wholes) -> Wholes:
        """Return the places (..., n) brought between the ends."""
        result: Wholes = np.clip(places, self.low, self.high)
        return result

    def _beside(self, descent: _Descent) -> Wholes:
        """Neighbours (2 f, n) along each axis, those ahead first."""
        steps = max(1, descent.reach // 2) * np.eye(len(self.low), dtype=np.int64)[self._free]
        return self.clipped(descent.place + np.concatenate([steps, -steps]))

    def _promising(self, goal: Goal, descent: _Descent, beside: Wholes) -> Wholes:
        """Return the places in reach that are best if the figures are linear, as they are `beside` it."""
        ahead, behind = np.split(beside, 2)
        apart = (ahead - behind)[np.arange(len(ahead)), self._free]
        reached = self._in_reach(descent.place, descent.reach)
        with np.errstate(invalid="ignore"):  # a figure may be infinite
            slopes = (goal.figures(ahead) - goal.figures(behind)) / apart[:, None]
            figures = goal.figures(descent.place[None]) + (reached - descent.place)[:, self._free] @ slopes
            values = goal.value(figures)
        return reached[np.argsort(values, kind="stable")[:_SOLVED]]

    def _in_reach(self, place: Wholes, reach: int) -> Wholes:
        """Return the places (v, n) up to so many steps away along every axis, the place included: all, or so many of them by
        chance.
        """
        axes = len(self._free)
        if (2 * reach + 1) ** axes <= _SCREENED:
            steps = np.array(list(itertools.product(range(-reach, reach + 1), repeat=axes)))
        else:
            steps = np.random.default_rng(_SEED).integers(-reach, reach + 1, (_SCREENED, axes))
        places = np.tile(place, (len(steps), 1))
        places[:, self._free] += steps
        return self._distinct(self.clipped(places))

    def _distinct(self, places: Wholes) -> Wholes:
        """Return the places (v, n), each once."""
        rank = np.ravel_multi_index(tuple((places - self.low).T), tuple(self.high - self.low + 1))
        return places[np.unique(rank, return_index=True)[1]]

    def _spread(self) -> Wholes:
        """Return the places (v, n) all over, evenly."""
        from scipy.stats import qmc

        share = qmc.Sobol(len(self._free), seed=_SEED).random_base2(_SOBOL)
        places = np.tile(self.low, (len(share), 1))
        places[:, self._free] += np.floor(share * (self.high - self.low + 1)[self._free]).astype(np.int64)
        return places

    @cached_property
    def _free(self) -> Wholes:
        """Axes (f,) that have a length."""
        return np.flatnonzero(self.high > self.low)


def _stepped(descent: _Descent, places: Wholes, values: Floats) -> _Descent:
    """Return the descent gone on to the best of the places (v, n) looked at, or looking less far."""
    best = int(values.argmin())
    value, reach = float(values[best]), descent.reach
    if value >= descent.value:
        return replace(descent, reach=reach // 2)
    farther = descent.value - value > _WORTH * abs(descent.value)
    return _Descent(places[best], value, min(2 * reach, _FARTHEST) if farther else reach)


_ROUGH = 2
"""Number of positions of which a survey takes one."""

_STEPS = np.array([1.0, 0.05, 1.0, 0.05, 1.0, 1.0])
_DECIMALS = 2
"""Steps to which amounts (µm) and lengths (mm) are rounded, and the number of decimals of such values."""

_OVER_PRESSURE = 10.0
_ON_EDGE = (0.1, 10.0)
"""What it costs, in deflections of the teeth, to be above the bound by all of it, and to carry all load on the edge of a tip:
where that is only unwelcome, and where it is not permitted."""

_FREE = 2e-3
"""Share of the load up to which the edges of tips count as free."""

_WITHIN = 1e-3
"""Share by which a bound may be passed over: less than the pressures are exact."""

_OUT_OF_REACH = 1.1
"""Ratio of the least pressure of a survey to a bound above which the search goes on to the next bound."""

_NEAR = 0.01
_NEAR_MOST = 48
"""Variants count as near the best up to this share above it; at most so many of them."""

_NEVER = 1e9
"""Score of a variant whose contact does not settle."""

_GENERATIONS = 15
_STARTS = 8
"""Number of generations of a survey, and number of its best places from which the search goes on."""

_MISALIGNMENT = 10.0
_PITCH_ERROR = 10.0
"""Misalignment (µm) over the common face width and pitch error (µm) of a tooth that a proposal should bear, on top of those of
the mounting.
"""


def conditions(torque: float) -> tuple[Condition, ...]:
    """Return the conditions that a proposal should bear: parts of the torque (N·m), the wheel's axis turned either way, and a
    pitch error.
    """
    parts = [Condition(part * torque) for part in (0.25, 0.5, 0.75, 1.0)]
    turned = [Condition(torque, misalignment=sign * _MISALIGNMENT) for sign in (1, -1)]
    return (*parts, *turned, Condition(torque, pitch_error=_PITCH_ERROR))


@dataclass(frozen=True)
class FoundModification:
    """Result of a search: the amounts (6,), the bound (MPa), and what becomes of the flanks.

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
        """Peak to peak of the transmission error (µm)."""
        return float(self.outcome.peak_to_peak[0])


@dataclass(frozen=True)
class Search:
    """Variants between `low` and `high` (6,) under a torque (N·m).

    `plain` is what becomes of the flanks without reliefs and crowning, their helix angle made up for a misalignment;
    `surveyed` are places that were solved roughly before. With several `loads`, of which the torque is the greatest, the
    transmission error is their statistic; pressures and loads on edges are the greatest under any.
    """

    variants: FlankVariants
    torque: float
    low: Floats
    high: Floats
    start: Floats
    plain: Outcomes
    surveyed: Remembered | None = field(default=None, repr=False)
    loads: LoadRange | None = None

    @property
    def deflection(self) -> float:
        """The greatest transmission error (µm) of plain flanks."""
        return float(self.plain.transmission_errors.max())

    def outcomes(self, amounts: Floats, condition: Condition | None = None) -> Outcomes:
        """Return the outcomes of variants (v, 6) under a condition, else under the loads of the search, or its torque."""
        if condition is None and self.loads is not None:
            parts = [self.variants.outcomes(amounts, Condition(torque)) for torque in self.loads.torques]
            return Outcomes.joined(parts, self.loads)
        return self.variants.outcomes(amounts, condition or Condition(self.torque))

    def _read(self, figures: Floats) -> Outcomes:
        """Return the outcomes of figures (v, 3 positions), under the loads of the search."""
        return Outcomes.from_figures(figures, self.loads)

    def best(self, bounds: Sequence[float]) -> FoundModification:
        """Return the proposal for the first of the bounds (MPa) that can be kept, else for the last.

        Without contact on the edges of the tips, unless that costs more than half of what is gained.
        """
        for bound in bounds:
            places = self._survey(bound)
            if bound != bounds[-1] and self._read(self._rough(places)).pressures.min() > _OUT_OF_REACH * bound:
                continue
            found = self._settled(bound, places)
            if found.bounded:
                break
        return replace(self._worth_its_price(found, places), tried=self._rough.count + self._full.count)

    def closer(self, angles: Floats) -> Search:
        """Return the search at further positions, at roll angles (deg); places that its survey solved are kept."""
        variants = replace(self.variants, more=(*self.variants.more, *angles.tolist()))
        return replace(self, variants=variants, surveyed=self._rough)

    def again(self, found: FoundModification, bound: float) -> FoundModification:
        """Return the proposal for another bound (MPa), from `found` and the best places of the survey on."""
        places = self._rough.places
        settled = self._worth_its_price(self._settled(bound, places, first=found), places)
        return replace(settled, tried=found.tried + self._full.count)

    def better(self, found: FoundModification, bound: float, count: int) -> list[FoundModification]:
        """Return at most `count` proposals near `found` that are better and keep to a bound (MPa), the best first."""
        places, here = self._lattice.near(_nearest(found.amounts)), _nearest(found.amounts)[None]
        goal = self._goal(self._full, bound, edges=not found.edges_free)
        values = goal.at(places)
        kept = (self._read(self._full(places)).pressures <= bound) & (values < goal.at(here)[0])
        best = np.flatnonzero(kept)[np.argsort(values[kept], kind="stable")][:count]
        return [
            replace(found, amounts=each, outcome=self.outcomes(each[None]), tried=found.tried + len(places))
            for each in _amounts(places[best])
        ]

    def _worth_its_price(self, found: FoundModification, places: Wholes) -> FoundModification:
        """Return the proposal that keeps the tip edges free if it costs little; otherwise the one with contact there."""
        if found.edges_free or not found.bounded:
            return found
        strict = self._settled(found.bound, places, edges=False, first=found)
        worth = strict.peak_to_peak <= self.dearest(found.peak_to_peak)
        return strict if strict.bounded and strict.edges_free and worth else found

    def dearest(self, peak_to_peak: float) -> float:
        """Return the greatest peak to peak (µm) permitted for a proposal with the edges of tips out of contact.

        This may cost half of what `peak_to_peak` (µm) gains on plain flanks.
        """
        return (peak_to_peak + float(self.plain.peak_to_peak[0])) / 2

    def scores(self, found: Outcomes, bound: float, *, edges: bool) -> Floats:
        """Return the values (v,) in µm that are to be least.

        Each is the peak to peak of the transmission error, and the cost of broken bounds: pressure above `bound` (MPa), and
        contact on edges of tips. With `edges` the latter costs little.
        """
        on_edge = self.deflection * _ON_EDGE[0 if edges else 1] * found.edge_shares
        over = self.price(found.pressures, bound)
        return np.nan_to_num(found.peak_to_peak + over + on_edge, nan=_NEVER, posinf=_NEVER)

    def price(self, pressures: Floats, bound: float) -> Floats:
        """Return what (µm) pressures (MPa) above the bound cost."""
        result: Floats = self.deflection * _OVER_PRESSURE * np.maximum(pressures / bound - 1, 0.0)
        return result

    def _survey(self, bound: float) -> Wholes:
        """Return the places (v, 6) all over, the most of them where variants are good."""
        return self._lattice.survey(self._goal(self._rough, bound, edges=True), _GENERATIONS, _nearest(self.start))

    def _settled(
        self, bound: float, places: Wholes, *, edges: bool = True, first: FoundModification | None = None
    ) -> FoundModification:
        """Return the proposal to which the best of the places lead, and that which was found `first`."""
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
        return FoundModification(amounts, bound, self.outcomes(amounts[None]))

    def _robust(self, places: Wholes, scores: Floats, bound: float) -> Floats:
        """Return the amounts (6,) of the variant near the best that bears the `conditions` from half the torque up best.

        The pressure counts too. Else the free play would go into crowning that nothing asks for.
        """
        pressures = self._read(self._full(places)).pressures
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
        return Goal(figures, lambda rows: self.scores(self._read(rows), bound, edges=edges))

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
        full = self.variants
        rough = replace(self, variants=replace(full, count=full.count // _ROUGH, at_ends=full.at_ends // _ROUGH))
        return Remembered(lambda places: rough.outcomes(_amounts(places)).figures)


def _nearest(amounts: Floats) -> Wholes:
    """Return the place (6,) nearest to amounts (6,)."""
    result: Wholes = np.rint(amounts / _STEPS).astype(np.int64)
    return result


def _amounts(places: Wholes) -> Floats:
    """Amounts (v, 6) of places."""
    result: Floats = np.round(places * _STEPS, _DECIMALS)
    return result


class _Sampling(NamedTuple):
    """Cells of a line of contact, positions over a base pitch, and as many more at either end of the path of contact."""

    cells: int
    positions: int
    at_ends: int


_HELICAL = _Sampling(16, 24, 0)
_SPUR = _Sampling(8, 32, 8)
"""Sampling by which variants are judged. Lines of helical teeth have cells at many places of the flank at once; spur teeth need
more positions instead.
"""

_MOST_RELIEF = 1.5
_MOST_CROWNING = 0.5
"""Largest tip relief of a gear and largest crowning, as shares of the greatest deflection of the teeth."""

_MOST_HELIX = 1.5
"""Largest change of the pinion's helix, as a share of the one that makes up for the misalignment."""

_SHORTEST = 0.1
_LONGEST = 0.5
"""Shortest and longest tip relief, as shares of the path of contact: in its middle flanks stay exact."""


def start_search(
    model: SolidPair,
    torque: float,
    shape: ReliefShape,
    lead: tuple[float, float] | None = None,
    loads: LoadRange | None = None,
) -> Search:
    """Prepare a search at a torque (N·m) for a model whatever its own tip relief and crowning; the helix angle is modified
    only against a misalignment of its mounting.

    `lead` (whole µm) are lead crowning and helix angle modification of the pinion that are found elsewhere and do not vary.
    With several `loads` the torque is the greatest of them.
    """
    nothing = np.zeros(len(AMOUNTS))
    sampling = _HELICAL if model.helix else _SPUR
    bare = replace(
        model.remade(with_amounts(model.pair, nothing, shape), model.mounting), cells=sampling.cells, known=KnownResponses()
    )
    start = np.array([0.0, 0.0, 0.0, 0.0, *(lead or (0.0, _aligning(bare)))])
    plain = FlankVariants(bare, shape, sampling.positions, torque, sampling.at_ends).outcomes(start[None], Condition(torque))
    low, high = _bounds(bare, shape, float(plain.transmission_errors.max()), lead)
    roomy = bare.remade(with_amounts(bare.pair, high, shape), bare.mounting)
    variants = FlankVariants(roomy, shape, sampling.positions, torque, sampling.at_ends)
    search = Search(variants, torque, low, high, start, plain, loads=loads)
    return replace(search, plain=search.outcomes(start[None]))


def _aligning(model: SolidPair) -> float:
    """Helix angle modification (µm) of the pinion that turns its loaded, left flanks as far as the wheel is misaligned."""
    form = model.pair.pinion.flank_form
    return form.hand * model.mounting.misalignment * form.width / model.width


def _bounds(model: SolidPair, shape: ReliefShape, deflection: float, lead: tuple[float, float] | None) -> tuple[Floats, Floats]:
    """Return the least and the greatest amounts (6,), those along the face of `lead` where it is given."""
    path, pair = model.pair.path_of_contact, model.pair
    reach = path.E - path.A
    longest = [min(_LONGEST * reach, gear.flank_form.last - gear.flank_form.first) for gear in pair.gears]
    helix = _MOST_HELIX * abs(_aligning(model))
    low = np.array([0.0, _SHORTEST * reach, 0.0, _SHORTEST * reach, 0.0, -helix])
    relief, crowning = np.ceil(_MOST_RELIEF * deflection), np.ceil(_MOST_CROWNING * deflection)
    high = np.array([relief, longest[0], relief, longest[1], crowning, helix])
    shrinking = [0, 2, 4]
    if lead is not None:
        low[4:] = high[4:] = lead
        shrinking = [0, 2]
    while not _fits(pair, high, shape, shrinking):
        high[shrinking] = np.floor(0.9 * high[shrinking])
    return low, high


def _fits(pair: GearPair, amounts: Floats, shape: ReliefShape, shrinking: list[int]) -> bool:
    """Return whether the flanks can be relieved by that length, or nothing of it is left to take away."""
    try:
        with_amounts(pair, amounts, shape)
    except GeometryError:
        return not amounts[shrinking].any()
    return True
