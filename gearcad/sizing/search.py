"""The search: every variant of a task past the limits and rated; only the best, and what tells about the rest, is kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.progress import Tell, untold
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.grid import Grid, rounded_width
from gearcad.sizing.limits import LIMITS, width_within
from gearcad.sizing.ranking import best_of_each, front
from gearcad.sizing.rated import MASS, REQUIRED, Rated
from gearcad.sizing.rating import RATED, rate_many
from gearcad.sizing.task import SizeTask

__all__ = ["CONDITIONS", "STEP", "Survey", "survey"]

STEP = "variants"

WIDTH = "face width"
CONDITIONS = (*LIMITS, WIDTH, RATED, *REQUIRED)
"""What variants must meet, in the order in which it is asked of them."""

_SAFETIES = tuple(name for name in REQUIRED if name != MASS)

_KEPT = 1 << 16
"""Variants that are kept before the best of them are picked."""


@dataclass
class _Keeper:
    """The best of each combination of teeth, module and helix angle, and the front of mass and safety, of all so far."""

    task: SizeTask
    group: int
    best: list[Rated] = field(default_factory=list)
    front: list[Rated] = field(default_factory=list)
    strongest: list[Rated] = field(default_factory=list)
    lightest: list[Rated] = field(default_factory=list)

    def add(self, rated: Rated) -> None:
        """Variants that meet all conditions."""
        self.best.append(self._best(rated))
        self.front.append(rated.picked(front(rated)))
        if sum(len(each.order) for each in self.best) > _KEPT:
            self.settle()

    def _best(self, rated: Rated) -> Rated:
        return best_of_each(rated, rated.pairs.key // self.group, self.task.criterion)

    def settle(self) -> None:
        """Leave one of each."""
        if self.best:
            self.best = [self._best(Rated.joined(self.best))]
            joined = Rated.joined(self.front)
            self.front = [joined.picked(front(joined))]

    def add_strongest(self, rated: Rated) -> None:
        """The one of most safety, of variants that need not be safe enough."""
        self.strongest = _first([*self.strongest, rated], lambda each: -each.margin)

    def add_lightest(self, rated: Rated) -> None:
        """The lightest, of variants that are safe, whatever mass is permitted."""
        self.lightest = _first([*self.lightest, rated], lambda each: each.mass)


def _first(rated: list[Rated], key: Callable[[Rated], Floats]) -> list[Rated]:
    """The one whose key is least, of all; none of none."""
    some = [each.picked([int(np.lexsort((each.order, key(each)))[0])]) for each in rated if len(each.order)]
    if not some:
        return []
    joined = Rated.joined(some)
    return [joined.picked([int(np.lexsort((joined.order, key(joined)))[0])])]


class Survey(NamedTuple):
    """What a search saw: the best of each combination of teeth, module and helix angle; the front of mass and safety; how many
    variants there were, and how many each condition removed;
    the strongest, if any was rated, and the lightest that is safe, of any mass."""

    best: Rated | None
    front: Rated | None
    considered: int
    removed: dict[str, int]
    rated: int
    strongest: Rated | None
    lightest: Rated | None


def survey(task: SizeTask, tell: Tell = untold) -> Survey:
    """Go through all variants of a task."""
    grid, widths = Grid(task), len(task.width_ratios)
    keeper, removed = _Keeper(task, grid.variants_of_a_group), dict.fromkeys(CONDITIONS, 0)
    done = rated = 0
    for pairs in grid.chunks():
        for variants in _variants(task, _within_limits(task, pairs, removed, widths), removed):
            rated += len(variants.order)
            keeper.add_strongest(variants)
            safe = _meeting(task, variants, _SAFETIES, removed)
            keeper.add_lightest(safe)
            held = _meeting(task, safe, (MASS,), removed)
            if len(held.order):
                keeper.add(held)
        done += len(pairs.key)
        tell(STEP, done / len(grid))
    keeper.settle()
    first = [each[0] if each else None for each in (keeper.best, keeper.front, keeper.strongest, keeper.lightest)]
    return Survey(first[0], first[1], len(grid) * widths, removed, rated, first[2], first[3])


def _within_limits(task: SizeTask, pairs: ManyPairs, removed: dict[str, int], widths: int) -> ManyPairs:
    left = pairs
    for name, met in LIMITS.items():
        mask = met(left, task)
        removed[name] += int(np.count_nonzero(~mask)) * widths
        left = left.picked(mask)
    return left


def _variants(task: SizeTask, pairs: ManyPairs, removed: dict[str, int]) -> Iterator[Rated]:
    """Pairs with every face width that is not too much for the module, rated."""
    if not len(pairs.key):
        return
    ratios = np.array(task.width_ratios)
    width: Floats = rounded_width(pairs.diameters.pinion[:, None] * ratios)
    fits = width_within(width, pairs.picked((slice(None), None)), task)
    removed[WIDTH] += int(np.count_nonzero(~fits))
    found = rate_many(task, pairs, width, fits, pairs.key[:, None] * len(ratios) + np.arange(len(ratios)))
    removed[RATED] += int(np.count_nonzero(fits)) - len(found.order)
    yield found


def _meeting(task: SizeTask, variants: Rated, conditions: Iterable[str], removed: dict[str, int]) -> Rated:
    """Those that meet some of the REQUIRED."""
    left = variants
    for name in conditions:
        mask = left.meets(name, task)
        removed[name] += int(np.count_nonzero(~mask))
        left = left.picked(mask)
    return left
