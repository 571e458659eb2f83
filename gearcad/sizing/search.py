"""Search of all variants of a task: the limits, the ranking, and the refinement of the best.

The place of a variant in the whole is its key: tuples of a task are in order, so it does not depend on how they were given.

In each cell, what is about one combination of teeth, module and helix angle, every helix angle in halves of a degree, every
shift in twentieths, every round centre distance and every face width in whole mm that can be light enough are gone through:
complete within its steps, where an iteration would stop at the first edge of K_v or K_Hbeta.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.records import Bools, Floats, Indices, PerGear, Wholes
from gearcad.core.runtime import Tell, untold
from gearcad.geometry.involute import root_between
from gearcad.sizing.geometry import ManyPairs, distance_for, shift_sum_at
from gearcad.sizing.rating import MASS, RATED, REQUIRED, Rated, disc_mass, rate_many
from gearcad.sizing.task import Criterion, SizeTask

CHUNK = 1 << 14
"""Pairs at a time: few enough for the cache of a core, enough for numpy's overhead not to count."""

_STEPS = np.array([factor * 10.0**power for power in range(-4, 3) for factor in (1, 2, 5)])
"""Steps (mm) to which centre distances that are not given are rounded."""

_COARSENESS = 0.25
"""The most of a module that such a step is."""


@dataclass(frozen=True)
class VariantGrid:
    """The product of all that a task lets vary but the widths; `len` is how many pairs that makes."""

    task: SizeTask

    @cached_property
    def _teeth(self) -> tuple[Floats, Floats]:
        pairs = np.array(self.task.teeth_pairs, float).reshape(-1, 2)
        return pairs[:, 0], pairs[:, 1]

    @cached_property
    def _radii(self) -> Floats | None:
        """Tip radius of the tool by module (normal modules); None where it is the same for all."""
        radii = self.task.root_radii
        return None if radii is None else np.array(radii)

    @property
    def _shape(self) -> tuple[int, ...]:
        task = self.task
        sums = 1 if task.centre_distance is not None else len(task.shift_sums)
        return len(self._teeth[0]), len(task.modules), len(task.helix_angles), sums, len(task.shifts)

    def __len__(self) -> int:
        return math.prod(self._shape)

    @property
    def variants_of_a_group(self) -> int:
        """Number of successive keys with the same teeth, module and helix angle."""
        return math.prod(self._shape[3:])

    def chunks(self) -> Iterator[ManyPairs]:
        """Yield all pairs of the grid. The centre distance is nan where none meshes without backlash."""
        for start in range(0, len(self), CHUNK):
            yield self._pairs(np.arange(start, min(start + CHUNK, len(self))))

    def _pairs(self, key: Wholes) -> ManyPairs:
        task = self.task
        teeth, module, helix, total, shift = np.unravel_index(key, self._shape)
        z_1, z_2 = (each[teeth] for each in self._teeth)
        m_n, beta = np.array(task.modules)[module], np.array(task.helix_angles)[helix]
        angle = task.rack.pressure_angle
        if task.centre_distance is None:
            distance = rounded_distance(distance_for(np.array(task.shift_sums)[total], z_1 + z_2, m_n, beta, angle), m_n)
        else:
            distance = np.full(len(key), task.centre_distance)
        x_1 = np.array(task.shifts)[shift]
        return ManyPairs(
            key=key,
            teeth=PerGear(z_1, z_2),
            normal_module=m_n,
            helix_angle=beta,
            centre_distance=distance,
            shifts=PerGear(x_1, shift_sum_at(distance, z_1 + z_2, m_n, beta, angle) - x_1),
            rack=task.rack,
            tip_radius=None if self._radii is None else self._radii[module],
        )


def rounded_distance(distance: Floats, module: Floats) -> Floats:
    """Return the distance rounded to steps of 1, 2 or 5, tenths and so on, as coarse as the module lets the shifts compensate:
    0.5 mm from 2 to 3.99 mm.
    """
    step = _distance_step(module)
    result: Floats = np.round(np.round(distance / step) * step, 6)
    return result


def _distance_step(module: Floats) -> Floats:
    result: Floats = _STEPS[np.searchsorted(_STEPS, _COARSENESS * module * (1 + 1e-9), side="right") - 1]
    return result


def distances_within(
    sums: tuple[float, float], teeth: Floats, module: Floats, helix_angle: Floats, pressure_angle: float
) -> tuple[Indices, Floats]:
    """All round centre distances (mm) at which x_1 + x_2 of pairs is from the first to the second sum.

    Those of each pair after each other, with the places of the pairs; `teeth` are z_1 + z_2.
    """
    ends = [distance_for(np.array(each), teeth, module, helix_angle, pressure_angle) for each in sums]
    step = _distance_step(module)
    least, most = np.ceil(ends[0] / step - 1e-6), np.floor(ends[1] / step + 1e-6)
    count = np.nan_to_num(np.maximum(most - least + 1, 0)).astype(int)
    place = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(place)) - np.repeat(np.cumsum(count) - count, count)
    return place, np.round((least[place] + number) * step[place], 6)


def rounded_width(width: Floats) -> Floats:
    """Return face widths rounded to whole mm, to tenths below 10 mm."""
    return np.where(width < 10, np.maximum(np.round(width, 1), 0.1), np.round(width))


ROUNDING = 1e-9
"""Difference of lengths, in normal modules, and of ratios below which they count as equal."""

SHIFT_SUMS = (-0.5, 2.0)
"""x_1 + x_2 that takes up a centre distance that is given: what q' of ISO 6336-1 is stated for."""

_NEAR = 0.15
"""Distance of x_1 + x_2 from the wanted range that is permitted for round centre distances."""


def shift_sums_within(task: SizeTask) -> tuple[float, float]:
    """The least and the most x_1 + x_2 where no centre distance is given."""
    return task.shift_sums[0] - _NEAR, task.shift_sums[-1] + _NEAR


def _centre_distance(pairs: ManyPairs, task: SizeTask) -> Bools:
    """Return a mask of the pairs whose centre distance is reached by permitted profile shifts."""
    total = pairs.shifts.pinion + pairs.shifts.wheel
    least, most = SHIFT_SUMS if task.centre_distance is not None else shift_sums_within(task)
    result: Bools = (total >= least) & (total <= most)  # false of nan
    return result


def _diameter(pairs: ManyPairs, task: SizeTask) -> Bools:
    if task.max_diameter is None:
        return np.ones(len(pairs.key), bool)
    result: Bools = np.maximum(*pairs.tip_diameters) <= task.max_diameter * (1 + ROUNDING)
    return result


def _whole_involutes(pairs: ManyPairs, _task: SizeTask) -> Bools:
    result: Bools = np.minimum(*pairs.form_reach) >= -ROUNDING * pairs.normal_module
    return result


def _thick_tips(pairs: ManyPairs, task: SizeTask) -> Bools:
    parts = zip(pairs.tip_thicknesses, task.tip_thicknesses, strict=True)
    first, second = (thickness >= (least - ROUNDING) * pairs.normal_module for thickness, least in parts)
    return first & second


def _contact_ratio(pairs: ManyPairs, task: SizeTask) -> Bools:
    result: Bools = (pairs.contact_ratio >= task.least_contact_ratio - ROUNDING) & (pairs.contact_ratio < 3)
    return result


def _no_interference(pairs: ManyPairs, _task: SizeTask) -> Bools:
    """Tips meet the involutes of their mates, none below the root form circle."""
    parts = zip(pairs.lowest_contact, pairs.form_reach, strict=True)
    first, second = (low >= form - ROUNDING * pairs.normal_module for low, form in parts)
    return first & second


LIMITS: dict[str, Callable[[ManyPairs, SizeTask], Bools]] = {
    "centre distance": _centre_distance,
    "diameter": _diameter,
    "undercut": _whole_involutes,
    "tip thickness": _thick_tips,
    "contact ratio": _contact_ratio,
    "interference": _no_interference,
}
"""Words of each condition, and where it is met: in this order, each of the pairs that met all before."""


def width_within(width: Floats, pairs: ManyPairs, task: SizeTask) -> Bools:
    """Return a mask of the pairs whose face width is not too large for the module."""
    result: Bools = width <= (task.max_width_in_modules + ROUNDING) * pairs.normal_module
    return result


NEARLY, _BAND = 1.005, 0.002
"""Ratio to the lightest mass that counts as equally good, where x_1 < x_2 is avoided; and the share of the lightest mass within
which masses count as equal, where sliding is less.
"""

_DIGITS = 9
"""Significant figures by which variants are told apart: what is beyond is rounding, and ties are decided by place."""


def ranked(rated: Rated, criterion: Criterion) -> Indices:
    """Places of variants, best first."""
    return np.lexsort(_keys(rated, criterion)[::-1])


def _keys(rated: Rated, criterion: Criterion) -> tuple[np.ndarray[Any, Any], ...]:
    """Return the criterion, rounded to what matters, so that pairs of equal value are ordered by mass."""
    first = {
        Criterion.MASS: rated.mass,
        Criterion.SAFETY: np.round(-rated.margin, 3),
        Criterion.QUIET: np.round(rated.ripple, 2),
        Criterion.SLIDING: np.round(rated.sliding, 2),
        Criterion.SCUFFING: np.round(rated.temperature),
        Criterion.EFFICIENCY: rated.mass if rated.efficiency is None else np.round(-rated.efficiency, 4),
    }[criterion]
    return _figures(first), _figures(rated.mass), _figures(-rated.margin), _figures(rated.sliding), rated.order


def _figures(values: Floats) -> Floats:
    """Return values without their last digits, which are rounding errors."""
    with np.errstate(divide="ignore"):
        size = np.where(values == 0, 0.0, np.floor(np.log10(np.abs(values))))
    step = 10.0 ** (size - _DIGITS + 1)
    return np.where(np.isfinite(values), np.round(values / step) * step, np.inf)


def best_of_each(rated: Rated, group: Wholes, criterion: Criterion) -> Rated:
    """The best of each group, such as of the same teeth and module, in order of the groups."""
    order = ranked(rated, criterion)
    _, first = np.unique(group[order], return_index=True)
    return rated.picked(order[first])


def lightest_of_each(rated: Rated, group: Wholes) -> Rated:
    """The lightest of each group; of those nearly as light, x_1 >= x_2 first, as q' is stated for it, then least sliding."""
    groups, place = np.unique(group, return_inverse=True)
    least = np.full(len(groups), np.inf)
    np.minimum.at(least, place, rated.mass)
    excess = rated.mass / least[place] - 1
    there = np.flatnonzero(excess <= NEARLY - 1)
    near, place = rated.picked(there), place[there]
    uneven = near.pairs.shifts.pinion < near.pairs.shifts.wheel - 1e-9
    bands = np.floor(excess[there] / _BAND + 1e-9)
    order = np.lexsort((_figures(near.mass), _figures(near.sliding), bands, uneven, place))
    _, first = np.unique(place[order], return_index=True)
    return near.picked(order[first])


def front(rated: Rated) -> Bools:
    """Return a mask of the front of mass and margin: no variant is both lighter and safer.

    Of variants that are equal in both the mask has the first.
    """
    mass, margin = _figures(rated.mass), _figures(rated.margin)
    order = np.lexsort((rated.order, -margin, mass))
    best = np.maximum.accumulate(margin[order])
    before = np.concatenate([[-np.inf], best[:-1]])
    result = np.zeros(len(order), bool)
    result[order] = margin[order] > before
    return result


STEP = "variants"

Heard = Callable[[Callable[[], Rated | None]], None]
"""Called now and then with a function that gives the best variants so far, which costs something only when it is called."""


def unheard_best(_best: Callable[[], Rated | None]) -> None:
    """Ignore the best variants so far: a Heard for callers that do not ask."""


WIDTH = "face width"
CONDITIONS = (*LIMITS, WIDTH, RATED, *REQUIRED)
"""Conditions of variants, in the order in which it is asked of them."""

_SAFETIES = tuple(name for name in REQUIRED if name != MASS)

_MOST_KEPT_VARIANTS = 1 << 16
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
        """Add variants that meet all conditions."""
        self.best.append(self._best(rated))
        self.front.append(rated.picked(front(rated)))
        if sum(len(each.order) for each in self.best) > _MOST_KEPT_VARIANTS:
            self.settle()

    def _best(self, rated: Rated) -> Rated:
        return best_of_each(rated, rated.pairs.key // self.group, self.task.criterion)

    def settle(self) -> None:
        """Keep the best variant of each combination, and the front of all."""
        if self.best:
            self.best = [self._best(Rated.joined(self.best))]
            joined = Rated.joined(self.front)
            self.front = [joined.picked(front(joined))]

    def so_far(self) -> Rated | None:
        """Return the best of each combination so far, best first; None where nothing meets all conditions yet."""
        self.settle()
        return self.best[0].picked(ranked(self.best[0], self.task.criterion)) if self.best else None

    def add_strongest(self, rated: Rated) -> None:
        """Add the variant of most safety, out of variants that need not be safe enough."""
        self.strongest = _search_first([*self.strongest, rated], lambda each: -each.margin)

    def add_lightest(self, rated: Rated) -> None:
        """Add the lightest variant, out of variants that are safe, whatever mass is permitted."""
        self.lightest = _search_first([*self.lightest, rated], lambda each: each.mass)


def _search_first(rated: list[Rated], key: Callable[[Rated], Floats]) -> list[Rated]:
    """Return the variant with the least key as a list of one; an empty list if there is no variant."""
    some = [each.picked([int(np.lexsort((each.order, key(each)))[0])]) for each in rated if len(each.order)]
    if not some:
        return []
    joined = Rated.joined(some)
    return [joined.picked([int(np.lexsort((joined.order, key(joined)))[0])])]


class Survey(NamedTuple):
    """Result of a search: the best of each combination of teeth, module and helix angle; the front of mass and safety; how many
    variants there were, and how many each condition removed;
    the strongest, if any was rated, and the lightest that is safe, of any mass."""

    best: Rated | None
    front: Rated | None
    considered: int
    removed: dict[str, int]
    rated: int
    strongest: Rated | None
    lightest: Rated | None


def survey(task: SizeTask, tell: Tell = untold, heard: Heard = unheard_best) -> Survey:
    """Go through all variants of a task; `heard` is offered the best of each combination so far."""
    grid, widths = VariantGrid(task), len(task.width_ratios)
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
        heard(keeper.so_far)
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
    """Return the variants that meet some of the REQUIRED, and count in `removed` how many each condition takes."""
    left = variants
    for name in conditions:
        mask = left.meets(name, task)
        removed[name] += int(np.count_nonzero(~mask))
        left = left.picked(mask)
    return left


_HELIX_STEP, _SHIFT_STEP, _FINE_SHIFT_STEP = 0.5, 0.05, 0.01

_WIDTHS, _MOST_WIDTHS = 12, 40
"""Widths of a pair that are tried at a time, and of one of which not the least is wanted."""

_EDGES = (10.0, 20.0, 40.0, 80.0, 100.0, 125.0, 160.0, 250.0, 400.0, 650.0)
"""Face widths (mm) beyond which tolerances of ISO 1328-1:1995 and DIN 3962 jump, and safeties with them."""

_AT_A_TIME = 24
"""Cells: some ten thousand pairs. Those that come later need only compete with what the first have become."""


def refined(
    task: SizeTask, best: Rated, most: int, tell: Callable[[float], None] = lambda _: None, heard: Heard = unheard_best
) -> Rated:
    """The best of the best `most` cells, best first; `best` has one variant of each.

    By mass all cells are refined, with pairs that are light enough to become one of those; else the best `most` as they are.
    `tell` hears what part is done, `heard` is offered the best so far.
    """
    by_mass = task.criterion is Criterion.MASS
    order = ranked(best, task.criterion)
    cells = best.picked(order if by_mass else order[:most])
    found = _first(task, [cells], most)
    for start in range(0, len(cells.order), _AT_A_TIME):
        tell(start / len(cells.order))
        some = cells.picked(slice(start, start + _AT_A_TIME))
        last = found.mass.max() if len(found.order) == most else np.inf
        made = _best_of(task, some, _dense(task, some), np.minimum(some.mass, last))
        found = _first(task, [found, made], most)
        heard(lambda found=found: found)  # type: ignore[misc]
    shifted = _best_of(task, found, _shifted(task, found), found.mass)
    found = _of_each(task, Rated.joined([found, shifted]))
    return found.picked(ranked(found, task.criterion))


def least_width(task: SizeTask, variant: Rated) -> float:
    """Face width (mm) at which the least safety is just the one that is required; n = 1.

    A root between the width there is, which is safe, and the first half of it, or half of that, that is not.
    """

    def reserve(width: float) -> float:
        """Return a number that is below 0 for too narrow a face, and for one that has no rating."""
        size = np.array([[width]])
        found = rate_many(task, variant.pairs, size, np.ones((1, 1), bool), np.zeros((1, 1), int))
        if not len(found.order):
            return -1.0
        most = task.most_temperature
        return min(float(found.margin[0]) - 1, np.inf if most is None else most / float(found.temperature[0]) - 1)

    wide = float(variant.width[0])
    if reserve(wide) <= 0:
        return wide
    narrow = wide / 2
    while reserve(narrow) > 0:
        wide, narrow = narrow, narrow / 2
    return root_between(reserve, narrow, wide, xtol=1e-6)


def _of_each(task: SizeTask, found: Rated) -> Rated:
    """The best of each cell; a cell has one `order`."""
    if task.criterion is Criterion.MASS:
        return lightest_of_each(found, found.order)
    return best_of_each(found, found.order, task.criterion)


def _first(task: SizeTask, parts: list[Rated], most: int) -> Rated:
    """The best `most` of different cells, no two of the same teeth, module and helix angle, as neighbours may be refined to."""
    found = _of_each(task, Rated.joined(parts))
    found = found.picked(ranked(found, task.criterion))
    pairs = found.pairs
    _, first = np.unique(np.column_stack([*pairs.teeth, pairs.normal_module, pairs.helix_angle]), axis=0, return_index=True)
    return found.picked(np.sort(first)[:most])


# ---------------------------------------------------------------------- pairs


def _dense(task: SizeTask, cells: Rated) -> ManyPairs:
    """Return all pairs of cells that are within limits; their key is the number of their cell."""
    angles = [_angles(task, float(angle)) for angle in cells.pairs.helix_angle]
    number = np.repeat(np.arange(len(angles)), list(map(len, angles)))
    many = replace(cells.pairs.picked(number), key=number, helix_angle=np.concatenate(angles))
    if task.centre_distance is None:
        teeth = many.teeth.pinion + many.teeth.wheel
        sums = shift_sums_within(task)
        place, distance = distances_within(sums, teeth, many.normal_module, many.helix_angle, many.rack.pressure_angle)
        many = replace(many.picked(place), centre_distance=distance)
    return _with_shifts(task, many, _SHIFT_STEP)


def _shifted(task: SizeTask, cells: Rated) -> ManyPairs:
    """Return the pairs of cells with all shifts, in fine steps, within limits; their key is the number of their cell."""
    return _with_shifts(task, replace(cells.pairs, key=np.arange(len(cells.order))), _FINE_SHIFT_STEP)


def _angles(task: SizeTask, own: float) -> Floats:
    """Helix angles that are no nearer to another angle of the task than to this one."""
    given = np.array([each for each in task.helix_angles if each > 0])
    if own == 0:
        return np.zeros(1)
    steps = np.arange(np.ceil(given[0] / _HELIX_STEP), np.floor(given[-1] / _HELIX_STEP) + 1) * _HELIX_STEP
    steps = np.union1d(steps, own)
    result: Floats = steps[np.abs(steps - own) <= np.abs(steps[:, None] - given).min(axis=1) + 1e-9]
    return result


def _with_shifts(task: SizeTask, pairs: ManyPairs, step: float) -> ManyPairs:
    """Pairs at their centre distances with all shifts, where they are within limits."""
    first, last = (end / step for end in (task.shifts[0], task.shifts[-1]))
    steps = np.arange(np.ceil(first - 1e-9), np.floor(last + 1e-9) + 1) * step
    shifts = np.union1d(np.round(steps, 6), task.shifts) + 0.0  # no -0
    teeth = pairs.teeth.pinion + pairs.teeth.wheel
    total = shift_sum_at(pairs.centre_distance, teeth, pairs.normal_module, pairs.helix_angle, pairs.rack.pressure_angle)
    many = pairs.picked(np.repeat(np.arange(len(pairs.key)), len(shifts)))
    shift = np.tile(shifts, len(pairs.key))
    found = replace(many, shifts=PerGear(shift, np.repeat(total, len(shifts)) - shift))
    for met in LIMITS.values():
        found = found.picked(met(found, task))
    return found


# ---------------------------------------------------------------------- widths


def _best_of(task: SizeTask, cells: Rated, pairs: ManyPairs, most_mass: Floats) -> Rated:
    """The best of each cell that one of its pairs makes; by mass none is heavier than `most_mass` (kg) of its cell."""
    by_mass = task.criterion is Criterion.MASS
    most = most_mass if by_mass else np.full(len(cells.order), np.inf if task.max_mass is None else task.max_mass)
    parts = _lightest(task, pairs, most) if by_mass else _widest(task, pairs, most)
    return _of_each(task, Rated.joined([cells, *(replace(part, order=cells.order[part.pairs.key]) for part in parts)]))


def _ends(task: SizeTask, pairs: ManyPairs, most_mass: Floats) -> tuple[Floats, Floats]:
    """Return the least and the greatest face width (mm) of each pair."""
    ratios, d = (task.width_ratios[0], task.width_ratios[-1]), pairs.diameters.pinion
    low, most = (rounded_width(ratio * d) for ratio in ratios)
    by_mass = most_mass[pairs.key] / _mass_of_width(task, pairs)
    most = np.minimum(most, np.minimum(task.max_width_in_modules * pairs.normal_module, by_mass))
    return low, _rounded_down(most)


def _mass_of_width(task: SizeTask, pairs: ManyPairs) -> Floats:
    """Mass per face width (kg/mm)."""
    return disc_mass(pairs, np.ones(1), PerGear(*(each.density for each in task.materials)))


def _rounded_down(width: Floats) -> Floats:
    """Return face widths (mm) rounded as by `rounded_width`, but never up."""
    return np.where(width < 10, np.floor(width * 10 + 1e-6) / 10, np.floor(width + 1e-6))


def _step(width: Floats) -> Floats:
    """Return the step (mm) of face widths from a width upwards."""
    return np.where(width < 10 - 1e-6, 0.1, 1.0)


def _widest(task: SizeTask, pairs: ManyPairs, most_mass: Floats) -> Iterator[Rated]:
    """Yield the safe pairs with widths from the least to the greatest."""
    low, high = _ends(task, pairs, most_mass)
    width = rounded_width(np.linspace(low, high, _MOST_WIDTHS, axis=1))
    yield _safe(task, pairs, width, (width >= low[:, None]) & (width <= high[:, None]))


def _lightest(task: SizeTask, pairs: ManyPairs, most_mass: Floats) -> Iterator[Rated]:
    """Pairs with the least width at which they are safe, unless others of the cell are lighter anyway.

    Between edges safeties grow with the width: at first what is safe at an edge or at the most width is found, then the width
    from which it is by ever closer widths between one that is not and one that is.
    """
    most, (low, high) = most_mass.copy(), _ends(task, pairs, most_mass * NEARLY)
    there = low <= high
    pairs, low, high = pairs.picked(there), low[there], high[there]
    edges = [edge for edge in _EDGES if np.any((low < edge) & (edge < high))]
    width = np.column_stack([low, *(np.clip(edge, low, high) for edge in edges), high])
    while len(pairs.key):
        found = _safe(task, pairs, width, np.ones(width.shape, bool))
        yield found
        np.minimum.at(most, found.pairs.key, found.mass)
        safe = _places(found, width)
        first = np.argmax(safe, axis=1)
        rows = np.arange(len(width))
        high, low = width[rows, first], width[rows, np.maximum(first - 1, 0)]
        lighter = (low + _step(low)) * _mass_of_width(task, pairs) <= most[pairs.key] * NEARLY
        left = np.any(safe, axis=1) & (first > 0) & (low + _step(low) < high - 1e-6) & lighter
        pairs, low, high = pairs.picked(left), low[left], high[left]
        width = rounded_width(np.linspace(low, high, _WIDTHS, axis=1))


def _safe(task: SizeTask, pairs: ManyPairs, width: Floats, wanted: Bools) -> Rated:
    """Return the variants with all safeties; their order is their place in (n, w)."""
    found = rate_many(task, pairs, width, wanted, np.arange(width.size).reshape(width.shape))
    return found.picked(found.safe(task))


def _places(found: Rated, width: Floats) -> Bools:
    """Return a mask (n, w) of the variants found."""
    result = np.zeros(width.shape, bool)
    result.ravel()[found.order] = True
    return result
