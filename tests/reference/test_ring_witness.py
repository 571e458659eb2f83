"""Contact in a ring against a witness: both gears whole in one fine mesh each, nothing taken off and nothing condensed."""

from __future__ import annotations

import pytest
from support.dense_contact import dense_contact

from gearcad import Body, Gear, GearPair, Material
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.geometry import ShaperCutter

PAIR = GearPair(
    pinion=Gear(teeth=22, normal_module=2.0, face_width=14, profile_shift=0.3, body=Body(bore=16.0)),
    wheel=Gear(
        teeth=-70,
        normal_module=2.0,
        face_width=14,
        profile_shift=-0.3,
        tip_alteration=-0.1,
        cutter=ShaperCutter(teeth=25),
        body=Body(rim_diameter=170.0),
    ),
)
TORQUE, ROLL_ANGLE = 100.0, -5.1136

STIFFNESS, PINION, RING = 25.5317, 263.496, 210.027
"""What the witness finds with edges of 0.015 mm on flanks: N/(mm·µm) and MPa; the long test below finds it again."""

SAME_STIFFNESS, SAME_STRESS = 0.005, 0.01


@pytest.fixture(scope="module")
def model() -> PlanePair:
    return plane_pair(PAIR, Material())


def test_stiffness_and_root_stress_are_those_of_the_witness(model: PlanePair) -> None:
    position = PlaneCycle(model, TORQUE).solve(ROLL_ANGLE)
    assert position.stiffness == pytest.approx(STIFFNESS, rel=SAME_STIFFNESS)
    assert position.tension.pinion.stress == pytest.approx(PINION, rel=SAME_STRESS)
    assert position.tension.wheel.stress == pytest.approx(RING, rel=SAME_STRESS)


@pytest.mark.long
def test_the_witness_says_so_today(model: PlanePair) -> None:
    found = dense_contact(PAIR, Material(), TORQUE, model.roll_length(ROLL_ANGLE))
    assert found.stiffness == pytest.approx(STIFFNESS, rel=1e-3)
    assert found.tension == pytest.approx((PINION, RING), rel=2e-3)
    shares = [contact.force for contact in PlaneCycle(model, TORQUE).solve(ROLL_ANGLE).contacts]
    assert [force for force in found.forces if force] == pytest.approx(shares, rel=SAME_STIFFNESS)
