"""Random gears in tetrahedra: good elements on exact faces that enclose the right volume."""

from __future__ import annotations

import pytest
from support.exact import solid_volume
from support.modified import removed_volume
from support.modifying import random_gear

from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.gear_faces import TetrahedronGrading
from gearcad.meshing.bodies.quality import measure_whole, quality, require_good
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra

EXACT = 1e-9
"""mm: what is promised of nodes."""

ROUND = 1e-4
"""Relative: what edges of second order leave out of round faces is a hundred-thousandth."""


SEEDS = (0, 1, 8, 12, 16, 19, 20, 22, 25, 28, 29, 30, 31, 32, 33, 36, 38)
"""Gears of less than 200,000 tetrahedra. Number 3 is refused: its chamfer begins 0.01 modules beside the root form circle."""


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_random_gears_are_meshed(seed: int) -> None:
    gear = random_gear(seed)
    mesh = mesh_tetrahedra(gear, size=gear.normal_module, grading=TetrahedronGrading(deviation=None))
    require_good(quality(mesh))
    assert deviations(mesh, gear).nodes < EXACT
    assert measure_whole(mesh) == pytest.approx(solid_volume(gear) - removed_volume(gear), rel=ROUND)
