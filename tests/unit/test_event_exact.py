"""Pairs integrated from event to event, and trains without damping, against closed forms and SciPy."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from support.commands import invoke, read_json
from support.trains import torqued_pair

from gearcad.core.errors import ParameterError, SolverError
from gearcad.core.records import Floats
from gearcad.core.runtime import compiled
from gearcad.dynamics.options import DynamicsOptions
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
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.dynamics.train_study import study_train, study_undamped
from gearcad.dynamics.trains.steady_response import UndampedError
from gearcad.dynamics.trains.train import Train

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


STARTER = (Path(__file__).parents[2] / "templates" / "train-1-stage.toml").read_text(encoding="utf-8")

UNDAMPED = STARTER.replace("damping_ratio = 0.05", "damping_ratio = 0").replace("damping = 14660.0", "damping = 0")

RUN = "[dynamics.transient]\nspeed_from = 2000\nspeed_to = 2600\nduration = 0.02\n"

STIFFNESS, FORCE, RATIO = 3e8, 5000.0, 20
"""N/m, N at rest, and teeth of the pinion."""

MASS = 1 / (0.04**2 / 0.004 + 0.08**2 / 0.03)
"""Of both gears on the line of action, in kg."""

STEPS = 2e-3
"""Relative error of forces by 80 steps a vibration or more."""

PHASE = 0.01
"""Of the swing: what phases of 6 or 22 vibrations are late by so many steps comes to 0.0043."""


def pair(**more: object) -> Train:
    """A pair without damping; its mesh is as stiff everywhere unless `more` says otherwise."""
    return torqued_pair(RATIO, **{"stiffness": STIFFNESS / 1e6, "variation": 0.0, "damping": 0.0, **more})


def test_a_torque_step_swings_for_ever_as_an_undamped_oscillator() -> None:
    """Force 1.5 - cos(omega t) of that at rest after a step from 0.5 to 1.5, from crest to crest."""
    omega = math.sqrt(STIFFNESS / MASS)
    lasts = 60 / omega
    step = TransientOptions(duration=lasts, torque_from=0.5, torque_to=1.5, torque_at=lasts / 3, sampling=20 * omega)
    found = study_undamped(pair(), DynamicsOptions(transient=step))
    assert found.modes.circular[-1] == pytest.approx(omega, rel=1e-9)
    run = found.transient
    assert run is not None
    later = run.time > lasts / 3
    expected = np.where(later, 1.5 - np.cos(omega * (run.time - lasts / 3)), 0.5)
    np.testing.assert_allclose(run.force[:, 0] / FORCE, expected, atol=PHASE)
    assert run.greatest[0].factor == pytest.approx(2.5, rel=STEPS)
    assert {each.code for each in found.notices} == {"no-damping", "not-settled"}


def test_a_mesh_of_varying_stiffness_moves_as_scipy_integrates_it() -> None:
    """k (1 - 0.2 cos(tooth phase)), from the state that the run begins with."""
    omega, lasts = math.sqrt(STIFFNESS / MASS), 0.01
    tooth = 2 * math.pi * 3000 / 60 * RATIO
    options = TransientOptions(duration=lasts, sampling=20 * omega)
    run = study_undamped(pair(variation=0.2), DynamicsOptions(transient=options)).transient
    assert run is not None

    def rates(t: float, x: NDArray[np.float64]) -> list[float]:
        return [x[1], (FORCE - STIFFNESS * (1 - 0.2 * math.cos(tooth * t)) * x[0]) / MASS]

    approach = 1e-6 * run.approach[:, 0]
    rate = float(np.gradient(approach[:7], float(run.time[1]), edge_order=2)[0])
    expected = solve_ivp(
        rates, (0, lasts), [approach[0], rate], "DOP853", t_eval=run.time[run.time <= lasts], rtol=1e-9, atol=1e-15
    ).y[0]
    swing = np.ptp(expected)
    assert swing > 0.2 * FORCE / STIFFNESS
    np.testing.assert_allclose(approach[: len(expected)], expected, atol=PHASE * swing, rtol=0)


def test_only_what_is_shaken_needs_damping() -> None:
    assert study_train(pair(), DynamicsOptions(speeds=5)).up.factors == pytest.approx(1.0)
    for speeds in (5, 200):  # whether a speed of the chart meets a resonance or not
        with pytest.raises(UndampedError, match=r"mesh\.damping = 0 N·s/m: must be above 0"):
            study_train(pair(variation=0.2), DynamicsOptions(speeds=speeds, speed_to=1000.0))


def test_flanks_that_pull_are_told() -> None:
    step = TransientOptions(duration=0.01, torque_from=1.0, torque_to=0.2)
    bonded, parting = (study_undamped(pair(backlash=each), DynamicsOptions(transient=step)).notices for each in (None, 100.0))
    assert "flanks-would-part" in [each.code for each in bonded]
    assert "flanks-would-part" not in [each.code for each in parting]


def test_a_run_that_grows_beyond_all_numbers_says_what_bounds_it() -> None:
    """Twice the natural frequency: parametric resonance of flanks that stick, about exp(0.05 omega t)."""
    twice = 2 * math.sqrt(STIFFNESS / MASS) * 60 / (2 * math.pi * RATIO)
    step = TransientOptions(duration=1.2, speed_from=twice, torque_from=0.5, torque_to=1.0, torque_at=0.0)
    with pytest.raises(SolverError, match=r"grows without bound before .* s: more damping limits it, or a backlash"):
        study_undamped(pair(variation=0.2), DynamicsOptions(transient=step))


def test_a_run_needs_a_speed() -> None:
    train = replace(pair(), speed=0.0)
    with pytest.raises(ParameterError, match=r"dynamics\.transient\.speed_from is missing: must be given, or train\.speed"):
        study_undamped(train, DynamicsOptions(transient=TransientOptions()))
    assert study_undamped(train).transient is None


# ---------------------------------------------------------------------- as a user meets it


def _run(tmp_path: Path, text: str, *more: str) -> tuple[int, str, dict[str, object]]:
    (tmp_path / "it.toml").write_text(text, encoding="utf-8")
    result = invoke("dynamics", str(tmp_path / "it.toml"), "-o", str(tmp_path / "out"), *more)
    written = tmp_path / "out" / "dynamics.json"
    return result.exit_code, result.output, read_json(written) if written.exists() else {}


def test_modes_are_written_and_the_run_in_time_is_offered(tmp_path: Path) -> None:
    status, words, document = _run(tmp_path, UNDAMPED)
    assert status == 0
    assert "loads over speed are left out: without damping" in words and "or [dynamics.transient] for a run in time" in words
    assert "chart" not in document and "transient" not in document
    assert document["modes"]["frequency"][1] == pytest.approx(2029.56, rel=1e-5)  # type: ignore[index]
    page = (tmp_path / "out" / "dynamics.html").read_text(encoding="utf-8")
    assert "1 mesh</p>" in page and "no mesh" not in page


def test_the_run_in_time_is_written(tmp_path: Path) -> None:
    status, words, document = _run(tmp_path, UNDAMPED + RUN)
    assert status == 0 and "greatest force of mesh:" in words and "[dynamics.transient] for a run" not in words
    transient = document["transient"]
    factor = transient["greatest"][0]["factor"]  # type: ignore[index]
    # The input shaft carries 0.16 N·m at rest, hundreds in the run: no torque is referred to that.
    assert [each["name"] for each in transient["greatest_of_shafts"]] == ["output"]  # type: ignore[index]
    with np.load(tmp_path / "out" / "dynamics.npz", allow_pickle=False) as arrays:
        assert arrays["transient_factor"].max() == factor > 1
    assert (tmp_path / "out" / "dynamics-transient.csv").exists()
    page = (tmp_path / "out" / "dynamics.html").read_text(encoding="utf-8")
    assert ">Run in time</h2>" in page and "the forces depend on how the run begins" in page


@pytest.mark.parametrize(
    ("text", "more"),
    [
        (UNDAMPED.replace('model = "modes"', 'model = ["massless", "modes"]'), ()),
        (UNDAMPED, ("--vary", "shaft.*.damping_ratio=0,0.05")),
    ],
)
def test_nothing_is_laid_over_loads_that_there_are_not(tmp_path: Path, text: str, more: tuple[str, ...]) -> None:
    status, words, _ = _run(tmp_path, text, *more)
    assert status == 1 and "with [dynamics.transient], a run in time" in words
