"""Campbell diagrams by integration: against springs solved from event to event, harmonic balance, and what cannot be run."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad.core.errors import ParameterError, SolverError
from gearcad.core.records import PerGear
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.time_domain.campbell import campbell, mesh_campbell
from gearcad.dynamics.time_domain.contact_model import ContactModel
from gearcad.dynamics.time_domain.spectra import MeshCampbell
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
