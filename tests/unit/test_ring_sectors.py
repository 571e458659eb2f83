"""The sector of a ring: tooth 0 with its tip towards the axis, and its share of the rim, in triangles and in quadrangles."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from gearcad import BasicRack, Body, Gear
from gearcad.core.errors import GeometryError, InputError
from gearcad.geometry import ShaperCutter
from gearcad.meshing.outline import MeshSizes, OutlineSide, SectorSides, held_radius
from gearcad.meshing.quads import LogPlane, QuadMesh, mesh_quads, mesh_quality, scaled_jacobians
from gearcad.meshing.sector import SectorMesh, mesh_sector

ROUNDING = 1e-9
"""mm per mm of module: what 16 digits leave of a mesh."""

LEAST_ANGLE, LEAST_JACOBIAN = 18.0, 0.3
"""Of triangles (deg) and of quadrangles, as those of external gears have them."""

SHAPED = ShaperCutter(teeth=25, tip_radius=0.15)
RINGS = {
    "form root": Gear(teeth=-70, normal_module=2.0, face_width=14),
    "sharp cutter": Gear(teeth=-70, normal_module=2.8, face_width=14, profile_shift=-1.2025, cutter=SHAPED),
    "few teeth": Gear(teeth=-30, normal_module=2, face_width=14, profile_shift=-0.4, cutter=ShaperCutter(teeth=18)),
    "full radius": Gear(
        teeth=-60, normal_module=1, face_width=9, cutter=ShaperCutter(teeth=22), rack=BasicRack(root_radius="full")
    ),
    "tip chamfer": Gear(teeth=-60, normal_module=1, face_width=9, body=Body(tip_chamfer=0.1), cutter=ShaperCutter(teeth=22)),
    "helical": Gear(teeth=-60, normal_module=2.5, face_width=9, helix_angle=45, cutter=ShaperCutter(teeth=22)),
    "tiny": Gear(teeth=-60, normal_module=0.01, face_width=0.1, cutter=ShaperCutter(teeth=22)),
    "huge": Gear(teeth=-60, normal_module=200, face_width=900, cutter=ShaperCutter(teeth=22)),
}
DEPTHS = (0.1, 0.5, 3.5)


def rim(gear: Gear, depth: float) -> float:
    return abs(gear.root_diameter) / 2 + depth * gear.normal_module


def exact_area(gear: Gear, held: float) -> float:
    """Of the sector (mm²): that inside the held circle, less what the profile of one pitch shuts off from it."""
    x, y = gear.profile.points(1e-7 * gear.normal_module).T
    return math.pi / gear.tooth_count * held**2 - float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) / 2


def areas(mesh: SectorSides, corners: int) -> np.ndarray:
    """Of all elements (mm²), signed: the shoelace over vertices, and two thirds of what the nodes between them bulge."""
    nodes = mesh.points[mesh.cells]
    total = np.zeros(len(nodes))
    for k in range(corners):
        start, end, middle = nodes[:, k], nodes[:, (k + 1) % corners], nodes[:, corners + k]
        total += (start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]) / 2
        bulge, chord = middle - start, end - start
        total += 2 / 3 * (bulge[:, 0] * chord[:, 1] - bulge[:, 1] * chord[:, 0])
    return total


def check_sides(gear: Gear, mesh: SectorSides, held: float) -> None:
    """Nodes on the profile and on both circles; one closed line in the order of the sides; cuts that fit their neighbours."""
    module, profile = gear.normal_module, gear.profile
    for sides, sign in ((("LEFT_FLANK", "LEFT_FILLET"), 1), (("RIGHT_FLANK", "RIGHT_FILLET"), -1)):
        for name in sides:
            x, y = mesh.points[mesh.sides[OutlineSide[name]]].T
            radius = np.hypot(x, y)
            steep = radius < profile.root_diameter / 2 * (1 - 1e-6)
            off = sign * np.arctan2(y, x) - np.radians(profile.half_angle(radius))
            assert np.abs(off[steep]).max() * radius.max() < 10 * ROUNDING * module
    for side, radius in ((OutlineSide.LEFT_ROOT, profile.root_diameter / 2), (OutlineSide.HELD, held)):
        if side in mesh.sides:
            assert np.hypot(*mesh.points[mesh.sides[side]].T) == pytest.approx(radius, rel=1e-12)
    chains = [mesh.sides[side] for side in OutlineSide if side in mesh.sides]
    assert all(one[-1] == other[0] for one, other in pairwise([*chains, chains[0]]))
    pitch = 2 * math.pi / gear.tooth_count
    turn = np.array([[math.cos(pitch), math.sin(pitch)], [-math.sin(pitch), math.cos(pitch)]])
    assert np.abs(mesh.points[mesh.behind] @ turn - mesh.points[mesh.ahead]).max() < ROUNDING * module
    assert np.diff(np.hypot(*mesh.points[mesh.ahead].T)).min() > 0, "from the root to the rim"


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("name", RINGS)
def test_any_ring_meshes_well_in_triangles(name: str, depth: float) -> None:
    gear = RINGS[name]
    mesh = mesh_sector(gear, rim(gear, depth))
    quality = mesh_quality(mesh.points, mesh.triangles)
    assert quality.least_angle > LEAST_ANGLE
    assert quality.mean_gamma > 0.94
    assert quality.least_jacobian > 0.75
    coarse = mesh_sector(gear, rim(gear, depth), MeshSizes().coarse())
    assert mesh_quality(coarse.points, coarse.triangles).least_jacobian > 0.15
    assert len(coarse.triangles) < 0.6 * len(mesh.triangles)
    assert np.abs(coarse.points[coarse.ahead] - mesh.points[mesh.ahead]).max() < ROUNDING * gear.normal_module


@pytest.mark.parametrize("name", RINGS)
def test_sectors_are_exactly_what_they_stand_for(name: str) -> None:
    gear = RINGS[name]
    held = rim(gear, 2.0)
    fine = MeshSizes().refined(2)
    for mesh, corners in ((mesh_sector(gear, held, fine), 3), (mesh_quads(gear, held, fine), 4)):
        own = areas(mesh, corners)
        assert own.min() > 0, "counter-clockwise"
        assert own.sum() == pytest.approx(exact_area(gear, held), rel=1e-6)
        check_sides(gear, mesh, held)


def test_triangles_and_quadrangles_have_the_same_sides() -> None:
    gear = RINGS["sharp cutter"]
    held = rim(gear, 3.5)
    triangles, quads = mesh_sector(gear, held), mesh_quads(gear, held, MeshSizes())
    assert isinstance(triangles, SectorMesh) and isinstance(quads, QuadMesh)
    for side in OutlineSide:
        for end in (0, -1):
            one, other = (mesh.points[mesh.sides[side][end]] for mesh in (triangles, quads))
            assert one == pytest.approx(other, abs=1e-9)


def test_random_rings_are_filled_by_good_quadrangles() -> None:
    random, worst, meshed = np.random.default_rng(16), 1.0, 0
    while meshed < 60:
        try:
            gear = Gear(
                teeth=-int(random.integers(20, 301)),
                normal_module=float(10 ** random.uniform(-2, 2.3)),
                face_width=500.0,
                helix_angle=float(random.choice([0.0, random.uniform(-45, 45)])),
                profile_shift=float(random.uniform(-1.2, 0.6)),
                cutter=ShaperCutter(teeth=int(random.integers(10, 60)), tip_radius=float(random.uniform(0.05, 0.4))),
            )
        except InputError:
            continue
        held = rim(gear, float(random.choice([0.1, 1.0, 3.5, 20.0])))
        mesh = mesh_quads(gear, held, MeshSizes().coarse())
        worst = min(worst, float(scaled_jacobians(mesh.points[mesh.quads]).min()))
        check_sides(gear, mesh, held)
        meshed += 1
    assert worst > 0.2


@pytest.mark.parametrize("inward", [False, True])
def test_places_in_the_plane_of_logarithms_come_back(inward: bool) -> None:
    plane, points = LogPlane(inward), np.array([[3.0, 0.2], [5.0, -1.0]])
    places = plane.places(points)
    assert plane.points(places) == pytest.approx(points, rel=1e-15)
    assert places[0, 1] == pytest.approx(plane.height(float(np.hypot(3.0, 0.2))), rel=1e-15)
    assert (places[1, 1] > places[0, 1]) is not inward, "tips are up"


def test_a_ring_is_held_on_its_rim_or_far_enough_from_its_roots() -> None:
    gear = RINGS["form root"]
    assert held_radius(gear) == abs(gear.root_diameter) / 2 + 3.5 * gear.normal_module
    rimmed = Gear(teeth=-70, normal_module=2.0, face_width=14, body=Body(rim_diameter=180.0))
    assert held_radius(rimmed) == 90.0


def test_a_root_without_a_fillet_is_refused_by_its_name() -> None:
    sharp = Gear(teeth=-70, normal_module=2.0, face_width=14, cutter=ShaperCutter(tip_radius=0.0))
    with pytest.raises(GeometryError, match=r"^cutter\.tip_radius = 0 m_n: must be larger for finite elements"):
        mesh_sector(sharp, 90.0)
