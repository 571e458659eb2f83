"""Inputs of the pair models, their spectra, and the pictures of a Campbell study."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.pairs import thesis_model

from gearcad import Gear, GearPair, GeometryError, ParameterError
from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.dynamics.time_domain.contact_model import EngagedPairs, disc_inertia
from gearcad.dynamics.time_domain.spectra import amplitude_spectrum
from gearcad.dynamics.time_domain.time_history import CampbellStudy, time_history

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
