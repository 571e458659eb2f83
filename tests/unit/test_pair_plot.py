"""The picture of a pair in mesh: teeth in spaces, circles that touch, a path of contact that lies on both gears."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcad import Body, Gear, GearPair
from gearcad.plots.gears import pair_inches, plot_pair

PAIRS = {
    "spur": GearPair(
        pinion=Gear(teeth=16, normal_module=4.5, face_width=14, profile_shift=0.18, tooth_thinning=0.05, body=Body(bore=30)),
        wheel=Gear(teeth=24, normal_module=4.5, face_width=14, profile_shift=0.17, tooth_thinning=0.05),
    ),
    "helical, odd wheel": GearPair(
        pinion=Gear(teeth=13, normal_module=2.5, face_width=18, helix_angle=28, profile_shift=0.1, tooth_thinning=0.08),
        wheel=Gear(teeth=45, normal_module=2.5, face_width=15, helix_angle=-28, tooth_thinning=0.16),
        axial_offset=1.3,
    ),
}

CHORDS = 0.02
"""mm: what the drawn outlines may be off, chords and rounded-off backlash."""


@pytest.mark.parametrize("name", PAIRS)
def test_teeth_stand_in_spaces(name: str) -> None:
    pair = PAIRS[name]
    axes = plot_pair(pair)
    pinion, wheel = (patch.get_xy()[:-1] for patch in axes.patches if hasattr(patch, "get_xy"))
    assert np.hypot(*pinion.T).max() == pytest.approx(pair.pinion.tip_diameter / 2, rel=1e-12)
    assert np.hypot(wheel[:, 0] - pair.centre_distance, wheel[:, 1]).max() == pytest.approx(
        pair.wheel.tip_diameter / 2, rel=1e-12
    )
    near = wheel[np.hypot(*wheel.T) < pair.pinion.tip_diameter / 2]
    radius, pitch = np.hypot(*near.T), 2 * math.pi / pair.pinion.teeth
    angle = np.abs((np.arctan2(near[:, 1], near[:, 0]) + pitch / 2) % pitch - pitch / 2)
    room = radius * (angle - np.radians(pair.pinion.profile.half_angle(radius)))
    # Clear of the pinion's teeth, and closest where half the backlash is left on each side.
    assert -CHORDS < room.min() - pair.circumferential_backlash / 2 < CHORDS + 0.1 * pair.pinion.normal_module
    assert room.min() > 0


@pytest.mark.parametrize("name", PAIRS)
def test_path_of_contact_lies_between_the_tips(name: str) -> None:
    pair = PAIRS[name]
    line, path = (np.asarray(drawn.get_xydata()) for drawn in plot_pair(pair).lines[-2:])
    first, last = path
    wheel = np.array([pair.centre_distance, 0.0])
    assert np.hypot(*(first - wheel)) == pytest.approx(pair.wheel.tip_form_diameter / 2, rel=1e-9)
    assert np.hypot(*last) == pytest.approx(pair.pinion.tip_form_diameter / 2, rel=1e-9)
    assert np.hypot(*line[0]) == pytest.approx(pair.pinion.base_diameter / 2, rel=1e-12)
    assert np.hypot(*(line[-1] - wheel)) == pytest.approx(pair.wheel.base_diameter / 2, rel=1e-12)


def test_picture_is_never_too_high_nor_too_low() -> None:
    alike = Gear(teeth=20, normal_module=1, face_width=5)
    assert 2.2 <= pair_inches(GearPair(pinion=alike, wheel=alike))[1] <= 5.0
    assert pair_inches(GearPair(pinion=alike, wheel=Gear(teeth=300, normal_module=1, face_width=5)))[1] == 5.0
