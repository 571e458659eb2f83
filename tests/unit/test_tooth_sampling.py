"""K_v of teeth with errors in time: against equations of their own, the harmonic balance, the motion of one train by itself."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.trains import one_stage

from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.time_domain.motion import MeshLaw, MovingSystem, RunCourse, SpringTable
from gearcad.dynamics.tooth_errors.error_result import ToothLaw
from gearcad.dynamics.tooth_errors.error_sources import ErrorDraw, MeshTeeth, mesh_teeth
from gearcad.dynamics.tooth_errors.error_study import Sampling
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation, train_excitation
from gearcad.dynamics.trains.shaft_lines import System, system
from gearcad.dynamics.trains.steady_response import senses
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution
from gearcad.dynamics.trains.train import Train

Floats = np.ndarray

STEPS = 0.006
"""Of K_v: 48 steps to a tooth, or 24 to a vibration, against tolerances of 1e-8."""

PARTING = 3500.0
"""rpm at which the flanks of the small pair part."""


def quiet(_part: float) -> None:
    """Nobody asks."""


def draw(sample: int, kind: ErrorDistribution = ErrorDistribution.UNIFORM) -> ErrorDraw:
    return ErrorDraw(kind, 0, sample)


def small_pair(backlash: float | None = None, damping_ratio: float = 0.06) -> Train:
    """16 teeth on 16, so that errors come again soon; 20 kN along the line of action."""
    mesh = ToothMesh(
        name="m",
        pinion="p",
        wheel="w",
        base_radii=(40.0, 40.0),
        stiffness=300.0,
        teeth=16,
        damping_ratio=damping_ratio,
        contact_ratio=1.4,
        backlash=backlash,
    )
    inertias = (Inertia(name="p", inertia=8e-3), Inertia(name="w", inertia=1e-2))
    return Train(model="isolated", inertias=inertias, meshes=(mesh,), torques={"p": 800.0, "w": 800.0})


def sampling(train: Train, law: ToothLaw = ToothLaw.SINGLE, grade: int | None = 8, *, wheel: bool = True) -> Sampling:
    of, excitation = system(train), train_excitation(train)
    forces = np.abs(Sampling(system=of, excitation=excitation, teeth=(), law=law).forces)
    teeth = tuple(
        replace(mesh_teeth(mesh, number, float(forces[number]), grade, single=law is ToothLaw.SINGLE), wheel_drawn=wheel)
        for number, mesh in enumerate(train.meshes)
    )
    return Sampling(system=of, excitation=excitation, teeth=teeth, law=law)


def by_solve_ivp(of: Sampling, speed: float, sample: ErrorDraw) -> float:
    """K_v of the small pair over the second period of its errors: m y'' + c y' + sum K max(y - gap, 0) = F, pair by pair."""
    teeth, pinion_teeth = of.teeth[0], of.teeth[0].teeth.pinion
    spring, errors, backlash = teeth.spring, teeth.pair_errors(sample), float(of.excitation.backlashes[0])
    assert spring is not None
    mass = 1 / float(of.system.mesh[:, 0] @ of.system.mesh[:, 0])
    force, damping, frequency = float(of.forces[0]), float(of.system.mesh_damping[0]), speed * pinion_teeth / 60
    stiffness, gaps, step = spring.stiffness.tolist(), spring.gap.tolist(), spring.places[1] - spring.places[0]
    position, slope = errors.position.tolist(), errors.slope.tolist()

    def carried(turn: float, y: float) -> float:
        total = 0.0
        for tooth in range(math.ceil(turn + spring.lead - spring.last), math.floor(turn + spring.lead - spring.first) + 1):
            place = turn + spring.lead - tooth
            cell = min(int((place - spring.first) / step), len(gaps) - 2)
            part = (place - spring.first) / step - cell
            k = stiffness[cell] + part * (stiffness[cell + 1] - stiffness[cell])
            gap = gaps[cell] + part * (gaps[cell + 1] - gaps[cell])
            gap += position[tooth % teeth.period] + slope[tooth % teeth.period] * place
            total += k * max(y - gap, 0.0)
            if math.isfinite(backlash):
                total += k * min(y + backlash + gap, 0.0)
        return total

    def rates(time: float, state: Floats) -> list[float]:
        y, v = state
        return [v, (force - damping * v - carried(frequency * time, y)) / mass]

    end, begin = 2 * teeth.period / frequency, teeth.period / frequency
    rest = [force / float(of.system.stiffness[0]), 0.0]
    times = np.linspace(begin, end, 100 * teeth.period)
    # No step passes over the beginning of a contact.
    found = solve_ivp(rates, (0, end), rest, "RK45", rtol=1e-7, atol=1e-13, t_eval=times, max_step=0.1 / frequency)
    return max(carried(frequency * time, y) for time, y in zip(times.tolist(), found.y[0].tolist(), strict=True)) / force


@pytest.mark.parametrize(("speed", "backlash"), [(1500.0, None), (PARTING, None), (PARTING, 3.0), (7000.0, 300.0)])
def test_samples_are_those_of_an_integration(speed: float, backlash: float | None) -> None:
    """3 µm of backlash are less than the errors: both flanks of some teeth touch at once, and carry against each other."""
    of = sampling(small_pair(backlash))
    found = of.run(np.array([speed * 16 / 60]), [draw(4), draw(2)], quiet)
    assert found.settled.all()
    assert found.factors[0, 1, 0] == pytest.approx(by_solve_ivp(of, speed, draw(2)), rel=STEPS)


def test_flanks_part_where_that_is_looked_at() -> None:
    of = sampling(small_pair())
    greatest = float(of.run(np.array([PARTING * 16 / 60]), [draw(2)], quiet).factors.max())
    assert greatest > 2.0


# ---------------------------------------------------------------------- one train by itself, at each step


def alone(of: Sampling, speed: float, sample: ErrorDraw, periods: int) -> Floats:
    """K_v (m,) over the last of so many periods, by the motion of one system that looks each tooth up in its tables."""
    first = of.ratios[0]
    orders = [int(of.period * ratio / first) for ratio in of.ratios]
    laws = []
    for teeth, order in zip(of.teeth, orders, strict=True):
        spring, errors = teeth.spring, teeth.pair_errors(sample)
        assert spring is not None
        table = SpringTable(place=spring.places, stiffness=spring.stiffness, gap=spring.gap, opening=True)
        laws.append(
            MeshLaw(table=table, order=order, lead=spring.lead, position=errors.position, slope=errors.slope, backlash=math.inf)
        )
    moving = MovingSystem(system=of.system, laws=tuple(laws), senses=senses(of.system), driven=np.zeros(of.system.size))
    frequency = speed * of.teeth[0].teeth.pinion / 60
    steps = 4 * of.per_tooth(frequency)
    count = of.period * steps
    motion = moving.run(
        RunCourse.steady(frequency / of.period),
        1 / (frequency * steps),
        periods * count,
        ends=[(periods - 1) * count, periods * count],
    )
    return np.asarray(motion.crest[-1] / of.forces)


@pytest.mark.parametrize("speed", [3300.0, 10500.0])
def test_the_train_of_the_paper_is_that_of_its_motion_by_itself(speed: float) -> None:
    """Three modes, 18 teeth of the pinion; four times as many steps there."""
    of = sampling(one_stage("modes"), grade=9, wheel=False)
    found = of.run(np.array([speed * 18 / 60]), [draw(0)], quiet)
    assert found.factors[0, 0] == pytest.approx(alone(of, speed, draw(0), 40), rel=STEPS)


def idler() -> Train:
    """Two meshes that share a gear, which the one drives and the other holds: 12 on 18 on 24 teeth."""
    shared = {"stiffness": 250.0, "damping_ratio": 0.12, "contact_ratio": 1.5}
    return Train(
        model="isolated",
        inertias=tuple(Inertia(name=name, inertia=each) for name, each in (("a", 1e-3), ("b", 3e-3), ("c", 9e-3))),
        meshes=(
            ToothMesh(name="ab", pinion="a", wheel="b", base_radii=(30.0, 45.0), teeth=12, **shared),  # type: ignore[arg-type]
            ToothMesh(name="bc", pinion="b", wheel="c", base_radii=(45.0, 60.0), teeth=18, phase=0.3, **shared),  # type: ignore[arg-type]
        ),
        torques={"a": 300.0, "b": 0.0, "c": -600.0},
    )


def test_meshes_that_share_a_gear_shake_each_other() -> None:
    of = sampling(idler(), wheel=False)
    assert of.period == 36
    found = of.run(np.array([9000.0 * 12 / 60]), [draw(1)], quiet)
    assert found.settled.all()
    assert found.factors[0, 0] == pytest.approx(alone(of, 9000.0, draw(1), 30), rel=STEPS)


def test_meshes_of_other_tooth_frequencies_come_again_together() -> None:
    stages = replace(idler(), meshes=(idler().meshes[0], replace(idler().meshes[1], teeth=36, base_radii=(45.0, 60.0))))
    of = sampling(stages, wheel=False)
    assert of.ratios == (Fraction(1), Fraction(2))
    found = of.run(np.array([5000.0 * 12 / 60]), [draw(1)], quiet)
    assert found.settled.all()
    assert found.factors[0, 0] == pytest.approx(alone(of, 5000.0, draw(1), 30), rel=STEPS)


# ---------------------------------------------------------------------- the harmonic balance


@pytest.mark.parametrize("grade", [None, 9])
def test_smooth_errors_are_those_of_the_harmonic_balance(grade: int | None) -> None:
    """Bonded flanks; 144 orders, so that what is left out of the balance is less than the steps leave out here."""
    train, speeds = one_stage("modes"), np.array([2000.0, 6764.0, 10900.0])
    of = sampling(train, ToothLaw.SMOOTH, grade, wheel=False)
    found = of.run(speeds * 18 / 60, [draw(0)], quiet)
    balance = over_speed(of.system, train_excitation(train, grade=grade, seed=0), speeds * 18 / 60 * 2 * np.pi)
    exact = np.interp(speeds, balance.up.frequencies * 30 / (18 * np.pi), balance.up.factors[:, 0])
    assert found.factors[:, 0, 0] == pytest.approx(exact, rel=STEPS)


@pytest.mark.long
def test_smooth_flanks_that_part_are_those_of_the_harmonic_balance() -> None:
    of = system(one_stage("modes"))
    excitation = Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.7), backlash=math.inf),))
    teeth = (MeshTeeth(name="m", number=0, teeth=(18, 48), contact_ratio=1.6),)  # type: ignore[arg-type]
    speeds = np.linspace(9500.0, 11500.0, 9)
    found = Sampling(system=of, excitation=excitation, teeth=teeth, law=ToothLaw.SMOOTH).run(speeds * 18 / 60, [None], quiet)
    balance = over_speed(of, excitation, speeds * 18 / 60 * 2 * np.pi)
    assert balance.up.apart.any() and not balance.jumps[0].size
    exact = np.interp(speeds, balance.up.frequencies * 30 / (18 * np.pi), balance.up.factors[:, 0])
    assert found.factors[1:, 0, 0] == pytest.approx(exact[1:], rel=STEPS)


# ---------------------------------------------------------------------- laws


def test_a_sample_does_not_depend_on_the_others() -> None:
    of, frequencies = sampling(small_pair()), np.array([200.0, 300.0, 700.0])
    few = of.run(frequencies, [draw(0), draw(1)], quiet).factors
    many = of.run(frequencies, [None, *(draw(number) for number in range(9))], quiet).factors
    assert (many[:, 1:3] == few).all()


def test_errors_of_no_size_are_none() -> None:
    of = sampling(small_pair())
    (teeth,) = of.teeth
    assert teeth.tolerances is not None
    nothing = teeth.tolerances.map(lambda each: each._replace(single_pitch=1e-12, cumulative_pitch=1e-12, profile_slope=1e-12))
    same = replace(of, teeth=(replace(teeth, tolerances=nothing),))
    found = same.run(np.array([250.0, 600.0]), [None, draw(3)], quiet).factors
    assert found[:, 1] == pytest.approx(found[:, 0], rel=1e-9)


def test_the_coarser_the_grade_the_greater_the_overload_and_normal_errors_are_milder() -> None:
    frequencies, draws = np.array([150.0, 400.0, 600.0]), [draw(number) for number in range(40)]
    medians = [
        np.median(sampling(small_pair(), grade=grade).run(frequencies, draws, quiet).factors[:, :, 0], axis=1).mean()
        for grade in (4, 8, 11)
    ]
    assert np.diff(medians).min() > 0.02
    normal = [draw(number, ErrorDistribution.NORMAL) for number in range(40)]
    milder = sampling(small_pair(), grade=11).run(frequencies, normal, quiet).factors[:, :, 0]
    assert np.median(milder, axis=1).mean() < medians[-1] - 0.02


def test_what_does_not_settle_is_told() -> None:
    """Hardly any damping: the start is still seen, and one period is not like the next."""
    restless = sampling(small_pair(damping_ratio=1e-5))
    assert restless.hardly_damped
    assert not restless.run(np.array([260.0, 400.0, 777.0]), [draw(0)], quiet).settled.all()


def test_undamped_vibrations_never_die_away() -> None:
    of: System = sampling(small_pair()).system
    undamped = replace(sampling(small_pair()), system=replace(of, mesh_damping=np.zeros(1)))
    assert undamped.decay == 0.0 and undamped.hardly_damped
    assert np.isfinite(undamped.run(np.array([500.0]), [draw(0)], quiet).factors).all()
