"""Meshes of tooth sectors and bodies in hexahedra: exactly on the profile, closed, named all over, well shaped."""

import math
import tracemalloc
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from support.checks import COARSE
from support.clearance import distance_to_section
from support.modified import depth_off, unturned
from support.samples import GEARS as BODY_GEARS
from support.samples import modified

from gearcad import BasicRack, Body, Gear, GearPair
from gearcad.core.errors import ParameterError
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import body_planes, mesh_body, swept_notices
from gearcad.meshing.bodies.quality import quality
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.quads import mesh_quality
from gearcad.meshing.sector import SectorMesh, mesh_sector

ROUNDING = 1e-9
"""mm per mm of module: what 16 digits leave of a mesh."""

LEAST_ANGLE = 18.0
"""Degrees; triangles below 15 begin to spoil the matrix, and a curved outline cannot do much better than 20."""

GEARS = {
    "z8 undercut": Gear(teeth=8, normal_module=1.0, face_width=10),
    "z13 undercut": Gear(teeth=13, normal_module=2.0, face_width=10),
    "z18": Gear(teeth=18, normal_module=1.5, face_width=10, profile_shift=0.3422),
    "z161": Gear(teeth=161, normal_module=1.5, face_width=10),
    "z300": Gear(teeth=300, normal_module=1.0, face_width=10),
    "full radius": Gear(teeth=24, normal_module=1.0, face_width=10, rack=BasicRack(root_radius="full")),
    "tip chamfer": Gear(teeth=24, normal_module=1.0, face_width=10, body=Body(tip_chamfer=0.1)),
    "helical": Gear(teeth=13, normal_module=2.5, face_width=18, helix_angle=28, profile_shift=0.107),
    "small": Gear(teeth=30, normal_module=0.1, face_width=1),
    "large": Gear(teeth=30, normal_module=20.0, face_width=200),
}
DEPTHS = (0.05, 0.5, 4.0)
"""Rim below the root in modules: nearly none, thin, and the usual one."""

Z18 = GEARS["z18"]


def inner_radius(gear: Gear, depth: float) -> float:
    """Radius (mm) of the inner circle `depth` modules below the root."""
    return max(gear.root_diameter / 2 - depth * gear.normal_module, 0.3 * gear.root_diameter / 2)


@pytest.fixture(scope="module")
def mesh() -> SectorMesh:
    return mesh_sector(Z18, inner_radius(Z18, 4))


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("name", GEARS)
def test_any_gear_meshes_well(name: str, depth: float) -> None:
    gear = GEARS[name]
    mesh = mesh_sector(gear, inner_radius(gear, depth))
    quality = mesh_quality(mesh.points, mesh.triangles)
    assert quality.least_angle > LEAST_ANGLE
    assert quality.mean_gamma > 0.94
    assert quality.least_jacobian > 0.75


@pytest.mark.parametrize("name", GEARS)
def test_a_coarse_mesh_is_not_folded_and_fits_the_fine_one(name: str) -> None:
    gear = GEARS[name]
    fine, coarse = (mesh_sector(gear, inner_radius(gear, 4), sizes) for sizes in (MeshSizes(), MeshSizes().coarse()))
    assert mesh_quality(coarse.points, coarse.triangles).least_jacobian > 0.2
    assert len(coarse.triangles) < 0.6 * len(fine.triangles)
    assert np.abs(coarse.points[coarse.ahead] - fine.points[fine.ahead]).max() < ROUNDING * gear.normal_module


@pytest.mark.parametrize("name", GEARS)
def test_sides_lie_on_the_profile(name: str) -> None:
    gear = GEARS[name]
    mesh = mesh_sector(gear, inner_radius(gear, 4))
    for left, right, kinds in (
        (OutlineSide.LEFT_FLANK, OutlineSide.RIGHT_FLANK, "flank"),
        (OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET, "fillet"),
    ):
        for side, sign in ((left, 1), (right, -1)):
            points = mesh.points[mesh.sides[side]]
            radius = np.hypot(*points.T)
            expected = np.radians(gear.profile.half_angle(radius))
            angle = sign * np.arctan2(points[:, 1], points[:, 0])
            # At the deepest point of the trochoid a radius says little about the angle.
            steep = radius > gear.root_diameter / 2 * (1 + 1e-6)
            assert np.abs(angle - expected)[steep].max() * radius.max() < ROUNDING * gear.normal_module, kinds


def test_ends_of_the_flank_are_those_of_the_gear(mesh: SectorMesh) -> None:
    radius = np.hypot(*mesh.points[mesh.sides[OutlineSide.LEFT_FLANK]].T)
    assert radius.max() == pytest.approx(Z18.tip_diameter / 2, abs=ROUNDING)
    assert radius.min() == pytest.approx(Z18.form_diameter / 2, abs=ROUNDING)


def test_tip_root_and_hub_are_round(mesh: SectorMesh) -> None:
    for side, radius in (
        (OutlineSide.TIP, Z18.tip_diameter / 2),
        (OutlineSide.LEFT_ROOT, Z18.root_diameter / 2),
        (OutlineSide.RIGHT_ROOT, Z18.root_diameter / 2),
        (OutlineSide.HELD, inner_radius(Z18, 4)),
    ):
        assert np.hypot(*mesh.points[mesh.sides[side]].T) == pytest.approx(radius, abs=ROUNDING)


def test_cuts_fit(mesh: SectorMesh) -> None:
    pitch = 2 * math.pi / Z18.teeth
    turn = np.array([[math.cos(pitch), math.sin(pitch)], [-math.sin(pitch), math.cos(pitch)]])
    assert np.abs(mesh.points[mesh.behind] @ turn - mesh.points[mesh.ahead]).max() < ROUNDING
    assert np.diff(np.hypot(*mesh.points[mesh.ahead].T)).max() < 0, "from the root inwards"


def test_sides_join_into_one_outline_around_the_section(mesh: SectorMesh) -> None:
    chains = [mesh.sides[side] for side in OutlineSide]
    assert all(one[-1] == other[0] for one, other in pairwise([*chains, chains[0]]))
    outline = np.concatenate([chain[:-1] for chain in chains])
    assert len(set(outline.tolist())) == len(outline)
    # Area from the outline by Simpson's rule, exact for quadratic edges, against that of the elements.
    first, middle, last = mesh.points[outline[::2]], mesh.points[outline[1::2]], mesh.points[np.roll(outline, -2)[::2]]

    def cross(a: Any, b: Any) -> Any:
        return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]

    by_outline = (4 * cross(first, middle) + 4 * cross(middle, last) - cross(first, last)).sum() / 6
    assert by_outline == pytest.approx(element_area(mesh.points, mesh.triangles), rel=1e-12)


def element_area(points: Any, triangles: Any) -> float:
    """Area (mm²) of quadratic triangles: each straight one, and two thirds of what its mid-side nodes bulge."""
    a, b, c, *mids = (points[triangles[:, k]] for k in range(6))
    corners = (a, b, c)

    def cross(u: Any, v: Any) -> Any:
        return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]

    area = cross(b - a, c - a) / 2
    for k, middle in enumerate(mids):
        start, end = corners[k], corners[(k + 1) % 3]
        area = area + 2 / 3 * cross(middle - start, end - start)
    return float(area.sum())


def test_sizes_are_kept(mesh: SectorMesh) -> None:
    def edges(side: OutlineSide) -> Any:
        return np.linalg.norm(np.diff(mesh.points[mesh.sides[side][::2]], axis=0), axis=1) / Z18.normal_module

    sizes = MeshSizes()
    assert edges(OutlineSide.LEFT_FLANK).max() < sizes.flank * 1.1
    assert edges(OutlineSide.LEFT_FLANK).min() == pytest.approx(sizes.corner, rel=0.3)
    assert edges(OutlineSide.LEFT_FILLET).max() == pytest.approx(sizes.fillet, rel=0.1)
    assert edges(OutlineSide.AHEAD).max() < sizes.rim


def test_refined_sizes_halve_the_edges() -> None:
    counts = [
        len(mesh_sector(Z18, inner_radius(Z18, 4), MeshSizes().refined(factor)).sides[OutlineSide.LEFT_FILLET])
        for factor in (1, 2)
    ]
    assert (counts[1] - 1) / (counts[0] - 1) == pytest.approx(2, rel=0.1)


def test_meshes_scale_with_the_module() -> None:
    """No length of any other unit hides in the mesh."""
    small, large = (
        mesh_sector(gear, inner_radius(gear, 4))
        for gear in (Gear(teeth=30, normal_module=m, face_width=10) for m in (0.125, 16.0))
    )
    for side in OutlineSide:
        assert np.abs(small.points[small.sides[side]] * 128 - large.points[large.sides[side]]).max() < 1e-9


@pytest.mark.parametrize("name", [each.name for each in MeshSizes.__dataclass_fields__.values()])
def test_sizes_must_be_positive(name: str) -> None:
    with pytest.raises(ParameterError, match=name):
        replace(MeshSizes(), **{name: 0.0})


def test_quality_of_known_triangles() -> None:
    height = math.sqrt(3) / 2
    points = np.array([[0, 0], [1, 0], [0.5, height], [0.5, 0], [0.75, height / 2], [0.25, height / 2]])
    triangle = np.arange(6)[None]
    even = mesh_quality(points, triangle)
    assert (even.least_angle, even.least_gamma, even.least_jacobian) == pytest.approx((60, 1, 1))
    right = mesh_quality(np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]), triangle)
    assert right.least_angle == pytest.approx(45)
    assert right.least_gamma == pytest.approx(2 * (math.sqrt(2) - 1))
    # A mid-side node half the height inwards: the edge leaves its ends along the other two edges.
    bent = points.copy()
    bent[3, 1] = height / 2
    assert mesh_quality(bent, triangle).least_jacobian == pytest.approx(0, abs=1e-12)


def test_a_pair_at_any_shift_meshes() -> None:
    """Thin tips and fat roots, as they come out of split shifts."""
    for shift in (-0.3, 0.0, 0.6):
        pair = GearPair(
            pinion=Gear(teeth=20, normal_module=1.0, face_width=10, profile_shift=shift),
            wheel=Gear(teeth=35, normal_module=1.0, face_width=10, profile_shift=-shift),
        )
        for gear in (pair.pinion, pair.wheel):
            mesh = mesh_sector(gear, inner_radius(gear, 4))
            assert mesh_quality(mesh.points, mesh.triangles).least_angle > LEAST_ANGLE


EXACT = 1e-9
"""mm: the promise; rounding is below 1e-13."""

KINDS = (Element.HEX8, Element.HEX20)


def body(gear: Gear, teeth: int | None = 1, element: Element = Element.HEX20, sizes: MeshSizes = COARSE) -> ElementMesh:
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    return mesh_body(gear, teeth=teeth, held_radius=inner, sizes=sizes, planes=None, element=element)


def flux(mesh: ElementMesh, faces: np.ndarray) -> float:
    """Volume (mm³) inside faces by their vertices: of tetrahedra with the origin, for both ways to halve a face."""
    a, b, c, d = (mesh.points[faces[:, k]] for k in range(4))
    return (
        float(sum(np.linalg.det(np.stack(corners, 1)).sum() for corners in ((a, b, c), (a, c, d), (a, b, d), (b, c, d)))) / 12
    )


@pytest.mark.parametrize("element", KINDS)
@pytest.mark.parametrize("teeth", [1, 3, None])
def test_names_cover_the_surface(element: Element, teeth: int | None) -> None:
    """Each side of an element that no other shares has one name, and faces look outwards: they hold the elements' volume."""
    gear = modified(BODY_GEARS["undercut"])
    mesh = body(gear, teeth, element)
    local = np.array(element.shape.faces)
    every = np.sort(mesh.cells[:, local[:, :4]].reshape(-1, 4), axis=1)
    _, first, uses = np.unique(every, axis=0, return_index=True, return_counts=True)
    assert uses.max() == 2
    named = np.concatenate([faces.elements.astype(int) * 6 + faces.sides for faces in mesh.sides.values()])
    assert sorted(named.tolist()) == sorted(first[uses == 1].tolist())
    assert len(np.unique(mesh.cells)) == len(mesh.points) == mesh.cells.max() + 1
    outside = flux(mesh, np.concatenate([mesh.face_cells(name) for name in mesh.sides]))
    inside = flux(mesh, mesh.cells[:, local].reshape(-1, local.shape[1]))
    assert outside == pytest.approx(inside, rel=1e-12) and outside > 0
    assert set(mesh.matched) == (set() if teeth is None else {"cut"})
    assert {"end_back", "end_front", "bore", "left_flank_0"} < set(mesh.sides)
    ends = [mesh.points[mesh.nodes(name), 2] for name in ("end_back", "end_front")]
    assert [set(z) for z in ends] == [{0.0}, {gear.face_width}]


@pytest.mark.parametrize("element", KINDS)
def test_cuts_turn_into_each_other(element: Element) -> None:
    gear = modified(BODY_GEARS["left hand"])
    mesh = body(gear, 3, element)
    behind, ahead = mesh.matched["cut"].T
    assert sorted(behind) == mesh.nodes("cut_behind").tolist() and sorted(ahead) == mesh.nodes("cut_ahead").tolist()
    turn = 3 * 2 * math.pi / gear.teeth
    turned = mesh.points[behind] @ np.array(
        [[math.cos(turn), math.sin(turn), 0], [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    assert turned == pytest.approx(mesh.points[ahead], abs=EXACT)


@pytest.mark.parametrize("name", [*BODY_GEARS])
@pytest.mark.parametrize("changed", [False, True])
def test_nodes_are_on_the_helicoid(name: str, changed: bool) -> None:
    """Of all flanks and fillets, ends of the body included: turned back by the depth that is specified, on the screw."""
    gear = modified(BODY_GEARS[name]) if changed else BODY_GEARS[name]
    mesh = body(gear, 3)
    for side in ("left", "right"):
        for tooth in (gear.teeth - 1, 0, 1):
            flank, fillet = (mesh.points[mesh.nodes(f"{side}_{part}_{tooth}")] for part in ("flank", "fillet"))
            assert np.abs(depth_off(gear, flank)).max() < EXACT
            assert distance_to_section(gear, unturned(gear, fillet)).max() < EXACT
            assert distance_to_section(gear, unturned(gear, flank)).max() < EXACT
    middles = mesh.points[mesh.cells[:, 8:]] - mesh.points[mesh.cells[:, np.array(mesh.element.shape.edges)]].mean(axis=2)
    assert np.abs(middles[:, 8:, 2]).max() < EXACT, "half-way up"


def test_planes_are_where_reliefs_begin() -> None:
    gear = modified(BODY_GEARS["spur"], "end_relief")
    planes = body_planes(gear, COARSE)
    assert planes[0] == 0 and planes[-1] == gear.face_width and (np.diff(planes) > 0).all()
    for start in gear.flank_form.height_breaks:
        assert start in planes
    thick = np.diff(body_planes(replace(gear, face_width=100), MeshSizes()))
    assert thick[0] < thick[len(thick) // 2] / 2 and np.maximum(thick[1:] / thick[:-1], thick[:-1] / thick[1:]).max() < 1.5
    assert len(body_planes(gear, COARSE, layers=11)) == 12
    assert len(body_planes(replace(BODY_GEARS["spur"], face_width=0.1), COARSE)) == 3
    with pytest.raises(ParameterError, match="layers = 2: must be at least 3"):
        body_planes(gear, COARSE, layers=2)


@pytest.mark.parametrize(("element", "planes"), [("quad8", None), ("hex20", [0.0, 5.0]), ("hex20", [0.0, 6.0, 5.0, 10.0])])
def test_what_cannot_be_swept_is_refused(element: str, planes: list[float] | None) -> None:
    given = None if planes is None else np.array(planes)
    with pytest.raises(ParameterError, match="must"):
        mesh_body(BODY_GEARS["spur"], teeth=1, held_radius=20.0, sizes=COARSE, planes=given, element=Element(element))


def test_what_is_left_out_is_said() -> None:
    assert swept_notices(BODY_GEARS["spur"]) == []
    (notice,) = swept_notices(BODY_GEARS["chamfered"])
    assert notice.text == "hexahedra are swept along the helix, without keyway, hub and end chamfers; tet10 has them"
    (notice,) = swept_notices(Gear(teeth=20, normal_module=2.0, face_width=10, body=Body(end_chamfer=1)))
    assert "without end chamfers;" in notice.text


def test_meshing_takes_no_more_than_twice_the_mesh() -> None:
    """Of a modified ring; its quality takes no more either."""
    gear = modified(BODY_GEARS["right hand"])
    body(gear)  # what is imported the first time is no mesh
    tracemalloc.start()
    mesh = body(gear, None, sizes=replace(COARSE.refined(3), deviation=None))
    made = tracemalloc.get_traced_memory()[1]
    tracemalloc.reset_peak()
    assert quality(mesh).least_jacobian > 0.5
    measured = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert mesh.nbytes > 4e6 and max(made, measured) < 2 * mesh.nbytes
