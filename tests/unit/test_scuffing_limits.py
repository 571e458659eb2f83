"""What scuffing temperatures do at the limits of their formulas, and what they must never do."""

import random
from dataclasses import replace

import numpy as np
import pytest
from support.scuffing import Factors, pair, scuffed

from gearcad import BasicRack, GearPair
from gearcad.core.errors import GeometryError
from gearcad.rating.scuffing_temperatures import FlashPath

SPUR = pair((16, 24), module=4.5, shifts=(0.1817, 0.1715), helix=0.0, width=14.0)


def test_without_a_stage_temperatures_stand_alone() -> None:
    found = scuffed(SPUR, scuffing_stage=None)
    document = found.to_dict()
    assert (found.judged, found.integral_safety, found.flash_safety, found.risk) == (False, None, None, None)
    assert document["integral"]["theta_int"] > 70
    assert document["flash"]["theta_B"] > 70
    assert "S_int" not in document["integral"]
    assert document["reason"] == "the scuffing_stage of the oil in the FZG test A/8.3/90 is not given"


def test_without_a_speed_there_are_none() -> None:
    found = scuffed(SPUR, speed=0.0)
    assert (found.integral, found.flash, found.judged) == (None, None, False)
    assert found.to_dict()["reason"] == "the speed is 0 rpm: nothing slides"


def test_deep_spur_teeth_have_no_flash_temperature() -> None:
    rack = BasicRack(addendum=1.4, dedendum=1.65, root_radius=0.2)
    found = scuffed(pair((40, 60), helix=0.0, shifts=(0.0, 0.0), rack=rack))
    assert found.flash is None
    assert found.integral_safety is not None
    assert found.flash_risk is None
    assert [notice.code for notice in found.notices] == ["no-flash-temperature"]


@pytest.mark.parametrize(("speed", "code"), [(100.0, "scuffing-low-speed"), (30000.0, "scuffing-high-speed")])
def test_speeds_beyond_the_formulas_are_told(speed: float, code: str) -> None:
    assert code in [notice.code for notice in scuffed(SPUR, speed=speed).notices]


def test_friction_stays_at_its_limits() -> None:
    """Below 150 N/mm and above 50 m/s."""
    alone = Factors(1.0, 1.0, 1.0, 1.0, 1.0)
    light = [scuffed(SPUR, torque=torque, factors=alone).integral for torque in (5.0, 50.0)]
    fast = [scuffed(SPUR, speed=speed).integral for speed in (14000.0, 28000.0)]
    assert light[0].friction == light[1].friction  # type: ignore[union-attr]
    assert fast[0].friction == fast[1].friction  # type: ignore[union-attr]
    assert "scuffing-low-load" in [notice.code for notice in scuffed(SPUR, torque=5.0, factors=alone).notices]


def test_nothing_slides_at_the_pitch_point() -> None:
    for gears in (SPUR, pair(), pair((20, -60), helix=0.0)):
        found = scuffed(gears).flash
        assert found is not None
        near = replace(found, path=FlashPath(np.array([-0.1, 0.0, 0.1]), np.ones(3)))
        assert near.flash[1] == 0
        assert min(near.flash[0], near.flash[2]) > 1
        assert np.all(np.diff(found.path.places) >= 0)


def _random_pairs(count: int) -> list[GearPair]:
    draw, found = random.Random(7), []
    while len(found) < count:
        first = draw.randint(14, 40)
        ring = draw.random() < 0.3
        second = -draw.randint(first + 25, 110) if ring else draw.randint(first, 90)
        helix, module = draw.choice([0.0, draw.uniform(8, 30)]), draw.uniform(1, 8)
        try:
            found.append(pair((first, second), module=module, helix=helix, width=module * draw.uniform(4, 14)))
        except GeometryError:
            continue
    return found


def test_heavier_rougher_and_hotter_is_never_safer() -> None:
    """Over random pairs: torque, roughness, oil temperature, and a lower load stage, one by one."""
    for gears in _random_pairs(30):
        torque = 5 * gears.pinion.reference_diameter**2 * gears.pinion.face_width / 1e3
        plain = scuffed(gears, torque=torque)
        rough = replace(gears, wheel=replace(gears.wheel, flank_roughness=8.0))
        worse = [
            scuffed(gears, torque=1.3 * torque),
            scuffed(rough, torque=torque),
            scuffed(gears, torque=torque, oil_temperature=90.0),
            scuffed(gears, torque=torque, scuffing_stage=9),
        ]
        for each in worse:
            assert each.integral_safety < plain.integral_safety  # type: ignore[operator]
            if plain.margin is not None:
                assert each.margin < plain.margin  # type: ignore[operator]
