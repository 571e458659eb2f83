"""Mass and inertia of solids against integrals over the outline."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcad import Body, Gear
from gearcad.solids.exact.inertia import mass_properties


def _of_outline(gear: Gear, density: float) -> tuple[float, float]:
    """Mass (kg) and inertia (kg·m²) by Green's theorem along a fine polygon, less the bore."""
    x, y = gear.profile.contour(1e-6).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    area = cross.sum() / 2
    square = sum((each**2 + each * np.roll(each, -1) + np.roll(each, -1) ** 2) @ cross for each in (x, y)) / 12
    bore = gear.body.bore / 2
    area, square = area - math.pi * bore**2, square - math.pi * bore**4 / 2
    return area * gear.face_width * density * 1e-9, square * gear.face_width * density * 1e-15


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_a_gear_with_a_bore(helix: float) -> None:
    gear = Gear(teeth=23, normal_module=2.0, face_width=14.0, helix_angle=helix, body=Body(bore=12.0))
    assert mass_properties(gear, 7850.0) == pytest.approx(_of_outline(gear, 7850.0), rel=2e-6)


def test_hubs_add_a_ring() -> None:
    plain = Gear(teeth=23, normal_module=2.0, face_width=14.0, body=Body(bore=12.0))
    hub = Gear(teeth=23, normal_module=2.0, face_width=14.0, body=Body(bore=12.0, hub_diameter=30.0, hub_length=5.0))
    ring = math.pi / 32 * (30.0**4 - 12.0**4) * 5.0 * 7850e-15
    assert mass_properties(hub, 7850.0).inertia - mass_properties(plain, 7850.0).inertia == pytest.approx(ring, rel=1e-6)
