"""size: the best pairs for a task."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gearcad.errors import GearcadError, InputError
from gearcad.progress import Agenda, Expected, Progress
from gearcad.rating.strength import rate_strength
from gearcad.sizing.rated import Rated
from gearcad.sizing.refine import refined
from gearcad.sizing.search import STEP, Survey, survey
from gearcad.sizing.sized import SizedPair, Sizing, front_pairs
from gearcad.sizing.task import Criterion, SizeTask
from gearcad.sizing.transmission import transmission_error
from gearcad.verdict import Verdict

__all__ = ["REACH", "expected", "search_pairs"]

REACH = 1.5
"""How many times as heavy as the lightest a pair may be, for which something else than mass comes first."""

_REFINED, _LEAST_REFINED = 2, 40
"""How many times the wanted number is kept, since not all of them may pass the full rating; and at the least how many are."""

_VARIANTS_A_SECOND, _REFINEMENT_SECONDS, _ERROR_SECONDS = 4e5, 0.03, 2.0
_MEMORY = 4e8
"""Bytes, numpy and scipy included."""

_REFINE, _ERROR = "refinement", "transmission error"


def search_pairs(task: SizeTask, *, count: int = 20, errors: int = 20, progress: Progress | None = None) -> Sizing:
    """The best `count` pairs for a task, the first of them, as many as `errors`, with their transmission error.

    By Criterion.QUIET they are in the order of that in the end, of which the lines of contact know only half.

    All variants of the task are gone through, and the best refined; each that is shown is rated by `rate_strength`, and left
    out unless it passes that, too.
    """
    most = max(_REFINED * count, _LEAST_REFINED)
    agenda = Agenda(progress, {STEP: _seconds(task), _REFINE: most * _REFINEMENT_SECONDS, _ERROR: errors * _ERROR_SECONDS})
    if task.criterion is not Criterion.MASS and task.max_mass is None:
        lightest = survey(replace(task, criterion=Criterion.MASS)).best
        if lightest is not None:
            task = replace(task, max_mass=float(f"{REACH * lightest.mass.min():.3g}"))
    seen = survey(task, agenda)
    unmade: list[str] = []
    found = list(_judged(task, _refined(task, seen, most, agenda), count, unmade))
    for number in range(min(errors, len(found))):
        agenda(_ERROR, number / errors, found[number].name)
        found[number] = _with_error(found[number])
    if task.criterion is Criterion.QUIET:
        found.sort(key=lambda each: math.inf if each.transmission_error is None else round(each.transmission_error, 2))
    return Sizing(
        task=task,
        found=tuple(found),
        considered=seen.considered,
        rated=seen.rated,
        removed=seen.removed,
        unmade=tuple(unmade),
        cloud=_places(seen.best),
        front=front_pairs(task, seen.front),
        strongest=None if seen.strongest is None else SizedPair.of(task, seen.strongest),
        lightest=None if seen.lightest is None else SizedPair.of(task, seen.lightest),
    )


def expected(task: SizeTask, count: int, errors: int) -> Expected:
    """What that takes."""
    refinement = max(_REFINED * count, _LEAST_REFINED) * _REFINEMENT_SECONDS
    seconds = _seconds(task) + refinement + errors * _ERROR_SECONDS
    return Expected(seconds, _MEMORY, f"{task.variants:,} variants".replace(",", "\N{NO-BREAK SPACE}"))


def _seconds(task: SizeTask) -> float:
    return task.variants / _VARIANTS_A_SECOND


def _refined(task: SizeTask, seen: Survey, most: int, agenda: Agenda) -> Rated | None:
    """The best combinations after refinement, best first."""
    if seen.best is None:
        return None
    return refined(task, seen.best, most, lambda part: agenda(_REFINE, part))


def _judged(task: SizeTask, best: Rated | None, count: int, unmade: list[str]) -> Iterator[SizedPair]:
    """The first `count` that can be made and pass the full rating; `unmade` hears why others do not."""
    passed = 0
    for place in range(0 if best is None else len(best.order)):
        assert best is not None
        if passed == count:
            return
        sized = SizedPair.of(task, best.picked(np.array([place])))
        try:
            judged = _rated(sized)
        except InputError as error:
            unmade.append(f"{sized.name}: {error}")
            continue
        if judged.strength is not None and judged.strength.strength is not Verdict.PASSED:
            unmade.append(f"{sized.name}: {judged.strength.verdict}")
            continue
        passed += 1
        yield replace(judged, front=_on_front(best, place))


def _rated(sized: SizedPair) -> SizedPair:
    """With its full rating. Raises InputError for a pair that cannot be made."""
    task = sized.task
    return replace(sized, strength=rate_strength(sized.pair(), task.materials, task.load, task.rating))


def _on_front(rated: Rated, place: int) -> bool:
    """Whether none of them is both lighter and safer, and none as good in one and better in the other."""
    mass, margin = rated.mass, rated.margin
    better = (mass <= mass[place]) & (margin >= margin[place])
    return not bool(np.any(better & ((mass < mass[place]) | (margin > margin[place]))))


def _with_error(sized: SizedPair) -> SizedPair:
    """With its transmission error, if that can be had."""
    task = sized.task
    try:
        error = transmission_error(sized.pair(), task.materials, task.load.torque)
    except GearcadError:  # such as thin rims or gears of two elasticities: the line stays without
        return sized
    return replace(sized, transmission_error=error)


def _places(rated: Rated | None) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Masses and margins (2, n)."""
    return np.zeros((2, 0)) if rated is None else np.array([rated.mass, rated.margin])
