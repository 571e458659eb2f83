"""Solids and triangles of double helical gears against the exact halves."""

import math
from pathlib import Path
from typing import Any

import cadquery
import numpy as np
import pytest
import trimesh
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_BSplineSurface
from scipy.spatial import cKDTree
from support.clearance import chamfered_volume, distance_to_section, toothed_volume
from support.solids import valid_and_closed

from gearcad import BasicRack, Body, FlankModification, Gear
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_parts import DoubleHelix
from gearcad.solids import gear_solid, write_step
from gearcad.solids.facets.tessellation import tessellate

_HUB = Body(bore=20, keyway_width=6, keyway_depth=2.8, hub_diameter=32, hub_length=4)

GEARS = {
    "gap": ({"helix_angle": 25.0}, DoubleHelix(gap_width=10)),
    "gap, offset, chamfers": ({"helix_angle": -30.0, "body": Body(end_chamfer=1)}, DoubleHelix(gap_width=6, offset=0.5)),
    "deep gap": ({"helix_angle": 35.0, "body": Body(bore=16)}, DoubleHelix(gap_width=8, gap_diameter=30)),
    "full radius": ({"helix_angle": 20.0, "rack": BasicRack(root_radius="full")}, DoubleHelix(gap_width=5)),
    "apex": ({"helix_angle": 25.0, "body": Body(bore=20)}, DoubleHelix(gap_width=0)),
    "apex, left, chamfers": ({"helix_angle": -40.0, "body": Body(end_chamfer=1, tip_chamfer=0.2)}, DoubleHelix(gap_width=0)),
    "apex, full radius": ({"helix_angle": 15.0, "rack": BasicRack(root_radius="full")}, DoubleHelix(gap_width=0)),
    "many teeth": ({"teeth": 60, "helix_angle": 30.0}, DoubleHelix(gap_width=10)),
}


def _gear(inputs: dict[str, object], double: DoubleHelix, **more: object) -> Gear:
    return Gear(**{"teeth": 16, "normal_module": 2.0, "face_width": 50.0, "double_helix": double} | inputs | more)


def _volume(gear: Gear) -> float:
    """Both halves, the groove's core, less a bore; at an apex only the outer ends have chamfers."""
    half, gap, body = halves(gear)[0].gear, gear.double_helix.gap_width or 0.0, gear.body
    chamfered = chamfered_volume(half) * (2 if gap else 1) if body.end_chamfer else 0.0
    bored = math.pi / 4 * body.bore**2 * gear.face_width
    return 2 * toothed_volume(half) - chamfered + math.pi / 4 * gear.gap_diameter**2 * gap - bored


def _points(solid: cadquery.Shape, low: float, high: float, most: int = 60) -> np.ndarray:
    """Points (n, 3) inside the first B-spline faces between two heights."""
    faces = [BRepAdaptor_Surface(face.wrapped) for face in solid.Faces()]
    found = []
    for face in [face for face in faces if face.GetType() == GeomAbs_BSplineSurface]:
        places = [
            face.Value(u, v)
            for u in np.linspace(0, 1, 7)
            for v in np.linspace(face.FirstVParameter(), face.LastVParameter(), 7)
        ]
        if all(low - 1e-9 <= place.Z() <= high + 1e-9 for place in places):
            found += [(place.X(), place.Y(), place.Z()) for place in places]
    return np.array(found[: most * 49] if most else found)


_LONG = ("gap", "full radius", "apex", "many teeth")
"""What is on them is on the others too."""


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in _LONG)) for name in GEARS])
def test_flanks_volume_and_validity_before_and_after_step(name: str, tmp_path: Path) -> None:
    gear = _gear(*GEARS[name])
    solid = gear_solid(gear)
    write_step(solid, tmp_path / "gear.step", name="gear")
    again = cadquery.importers.importStep(str(tmp_path / "gear.step")).val()
    assert len(again.Solids()) == 1
    assert valid_and_closed(again)
    assert again.Volume() == pytest.approx(_volume(gear), rel=1e-7)
    assert again.Center().z == pytest.approx(gear.face_width / 2, abs=1e-6)  # halves weigh the same
    for half in halves(gear):
        points = _points(solid, half.z, half.z + half.gear.face_width)
        turn = -math.radians(half.rotation)
        x, y = (
            points[:, 0] * math.cos(turn) - points[:, 1] * math.sin(turn),
            points[:, 0] * math.sin(turn) + points[:, 1] * math.cos(turn),
        )
        assert len(points) > 1000
        assert distance_to_section(half.gear, np.stack([x, y, points[:, 2] - half.z], -1)).max() < 1e-6


@pytest.mark.parametrize("gap", [pytest.param(0.0, marks=pytest.mark.long), 8.0])
def test_modified_halves_are_mirror_images(gap: float) -> None:
    """The mirror image of every point of a flank below the middle lies on a flank above it."""
    modification = FlankModification(
        tip_relief=20, tip_relief_length=1, lead_crowning=15, end_relief=8, end_relief_length=3, twist=12
    )
    gear = _gear({"teeth": 24, "helix_angle": 22.0, "body": _HUB}, DoubleHelix(gap_width=gap), modification=modification)
    solid = gear_solid(gear)
    assert valid_and_closed(solid)
    lower = _points(solid, 0.0, gear.half_width)
    upper = [tuple(point) for point in np.round(_points(solid, 50 - gear.half_width, 50.0, most=0), 6)]
    mirrored = np.round(lower * [1, 1, -1] + [0, 0, 50], 6) + 0.0
    assert cKDTree(np.array(upper)).query(mirrored)[0].max() < 3e-6


_FACET_HUB = Body(bore=20, keyway_width=6, keyway_depth=2.8, hub_diameter=32, hub_length=4, hub_side="both")

FACET_GEARS: dict[str, tuple[DoubleHelix, dict[str, Any]]] = {
    "gap": (DoubleHelix(gap_width=10), {}),
    "gap, offset, hubs, keyway": (DoubleHelix(gap_width=10, offset=0.5), {"body": _FACET_HUB}),
    "deep gap, chamfers": (DoubleHelix(gap_width=6, gap_diameter=24), {"body": Body(bore=16, end_chamfer=2)}),
    "apex": (DoubleHelix(gap_width=0), {}),
    "apex, chamfers": (DoubleHelix(gap_width=0), {"body": Body(bore=20, end_chamfer=1.5, tip_chamfer=0.2)}),
    "apex, full radius, hubs": (DoubleHelix(gap_width=0), {"body": _FACET_HUB, "rack": BasicRack(root_radius="full")}),
    "modified, offset": (
        DoubleHelix(gap_width=6, offset=-0.3),
        {"body": Body(bore=20, end_chamfer=1), "modification": FlankModification(lead_crowning=10, twist=10)},
    ),
    "modified apex": (
        DoubleHelix(gap_width=0),
        {"modification": FlankModification(tip_relief=20, tip_relief_length=1, end_relief=9, end_relief_length=4, twist=8)},
    ),
}


@pytest.mark.parametrize("name", FACET_GEARS)
def test_closed_and_within_the_chord_error(name: str) -> None:
    double, more = FACET_GEARS[name]
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
