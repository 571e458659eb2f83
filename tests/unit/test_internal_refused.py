"""Rooms that do not treat rings, or shaped gears, yet: they say so in one line."""

import re

import pytest

from gearcad import Gear, GearPair, Load, dynamics, rate, stiffness
from gearcad.errors import GeometryError
from gearcad.geometry import ShaperCutter

RING = GearPair(
    pinion=Gear(teeth=22, normal_module=2.0, face_width=16.0),
    wheel=Gear(teeth=-70, normal_module=2.0, face_width=14.0),
)
SHAPED = GearPair(
    pinion=Gear(teeth=22, normal_module=2.0, face_width=16.0, cutter=ShaperCutter(teeth=25)),
    wheel=Gear(teeth=70, normal_module=2.0, face_width=14.0),
)


@pytest.mark.parametrize(
    "use, said",
    [
        (lambda: rate(RING, Load(torque=50)), "wheel.teeth = -70: must be above 0 for a rating: rings are not rated yet"),
        (lambda: rate(SHAPED, Load(torque=50)), "pinion.cutter.teeth = 25: must be left out for a rating"),
        (lambda: stiffness(RING, Load(torque=50)), "wheel.teeth = -70: must be above 0 for potential-energy"),
        (lambda: dynamics(RING, Load(torque=50, speed=100)), "wheel.teeth = -70: must be above 0: the dynamics"),
    ],
)
def test_no_room_gives_wrong_numbers_for_rings(use, said: str) -> None:
    with pytest.raises(GeometryError, match="^" + re.escape(said)):
        use()
