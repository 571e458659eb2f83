"""Quality of elements in closed form and by VTK (Verdict), and gates that catch spoilt meshes."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TETRA, vtkUnstructuredGrid
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality

from gearcad import Body, FlankModification, Gear, GearcadError
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.bodies.quality import Quality, quality, require_good
from gearcad.meshing.fem import (
    SWEPT,
    field_gradients,
    mass_matrices,
    node_places,
    shape_slopes,
    shape_values,
    stiffness_matrices,
)
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.plan import plan_mesh
from gearcad.meshing.result import JudgedMesh, _judged

ROUNDING = 1e-13
KINDS = list(Element)


def mesh_of(element: Element, *elements: np.ndarray, sides: dict[str, Faces] | None = None) -> ElementMesh:
    """Elements side by side, no node in common; of sections (n, 2) or solids (n, 3)."""
    points = np.concatenate(elements).astype(float)
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    cells = np.arange(len(points), dtype=np.int32).reshape(len(elements), -1)
    return ElementMesh(element, points, cells, {"gear": slice(0, len(elements))}, sides or {})


def straight(element: Element, vertices: np.ndarray) -> np.ndarray:
    """Nodes of an element with straight edges, middle nodes half-way."""
    if element.shape.order == 1:
        return vertices
    return np.concatenate([vertices, vertices[np.array(element.shape.edges)].mean(axis=1)])


def measure(element: Element, nodes: np.ndarray) -> Quality:
    return quality(mesh_of(element, nodes))


def is_(found: Quality, jacobian: float, aspect: float, angle: float) -> None:
    assert found.least_jacobian == pytest.approx(jacobian, abs=ROUNDING)
    assert found.mean_jacobian == pytest.approx(jacobian, abs=ROUNDING)
    assert found.largest_aspect == found.mean_aspect == pytest.approx(aspect, rel=ROUNDING)
    assert found.least_angle == pytest.approx(angle, abs=1e-6)


@pytest.mark.parametrize("kind", [*(each.value for each in KINDS), "line3", "quad4", SWEPT])
def test_shapes_interpolate(kind: str) -> None:
    """1 at their own node and 0 at others; sums are 1; linear fields have their slope."""
    places = node_places(kind)
    assert shape_values(kind, places) == pytest.approx(np.eye(len(places)), abs=ROUNDING)
    inside = np.random.default_rng(1).uniform(0, 0.3, (7, places.shape[1]))
    assert shape_values(kind, inside).sum(axis=1) == pytest.approx(1, abs=ROUNDING)
    field = places @ np.arange(1, places.shape[1] + 1)
    assert shape_slopes(kind, inside) @ field == pytest.approx(np.tile(np.arange(1, places.shape[1] + 1), (7, 1)), abs=1e-12)
    step = 1e-6
    for axis, shift in enumerate(step * np.eye(places.shape[1])):
        measured = (shape_values(kind, inside + shift) - shape_values(kind, inside - shift)) / (2 * step)
        assert shape_slopes(kind, inside)[:, axis] == pytest.approx(measured, abs=1e-8)


@pytest.mark.parametrize("kind", ["tri6", SWEPT])
def test_no_elements_have_no_matrices(kind: str) -> None:
    places = node_places(kind)
    size, none = places.size, np.empty((0, *places.shape))
    assert stiffness_matrices(kind, none, (1.0, 1.0), 4).shape == mass_matrices(kind, none, 4).shape == (0, size, size)
    assert field_gradients(kind, none, none, places).shape == (0, len(places), places.shape[1], places.shape[1])


@pytest.mark.parametrize("element", KINDS)
def test_regular_elements_are_perfect(element: Element) -> None:
    """Squares, cubes, equilateral triangles and tetrahedra."""
    vertices = node_places(element.value)[: element.shape.vertices]
    if element is Element.TRI6:
        vertices = np.array([[0, 0], [1, 0], [0.5, math.sqrt(0.75)]])
    if element is Element.TET10:
        vertices = np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]], float)
    is_(measure(element, straight(element, vertices)), 1, 1, 60 if element in (Element.TRI6, Element.TET10) else 90)


@pytest.mark.parametrize("element", [Element.QUAD8, Element.HEX8, Element.HEX20])
def test_sheared_elements(element: Element) -> None:
    """Leaning by 40 degrees: the cosine, and edges longer by its inverse."""
    vertices = node_places(element.value)[: element.shape.vertices].copy()
    vertices[:, 0] += math.tan(math.radians(40)) * vertices[:, -1]
    cosine = math.cos(math.radians(40))
    is_(measure(element, straight(element, vertices)), cosine, 1 / cosine, 50)


def test_flat_triangle() -> None:
    """Of height h over a base of 2: 2 h/(sqrt(3) l) with legs l, and atan h in its corners."""
    height = 0.1
    leg = math.hypot(1, height)
    found = measure(Element.TRI6, straight(Element.TRI6, np.array([[0, 0], [2, 0], [1, height]])))
    is_(found, 2 * height / math.sqrt(3) / leg, 2 / leg, math.degrees(math.atan(height)))


@pytest.mark.parametrize("element", [Element.QUAD8, Element.HEX20])
def test_curved_edges_count(element: Element) -> None:
    """A middle node d off its edge turns the ends of an edge of 1 by atan 4d; past a quarter of the edge the element folds."""
    places = node_places(element.value)
    bottom = (places[:, 0] == 0.5) & (places[:, 1] == 0)
    for axis, moved, expected in ((1, 0.15, 1 / math.hypot(1, 0.6)), (0, 0.3, -1.0)):
        nodes = places.copy()
        nodes[bottom, axis] += moved
        assert measure(element, nodes).least_jacobian == pytest.approx(expected, abs=ROUNDING)


@pytest.mark.parametrize("element", [Element.TRI6, Element.TET10])
def test_curved_simplices_fold(element: Element) -> None:
    places = node_places(element.value)
    middle = np.flatnonzero(np.isclose(places[:, 0], 0.5) & (places[:, 1:] == 0).all(axis=1))
    for moved, folds in ((0.2, False), (0.3, True)):
        nodes = places.copy()
        nodes[middle, 0] += moved
        assert (measure(element, nodes).least_jacobian < 0) == folds


@pytest.mark.parametrize(("element", "kind"), [(Element.HEX8, VTK_HEXAHEDRON), (Element.TET10, VTK_TETRA)])
def test_scaled_jacobians_are_those_of_vtk(element: Element, kind: int) -> None:
    """Of distorted elements with straight edges, folded ones among them."""
    rng = np.random.default_rng(7)
    vertices = node_places(element.value)[: element.shape.vertices]
    drawn = vertices + rng.uniform(-0.45, 0.45, (200, *vertices.shape))
    grid, points = vtkUnstructuredGrid(), vtkPoints()
    points.SetData(numpy_to_vtk(drawn.reshape(-1, 3), deep=True))
    grid.SetPoints(points)
    for row in np.arange(drawn.shape[0] * drawn.shape[1]).reshape(len(drawn), -1):
        numbers = vtkIdList()
        for node in row:
            numbers.InsertNextId(int(node))
        grid.InsertNextCell(kind, numbers)
    measured = vtkMeshQuality()
    measured.SetInputData(grid)
    measured.SetHexQualityMeasureToScaledJacobian()
    measured.SetTetQualityMeasureToScaledJacobian()
    measured.Update()
    expected = vtk_to_numpy(measured.GetOutput().GetCellData().GetArray("Quality"))
    assert (expected < 0).any() and (expected > 0).any()
    mesh = mesh_of(element, *(straight(element, each) for each in drawn))
    ours = np.array([quality(mesh_of(element, mesh.points[row])).least_jacobian for row in mesh.cells])
    assert ours == pytest.approx(expected, abs=1e-12)
    assert quality(mesh).mean_jacobian == pytest.approx(expected.mean(), abs=1e-12)


def test_worst_elements_have_their_place() -> None:
    """The worst first, with the nearest side; the gate says so in a line."""
    cube = node_places("hex8") - 0.5
    slopes = np.tan(np.radians([0, 88, 20]))
    leaning = [cube + [100 * k, 0, 0] + slope * cube[:, 2:] * [1, 0, 0] for k, slope in enumerate(slopes)]
    sides = {f"tip_{k}": Faces(np.array([k], np.int32), np.array([1], np.int8)) for k in range(3)}
    found = quality(mesh_of(Element.HEX8, *leaning, sides=sides))
    assert [each.number for each in found.worst] == [1, 2, 0]
    assert found.worst[0].near == "tip_1" and found.worst[0].place == pytest.approx((100, 0, 0))
    assert found.to_dict()["worst"][0]["element"] == 2
    with pytest.raises(GearcadError, match=r"Jacobian 0\.035, must be at least 0\.05; element 2 at .* near tip_1$"):
        require_good(found)
    require_good(found, 0.03)


def test_an_element_as_good_as_flat_is_refused() -> None:
    thin = node_places("hex20") * [1, 1, 1e-5]
    found = measure(Element.HEX20, thin)
    assert found.least_jacobian == pytest.approx(1) and found.largest_aspect == pytest.approx(1e5)
    with pytest.raises(GearcadError, match=r"an edge is 1e\+05 times as long as another"):
        require_good(found)


GEAR = Gear(teeth=20, normal_module=2, face_width=8, body=Body(bore=16))

CHAMFERED = Gear(
    teeth=25,
    normal_module=3,
    face_width=20,
    helix_angle=-20,
    body=Body(bore=30, tip_chamfer=0.3),
    modification=FlankModification(tip_relief=30, tip_relief_length=2, lead_crowning=12),
)

OTHERS, CUTS, CLOSED, MEAN = "nodes from the other exact sides", "nodes of matched cuts", "share of the surface", "surface "


def judged(spoil: Callable[[ElementMesh], ElementMesh], options: MeshOptions, gear: Gear = GEAR) -> JudgedMesh:
    plan = plan_mesh(options, {"gear": gear}, None)
    return _judged(spoil(plan.gears["gear"].mesh(lambda *_: None)), plan.gears["gear"], plan)


def moved(mesh: ElementMesh, nodes: np.ndarray, scale: float, up: float = 0.0) -> ElementMesh:
    points = mesh.points.copy()
    points[nodes, :2] *= scale
    points[nodes, 2] += up
    return replace(mesh, points=points)


def cut_node_out(mesh: ElementMesh) -> ElementMesh:
    """By 20 µm."""
    points = mesh.points.copy()
    points[mesh.matched["cut"][5, 1], 1] += 0.02
    return replace(mesh, points=points)


def root_in(mesh: ElementMesh) -> ElementMesh:
    """By 17 µm."""
    return moved(mesh, np.setdiff1d(mesh.nodes("left_root_0"), mesh.nodes("left_fillet_0")), 0.999)


def end_out(mesh: ElementMesh) -> ElementMesh:
    return moved(mesh, mesh.nodes("end_front"), 1.0, 0.003)


def bore_in(mesh: ElementMesh) -> ElementMesh:
    """By 24 µm."""
    return moved(mesh, mesh.nodes("bore"), 0.997)


def without(side: str) -> Callable[[ElementMesh], ElementMesh]:
    return lambda mesh: replace(mesh, sides={name: faces for name, faces in mesh.sides.items() if name != side})


def twice(mesh: ElementMesh) -> ElementMesh:
    tip = mesh.sides["tip_0"]
    both = Faces(np.tile(tip.elements, 2), np.tile(tip.sides, 2))
    return replace(mesh, sides={**mesh.sides, "tip_0": both})


SECTION, BODY = MeshOptions(what="sector"), MeshOptions(what="sector", model="3d", size=1.0)
FIRST, RING = MeshOptions(what="sector", element="hex8", size=1.0), MeshOptions(what="ring", element="hex8", size=2.0)


@pytest.mark.parametrize(
    ("spoil", "options", "caught"),
    [
        (cut_node_out, SECTION, CUTS),
        (root_in, SECTION, OTHERS),
        (end_out, BODY, OTHERS),
        (end_out, BODY, MEAN),
        (bore_in, FIRST, OTHERS),
        (bore_in, SECTION, MEAN),
        (without("left_flank_0"), FIRST, CLOSED),
        (without("left_flank_0"), FIRST, MEAN),
        (without("bore"), RING, CLOSED),
        (without("end_back"), RING, CLOSED),
        (twice, RING, CLOSED),
    ],
)
def test_what_is_spoilt_fails(spoil: Callable[[ElementMesh], ElementMesh], options: MeshOptions, caught: str) -> None:
    failed = [gate.quantity for gate in judged(spoil, options).gates if not gate.passed]
    assert any(quantity.startswith(caught) for quantity in failed), failed


@pytest.mark.parametrize(
    ("options", "gear"),
    [(SECTION, GEAR), (FIRST, GEAR), (RING, GEAR), (BODY, CHAMFERED), (replace(SECTION, model="2d"), CHAMFERED)],
)
def test_what_is_not_passes(options: MeshOptions, gear: Gear) -> None:
    """Also nodes of tip chamfers, which turn with modified flanks, are where they should be."""
    found = judged(lambda mesh: mesh, options, gear)
    assert found.passed, [str(gate) for gate in found.gates if not gate.passed]
    assert {"longest over shortest edge", OTHERS} <= {gate.quantity for gate in found.gates}
