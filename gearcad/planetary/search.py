"""Search of planetary sets for a ratio: every set within limits, condition by condition, ranked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.errors import InputError
from gearcad.core.records import JsonObject, Wholes
from gearcad.geometry import Gear
from gearcad.planetary.members import Central, Rim, SetType
from gearcad.planetary.tooth_numbers import CONDITIONS, MEMBERS, ManySets, SearchTask, TeethGrid, grids, ratios
from gearcad.planetary.train import PlanetaryTrain

RIMS = ("planet", "planet_2")


@dataclass(frozen=True, kw_only=True)
class PlanetarySet:
    """One set that was found. Lengths in mm, `deviation` of its ratio in %.

    `teeth`, `profile_shifts` and `tip_alterations` by the names of its gears. `phases` are z mod N of each mesh, 0 where all
    planets are in phase; `common` the greatest common divisors of the teeth that mesh, 1 where each meets every other.
    `error_share` is what is left, while a central floats, of the load that an error of one planet would bring: 0 up to
    three planets, (N - 3)/N with more. `diameter` is the greatest over all teeth.
    """

    task: SearchTask
    kind: SetType
    planets: int
    teeth: dict[str, int]
    centre_distance: float
    profile_shifts: dict[str, float]
    tip_alterations: dict[str, float]
    ratio: float
    deviation: float
    diameter: float
    positions: int
    phases: tuple[int, int]
    common: tuple[int, int]
    efficiency: float

    @property
    def name(self) -> str:
        """Name such as A-24-21-66-n3."""
        return f"{self.kind.value}-{'-'.join(str(abs(teeth)) for teeth in self.teeth.values())}-n{self.planets}"

    @property
    def error_share(self) -> float:
        """1 - 3/N, or 0."""
        return max(0.0, 1 - 3 / self.planets)

    @property
    def second_height(self) -> float:
        """Bottom of the second rim above that of the first (mm): a module of room between them."""
        return self.task.width + max(self.task.modules)

    @property
    def helix_angles(self) -> dict[str, float]:
        """Helix angles of the gears (degrees): the rims of a planet have the hand of rings, opposed to that of suns."""
        planet = -self.task.helix_angle if self.kind is not SetType.D else self.task.helix_angle
        return {name: (-planet if name.startswith("sun") else planet) + 0.0 for name in self.teeth}

    @property
    def modules(self) -> dict[str, float]:
        """Normal modules of the gears (mm) by their names."""
        first, second = self.task.modules
        of_second = (MEMBERS[self.kind][1], RIMS[1]) if self.kind is not SetType.A else ()
        return {name: second if name in of_second else first for name in self.teeth}

    def gear(self, name: str) -> Gear:
        """Return one of the gears. Raises GeometryError."""
        return Gear(
            name=name,
            teeth=self.teeth[name],
            normal_module=self.modules[name],
            face_width=self.task.width,
            helix_angle=self.helix_angles[name],
            profile_shift=self.profile_shifts[name],
            tip_alteration=self.tip_alterations[name],
        )

    def train(self) -> PlanetaryTrain:
        """Return the train, checked. Raises GeometryError if it cannot be made."""
        roles, stepped = self.task.roles(self.kind), self.kind is not SetType.A
        meshed = (RIMS[0], RIMS[stepped])
        return PlanetaryTrain(
            name=self.name,
            planets=self.planets,
            centrals=tuple(
                Central(name=name, gear=self.gear(name), meshes=rim)
                for name, rim in zip(MEMBERS[self.kind][:2], meshed, strict=True)
            ),
            rims=tuple(
                Rim(name=name, gear=self.gear(name), axial_position=height)
                for name, height in ((RIMS[0], 0.0), (RIMS[1], self.second_height))[: 1 + stepped]
            ),
            centre_distance=self.centre_distance,
            tip_distance=self.task.least_distance,
            **roles._asdict(),
        )

    def to_dict(self) -> JsonObject:
        """Return the candidate as a document for JSON."""
        return {
            "name": self.name,
            "type": self.kind.value,
            "planets": self.planets,
            "teeth": self.teeth,
            "ratio": self.ratio,
            "deviation": self.deviation,
            "diameter": self.diameter,
            "centre_distance": self.centre_distance,
            "profile_shifts": self.profile_shifts,
            "tip_alterations": self.tip_alterations,
            "positions": self.positions,
            "phases": list(self.phases),
            "common": list(self.common),
            "efficiency": self.efficiency,
            "error_share": self.error_share,
        }


MOST_TRIALS = 5
"""Sets that are made for each that is asked for, before the search gives up on those that cannot be made."""

BATCH = 100_000
"""Sets near the ratio that are looked at together, without the number of their planets: memory stays small."""

WIDER = 4.0
"""Factor on the tolerance with which the nearest sets are searched if none is found."""

WIDEST = 300.0
"""Largest deviation (%) up to which the tolerance is widened."""


@dataclass(frozen=True, kw_only=True)
class SearchResult:
    """The result of a search, best set first.

    `considered` are all sets with their numbers of planets, `removed` how many each condition took of those that the ones
    before it had left, `unmade` what those say that could not be made, `left` how many more would follow.
    `nearest` are ratios that sets outside the tolerance reach, below and above, if none is inside.
    """

    task: SearchTask
    found: tuple[PlanetarySet, ...]
    considered: int
    removed: dict[str, int]
    unmade: tuple[str, ...]
    left: int
    nearest: tuple[float, ...] = ()

    def to_dict(self) -> JsonObject:
        """Return the result as a document for JSON."""
        return {
            "kind": "planetary search",
            "task": asdict(self.task) | {"types": [kind.value for kind in self.task.types]},
            "found": [candidate.to_dict() for candidate in self.found],
            "considered": self.considered,
            "removed": self.removed,
            "unmade": list(self.unmade),
            "left": self.left,
            "nearest": list(self.nearest),
        }


def search(task: SearchTask, count: int = 20) -> SearchResult:
    """Return the best sets for a ratio: by its deviation, then diameter, planets out of phase, hunting teeth, efficiency."""
    met = _meeting(task)
    found, unmade, left = _best_sets(met.kept, count)
    nearest = () if found or left else _nearest(task)
    return SearchResult(
        task=task,
        found=tuple(found),
        considered=met.considered,
        removed=met.removed,
        unmade=tuple(unmade),
        left=left,
        nearest=nearest,
    )


class _Meeting(NamedTuple):
    """The sets of each type that meet all conditions, how many there were, and what took the others."""

    kept: list[ManySets]
    considered: int
    removed: dict[str, int]


def _meeting(task: SearchTask) -> _Meeting:
    considered, removed = 0, dict.fromkeys(("ratio", *CONDITIONS), 0)
    kept: list[ManySets] = []
    for sets, seen in (batch for kind in task.types for batch in _near_ratio(task, kind)):
        considered += seen
        removed["ratio"] += seen - len(sets.planets)
        left = sets
        for name, met in CONDITIONS.items():
            mask = met(left)
            removed[name] += int(np.count_nonzero(~mask))
            left = left.picked(mask)
        kept.append(left)
    return _Meeting(kept, considered, removed)


def _best_sets(kept: list[ManySets], count: int) -> tuple[list[PlanetarySet], list[str], int]:
    """Return the best sets that can be made, the messages of those that cannot, and the number that are left."""
    found: list[PlanetarySet] = []
    unmade: list[str] = []
    for candidate in _ranked(kept):
        if len(found) == count or len(found) + len(unmade) == MOST_TRIALS * count:
            break
        try:
            candidate.train()
        except InputError as error:
            unmade.append(f"{candidate.name}: {error}")
            continue
        found.append(candidate)
    return found, unmade, sum(len(sets.planets) for sets in kept) - len(found) - len(unmade)


def _nearest(task: SearchTask) -> tuple[float, ...]:
    """Return the nearest ratios below and above that sets reach; none where all are farther off than WIDEST."""
    tolerance = task.tolerance or 1.0
    while tolerance < WIDEST:
        tolerance = min(tolerance * WIDER, WIDEST)
        kept = _meeting(replace(task, tolerance=tolerance)).kept
        sides = [[sets.picked(side * (sets.ratio - task.ratio) > 0) for sets in kept] for side in (-1, 1)]
        if reached := [each.ratio for side in sides for each in _best_sets(side, 1)[0]]:
            return tuple(reached)
    return ()


def _near_ratio(task: SearchTask, kind: SetType) -> Iterator[tuple[ManySets, int]]:
    """Sets whose ratio is within the tolerance, with every number of planets, and how many were looked at; some at a time."""
    numbers = np.arange(task.planets[0], task.planets[1] + 1)
    near: list[TeethGrid] = []
    waiting = seen = 0
    for grid in grids(task, kind):
        seen += len(grid.a) * len(numbers)
        deviation = np.abs(ratios(task, kind, grid) / task.ratio - 1)
        near.append(grid.picked(deviation <= task.tolerance / 100 + ROUNDING))
        waiting += len(near[-1].a)
        if waiting > BATCH:
            yield _with_planets(task, kind, near, numbers), seen
            near, waiting, seen = [], 0, 0
    if near:
        yield _with_planets(task, kind, near, numbers), seen


def _with_planets(task: SearchTask, kind: SetType, near: list[TeethGrid], numbers: Wholes) -> ManySets:
    """Return every set with every number of planets."""
    teeth = TeethGrid(*(np.repeat(np.concatenate(parts), len(numbers)) for parts in zip(*near, strict=True)))
    return ManySets(task, kind, teeth, np.tile(numbers, len(teeth.a) // len(numbers)))


ROUNDING = 1e-12
"""Relative difference of ratios below which they count as equal."""


def _ranked(kept: list[ManySets]) -> Iterator[PlanetarySet]:
    """Yield the sets of all types, best first."""
    keys = [np.concatenate(parts) for parts in zip(*(_keys(sets) for sets in kept), strict=True)]
    starts = np.cumsum([0, *(len(sets.planets) for sets in kept)])
    for place in np.lexsort(keys[::-1]):
        which = int(np.searchsorted(starts, place, side="right")) - 1
        yield _candidate(kept[which], int(place - starts[which]))


def _keys(sets: ManySets) -> tuple[np.ndarray[Any, Any], ...]:
    """Return the sort keys of sets, the first key first; ties go by planets and teeth.

    Values are rounded, so that equal ones are equal.
    """
    deviation = np.round(np.abs(sets.ratio / sets.task.ratio - 1), 12)
    diameter = np.round(sets.sizes.diameter, 6)
    last = (sets.planets, *(np.abs(teeth) for teeth in sets.teeth))
    return deviation, diameter, sets.in_phase, sets.common, -np.round(sets.efficiency, 9), *last


def _candidate(sets: ManySets, place: int) -> PlanetarySet:
    """Return one of the sets as a candidate."""
    one = sets.picked(np.array([place]))
    kind, sizes, stepped = sets.kind, one.sizes, sets.kind is not SetType.A
    a, rim_a, rim_b, b = (int(teeth[0]) for teeth in one.teeth)
    first, second = MEMBERS[kind][:2]
    names = (first, RIMS[0], RIMS[1], second) if stepped else (first, RIMS[0], RIMS[0], second)
    rims, centrals, planets = sizes.rim_shifts, sizes.central_shifts, int(one.planets[0])
    shifts = (centrals[0], rims[0], rims[1], centrals[1])
    tips, own = sizes.tip_alterations, sizes.central_alterations
    alterations = (own[0], tips[0], tips[1], own[1])
    common = (np.gcd(a, rim_a), np.gcd(b, rim_b))
    return PlanetarySet(
        task=sets.task,
        kind=kind,
        planets=planets,
        teeth=dict(zip(names, (a, rim_a, rim_b, b), strict=True)),
        centre_distance=float(sizes.distance[0]),
        profile_shifts={name: float(shift[0]) for name, shift in zip(names, shifts, strict=True)},
        tip_alterations={name: float(k[0]) for name, k in zip(names, alterations, strict=True)}
        | ({} if stepped else {RIMS[0]: float(min(tips[0][0], tips[1][0]))}),
        ratio=float(one.ratio[0]),
        deviation=float((one.ratio[0] / sets.task.ratio - 1) * 100),
        diameter=float(sizes.diameter[0]),
        positions=int(one.teeth.positions[0]),
        phases=(a % planets, b % planets),
        common=(int(common[0]), int(common[1])),
        efficiency=float(one.efficiency[0]),
    )
