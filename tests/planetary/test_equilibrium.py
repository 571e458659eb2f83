"""Springs that can only press: against all their active sets one by one, and where nothing is in balance."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Floats
from gearcad.dynamics.planetary.planetary_statics import Equilibrium

EXACT = 1e-9


def _by_hand(vectors: Floats, press: Bools, compliance: Floats, gap: Floats, load: Floats) -> list[Floats]:
    """Forces of every active set that fulfils all conditions: F >= 0 where closed, no overlap where open."""
    count, found = len(press), []
    size = vectors.shape[1]
    places = np.flatnonzero(press)
    for off in (set(each) for number in range(len(places) + 1) for each in combinations(places, number)):
        on, apart = [j for j in range(count) if j not in off], sorted(off)
        matrix = np.block([[-np.diag(compliance[on]), vectors[on]], [vectors[on].T, np.zeros((size, size))]])
        right = np.r_[gap[on], load]
        solved, *_ = np.linalg.lstsq(matrix, right, rcond=1e-12)
        forces = np.zeros(count)
        forces[on] = solved[: len(on)]
        opening = gap[apart] - vectors[apart] @ solved[len(on) :]
        if np.allclose(matrix @ solved, right, atol=1e-8) and (forces[places] > -EXACT).all() and (opening > -EXACT).all():
            found.append(forces)
    return found


@pytest.mark.parametrize("seed", range(40))
def test_forces_are_those_of_the_one_active_set(seed: int) -> None:
    random = np.random.default_rng(seed)
    size = int(random.integers(2, 5))
    count = size + int(random.integers(1, 5))
    vectors, press = random.normal(size=(count, size)), random.random(count) < 0.7
    compliance = random.uniform(0.1, 3, count)
    gap, load = random.normal(size=count) * random.choice([0.1, 3]), random.uniform(0, 1, count) @ vectors
    springs = Equilibrium(vectors=vectors, press=press)
    case = compliance[None], gap[None], load[None]
    forces, opening = springs.forces(*case)
    sets = _by_hand(vectors, press, compliance, gap, load)
    assert sets  # the load is one that pressing springs can carry
    for other in sets:  # degenerate ones differ in what is open, not in forces
        assert forces[0] == pytest.approx(other, abs=EXACT * np.abs(other).max())
    assert (opening[0] >= 0).all()
    elongation = compliance * forces[0] + gap - opening[0]
    assert vectors @ springs.displacement(elongation[None])[0] == pytest.approx(elongation, abs=EXACT)


def test_there_is_none_where_a_spring_would_have_to_pull() -> None:
    """Two springs on either side of a body that is pulled between them, and a third that ties it."""
    vectors = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    springs = Equilibrium(vectors=vectors, press=np.array([True, True, False]))
    one = np.ones((1, 3))
    forces, opening = springs.forces(one, np.zeros((1, 3)), np.array([[2.0, 5.0]]))
    assert forces[0] == pytest.approx([2, 0, 5]) and opening[0] == pytest.approx([0, 2, 0])
    only = Equilibrium(vectors=vectors[::2], press=np.array([True, False]))
    with pytest.raises(SolverError, match="no compressive forces"):
        only.forces(one[:, :2], np.zeros((1, 2)), np.array([[-2.0, 5.0]]))


def test_many_cases_are_each_by_itself() -> None:
    random = np.random.default_rng(7)
    vectors, press = random.normal(size=(8, 4)), np.arange(8) < 5
    compliance, gap = random.uniform(0.1, 3, (20, 8)), random.normal(size=(20, 8))
    load = random.uniform(0, 1, (20, 8)) @ vectors
    springs = Equilibrium(vectors=vectors, press=press)
    together, _ = springs.forces(compliance, gap, load)
    alone = [springs.forces(compliance[i : i + 1], gap[i : i + 1], load[i : i + 1])[0][0] for i in range(20)]
    assert together == pytest.approx(np.array(alone), abs=1e-10)


def test_what_springs_cannot_carry_is_found() -> None:
    springs = Equilibrium(vectors=np.array([[1.0, 0.0], [2.0, 0.0]]), press=np.array([True, True]))
    assert springs.redundancy == 1
    assert springs.unbalanced(np.array([[3.0, 0.0], [3.0, 0.5]])) == pytest.approx(np.array([[0, 0], [0, 0.5]]))
