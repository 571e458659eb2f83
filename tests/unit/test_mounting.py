"""Mounting: what is permitted, and the pair at another centre distance."""

from __future__ import annotations

import math
from typing import Any

import pytest

from gearcad import Gear, GearPair, Mounting, ParameterError
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.core.errors import GeometryError

PAIR = GearPair(
    pinion=Gear(teeth=18, normal_module=1.5, face_width=10, tooth_thinning=0.05),
    wheel=Gear(teeth=41, normal_module=1.5, face_width=10),
)


def test_the_drawing_is_the_pair_itself() -> None:
    assert Mounting().mounted(PAIR) is PAIR
    assert Mounting(pinion_pitch_error=3, wheel_pitch_error=-5).pitch_error == -2.0


@pytest.mark.parametrize("change", [0.1, -0.02])
def test_base_circles_stay_and_the_line_of_action_follows(change: float) -> None:
    """T1T2 = sqrt((a + da)^2 - (r_b1 + r_b2)^2), and the pitch point divides it as it divides the centre distance."""
    pair = Mounting(centre_distance_change=change).mounted(PAIR)
    radii = [gear.base_diameter / 2 for gear in (PAIR.pinion, PAIR.wheel)]
    distance = PAIR.centre_distance + change
    whole = math.sqrt(distance**2 - sum(radii) ** 2)
    assert (pair.pinion, pair.wheel) == (PAIR.pinion, PAIR.wheel)
    assert line_of_action(pair).whole == pytest.approx(whole, rel=1e-12)
    assert pair.path_of_contact.C == pytest.approx(whole * 18 / 59, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (5.0, "mounting.centre_distance_change = 5 mm: makes a centre distance of 49.25 mm, but must be below "),
        (-0.5, "mounting.centre_distance_change = -0.5 mm: makes a centre distance of 43.75 mm, but must be at least "),
    ],
)
def test_gears_that_no_longer_mesh_are_refused(change: float, message: str) -> None:
    with pytest.raises(GeometryError) as caught:
        Mounting(centre_distance_change=change).mounted(PAIR)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    "wrong",
    [{"misalignment": 1001.0}, {"misalignment_across": math.nan}, {"wheel_pitch_error": "x"}, {"centre_distance_change": None}],
)
def test_wrong_values_are_refused(wrong: dict[str, Any]) -> None:
    (name,) = wrong
    with pytest.raises(ParameterError, match=f"{name} = .*: must be a number"):
        Mounting(**wrong)
