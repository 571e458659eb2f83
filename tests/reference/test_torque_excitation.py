"""Torques on inertias beside teeth: closed forms of chains, own equations by scipy, superposition, energy, run-ups."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats
from gearcad.dynamics import DynamicsOptions, Inertia, Shaft, ToothMesh, TorqueCurve, TorqueExcitation, Train
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.response.order_chart import order_chart
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.time_domain.transient import run_transient
from gearcad.dynamics.time_domain.transient_result import Transient, TransientOptions
from gearcad.dynamics.train_result import ModalStudy
from gearcad.dynamics.train_study import study_torques, study_train
from gearcad.dynamics.trains.mesh_excitation import Excitation, train_excitation, train_torques
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.speed_orders import SpeedOrder, speed_orders
from gearcad.dynamics.trains.steady_response import torque_motion

CLOSED = 1e-10
"""Relative: the same numbers by another formula."""

BY_STEPS = 2e-4
"""Relative, of amplitudes: what steps of 80 a vibration leave."""

TORQUE = TorqueExcitation(name="firing", inertia="a", order=2.0, amplitude=10.0, phase=30.0)


def chain(*excitations: TorqueExcitation, held: bool = False, masses: int = 2) -> Train:
    """Two or three inertias in a row, free or with the last one held; dampers are as the springs, so modes stay uncoupled."""
    names = "abc"[:masses]
    shafts = [Shaft(name="ab", start="a", end="b", torsional_stiffness=2e4, damping=3.0)]
    shafts += [Shaft(name="bc", start="b", end="c", torsional_stiffness=3e4, damping=4.5)] * (masses > 2)
    shafts += [Shaft(name="held", start=names[-1], end="ground", torsional_stiffness=5e4, damping=7.5)] * held
    inertias = [Inertia(name=name, inertia=j) for name, j in zip(names, (0.1, 0.3, 0.2), strict=False)]
    return Train(model="massless", inertias=inertias, shafts=shafts, excitations=excitations)


def moved(train: Train, rpm: float, order: float) -> tuple[Floats, Floats]:
    """Complex amplitudes of turns (rad) and shaft torques (N·m) of an order."""
    of, excitation = system(train), Excitation(meshes=(), torques=train_torques(train))
    place = round(order * excitation.period)
    omega = np.array([rpm * math.pi / 30 * excitation.fundamental])
    (row,) = 2 * torque_motion(of, excitation, omega, np.array([0, place])).others[:, 0]
    return row[: len(train.inertias)], row[of.torque_outputs]


# ---------------------------------------------------------------------- closed forms of chains


@pytest.mark.parametrize("rpm", [60.0, 900.0, 2200.0, 9000.0])
def test_the_torque_in_a_chain_of_two_inertias(rpm: float) -> None:
    """k T/J_1 over (k + i w c)(1/J_1 + 1/J_2) - w², at w of twice the speed."""
    w, torque = 2 * rpm * math.pi / 30, 10 * cmath.exp(1j * math.radians(30))
    _, (found,) = moved(chain(TORQUE), rpm, 2.0)
    twist = -torque / 0.1 / ((2e4 + 3j * w) * (1 / 0.1 + 1 / 0.3) - w**2)
    assert found == pytest.approx(2e4 * twist, rel=CLOSED)


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("rpm", [300.0, 1900.0, 4000.0])
def test_a_chain_of_three_inertias(rpm: float, held: bool) -> None:
    """The transfer matrix of Holzer from the loaded end to the other, with complex stiffness, by hand."""
    w, torque = 2 * rpm * math.pi / 30, 10 * cmath.exp(1j * math.radians(30))
    first, second, last = 2e4 + 3j * w, 3e4 + 4.5j * w, (5e4 + 7.5j * w) if held else 0.0

    def end(turn: complex, load: complex) -> tuple[complex, list[complex]]:
        """Torque that is left at the far end, and the turns, for a turn of the loaded inertia."""
        inner = load + w**2 * 0.1 * turn
        middle = turn - inner / first
        inner += w**2 * 0.3 * middle
        far = middle - inner / second
        return inner + w**2 * 0.2 * far - last * far, [turn, middle, far]

    rest, slope = end(0.0, torque)[0], end(1.0, 0.0)[0]
    _, expected = end(-rest / slope, torque)
    found, torques = moved(chain(TORQUE, masses=3, held=held), rpm, 2.0)
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    np.testing.assert_allclose(torques[:2], [2e4 * (expected[1] - expected[0]), 3e4 * (expected[2] - expected[1])], rtol=1e-8)


@pytest.mark.parametrize("phase", [0.0, 70.0, -120.0])
def test_a_slow_torque_turns_what_is_held_as_at_rest(phase: float) -> None:
    """T(0)/k at angle 0, and in time too: the sign of the phase."""
    train = chain(replace(TORQUE, phase=phase), held=True)
    compliance = 1 / 2e4 + 1 / 5e4
    found, _ = moved(train, 0.01, 2.0)
    assert found[0] == pytest.approx(10 * compliance * cmath.exp(1j * math.radians(phase)), rel=1e-5)
    run = in_time(train, TransientOptions(speed_from=15.0, duration=1.0, sampling=1000.0), 15.0)
    expected = np.degrees(compliance * 10 * np.cos(2 * 15.0 * np.pi / 30 * run.time + math.radians(phase)))
    np.testing.assert_allclose(run.turn[:, 0], expected, atol=2e-3 * np.abs(expected).max())


def in_time(train: Train, options: TransientOptions, rpm: float) -> Transient:
    excitation = train_excitation(train) if train.meshes else Excitation(meshes=(), torques=train_torques(train))
    return run_transient(train, system(train), excitation, options, otherwise=rpm)


# ---------------------------------------------------------------------- a geared drive by its own equations

J = np.array([0.02, 0.004, 0.03, 0.2])
RADII, K, INPUT, OUTPUT = (0.04, 0.08), 3e8, (2e4, 10.0), (5e4, 20.0)
MESH_DAMPING = 2 * 0.05 * math.sqrt(K / (RADII[0] ** 2 / J[1] + RADII[1] ** 2 / J[2]))
ON_MOTOR = TorqueExcitation(name="ripple", inertia="m", order=2.0, amplitude=30.0, phase=40.0)
ON_LOAD = TorqueExcitation(name="load", inertia="l", order=3.0, amplitude=25.0, phase=-75.0)


def drive(*excitations: TorqueExcitation, variation: float = 0.2, backlash: float | None = None) -> Train:
    """Motor, shaft, pinion of 20 teeth, wheel of 40 teeth, shaft, load."""
    mesh = ToothMesh(
        name="z",
        pinion="p",
        wheel="w",
        base_radii=(40.0, 80.0),
        stiffness=300.0,
        teeth=20,
        damping_ratio=0.05,
        variation=variation,
        backlash=backlash,
    )
    shafts = [
        Shaft(name=name, start=start, end=end, torsional_stiffness=k, damping=c)
        for name, start, end, (k, c) in (("in", "m", "p", INPUT), ("out", "w", "l", OUTPUT))
    ]
    return Train(
        model="massless",
        inertias=[Inertia(name=name, inertia=j) for name, j in zip("mpwl", J, strict=True)],
        shafts=shafts,
        meshes=[mesh],
        torques={"m": 100.0, "l": 200.0},
        excitations=excitations,
    )


def integrated(
    rpm: float, lasts: float, shown: float, ripple: float = 30.0, backlash: float = math.inf
) -> tuple[Floats, Floats, Floats]:
    """Times, torques of both shafts (2, k) and the tooth force (k,), of equations written out by hand; 2.0 is the ratio."""
    omega = rpm * math.pi / 30

    def parts(t: float, x: Floats) -> tuple[float, float, float, float]:
        q, v = x[:4], x[4:]
        y, rate = RADII[0] * q[1] + RADII[1] * q[2], RADII[0] * v[1] + RADII[1] * v[2]
        gap = y if not math.isfinite(backlash) else max(y, 0.0) + min(y + backlash, 0.0)
        spring = K * (1 - 0.2 * math.cos(20 * omega * t)) * gap
        twists = (q[1] - q[0], v[1] - v[0], q[3] - q[2], v[3] - v[2])
        return (
            spring,
            MESH_DAMPING * rate,
            INPUT[0] * twists[0] + INPUT[1] * twists[1],
            OUTPUT[0] * twists[2] + OUTPUT[1] * twists[3],
        )

    def rates(t: float, x: Floats) -> Floats:
        spring, damper, before, behind = parts(t, x)
        motor = 100 + ripple * math.cos(2 * omega * t + math.radians(40)) + before
        load = 200 + 25 * math.cos(3 * omega / 2 * t + math.radians(-75)) - behind
        force = spring + damper
        accelerations = np.array([motor, -before - force * RADII[0], behind - force * RADII[1], load]) / J
        return np.concatenate([x[4:], accelerations])

    y = 100 / RADII[0] / K
    turns = np.array([100 / INPUT[0], 0.0, y / RADII[1], y / RADII[1] + 200 / OUTPUT[0]])
    times = np.linspace(lasts - shown, lasts, 6001)
    start = np.concatenate([turns, np.zeros(4)])
    longest = math.pi / (20 * omega) / 4
    x = solve_ivp(rates, (0, lasts), start, "DOP853", t_eval=times, rtol=1e-8, atol=1e-12, max_step=longest).y
    torques = np.array([INPUT[0] * (x[1] - x[0]), OUTPUT[0] * (x[3] - x[2])])
    forces = np.array([parts(t, column)[0] for t, column in zip(times.tolist(), x.T, strict=True)])
    return times, torques, forces


def test_torques_and_teeth_together_as_scipy_integrates_them() -> None:
    """Orders and phases of the shaft torques, and the greatest tooth force, of the balance and of the motion in time."""
    train, rpm = drive(ON_MOTOR, ON_LOAD), 1500.0
    period = 2 * 60 / rpm  # two turns of the pinion: one of the wheel
    times, torques, forces = integrated(rpm, 0.24 + period, period)
    excitation = train_excitation(train)
    assert (excitation.orders, excitation.torque_orders) == ((40,), (4, 3))
    response = periodic_response(system(train), excitation, np.array([rpm * 20 * math.pi / 30]), harmonics=12)
    for order in (3, 4, 36, 37, 40, 44):
        wave = np.exp(-1j * order * rpm * math.pi / 60 * times[:-1])
        expected = 2 * (torques[:, :-1] * wave).mean(axis=1)
        row = int(np.flatnonzero(response.harmonics == order)[0])
        found = 2 * response.torque_coefficients[0, row]
        np.testing.assert_allclose(found, expected, atol=BY_STEPS * 30, err_msg=str(order))
    assert response.spring_forces(count=8192).max() == pytest.approx(forces.max(), rel=1e-3)
    run = in_time(train, TransientOptions(speed_from=rpm, duration=0.24 + period, sampling=20_000.0), rpm)
    late = run.time > 0.24
    np.testing.assert_allclose(run.shaft_torque[late].max(axis=0), torques.max(axis=1), rtol=1e-3)
    assert float(run.factor[run.middles > 0.24].max() * run.static_forces[0]) == pytest.approx(forces.max(), rel=2e-3)


@pytest.mark.long
def test_flanks_that_part_under_a_torque_do_so_as_scipy_integrates_them() -> None:
    """K_v where the ripple lifts the flanks off: by the run of the chart."""
    train, rpm = drive(replace(ON_MOTOR, amplitude=80.0), ON_LOAD, backlash=60.0), 3300.0
    period = 2 * 60 / rpm
    _, _, forces = integrated(rpm, 0.6 + 4 * period, 4 * period, ripple=80.0, backlash=60e-6)
    assert forces.min() <= 0.0
    frequencies = np.linspace(3200.0, 3400.0, 9) * 20 * math.pi / 30
    found = over_speed(system(train), train_excitation(train), frequencies)
    row = int(np.abs(found.up.frequencies - rpm * 20 * math.pi / 30).argmin())
    assert found.up.factors[row, 0] * 2500.0 == pytest.approx(forces.max(), rel=0.02)


# ---------------------------------------------------------------------- superposition and energy


def test_torques_add_up_with_each_other_and_with_the_teeth() -> None:
    """In contact the equations are linear: each torque adds what it does beside the teeth alone, sidebands included."""
    rpm = np.array([700.0, 1500.0, 3100.0]) * 20 * math.pi / 30
    whole = train_excitation(drive(ON_MOTOR, ON_LOAD))
    parts = {"both": whole.torques, "first": whole.torques[:1], "second": whole.torques[1:], "none": whole.torques}
    responses = {}
    for name, torques in parts.items():
        weak = tuple(replace(each, coefficient=0j) for each in whole.torques if each not in torques)
        given = tuple(replace(each, coefficient=0j) for each in torques) if name == "none" else torques
        # All of the same common period, so that orders are the same.
        excitation = replace(whole, torques=(*given, *weak))
        responses[name] = periodic_response(system(drive(ON_MOTOR, ON_LOAD)), excitation, rpm, harmonics=8).torque_coefficients
    both = responses["first"] + responses["second"] - responses["none"]
    np.testing.assert_allclose(responses["both"], both, atol=1e-9 * np.abs(both).max())
    doubled = periodic_response(
        system(drive(ON_MOTOR, ON_LOAD)),
        replace(whole, torques=tuple(replace(each, coefficient=2 * each.coefficient) for each in whole.torques)),
        rpm,
        harmonics=8,
    ).torque_coefficients
    np.testing.assert_allclose(doubled, 2 * both - responses["none"], atol=1e-9 * np.abs(both).max())


@pytest.mark.parametrize("rpm", [400.0, 1500.0, 3200.0])
def test_the_power_of_the_torques_is_what_the_dampers_take(rpm: float) -> None:
    """Teeth of constant stiffness neither give nor take: 1/2 Re(T conj(i w turn)) against c |rate|²/2 of shafts and mesh."""
    train = drive(ON_MOTOR, ON_LOAD, variation=0.0)
    excitation = train_excitation(train)
    response = periodic_response(system(train), excitation, np.array([rpm * 20 * math.pi / 30]), harmonics=4)
    given = taken = 0.0
    for torque, order in zip(excitation.torques, excitation.torque_orders, strict=True):
        row, w = int(np.flatnonzero(response.harmonics == order)[0]), order * rpm * math.pi / 60
        turns = 2 * response.inertia_coefficients[0, row]
        at = "mpwl".index(torque.inertia)
        given += 0.5 * (2 * torque.coefficient * np.conj(1j * w * turns[at])).real
        approach = RADII[0] * turns[1] + RADII[1] * turns[2]
        moved_by = (turns[1] - turns[0], turns[3] - turns[2], approach)
        taken += sum(0.5 * c * w**2 * abs(x) ** 2 for c, x in zip((10.0, 20.0, MESH_DAMPING), moved_by, strict=True))
    assert given == pytest.approx(taken, rel=1e-8)
    assert taken > 0


# ---------------------------------------------------------------------- curves of torques


def curve(period: float = 720.0, count: int = 144, closed: bool = True) -> TorqueCurve:
    angle = np.linspace(0, period, count + 1)[: count + closed]
    torque = 50 + 20 * np.cos(np.radians(0.5 * angle + 20)) + 5 * np.cos(np.radians(2.5 * angle - 60))
    return TorqueCurve(angle=tuple(angle), torque=tuple(torque))


@pytest.mark.parametrize("closed", [True, False])
def test_a_curve_has_the_harmonics_of_which_it_was_made(closed: bool) -> None:
    found = curve(closed=closed)
    assert (found.turns, found.closed) == (2, closed)
    assert found.mean == pytest.approx(50)
    first, second = found.harmonics
    assert (float(first.order), float(second.order)) == (0.5, 2.5)
    assert first.amplitude == pytest.approx(20 * cmath.exp(1j * math.radians(20)), rel=1e-9)
    assert second.amplitude == pytest.approx(5 * cmath.exp(-1j * math.radians(60)), rel=1e-9)


def test_a_curve_that_begins_elsewhere_is_the_same_torque() -> None:
    whole = curve(closed=False)
    later = TorqueCurve(angle=tuple(a + 90 for a in whole.angle), torque=(*whole.torque[18:], *whole.torque[:18]))
    for one, other in zip(whole.harmonics, later.harmonics, strict=True):
        assert other.amplitude == pytest.approx(one.amplitude, rel=1e-9)


def test_a_curve_excites_as_its_harmonics_do() -> None:
    by_file = chain(TorqueExcitation(name="gas", inertia="a", file=curve()))
    waves = [
        TorqueExcitation(name=str(o), inertia="a", order=o, amplitude=a, phase=p) for o, a, p in ((0.5, 20, 20), (2.5, 5, -60))
    ]
    for order in (0.5, 2.5):
        np.testing.assert_allclose(moved(by_file, 800.0, order)[1], moved(chain(*waves), 800.0, order)[1], rtol=1e-9)


@pytest.mark.parametrize(
    ("angle", "error"),
    [((0.0, 90.0, 180.0, 300.0), "rise evenly"), ((0.0, 100.0, 200.0, 300.0), "whole number of turns"), ((0.0, 180.0), "four")],
)
def test_angles_that_make_no_period_are_refused(angle: tuple[float, ...], error: str) -> None:
    with pytest.raises((ParameterError, GeometryError), match=error):
        TorqueCurve(angle=angle, torque=(1.0,) * len(angle))


def test_excitations_that_cannot_be() -> None:
    with pytest.raises(ParameterError, match=r"firing\.inertia = 'x': must be one of the inertias a, b"):
        chain(replace(TORQUE, inertia="x"))
    with pytest.raises(ParameterError, match="names must differ"):
        chain(TORQUE, TORQUE)
    with pytest.raises(ParameterError, match="or give file instead"):
        TorqueExcitation(name="e", inertia="a", order=1.0)
    with pytest.raises(GeometryError, match=r"e\.order = 1: must be left out beside file"):
        TorqueExcitation(name="e", inertia="a", order=1.0, file=curve())
    with pytest.raises(GeometryError, match="drawn tooth errors has no torques on inertias"):
        study_train(drive(ON_MOTOR), DynamicsOptions(premature_engagement="on"))


# ---------------------------------------------------------------------- run-ups


def run_up(train: Train, duration: float, last: float) -> tuple[ModalStudy, Floats]:
    """The study, and how far each order track of each shaft is off the steady chart at most, over the chart's maximum."""
    transient = TransientOptions(
        speed_from=500.0, speed_to=last, duration=duration, order_tracks="on", sampling=1500.0
    )  # fmt: skip
    found = study_torques(train, DynamicsOptions(speed_from=400.0, speed_to=1.05 * last, speeds=600, transient=transient))
    assert found.transient is not None and found.transient.tracks is not None and found.orders is not None
    tracks, chart = found.transient.tracks, found.orders
    assert tracks.orders == chart.orders
    shape = tracks.torques.shape[1:]
    steady = np.array(
        [[np.interp(tracks.speeds, chart.speeds, chart.torques[:, k, n]) for n in range(shape[1])] for k in range(shape[0])]
    )
    off = np.abs(tracks.torques - np.moveaxis(steady, -1, 0)).max(axis=0)
    return found, off / steady.max(axis=-1)


@pytest.mark.long
def test_order_tracks_of_slower_and_slower_run_ups_become_the_steady_chart() -> None:
    """The error at a resonance halves with the sweep rate, to below 10 % of its height at 100 rpm/s; elsewhere it is 1 %."""
    train = chain(TORQUE, TorqueExcitation(name="other", inertia="c", order=0.5, amplitude=4.0), masses=3)
    offs = [run_up(train, duration, 4400.0)[1] for duration in (10.0, 20.0, 40.0)]
    second = [float(off[1].max()) for off in offs]
    assert 1.4 < second[0] / second[1] < 2.2
    assert 1.6 < second[1] / second[2] < 2.2
    assert second[2] < 0.1
    assert float(offs[2][0].max()) < 0.015


def test_a_spectrogram_has_its_ridges_on_the_orders() -> None:
    """At each speed the greatest amplitude is at 2 n/60 Hz, and as high as the chart has it away from resonances."""
    found, _ = run_up(chain(TORQUE), 20.0, 1800.0)
    assert found.transient is not None and found.transient.tracks is not None and found.orders is not None
    tracks, chart = found.transient.tracks, found.orders
    ridge = tracks.frequency[tracks.torque_map[:, :, 0].argmax(axis=1)]
    np.testing.assert_allclose(ridge, 2 * tracks.map_speeds / 60, atol=1.6 * float(tracks.frequency[1]))
    steady = np.interp(tracks.map_speeds, chart.speeds, chart.torques[:, 0, 0])
    np.testing.assert_allclose(tracks.torque_map[:, :, 0].max(axis=1), steady, rtol=0.2)


def test_order_tracks_of_teeth_and_torques_against_the_chart() -> None:
    """A slow run-up of the geared drive below its resonances of the teeth: force of the mesh and torques of both shafts."""
    options = DynamicsOptions(
        speeds=60,
        speed_from=800.0,
        speed_to=1500.0,
        transient=TransientOptions(
            speed_from=900.0, speed_to=1400.0, duration=6.0, order_tracks="on", sampling=6000.0, orders=(18.0,)
        ),
    )
    found = study_train(drive(ON_MOTOR, ON_LOAD), options)
    assert found.transient is not None and found.transient.tracks is not None and found.orders is not None
    tracks, chart = found.transient.tracks, found.orders
    assert [(each.order, each.source) for each in chart.orders] == [
        (1.5, "load"), (2.0, "ripple"), (18.0, ""), (20.0, "z"), (40.0, "z")
    ]  # fmt: skip
    for values, steady in ((tracks.forces, chart.forces), (tracks.torques, chart.torques)):
        for order in range(4):
            for member in range(values.shape[2]):
                expected = np.interp(tracks.speeds, chart.speeds, steady[:, order, member])
                off = np.abs(values[:, order, member] - expected).max()
                assert off < 0.02 * steady[:, [0, 1, 3], member].max(), (order, member)


def test_a_run_without_tracks_says_why() -> None:
    for options, why in (
        ({"speed_from": 900.0}, "does not change"),
        ({"speed_from": -100.0, "speed_to": 900.0}, "turns back"),
        ({"speed_from": 100.0, "speed_to": 900.0, "duration": 0.1}, "too short"),
    ):
        run = in_time(chain(TORQUE), TransientOptions(order_tracks="on", **options), 900.0)
        assert run.tracks is None
        assert any(why in notice.text for notice in run.notices if notice.code == "no-order-tracks")
    with pytest.raises(ParameterError, match="order_tracks"):
        TransientOptions(orders=(1.0,))


def test_orders_that_do_not_come_again_with_the_period_are_none_of_the_steady_motion() -> None:
    train = chain(TORQUE)
    excitation = Excitation(meshes=(), torques=train_torques(train))
    orders = speed_orders(train, excitation, (0.7,))
    assert orders == (SpeedOrder(0.7, ""), SpeedOrder(2.0, "firing"))
    chart = order_chart(train, system(train), excitation, np.linspace(500, 900, 5), orders)
    assert not chart.torques[:, 0].any() and chart.torques[:, 1].all()


def test_an_uneven_turn_and_what_a_model_leaves_out_are_told() -> None:
    """T/(o J) swings the speed w by T/(o J w): more than a tenth of it below sqrt(10 T/(o J))."""
    found = study_torques(chain(TORQUE), DynamicsOptions(speed_from=10.0, speed_to=900.0, speeds=20))
    limit = math.sqrt(10 * 10 / (2 * 0.4)) * 30 / math.pi
    assert any(notice.code == "uneven-turn" and f"{limit:.5g} rpm" in notice.text for notice in found.notices)
    isolated = study_train(
        replace(drive(ON_MOTOR), model="isolated"), DynamicsOptions(speeds=10, speed_to=900.0, speed_from=500.0)
    )
    assert any(notice.code == "torque-left-out" and notice.where == "ripple" for notice in isolated.notices)
