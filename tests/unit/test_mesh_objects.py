"""Meshes as objects of meshio, scikit-fem and PyVista."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, FacetBasis, Functional
from support.boxes import AREAS, box, two_boxes

import gearcad
from gearcad import Body, Gear
from gearcad.meshing import Element, ElementMesh
from gearcad.meshing.bodies.element_mesh import shape_slopes
from gearcad.meshing.bodies.quality import measure_side


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
