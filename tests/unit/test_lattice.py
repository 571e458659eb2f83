"""The least of a function of whole numbers, against all its values."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from gearcad.contact.modification_search import Goal, Lattice, Remembered

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
