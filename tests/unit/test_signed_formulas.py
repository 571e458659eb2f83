"""Formulas on plain numbers with signed teeth: what holds for external gears holds for internal ones (ISO 21771).

The references are our own, computed apart; sections of these very gears, posed by them, do not overlap in nine positions.
"""

import math
from dataclasses import dataclass

import pytest

from gearcad import GeometryError
from gearcad.core.records import PerGear
from gearcad.geometry import BaseTangent, PathOfContact, profile_shift_sum, specific_sliding, zero_backlash_centre_distance
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.pair_data import farthest_centre_distance, shift_sum_limit

EXACT = 1e-10


@dataclass
class Internal:
    """A pinion in a ring, and what the formulas must give."""

    gears: PerGear[GearData]
    tip_diameters: PerGear[float]
    centre_distance: float
    pressure_angle: float
    length: float
    path: PathOfContact
    active_root_diameters: PerGear[float]

    @property
    def size(self) -> dict[str, object]:
        pinion = self.gears.pinion
        teeth = self.gears.map(lambda gear: gear.teeth)
        return {"teeth": teeth, "helix_angle": pinion.helix_angle, "pressure_angle": pinion.rack.pressure_angle}


def _gears(module: float, teeth: PerGear[int], shifts: PerGear[float], helix: float = 0.0) -> PerGear[GearData]:
    return PerGear(
        *(
            GearData(teeth=z, normal_module=module, face_width=20.0, helix_angle=helix, profile_shift=x)
            for z, x in zip(teeth, shifts, strict=True)
        )
    )


PAIRS = [
    Internal(
        gears=_gears(2.8, PerGear(22, -70), PerGear(0.5, -1.2025)),
        tip_diameters=PerGear(70.0, -197.134),
        centre_distance=-68.99992099071177,
        pressure_angle=23.76870499066457,
        length=-27.810106575079217,
        path=PathOfContact(7.331152268944393, 11.414728103827295, 12.746298846911309, 15.597120284406332, 19.680696119289234),
        active_root_diameters=PerGear(59.71318091847535, -207.22858641039625),
    ),
    Internal(
        gears=_gears(2.7, PerGear(24, -75), PerGear(0.4, -0.46), helix=15.0),
        tip_diameters=PerGear(74.64589649057339, -207.53742653304184),
        centre_distance=-71.43949816736826,
        pressure_angle=20.986341436945867,
        length=-25.585726648533377,
        path=PathOfContact(8.273770600516531, 11.97564253928789, 12.040341952251005, 16.491267567000715, 20.193139505772074),
        active_root_diameters=PerGear(64.92133278270704, -216.49189255401532),
    ),
]


@pytest.mark.parametrize("pair", PAIRS, ids=["spur", "helical"])
def test_centre_distance_and_shifts_of_an_internal_pair(pair: Internal) -> None:
    pinion, ring = pair.gears
    size = {"normal_module": pinion.normal_module, **pair.size}
    total = pinion.profile_shift + ring.profile_shift
    assert zero_backlash_centre_distance(**size, shift_sum=total) == pytest.approx(pair.centre_distance, rel=EXACT)
    assert profile_shift_sum(**size, centre_distance=pair.centre_distance) == pytest.approx(total, rel=EXACT)
    assert pinion.standard_tip_diameter == pytest.approx(pair.tip_diameters.pinion, rel=EXACT)
    limit = shift_sum_limit(**pair.size)
    with pytest.raises(GeometryError, match=f"must be below {limit:.3f}"[:-1]):
        zero_backlash_centre_distance(**size, shift_sum=limit + 0.1)
    base = (pinion.base_diameter + ring.base_diameter) / 2
    assert zero_backlash_centre_distance(**size, shift_sum=limit - 1e-9) == pytest.approx(base, rel=1e-5)


@pytest.mark.parametrize("pair", PAIRS, ids=["spur", "helical"])
def test_path_of_contact_of_an_internal_pair(pair: Internal) -> None:
    bases = pair.gears.map(lambda gear: gear.base_diameter)
    line = BaseTangent(bases, pair.centre_distance, pair.pressure_angle, pair.gears.pinion.transverse_base_pitch)
    assert line.length == pytest.approx(pair.length, rel=EXACT)
    path = line.path(pair.tip_diameters)
    assert path == pytest.approx(pair.path, rel=EXACT)
    assert line.active_root_diameters(path) == pytest.approx(pair.active_root_diameters, rel=EXACT)
    assert line.usable(path, pair.active_root_diameters) == pytest.approx((path.A, path.E), rel=EXACT)
    distance = -farthest_centre_distance(bases, pair.tip_diameters)
    angle = math.degrees(math.acos(sum(bases) / 2 / distance))
    vanished = BaseTangent(bases, distance, angle, 1.0).path(pair.tip_diameters)
    assert vanished.A == pytest.approx(vanished.E, rel=EXACT)


@pytest.mark.parametrize("pair", PAIRS, ids=["spur", "helical"])
def test_specific_sliding_of_an_internal_pair(pair: Internal) -> None:
    """1 - v_mate/v_own of the flanks where they touch: their velocities along the profile are omega rho."""
    z_1, z_2 = pair.gears.map(lambda gear: gear.teeth)
    found = specific_sliding(
        teeth=PerGear(z_1, z_2),
        base_radii=pair.gears.map(lambda gear: gear.base_diameter / 2),
        tip_radii=pair.tip_diameters.map(lambda diameter: diameter / 2),
        centre_distance=pair.centre_distance,
    )
    ratio, (first, _, _, _, last) = z_1 / abs(z_2), pair.path
    mates = PerGear(first - pair.length, last)
    assert found.pinion == pytest.approx(1 - ratio * mates.pinion / first, rel=1e-9)
    assert found.wheel == pytest.approx(1 - mates.wheel / ratio / (last - pair.length), rel=1e-9)
