"""Load spectra: Miner's sum against a sum by hand, safety and life where it is 1, torques for a safety."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcad import ParameterError
from gearcad.material import MaterialGroup as G
from gearcad.rating.factors import flank_life_factor, flank_points, root_life_factor, root_points
from gearcad.rating.strength.duty import (
    FLANK_POWER,
    ROOT_POWER,
    damage_sum,
    equivalent_torque,
    life_at_failure,
    permissible_cycles,
    permissible_torque,
    safety_at_failure,
    torque_at_safety,
    torque_exponent,
)

FLANK = tuple((cycles, 1300 * factor) for cycles, factor in flank_points(G.CASE_HARDENED))
ROOT = tuple((cycles, 860 * factor) for cycles, factor in root_points(G.CASE_HARDENED))
CYCLES, STRESSES = np.array([1e4, 1e6, 1e8, 3e9]), np.array([1500.0, 1200, 950, 700])


def _by_hand(stress: float) -> float:
    """N of a flank, with the slopes worked out: 13.2225 of limited life, which goes on above 2080 MPa, 32.6008 beyond."""
    if stress >= 1300:
        return 5e7 * (1300 / stress) ** (math.log(500) / math.log(1.6))
    return 5e7 * (1300 / stress) ** (math.log(200) / math.log(1 / 0.85))


def test_permissible_cycles() -> None:
    stresses = np.array([2500.0, 2081, 2080, 1900, 1300, 1200, 1105, 900, 0.001])
    expected = [_by_hand(float(stress)) for stress in stresses]
    assert permissible_cycles(stresses, FLANK)[:-1] == pytest.approx(expected[:-1], rel=1e-9)
    assert permissible_cycles(0.0, FLANK) > 1e200
    kept = permissible_cycles(stresses, FLANK, endurance=True)
    assert kept[:7] == pytest.approx(expected[:7], rel=1e-9)
    assert kept[7:].tolist() == [math.inf, math.inf]
    level = tuple((cycles, 1300 * factor) for cycles, factor in flank_points(G.CASE_HARDENED, long_life=1.0))
    assert permissible_cycles(np.array([1300.001, 1300, 800]), level) == pytest.approx([5e7, math.inf, math.inf], rel=1e-4)


def test_a_static_strength_below_endurance_holds_for_more_cycles_too() -> None:
    odd = ((1e3, 100.0), (3e6, 120.0), (1e10, 102.0))
    assert permissible_cycles(np.array([100.1, 100, 50]), odd).tolist() == [0, math.inf, math.inf]


def test_the_line_of_limited_life_goes_on_above_the_static_strength() -> None:
    """No jump at the corner; twice the stress is 2^-13.2225 of the cycles; a level start goes on from where it ends."""
    found = permissible_cycles(np.array([2080 * (1 - 1e-9), 2080 * (1 + 1e-9), 4160.0]), FLANK)
    assert found == pytest.approx([1e5, 1e5, 1e5 * 2 ** -(math.log(500) / math.log(1.6))], rel=1e-6)
    level = ((1e3, 2080.0), *FLANK)
    assert permissible_cycles(np.array([2080.001, 4160.0]), level) == pytest.approx(found[1:], rel=1e-5)
    # The safety is never more than the static strength over the greatest stress.
    assert safety_at_failure(np.array([1.0]), np.array([4160.0]), FLANK) == pytest.approx(0.5, rel=1e-12)


@pytest.mark.parametrize("endurance", [False, True])
def test_the_safety_is_that_of_a_damage_of_one(endurance: bool) -> None:
    """Against the damage at 20,001 safeties, summed by hand."""
    tried = np.linspace(0.8, 1.6, 20_001)
    limit = 1105 if endurance else 0
    damage = [
        sum(n / max(_by_hand(s * each), 1e-99) for n, s in zip(CYCLES, STRESSES, strict=True) if s * each >= limit)
        for each in tried[::100]
    ]
    found = [damage_sum(CYCLES, STRESSES, FLANK, safety=each, endurance=endurance) for each in tried[::100]]
    inside = [each for each, value in enumerate(damage) if value < 1e50]
    assert np.array(found)[inside] == pytest.approx(np.array(damage)[inside], rel=1e-9)
    safety = safety_at_failure(CYCLES, STRESSES, FLANK, endurance=endurance)
    assert damage_sum(CYCLES, STRESSES, FLANK, safety=safety, endurance=endurance) <= 1
    assert damage_sum(CYCLES, STRESSES, FLANK, safety=safety * (1 + 1e-9), endurance=endurance) > 1
    assert tried[::100][np.searchsorted(damage, 1) - 1] <= safety <= tried[::100][np.searchsorted(damage, 1)]


def test_one_load_has_the_safety_of_the_life_factor() -> None:
    for cycles in (1.0, 1e3, 1e5, 3e6, 5e7, 2e8, 1e10):
        one = np.array([cycles])
        flank = 1300 * flank_life_factor(cycles, G.CASE_HARDENED) / 1000
        assert safety_at_failure(one, np.array([1000.0]), FLANK) == pytest.approx(flank, rel=1e-9)
        root = 860 * root_life_factor(cycles, G.CASE_HARDENED) / 400
        assert safety_at_failure(one, np.array([400.0]), ROOT) == pytest.approx(root, rel=1e-9)


def test_more_load_and_more_cycles_are_never_safer() -> None:
    chance = np.random.default_rng(19)
    for _ in range(20):
        cycles, stresses = 10 ** chance.uniform(3, 10, 5), chance.uniform(500, 1600, 5)
        safety = safety_at_failure(cycles, stresses, FLANK)
        which = int(chance.integers(5))
        more, higher = cycles.copy(), stresses.copy()
        more[which] *= 2
        higher[which] *= 1.1
        assert safety_at_failure(more, stresses, FLANK) <= safety
        assert safety_at_failure(cycles, higher, FLANK) <= safety
        assert safety_at_failure(cycles, 2 * stresses, FLANK) == pytest.approx(safety / 2, rel=1e-9)


def test_no_load_and_no_number() -> None:
    assert safety_at_failure(np.array([0.0, 1e6]), np.array([5000.0, 0]), FLANK) == math.inf
    assert damage_sum(np.array([0.0, 1e5]), np.array([5000.0, 2080]), FLANK) == pytest.approx(1)
    assert damage_sum(np.array([1.0, 1e5]), np.array([5000.0, 2080]), FLANK) == pytest.approx(1 + 1 / _by_hand(5000.0))
    with pytest.raises(ParameterError, match="stress"):
        safety_at_failure(np.array([1.0]), np.array([math.nan]), FLANK)


def test_life() -> None:
    damage = damage_sum(CYCLES, STRESSES, FLANK)
    life = life_at_failure(20_000.0, damage)
    assert damage_sum(CYCLES * life / 20_000, STRESSES, FLANK) == pytest.approx(1, rel=1e-12)
    assert life_at_failure(20_000.0, 0.0) == math.inf
    assert life_at_failure(20_000.0, math.inf) == 0


@pytest.mark.parametrize(("points", "power"), [(flank_points(G.NITRIDED), FLANK_POWER), (root_points(G.NITRIDED), ROOT_POWER)])
def test_the_equivalent_torque_does_the_same_damage_in_limited_life(points: tuple, power: float) -> None:
    curve = tuple((cycles, 1000 * factor) for cycles, factor in points)
    cycles, torques = np.array([2e4, 1e5, 3e5]), np.array([160.0, 140, 130])
    stresses = 1200 * (torques / 150) ** (1 / power)
    assert np.all((stresses > 1000) & (stresses < curve[0][1]))
    steady = equivalent_torque(cycles, torques, torque_exponent(points, power))
    whole, stress = np.array([cycles.sum()]), np.array([1200 * (steady / 150) ** (1 / power)])
    assert damage_sum(whole, stress, curve) == pytest.approx(damage_sum(cycles, stresses, curve), rel=1e-12)
    assert equivalent_torque(np.zeros(2), np.ones(2), 6.0) == 0
    assert equivalent_torque(np.ones(2), np.array([1e6, 1e6]), 84.0) == pytest.approx(1e6)


def test_torque_for_a_safety() -> None:
    """Where load factors stay, in closed form; where they depend on torque, S = 100/(T + 20) is 1.25 at 60 N·m."""
    assert permissible_torque(300.0, 1.5, 1.2, FLANK_POWER) == pytest.approx(300 * 1.5625)
    assert torque_at_safety(lambda torque: 1.5 * math.sqrt(300 / torque), 1.2, 300.0) == pytest.approx(300 * 1.5625, rel=1e-11)
    for begin in (0.01, 60.0, 5e4):
        assert torque_at_safety(lambda torque: 100 / (torque + 20), 1.25, begin) == pytest.approx(60, rel=1e-11)
    assert torque_at_safety(lambda torque: 10 / (torque + 20), 1.25, 1.0) == 0
    assert torque_at_safety(lambda torque: 5.0, 1.25, 1.0) == math.inf
