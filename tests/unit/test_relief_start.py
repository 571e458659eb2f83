"""The contact where a linear relief starts: a closed form, contacts of any convex gap, and which places are beside a start."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from gearcad import FlankModification, Gear
from gearcad.contact.shared.line_of_action import TransverseFlank
from gearcad.contact.shared.local_contact import GapCurve, onsets, press, rounded_kink_pressure, start_distance

Floats = NDArray[np.float64]

STEEL = 113187.0
"""Reduced modulus of two steel bodies (MPa)."""

PRINTED = 0.002
"""Relative: pressures by another program (a linear complementarity problem of 2,000 cells), rounded to a MPa."""

TABLE = [
    (300, 8, 0.01, 0.2, 1370),
    (300, 8, 0.01, 0.1, 1490),
    (300, 8, 0.01, 0.05, 1613),
    (300, 8, 0.01, 0.025, 1737),
    (300, 8, 0.02, 0.2, 1556),
    (300, 8, 0.02, 0.1, 1790),
    (300, 8, 0.02, 0.05, 2036),
    (300, 8, 0.02, 0.025, 2285),
    (300, 8, 0.036, 0.2, 1815),
    (300, 8, 0.036, 0.1, 2221),
    (300, 8, 0.036, 0.05, 2660),
    (300, 8, 0.036, 0.025, 3106),
    (500, 12, 0.02, 0.2, 1774),
    (500, 12, 0.02, 0.1, 2018),
    (500, 12, 0.02, 0.05, 2266),
    (500, 12, 0.02, 0.025, 2516),
    (300, 5, 0.03, 0.2, 1945),
    (300, 5, 0.03, 0.1, 2276),
    (300, 5, 0.03, 0.05, 2640),
    (300, 5, 0.03, 0.025, 3013),
]
"""Load (N/mm), reduced radius (mm), slope behind the kink, length of its rounding (mm), greatest pressure (MPa)."""


@pytest.mark.parametrize(("load", "radius", "slope", "length", "expected"), TABLE)
def test_greatest_pressure_over_a_rounded_kink(
    load: float, radius: float, slope: float, length: float, expected: float
) -> None:
    closed = rounded_kink_pressure(load, radius, slope, length, STEEL)
    assert closed == pytest.approx(expected, rel=PRINTED)
    nominal = np.linspace(-0.3, radius * slope + 0.3, 241)[:, None]
    loads, start = np.full(len(nominal), load), (np.zeros(len(nominal)), np.full(len(nominal), 0.2))
    found = press(lambda place: rounded(place, nominal, radius, slope, length), loads, STEEL, start, length)
    assert found.resolved.all()
    assert float(found.peaks.max()) == pytest.approx(closed, rel=1e-3)


def rounded(place: Floats, nominal: Floats, radius: float, slope: float, length: float) -> GapCurve:
    """Return the gap of a cylinder that would touch `nominal` behind a kink, which a parabola rounds."""
    past = np.clip(place + nominal + length / 2, 0, length)
    beyond = np.maximum(place + nominal - length / 2, 0)
    inside = (past > 0) & (past < length)
    return GapCurve(
        place**2 / (2 * radius) + slope * (past**2 / (2 * length) + beyond),
        place / radius + slope * past / length,
        1 / radius + slope / length * inside,
    )


def test_closed_forms_at_their_limits() -> None:
    """A wide rounding, a kink that is none (Hertz), and one as long as the contact, of which all is a smaller cylinder."""
    assert rounded_kink_pressure(300, 8, 0.036, 0.4, STEEL) == pytest.approx(1524.4, rel=1e-3)
    hertz = math.sqrt(300 * STEEL / (math.pi * 8))
    assert rounded_kink_pressure(300, 8, 1e-9, 0.1, STEEL) == pytest.approx(hertz, rel=1e-4)
    within = math.sqrt(300 * STEEL / math.pi * (1 / 8 + 0.036 / 0.6))
    assert rounded_kink_pressure(300, 8, 0.036, 0.6, STEEL) == pytest.approx(within, rel=1e-4)


def test_a_short_rounding_adds_as_much_with_each_halving() -> None:
    """12,500 D MPa in steel: the logarithm of a sharp kink, E* D ln 2/(2 pi)."""
    short, half = (rounded_kink_pressure(300, 8, 0.02, length, STEEL) for length in (0.02, 0.01))
    assert half - short == pytest.approx(STEEL * 0.02 * math.log(2) / (2 * math.pi), rel=0.01)


def test_a_contact_away_from_the_kink_is_that_of_a_cylinder() -> None:
    """Hertz's half width, pressure and own distance, and the place: R D back from where the exact cylinder would touch."""
    nominal = np.array([[-1.0], [1.0]])
    found = press(
        lambda place: rounded(place, nominal, 8.0, 0.036, 0.1), np.full(2, 300.0), STEEL, (np.zeros(2), np.full(2, 0.2)), 0.1
    )
    half = math.sqrt(4 * 300 * 8 / (math.pi * STEEL))
    assert found.half_widths == pytest.approx(half, rel=1e-9)
    assert found.peaks == pytest.approx(2 * 300 / (math.pi * half), rel=1e-6)
    assert found.own == pytest.approx(math.exp(-0.5) / 2 * half, rel=1e-6)
    assert found.middle == pytest.approx([0.0, -8 * 0.036], abs=1e-9)
    assert found.least == pytest.approx([0.0, 0.036 * 1.0 - 8 * 0.036**2 / 2], abs=1e-9)


def test_a_transition_too_short_for_the_places_is_not_resolved() -> None:
    nominal = np.array([[0.1]])
    found = press(
        lambda place: rounded(place, nominal, 8.0, 0.036, 1e-5), np.array([300.0]), STEEL, (np.zeros(1), np.ones(1)), 1e-5
    )
    assert not found.resolved.any()


@pytest.mark.parametrize(("relief", "sense"), [("tip_relief", 1), ("root_relief", -1)])
def test_contacts_beside_a_start(relief: str, sense: int) -> None:
    """Slope and length along the tangent, by r_b/rho; from half a transition before the onset to R D and half behind it."""
    gear = Gear(teeth=23, normal_module=2.5, face_width=16.0, profile_shift=0.2)
    amounts = {relief: 18.0, f"{relief}_length": 2.0, f"{relief}_transition": 0.3}
    form = replace(gear, modification=FlankModification(**amounts)).flank_form  # type: ignore[arg-type]
    (onset,) = onsets(TransverseFlank(form, 8.0))
    assert onset.roll == pytest.approx(form.last - 2.0 if sense > 0 else form.first + 2.0)
    stretch = form.base_radius / onset.roll
    assert onset[1:] == pytest.approx((0.3 / stretch, 0.009 * stretch, sense))
    along = np.array([-0.5, 0.1, 0.5])  # mm along the tangent towards the relief
    lengths = np.sqrt(onset.roll**2 + 2 * form.base_radius * sense * along)
    shift, half = 8 * onset.slope, onset.length / 2
    expected = [0.5 - half, max(-0.1, 0.1 - shift) - half, 0.5 - shift - half]
    assert start_distance(form.base_radius, onset, lengths, 8.0) == pytest.approx(expected, abs=1e-9)
