"""Steps in time, each piece against something that takes none: exponentials, scipy's integration, harmonic balance, energy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from gearcad.core.errors import ParameterError, SolverError
from gearcad.core.records import Floats
from gearcad.dynamics.response.branch_continuation import trace
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.time_domain.motion import MeshLaw, MovingSystem, PiecewiseLine, RunCourse, SpringTable, Start
from gearcad.dynamics.time_domain.motion_kernel import propagators
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation, square_stiffness
from gearcad.dynamics.trains.shaft_lines import System, system
from gearcad.dynamics.trains.steady_response import Direction
from gearcad.dynamics.trains.tooth_deviations import TransmissionError
from gearcad.dynamics.trains.train import Train

EXPONENTIAL = 1e-11
"""Relative to the largest entry: scipy's own rounding of exponentials of stiff matrices."""

ORDER = 0.15
"""Of the measured order of convergence from 2."""

CHART = 1e-3
"""Of K_v by steps of 1/400 of a tooth from that of 60 harmonics."""

STEPS = 5e-3
"""The same where the stiffness jumps: harmonics overshoot there."""


def one_stage(**more: object) -> Train:
    """Near the first example of Osinski's paper, lightly damped."""
    mesh: dict[str, object] = {"stiffness": 705.0, "variation": 0.206, "damping": 2200.0, "preload": 44497.0, **more}
    return Train(
        inertias=(Inertia(name="pinion", inertia=0.0058), Inertia(name="wheel", inertia=0.2228)),
        shafts=(
            Shaft(name="input", start="ground", end="pinion", torsional_stiffness=1.1e5, damping_ratio=0.05),
            Shaft(name="output", start="wheel", end="ground", torsional_stiffness=930.0, damping_ratio=0.05),
        ),
        meshes=(ToothMesh(name="mesh", pinion="pinion", wheel="wheel", base_radii=(50.7, 135.3), teeth=18, **mesh),),  # type: ignore[arg-type]
    )


# ---------------------------------------------------------------------- one step


@pytest.mark.parametrize("h", [1e-6, 1e-3, 0.3])
@pytest.mark.parametrize(
    ("square", "damping"),
    [(0, 0), (0, 40), (0, 1e7), (1e-9, 50), (9.4e6, 0), (9.4e6, 94), (1e4, 200), (1e4, 8000), (1.0, 2.0001), (1e12, 3e3)],
)
def test_a_step_of_a_mode_is_the_exponential(square: float, damping: float, h: float) -> None:
    """Coordinate, rate times the step, force times its square, and the force's change over the step."""
    rate, pull = damping * h, square * h * h
    if max(rate, pull) > 3e6:  # scipy's exponential has no digits left: the next test is of such steps
        return
    whole = expm(np.array([[0, 1, 0, 0], [-pull, -rate, 1, 0], [0, 0, 0, 1], [0, 0, 0, 0]], float))
    ((zz, zv, vz, vv, z0, z1, v0, v1),) = propagators(np.array([square], float), np.array([damping], float), h)
    found = np.array([[zz, zv / h, (z0 + z1) / h**2, z1 / h**2], [vz * h, vv, (v0 + v1) / h, v1 / h]])
    np.testing.assert_allclose(found, whole[:2], atol=EXPONENTIAL * np.abs(whole[:2]).max(), rtol=0)
    np.testing.assert_allclose(found[0], whole[0], atol=EXPONENTIAL * np.abs(whole[0]).max(), rtol=0)


def test_a_stiff_and_hardly_tenable_mode_comes_to_rest_under_its_force() -> None:
    """Where no exponential has digits: after one long step the mode stands where the force holds it, for any damping."""
    for square, damping in ((1e12, 1e9), (1e14, 1e12), (1e4, 1e9)):
        ((zz, _, _, _, z0, z1, _, _),) = propagators(np.array([square]), np.array([damping]), 1e9)
        assert abs(zz) < 1e-12
        assert (z0 + z1) * square == pytest.approx(1.0, rel=1e-12)


# ---------------------------------------------------------------------- a motion, against an integration of its equations


SPEEDS, LASTS = (1000.0, 3600.0), 0.003


def _shaken() -> tuple[System, Excitation]:
    error = TransmissionError(coefficients=4 * np.array([0, 3 + 1j, 1.0, 0.5j]), teeth=3)
    mesh = MeshExcitation(stiffness=CosineStiffness(variation=0.3), error=error, backlash=20.0, phase=40.0)
    return system(one_stage()), Excitation(meshes=(mesh,))


def _integrated(of: System, excitation: Excitation, start: Start) -> Floats:
    """Coordinates at the end, by scipy: speed rising, torque falling to a fifth at a third of the time."""
    n, (low, high), (back,) = of.size, SPEEDS, excitation.backlashes
    middle = LASTS / 3

    def rates(t: float, x: Floats, factor: float) -> Floats:
        theta = 2 * np.pi * (low * t + (high - low) * t * t / (2 * LASTS))
        omega = 2 * np.pi * (low + (high - low) * t / LASTS)
        y = float(of.mesh[:, 0] @ x[:n] - excitation.errors(theta)[0])
        v = float(of.mesh[:, 0] @ x[n:] - excitation.error_slopes(theta)[0] * omega)
        stiffness = float(of.stiffness[0] * excitation.ratios(theta)[0])
        force = stiffness * (max(y, 0.0) + min(y + back, 0.0)) + of.mesh_damping[0] * v
        turn = of.load * factor - of.mesh[:, 0] * force - of.squares * x[:n] - of.damping * x[n:]
        return np.concatenate([x[n:], turn])

    x = np.concatenate([start.coordinates, start.rates])
    for begin, end, factor in ((0.0, middle, 1.0), (middle, LASTS, 0.2)):
        found = solve_ivp(rates, (begin, end), x, "DOP853", args=(factor,), rtol=1e-10, atol=1e-15, max_step=2e-5)
        x = found.y[:, -1]
    return np.asarray(x, float)


def test_motion_converges_to_that_of_scipy_with_the_square_of_the_step() -> None:
    """Modes, teeth that part and meet at the back, errors, a speed that rises and a torque that drops."""
    of, excitation = _shaken()
    moving = MovingSystem.lumped(of, excitation)
    assert moving.senses[0] == 1
    expected = _integrated(of, excitation, moving.at_rest())
    torque = PiecewiseLine(time=np.array([0, LASTS / 3, LASTS / 3, LASTS]), value=np.array([1, 1, 0.2, 0.2]))
    course = RunCourse(frequency=PiecewiseLine(time=np.array([0, LASTS]), value=np.array(SPEEDS)), torque=torque)
    scale, errors = float(np.linalg.norm(moving.at_rest().coordinates)), []
    for count in (750, 3000, 12000):
        motion = moving.run(course, LASTS / count, count, stride=count)
        errors.append(float(np.linalg.norm(motion.end.coordinates - expected[: of.size])) / scale)
    assert errors[-1] < 2e-4
    assert math.log(errors[0] / errors[-1], 16) == pytest.approx(2, abs=2 * ORDER)


def test_teeth_with_gaps_of_their_own_are_springs_beside_each_other() -> None:
    """A spring for each pair of teeth, with a gap that closes and opens, and teeth that stand back: against scipy."""
    of = system(one_stage())
    place = np.array([-0.9, -0.7, 0.7, 0.9])
    table = SpringTable(
        place=place, stiffness=2e8 * np.array([0.5, 1, 1, 0.5]), gap=1e-5 * np.array([8, 0, 0, 8.0]), opening=True
    )
    position, slope = 1e-6 * np.array([0, 20.0, -15.0]), 1e-6 * np.array([5.0, 0, 10])
    law = MeshLaw(table=table, order=3, lead=0.2, position=position, slope=slope, middle=0.1, backlash=3e-5)
    moving = MovingSystem(system=of, laws=(law,), senses=np.ones(1), driven=np.zeros(of.size))
    speed, lasts, n = 900.0, 0.003, of.size

    def rates(t: float, x: Floats) -> Floats:
        y, u, force = float(of.mesh[:, 0] @ x[:n]), 3 * speed * t + 0.2, 0.0
        for tooth in range(math.floor(u) - 2, math.floor(u) + 3):
            s = u - tooth
            if place[0] <= s <= place[-1]:
                k, g = np.interp(s, place, table.stiffness), np.interp(s, place, table.gap)
                front = y - g - position[tooth % 3] - slope[tooth % 3] * (s - 0.1)
                back = y + 3e-5 + g + position[tooth % 3] + slope[tooth % 3] * (s - 0.1)
                force += k * (max(front, 0.0) + min(back, 0.0))
        force += of.mesh_damping[0] * float(of.mesh[:, 0] @ x[n:])
        return np.concatenate([x[n:], of.load - of.mesh[:, 0] * force - of.squares * x[:n] - of.damping * x[n:]])

    start = moving.at_rest()
    x = np.concatenate([start.coordinates, start.rates])
    expected = solve_ivp(rates, (0, lasts), x, "DOP853", rtol=1e-9, atol=1e-14, max_step=2e-6).y[:n, -1]
    errors = []
    for count in (1000, 4000):
        found = moving.run(RunCourse.steady(speed), lasts / count, count).end.coordinates
        errors.append(float(np.linalg.norm(found - expected) / np.linalg.norm(expected)))
    assert errors[0] < 1e-3
    assert errors[1] < errors[0] / 8


# ---------------------------------------------------------------------- what lasts, against harmonic balance


@pytest.mark.parametrize("shape", ["cosine", "square"])
@pytest.mark.parametrize("rpm", [3100.0, 5200.0, 12500.0])
def test_what_lasts_has_the_factor_of_harmonic_balance(rpm: float, shape: str) -> None:
    of = system(one_stage())
    stiffness = CosineStiffness(variation=0.206) if shape == "cosine" else square_stiffness(1.6)
    excitation = Excitation(meshes=(MeshExcitation(stiffness=stiffness),))
    teeth, per_tooth = 120, 400
    frequency = rpm * 18 / 60
    motion = MovingSystem.lumped(of, excitation).run(
        RunCourse.steady(frequency), 1 / frequency / per_tooth, teeth * per_tooth, ends=np.array([100, teeth]) * per_tooth
    )
    balance = periodic_response(of, excitation, [2 * np.pi * frequency], harmonics=60, stability=False)
    static = np.abs(of.stiffness * balance.static.approach)
    tolerance = CHART if shape == "cosine" else STEPS
    assert motion.crest[-1] / static == pytest.approx(balance.spring_forces().max() / static, rel=tolerance)


def test_flanks_that_part_and_bounce_follow_the_branch_that_lasts() -> None:
    """Below the resonance, where two motions last: the one of the run down is met from far above."""
    of = system(one_stage(damping=1500.0))
    excitation = Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.2), backlash=60.0),))
    speeds = 2 * np.pi * 18 / 60 * np.linspace(4000.0, 13000.0, 91)
    branch = trace(of, excitation, speeds, harmonics=20)
    moving, per_tooth = MovingSystem.lumped(of, excitation), 400
    for direction, begin in ((Direction.UP, 4000.0), (Direction.DOWN, 13000.0)):
        chart = branch.sweep(direction)
        wanted = 8800.0
        index = int(np.argmin(np.abs(chart.frequencies - 2 * np.pi * 18 / 60 * wanted)))
        static = np.abs(of.stiffness * chart.static.approach)
        low, high = begin * 18 / 60, float(chart.frequencies[index]) / (2 * np.pi)
        course = RunCourse(frequency=PiecewiseLine(time=np.array([0, 0.5]), value=np.array([low, high])))
        step = 1 / max(low, high) / per_tooth
        count = round(0.6 / step)
        motion = moving.run(course, step, count, ends=[round(0.55 / step), count])
        expected = (chart.spring_forces().max(axis=1) / static)[index]
        assert motion.crest[-1] / static == pytest.approx(expected, rel=CHART)


# ---------------------------------------------------------------------- energy


def test_a_free_pair_without_damping_keeps_its_energy() -> None:
    """For ten thousand steps of a thirtieth of its own vibration; its turning as a whole goes on evenly.

    One step takes (y, h v) by a matrix of determinant 1, which keeps v² + (1 - (omega h)²/12) omega² y².
    """
    train = Train(
        inertias=(Inertia(name="pinion", inertia=0.01), Inertia(name="wheel", inertia=0.03)),
        meshes=(
            ToothMesh(
                name="mesh", pinion="pinion", wheel="wheel", base_radii=(50.0, 100.0), teeth=20, stiffness=300.0, variation=0.0
            ),
        ),
    )
    of = system(train)
    moving = MovingSystem.lumped(of, Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.0)),)))
    own = math.sqrt(float(np.linalg.eigvalsh(of.stiffness_matrix())[-1]))
    rates, step = np.array([0.3, 0.1]), 2 * np.pi / own / 30

    def energy(z: Floats, v: Floats) -> float:
        return float(v @ v + (1 - (own * step) ** 2 / 12) * of.stiffness[0] * (of.mesh[:, 0] @ z) ** 2) / 2

    turning = np.array([-of.mesh[1, 0], of.mesh[0, 0]]) / float(np.linalg.norm(of.mesh))
    start = Start(coordinates=np.zeros(2), rates=rates)
    motion = moving.run(RunCourse.steady(500.0), step, 10_000, start=start)
    assert energy(motion.end.coordinates, motion.end.rates) == pytest.approx(energy(np.zeros(2), rates), rel=1e-9)
    assert turning @ motion.end.coordinates == pytest.approx(10_000 * step * float(turning @ rates), rel=1e-9)


# ---------------------------------------------------------------------- steps that are too long


def moving_stage() -> MovingSystem:
    excitation = Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.2)),))
    return MovingSystem.lumped(system(one_stage()), excitation)


@pytest.mark.parametrize(
    ("frequency", "step", "count", "parameter"),
    [(3e5, 1e-5, 2000, "step"), (100.0, 1e300, 1, "step"), (0.0, 1e300, 1, "step"), (1e4, 1e-4, 10**12, "count")],
)
def test_steps_over_many_teeth_are_refused(frequency: float, step: float, count: int, parameter: str) -> None:
    """There is room for the teeth of one base pitch, and places are told apart up to 1e12 of them."""
    with pytest.raises(ParameterError, match=f"^{parameter} = .*must (be|make)"):
        moving_stage().run(RunCourse.steady(frequency), step, count)


@pytest.mark.parametrize("frequency", [3e5, 1e300])
def test_the_kernel_stops_before_it_runs_out_of_room(frequency: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nobody looked before."""
    monkeypatch.setattr(MovingSystem, "_require_short", lambda *_: None)
    with pytest.raises(SolverError, match="take shorter steps"):
        moving_stage().run(RunCourse.steady(frequency), 1e-5, 2000)


def test_a_base_pitch_in_one_step_is_not_too_much() -> None:
    motion = moving_stage().run(RunCourse.steady(1e3), 1e-3, 200, stride=1)
    assert np.isfinite(motion.spring).all()
