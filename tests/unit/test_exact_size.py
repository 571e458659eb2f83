"""Areas and volumes of exact gears against the polygon of their contour, and against the B-rep."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcad import BasicRack, Body, FlankModification, Gear
from gearcad.meshing.bodies.exactness import exact_area, exact_volume
from gearcad.solids.exact.inertia import mass_properties

_CHORD = 1e-6
"""Error (mm) of the contour: a polygon loses two thirds of it all round."""

_SOLID = 1e-9
"""The solid interpolates fillets and flanks to a nanometre."""

GEARS = {
    "undercut": Gear(teeth=8, normal_module=2, face_width=10, body=Body(bore=4)),
    "full radius": Gear(teeth=30, normal_module=2, face_width=10, body=Body(bore=12), rack=BasicRack(root_radius="full")),
    "chamfered, helical": Gear(teeth=60, normal_module=1, face_width=10, helix_angle=30, body=Body(bore=40, tip_chamfer=0.05)),
}


@pytest.mark.parametrize("name", GEARS)
def test_the_area_is_that_of_the_contour(name: str) -> None:
    gear = GEARS[name]
    x, y = gear.profile.contour(_CHORD).T
    polygon = abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))) / 2
    bore = gear.body.bore / 2
    length = float(np.hypot(np.diff(x), np.diff(y)).sum())
    found = gear.teeth * exact_area(gear, bore)
    assert abs(found - (polygon - math.pi * bore**2)) < _CHORD * length


@pytest.mark.parametrize(
    "modification",
    [
        FlankModification(),
        FlankModification(tip_relief=30, tip_relief_length=2, end_relief=20, end_relief_length=2, lead_crowning=10),
        FlankModification(helix_angle_modification=15, twist=10, profile_crowning=10),
    ],
    ids=["plain", "relieved", "twisted"],
)
def test_the_volume_is_that_of_the_solid(modification: FlankModification) -> None:
    gear = Gear(teeth=17, normal_module=2, face_width=10, helix_angle=20, body=Body(bore=12), modification=modification)
    solid = mass_properties(gear, 1e9).mass
    assert gear.teeth * exact_volume(gear, 6.0) == pytest.approx(solid, rel=_SOLID)
