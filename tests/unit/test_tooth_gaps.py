"""The gap between two teeth beyond their path of contact, against the distance of turned profiles found by brute force."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcad import FlankModification, Gear, GearPair
from gearcad.contact.shared.line_of_action import line_of_action, nearest
from gearcad.core.records import Floats, PerGear
from gearcad.dynamics.tooth_errors.tooth_springs import ToothPath, pair_path, standard_path

POINTS = 100_001
"""Of a profile: chords of 0.1 µm on flanks of 10 mm, 1e-9 mm off the curve."""

SAME_MICROMETRES = 2e-3
"""What the interpolation of turned profiles leaves, of gaps up to a millimetre."""


def _pair(wheel: int, shift: float = 0.3, **more: Any) -> GearPair:
    sizes = {"normal_module": 3.0, "face_width": 10.0, "tooth_thinning": 0.05}
    pinion = Gear(teeth=18, profile_shift=shift, **sizes, **more)  # type: ignore[arg-type]
    return GearPair(pinion=pinion, wheel=Gear(teeth=wheel, **sizes))  # type: ignore[arg-type]


def _angles(base: float, contact: float, length: Floats) -> tuple[Floats, Floats]:
    """Radius and polar angle of an involute that touches at `contact`, from the base tangent point on, by inv = tan - arc."""
    roll = length / base
    return np.hypot(base, length), contact / base - (roll - np.arctan(roll))


def _brute_gap(path: ToothPath, place: float) -> float:
    """Gap (µm) by turning the wheel about its axis until its profile meets that of the pinion, at a place from T1 (mm)."""
    pinion, wheel = path.flanks
    radius, angle = _angles(pinion.base_radius, place, np.linspace(pinion.first, pinion.last, POINTS))
    x, up = radius * np.sin(angle), radius * np.cos(angle) - pinion.base_radius
    ring = wheel.base_radius < 0
    base, side = abs(wheel.base_radius), -1.0 if ring else 1.0
    # Seen from the wheel's axis, from the line to its base tangent point on.
    x, up = side * (path.whole - x), (side * (wheel.base_radius - up)) if not ring else up - wheel.base_radius
    seen_radius, seen_angle = np.hypot(x, up), np.arctan2(x, up)
    contact = side * (path.whole - place)
    own_radius, own_angle = _angles(base, contact, np.sort(np.abs(np.linspace(wheel.first, wheel.last, POINTS))))
    order = np.argsort(seen_radius)
    low, high = max(own_radius.min(), seen_radius.min()), min(own_radius.max(), seen_radius.max())
    radii = np.linspace(low, high, POINTS)
    apart = np.interp(radii, seen_radius[order], seen_angle[order]) - np.interp(radii, own_radius, own_angle)
    return float(1000 * base * (side * apart).min())


@pytest.mark.parametrize("teeth", [48, 18, -70])
@pytest.mark.parametrize("beyond", [0.02, 0.1, 0.3])
def test_gap_beyond_the_path_is_that_of_turned_profiles(teeth: int, beyond: float) -> None:
    path = pair_path(_pair(teeth))
    half = path.contact_ratio / 2
    for place in (-half - beyond, half + beyond):
        found = float(path.gaps(np.array([place]))[0])
        assert found == pytest.approx(_brute_gap(path, path.middle + place * path.pitch), abs=SAME_MICROMETRES)
        assert found > 0.01


def test_exact_flanks_touch_all_along_their_path() -> None:
    path = pair_path(_pair(48))
    inside = np.linspace(-0.5, 0.5, 101) * path.contact_ratio
    assert np.abs(path.gaps(inside)).max() < 1e-8


def test_near_the_path_it_is_the_gap_of_the_contact_model() -> None:
    """That looks along the line of action, by a parabola: the same to second order."""
    pair = _pair(48)
    line, path = line_of_action(pair), pair_path(pair)
    place = path.first - 0.02 * path.pitch
    along = nearest(line, 0, place)
    assert along is not None
    assert float(path.gaps((np.array([place]) - path.middle) / path.pitch)[0]) == pytest.approx(1000 * along[0], rel=0.06)


def test_tip_relief_opens_the_gap_where_it_is() -> None:
    """By the contact model, which looks for the nearest points of the modified flanks along the line of action."""
    relieved = _pair(48, modification=FlankModification(tip_relief=20.0, tip_relief_length=1.5))
    line, path = line_of_action(relieved), pair_path(relieved)
    ends = path.contact_ratio / 2 + np.array([-0.4, 0.0, 0.05])
    along = [nearest(line, 0, path.middle + place * path.pitch) for place in ends.tolist()]
    found = path.gaps(ends)
    assert found == pytest.approx([1000 * each[0] for each in along if each is not None], rel=0.03, abs=1e-3)
    # Less than the relief: just below it the flanks are still near.
    assert 8.0 < found[1] < 20.0


@pytest.mark.parametrize(
    ("radii", "teeth", "ratio"), [((50.7, 135.3), 18, 1.6), ((50.0, -150.0), 20, 1.8), ((40.0, 40.0), 40, 1.2)]
)
def test_assumed_teeth_have_the_contact_ratio_and_equal_addenda(radii: tuple[float, float], teeth: int, ratio: float) -> None:
    path = standard_path(PerGear(*radii), teeth, ratio)
    assert path is not None
    assert path.contact_ratio == pytest.approx(ratio, rel=1e-12)
    one, other = (abs(each) / math.cos(math.radians(20)) for each in radii)
    tips = math.hypot(radii[0], path.last) - one, math.hypot(radii[1], path.whole - path.first) - other
    assert tips[0] == pytest.approx(math.copysign(1, radii[1]) * tips[1], abs=1e-9)


def test_no_assumed_teeth_have_a_path_longer_than_their_line_of_action() -> None:
    assert standard_path(PerGear(50.0, 50.0), 8, 1.6) is None
