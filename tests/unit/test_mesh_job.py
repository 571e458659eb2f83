"""`gearcad.mesh`: what options ask for is what comes out; meshes as objects of meshio, scikit-fem and PyVista."""

from __future__ import annotations

import math
import sys
from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, FacetBasis, Functional
from support.boxes import AREAS, box, two_boxes

import gearcad
from gearcad import BasicRack, Body, FlankModification, Gear, GearPair, Load, ParameterError
from gearcad.meshing import Element, ElementMesh
from gearcad.meshing.bodies.quality import measure_side
from gearcad.meshing.fem import shape_slopes
from gearcad.meshing.options import MeshOptions

GEAR = Gear(teeth=20, normal_module=2, face_width=8, body=Body(bore=12))

PAIR = GearPair(
    pinion=Gear(teeth=17, normal_module=2, face_width=8, body=Body(bore=12)),
    wheel=Gear(teeth=23, normal_module=2, face_width=6, body=Body(bore=20)),
)


def edge_turns(mesh: ElementMesh, side: str) -> np.ndarray:
    """By how much (deg) each edge of a side turns."""
    end, other, middle = np.moveaxis(mesh.points[mesh.face_cells(side)], 1, 0)
    first, last = 4 * middle - 3 * end - other, 3 * other + end - 4 * middle
    angles = [np.arctan2(each[:, 1], each[:, 0]) for each in (first, last)]
    return np.degrees(np.abs((angles[1] - angles[0] + math.pi) % (2 * math.pi) - math.pi))


@pytest.mark.parametrize("count", [4, 9])
def test_fillets_have_as_many_elements_as_are_asked_for(count: int) -> None:
    mesh = gearcad.mesh(GEAR, what="sector", fillet_elements=count).mesh
    for side in ("left_fillet_0", "right_fillet_0"):
        assert 30 / edge_turns(mesh, side).max() == pytest.approx(count, rel=0.15)


def test_edges_on_flanks_are_as_long_as_asked_for() -> None:
    for size in (0.2, 0.5):
        mesh = gearcad.mesh(GEAR, what="sector", size=size).mesh
        ends = mesh.points[mesh.face_cells("left_flank_0")[:, :2]]
        longest = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()
        assert 0.7 * size < longest < 1.1 * size


@pytest.mark.parametrize(
    ("element", "roll"),
    [
        *((Element.QUAD8, 0.0), (Element.HEX8, 5.0)),
        *(pytest.param(*each, marks=pytest.mark.long) for each in ((Element.QUAD8, 5.0), (Element.HEX8, 0.0))),
    ],
)
def test_flanks_of_a_pair_touch_at_the_roll_angle(element: Element, roll: float) -> None:
    """The distance of a flank's nodes from the mate's: none overlaps, and some are near."""
    mesh = gearcad.mesh(
        PAIR, what="pair:3", element=element.value, size=0.25 if element is Element.HEX8 else 0.1, roll=roll
    ).mesh
    pinion, wheel = (mesh.points[mesh.nodes(f"{gear}_left_flank_0")] for gear in ("pinion", "wheel"))
    gap = min(np.hypot(*(wheel[:, :2] - place[:2]).T).min() for place in pinion)
    assert gap < 0.2
    angle = math.radians(PAIR.working_transverse_pressure_angle)
    tangent = np.array([math.sin(angle), math.cos(angle)])
    rolled = PAIR.path_of_contact.C + math.radians(roll) * PAIR.pinion.base_diameter / 2
    contact = PAIR.pinion.base_diameter / 2 * np.array([math.cos(angle), -math.sin(angle)]) + rolled * tangent
    assert np.hypot(*(pinion[:, :2] - contact).T).min() < 0.15


def test_a_negative_torque_makes_right_flanks_touch() -> None:
    result = gearcad.mesh(PAIR, Load(torque=-40), what="pair:3", size=0.4)
    faces = {side: len(result.mesh.sides[f"pinion_{side}_flank_0"]) for side in ("left", "right")}
    assert faces["right"] >= faces["left"]
    ahead = result.mesh.points[result.mesh.nodes("pinion_right_flank_0")]
    behind = result.mesh.points[result.mesh.nodes("wheel_right_flank_0")]
    assert min(np.hypot(*(behind - place)[:, :2].T).min() for place in ahead) < 0.02
    assert not result.plan.left


def test_the_whole_part_has_keyway_and_hub() -> None:
    body = Body(bore=6, keyway_width=2, keyway_depth=1, hub_diameter=11, hub_length=2, end_chamfer=0.5)
    gear = Gear(teeth=9, normal_module=2, face_width=4, profile_shift=0.5, rack=BasicRack(root_radius="full"), body=body)
    result = gearcad.mesh(gear, what="part", elements=20_000)
    judged = result.judged["gear"]
    assert {"keyway", "hub", "hub_front", "end_chamfers", "bore", "tip_8"} <= set(result.mesh.sides)
    assert result.mesh.element is Element.TET10 and result.passed
    assert judged.whole == pytest.approx(judged.exact, rel=1e-4)


def test_modified_flanks_are_meshed_as_modified() -> None:
    gear = Gear(
        teeth=20,
        normal_module=2,
        face_width=8,
        helix_angle=15,
        body=Body(bore=12),
        modification=FlankModification(tip_relief=20, tip_relief_length=2, lead_crowning=10),
    )
    result = gearcad.mesh(gear, what="sector", model="3d")
    plain = gearcad.mesh(Gear(teeth=20, normal_module=2, face_width=8, helix_angle=15, body=Body(bore=12)), what="sector")
    assert result.passed and result.judged["gear"].deviations.nodes < 1e-12
    assert plain.judged["gear"].whole - result.judged["gear"].whole == pytest.approx(
        plain.judged["gear"].exact - result.judged["gear"].exact, rel=2e-3
    )


def test_options_are_those_of_a_design_unless_they_are_given() -> None:
    options = MeshOptions(what="teeth:3", element="tri6")
    assert gearcad.mesh(GEAR, mesh=options).plan.options == options
    assert gearcad.mesh(GEAR, mesh=options, what="sector").plan.options == MeshOptions(what="sector", element="tri6")
    with pytest.raises(ParameterError, match=r"^mesh = 5: must be a MeshOptions$"):
        gearcad.mesh(GEAR, mesh=5)
    with pytest.raises(ParameterError, match=r"^what = 3: must be"):
        gearcad.mesh(GEAR, what=3)
    with pytest.raises(LookupError, match="there are several meshes: pinion, wheel"):
        gearcad.mesh(PAIR, what="sector").mesh  # noqa: B018


@Functional
def size(w):  # type: ignore[no-untyped-def]
    return 1.0 + 0.0 * w.x[0]


def bent(element: Element) -> ElementMesh:
    """A box bent about the z axis, 5 mm below it, and twisted: edges and faces are curved."""
    mesh = box(element)
    x, y, z = mesh.points.T
    turn = y / 4 + z / 8
    return replace(mesh, points=np.stack([(5 + x) * np.cos(turn), (5 + x) * np.sin(turn), z], axis=1))


def gauss(dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (p, dimension) in -1 ... 1 and weights (p,) that are exact to the ninth power."""
    places, weights = np.polynomial.legendre.leggauss(5)
    grid = np.stack(np.meshgrid(*[places] * dimension, indexing="ij"), -1).reshape(-1, dimension)
    return grid, np.prod(np.stack(np.meshgrid(*[weights] * dimension, indexing="ij"), -1).reshape(-1, dimension), axis=1)


def area(mesh: ElementMesh, name: str) -> float:
    """mm², or mm, of a side of quadrangles or edges, by our own shape functions."""
    dimension = mesh.element.shape.dimension - 1
    places, weights = gauss(dimension)
    tangents = np.einsum("pdn,mnc->mpdc", shape_slopes(mesh.element.shape.face, places), mesh.points[mesh.face_cells(name)])
    lengths = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1] if dimension == 2 else [0.0, 0.0, 1.0]), axis=-1)
    return float(lengths.sum(axis=0) @ weights)


@pytest.mark.parametrize("element", Element)
def test_scikit_fem_has_parts_and_sides(element: Element) -> None:
    mesh = two_boxes(element)
    theirs = mesh.to_skfem()
    own = theirs.elem()
    for part in mesh.parts:
        assert size.assemble(Basis(theirs, own, elements=part)) == pytest.approx(6.0)
        assert theirs.p[0, theirs.t[:, theirs.subdomains[part]]].min() == (5.0 if part == "wheel" else 0.0)
    assert set(theirs.boundaries) == set(mesh.sides)
    for name in mesh.sides:
        basis = FacetBasis(theirs, own, facets=name)
        assert size.assemble(basis) == pytest.approx(AREAS[name.partition("_")[2]])


@pytest.mark.parametrize("element", [Element.QUAD8, Element.HEX20])
def test_nodes_that_scikit_fem_wants_do_not_change_curved_elements(element: Element) -> None:
    mesh = bent(element)
    theirs = mesh.to_skfem()
    own = theirs.elem()
    for name in mesh.sides:
        assert size.assemble(FacetBasis(theirs, own, facets=name, intorder=8)) == pytest.approx(area(mesh, name), rel=1e-7)
    places, weights = gauss(element.shape.dimension)
    slopes = np.einsum("pdn,mnc->mpdc", shape_slopes(element.value, places), mesh.points[mesh.cells])
    dimension = element.shape.dimension
    volume = float((np.linalg.det(slopes[..., :dimension]) @ weights).sum())
    assert size.assemble(Basis(theirs, own, intorder=8)) == pytest.approx(volume, rel=1e-12)


def test_scikit_fem_finds_its_places_on_small_faces_far_from_the_origin() -> None:
    gear = Gear(teeth=23, normal_module=2, face_width=12, helix_angle=-18, body=Body(bore=20))
    mesh = gearcad.mesh(gear, what="sector", element="hex20", size=1.0).mesh
    theirs = mesh.to_skfem()
    for name in ("left_flank_0", "end_front"):
        area = size.assemble(FacetBasis(theirs, theirs.elem(), facets=name))
        assert area == pytest.approx(measure_side(mesh, name).size, rel=1e-10)


@pytest.mark.parametrize("element", Element)
def test_meshio_has_parts_and_sides_as_sets(element: Element) -> None:
    mesh = two_boxes(element)
    theirs = mesh.to_meshio()
    solid, faces = theirs.cells
    assert np.array_equal(solid.data, mesh.cells)
    for name, part in mesh.parts.items():
        assert np.array_equal(theirs.cell_sets[name][0], np.arange(part.start, part.stop))
        assert len(theirs.cell_sets[name][1]) == 0
    for name in mesh.sides:
        assert len(theirs.cell_sets[name][0]) == 0
        assert np.array_equal(faces.data[theirs.cell_sets[name][1]], mesh.face_cells(name))
        assert np.array_equal(theirs.point_sets[name], mesh.nodes(name))


def test_a_mesh_without_sides_is_one_too() -> None:
    mesh = replace(box(Element.HEX20), sides={}, matched={})
    assert [block.type for block in mesh.to_meshio().cells] == ["hexahedron20"]
    theirs = mesh.to_skfem()
    assert size.assemble(Basis(theirs, theirs.elem())) == pytest.approx(6.0)


def test_without_pyvista_its_name_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match="needs PyVista: pip install pyvista"):
        box(Element.TRI6).to_pyvista()


def test_pyvista_shares_nodes_and_fields() -> None:
    pytest.importorskip("pyvista")
    mesh = box(Element.HEX20)
    theirs = mesh.to_pyvista()
    assert np.array_equal(theirs.points, mesh.points)
    assert np.array_equal(theirs.cells.reshape(-1, 21)[:, 1:], mesh.cells)
    assert np.array_equal(np.flatnonzero(theirs.point_data["left_flank"] == 0), mesh.nodes("left_flank_0"))
