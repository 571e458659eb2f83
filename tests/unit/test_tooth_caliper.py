"""The chord that a tooth caliper reads: that of the outline, and the chordal thickness of ISO 21771 at its own height."""

from __future__ import annotations

import math

import pytest

from gearcad import Gear, GeometryError
from gearcad.geometry.inspection import chord_below_tip

EXACT = 1e-10
"""mm: rounding, and the tolerance of the root."""

SPUR = Gear(teeth=23, normal_module=3, face_width=20, profile_shift=0.3, tooth_thinning=0.07)
HELICAL = Gear(teeth=31, normal_module=2.5, face_width=20, helix_angle=17.0, profile_shift=0.21)


@pytest.mark.parametrize("diameter", [70.0, 72.0, 75.0])
def test_chord_of_a_spur_gear_is_that_of_its_outline(diameter: float) -> None:
    half = math.radians(float(SPUR.profile.half_angle(diameter / 2)))
    height = (SPUR.tip_diameter - diameter * math.cos(half)) / 2
    found = chord_below_tip(SPUR.inspection, SPUR.inspection.addendum, height)
    assert found == pytest.approx((diameter * math.sin(half), diameter), abs=EXACT)


@pytest.mark.parametrize("gear", [SPUR, HELICAL])
def test_at_the_chordal_height_it_is_the_chordal_thickness(gear: Gear) -> None:
    chord = gear.inspection.chordal_thickness
    found = chord_below_tip(gear.inspection, gear.inspection.addendum, chord.height)
    assert found == pytest.approx((chord.thickness, gear.reference_diameter), abs=EXACT)


def test_where_no_involute_is_nothing_is_measured() -> None:
    for height in (0.001, 9.0):
        with pytest.raises(GeometryError, match=r"^height = \S+ mm: must be between \S+ and \S+ mm, where the involute is$"):
            chord_below_tip(SPUR.inspection, SPUR.inspection.addendum, height)
