"""Numerical functions against `math`, SciPy and plain loops: functions of numbers or arrays, roots, maxima, lattices."""

import itertools
import math
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from gearcad import SolverError
from gearcad.contact.modification_search import Goal, Lattice, Remembered
from gearcad.core import values
from gearcad.dynamics.time_domain.spectra import apart, outstanding
from gearcad.geometry.involute import root_between

ROUNDING = 1e-15
"""Relative: numpy's functions are not those of `math`, whose last digits may differ."""

ONE = (
    (values.sin, math.sin),
    (values.cos, math.cos),
    (values.tan, math.tan),
    (values.arcsin, math.asin),
    (values.arccos, math.acos),
    (values.arctan, math.atan),
    (values.radians, math.radians),
    (values.degrees, math.degrees),
    (values.root, math.sqrt),
    (values.fourth_root, lambda value: math.pow(value, 0.25)),
    (values.magnitude, abs),
)
TWO = (
    (values.larger, max),
    (values.smaller, min),
    (values.hypot, math.hypot),
    (values.arctan2, math.atan2),
    (values.with_sign, math.copysign),
)
PLACES = [0.05, 0.3, 0.7, 0.95]


@pytest.mark.parametrize(("function", "of_number"), ONE)
def test_one_argument(function: Callable[..., Any], of_number: Callable[..., float]) -> None:
    expected = [of_number(place) for place in PLACES]
    assert [function(place) for place in PLACES] == expected
    assert all(type(function(place)) is float for place in PLACES)
    assert function(np.array(PLACES)) == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize(("function", "of_numbers"), TWO)
@pytest.mark.parametrize("other", [-0.4, 0.5])
def test_two_arguments(function: Callable[..., Any], of_numbers: Callable[..., float], other: float) -> None:
    expected = [of_numbers(place, other) for place in PLACES]
    assert [function(place, other) for place in PLACES] == expected
    assert all(type(function(place, other)) is float for place in PLACES)
    for given in (other, np.full(len(PLACES), other)):
        assert function(np.array(PLACES), given) == pytest.approx(expected, rel=ROUNDING)
    assert function(PLACES[0], np.array([other])) == pytest.approx([expected[0]], rel=ROUNDING)


def functions(chance: random.Random) -> Callable[[float], float]:
    a, b, c, d = (chance.uniform(-3, 3) for _ in range(4))
    kinds: tuple[Callable[[float], float], ...] = (
        lambda x: a * x**3 + b * x + c,
        lambda x: math.atan(a * (x - c)) + b / 1000,
        lambda x: math.exp(a * x) - abs(b),
        lambda x: a * math.sin(d * x) + b * x,
        lambda x: math.copysign(1.0, x - c),
    )
    return chance.choice(kinds)


@pytest.mark.parametrize("tolerances", [{}, {"xtol": 1e-14}, {"xtol": 1e-15, "rtol": 8.9e-16}])
def test_roots_are_those_of_scipy_to_the_last_bit(tolerances: dict[str, float]) -> None:
    chance, found = random.Random(3), 0
    while found < 500:
        function, low, high = functions(chance), chance.uniform(-4, 0), chance.uniform(0, 4)
        if function(low) * function(high) > 0:
            continue
        found += 1
        assert root_between(function, low, high, **tolerances) == brentq(function, low, high, **tolerances)


def test_ends_of_one_sign_are_refused() -> None:
    with pytest.raises(ValueError, match="different signs"):
        root_between(lambda x: x + 2.0, 0.0, 1.0)


def test_root_that_is_not_reached_is_an_error() -> None:
    with pytest.raises(SolverError, match="no root to 1e-300"):
        root_between(lambda x: (x - 0.3) ** 5, 0.0, 1.0, xtol=1e-300, rtol=1e-17)


@pytest.mark.parametrize("seed", range(40))
def test_maxima_that_stand_out(seed: int) -> None:
    """Of courses of whole numbers, which stay alike at many places."""
    from scipy.signal import find_peaks

    random = np.random.default_rng(seed)
    values = np.cumsum(random.integers(-2, 3, random.integers(1, 150))).astype(float)
    for prominence in (0.0, 1.0, 3.5):
        assert outstanding(values, prominence).tolist() == find_peaks(values, prominence=prominence)[0].tolist()


@pytest.mark.parametrize("seed", range(40))
def test_maxima_apart_from_each_other(seed: int) -> None:
    from scipy.signal import find_peaks

    values = np.random.default_rng(seed).normal(size=150)
    for distance in (1, 2, 7, 40):
        assert apart(values, distance).tolist() == find_peaks(values, distance=distance)[0].tolist()


def test_of_two_maxima_that_are_alike_one_stays() -> None:
    values = np.array([0.0, 2, 0, 2, 2, 0, 1, 0])
    assert apart(values, 1).tolist() == [1, 3, 6]
    assert apart(values, 3).tolist() == [3, 6]


LOW, HIGH = np.array([0, 4, -3, 7]), np.array([30, 34, 27, 7])
EVERY = np.array(list(itertools.product(*(range(low, high + 1) for low, high in zip(LOW, HIGH, strict=True)))))


def goal(seed: int) -> Goal:
    """Peak to peak of twelve figures that bend a little over three coordinates: a valley between kinks, along no axis."""
    rng = np.random.default_rng(seed)
    slopes, bends, heights = rng.normal(size=(4, 12)), 0.02 * rng.normal(size=(4, 12)), rng.normal(scale=8, size=12)

    def figures(places: np.ndarray) -> np.ndarray:
        away = places - np.array([14, 17, 9, 0])
        return heights + away @ slopes + away**2 @ bends

    return Goal(Remembered(figures), lambda rows: np.ptp(rows, axis=1))


@pytest.mark.parametrize("seed", [0, 2, 3, 4])
def test_the_least_of_all_places_is_found(seed: int) -> None:
    of, lattice = goal(seed), Lattice(LOW, HIGH)
    seen = lattice.survey(of, 4, LOW)
    ends = lattice.descend(of, lattice.best_apart(seen, of.at(seen), 4))
    solved = of.figures.count
    values = of.at(EVERY)
    assert of.at(ends).min() == pytest.approx(values.min(), rel=1e-12)
    assert solved < 0.04 * len(EVERY)
    # The survey alone does not get there: it is the descent that goes along the valley.
    assert of.at(seen).min() > 1.01 * values.min()


def test_what_a_processor_rounds_leads_no_search_another_way() -> None:
    """Figures that do not change along an axis, so that places tie, and noise of the size of rounding on them."""
    lattice, ways = Lattice(LOW, HIGH), []
    for seed in (1, 2):
        noise = np.random.default_rng(seed)

        def figures(places: np.ndarray, noise: np.random.Generator = noise) -> np.ndarray:
            clear = np.column_stack([(places[:, 0] // 7) ** 2, 30 + abs(places[:, 1] - 17), places[:, 2] // 5]).astype(float)
            return clear + noise.normal(scale=1e-11, size=clear.shape)

        of = Goal(Remembered(figures), lambda rows: np.ptp(rows, axis=1))
        seen = lattice.survey(of, 4, LOW)
        ways.append((lattice.descend(of, lattice.best_apart(seen, of.at(seen), 4)).tolist(), of.figures.count))
    assert ways[0] == ways[1]


def test_a_place_is_worked_out_once_and_never_outside() -> None:
    of, lattice, counted = goal(1), Lattice(LOW, HIGH), []

    def work(places: np.ndarray) -> np.ndarray:
        counted.append(places)
        return of.figures(places)

    once = Goal(Remembered(work), of.value)
    lattice.descend(once, np.array([LOW, HIGH]))
    places = np.concatenate(counted)
    assert len(np.unique(places, axis=0)) == len(places)
    assert (places >= LOW).all() and (places <= HIGH).all()


def test_starts_lie_apart() -> None:
    of, lattice = goal(2), Lattice(LOW, HIGH)
    starts = lattice.best_apart(EVERY[::7], of.at(EVERY[::7]), 5)
    apart = np.abs(starts[:, None] - starts)[:, :, :3].max(axis=2)
    assert (apart[~np.eye(5, dtype=bool)] >= 3).all()
