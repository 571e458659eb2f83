"""Pair models of J. Uhlir's thesis (CTU in Prague), and gears that travel as well as turn, against Newton's equations."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from support.published import Published
from support.responses import FreeBodies, Period, cosine
from support.trains import THESIS_SPEEDS, Witness, thesis_model, thesis_pair

from gearcad.core.records import Floats
from gearcad.dynamics.response.kv_chart import KvChart, kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.dynamics.time_domain.contact_model import EngagedPairs
from gearcad.dynamics.time_domain.time_history import CampbellStudy, PairStart, time_history
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings

DIGITS = 1e-7
"""Relative, for recomputed numbers with eight digits."""

PEAKS = {
    6000: ((1900, 21.0), (621, 4.15), (3800, 1.88), (5700, 1.73)),
    10000: ((3167, 9.76), (613, 3.16), (6333, 0.985)),
    20000: ((6333, 4.79), (612, 3.16)),
}
"""Recomputed: frequency (Hz) and amplitude (rad/s) of the pinion's speed over 1 s from y = 0."""

PEAK = 0.01
CHAOTIC = (1000, 2000, 3500, 4000)

DOP853 = 1e-9
"""Of the amplitude: found were 4e-12 to 1.2e-10, DOP853 itself having rtol 1e-10."""


@pytest.fixture(scope="module")
def study() -> CampbellStudy:
    return campbell(thesis_model(), THESIS_SPEEDS)


# ---------------------------------------------------------------------- parameters, simple model


def test_parameters_of_table_3_1(published: Published) -> None:
    model = thesis_model()
    assert model.inertias == pytest.approx((1.7399409e-05, 3.7362114e-05), rel=DIGITS)
    assert model.base_radii[0] == pytest.approx(15.6224, rel=5e-6)
    assert model.base_pitch == pytest.approx(5.16623, rel=1e-6)
    assert model.contact_ratio == pytest.approx(1.567673, rel=4e-7)
    assert model.static_approach == pytest.approx(1600.267, rel=4e-7)
    published(
        "natural frequency, Hz", model.natural_frequency(), "489", 0.5, "Uhlir, bachelor's thesis, CTU Prague 2021, chapter 3"
    )
    assert model.natural_frequency() == pytest.approx(488.98723, rel=1e-8)
    assert model.damping_ratio == pytest.approx(0.01536199, abs=5e-9)
    assert model.natural_frequency(model.contact_ratio) == pytest.approx(612.25, abs=0.005)
    assert model.tooth_frequency(1000) == pytest.approx(316.67, abs=0.005)  # (3.56)


def test_simple_model_is_the_matrix_exponential_of_its_equations() -> None:
    """M phi'' + R (b phi' + k phi) = F, (3.14), where R has R_b1 R_b2 with a plus: both angles are counter-clockwise."""
    model, speed, duration = replace(thesis_model(), zone=EngagedPairs.ONE_PAIR), 20000.0, 0.02
    radii, inverse = 1e-3 * np.array(model.base_radii), np.diag(1 / np.array(model.inertias))
    coupling = inverse @ np.outer(radii, radii)
    matrix = np.zeros((5, 5))
    matrix[:2, 2:4] = np.eye(2)
    matrix[2:4, :2], matrix[2:4, 2:4] = -4e5 * coupling, -4 * coupling
    matrix[2:4, 4] = inverse @ [10, 10 * 23 / 19]
    rate = speed * math.pi / 30
    start = np.array([0, 0, rate, -rate * 19 / 23, 1])
    history = time_history(model, speed, duration=duration, sampling=1000.0)
    found = np.column_stack(
        [np.radians(history.pinion_angle), np.radians(history.wheel_angle), history.pinion_speed, history.wheel_speed]
    )
    expected = [(expm(matrix * time) @ start)[:4] for time in history.time]
    np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12)


# ---------------------------------------------------------------------- contact model


@pytest.mark.parametrize("speed", PEAKS)
def test_peaks_of_the_contact_model(study: CampbellStudy, speed: int) -> None:
    found = {round(peak.frequency): peak.amplitude for peak in study.peaks(speed, 12)}
    for frequency, amplitude in PEAKS[speed]:
        assert found[frequency] == pytest.approx(amplitude, rel=PEAK)


def test_high_speed_leaves_the_frequency_of_the_mean_stiffness(study: CampbellStudy) -> None:
    for speed in (16000, 18000, 20000):
        free = max((peak for peak in study.peaks(speed) if peak.frequency < 1000), key=lambda peak: peak.amplitude)
        assert free.frequency == pytest.approx(612.25, abs=1.0)  # lines of a spectrum of 1 s


def test_chaotic_speeds_and_no_others_are_flagged(study: CampbellStudy) -> None:
    assert tuple(study.speeds[study.chaotic]) == CHAOTIC
    # Nothing is near the limit of 6 digits: a hundred starts, 1e-9 µm apart, lost 13.9 and more at each chaotic speed.
    assert study.digits_lost[~study.chaotic].max() < 3.5
    assert study.digits_lost[study.chaotic].min() > 10
    # Where it settles, a disturbance dies with b/(2 m).
    model = thesis_model()
    decay = model.damping / (2 * model.reduced_mass)
    assert study.growth[~study.chaotic] == pytest.approx(-decay, rel=0.07)
    assert study.growth[study.speeds == 1000] > 0.2 * decay  # 42 to 120 1/s from those starts


@pytest.mark.parametrize(("speed", "apart"), [(3000, False), (6000, False), (1000, True), (3500, True)])
def test_two_motions_from_almost_one_start(speed: float, apart: bool) -> None:
    """What the flag says, without it: 1e-9 of the static approach apart at the start, and in the last tenth of a second.

    With the same place of contact the rotation differs by as much, for ever: the calm motions stay so little apart.
    """
    model = thesis_model()
    there, beside = (
        time_history(model, speed, start=PairStart(approach=approach * model.static_approach)).approach[-20000:]
        for approach in (0.5, 0.5 + 1e-9)
    )
    difference = np.abs(there - beside).max() / np.ptp(there)
    assert difference > 0.3 if apart else difference < 1e-8


def test_statistics_at_a_chaotic_speed_hold_where_the_motion_does_not() -> None:
    """Tolerances are five times the scatter that 40 such runs have."""
    model = thesis_model()
    starts = (PairStart(), PairStart(approach=1e-3))
    one, other = (time_history(model, 1000.0, duration=40.0, sampling=5000.0, start=start) for start in starts)
    assert np.abs(one.approach - other.approach).max() > 0.5 * np.ptp(one.approach)
    assert np.std(one.settled) == pytest.approx(np.std(other.settled), rel=0.07)
    assert one.out_of_contact == pytest.approx(other.out_of_contact, abs=0.025)


def test_warnings_name_the_penetration_and_the_chaos(study: CampbellStudy) -> None:
    soft, deep, chaotic = study.warnings
    assert "0.4 N/µm" in soft and "1.6 mm" in soft
    assert "more than the module of 1.75 mm" in deep and "3500 rpm" in deep
    assert "1000, 2000, 3500, 4000 rpm" in chaotic
    assert replace(thesis_model(), pair_stiffness=0.3).notices[0].text.count("pass through each other") == 1
    assert replace(thesis_model(), pair_stiffness=200.0).notices == ()


@pytest.mark.parametrize(
    ("changes", "frequency"),
    [
        # A small amplitude about y (eps - y/p_b) = F/k would have 513.8 Hz.
        ({"zone": EngagedPairs.PENETRATING_TIPS}, 512),
        ({"zone": EngagedPairs.PENETRATING_TIPS, "first_contact": 0.0, "last_contact": 12.56924}, 719),
        ({"zone": EngagedPairs.ONE_PAIR}, 489),
    ],
)
def test_other_readings_of_the_zone_do_not_give_302_hz(changes: dict[str, object], frequency: float) -> None:
    """Recomputed; the second lets the whole line T1T2 carry. RK4 at 16 MHz has 512 Hz for the first, at 200 kHz 500."""
    peaks = campbell(replace(thesis_model(), **changes), [20000.0]).peaks(20000)
    assert max((peak for peak in peaks if peak.frequency < 1000), key=lambda peak: peak.amplitude).frequency == frequency


# ---------------------------------------------------------------------- DOP853


def _compare(model_changes: dict[str, object], speed: float, duration: float, sampling: float, limit: float) -> None:
    back = bool(model_changes.get("back_flanks"))
    pair = thesis_pair(tooth_thinning=0.6) if back else thesis_pair()
    model = thesis_model(pair, **model_changes)
    history = time_history(model, speed, duration=duration, sampling=sampling)
    expected = Witness(model).run(speed, duration, len(history.approach))
    approach = 1e6 * (expected[0] + expected[1])
    assert np.abs(history.approach - approach).max() < limit * np.ptp(approach)
    rotation = speed * math.pi / 30
    pinion = expected[2] / (1e-3 * model.base_radii[0])
    assert np.abs(history.pinion_speed - pinion).max() < limit * np.abs(pinion - rotation).max()
    if back:
        assert history.approach.min() < -1e3 * model.backlash < 0
    wheel = expected[3] / (1e-3 * model.base_radii[1])
    assert np.abs(history.wheel_speed - wheel).max() < limit * np.abs(pinion - rotation).max()


@pytest.mark.parametrize(("speed", "duration"), [(6000.0, 0.03), (1500.0, 0.02), (3000.0, 0.02)])
def test_motion_is_that_of_dop853(speed: float, duration: float) -> None:
    """Contact is lost at 1500 rpm."""
    _compare({}, speed, duration, 50_000.0, DOP853)


def test_motion_between_both_flanks_is_that_of_dop853() -> None:
    _compare({"back_flanks": True}, 3500.0, 0.01, 50_000.0, DOP853)


@pytest.mark.long
@pytest.mark.parametrize("speed", [3000.0, 6000.0, 20000.0])
def test_a_whole_second_is_that_of_dop853(speed: float) -> None:
    _compare({}, speed, 1.0, 200_000.0, DOP853)


def test_back_flanks_touch_where_the_profile_has_them() -> None:
    """A tooth of the pinion on the line of centres: its flanks are the same distance from their base tangent points."""
    pair = thesis_pair(tooth_thinning=0.3)
    model = thesis_model(pair, back_flanks=True)
    assert model.back_place is not None and model.backlash == pytest.approx(pair.normal_backlash)
    place, radius = model.back_place / 2, pair.pinion.base_diameter / 2
    # The point of the line of action so far from T1, seen from the axis: its angle from the line of centres.
    angle = math.degrees(math.atan(place / radius)) - pair.working_transverse_pressure_angle
    assert angle == pytest.approx(float(pair.pinion.profile.half_angle(math.hypot(radius, place))), abs=1e-10)


PAIR = PairOnBearings(
    masses=(0.8, 3.1),
    inertias=(4e-4, 7e-3),
    base_radii=(28.0, 66.0),
    working_transverse_pressure_angle=21.5,
    mesh_stiffness=240.0,
    bearing_stiffness=((300.0, 120.0), (450.0, 900.0)),
    torque=80.0,
    mesh_damping=900.0,
    bearing_damping=150.0,
)
RING = replace(PAIR, base_radii=(28.0, -66.0), bearing_stiffness=((500.0, 700.0), (200.0, 90.0)))
VARIATION = 0.3

SAMPLED = 1e-4
"""Relative: how far greatest values of some hundred samples a period are off those of others."""


def half_range(course: Floats) -> float:
    return float(np.ptp(course)) / 2


def same(chart: KvChart, row: int, expected: Period, pair: PairOnBearings, tolerance: float) -> None:
    """All that a chart tells of one speed."""
    force = pair.torque / (pair.base_radii[0] / 1000)
    assert chart.factors[row, 0] * force == pytest.approx(expected.spring.max(), rel=tolerance)
    assert chart.damped[row, 0] * force == pytest.approx(expected.force.max(), rel=tolerance)
    assert chart.least[row, 0] * force == pytest.approx(expected.spring.min(), rel=tolerance, abs=tolerance * force)
    moved = chart.displacements
    assert moved.approaches[row, 0] == pytest.approx(1e6 * half_range(expected.approach), rel=tolerance)
    assert moved.deepest[row, 0] == pytest.approx(1e6 * expected.approach.max(), rel=tolerance)
    turns = [3600 * np.degrees(half_range(turn)) for turn in expected.turns]
    assert moved.turns[row] == pytest.approx(turns, rel=tolerance)
    assert np.isnan(moved.farthest[row]).all()  # free to turn
    loads = chart.bearings
    assert loads is not None and loads.static == pytest.approx(force)
    along = np.array([np.sin(a := np.radians(pair.working_transverse_pressure_angle)), np.cos(a)])
    for gear, (sense, on) in enumerate(zip((-1, 1), expected.bearings, strict=True)):
        assert loads.greatest[row, gear] == pytest.approx(np.hypot(*on).max(), rel=tolerance)
        line = sense * along @ on
        assert loads.along[row, :, gear] == pytest.approx([line.max(), line.min()], rel=tolerance, abs=tolerance * force)
        across = np.array([along[1], -along[0]]) @ on
        assert loads.across[row, :, gear] == pytest.approx([across.max(), across.min()], abs=tolerance * force)


@pytest.mark.parametrize("pair", [PAIR, RING], ids=["wheel", "ring"])
def test_flanks_in_contact(pair: PairOnBearings) -> None:
    frequencies = [4000.0, 9000.0, 16400.0, 26000.0]
    chart = kv_chart(periodic_response(pair.system(), cosine(VARIATION), frequencies, harmonics=40))
    for row, frequency in enumerate(frequencies):
        same(chart, row, FreeBodies(pair, frequency, VARIATION).periodic(), pair, SAMPLED)


@pytest.mark.long
@pytest.mark.parametrize(
    ("mesh_damping", "backlash", "frequency"), [(600.0, np.inf, 31000.0), (400.0, 8.0, 30500.0)], ids=["parted", "at the back"]
)
def test_flanks_that_part(mesh_damping: float, backlash: float, frequency: float) -> None:
    """Between the jumps, where running up and down show the same, from rest; with 8 µm the flanks at the back meet too."""
    pair = replace(PAIR, mesh_damping=mesh_damping, bearing_damping=2000.0)
    over = over_speed(pair.system(), cosine(VARIATION, backlash=backlash), np.linspace(10500.0, 31500.0, 43))
    expected = FreeBodies(pair, frequency, VARIATION, backlash * 1e-6).settled(120)
    assert over.down is not None
    for chart in (over.up, over.down):
        row = int(np.flatnonzero(chart.frequencies == frequency)[0])
        assert chart.least[row, 0] <= 0
        same(chart, row, expected, pair, SAMPLED)
