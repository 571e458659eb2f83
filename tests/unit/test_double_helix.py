"""Double helical gears and pairs: halves, limits, and what two halves carry together (identity)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import Gear, GearPair
from gearcad.core.errors import InputError
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_parts import DoubleHelix


def _gear(teeth: int = 24, helix: float = 25.0, width: float = 50.0, **double: Any) -> Gear:
    given = DoubleHelix(**{"gap_width": 10.0} | double)
    return Gear(teeth=teeth, normal_module=2.0, face_width=width, helix_angle=helix, double_helix=given)


def test_the_upper_half_goes_on_where_the_lower_one_ends() -> None:
    lower, upper = halves(_gear(offset=0.25))
    assert (lower.z, upper.z, lower.gear.face_width) == (0.0, 30.0, 20.0)
    assert (lower.gear.helix_angle, upper.gear.helix_angle) == (25.0, -25.0)
    assert upper.rotation == pytest.approx(lower.gear.twist + 0.25 * 15, abs=1e-12)
    assert halves(_gear(helix=-25.0))[1].rotation == pytest.approx(-lower.gear.twist, abs=1e-12)


@pytest.mark.parametrize("offset", [0.0, 0.3, 0.5])
def test_two_halves_carry_what_their_pairs_do(offset: float) -> None:
    """The overlap ratio is that of one half; lines of contact are those of both, each where its teeth are."""
    pinion, wheel = _gear(offset=offset), _gear(54, -25.0, 46.0, offset=-offset)
    pair = GearPair(pinion=pinion, wheel=wheel)
    half = GearPair(pinion=halves(pinion)[0].gear, wheel=replace(halves(wheel)[0].gear, face_width=18.0))
    assert pair.common_width == (36.0, 0.0)
    assert pair.overlap_ratio == pytest.approx(half.overlap_ratio, rel=1e-12)
    roll = np.linspace(0, 15, 3001)
    total = half.contact_line_length(roll) + half.contact_line_length(roll + offset * 15)
    assert pair.contact_line_length(roll) == pytest.approx(total, rel=1e-12)
    lengths = pair.contact_line_lengths
    assert lengths.minimum == pytest.approx(total.min(), rel=1e-3)
    assert lengths.maximum == pytest.approx(total.max(), rel=1e-3)
    assert lengths.mean == pytest.approx(2 * half.contact_line_lengths.mean, rel=1e-12)


@pytest.mark.parametrize("gap", [0.0, 10.0])
def test_two_halves_need_a_fiftieth_of_the_module_beside_the_gap(gap: float) -> None:
    assert _gear(width=gap + 0.0401, gap_width=gap).half_width == pytest.approx(0.02005, abs=1e-12)
    with pytest.raises(InputError, match=rf"gap_width = {gap:g} mm: must be at most .* to leave two halves"):
        _gear(width=gap + 0.0399, gap_width=gap)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: _gear(gap_width=60.0), "double_helix.gap_width = 60 mm: must be at most 49.96 mm"),
        (lambda: _gear(helix=0.0), "helix_angle = 0 deg: must not be 0 deg on a double helical gear"),
        (lambda: _gear(gap_diameter=70.0), "double_helix.gap_diameter = 70 mm: must be from 0.4 to 47.5621 mm"),
        (
            lambda: Gear(teeth=-40, normal_module=2, face_width=50, helix_angle=9, double_helix=DoubleHelix(gap_width=9)),
            "double_helix.gap_width = 9 mm: must be left out on a ring",
        ),
        (lambda: DoubleHelix(gap_width=0.0, offset=0.5), "gap_width = 0 mm: must be above 0 mm where offset is 0.5"),
        (lambda: DoubleHelix(gap_width=-1.0), "gap_width = -1 mm: must be a number"),
        (
            lambda: GearPair(pinion=_gear(), wheel=Gear(teeth=30, normal_module=2, face_width=50, helix_angle=-25)),
            "wheel.double_helix.gap_width is missing: must be given for both gears",
        ),
        (
            lambda: GearPair(pinion=_gear(offset=0.2), wheel=_gear(54, -25.0)),
            "wheel.double_helix.offset = 0: must be -0.2, for both halves to mesh",
        ),
        (
            lambda: GearPair(pinion=_gear(), wheel=_gear(54, -25.0, 12.0, gap_width=11.0), axial_offset=1.0),
            "axial_offset = 1 mm: must be 0 mm: double helical gears centre each other",
        ),
        (
            lambda: GearPair(pinion=_gear(gap_width=14.0), wheel=_gear(54, -25.0, 12.0)),
            "pinion.double_helix.gap_width = 14 mm: must be below 12 mm",
        ),
    ],
)
def test_what_makes_no_double_helical_gear(make: Any, message: str) -> None:
    with pytest.raises(InputError) as raised:
        make()
    assert str(raised.value).startswith(message)
