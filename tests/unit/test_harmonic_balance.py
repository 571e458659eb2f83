"""Excitation, harmonic balance, stability, time integration and K_v: each against a closed form or against another method."""

import json
import math
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp
from scipy.linalg import expm
from support.responses import MOMENT, VARIATION, cosine, floquet_multipliers, isolated, oscillator, two_stages
from support.transient import integrate

from gearcad.core.errors import GeometryError, ParameterError, SolverError
from gearcad.core.records import PerGear
from gearcad.dynamics.response.branch_continuation import Branch, sweep, trace
from gearcad.dynamics.response.harmonic_balance import Resolution
from gearcad.dynamics.response.kv_chart import kv_chart
from gearcad.dynamics.response.linear_response import _propagators, growth, harmonic_orders, periodic_response
from gearcad.dynamics.response.speed_charts import parted
from gearcad.dynamics.response.speed_curves import SpeedCurves
from gearcad.dynamics.trains.mesh_excitation import (
    CosineStiffness,
    CurveStiffness,
    Excitation,
    MeshExcitation,
    cycle_excitation,
    cycle_stiffness,
    square_stiffness,
)
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import Direction
from gearcad.dynamics.trains.tooth_deviations import ToothDeviations, TransmissionError, random_deviations, tooth_errors
from gearcad.mesh_cycle import MeshCycle
from gearcad.rating.dynamic_factor import DynamicFactor, reduced_mass
from gearcad.rating.tolerances import flank_tolerances

# ---------------------------------------------------------------------- stiffness


def by_quadrature(shape: CurveStiffness, order: int) -> complex:
    """A Fourier coefficient, integrated from corner to corner."""
    corners = np.unique(shape.phase)
    total = 0.0 + 0j
    for start, end in pairwise(corners):
        inside = (start + 1e-12 * (end - start), end - 1e-12 * (end - start))
        for part, unit in ((np.cos, 1), (np.sin, -1j)):
            total += unit * quad(lambda t, part=part: float(shape.values(t)) * part(order * t), *inside, epsabs=1e-13)[0]
    return total / (2 * np.pi)


def test_coefficients_of_a_curve() -> None:
    curve = CurveStiffness(phase=np.array([-0.5, 0.3, 1.0, 1.0, 2.0, 2 * np.pi - 0.5]), stiffness=[3, 4, 5, 2, 2.5, 1.0])
    found = curve.coefficients(7)
    assert found[0] == 1
    assert found[1:] == pytest.approx([by_quadrature(curve, n) for n in range(1, 8)], abs=1e-10)
    assert curve.jumps == pytest.approx([1.0, 2 * np.pi - 0.5])


def test_square_wave() -> None:
    """2 pairs for 0.6 of a pitch, 1 for the rest; coefficients in closed form."""
    shape = square_stiffness(1.6)
    assert shape.values([0.1, 0.59 * 2 * np.pi, 0.61 * 2 * np.pi, 6.2]) == pytest.approx([2 / 1.6, 2 / 1.6, 1 / 1.6, 1 / 1.6])
    n = np.arange(1, 6)
    assert shape.coefficients(5)[1:] == pytest.approx((1 - np.exp(-2j * np.pi * n * 0.6)) / (2j * np.pi * n * 1.6), abs=1e-14)
    assert not len(square_stiffness(2.0).jumps)


def cycle() -> MeshCycle:
    """A smooth curve, with a modification of 3 µm that varies over the mesh."""
    angle = np.linspace(-10, 10, 81)
    phase = 2 * np.pi * angle / 20
    tangent = 400 * (1 + 0.1 * np.cos(phase) + 0.05 * np.sin(2 * phase))
    secant = 0.9 * tangent
    return MeshCycle(
        method="made up",
        holds=(),
        torque=100.0,
        force=4000.0,
        width=10.0,
        roll_angle=angle,
        mesh_stiffness=secant,
        tangent_stiffness=tangent,
        transmission_error=4000.0 / secant + 3.0 * np.cos(phase),
    )


def test_mesh_cycle_as_excitation() -> None:
    of = cycle()
    shape = cycle_stiffness(of)
    turn = np.linspace(-180, 180, 37)
    assert shape.values(np.radians(turn)) * of.tangent_mean == pytest.approx(
        of.stiffness_at(turn / 18, tangent=True), rel=1e-12
    )
    series = of.fourier(3, tangent=True)
    assert 2 * shape.coefficients(3)[1:] * of.tangent_mean == pytest.approx(series.cosine - 1j * series.sine, abs=0.1)
    mesh = cycle_excitation(of)
    phase = np.radians(of.roll_angle * 18)
    assert mesh.error is not None
    loaded = mesh.error.values(phase) + of.force / (of.tangent_mean * shape.values(phase))
    assert loaded == pytest.approx(of.transmission_error, abs=1e-12)


# ---------------------------------------------------------------------- tooth errors


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_random_deviations_keep_their_tolerances(seed: int) -> None:
    tolerances = flank_tolerances(9, 108.0, 6.0)
    found = random_deviations(18, tolerances, seed)
    pitches = np.diff(found.position, append=found.position[0])
    assert np.abs(pitches).max() <= tolerances.single_pitch * (1 + 1e-12)
    assert np.ptp(found.position) <= tolerances.cumulative_pitch * (1 + 1e-12)
    assert np.abs(found.slope).max() <= tolerances.profile_slope
    # Well used: uniform deviations of 18 teeth reach beyond half of the tolerance.
    assert np.abs(pitches).max() > 0.5 * tolerances.single_pitch
    assert np.array_equal(found.position, random_deviations(18, tolerances, seed).position)


@pytest.mark.parametrize("contact_ratio", [1.3, 1.6, 2.4])
def test_tooth_errors_are_the_mean_of_pairs_in_contact(contact_ratio: float) -> None:
    """Against the sum in time over pairs of their deviation times their trapezoidal share."""
    generator = np.random.default_rng(5)
    pinion = ToothDeviations(position=generator.normal(size=5), slope=generator.normal(size=5))
    wheel = ToothDeviations(position=generator.normal(size=7))
    error = tooth_errors(pinion, wheel, contact_ratio=contact_ratio, harmonics=60)
    assert error.teeth == 35
    pitches = np.linspace(0, 35, 211)
    expected = np.zeros_like(pitches)
    wide = contact_ratio - 1
    for pair in range(-4, 40):
        s = pitches - pair
        share = np.clip((contact_ratio / 2 - np.abs(s)) / max(min(wide, 1), 1e-12), 0, 1) / max(wide, 1)
        deviation = pinion.position[pair % 5] + wheel.position[pair % 7] + pinion.slope[pair % 5] * s / contact_ratio
        expected += share * deviation
    # The series of a continuous course with kinks is cut at 60 harmonics of the tooth frequency.
    assert error.values(2 * np.pi * pitches) == pytest.approx(expected, abs=0.02)


# ---------------------------------------------------------------------- linear response


def test_transmission_error_drives_an_oscillator() -> None:
    """y'' + c (y' - e') + (y - e) = 1 with constant stiffness: the closed form of base excitation."""
    error = TransmissionError(coefficients=np.array([0.0, 0.5e6]))
    excitation = Excitation(meshes=(MeshExcitation(stiffness=CosineStiffness(variation=0.0), error=error),))
    speeds = np.array([0.3, 0.9, 2.0])
    response = periodic_response(oscillator(0.1), excitation, speeds, harmonics=3)
    exact = 0.5 * (1 + 0.2j * speeds) / (1 - speeds**2 + 0.2j * speeds)
    assert response.approach_coefficients[:, 1, 0] == pytest.approx(exact, rel=1e-12)
    assert response.approach_coefficients[:, 0, 0] == pytest.approx([1, 1, 1], rel=1e-12)
    assert "would part" in str(response.notices[0])


def pitch_errors(backlash: float | None = None) -> Excitation:
    """Five teeth with deviations of up to a tenth of the static deflection of 1 m, on a square wave."""
    deviations = ToothDeviations(position=1e5 * np.array([0.5, -1, 0.3, 0.8, -0.6]))
    error = tooth_errors(deviations, contact_ratio=1.6, harmonics=8)
    return Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(1.6), error=error, phase=70.0, backlash=backlash),))


def test_tooth_errors_against_time_integration() -> None:
    """Orders of the shaft: where the stiffness jumps the error falls with the square of the number of harmonics."""
    period = 5 * 2 * np.pi / 0.7
    times = 2 * period + period * np.arange(1024) / 1024
    errors = []
    for harmonics in (8, 16, 32):
        response = periodic_response(oscillator(0.2), pitch_errors(), [0.7], harmonics=harmonics)
        assert response.harmonics.tolist() == list(range(5 * harmonics + 1))
        errors.append(response.approach(count=1024)[0, :, 0])
    found = integrate(oscillator(0.2), pitch_errors(), 0.7, 3 * period, times=times, tolerance=1e-8).approach[:, 0]
    eight, sixteen, thirty_two = (float(np.abs(y - found).max()) for y in errors)
    assert eight < 5e-3
    assert eight / sixteen > 3.5 < sixteen / thirty_two


def test_meshes_of_different_tooth_frequency() -> None:
    """A second stage at 3/2 of the first's tooth frequency, against time integration of the whole train."""
    shape = CosineStiffness(variation=0.15)
    ratio = Fraction(3, 2)
    excitation = Excitation(
        meshes=(MeshExcitation(stiffness=shape), MeshExcitation(stiffness=shape, frequency_ratio=ratio, phase=40.0))
    )
    assert excitation.orders == (2, 3)
    assert harmonic_orders(excitation, 2).tolist() == [0, 1, 2, 3, 4, 5, 6]
    system = replace(two_stages(), damping=np.full(4, 4000.0))
    response = periodic_response(system, excitation, [7000.0], harmonics=6)
    period = 2 * 2 * np.pi / 7000.0
    times = np.linspace(7 * period, 8 * period, 256, endpoint=False)
    found = integrate(system, excitation, 7000.0, 8 * period, times=times, tolerance=1e-9)
    y = response.approach(count=256)[0]
    assert np.abs(found.approach - y).max() < 1e-4 * np.abs(y).max()
    assert np.abs(found.shaft_torques - response.shaft_torques(count=256)[0]).max() < 1e-3 * MOMENT


def free_pair(balance: float = 1.0) -> System:
    """The isolated pair as two gears that are free to turn."""
    radii, inertias = np.array([0.0507, 0.1353]), np.array([0.0058, 0.2228])
    shapes = np.diag(1 / np.sqrt(inertias))
    return replace(
        isolated(),
        squares=np.zeros(2),
        damping=np.zeros(2),
        mesh=(shapes @ radii)[:, None],
        inertias=shapes,
        shaft_torques=np.zeros((2, 0)),
        load=shapes @ (MOMENT / radii[0] * radii * np.array([1.0, balance])),
    )


def test_train_that_is_free_to_turn() -> None:
    """Reduced to the line of action it is the oscillator of the isolated pair; torques must balance."""
    speeds = np.linspace(2000, 30000, 15)
    single, free = (periodic_response(of, cosine(VARIATION), speeds) for of in (isolated(), free_pair()))
    assert free.approach_coefficients == pytest.approx(single.approach_coefficients, rel=1e-9, abs=1e-18)
    assert free.stable.all()
    with pytest.raises(GeometryError, match="must balance"):
        periodic_response(free_pair(0.9), cosine(VARIATION), speeds)


def test_undamped_resonance_is_an_error() -> None:
    with pytest.raises(SolverError, match="without damping"):
        periodic_response(oscillator(0.0), cosine(0.1), [0.5, 1.0])


@pytest.mark.parametrize(
    ("make", "parameter"),
    [
        (lambda: CosineStiffness(variation=1.0), "variation"),
        (lambda: CurveStiffness(phase=[0, 3, 2 * np.pi], stiffness=[1, -0.1, 1]), "stiffness"),
        (lambda: CurveStiffness(phase=[0, 3, 6], stiffness=[1, 1, 1]), "phase"),
        (lambda: cosine(0.1, backlash=-1.0), "backlash"),
        (lambda: square_stiffness(0.9), "contact_ratio"),
        (lambda: ToothDeviations(position=[1.0, math.nan]), "position"),
        (lambda: periodic_response(oscillator(0.1), cosine(0.1), [-1.0]), "frequencies"),
        (lambda: periodic_response(oscillator(0.1, -1.0), cosine(0.1), [1.0]), "mesh_stiffness"),
        (lambda: periodic_response(two_stages(), cosine(0.1), [1.0]), "meshes"),
        (lambda: trace(oscillator(0.1), cosine(0.1), [2.0, 1.0]), "frequencies"),
    ],
)
def test_unphysical_input(make: object, parameter: str) -> None:
    with pytest.raises(ParameterError, match=parameter):
        make()  # type: ignore[operator]


# ---------------------------------------------------------------------- stability


def test_parametric_instability_is_told() -> None:
    """Principal instability about twice the natural frequency: for |1 - nu^2/4| < sqrt((p/2)^2 - (2 zeta)^2), nearly."""
    speeds = np.linspace(1.7, 2.3, 61)
    response = periodic_response(oscillator(0.01), cosine(0.2), speeds)
    half = np.sqrt(0.1**2 - 0.02**2)
    unstable = speeds[~response.stable]
    assert (unstable[0], unstable[-1]) == (
        pytest.approx(2 * np.sqrt(1 - half), abs=0.012),
        pytest.approx(2 * np.sqrt(1 + half), abs=0.012),
    )
    assert "parametric instability" in str(response.notices[0])
    assert periodic_response(oscillator(0.06), cosine(0.2), speeds).stable.all()


def test_growth_is_the_largest_multiplier() -> None:
    excitation, speeds = Excitation(meshes=(MeshExcitation(stiffness=square_stiffness(1.5)),)), np.array([0.05, 0.7, 1.9])
    exact = [abs(floquet_multipliers(oscillator(0.02), excitation, nu)[0]) for nu in speeds]
    assert growth(oscillator(0.02), excitation, speeds) == pytest.approx(exact, rel=2e-3)


# ---------------------------------------------------------------------- flanks that part


def test_without_parting_both_methods_agree() -> None:
    speeds = np.linspace(0.3, 0.8, 11)
    linear = periodic_response(oscillator(0.1), cosine(0.1), speeds, harmonics=10)
    parting = sweep(oscillator(0.1), cosine(0.1, backlash=1e6), speeds, harmonics=10)
    assert parting.approach_coefficients == pytest.approx(linear.approach_coefficients, abs=1e-9)
    assert linear.notices == parting.notices == ()


def test_both_branches_against_time_integration() -> None:
    """At 0.87, where there are two motions: both last, and one of them lifts off."""
    excitation = cosine(0.2, phase=180.0, backlash=math.inf)
    branch = trace(oscillator(0.05), excitation, np.linspace(0.6, 1.2, 61), harmonics=24)
    period = 2 * np.pi / 0.87
    times = period * (5 + np.arange(512) / 512)
    for direction, lifts in ((Direction.UP, False), (Direction.DOWN, True)):
        response = branch.sweep(direction)
        at = int(np.argmin(np.abs(response.frequencies - 0.87)))
        y = response.approach(slice(at, at + 1), 512)[0, :, 0]
        speed = 2 * (1j * response.harmonics * 0.87 * response.approach_coefficients[at, :, 0]).sum().real
        found = integrate(oscillator(0.05), excitation, 0.87, 6 * period, times=times, start=([y[0]], [speed]), tolerance=1e-9)
        assert np.abs(found.approach[:, 0] - y).max() < 1e-4
        assert (len(found.events) > 0) == lifts == (y.min() < 0)
    between = branch.index == np.argmin(np.abs(branch.frequencies - 0.87))
    assert branch.stable[between].tolist() == [True, False, True]


def test_flanks_meet_at_the_back() -> None:
    """With a backlash of a fifth of the static deflection, against time integration."""
    excitation = cosine(0.5, backlash=0.2e6)
    response = sweep(oscillator(0.05), excitation, np.linspace(0.4, 1.0, 61), harmonics=40)
    y = response.approach(slice(60, 61), 512)[0, :, 0]
    assert y.min() < -0.2
    rate = 2 * (1j * response.harmonics * response.approach_coefficients[60, :, 0]).sum().real
    times = 2 * np.pi * np.arange(512) / 512
    found = integrate(oscillator(0.05), excitation, 1.0, 2 * np.pi, times=times, start=([y[0]], [rate]), tolerance=1e-9)
    assert np.abs(found.approach[:, 0] - y).max() < 2e-3
    assert len(found.events) == 4


def test_load_on_the_other_flanks() -> None:
    """All signs turned round: the same chart, the approach negative."""
    speeds = np.linspace(0.6, 1.4, 41)
    plus, minus = (sweep(oscillator(0.1, load=load), cosine(0.4, backlash=5e6), speeds, Direction.DOWN) for load in (1.0, -1.0))
    assert plus.approach().min() < 0 < plus.approach().max()
    assert minus.approach_coefficients == pytest.approx(-plus.approach_coefficients, abs=1e-8)
    assert kv_chart(minus).factors == pytest.approx(kv_chart(plus).factors, abs=1e-8)


def test_bounce_in_time() -> None:
    """y'' + max(y, 0) = 1 from contact at speed 1: touches again after 2 + 2 pi - 2 atan 1."""
    period = 2 + 2 * np.pi - 2 * math.atan(1)
    found = integrate(
        oscillator(0.0),
        cosine(0.0, backlash=math.inf),
        1.0,
        3 * period,
        times=[3 * period],
        start=([0.0], [1.0]),
        tolerance=1e-11,
    )
    # Contact lasts 2 pi - 2 atan 1, flight 2.
    turns = period * np.arange(3)[:, None] + [2 * np.pi - 2 * math.atan(1), period]
    assert found.events[found.events > 1e-6][:5] == pytest.approx(turns.ravel()[:5], rel=1e-9)


def test_run_up_in_time() -> None:
    """Against a plain integration with the phase of an even run-up."""
    times = np.linspace(0, 40, 81)
    found = integrate(oscillator(0.1), cosine(0.3), (0.5, 1.5), 40.0, times=times, tolerance=1e-9)

    def derivative(t: float, state: np.ndarray) -> list[float]:
        stiffness = 1 - 0.3 * math.cos(0.5 * t + t**2 / 80)
        return [state[1], 1 - 0.2 * state[1] - stiffness * state[0]]

    expected = solve_ivp(derivative, (0, 40), [1.0, 0.0], "Radau", rtol=1e-9, atol=1e-11, t_eval=times).y[0]
    assert found.approach[:, 0] == pytest.approx(expected, abs=1e-6)
    assert found.frequency[[0, -1]] == pytest.approx([0.5, 1.5])


# ---------------------------------------------------------------------- K_v


def test_chart_of_two_stages() -> None:
    """The paper's figure 9: overload of the middle shaft max k3 (phi2 - phi3)/M, which exceeds that of the teeth."""
    shape = CosineStiffness(variation=VARIATION)
    excitation = Excitation(meshes=(MeshExcitation(stiffness=shape), MeshExcitation(stiffness=shape)))
    response = periodic_response(two_stages(), excitation, np.arange(9000.0, 11001.0, 50.0))
    given, static = kv_chart(response, shaft_references=[None, MOMENT, None]), kv_chart(response)
    assert given.shaft_factors[:, 1] == pytest.approx(static.shaft_factors[:, 1] * static.shaft_references[1] / MOMENT)
    assert static.shaft_references[1] == pytest.approx(MOMENT, rel=1e-3)
    turns = response.turns()
    assert given.shaft_factors[:, 1] == pytest.approx(1e7 * np.abs(turns[:, :, 1] - turns[:, :, 2]).max(axis=1) / MOMENT)
    (peak,) = given.peaks()
    assert peak.frequency == pytest.approx(9971, rel=0.01)
    json.dumps(given.to_dict(), allow_nan=False)


def test_definitions_of_k_v() -> None:
    """What the teeth carry and what the mesh with its damping carries: the latter accelerates the gears."""
    response = periodic_response(isolated(), cosine(VARIATION), [9000.0, 19000.0], harmonics=10)
    force = response.spring_forces() + response.damping_forces()
    static = response.system.stiffness * response.static.approach
    assert kv_chart(response).damped == pytest.approx(force.max(axis=1) / static)
    order = response.harmonics[:, None]
    rate = (1j * order * response.frequencies[:, None, None]) ** 2 * response.approach_coefficients
    acceleration = np.fft.irfft(np.pad(rate, ((0, 0), (0, 129 - 11), (0, 0))) * 256, 256, axis=1)
    mass = 1 / float(response.system.mesh[0, 0]) ** 2
    assert force == pytest.approx(static - mass * acceleration, rel=1e-5)


def test_k_v_needs_a_static_load() -> None:
    response = periodic_response(oscillator(0.1, load=0.0), cosine(0.1), [1.0])
    with pytest.raises(GeometryError, match="K_v refers to it"):
        kv_chart(response)


def test_method_b_beside_ours() -> None:
    """One resonance: n_E1 of m_red and c_gamma is the natural frequency of the isolated pair."""
    width = 50.0
    mass = reduced_mass(PerGear(0.0058, 0.2228), PerGear(50.7, 135.3), width)
    method_b = DynamicFactor(
        teeth=18,
        total_contact_ratio=1.6,
        single_stiffness=14.0,
        mesh_stiffness=7.05e8 / 1e6 / width,
        reduced_mass=mass,
        specific_load=400.0,
        pitch_deviation=8.0,
        profile_deviation=6.0,
    )
    assert method_b.resonance_speed == pytest.approx(19245.076 * 30 / (18 * math.pi), rel=1e-7)
    speeds = np.linspace(2000, 40000, 39)
    chart = kv_chart(periodic_response(isolated(), cosine(VARIATION), speeds), method_b=method_b)
    assert chart.standard == pytest.approx(method_b.values(speeds * 30 / (18 * math.pi)))


def test_a_motion_far_from_where_the_search_began_is_another_one() -> None:
    """More harmonics must refine the motion that was found: a linear balance is met from afar too, but does not count."""
    balance = Resolution(oscillator(0.1), cosine(0.2), 8)
    omega = np.array([0.7])
    (found,) = balance.solve(omega)
    assert found.solved.all()
    start = found.approach[:, :9]
    for beside, near in ((0.0, True), (1.0, False)):
        (again,) = balance.solve(omega, start + beside)
        np.testing.assert_allclose(again.approach, found.approach, atol=1e-5)
        assert again.solved.tolist() == [near]


def test_a_branch_goes_on_to_the_last_speed_where_flanks_still_part(monkeypatch: pytest.MonkeyPatch) -> None:
    """Flanks are said to part at 0.9 of the resonance alone, but do so at the end of the chart too: it is followed to there."""
    traced: list[float] = []

    def traced_to(system: System, excitation: Excitation, frequencies: NDArray[np.float64], **how: Any) -> Branch:
        traced.append(float(frequencies[-1]))
        assert len(traced) < 5  # or it would be followed for ever
        return trace(system, excitation, frequencies, **how)

    monkeypatch.setattr("gearcad.dynamics.response.speed_charts.trace", traced_to)
    monkeypatch.setattr("gearcad.dynamics.response.speed_charts.MOST_ROUNDS", 0)  # no speeds between: they take long
    curves = SpeedCurves(oscillator(0.1), cosine(0.5, phase=180.0, backlash=math.inf))
    speeds = np.array([0.5, 0.6, 0.75, 0.9, 0.95, 1.0, 1.05])
    found = parted(curves, speeds, np.array([0.9]))
    assert traced[0] < traced[-1] == speeds[-1]
    assert found.branch.frequencies[-1] == speeds[-1]
    assert found.seen(Direction.UP)[0].least[-1].min() <= 0


@pytest.mark.parametrize("size", [1, 6])
def test_propagators_of_many_times_are_matrix_exponentials(size: int) -> None:
    """One of the modes turns freely; damping couples them."""
    random = np.random.default_rng(size)
    squares, couplings = np.abs(random.standard_normal(size)) * 1e9, random.standard_normal((size, size))
    squares[0] = 0.0 if size > 1 else squares[0]
    damping, times = couplings @ couplings.T * 300, np.geomspace(1e-7, 1e-4, 5)
    generator = np.block([[np.zeros((size, size)), np.eye(size)], [-np.diag(squares), -damping]])
    true = expm(generator * times[:, None, None])
    scale = np.repeat([1.0, np.sqrt(squares.max())], size)
    assert _propagators(squares, damping, times) / scale[:, None] * scale == pytest.approx(
        true / scale[:, None] * scale, abs=1e-11
    )
