"""Weber and Banaschek's stiffness of a ring's teeth: by points of its outline, in the limit of a rack, beside elements."""

import math

import numpy as np
import pytest

from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats, Role
from gearcad.stiffness import METHODS, PotentialEnergy, WeberBanaschek

STEEL = Material()
LOAD = Load(torque=120.0)

OUTLINE = 2e-3
"""Relative: the point of 20,000 that is nearest to the contact, differences and trapezoids, against quadrature."""

ELEMENTS = 0.05
"""Relative: a beam on a half-plane against elements, of one pair of teeth on thick bodies."""


def ring_pair(teeth: int = -70, shift: float = -1.2025, helix: float = 0.0) -> GearPair:
    """The pair 3-4 of the Alm thesis, or one with another ring."""
    pinion = Gear(teeth=22, normal_module=2.8, face_width=16.0, profile_shift=0.5, helix_angle=helix)
    rim = Body(rim_diameter=240.0) if teeth == -70 else Body()
    return GearPair(
        pinion=pinion,
        wheel=Gear(teeth=teeth, normal_module=2.8, face_width=14.0, profile_shift=shift, helix_angle=helix, body=rim),
    )


def outline(gear: Gear) -> tuple[Floats, Floats]:
    """Place on the centre line (n,) and half thickness (n,) of a ring's tooth, from root to tip (mm)."""
    points = [curve.points(np.linspace(0, 1, 10000)) for curve in (gear.profile.fillet, gear.profile.involute)]
    x, half = np.concatenate(points).T
    return x, half


@pytest.mark.parametrize("place", [0.2, 0.5, 0.8])
def test_compliances_of_a_rings_tooth_by_points_of_its_outline(place: float) -> None:
    """The force is normal to the outline: its angle and where it cuts the centre line come from differences of points."""
    pair = ring_pair()
    method = WeberBanaschek(pair=pair, material=STEEL)
    lengths = np.array([pair.usable_path[0] + place * np.ptp(pair.usable_path)])
    x, half = outline(pair.wheel)
    height = x[0] - x
    reach = pair.base_tangent.length - lengths[0]
    radius = math.hypot(pair.wheel.base_diameter / 2, reach)
    at = int(np.argmin(np.abs(np.hypot(x, half) - radius)))
    slope = (half[at + 1] - half[at - 1]) / (height[at + 1] - height[at - 1])
    angle = -math.atan(slope)
    crossing = height[at] - half[at] * math.tan(angle)
    below = height <= crossing
    y, t = height[below], 2 * half[below]
    e, nu, across = STEEL.youngs_modulus, STEEL.poisson_ratio, math.cos(angle) ** 2
    plain = np.trapezoid(1 / t, y)
    beam = 12 * np.trapezoid((crossing - y) ** 2 / t**3, y) + (2.4 / (1 - nu) + math.tan(angle) ** 2) * plain
    lever = crossing / (2 * half[0])
    body = 18 / math.pi * lever**2 + 2 * (1 - 2 * nu) / (1 - nu) * lever
    body += 4.8 / math.pi * (1 + (1 - nu) / 2.4 * math.tan(angle) ** 2)
    expected = [1000 * (1 - nu**2) * across / e * each for each in (beam, body)]
    parts = method.single(lengths, LOAD).parts
    found = [
        sum(float(parts[f"wheel {name}"][0]) for name in ("bending", "shear", "axial")),
        float(parts["wheel foundation"][0]),
    ]
    assert found == pytest.approx(expected, rel=OUTLINE)


def test_rings_and_external_wheels_meet_in_the_rack() -> None:
    """Both single stiffnesses go to the rack's as 1/z: extrapolated from 1,000 and 2,000 teeth they are the same."""

    def single(teeth: int) -> float:
        return float(WeberBanaschek(pair=ring_pair(teeth, 0.0))(LOAD).single_stiffness)

    external, ring = (2 * single(2000 * side) - single(1000 * side) for side in (1, -1))
    assert ring == pytest.approx(external, rel=1e-3)
    assert single(-100) > ring > single(100)


def test_beside_finite_elements_of_a_thick_rim() -> None:
    """Nothing in common but the teeth: the elements' energy of one pair of teeth."""
    pair = ring_pair()
    weber, energy = (METHODS[name](pair=pair, material=STEEL)(LOAD) for name in ("weber-banaschek", "strain-energy"))
    assert weber.single_stiffness == pytest.approx(energy.single_stiffness, rel=ELEMENTS)


def test_what_it_is_not_for() -> None:
    with pytest.raises(GeometryError, match=r"pair.helix_angle = -?15 deg: must be 0 for weber-banaschek on a ring"):
        WeberBanaschek(pair=ring_pair(helix=15.0))(LOAD)
    with pytest.raises(GeometryError, match="potential-energy: Sainsot"):
        PotentialEnergy(pair=ring_pair())
    thin = ring_pair(-60, 0.0)
    rim = Body(rim_diameter=abs(thin.wheel.root_diameter) + 6.0)
    narrow = GearPair(pinion=thin.pinion, wheel=Gear(teeth=-60, normal_module=2.8, face_width=14.0, body=rim))
    notices = WeberBanaschek(pair=narrow)(LOAD).notices
    assert [(notice.code, notice.where) for notice in notices if notice.code == "thin-rim"] == [("thin-rim", Role.WHEEL.value)]
