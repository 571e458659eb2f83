"""Sizes of meshes: elements and memory before they are made; lengths, areas, volumes and their error against exact gears."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.checks import COARSE
from support.commands import invoke
from support.samples import AMOUNTS, modified
from support.samples import GEARS as EXACTNESS_GEARS

import gearcad
from gearcad import BasicRack, Body, FlankModification, Gear, GearPair, GeometryError, Load, Material
from gearcad.check import CheckOptions, run
from gearcad.check.run import check_pair, expected_solid
from gearcad.check.task import CheckTask, check_task
from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats
from gearcad.jobs import mesh as mesh_job
from gearcad.meshing import Faces, plan
from gearcad.meshing.bodies.body_mesh import Amount, body_sizes, expected_amount, factor_for, mesh_body
from gearcad.meshing.bodies.element_mesh import ElementMesh
from gearcad.meshing.bodies.exactness import deviations, exact_area, exact_volume
from gearcad.meshing.bodies.quality import measure_side, measure_whole
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import Element
from gearcad.meshing.outline import MeshSizes, held_radius
from gearcad.solids.exact.inertia import mass_properties

GEARS = {
    "z7": Gear(teeth=7, normal_module=2.0, face_width=4, profile_shift=0.4),
    "z17 full radius": Gear(teeth=17, normal_module=0.5, face_width=3, profile_shift=0.2, body=Body(tip_chamfer=0.05)),
    "z30": Gear(teeth=30, normal_module=5.0, face_width=8, helix_angle=20),
}

ZONES = {-1: ContactRefinement(length=5.0, half_width=0.2, edge=0.05)}


def amount(mesh: ElementMesh) -> Amount:
    return Amount(len(mesh.cells), len(mesh.points), mesh.nbytes)


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6])
@pytest.mark.parametrize(("teeth", "share"), [(1, 0.7), (5, 0.5), (None, 0.0)])
def test_sections_have_as_many_elements_as_expected(teeth: int | None, share: float, element: Element, name: str) -> None:
    gear = GEARS[name]
    radius = share * gear.root_diameter / 2
    contacts = ZONES if name == "z30" else {}
    what = dict(teeth=teeth, held_radius=radius, sizes=body_sizes(gear).scaled(0.4), element=element)
    found = amount(mesh_section(gear, **what, contacts=contacts))
    expected = expected_amount(gear, **what, contacts=contacts)
    if element is Element.TRI6 and not share:
        assert expected == pytest.approx(found, rel=2e-3), "where gmsh fills a disc, it hangs on the last digits"
    else:
        assert expected == found


@pytest.mark.parametrize("element", [Element.HEX8, Element.HEX20])
@pytest.mark.parametrize(("teeth", "share"), [(3, 0.7), (None, 0.0)])
def test_bodies_have_as_many_elements_as_expected(teeth: int | None, share: float, element: Element) -> None:
    gear = GEARS["z7"]
    what = dict(teeth=teeth, held_radius=share * gear.root_diameter / 2, sizes=body_sizes(gear, 1.5), element=element)
    assert expected_amount(gear, **what) == amount(mesh_body(gear, **what, planes=None))


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize(
    ("element", "teeth", "elements"),
    [
        (Element.QUAD8, 1, 150),
        (Element.QUAD8, None, 100_000),
        (Element.TRI6, 1, 1000),
        (Element.HEX20, None, 10**6),
        (Element.HEX8, 3, 10**7),
    ],
)
def test_as_many_elements_as_asked_for(element: Element, teeth: int | None, elements: int, name: str) -> None:
    gear = GEARS[name]
    usual = body_sizes(gear)

    def count(factor: float) -> int:
        sizes = usual.scaled(factor)
        radius = 0.7 * gear.root_diameter / 2
        return expected_amount(gear, teeth=teeth, held_radius=radius, sizes=sizes, element=element).elements

    factor = factor_for(elements, count, element.shape.dimension)
    assert count(factor) == pytest.approx(elements, rel=0.1)


def test_what_no_layout_has_is_refused() -> None:
    with pytest.raises(ParameterError, match="near is 12"):
        factor_for(5, lambda factor: 12 * max(1, round(factor)), 2)
    with pytest.raises(ParameterError, match="elements"):
        factor_for(0, round, 2)
    with pytest.raises(ParameterError, match="tet10"):
        expected_amount(GEARS["z7"], teeth=None, held_radius=1.0, sizes=body_sizes(GEARS["z7"]), element=Element.TET10)


@pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6])
@pytest.mark.parametrize("module", [0.2, 20.0])
@pytest.mark.parametrize(("teeth", "shift"), [(6, 0.35), (14, -0.1), (200, 0.3)])
def test_usual_sizes_are_within_half_a_micrometre(teeth: int, shift: float, module: float, element: Element) -> None:
    gear = Gear(teeth=teeth, normal_module=module, face_width=module, profile_shift=shift)
    mesh = mesh_section(gear, teeth=1, held_radius=0.8 * gear.root_diameter / 2, sizes=body_sizes(gear), element=element)
    found = deviations(mesh, gear)
    assert found.nodes < 1e-9
    assert found.between < 0.5


def test_a_size_is_the_edge_on_the_flank() -> None:
    gear = GEARS["z30"]
    mesh = mesh_section(gear, teeth=1, held_radius=60.0, sizes=body_sizes(gear, 0.9), element=Element.TRI6)
    faces = mesh.points[mesh.face_cells("left_flank_0")[:, :2]]
    lengths = ((faces[:, 1] - faces[:, 0]) ** 2).sum(axis=1) ** 0.5
    assert lengths.max() == pytest.approx(0.9, rel=0.1)


HELICAL = Gear(teeth=23, normal_module=2, face_width=12, helix_angle=-18, body=Body(bore=20))

LITTLE = 2.0e9
"""Bytes of a machine that has no room for rings of fine elements."""


def test_more_nodes_than_numbers_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: 1e18)
    with pytest.raises(ParameterError, match=r"^size = 0.01 mm: makes .*a file numbers at most 2147483647; they take about"):
        gearcad.mesh(HELICAL, size=0.01)


def test_too_many_triangles_are_refused_before_a_sector_is_meshed_to_count_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: LITTLE)
    with pytest.raises(ParameterError, match=r"^size = 0.001 mm: makes [0-9.e+]+ tri6"):
        gearcad.mesh(HELICAL, size=0.001, element="tri6")


class Meshes(Exception):
    """It was not refused."""


def meshes(*_arguments: Any) -> None:
    raise Meshes


@pytest.mark.parametrize("given", [{"size": 0.05}, {"elements": 9_000_000}])
def test_what_is_said_to_do_does(given: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: LITTLE)
    monkeypatch.setattr(mesh_job, "run_mesh", meshes)
    (name,) = given
    with pytest.raises(ParameterError, match="GB of memory, and there are 2 GB") as refused:
        gearcad.mesh(HELICAL, **given)
    enough = re.search(r"about ([0-9.e+]+)(?: mm)? would do", str(refused.value))
    assert enough is not None
    with pytest.raises(Meshes):
        gearcad.mesh(HELICAL, **{name: type(given[name])(float(enough[1]))})


def test_usual_sizes_that_do_not_fit_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: 1e6)
    with pytest.raises(GeometryError, match="a larger size, or less of the gear, would do"):
        gearcad.mesh(HELICAL, what="sector")


def test_want_of_memory_is_told_in_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_arguments: Any) -> None:
        raise MemoryError("Unable to allocate 9 GiB")

    monkeypatch.setattr(mesh_job, "run_mesh", fail)
    spec = tmp_path / "some.toml"
    spec.write_text("[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 8.0\n", encoding="utf-8")
    result = invoke("mesh", str(spec), "--quiet", "-o", str(tmp_path / "out"))
    assert (result.exit_code, result.stderr) == (
        1,
        "Error: there is not enough memory (Unable to allocate 9 GiB); ask for less, or free some\n",
    )


PAIR = GearPair(
    pinion=Gear(teeth=20, normal_module=2, face_width=60, helix_angle=15, tooth_thinning=0.05),
    wheel=Gear(teeth=30, normal_module=2, face_width=60, helix_angle=-15, tooth_thinning=0.05),
)


def task(refinement: float, convergence: str = "on") -> CheckTask:
    options = CheckOptions(refinement=refinement, convergence=convergence)
    return check_task(PAIR, Material(), Load(torque=100), options)


@pytest.fixture
def needed(monkeypatch: pytest.MonkeyPatch) -> float:
    """Bytes that a check takes, on a machine with a little less."""
    memory = expected_solid(task(1.0)).memory
    monkeypatch.setattr(run, "machine_memory", lambda: 0.9 * memory)
    return memory


def test_bodies_for_which_there_is_no_memory_are_refused(needed: float) -> None:
    there = re.escape(f"there are {0.9 * needed / 1e9:.3g} GB")
    with pytest.raises(ParameterError, match=f"GB of memory, or fewer without convergence, and {there}; about 0.92 would do"):
        check_pair(check_task(PAIR, Material(), Load(torque=100), CheckOptions()))


def test_what_is_told_would_do(needed: float) -> None:
    run.require_room(task(0.92))
    run.require_room(task(1.0, "off"))
    with pytest.raises(ParameterError):
        run.require_room(task(1.0))


def test_a_machine_with_room_refuses_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = task(1.0)
    monkeypatch.setattr(run, "machine_memory", lambda: expected_solid(wanted).memory)
    run.require_room(wanted)
    run.require_room(replace(wanted, load=Load(torque=200)))


ROUNDING = 1e-13


def unit_element(element: Element, bend: Floats) -> ElementMesh:
    """One element of the unit square, cube or tetrahedron, its nodes moved by an affine map."""
    corners = {
        Element.TRI6: [[0, 0], [1, 0], [0, 1]],
        Element.QUAD8: [[0, 0], [1, 0], [1, 1], [0, 1]],
        Element.TET10: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    }.get(element, [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    places = np.zeros((len(corners), 3))
    places[:, : len(corners[0])] = corners
    if element.shape.order == 2:
        places = np.concatenate([places, [places[list(edge)].mean(axis=0) for edge in element.shape.edges]])
    count = len(element.shape.faces)
    sides = {f"side_{k}": Faces(np.zeros(1, np.int32), np.array([k], np.int8)) for k in range(count)}
    return ElementMesh(
        element, places @ bend.T + 3.0, np.arange(len(places), dtype=np.int32)[None], {"gear": slice(0, 1)}, sides
    )


@pytest.mark.parametrize("element", Element)
def test_an_element_is_as_large_as_its_map_makes_it(element: Element) -> None:
    bend = np.array([[2.0, 0.5, 0.0], [0.25, 1.5, 0.0], [0.0, 0.0, 3.0]])
    whole = {Element.TRI6: 1 / 2, Element.TET10: 1 / 6}.get(element, 1.0)
    scale = np.linalg.det(bend) if element.shape.dimension == 3 else np.linalg.det(bend[:2, :2])
    mesh = unit_element(element, bend)
    if element.shape.dimension == 2:
        mesh.points[:, 2] = 0.0
    assert measure_whole(mesh) == pytest.approx(whole * scale, rel=ROUNDING)
    for name in mesh.sides:
        corners = mesh.points[mesh.face_cells(name)[0]]
        if element.shape.dimension == 2:
            expected = math.dist(corners[0], corners[1])
        else:
            half = 0.5 * np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
            expected = half if element is Element.TET10 else 2 * half
        assert measure_side(mesh, name).size == pytest.approx(expected, rel=ROUNDING)


PROMISED_NODES, PROMISED_BETWEEN = 1e-9, 0.5
"""mm, and µm for elements of second order at default size."""

STEEP = Gear(teeth=6, normal_module=2, face_width=8, helix_angle=45, profile_shift=0.5)
FADING = Gear(teeth=17, normal_module=3, face_width=9, helix_angle=-20, rack=BasicRack(root_radius="full"))

HIGHEST = {"tip_relief": 300.0, "root_relief": 300.0, "end_relief": 300.0, "lead_crowning": 300.0, "twist": 300.0}
STRETCHED = Gear(teeth=17, normal_module=5, face_width=10, helix_angle=10)
"""Its flank begins near the base circle: there a depth in proportion to the roll is far from a parabola of the arc."""

LARGE = Gear(teeth=23, normal_module=8.0, face_width=60, helix_angle=15)


def body(gear: Gear, sizes: MeshSizes = COARSE, element: Element = Element.HEX20) -> ElementMesh:
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    return mesh_body(gear, teeth=1, held_radius=inner, sizes=sizes, planes=None, element=element)


def only(mesh: ElementMesh, part: str) -> ElementMesh:
    return replace(mesh, sides={name: faces for name, faces in mesh.sides.items() if part in name})


@pytest.mark.parametrize("changed", [False, True])
@pytest.mark.parametrize("name", ["right hand", "spur"])
def test_a_turned_flank_is_off_by_its_lever(name: str, changed: bool) -> None:
    """Turned by delta, an involute helicoid moves by delta r_b cos beta_b along its normals, at every point of it."""
    gear = modified(EXACTNESS_GEARS[name]) if changed else EXACTNESS_GEARS[name]
    mesh, turn = body(gear), 1e-6
    turned = mesh.points @ np.array([[math.cos(turn), math.sin(turn), 0], [-math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    expected = turn * gear.base_diameter / 2 * math.cos(math.radians(gear.base_helix_angle))
    found = deviations(only(replace(mesh, points=turned), "flank"), gear)
    slopes = 0.03 if changed else 1e-5  # of the modified flank to the exact one; the flank is curved
    assert found.nodes == pytest.approx(expected, rel=slopes)
    assert deviations(only(mesh, "flank"), gear).nodes < 1e-6 * expected


def test_straight_edges_are_off_by_their_bulge() -> None:
    """L^2/(8 rho) in the middle of an edge, rho the roll length there."""
    gear = replace(EXACTNESS_GEARS["spur"], face_width=0.5)
    mesh = body(gear, MeshSizes(), Element.HEX8)
    ends = mesh.points[mesh.face_cells("left_flank_0")[:, :2], :2]
    lengths, middles = np.hypot(*np.diff(ends, axis=1)[:, 0].T), np.hypot(*ends.mean(axis=1).T)
    bulges = lengths**2 / 8 / np.sqrt(middles**2 - gear.base_diameter**2 / 4)
    found = deviations(only(mesh, "left_flank"), gear)
    assert found.between == pytest.approx(1000 * bulges.max(), rel=0.02) and found.worst == "left_flank_0"


@pytest.mark.parametrize("teeth", [8, 20, 29, 47])
def test_of_the_two_alike_sides_of_a_symmetric_tooth_the_first_is_named_whatever_rounding_says(teeth: int) -> None:
    gear = Gear(teeth=teeth, normal_module=2, face_width=10, profile_shift=0.3)
    mesh = mesh_section(gear, teeth=1, held_radius=held_radius(gear), sizes=MeshSizes(), element=Element.QUAD8)
    found = deviations(mesh, gear)
    part = found.worst.partition("_")[2]
    assert found.worst == next(name for name in mesh.sides if name.endswith(part)), "both sides are off by the same"


@pytest.mark.parametrize(
    "gear",
    [
        *EXACTNESS_GEARS.values(),
        *map(modified, EXACTNESS_GEARS.values()),
        STEEP,
        modified(STEEP),
        modified(FADING),
        modified(LARGE, *HIGHEST, **HIGHEST),
        modified(STRETCHED, *AMOUNTS, **{name: 60.0 for name in AMOUNTS}),
    ],
)
def test_meshes_are_as_exact_as_promised(gear: Gear) -> None:
    """Nodes, faces between them, and the volume: no more than the deviation over all the surface."""
    mesh = body(gear, body_sizes(gear))
    found = deviations(mesh, gear)
    assert found.nodes < PROMISED_NODES
    assert found.between < PROMISED_BETWEEN
    exact = exact_volume(gear, gear.root_diameter / 2 - 1.5 * gear.normal_module)
    assert measure_whole(mesh) == pytest.approx(exact, rel=3e-6)


@pytest.mark.parametrize("element", [Element.TRI6, Element.QUAD8])
def test_sections_are_those_at_mid_face_width(element: Element) -> None:
    gear = modified(EXACTNESS_GEARS["left hand"])
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    found = deviations(mesh_section(gear, teeth=3, held_radius=inner, sizes=body_sizes(gear), element=element), gear)
    assert found.nodes < PROMISED_NODES and found.between < PROMISED_BETWEEN


_CHORD = 1e-6
"""Error (mm) of the contour: a polygon loses two thirds of it all round."""

_SOLID = 1e-9
"""The solid interpolates fillets and flanks to a nanometre."""

EXACT_GEARS = {
    "undercut": Gear(teeth=8, normal_module=2, face_width=10, body=Body(bore=4)),
    "full radius": Gear(teeth=30, normal_module=2, face_width=10, body=Body(bore=12), rack=BasicRack(root_radius="full")),
    "chamfered, helical": Gear(teeth=60, normal_module=1, face_width=10, helix_angle=30, body=Body(bore=40, tip_chamfer=0.05)),
}


@pytest.mark.parametrize("name", EXACT_GEARS)
def test_the_area_is_that_of_the_contour(name: str) -> None:
    gear = EXACT_GEARS[name]
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
