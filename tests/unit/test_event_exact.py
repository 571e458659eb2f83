"""Pairs of teeth integrated from event to event, each piece against something that knows nothing of events."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from gearcad.core.runtime import compiled
from gearcad.dynamics.time_domain.event_kernel import (
    MotionOutcome,
    Oscillator,
    PairMotion,
    Zone,
    _zero,
    accelerated,
    advanced,
    next_turn,
    run,
)

Floats = NDArray[np.float64]

ROUNDING = 1e-12
"""Relative to the amplitude: some thousand operations in double precision."""

PERIOD = 1e-10
"""Relative error of a bounce period and of the state after it."""

DISTURBANCE = 1e-6
"""Relative: a disturbance of a ten-millionth of the static approach, to both sides, has an error of second order."""

SPRINGS = {
    "free": Oscillator(0.0, 47.0, 1.9e4, 0.0),
    "free, barely damped": Oscillator(0.0, 1e-7, 1.9e4, 0.0),
    "free, undamped": Oscillator(0.0, 0.0, 1.9e4, 0.0),
    "underdamped": Oscillator(9.4e6, 47.0, 0.0, 1.6e-3),
    "undamped": Oscillator(9.4e6, 0.0, 0.0, 1.6e-3),
    "critical": Oscillator(100.0**2, 100.0, 0.0, 1.6e-3),
    "overdamped": Oscillator(100.0**2, 4000.0, 0.0, 1.6e-3),
}

BOUNCES = {0.5: 6.355890089178, 1.0: 6.712388980385, 3.0: 9.785093762383}
"""Period of y'' + max(y, 0) = 1 by the speed x at contact: 2 x + 2 pi - 2 atan x."""

_NEVER = Zone(-1e9, 1e9, 0.5, 0.5)

THESIS = PairMotion(
    9439492.4, 47.2, 1.5109e4, 5.166e-3, math.inf, Zone(1.87e-3, 9.97e-3, 0.594, 0.594), Zone(1.87e-3, 9.97e-3, 0.594, 0.594)
)
"""About the pair of Uhlir's thesis."""


def ran(
    motion: PairMotion, drift: float, start: tuple[float, float, float], step: float, samples: int, counted: float = 0.0
) -> tuple[Floats, Floats, MotionOutcome]:
    y, v = np.full(samples, np.nan), np.full(samples, np.nan)
    return y, v, run(motion, drift, start, step, counted, y, v)


# ---------------------------------------------------------------------- closed form


@pytest.mark.parametrize("tau", [1e-7, 3e-5, 2e-3, 0.4])
@pytest.mark.parametrize("name", SPRINGS)
def test_closed_form_is_the_matrix_exponential(name: str, tau: float) -> None:
    spring, y, v = SPRINGS[name], 4e-4, -2.3
    constant = spring.push + spring.square * spring.rest
    matrix = np.array([[0, 1, 0], [-spring.square, -2 * spring.half, constant], [0, 0, 0]])
    # In units of some kilohertz, for the exponential's own rounding.
    unit = np.diag([1.0, 1 / 3000, 1.0])
    expected = (np.linalg.inv(unit) @ expm(unit @ matrix @ np.linalg.inv(unit) * tau) @ unit @ [y, v, 1])[:2]
    size = max(abs(y), abs(v) / 3000, *np.abs(expected) / [1, 3000])
    np.testing.assert_allclose(
        np.array(advanced(spring, y, v, tau)) / [1, 3000], expected / [1, 3000], atol=2e-12 * size, rtol=0
    )


@pytest.mark.parametrize("v", [-2.3, 0.0, 0.3, 4.0])
@pytest.mark.parametrize("name", SPRINGS)
def test_next_turn_is_the_first_zero_of_the_acceleration(name: str, v: float) -> None:
    spring, y = SPRINGS[name], 4e-4
    turn, step = next_turn(spring, y, v)
    until = min(turn, 0.05)
    signs = {np.sign(accelerated(spring, *advanced(spring, y, v, until * part))) for part in np.linspace(0.001, 0.999, 200)}
    assert len(signs) == 1
    if math.isfinite(turn):
        after = accelerated(spring, *advanced(spring, y, v, turn * 1.001))
        assert np.sign(after) == -signs.pop()
    if math.isfinite(step):
        start = abs(spring.square * (y - spring.rest)) + abs(math.sqrt(spring.square) * v)
        for turns in range(3):
            at = advanced(spring, y, v, turn + turns * step)
            assert abs(accelerated(spring, *at)) < ROUNDING * start


@pytest.mark.parametrize("y", [-4e-4, 4e-4])
@pytest.mark.parametrize("name", SPRINGS)
def test_zeros_are_found_from_both_sides_of_rest(name: str, y: float) -> None:
    """Levels and drifts are chosen so that the zero is at two fifths of the bracket."""
    spring, v, share, end = SPRINGS[name], 4.0, 0.6, 5e-5
    at_y, at_v = advanced(spring, y, v, 0.4 * end)
    for drift in (0.7, -0.7):
        level = drift * 0.4 * end + share * (at_y - y)
        assert _zero(spring, y, v, drift, share, level, 0.0, end, 0) == pytest.approx(0.4 * end, rel=1e-9)
    if abs(accelerated(spring, y, v)) > 1:
        assert _zero(spring, y, v, -share * at_v, share, 0.0, 0.0, end, 1) == pytest.approx(0.4 * end, rel=1e-9)


# ---------------------------------------------------------------------- contact and loss of it


@pytest.mark.parametrize("x", BOUNCES)
def test_bounce_period(x: float) -> None:
    period = 2 * x + 2 * math.pi - 2 * math.atan(x)
    assert period == pytest.approx(BOUNCES[x], rel=PERIOD)
    motion = PairMotion(1.0, 0.0, 1.0, 4e9, math.inf, _NEVER, _NEVER)
    y, v, outcome = ran(motion, 0.0, (0.0, 0.0, x), period / 64, 64 * 100 + 1)
    np.testing.assert_allclose(y[::64], 0, atol=PERIOD * x * 100)
    np.testing.assert_allclose(v[::64], x, rtol=PERIOD * 100)
    assert abs(y[64]) < PERIOD * x and abs(v[64] - x) < PERIOD * x
    assert outcome.events == 200
    assert outcome.free == pytest.approx(100 * 2 * x, rel=PERIOD)


def test_backlash_lets_the_back_flanks_touch() -> None:
    """y'' = 1 between y = 0 and -j, springs beyond: potential energy gives the turning points, and it goes on for ever."""
    motion, x, j = PairMotion(1.0, 0.0, 1.0, 4e9, 0.5, _NEVER, _NEVER), 3.0, 0.5
    y, v, outcome = ran(motion, 0.0, (0.0, 0.0, x), 1e-3, 200_000)
    energy = v**2 / 2 - y + np.where(y > 0, y**2, np.where(y < -j, (y + j) ** 2, 0)) / 2
    np.testing.assert_allclose(energy, x**2 / 2, rtol=1e-10)
    # (y + j)²/2 - y = x²/2 below, y²/2 - y = x²/2 above
    assert y.max() == pytest.approx(1 + math.sqrt(1 + x**2), abs=1e-6)
    assert y.min() == pytest.approx(1 - j - math.sqrt((1 - j) ** 2 + x**2 - j**2), abs=1e-6)
    crossings = sum(np.count_nonzero(np.diff(np.sign(y[1:] + level))) for level in (0.0, j))
    assert outcome.events == crossings > 50


# ---------------------------------------------------------------------- pairs of teeth


@pytest.mark.parametrize(("drift", "start"), [(9.8, (0.0, 0.0, 0.0)), (1.6, (1e-3, 1e-3, 2.0)), (32.7, (0.0, 2e-3, 0.0))])
def test_the_step_between_samples_changes_nothing(drift: float, start: tuple[float, float, float]) -> None:
    """Also events that come in pairs within one step: the exact solution has no step."""
    fine, _, of_fine = ran(THESIS, drift, start, 1 / 400_000, 20_000)
    coarse, _, of_coarse = ran(THESIS, drift, start, 1 / 1_000, 50)
    scale = 10**6 if drift == 1.6 else 1  # contact is lost there, and digits with it
    np.testing.assert_allclose(coarse, fine[::400], rtol=0, atol=scale * ROUNDING * np.ptp(fine))
    assert of_fine.events == of_coarse.events > 80


def test_each_base_pitch_brings_one_pair_and_takes_one() -> None:
    """Where y is far too small to move a place of contact: its share of the travel only shifts the times."""
    drift, pitch = 30.0, THESIS.pitch
    _, _, outcome = ran(THESIS, drift, (0.0, 1.0e-3, 0.0), 1e-4, 2000)
    assert outcome.events == pytest.approx(2 * drift * 0.2 / pitch, abs=2)


@pytest.mark.parametrize("drift", [1.6, 9.8])
def test_growth_is_that_of_a_small_disturbance(drift: float) -> None:
    """Two motions from starts a little apart, through pairs coming and going, and contact lost and found."""
    samples, step, small = 400, 1 / 20_000, 1.6e-10
    _, _, outcome = ran(THESIS, drift, (1e-3, 1e-3, 2.0), step, samples)
    above, below = (ran(THESIS, drift, (1e-3, 1e-3 + change, 2.0), step, samples + 1) for change in (small, -small))
    frequency = math.sqrt(THESIS.pair_square)
    apart = math.hypot(frequency * (above[0] - below[0])[-1], (above[1] - below[1])[-1]) / (frequency * 2 * small)
    assert outcome.events > 20
    assert math.exp(outcome.growth * samples * step) == pytest.approx(apart, rel=DISTURBANCE)


def test_a_pair_at_rest_stands_on_the_end_of_the_zone() -> None:
    """One pair gives way until a second enters, and two push it out again: there is no rest but on the end of the zone."""
    share, zone = 0.594, THESIS.front
    static = THESIS.push / THESIS.pair_square
    travel = zone.first - 0.75 * share * static  # of tooth 0: one pair carries until y = 0.75 of the static approach
    y, v, outcome = ran(THESIS._replace(half=600.0), 0.0, (travel, 0.7 * static, 0.0), 1e-5, 50_000)
    assert np.isfinite(y).all()
    assert y[-1] == pytest.approx(0.75 * static, rel=1e-8)
    assert abs(v[-1]) == 0 and outcome.held > 0.1


def test_code_that_cannot_be_kept_on_disk_is_compiled_all_the_same() -> None:
    """numba finds no folder for a function without a file, nor for one whose folder and home cannot be written."""
    made: dict[str, object] = {}
    exec(compile("def twice(x):\n    return 2 * x\n", "<no file>", "exec"), made)
    twice = compiled(made["twice"])
    assert twice(3.5) == 7 and twice.signatures


def test_runs_are_the_same_to_the_last_bit() -> None:
    first, second = (ran(THESIS, 1.6, (0.0, 0.0, 0.0), 5e-6, 100_000)[0] for _ in range(2))
    assert np.array_equal(first, second)
