"""Rooms that do not treat rings yet: they say so in one line."""

import re

import pytest

from gearcad import Gear, GearPair, Load, Material, stiffness
from gearcad.check import check_pair
from gearcad.errors import GeometryError

RING = GearPair(
    pinion=Gear(teeth=22, normal_module=2.0, face_width=16.0),
    wheel=Gear(teeth=-70, normal_module=2.0, face_width=14.0),
)


@pytest.mark.parametrize(
    "use, said",
    [
        (
            lambda: check_pair(RING, Material(), Load(torque=50)),
            "wheel.teeth = -70: must be above 0: pairs with a ring are not",
        ),
    ],
)
def test_no_room_gives_wrong_numbers_for_rings(use, said: str) -> None:
    with pytest.raises(GeometryError, match="^" + re.escape(said)):
        use()


def test_methods_without_an_internal_form_say_why() -> None:
    found = stiffness(RING, Load(torque=50))
    assert [cycle.method for cycle in found.cycles] == ["iso6336", "strain-energy"]
    said = "wheel.teeth = -70: must be above 0 for {}: {}"
    expected = {
        "potential-energy": "Sainsot's elastic ring lies inside the teeth, held at its bore, not outside them",
        "weber-banaschek": "its beam and half-plane are those of teeth that stand out from their body",
    }
    assert {name: found.left_out[name] for name in expected} == {name: said.format(name, why) for name, why in expected.items()}
