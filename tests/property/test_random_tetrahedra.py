"""Random gears in tetrahedra: good elements on exact faces that enclose the right volume."""

from __future__ import annotations

import math

import pytest
from support.exact import solid_volume
from support.modified import removed_volume
from support.modifying import random_gear

from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.measure import measure_whole
from gearcad.meshing.bodies.quality import quality, require_good
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra
from gearcad.meshing.bodies.tetrahedron_sizes import TetrahedronGrading

EXACT = 1e-9
"""mm: what is promised of nodes."""

ROUND = 1e-4
"""Relative: what edges of second order leave out of round faces is a hundred-thousandth."""


WEDGE = 0.02
"""Normal modules between a chamfer's begin and the root form circle, below which tetrahedra between them are too flat."""


@pytest.mark.long
@pytest.mark.parametrize("seed", range(40))
def test_random_gears_are_meshed(seed: int) -> None:
    gear = random_gear(seed)
    face = gear.tip_diameter / 2 - gear.body.end_chamfer * math.tan(math.radians(gear.body.end_chamfer_angle))
    if abs(face - gear.form_diameter / 2) < WEDGE * gear.normal_module:
        pytest.skip("a chamfer that begins beside the root form circle leaves wedges that are refused")
    mesh = mesh_tetrahedra(gear, size=gear.normal_module, grading=TetrahedronGrading(deviation=None))
    require_good(quality(mesh))
    assert deviations(mesh, gear).nodes < EXACT
    assert measure_whole(mesh) == pytest.approx(solid_volume(gear) - removed_volume(gear), rel=ROUND)
