"""Triangles of double helical gears: closed, and as far from the exact halves as was asked (property)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import trimesh
from support.exact import distance_to_section

from gearcad import BasicRack, Body, FlankModification, Gear
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_parts import DoubleHelix
from gearcad.solids import gear_solid
from gearcad.solids.facets.tessellation import tessellate

_HUB = Body(bore=20, keyway_width=6, keyway_depth=2.8, hub_diameter=32, hub_length=4, hub_side="both")

GEARS: dict[str, tuple[DoubleHelix, dict[str, Any]]] = {
    "gap": (DoubleHelix(gap_width=10), {}),
    "gap, offset, hubs, keyway": (DoubleHelix(gap_width=10, offset=0.5), {"body": _HUB}),
    "deep gap, chamfers": (DoubleHelix(gap_width=6, gap_diameter=24), {"body": Body(bore=16, end_chamfer=2)}),
    "apex": (DoubleHelix(gap_width=0), {}),
    "apex, chamfers": (DoubleHelix(gap_width=0), {"body": Body(bore=20, end_chamfer=1.5, tip_chamfer=0.2)}),
    "apex, full radius, hubs": (DoubleHelix(gap_width=0), {"body": _HUB, "rack": BasicRack(root_radius="full")}),
    "modified, offset": (
        DoubleHelix(gap_width=6, offset=-0.3),
        {"body": Body(bore=20, end_chamfer=1), "modification": FlankModification(lead_crowning=10, twist=10)},
    ),
    "modified apex": (
        DoubleHelix(gap_width=0),
        {"modification": FlankModification(tip_relief=20, tip_relief_length=1, end_relief=9, end_relief_length=4, twist=8)},
    ),
}


@pytest.mark.parametrize("name", GEARS)
def test_closed_and_within_the_chord_error(name: str) -> None:
    double, more = GEARS[name]
    gear = Gear(**{"teeth": 24, "normal_module": 2.0, "face_width": 50.0, "helix_angle": -25.0} | more, double_helix=double)
    exact = gear_solid(gear).Volume()
    for error in (0.02, 0.004):
        check_facets(gear, exact, error)


def check_facets(gear: Gear, exact: float, error: float) -> None:
    assert gear.double_helix is not None
    facets = tessellate(gear, error)
    mesh = trimesh.Trimesh(facets.vertices, facets.faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.euler_number == (0 if gear.body.bore else 2)
    assert abs(facets.volume - exact) < error * mesh.area
    assert np.allclose(mesh.bounds[:, 2], [-gear.body.hub_ends[0], 50 + gear.body.hub_ends[1]])
    if gear.modification.present:
        return
    sampled, _ = trimesh.sample.sample_surface(mesh, 4000, seed=1)
    for half in halves(gear):
        z = sampled[:, 2] - half.z
        radius = np.hypot(*sampled[:, :2].T)
        inside = (z > 0.01) & (z < half.gear.face_width - 0.01) & (radius > gear.root_diameter / 2 - error)
        inside &= (
            np.minimum(z if half.z == 0 or gear.double_helix.gap_width else half.gear.face_width - z, 9) > 2.1
        )  # clear of cones
        if gear.double_helix.gap_width:
            inside &= half.gear.face_width - z > 2.1
        turn = -math.radians(half.rotation)
        x, y, _ = sampled[inside].T
        turned = np.stack([x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn), z[inside]], -1)
        assert len(turned) > 100
        assert distance_to_section(half.gear, turned).max() < 1.01 * error
