"""Meshes of sectors, rings and internal pairs: sides, sizes and how they stand."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from gearcad import BasicRack, Body, FlankModification, Gear, GearPair
from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.records import PerGear
from gearcad.geometry import ShaperCutter
from gearcad.meshing.bodies.body_mesh import body_sizes, contacts, expected_amount, posed
from gearcad.meshing.bodies.exactness import deviations, side_deviations
from gearcad.meshing.bodies.gear_faces import TetrahedronGrading
from gearcad.meshing.bodies.quality import measure_whole, quality
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.tetrahedra import mesh_tetrahedra
from gearcad.meshing.fem import Element, scaled_jacobians
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.outline import MeshSizes, OutlineSide, SectorSides, held_radius
from gearcad.meshing.plan import plan_mesh
from gearcad.meshing.quads import LogPlane, QuadMesh, mesh_quads, mesh_quality
from gearcad.meshing.result import run_mesh
from gearcad.meshing.sector import SectorMesh, mesh_sector
from gearcad.solids.exact.inertia import mass_properties

_ALM: dict[str, Any] = {
    "teeth": -70, "normal_module": 2.8, "face_width": 14.0, "profile_shift": -1.2025,
    "cutter": ShaperCutter(teeth=25, tip_radius=0.15), "body": Body(rim_diameter=240.0),
}  # fmt: skip

RINGS = {
    "shaped": {},
    "form root": {"cutter": ShaperCutter(tip_radius=0.15)},
    "full radius, no rim": {
        "teeth": -40, "profile_shift": 0.0, "cutter": ShaperCutter(), "rack": BasicRack(root_radius="full"), "body": Body(),
    },
    "helical, modified": {
        "teeth": -60, "normal_module": 4.0, "profile_shift": 0.3, "helix_angle": -28.0,
        "cutter": ShaperCutter(teeth=22, tip_radius=0.3), "body": Body(rim_diameter=300.0, tip_chamfer=0.3),
        "modification": FlankModification(
            tip_relief=20, tip_relief_length=1.5, root_relief=10, root_relief_length=1, lead_crowning=10, twist=8,
            end_relief=5, end_relief_length=2,
        ),
    },
}  # fmt: skip


def _ring(name: str) -> Gear:
    return Gear(**_ALM | RINGS[name])


@pytest.mark.parametrize(
    ("element", "what"), [("quad8", "teeth:5"), ("tri6", "teeth:3"), ("hex20", "teeth:3"), ("hex8", "sector")]
)
@pytest.mark.parametrize("name", RINGS)
def test_every_gate_is_passed(name: str, element: str, what: str) -> None:
    """Nodes on the exact, modified surfaces, closed, as large as the exact ring, and as many as was told before."""
    gear = _ring(name)
    plan = plan_mesh(MeshOptions(element=element, what=what), {"gear": gear}, None)
    judged = run_mesh(plan, "ring").judged["gear"]
    assert [gate for gate in judged.gates if not gate.passed] == []
    assert plan.amount is not None
    if element != "tri6":  # a ring of triangles is exact too, but meshed to be counted
        assert judged.elements == plan.amount.elements
    assert judged.deviations.nodes < 1e-12


def test_the_area_is_that_between_the_outline_and_the_rim() -> None:
    gear = _ring("shaped")
    x, y = gear.profile.contour(2e-7).T
    opening = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    mesh = mesh_section(gear, teeth=None, held_radius=120.0, sizes=body_sizes(gear), element=Element.QUAD8)
    assert measure_whole(mesh) == pytest.approx(math.pi * 120.0**2 - opening, rel=1e-7)


def test_left_is_as_a_tooth_is_seen_with_its_tip_up() -> None:
    """The teeth of a ring point inwards: of the tooth on +x the left flank has y < 0."""
    gear = _ring("shaped")
    mesh = mesh_section(gear, teeth=3, held_radius=120.0, sizes=body_sizes(gear), element=Element.QUAD8)
    for side in ("flank", "fillet", "root"):
        assert mesh.points[mesh.nodes(f"left_{side}_0"), 1].max() < 0 < mesh.points[mesh.nodes(f"right_{side}_0"), 1].min()
    assert np.hypot(*mesh.points[mesh.nodes("rim"), :2].T) == pytest.approx(120.0, abs=1e-9)
    assert {"cut_ahead", "cut_behind", "tip_1", "tip_69"} <= set(mesh.sides)
    with pytest.raises(ParameterError, match=r"held_radius = 90 mm: must be a number above 104\.867 mm"):
        mesh_section(gear, teeth=3, held_radius=90.0, sizes=body_sizes(gear), element=Element.QUAD8)


def _nearest(points: np.ndarray, chain: np.ndarray) -> tuple[float, float]:
    """Least signed distance (mm) of points (n, 2) from a polyline, positive on its left, and the place of it along x."""
    start, step = chain[:-1], np.diff(chain, axis=0)
    share = np.clip(((points[:, None] - start) * step).sum(-1) / (step**2).sum(-1), 0, 1)
    off = points[:, None] - start - share[..., None] * step
    distance = np.hypot(*np.moveaxis(off, -1, 0))
    at = distance.argmin(axis=1)
    rows = np.arange(len(points))
    cross = step[at, 0] * off[rows, at, 1] - step[at, 1] * off[rows, at, 0]
    return float((np.sign(cross) * distance[rows, at]).min()), float(distance.min())


@pytest.mark.parametrize("roll", [-4.0, 0.0, 5.0])
def test_left_flanks_touch_and_do_not_overlap(roll: float) -> None:
    """Teeth of the pinion stand at those of the same number in a ring: as near as the elements are to the exact flanks."""
    pinion = Gear(teeth=22, normal_module=2.8, face_width=16.0, profile_shift=0.5, tooth_thinning=0.04)
    pair = GearPair(pinion=pinion, wheel=_ring("shaped"))
    sizes = body_sizes(pinion, 0.05)
    meshes = PerGear(
        mesh_section(pinion, teeth=5, held_radius=15.0, sizes=sizes, element=Element.QUAD8),
        mesh_section(pair.wheel, teeth=5, held_radius=120.0, sizes=sizes, element=Element.QUAD8),
    )
    mesh, touching = posed(pair, meshes, roll), contacts(pair, roll)
    assert list(touching.pinion) == list(touching.wheel)
    for tooth in touching.pinion:
        own, mate = (
            mesh.points[mesh.nodes(f"{role}_left_flank_{tooth % gear.tooth_count}"), :2]
            for role, gear in (("pinion", pinion), ("wheel", pair.wheel))
        )
        own = own[np.argsort(own[:, 0])]
        signed, nearest = _nearest(mate, own)
        assert nearest < 2e-4
        assert signed > -3e-4  # the tooth of the pinion is on the right of its left flank, run from root to tip
    # the lengths on the ring are those of its signed line of action
    assert all(length < 0 for length in touching.wheel.values())


def test_amounts_of_rings_are_known_before() -> None:
    gear = _ring("form root")
    sizes = body_sizes(gear).scaled(0.5)
    for element in (Element.QUAD8, Element.HEX20):
        told = expected_amount(gear, teeth=None, held_radius=120.0, sizes=sizes, element=element)
        assert told.elements % 70 == 0


_SMALL: dict[str, Any] = {
    "teeth": -14, "normal_module": 2.0, "face_width": 6.0, "helix_angle": 12.0,
    "rack": BasicRack(addendum=0.4, dedendum=0.8, root_radius=0.5),
}  # fmt: skip

_TETRAHEDRA = {
    "plain": {"body": Body(rim_diameter=44.0)},
    "bolts, chamfers, modified": {
        "body": Body(rim_diameter=44.0, bolt_circle=38.0, bolt_holes=5, bolt_diameter=2.0, end_chamfer=0.3),
        "modification": FlankModification(tip_relief=20, tip_relief_length=0.5),
    },
}


@pytest.mark.parametrize("name", [pytest.param(n, marks=[] if n == "plain" else pytest.mark.long) for n in _TETRAHEDRA])
def test_tetrahedra_fill_a_ring(name: str) -> None:
    """Nodes on the exact faces, volume that of the solid by its own boundary, sides named as those of sections."""
    gear = Gear(**_SMALL | _TETRAHEDRA[name])
    mesh = mesh_tetrahedra(gear, size=3.0, grading=TetrahedronGrading(fillet_elements=0.3, deviation=None))
    assert deviations(mesh, gear).nodes < 1e-12
    assert side_deviations(mesh, gear, 22.0).nodes < 1e-9
    assert quality(mesh).least_jacobian > 0
    assert measure_whole(mesh) == pytest.approx(mass_properties(gear, 1e9).mass, rel=3e-6)
    assert mesh.points[mesh.nodes("left_flank_0"), 1].mean() < 0 < mesh.points[mesh.nodes("right_flank_0"), 1].mean()
    assert {"rim", "end_back", "end_front", "tip_13", "left_fillet_7"} <= set(mesh.sides)
    if gear.body.bolt_holes:
        holes = mesh.points[mesh.nodes("bolt_holes"), :2]
        turns = 2 * np.pi / 5 * np.arange(5)
        centres = 19.0 * np.stack([np.cos(turns), np.sin(turns)], -1)
        off = np.linalg.norm(holes[:, None] - centres, axis=-1).min(axis=1)
        assert off == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("element", "code"), [("hex20", "swept-body"), ("quad8", "section-body")])
def test_bolt_holes_that_are_left_out_are_told(element: str, code: str) -> None:
    body = Body(rim_diameter=240.0, bolt_circle=226.0, bolt_holes=8, bolt_diameter=6.6)
    gear = Gear(**_ALM | {"body": body})
    plan = plan_mesh(MeshOptions(element=element, what="sector"), {"gear": gear}, None)
    told = {notice.code: notice.text for notice in plan.notices}
    assert "bolt holes" in told[code]


ROUNDING = 1e-9
"""mm per mm of module: what 16 digits leave of a mesh."""

LEAST_ANGLE, LEAST_JACOBIAN = 18.0, 0.3
"""Of triangles (deg) and of quadrangles, as those of external gears have them."""

SHAPED = ShaperCutter(teeth=25, tip_radius=0.15)
SECTOR_RINGS = {
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
@pytest.mark.parametrize("name", SECTOR_RINGS)
def test_any_ring_meshes_well_in_triangles(name: str, depth: float) -> None:
    gear = SECTOR_RINGS[name]
    mesh = mesh_sector(gear, rim(gear, depth))
    quality = mesh_quality(mesh.points, mesh.triangles)
    assert quality.least_angle > LEAST_ANGLE
    assert quality.mean_gamma > 0.94
    assert quality.least_jacobian > 0.75
    coarse = mesh_sector(gear, rim(gear, depth), MeshSizes().coarse())
    assert mesh_quality(coarse.points, coarse.triangles).least_jacobian > 0.15
    assert len(coarse.triangles) < 0.6 * len(mesh.triangles)
    assert np.abs(coarse.points[coarse.ahead] - mesh.points[mesh.ahead]).max() < ROUNDING * gear.normal_module


@pytest.mark.parametrize("name", SECTOR_RINGS)
def test_sectors_are_exactly_what_they_stand_for(name: str) -> None:
    gear = SECTOR_RINGS[name]
    held = rim(gear, 2.0)
    fine = MeshSizes().refined(2)
    for mesh, corners in ((mesh_sector(gear, held, fine), 3), (mesh_quads(gear, held, fine), 4)):
        own = areas(mesh, corners)
        assert own.min() > 0, "counter-clockwise"
        assert own.sum() == pytest.approx(exact_area(gear, held), rel=1e-6)
        check_sides(gear, mesh, held)


def test_triangles_and_quadrangles_have_the_same_sides() -> None:
    gear = SECTOR_RINGS["sharp cutter"]
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
        worst = min(worst, float(scaled_jacobians(Element.QUAD8, mesh.points[mesh.quads]).min()))
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
    gear = SECTOR_RINGS["form root"]
    assert held_radius(gear) == abs(gear.root_diameter) / 2 + 3.5 * gear.normal_module
    rimmed = Gear(teeth=-70, normal_module=2.0, face_width=14, body=Body(rim_diameter=180.0))
    assert held_radius(rimmed) == 90.0


def test_a_root_without_a_fillet_is_refused_by_its_name() -> None:
    sharp = Gear(teeth=-70, normal_module=2.0, face_width=14, cutter=ShaperCutter(tip_radius=0.0))
    with pytest.raises(GeometryError, match=r"^cutter\.tip_radius = 0 m_n: must be larger for finite elements"):
        mesh_sector(sharp, 90.0)
