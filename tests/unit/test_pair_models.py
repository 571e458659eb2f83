"""Pair models: inputs, spectra, and Campbell diagrams by integration against springs solved from event to event."""

import json
import math
import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.trains import thesis_model

from gearcad import Gear, GearPair, GeometryError, ParameterError
from gearcad.core.errors import SolverError
from gearcad.core.records import PerGear
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.time_domain.campbell import campbell, mesh_campbell
from gearcad.dynamics.time_domain.contact_model import ContactModel, EngagedPairs, disc_inertia
from gearcad.dynamics.time_domain.spectra import MeshCampbell, amplitude_spectrum
from gearcad.dynamics.time_domain.time_history import CampbellStudy, time_history
from gearcad.dynamics.trains.members import Inertia, ToothMesh
from gearcad.dynamics.trains.mesh_excitation import (
    CosineStiffness,
    CurveStiffness,
    Excitation,
    MeshExcitation,
    StiffnessShape,
    square_stiffness,
)
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.train import Train

ROUNDING = 1e-13


@pytest.fixture(scope="module")
def study() -> CampbellStudy:
    return campbell(thesis_model(), [0.0, 3500.0, 6000.0], duration=0.2, sampling=50_000.0)


# ---------------------------------------------------------------------- inputs


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pair_stiffness": -0.4}, "pair_stiffness = -0.4 N/µm: must be a number above 0 N/µm"),
        ({"inertias": (0.0, 1e-5)}, "inertias[0] = 0 kg·m²: must be a number above 0 kg·m²"),
        ({"inertias": (1e-5,)}, "inertias = (1e-05,): must be two numbers, of pinion and wheel"),
        ({"damping": -4.0}, "damping = -4 N·s/m: must be a number at least 0 N·s/m"),
        ({"damping": math.nan}, "damping = nan N·s/m: must be a number at least 0 N·s/m"),
        ({"torque": 0.0}, "torque = 0 N·m: must be a number above 0 N·m"),
        ({"teeth": (19, 23.5)}, "teeth[1] = 23.5: must be a whole number from 1 to 10000"),
        ({"first_contact": 11.0}, "last_contact = "),
        ({"backlash": 0.1}, "backlash = 0.1: must be given together with back_place"),
        ({"zone": "none"}, "zone = 'none': must be one of 'rigid tips', 'penetrating tips', 'one pair'"),
    ],
)
def test_model_names_what_is_wrong(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        replace(thesis_model(), **changes)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("speeds", "options", "message"),
    [
        ([], {}, "speeds = [] rpm: must be at least one speed"),
        ([500.0, 500.0], {}, "speeds[1] = 500 rpm: must be above 500 rpm: speeds rise"),
        ([-1.0], {}, "speeds[0] = -1 rpm: must be a number at least 0 rpm"),
        ([1.0], {"duration": 1e-6}, "duration = 1e-06 s: must give between 2 and 100000000 samples at 200000 Hz"),
        ([1.0], {"sampling": 0.0}, "sampling = 0 Hz: must be a number above 0 Hz"),
    ],
)
def test_study_names_what_is_wrong(speeds: list[float], options: dict[str, float], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        campbell(thesis_model(), speeds, **options)
    assert str(caught.value) == message


def test_helical_pairs_are_refused() -> None:
    pinion, wheel = (
        Gear(teeth=z, normal_module=2.0, face_width=20.0, helix_angle=beta) for z, beta in ((19, 15.0), (23, -15.0))
    )
    with pytest.raises(GeometryError, match=r"pinion.helix_angle = 15 deg: must be 0"):
        thesis_model(GearPair(pinion=pinion, wheel=wheel))


def test_disc_inertia() -> None:
    """J = m r²/2."""
    radius, width, density = 0.05, 0.02, 7850.0
    mass = math.pi * radius**2 * width * density
    assert disc_inertia(100.0, 20.0, density) == pytest.approx(mass * radius**2 / 2, rel=ROUNDING)


def test_contact_ratio_below_one_warns_and_runs() -> None:
    """Between two pairs nothing resists: the flanks still come together, and all numbers are finite."""
    model = replace(thesis_model(), last_contact=6.0)
    assert model.contact_ratio < 1
    assert any("below 1" in notice.text for notice in model.notices)
    assert np.isfinite(time_history(model, 6000.0, duration=0.05).approach).all()


def test_import_leaves_numba_alone() -> None:
    heavy = ("numba", "scipy", "matplotlib")
    code = f"import sys, gearcad.dynamics.time_domain.campbell; print([name for name in {heavy!r} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"


# ---------------------------------------------------------------------- spectra


@pytest.mark.parametrize("n", [1000, 1001])
def test_a_sine_shows_its_amplitude(n: int) -> None:
    sampling = 10.0 * n
    time = np.arange(n) / sampling
    spectrum = amplitude_spectrum(
        5e6 + 3 * np.sin(2 * np.pi * 400 * time + 0.3) + 0.5 * np.cos(2 * np.pi * 1200 * time), sampling
    )
    expected = np.zeros(n // 2 + 1)
    expected[[0, 40, 120]] = 5e6, 3, 0.5
    np.testing.assert_allclose(spectrum.amplitude, expected, rtol=1e-9, atol=1e-9)
    assert spectrum.frequency[40] == pytest.approx(400)
    peaks = spectrum.peaks(2)
    assert [peak.frequency for peak in peaks] == pytest.approx([400, 1200])
    assert [peak.amplitude for peak in peaks] == pytest.approx([3, 0.5])


def test_half_the_sampling_frequency_is_not_doubled() -> None:
    spectrum = amplitude_spectrum(2.0 * (-1.0) ** np.arange(100), 100.0)
    assert spectrum.amplitude[-1] == pytest.approx(2, rel=ROUNDING)


def test_the_end_of_a_spectrum_is_the_frequency_asked_for() -> None:
    signal = np.random.default_rng(1).normal(size=2000)
    whole, part = amplitude_spectrum(signal, 1000.0), amplitude_spectrum(signal, 1000.0, 100.0)
    assert part.frequency[-1] == 100
    np.testing.assert_array_equal(part.amplitude, whole.amplitude[: len(part.amplitude)])


def test_mean_square_is_that_of_the_spectrum() -> None:
    """Parseval."""
    signal = np.random.default_rng(2).normal(size=1001)
    amplitude = amplitude_spectrum(signal, 1.0).amplitude
    assert amplitude[0] ** 2 + (amplitude[1:] ** 2).sum() / 2 == pytest.approx((signal**2).mean(), rel=ROUNDING)


# ---------------------------------------------------------------------- study


def test_a_study_is_its_motions(study: CampbellStudy) -> None:
    motion = time_history(study.model, 6000.0, duration=0.2, sampling=50_000.0)
    np.testing.assert_array_equal(study.pinion_speed[2], motion.spectrum(15000.0).amplitude)
    np.testing.assert_array_equal(study.frequency, motion.spectrum(15000.0).frequency)
    assert study.greatest_approach[2] == motion.approach[5000:].max()
    assert study.pinion_speed[2, 0] == pytest.approx(6000 * math.pi / 30, rel=1e-2)
    again = campbell(study.model, study.speeds, duration=0.2, sampling=50_000.0)
    np.testing.assert_array_equal(again.approach, study.approach)


def test_a_study_becomes_json(study: CampbellStudy) -> None:
    document = json.loads(json.dumps(study.to_dict()))
    assert document["speeds"] == [0, 3500, 6000]
    assert document["chaotic"] == [False, True, False]
    assert document["natural_frequencies"] == pytest.approx({"one pair": 488.98723, "mean stiffness": 612.24509})
    assert document["peaks"][2][0][0] == pytest.approx(1900, abs=5)


def test_a_study_names_a_speed_it_does_not_have(study: CampbellStudy) -> None:
    with pytest.raises(ParameterError, match=r"speed = 7000 rpm: must be one of the study's speeds"):
        study.spectrum(7000)


@pytest.mark.parametrize("speed", [0.0, 10.0])
def test_stiff_teeth_that_settle_long_before_the_end(speed: float) -> None:
    """A disturbance falls below the least number that a double can hold, and its growth is known all the same."""
    model = replace(thesis_model(), pair_stiffness=200.0, damping=1000.0, zone=EngagedPairs.ONE_PAIR)
    history = time_history(model, speed, duration=2.0, sampling=1000.0)
    decay = model.damping / (2 * model.reduced_mass)
    assert decay * 1.0 > 10_000
    assert history.growth == pytest.approx(-decay, rel=1e-3)
    assert history.approach[-1] == pytest.approx(model.static_approach, rel=ROUNDING)
    assert not history.chaotic


def test_at_rest_the_pair_settles_at_the_static_approach() -> None:
    model = replace(thesis_model(), zone=EngagedPairs.ONE_PAIR)
    history = time_history(model, 0.0, duration=0.6)
    decay = math.exp(-model.damping / (2 * model.reduced_mass) * 0.6)
    assert history.approach[-1] == pytest.approx(model.static_approach, rel=1.1 * decay)
    assert history.out_of_contact == 0


# ---------------------------------------------------------------------- pictures


def test_campbell_diagram_shows_teeth_natural_frequencies_and_chaos(study: CampbellStudy) -> None:
    from gearcad.plots.motions import plot_campbell

    axes = plot_campbell(study)
    lines = {line.get_label(): line for line in axes.get_lines()}
    assert "natural, one pair: 489.0 Hz" in lines and "natural, mean stiffness: 612.2 Hz" in lines
    assert list(lines["chaotic speed"].get_xdata()) == [3500]
    assert [text.get_text() for text in axes.texts] == list("1234567")
    slopes = [line.get_ydata()[1] / line.get_xdata()[1] for line in axes.get_lines() if len(line.get_xdata()) == 2][:7]
    assert slopes == pytest.approx([harmonic * 19 / 60 for harmonic in range(1, 8)])
    (mesh,) = axes.collections
    values = mesh.get_array()
    assert values.shape[1] == 3 and values.max() == pytest.approx(study.pinion_speed[:, 1:1401].max())


def test_speeds_and_spectrum_of_one_speed() -> None:
    from gearcad.plots.motions import plot_motion, plot_spectrum

    history = time_history(thesis_model(), 6000.0, duration=0.2, sampling=50_000.0)
    whole, close, _, wheel = plot_motion(history).axes
    time = close.get_lines()[0].get_xdata()
    assert time[-1] - time[0] == pytest.approx(6 * 1000 / 1900, abs=0.05)
    assert "1900 Hz" in {text.get_text() for text in plot_spectrum(history).texts}
    np.testing.assert_array_equal(close.get_lines()[0].get_ydata(), history.pinion_speed[-len(time) :])
    np.testing.assert_array_equal(wheel.get_lines()[0].get_ydata(), history.wheel_speed[-len(time) :])
    # 10,000 samples are drawn by the extremes of some at a time: none of these is lost.
    drawn = np.asarray(whole.get_lines()[0].get_ydata(), float)
    assert len(drawn) < 2500 and (drawn.min(), drawn.max()) == (history.pinion_speed.min(), history.pinion_speed.max())


def test_angles_are_those_of_the_speeds() -> None:
    """Of a motion that is seen from its begin: its mesh does not vary."""
    from gearcad.plots.motions import plot_angles

    history = time_history(replace(thesis_model(), zone=EngagedPairs.ONE_PAIR), 6000.0, duration=0.2, sampling=50_000.0)
    above, below = plot_angles(history).axes
    for line, speed in zip(above.get_lines(), (history.pinion_speed, history.wheel_speed), strict=True):
        # The trapezoidal rule over 0.2 s, of vibrations of 489 Hz sampled a hundred times.
        turned = np.degrees(np.trapezoid(speed, history.time))
        assert np.asarray(line.get_ydata(), float)[-1] == pytest.approx(turned, abs=0.02)
    pinion, _ = below.get_lines()
    assert np.asarray(pinion.get_ydata(), float) == pytest.approx(
        history.pinion_angle[: len(pinion.get_xdata())] - 36000 * np.asarray(pinion.get_xdata(), float) / 1000, abs=1e-9
    )
    assert pinion.get_xdata()[-1] == pytest.approx(12 * 1000 / 488.987, abs=0.05)


THESIS = ContactModel(
    teeth=PerGear(19, 23),
    normal_module=1.75,
    base_radii=PerGear(15.6224, 18.9113),
    base_pitch=5.16627,
    first_contact=1.8702,
    last_contact=9.9664,
    inertias=PerGear(1.7399409e-5, 3.7362114e-5),
    pair_stiffness=0.4,
    damping=4.0,
    torque=10.0,
)
"""About the pair of Uhlir's thesis."""

STATISTICS = 5e-3
"""Relative: of means and greatest values, for teeth that move by a hundredth of their base pitch against each other."""

AMPLITUDE = 3e-3
"""Relative, by 80 steps a vibration."""


def as_mesh(of: ContactModel) -> Train:
    first, second = of.base_radii
    mesh = ToothMesh(
        name="mesh",
        pinion="pinion",
        wheel="wheel",
        base_radii=(first, second),
        stiffness=of.pair_stiffness * of.contact_ratio,
        teeth=19,
        damping=of.damping,
        backlash=1e6,
    )
    inertias = tuple(Inertia(name=name, inertia=each) for name, each in zip(("pinion", "wheel"), of.inertias, strict=True))
    return Train(inertias=inertias, meshes=(mesh,), torques={"pinion": of.torque, "wheel": of.torque * second / first})


def spectra(train: Train, shape: StiffnessShape, speeds: list[float], backlash: float | None, **how: float) -> MeshCampbell:
    excitation = Excitation(meshes=(MeshExcitation(stiffness=shape, backlash=backlash),))
    return mesh_campbell(train, system(train), excitation, np.array(speeds), {"mode 2": 9000.0}, **how)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "speeds", [[20000.0, 45000.0], pytest.param([15000.0, 25000.0, 60000.0], marks=pytest.mark.long)], ids=["few", "more"]
)
def test_the_square_wave_is_the_contact_model_of_stiff_teeth(speeds: list[float]) -> None:
    """Teeth a hundred times as stiff as the thesis's: their vibration hardly moves the ends of the zone of contact."""
    stiff = replace(THESIS, pair_stiffness=40.0, damping=40.0)
    how = {"duration": 0.1, "sampling": 1e6}
    found = spectra(as_mesh(stiff), square_stiffness(stiff.contact_ratio), speeds, math.inf, **how)
    expected = campbell(stiff, speeds, highest_frequency=float(found.frequency[-1]), **how)
    assert not found.chaotic.any() and not expected.chaotic.any()
    scale = stiff.static_approach
    for name in ("mean_approach", "greatest_approach"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), atol=STATISTICS * scale, rtol=STATISTICS)
    np.testing.assert_allclose(found.out_of_contact, expected.out_of_contact, atol=2e-3)
    # In 0.05 s a logarithm may be off by 2: sizes are measured wherever a vibration stands.
    np.testing.assert_allclose(found.growth, expected.growth, atol=2 / 0.05)
    for speed in speeds[1:]:
        ours, theirs = found.peaks(speed, 1)[0], expected.peaks(speed, 1)[0]
        assert ours.frequency == pytest.approx(19 * speed / 60, abs=10)
        assert ours == pytest.approx(theirs, rel=0.01)


def test_a_chaotic_speed_is_flagged_and_a_periodic_one_is_not() -> None:
    """3500 rpm of the thesis, chaotic by its contact model as well, and 3000 rpm."""
    found = spectra(
        as_mesh(THESIS), square_stiffness(THESIS.contact_ratio), [3000.0, 3500.0], math.inf, duration=1.0, sampling=2e5
    )
    assert found.chaotic.tolist() == [False, True]
    assert found.growth[1] > 50
    assert found.growth[0] == pytest.approx(-THESIS.damping / (2 * THESIS.reduced_mass), rel=0.02)
    assert found.digits_lost[0] < 1
    (notice,) = found.notices
    assert notice.code == "chaotic" and "3500 rpm" in notice.text


def test_amplitudes_far_from_resonance_are_those_of_harmonic_balance() -> None:
    """A curve as finite elements give it, at speeds whose tooth frequencies are lines of the spectrum."""
    phase = 2 * np.pi * np.array([0, 0.05, 0.4, 0.45, 0.5, 0.9, 1.0])
    shape = CurveStiffness(phase=phase, stiffness=np.array([300, 360, 400, 380, 270, 250, 300.0]))
    train = as_mesh(replace(THESIS, pair_stiffness=200.0, damping=150.0, torque=60.0))
    speeds = [60 / 19 * hertz for hertz in (1000.0, 2500.0, 6000.0)]
    found = spectra(train, shape, speeds, 60.0, duration=0.02, sampling=1e6)
    of, excitation = system(train), Excitation(meshes=(MeshExcitation(stiffness=shape),))
    for row, speed in enumerate(speeds):
        tooth = 19 * speed / 60
        balance = periodic_response(of, excitation, [2 * np.pi * tooth], harmonics=40, stability=False)
        for harmonic in (1, 2, 3):
            place = round(harmonic * tooth / float(found.frequency[1]))
            amplitude = 2e6 * abs(balance.approach_coefficients[0, harmonic, 0])
            assert found.approach[row, place] == pytest.approx(amplitude, rel=AMPLITUDE, abs=2e-4)
            turning = 2 * abs(balance.inertia_coefficients[0, harmonic, 0]) * 2 * np.pi * harmonic * tooth
            assert found.pinion_speed[row, place] == pytest.approx(turning, rel=AMPLITUDE, abs=0.01)
    assert not found.out_of_contact.any()


def test_what_grows_without_bound_is_named_and_left_out() -> None:
    """Flanks that never part, without damping: twice the natural frequency is a parametric resonance."""
    train = as_mesh(replace(THESIS, damping=0.0))
    resonance = THESIS.natural_frequency(THESIS.contact_ratio) * 60 / 19
    shape = CosineStiffness(variation=0.4)
    found = spectra(train, shape, [0.3 * resonance, 2 * resonance], None, duration=2.0, sampling=2e4)
    assert found.unbounded == (2 * resonance,)
    assert found.speeds.tolist() == [0.3 * resonance]
    assert found.notices[-1].code == "unbounded"
    with pytest.raises(SolverError, match="at every speed"):
        spectra(train, shape, [2 * resonance], None, duration=2.0, sampling=2e4)


def test_what_takes_too_long_says_what_would_do() -> None:
    for duration, sampling, words in ((1e-9, 2e5, "at least 2e-05 s"), (1000.0, 2e5, r"at most \d+ s for")):
        with pytest.raises(ParameterError, match=f"duration = .*{words}"):
            spectra(as_mesh(THESIS), square_stiffness(1.5), [1000.0], None, duration=duration, sampling=sampling)
