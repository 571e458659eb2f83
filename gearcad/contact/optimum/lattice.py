"""The least of a function of whole numbers whose value, with kinks, follows from many smooth figures that are dear to work out.

A survey all over, by differential evolution; from the best places that lie apart a descent, by linear models of the figures: a
valley between kinks is narrower than a step along any axis, and only they know which way it runs. What is found is a place of
the lattice, so nothing is lost by rounding it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Wholes

__all__ = ["Goal", "Lattice", "Remembered", "Wholes"]


_SOBOL = 6
"""Places of the first generation: two to the power of this."""

_SEED = 0

_APART = 0.1
"""Least distance of two starts of a descent along some axis, as a share of its length."""

_REACH, _FARTHEST = 4, 8
"""How far a descent looks along each axis, in steps: at first, and at the most."""

_SCREENED, _SOLVED = 4000, 24
"""How many places in reach its linear model looks at, and how many of them, the most promising, are worked out."""

_DECIMALS = 6
"""Of figures, which are of the order of 1 to 1000."""

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
        """Those places (v, n)."""
        return np.array([np.frombuffer(key, np.int64) for key in self._known])

    def __call__(self, places: Wholes) -> Floats:
        keys = [place.tobytes() for place in places]
        new = {key: row for row, key in enumerate(keys) if key not in self._known}
        if new:
            figures = np.round(self._work(places[list(new.values())]), _DECIMALS)
            self._known.update(zip(new, figures, strict=True))
        return np.array([self._known[key] for key in keys])


@dataclass(frozen=True)
class Goal:
    """What is to be least: a value (v,) of the figures (v, m) of places."""

    figures: Remembered
    value: Callable[[Floats], Floats]

    def at(self, places: Wholes) -> Floats:
        """Values (v,) of places (v, n)."""
        return self.value(self.figures(places))


@dataclass(frozen=True)
class _Descent:
    """Where a descent is, and how far it looks; 0 when it is over."""

    place: Wholes
    value: float
    reach: int


@dataclass(frozen=True)
class Lattice:
    """Places (n,) between `low` and `high`, both included."""

    low: Wholes
    high: Wholes

    def survey(self, goal: Goal, generations: int, first: Wholes) -> Wholes:
        """Places (v, n) that differential evolution looks at, from a Sobol sequence and `first` (n,) on; the same each time."""
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
        """The best (count, n) of places that lie apart."""
        order = np.argsort(values, kind="stable")
        share, found = places / np.maximum(self.high - self.low, 1), [order[0]]
        for each in order:
            if len(found) < count and np.abs(share[found] - share[each]).max(axis=1).min() > _APART:
                found.append(each)
        return places[found]

    def descend(self, goal: Goal, starts: Wholes) -> Wholes:
        """Where descents from `starts` (s, n) end (s, n): at places that none nearby, by a linear model or solved, is below."""
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
        """A place (n,) and all its neighbours (v, n), those in the direction of several axes included."""
        return self._in_reach(place, 1)

    def near(self, place: Wholes) -> Wholes:
        """Places (v, n) up to two steps away along every axis."""
        return self._in_reach(place, 2)

    def clipped(self, places: Wholes) -> Wholes:
        """Places (..., n) brought between the ends."""
        result: Wholes = np.clip(places, self.low, self.high)
        return result

    def _beside(self, descent: _Descent) -> Wholes:
        """Neighbours (2 f, n) along each axis, those ahead first."""
        steps = max(1, descent.reach // 2) * np.eye(len(self.low), dtype=np.int64)[self._free]
        return self.clipped(descent.place + np.concatenate([steps, -steps]))

    def _promising(self, goal: Goal, descent: _Descent, beside: Wholes) -> Wholes:
        """Places in reach that are the best if the figures are linear, as they are `beside` it."""
        ahead, behind = np.split(beside, 2)
        apart = (ahead - behind)[np.arange(len(ahead)), self._free]
        reached = self._in_reach(descent.place, descent.reach)
        with np.errstate(invalid="ignore"):  # a figure may be infinite
            slopes = (goal.figures(ahead) - goal.figures(behind)) / apart[:, None]
            figures = goal.figures(descent.place[None]) + (reached - descent.place)[:, self._free] @ slopes
            values = goal.value(figures)
        return reached[np.argsort(values, kind="stable")[:_SOLVED]]

    def _in_reach(self, place: Wholes, reach: int) -> Wholes:
        """Places (v, n) up to so many steps away along every axis, the place included: all, or so many of them by chance."""
        axes = len(self._free)
        if (2 * reach + 1) ** axes <= _SCREENED:
            steps = np.array(list(itertools.product(range(-reach, reach + 1), repeat=axes)))
        else:
            steps = np.random.default_rng(_SEED).integers(-reach, reach + 1, (_SCREENED, axes))
        places = np.tile(place, (len(steps), 1))
        places[:, self._free] += steps
        return self._distinct(self.clipped(places))

    def _distinct(self, places: Wholes) -> Wholes:
        """Places (v, n), each once."""
        rank = np.ravel_multi_index(tuple((places - self.low).T), tuple(self.high - self.low + 1))
        return places[np.unique(rank, return_index=True)[1]]

    def _spread(self) -> Wholes:
        """Places (v, n) all over, evenly."""
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
    """The descent gone on to the best of the places (v, n) looked at, or looking less far."""
    best = int(values.argmin())
    value, reach = float(values[best]), descent.reach
    if value >= descent.value:
        return replace(descent, reach=reach // 2)
    farther = descent.value - value > _WORTH * abs(descent.value)
    return _Descent(places[best], value, min(2 * reach, _FARTHEST) if farther else reach)
