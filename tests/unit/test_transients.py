"""Runs with changing speed and torque: against closed forms, an integration by scipy, the charts; and what cannot be run."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.trains import torqued_pair

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.time_domain.transient import run_transient
from gearcad.dynamics.time_domain.transient_result import Transient, TransientOptions
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, Shaft
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.steady_response import Direction
from gearcad.dynamics.trains.tooth_deviations import TransmissionError
from gearcad.dynamics.trains.train import Train

STEPS = 2e-3
"""Relative error of forces by 80 steps a vibration."""

JUMP = 0.02
"""Of the speed at which vibration jumps: a run needs some tooth periods to notice that its motion has ended."""


def pair(**more: object) -> Train:
    return torqued_pair(20, **{"stiffness": 300.0, "variation": 0.0, "damping_ratio": 0.05, **more})


def resonance(train: Train) -> float:
    """Natural frequency with the mesh at its mean (1/s)."""
    return math.sqrt(float(np.linalg.eigvalsh(system(train).stiffness_matrix())[-1]))


def run(train: Train, options: TransientOptions, mesh: MeshExcitation | None = None) -> Transient:
    given = mesh or MeshExcitation(stiffness=CosineStiffness(variation=0.0))
    return run_transient(train, system(train), Excitation(meshes=(given,)), options, otherwise=train.speed)


# ---------------------------------------------------------------------- closed forms


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.4])
def test_a_torque_step_overshoots_as_a_damped_oscillator(ratio: float) -> None:
    """1 + exp(-pi zeta/sqrt(1 - zeta²)) of the change, half a vibration behind it; the force of the springs."""
    train = pair(damping_ratio=ratio)
    omega = resonance(train)
    lasts = 60 / omega
    found = run(train, TransientOptions(duration=lasts, torque_from=0.5, torque_to=1.5, torque_at=lasts / 3, speed_from=0.0))
    crest = 0.5 + 1 + math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
    (greatest,) = found.greatest
    assert greatest.factor == pytest.approx(crest, rel=STEPS)
    later = math.pi / (omega * math.sqrt(1 - ratio**2))
    assert greatest.time == pytest.approx(lasts / 3 + later, abs=lasts / 100)
    before = found.time < 0.99 * lasts / 3
    np.testing.assert_allclose(found.force[before] / found.static_forces, 0.5, rtol=1e-9)


def test_a_slow_ramp_of_the_torque_is_followed_and_none_of_it_rattles() -> None:
    train = pair(backlash=50.0)
    slow = TransientOptions(duration=0.4, torque_from=1.0, torque_to=3.0, torque_at=0.1, torque_over=0.2, speed_from=0.0)
    found = run(train, slow, MeshExcitation(stiffness=CosineStiffness(variation=0.0), backlash=50.0))
    np.testing.assert_allclose(found.force[:, 0] / found.static_forces[0], found.torque, atol=0.01)
    assert found.partings == ()


def test_a_rising_speed_asks_for_the_torque_of_the_driven_inertia() -> None:
    """J_2 alpha_2 / r_b2 more in the mesh, and none of it on the side that drives."""
    train = pair()
    found = run(train, TransientOptions(speed_from=0.0, speed_to=6000.0, duration=0.05))
    alpha = 6000 * math.pi / 30 / 0.05
    expected = 400 / 0.08 + 0.03 * alpha * 40 / 80 / 0.08
    np.testing.assert_allclose(found.force[len(found.time) // 2 :, 0], expected, rtol=1e-3)
    assert found.notices == ()
    slowed = run(train, TransientOptions(speed_from=6000.0, speed_to=0.0, duration=0.05))
    assert float(slowed.force[-1, 0]) == pytest.approx(2 * 5000 - expected, rel=1e-3)


def test_what_two_torques_drive_is_not_sped_up() -> None:
    motor, shaft = Inertia(name="motor", inertia=0.1), Shaft(name="input", start="motor", end="pinion", torsional_stiffness=1e5)
    torques = {"pinion": 100.0, "motor": 100.0, "wheel": 400.0}
    train = replace(pair(), inertias=(*pair().inertias, motor), shafts=(shaft,), torques=torques)
    notices = run(train, TransientOptions(speed_from=10.0, speed_to=600.0, duration=0.01)).notices
    assert "2 torques drive it" in next(each.text for each in notices if each.code == "no-acceleration-torque")


# ---------------------------------------------------------------------- a sweep through the resonance


def test_a_sweep_passes_the_resonance_behind_its_place_and_below_its_height() -> None:
    """A linear oscillator, shaken by an error of one wave a tooth whose speed rises: as scipy integrates it."""
    train = pair(damping_ratio=0.03)
    of = system(train)
    omega, error = resonance(train), TransmissionError(coefficients=np.array([0, 0.5 + 0j]))
    mesh = MeshExcitation(stiffness=CosineStiffness(variation=0.0), error=error)
    centre, lasts = omega * 60 / (2 * np.pi * 20), 300 / omega
    options = TransientOptions(speed_from=0.6 * centre, speed_to=1.6 * centre, duration=lasts, sampling=10 * omega)
    found = run(train, options, mesh)
    mass = 1 / float((of.mesh**2).sum())
    low, high, damping, k = 0.6 * omega, 1.6 * omega, float(of.mesh_damping[0]), float(of.stiffness[0])
    pinion, wheel = 0.004 / 0.04**2, 0.03 / 0.08**2
    alpha = (options.speeds(0)[1] - options.speeds(0)[0]) * math.pi / 30 / lasts
    assert mass == pytest.approx(pinion * wheel / (pinion + wheel))
    force = 5000.0 + wheel * alpha * 0.04  # the wheel is sped up through the mesh

    def rates(t: float, x: Floats) -> list[float]:
        phase, rate = low * t + (high - low) * t * t / (2 * lasts), low + (high - low) * t / lasts
        e, slope = 1e-6 * math.cos(phase), -1e-6 * math.sin(phase) * rate
        return [x[1], (force - k * (x[0] - e) - damping * (x[1] - slope)) / mass]

    begin = np.array([found.approach[0, 0] * 1e-6, 0.0])
    # The rate at the beginning is that of the settled motion, as the first samples have it.
    begin[1] = float(np.gradient(1e-6 * found.approach[:5, 0], float(found.time[1]), edge_order=2)[0])
    times = found.time[found.time <= lasts]
    expected = 1e6 * solve_ivp(rates, (0, lasts), begin, "DOP853", t_eval=times, rtol=1e-9, atol=1e-14).y[0]
    swings = np.abs(expected - 1e6 * force / k)
    np.testing.assert_allclose(found.approach[: len(times), 0], expected, atol=0.02 * swings.max(), rtol=0)
    later = times > 0.25 * lasts  # what the beginning of the acceleration pushed has died away
    assert found.speed[: len(times)][later][swings[later].argmax()] > 1.02 * centre
    assert swings[later].max() < 0.9 * math.hypot(1, 2 * 0.03) / (2 * 0.03)


# ---------------------------------------------------------------------- flanks that part: the charts run through


@pytest.mark.long
def test_slow_runs_up_and_down_jump_where_the_charts_do() -> None:
    train = pair(variation=0.25, damping_ratio=0.04, backlash=100.0)
    centre = resonance(train) * 60 / (2 * np.pi * 20)
    for direction, ends in ((Direction.UP, (0.6, 1.3)), (Direction.DOWN, (1.3, 0.6))):
        speeds = {"speed_from": ends[0] * centre, "speed_to": ends[1] * centre}
        options = DynamicsOptions(
            speed_from=0.55 * centre, speed_to=1.35 * centre, speeds=200, transient=TransientOptions(duration=1.5, **speeds)
        )
        study = study_train(train, options)
        assert study.transient is not None and study.down is not None
        (jump,) = study.jump_speeds[direction]
        factor, at = study.transient.factor[:, 0], study.transient.window_speed
        chart = study.up if direction is Direction.UP else study.down
        faster = 0.7 * centre * math.pi / 30 / 1.5 * (1 if direction is Direction.UP else -1)
        # More load by what the wheel needs to follow.
        expected = np.interp(at, study.speeds, chart.factors[:, 0]) * (1 + 0.03 * faster / 2 / 0.08 / 5000)
        far = np.abs(at / jump - 1) > JUMP
        assert np.median(np.abs(factor - expected)[far] / expected[far]) < 5e-3
        assert np.quantile(np.abs(factor - expected)[far] / expected[far], 0.98) < 0.03
        assert study.lasting(0) == pytest.approx(
            float(chart.factors[(study.speeds > at.min()) & (study.speeds < at.max()), 0].max())
        )


def test_what_lasts_has_the_torques_of_the_run_where_forces_follow_them() -> None:
    bonded = pair(variation=0.2, damping_ratio=0.04)
    centre = resonance(bonded) * 60 / (2 * np.pi * 20)
    step = TransientOptions(speed_from=0.7 * centre, speed_to=0.8 * centre, duration=0.4, torque_to=2.0)
    options = DynamicsOptions(speed_from=0.6 * centre, speed_to=1.2 * centre, speeds=100, transient=step)
    study = study_train(bonded, options)
    assert study.transient is not None
    # The second half, after the step has died away: the run itself says what lasts.
    late = study.transient.middles > 0.3
    np.testing.assert_allclose(study.lasting_course(study.up, 0)[late], study.transient.factor[late, 0], rtol=0.01)
    assert study.lasting(0) == pytest.approx(2 * np.interp(0.8 * centre, study.speeds, study.up.factors[:, 0]), rel=0.01)
    # Flanks that part at these speeds are not in proportion to their load.
    through = replace(step, speed_from=0.8 * centre, speed_to=1.1 * centre)
    parted = study_train(pair(variation=0.25, damping_ratio=0.04, backlash=100.0), replace(options, transient=through))
    assert parted.up.apart.any() and parted.transient is not None
    assert np.array_equal(np.isfinite(parted.lasting_course(parted.up, 0)), parted.transient.whole_load)
    assert parted.lasting(0) is None


# ---------------------------------------------------------------------- what cannot be run


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"duration": 0.0}, "duration"),
        ({"duration": float("nan")}, "duration"),
        ({"speed_from": 1e9}, "speed_from"),
        ({"torque_to": float("inf")}, "torque_to"),
        ({"torque_at": 0.5}, "torque_to"),
        ({"torque_to": 2.0, "torque_at": 2.0}, "torque_at = 2 s: must be at most 1 s"),
        ({"torque_to": 2.0, "torque_at": 0.9, "torque_over": 0.2}, "torque_over = 0.2 s: must be at most 0.1 s"),
        ({"torque_to": 2.0, "torque_at": -1.0}, "torque_at"),
        ({"sampling": 0.0}, "sampling"),
    ],
)
def test_bad_options_are_told_in_a_line(given: dict[str, float], words: str) -> None:
    with pytest.raises((ParameterError, GeometryError)) as told:
        TransientOptions(**given)  # type: ignore[arg-type]
    assert words in str(told.value) and "\n" not in str(told.value)


def test_what_takes_too_long_says_what_would_do() -> None:
    with pytest.raises(ParameterError, match=r"transient\.duration = 100000 s: must be at most \d+ s"):
        run(pair(), TransientOptions(duration=1e5))
    with pytest.raises(ParameterError, match=r"transient\.sampling = 1000000000 Hz: must be at most"):
        run(pair(), TransientOptions(duration=1.0, sampling=1e9))


@pytest.mark.parametrize(
    "options",
    [
        TransientOptions(speed_from=-2000.0, speed_to=2000.0, duration=0.02),
        TransientOptions(speed_from=-2000.0, speed_to=-100.0, duration=0.02),
        TransientOptions(speed_from=0.0, speed_to=0.0, duration=0.01),
        TransientOptions(duration=1e-9),
        TransientOptions(duration=0.01, sampling=1e-3),
        TransientOptions(duration=0.01, torque_to=0.0),
        TransientOptions(duration=0.01, torque_to=-1.0, torque_at=0.0),
        TransientOptions(duration=0.01, torque_from=0.0, torque_to=1.0, torque_over=0.005),
    ],
)
@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_odd_runs_have_finite_courses_of_their_whole_duration(options: TransientOptions, damping: float) -> None:
    train = pair(damping_ratio=damping, backlash=30.0)
    found = run(train, options, MeshExcitation(stiffness=CosineStiffness(variation=0.2), backlash=30.0))
    for name, array in found.arrays().items():
        assert np.isfinite(array).all(), name
    assert found.windows[0] == 0
    assert found.windows[-1] == pytest.approx(options.duration)
    assert found.time[-1] <= options.duration * (1 + 1e-9)
    assert (np.diff(found.windows) > 0).all()


def test_a_torque_that_turns_presses_the_other_flanks_by_as_much() -> None:
    train = pair(backlash=30.0)
    options = TransientOptions(duration=0.05, torque_to=-1.0, torque_at=0.01, speed_from=0.0)
    found = run(train, options, MeshExcitation(stiffness=CosineStiffness(variation=0.0), backlash=30.0))
    assert float(found.force[-1, 0]) == pytest.approx(-5000.0, rel=1e-3)
    rest = 5000 / 300.0
    assert float(found.approach[-1, 0]) == pytest.approx(-30 - rest, rel=1e-3)
    assert [each.mesh for each in found.partings][:1] == ["mesh"]
