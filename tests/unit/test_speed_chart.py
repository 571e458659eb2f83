"""Charts over speed: every maximum between the speeds asked for, as many harmonics as are needed, motions where flanks part."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.responses import cosine, isolated, oscillator, preloaded, two_stages
from support.specs import TEMPLATES
from support.transient import integrate

from gearcad.core.errors import GeometryError
from gearcad.designs import read_spec
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.response.branch_continuation import trace
from gearcad.dynamics.response.harmonic_balance import solve_all
from gearcad.dynamics.response.kv_chart import KvChart, kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.response.run_up import TimeRuns, _start
from gearcad.dynamics.response.speed_charts import OverSpeed, over_speed
from gearcad.dynamics.response.speed_curves import LEFT_OUT, SpeedCurves
from gearcad.dynamics.train_study import study_modes, study_train
from gearcad.dynamics.trains.mesh_excitation import CurveStiffness, Excitation, MeshExcitation, square_stiffness
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.tooth_deviations import PeriodicLine, TransmissionError
from gearcad.dynamics.trains.train import Train

SAME_MOTION = 0.01
"""Two ways to integrate a motion, by steps of a hundredth of a vibration and by events."""
MAXIMUM = 0.01
"""What a maximum may be short of the true one."""


def starter(name: str, model: str | None = None, damping_ratio: float | None = None) -> Train:
    train = read_spec(TEMPLATES / f"{name}.toml").train
    if damping_ratio is not None:
        train = replace(train, shafts=[replace(shaft, damping_ratio=damping_ratio) for shaft in train.shafts])
    return train if model is None else replace(train, model=model)


# ---------------------------------------------------------------------- maxima between the speeds


@pytest.mark.parametrize(
    ("train", "shaft", "near", "known"),
    [
        (starter("train-2-stage"), "output", 222.96, 6.436),
        (starter("train-1-stage", damping_ratio=0.002), None, 870.6, 3.608),
        (starter("train-1-stage", "massless", 0.002), None, 891.6, 3.905),
    ],
    ids=["shaft of two stages", "shaft of little damping", "spring of little damping"],
)
def test_narrow_resonances_between_the_speeds(train: Train, shaft: str | None, near: float, known: float) -> None:
    """Against speeds a few hundred times as close, by the harmonic balance that writes all its equations down."""
    study = study_train(train, DynamicsOptions(speeds=90, speed_from=100.0, speed_to=9000.0))
    fine = np.linspace(0.995, 1.005, 401) * near * math.pi * train.meshes[0].teeth / 30
    brute = kv_chart(periodic_response(study.system, study.excitation, fine, harmonics=10, stability=False))
    both = (study.up, brute)
    found, true = (
        chart.factors if shaft is None else chart.shaft_factors[:, [chart.shaft_names.index(shaft)]] for chart in both
    )
    here = np.abs(study.speeds / near - 1) < 0.02
    assert true.max() == pytest.approx(known, rel=5e-3)
    assert found[here].max() == pytest.approx(true.max(), rel=MAXIMUM)


def random_system(seed: int) -> tuple[System, Excitation]:
    """A mesh between lines of some modes, damped by 0.1 to 5 per cent, its stiffness cosine or square."""
    generator = np.random.default_rng(seed)
    frequencies = np.sort(generator.uniform(500, 40000, generator.integers(1, 6)))
    shape = generator.uniform(0.02, 0.6, len(frequencies))
    of = preloaded([0.0, *frequencies], [0.5, *shape], float(10 ** generator.uniform(-3, -1.3)))
    if seed % 2:
        return of, cosine(float(generator.uniform(0.05, 0.3)))
    return of, Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(float(generator.uniform(1.2, 1.9)))),))


@pytest.mark.parametrize("seed", [3, 4, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(10, 50))])
def test_no_maximum_of_random_systems_is_missed(seed: int) -> None:
    """Every maximum of K_v that stands out by a fiftieth, over speeds that are six a half width of the sharpest."""
    of, excitation = random_system(seed)
    low, high = 4000.0, 30000.0 if seed > 9 else 9000.0
    chart = over_speed(of, excitation, np.linspace(low, high, 60)).up
    fine = np.geomspace(low, high, round(math.log(high / low) / 1.5e-4) if seed > 9 else 4000)
    brute = kv_chart(periodic_response(of, excitation, fine, harmonics=12, stability=False))
    from scipy.signal import find_peaks

    values = brute.factors[:, 0]
    for place in find_peaks(values, prominence=0.02 * values.max())[0]:
        near = np.abs(chart.frequencies / fine[place] - 1) < 0.01
        after = np.searchsorted(chart.frequencies, fine[place])
        near[after - 1 : after + 1] = True
        assert chart.factors[near].max() > (1 - MAXIMUM) * values[place], fine[place]


def test_speeds_asked_for_are_in_the_chart() -> None:
    speeds = np.linspace(9000.0, 11000.0, 30)
    chart = over_speed(two_stages(), Excitation(meshes=cosine(0.2).meshes * 2), speeds).up
    assert np.isin(speeds, chart.frequencies).all() and (np.diff(chart.frequencies) > 0).all()


# ---------------------------------------------------------------------- number of harmonics


def square_by_exponentials(damping_ratio: float, ratio: float, frequency: float) -> float:
    """K_v of an oscillator whose stiffness is a square wave: each stretch in closed form, periodic by a linear equation."""
    from scipy.linalg import expm

    shape, steps = square_stiffness(ratio), 4000
    stretches = [(shape.values(0.1).item(), ratio - 1), (shape.values(6.2).item(), 2 - ratio)]
    maps = []
    for stiffness, share in stretches:
        still = np.array([1 / stiffness, 0.0])
        generator = np.array([[0, 1], [-stiffness, -2 * damping_ratio]])
        maps.append((stiffness, still, expm(generator * share * 2 * np.pi / frequency / steps)))
    (_, rest_1, step_1), (_, rest_2, step_2) = maps
    first, second = (np.linalg.matrix_power(step, steps) for step in (step_1, step_2))
    # x -> rest_2 + second (rest_1 + first (x - rest_1) - rest_2) is x again.
    constant = rest_2 + second @ (rest_1 - first @ rest_1 - rest_2)
    state, greatest = np.linalg.solve(np.eye(2) - second @ first, constant), 0.0
    for stiffness, rest, step in maps:
        for _ in range(steps + 1):
            greatest, last = max(greatest, stiffness * state[0]), state
            state = rest + step @ (state - rest)
        state = last
    return greatest


@pytest.mark.parametrize("damping_ratio", [0.07, 0.01])
def test_as_many_harmonics_as_a_hundredth_asks_for(damping_ratio: float) -> None:
    """Steps of stiffness: from above the resonance down to where a hundred vibrations fit between two teeth."""
    excitation = Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(1.6)),))
    speeds = np.array([0.0101, 0.043, 0.11, 0.37, 0.93, 1.31])
    told, _ = SpeedCurves(oscillator(damping_ratio), excitation).told(speeds)
    true = [square_by_exponentials(damping_ratio, 1.6, float(nu)) for nu in speeds]
    assert told.most[:, 0] == pytest.approx(true, rel=0.005)
    assert told.left_out.max() < LEFT_OUT


def stepped(height: float) -> Excitation:
    """Stiffness and error of contact by FE: both rise within a sixtieth of a tooth, and take each other off at rest."""
    corners = 2 * np.pi * np.array([0, 0.3, 0.3 + 1 / 60, 0.7, 0.7 + 1 / 60, 1.0])
    shape = CurveStiffness(phase=corners, stiffness=np.array([1, 1, 1 + height, 1 + height, 1, 1]))
    smooth = 1 - 0.1 * np.cos(corners)
    error = TransmissionError(line=PeriodicLine(phase=corners, height=1e6 * (smooth - 1 / shape.stiffness)))
    return Excitation(meshes=(MeshExcitation(stiffness=shape, error=error),))


def test_towards_standstill_loads_are_those_at_rest() -> None:
    found = over_speed(oscillator(0.07), stepped(0.4), np.geomspace(1e-3, 0.1, 9))
    # What a thousand vibrations between two teeth still leave of one.
    assert found.up.factors[0, 0] == pytest.approx(1, abs=2e-3) and found.up.least[0, 0] == pytest.approx(1, abs=2e-3)
    assert not found.notices


def test_steps_of_stiffness_are_told_to_load_teeth_at_standstill() -> None:
    """Without errors that take them off, forces rise with the stiffness: by 2 over 1 pairs of teeth."""
    excitation = Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(1.6)),))
    found = over_speed(oscillator(0.07), excitation, np.array([0.002, 0.003]))
    assert found.up.factors[0, 0] == pytest.approx(2, rel=0.005)
    assert "towards standstill K_v tends to 2.000, not to 1" in str(found.notices[0])


def test_too_few_harmonics_are_told() -> None:
    excitation = Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(1.6)),))
    found = over_speed(oscillator(0.05), excitation, np.array([0.1, 1.5]), harmonics=3)
    assert "more than 3 harmonics of the tooth frequency would be needed at tooth frequencies (1/s) 0.1" in found.up.warnings[0]


def test_a_period_of_many_teeth_is_told() -> None:
    from fractions import Fraction

    meshes = (cosine(0.2).meshes[0], replace(cosine(0.2).meshes[0], frequency_ratio=Fraction(997, 1009)))
    found = over_speed(two_stages(), Excitation(meshes=meshes), np.array([3000.0, 5000.0]))
    assert "the teeth of all meshes come again after 1009 teeth only: K_v holds 6 harmonics" in str(found.notices[0])


# ---------------------------------------------------------------------- where flanks part


@pytest.fixture(scope="module")
def parting() -> OverSpeed:
    """The jump of the reference tests, over a few speeds."""
    return over_speed(oscillator(0.05), cosine(0.2, phase=180.0, backlash=math.inf), np.linspace(0.5, 1.4, 13))


def test_both_directions_show_their_maximum(parting: OverSpeed) -> None:
    """At 13 speeds what a branch of 24 harmonics at 2,000 speeds shows; the jumps lie at its folds."""
    branch = trace(oscillator(0.05), cosine(0.2, phase=180.0, backlash=math.inf), np.linspace(0.82, 0.93, 500), harmonics=24)
    assert parting.down is not None
    for chart, jumps, fold, direction in zip(
        (parting.up, parting.down), parting.jumps, branch.folds[::-1], ("up", "down"), strict=True
    ):
        true = kv_chart(branch.sweep(direction)).factors.max()  # type: ignore[arg-type]
        assert (1 - MAXIMUM) * true < chart.factors.max() < 1.02 * true
        assert jumps == pytest.approx([fold], rel=1e-3)


def test_force_over_time_is_that_of_the_motion(parting: OverSpeed) -> None:
    """Against time integration from its own state: no ripples while flanks are apart, no spikes where they meet."""
    (response,) = (parting.response(0.93),)
    count, period = 2048, 2 * np.pi / 0.93
    force, approach = response.spring_forces(count=count)[0, :, 0], response.approach(count=count)[0, :, 0]
    speed = 0.93 * float((1j * response.harmonics @ response.approach_coefficients[0, :, 0]).real * 2)
    times = period * np.arange(count) / count
    found = integrate(
        response.system, response.excitation, 0.93, period, times=times, start=(approach[:1], [speed]), tolerance=1e-10
    )
    assert force == pytest.approx(found.spring_forces[:, 0], abs=5e-3)
    assert 0.1 < (force == 0).mean() < 0.5 and force.min() == 0
    damping = response.damping_forces(count=count)[0, :, 0]
    assert damping == pytest.approx(found.damping_forces[:, 0], abs=2e-3)


@pytest.mark.long
def test_few_speeds_begin_with_flanks_apart() -> None:
    """No motion below the first speed to begin with: integrated in time, as from any other first speed."""
    of, excitation = oscillator(0.02), cosine(0.3, phase=180.0, backlash=math.inf)
    charts = [over_speed(of, excitation, np.linspace(low, 1.0, count)) for low, count in ((0.9, 3), (0.5, 11))]
    values = []
    for found in charts:
        assert found.down is not None
        here = np.isclose(found.up.frequencies, 0.95) | np.isclose(found.up.frequencies, 1.0)
        values.append([found.up.factors[here, 0], found.down.factors[here, 0]])
    for other in values[1:]:
        assert np.array(other) == pytest.approx(np.array(values[0]), rel=SAME_MOTION)


@pytest.mark.long
@pytest.mark.parametrize(
    "damping_ratio", [pytest.param(0.005, marks=pytest.mark.long), 0.02, pytest.param(0.05, marks=pytest.mark.long)]
)
@pytest.mark.parametrize("backlash", [pytest.param(1e6, marks=pytest.mark.long), math.inf])
def test_loads_where_flanks_part_are_those_of_an_integration_by_events(damping_ratio: float, backlash: float) -> None:
    """A run by DOP853 from a linear motion below the resonance in even steps of speed, its steps ending where flanks part."""
    of, excitation = oscillator(damping_ratio), cosine(0.1, phase=180.0, backlash=backlash)
    found = over_speed(of, excitation, np.array([0.9, 1.0, 1.1]))
    speeds, state, true = [*np.arange(0.7, 1.0, 0.02), 1.0], None, {}
    for nu in speeds:
        periods = math.ceil(6 / damping_ratio * nu / (2 * np.pi))
        end = (periods + 2) * 2 * np.pi / nu
        times = np.linspace(periods * 2 * np.pi / nu, end, 401)
        motion = integrate(of, excitation, nu, end, times=times, start=state, tolerance=1e-7)
        state, true[round(nu, 9)] = (motion.modal[-1], motion.modal_speed[-1]), float(motion.spring_forces.max())
    for nu in (0.9, 1.0):
        value = found.up.factors[np.isclose(found.up.frequencies, nu), 0][0]
        assert np.isnan(value) or value == pytest.approx(true[nu], rel=SAME_MOTION)


@pytest.mark.long
def test_a_motion_that_does_not_repeat_is_told_with_its_greatest_load() -> None:
    """A stretch of it by DOP853 from rest."""
    of, excitation, nu = oscillator(0.05), cosine(0.7, phase=180.0, backlash=math.inf), 0.49
    found = over_speed(of, excitation, np.array([nu, 0.493]))
    assert found.up.frequencies[0] == nu and not found.up.stable[0] and not found.response(nu).stable[0]
    assert "the motion in time does not repeat at tooth frequencies (1/s) 0.49" in " ".join(found.up.warnings)
    period = 2 * np.pi / nu
    motion = integrate(of, excitation, nu, 160 * period, times=np.arange(60 * 200, 160 * 200) * period / 200, tolerance=1e-5)
    assert found.up.factors[0, 0] == pytest.approx(motion.spring_forces.max(), rel=0.005)


def test_no_loads_where_runs_in_time_would_take_too_long() -> None:
    """Hardly damped: null and the reason, not the resonance of flanks that stick."""
    found = over_speed(oscillator(2e-6), cosine(0.1, backlash=math.inf), np.linspace(0.5, 1.4, 7))
    known = found.up.known
    assert not known.all() and found.up.factors[known].max() < 3
    (text,) = (notice.text for notice in found.notices if notice.code == "no-value")
    assert text.endswith('[dynamics.transient] or campbell = "on", which integrate in time, give some')
    assert None in found.up.to_dict()["kv"]["mesh"]


def test_runs_begin_with_the_linear_motion() -> None:
    """Approach and its rate at phase 0, from the coefficients of the balance; orders beyond these are in the start too."""
    curves = SpeedCurves(oscillator(0.1), cosine(0.2))
    (motion,) = curves.balance(8).solve(np.array([0.7]))
    start, coefficients = _start(curves, motion), motion.approach[0, :, 0]
    twice = np.where(np.arange(len(coefficients)) == 0, 1, 2) * coefficients
    assert start.coordinates == pytest.approx([twice.real.sum()], abs=1e-5)
    assert start.rates == pytest.approx([(0.7j * np.arange(len(coefficients)) * twice).real.sum()], abs=1e-5)


def test_time_that_runs_would_take_grows_with_the_speeds_between() -> None:
    """As many speeds between the rungs as there are rungs where flanks part take as long as those."""
    runs = TimeRuns(SpeedCurves(oscillator(2e-6), cosine(0.1, backlash=math.inf)), cosine(0.1, backlash=math.inf), 1.1)
    count = int(runs.contact[1].sum())
    alone, twice = (float(runs.reason(more).split(" about ")[1].removesuffix(" s")) for more in (0, count))
    assert count > 10 and twice == pytest.approx(2 * alone, rel=1e-3)


# ---------------------------------------------------------------------- one speed, no mesh


@pytest.mark.parametrize("speed", [3001.7, 50000.0])
def test_the_course_is_at_the_speed_asked_for(speed: float) -> None:
    """Within the chart and ten times beyond its end."""
    train = replace(starter("train-2-stage"), speed=speed)
    study = study_train(train, DynamicsOptions(speeds=20, speed_to=5000.0))
    assert study.course.speed == pytest.approx(speed, rel=1e-12)
    frequency = speed * math.pi * 32 / 30
    linear = kv_chart(periodic_response(study.system, study.excitation, [frequency], harmonics=20))
    assert study.course.kv == pytest.approx(linear.factors[0], rel=1e-3)
    assert (speed in study.speeds.round(9)) == (speed < 5000)


def test_a_train_without_teeth_has_modes() -> None:
    whole = starter("train-2-stage")
    train = replace(whole, meshes=(), shafts=whole.shafts[1:2], inertias=whole.inertias[1:3], torques={})
    modes = study_modes(train).modes
    assert modes.circular == pytest.approx([0, math.sqrt(1e7 * 2 / 0.0446)], abs=1e-3)
    with pytest.raises(GeometryError, match="without teeth nothing excites a train"):
        study_train(train)


def test_products_alone_solve_equations() -> None:
    generator = np.random.default_rng(0)
    matrices = np.eye(30) + 0.1 * generator.normal(size=(7, 30, 30))
    matrices[3], right = 2 * np.eye(30), generator.normal(size=(7, 30))
    right[5] = 0
    found, left = solve_all(lambda x: (matrices @ x[:, :, None])[:, :, 0], right, 1e-10, 100)
    assert found == pytest.approx(np.linalg.solve(matrices, right[:, :, None])[:, :, 0], abs=1e-10) and left.max() < 1e-10
    assert solve_all(lambda x: (matrices @ x[:, :, None])[:, :, 0], right, 1e-10, 5)[1].max() > 1e-3


def test_an_isolated_pair_keeps_its_chart() -> None:
    """The paper's K_v, by both ways to solve the balance."""
    speeds = np.linspace(2000, 30000, 15)
    chart: KvChart = over_speed(isolated(), cosine(0.206), speeds).up
    dense = kv_chart(periodic_response(isolated(), cosine(0.206), speeds, harmonics=12))
    assert chart.factors[np.isin(chart.frequencies, speeds)] == pytest.approx(dense.factors, rel=1e-4)
