"""Meshes as files, read by others: nodes in the reader's own order, parts and sides under their names."""

import math
import sys
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import gmsh
import meshio
import numpy as np
import pytest
from support.boxes import AREAS, SIZE, box, outward, two_boxes
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import gearcad
from gearcad import Body, Gear
from gearcad.batch.row import MANIFEST, Manifest, RowPart, read_manifest
from gearcad.core.errors import ParameterError
from gearcad.designs import GearDesign
from gearcad.jobs.mesh import Mesh
from gearcad.meshing import Element, ElementMesh
from gearcad.meshing.bodies.element_mesh import MESHIO_WORDS
from gearcad.meshing.files import node_sets
from gearcad.meshing.options import MeshFormat, write

GEAR = Gear(teeth=20, normal_module=2, face_width=8, body=Body(bore=16))

ROUNDING = 1e-12
"""mm: what binary formats and twelve decimals keep of a box of 8 mm."""


@pytest.fixture
def reader() -> Iterator[None]:
    gmsh.initialize(interruptible=False)
    gmsh.option.set_number("General.Terminal", 0)
    yield
    gmsh.finalize()


def sizes(points: np.ndarray, cells: np.ndarray, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Volumes (m,), or areas or lengths, of parallelepipeds and simplices whose nodes have these local places, and their
    normals (m, 3); asserts that every node is where its local place is.
    """
    corners = np.c_[np.ones(len(local)), local]
    placed = np.einsum("ij,mjc->mic", np.linalg.pinv(corners), points[cells])
    assert np.abs(np.einsum("ij,mjc->mic", corners, placed) - points[cells]).max() < ROUNDING
    tangents = placed[:, 1:]
    simplex = np.allclose(local.min(axis=0), 0) and local.sum(axis=1).max() < 1 + 1e-9
    unit = 1 / math.factorial(local.shape[1]) if simplex else float(np.prod(np.ptp(local, axis=0)))
    if local.shape[1] == 3:
        return unit * np.linalg.det(tangents), np.zeros((len(cells), 3))
    normals = np.cross(tangents[:, 0], tangents[:, 1] if local.shape[1] == 2 else [0.0, 0.0, 1.0])
    area = np.linalg.norm(normals, axis=1)
    return unit * area, normals / area[:, None]


@pytest.mark.usefixtures("reader")
@pytest.mark.parametrize("kind", [MeshFormat.MSH, MeshFormat.UNV, MeshFormat.MED])
@pytest.mark.parametrize("element", Element)
def test_gmsh_opens_parts_and_sides(element: Element, kind: MeshFormat, tmp_path: Path) -> None:
    mesh, shape = two_boxes(element), element.shape
    write(mesh, tmp_path / f"mesh.{kind.value}")
    gmsh.merge(str(tmp_path / f"mesh.{kind.value}"))
    tags, places, _ = gmsh.model.mesh.get_nodes()
    points = np.empty((len(tags), 3))
    points[np.array(tags, int) - 1] = np.reshape(places, (-1, 3))
    assert np.abs(points - mesh.points).max() < ROUNDING
    groups = {gmsh.model.get_physical_name(*group).rstrip(): group for group in gmsh.model.get_physical_groups()}
    assert set(groups) == {*mesh.parts, *mesh.sides}
    used: list[int] = []
    thick = 1.0 if shape.dimension == 2 else SIZE[2]
    for name, (dimension, tag) in groups.items():
        cells, local, numbers = _group(dimension, tag)
        measured, normals = sizes(points, cells, local)
        side = name.partition("_")[2]
        assert dimension == shape.dimension - bool(side)
        assert len(cells) == (len(mesh.sides[name]) if side else len(mesh.cells) / 2)
        assert measured.min() > 0
        assert measured.sum() * thick == pytest.approx(AREAS[side] * (thick if dimension == 1 else 1) if side else 6.0)
        if side:
            assert np.abs(normals - outward(side)).max() < ROUNDING
        part = slice(*mesh.parts[name.partition("_")[0]].indices(len(mesh.cells)))
        assert np.isin(cells, mesh.cells[part]).all()
        if not side and kind is not MeshFormat.MED:  # which has no numbers of elements
            assert np.array_equal(numbers, np.arange(part.start, part.stop) + 1)
        used.extend(numbers)
    assert len(set(used)) == len(used)


def _group(dimension: int, tag: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Elements of a group (m, n), from 0, the local places of their nodes, and the numbers of the elements."""
    found, numbers = [], []
    for entity in gmsh.model.get_entities_for_physical_group(dimension, tag):
        (kind,), (tags,), (nodes,) = gmsh.model.mesh.get_elements(dimension, entity)
        _, _, _, count, local, _ = gmsh.model.mesh.get_element_properties(kind)
        numbers.append(tags)
        found.append(np.reshape(nodes, (-1, count)).astype(int) - 1)
    return np.concatenate(found), np.reshape(local, (count, -1)), np.concatenate(numbers)


UNV_MIDDLES = {
    118: {1: (0, 2), 3: (2, 4), 5: (4, 0), 6: (0, 9), 7: (2, 9), 8: (4, 9)},
    116: {1: (0, 2), 3: (2, 4), 5: (4, 6), 7: (6, 0), 8: (0, 12), 9: (2, 14), 10: (4, 16), 11: (6, 18)}
    | {13: (12, 14), 15: (14, 16), 17: (16, 18), 19: (18, 12)},
}
"""Of parabolic tetrahedra and bricks of I-DEAS, which nodes are between which: round each face, vertex and middle in turn."""

UNV_EDGES = {118: (2, 4, 9), 116: (2, 6, 12)}
"""Their nodes at the other ends of the edges that begin at the first."""


@pytest.mark.parametrize(("element", "kind"), [(Element.TET10, 118), (Element.HEX20, 116)])
def test_unv_has_the_order_of_ideas(element: Element, kind: int, tmp_path: Path) -> None:
    """Gmsh reads what gmsh writes; this is the format's own text."""
    mesh = two_boxes(element)
    write(mesh, tmp_path / "mesh.unv")
    words = (tmp_path / "mesh.unv").read_text().split("2412\n")[1].split("    -1\n")[0].split()
    cells, at = list[list[int]](), 0
    while at < len(words):
        count = int(words[at + 5])
        if int(words[at + 1]) == kind:
            cells.append([int(word) - 1 for word in words[at + 6 : at + 6 + count]])
        at += 6 + count
    places = mesh.points[np.array(cells)]
    assert len(places) == len(mesh.cells)
    for middle, ends in UNV_MIDDLES[kind].items():
        assert np.abs(places[:, middle] - places[:, list(ends)].mean(axis=1)).max() < ROUNDING
    boxes = np.linalg.det(places[:, list(UNV_EDGES[kind])] - places[:, :1])
    assert boxes.min() > 0
    assert boxes.sum() / (6 if kind == 118 else 1) == pytest.approx(12.0)


@pytest.mark.parametrize("element", Element)
def test_vtk_opens_elements_and_fields(element: Element, tmp_path: Path) -> None:
    mesh = two_boxes(element)
    write(mesh, tmp_path / "mesh.vtu")
    source = vtkXMLUnstructuredGridReader()
    source.SetFileName(str(tmp_path / "mesh.vtu"))
    source.Update()
    grid = source.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    assert np.array_equal(points, mesh.points)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(len(mesh.cells), -1)
    first = grid.GetCell(0)
    local = np.reshape([first.GetParametricCoords()[k] for k in range(3 * cells.shape[1])], (-1, 3))
    volumes, _ = sizes(points, cells, local[:, : element.shape.dimension])
    assert volumes.min() > 0
    assert volumes.sum() == pytest.approx(12.0)
    assert np.array_equal(vtk_to_numpy(grid.GetCellData().GetArray("part")), np.repeat([1, 2], len(mesh.cells) // 2))
    for name in mesh.sides:
        kind, _, tooth = name.rpartition("_") if name.endswith("_0") else (name, "", "1")
        field = vtk_to_numpy(grid.GetPointData().GetArray(kind))
        assert np.array_equal(np.flatnonzero(field == int(tooth)), mesh.nodes(name))
        assert set(field) == ({-1, 0} if name.endswith("_0") else {0, 1})
    assert np.array_equal(vtk_to_numpy(grid.GetFieldData().GetArray("matched_wheel_cut")), mesh.matched["wheel_cut"])


@pytest.mark.parametrize("kind", [MeshFormat.VTU, MeshFormat.BDF, MeshFormat.XDMF])
@pytest.mark.parametrize("element", Element)
def test_meshio_reads_elements_and_parts(element: Element, kind: MeshFormat, tmp_path: Path) -> None:
    if kind is MeshFormat.XDMF:
        pytest.importorskip("h5py")
    mesh = two_boxes(element)
    write(mesh, tmp_path / f"mesh.{kind.value}")
    read = meshio.read(tmp_path / f"mesh.{kind.value}")
    assert np.abs(read.points - mesh.points).max() < ROUNDING
    (block,) = read.cells
    assert np.array_equal(block.data, mesh.cells)
    field = "nastran:ref" if kind is MeshFormat.BDF else "part"
    assert np.array_equal(read.cell_data[field][0], np.repeat([1, 2], len(mesh.cells) // 2))


def test_files_beside_are_a_rows_to_keep(tmp_path: Path) -> None:
    names = ("gear.xdmf", "gear_sides.xdmf", "gear.h5")
    assert {Mesh().part_of(name) for name in names} == {"mesh"}
    manifest = Manifest("", {"mesh": RowPart({}, dict.fromkeys(names, 1))})
    (tmp_path / MANIFEST).write_text(manifest.text())
    assert read_manifest(tmp_path) == manifest


def test_mesh_json_names_files_beside_too(tmp_path: Path) -> None:
    pytest.importorskip("h5py")
    job = Mesh(given={"what": "sector", "format": "xdmf"})
    result = job.run(GearDesign(name="some", gear=GEAR))
    job.write(result, tmp_path)
    assert sorted(job.document(result)["files"]) == sorted(path.name for path in tmp_path.iterdir())


@pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6])
def test_sets_of_cuts_say_that_they_are_unsorted_only_where_they_are(element: Element, tmp_path: Path) -> None:
    """The k-th of one meets the k-th of the other, and CalculiX, which knows no such word, keeps every order."""
    mesh = gearcad.mesh(GEAR, what="sector", element=element.value).mesh
    write(mesh, tmp_path / "mesh.inp")
    assert ("UNSORTED" in (tmp_path / "mesh.inp").read_text()) == (element is Element.TRI6)
    behind, ahead = (node_sets(mesh)[f"cut_{end}"] for end in ("behind", "ahead"))
    assert set(zip(behind, ahead, strict=True)) == set(map(tuple, mesh.matched["cut"]))


@pytest.mark.parametrize("element", Element)
def test_meshio_reads_msh_with_its_sets(element: Element, tmp_path: Path) -> None:
    mesh, kind = two_boxes(element), MESHIO_WORDS[element.value]
    write(mesh, tmp_path / "mesh.msh")
    read = meshio.read(tmp_path / "mesh.msh", file_format="gmsh")
    assert np.array_equal(read.points, mesh.points)
    assert np.array_equal(read.cells_dict[kind], mesh.cells)
    assert set(read.cell_sets) - {"gmsh:bounding_entities"} == {*mesh.parts, *mesh.sides}
    for name, part in mesh.parts.items():
        assert np.array_equal(read.cell_sets_dict[name][kind], np.arange(part.start, part.stop))
    for name in mesh.sides:
        ((face, numbers),) = read.cell_sets_dict[name].items()
        assert np.array_equal(read.cells_dict[face][numbers], mesh.face_cells(name))


@pytest.mark.parametrize("element", Element)
def test_sides_of_xdmf_have_a_file_with_their_names(element: Element, tmp_path: Path) -> None:
    pytest.importorskip("h5py")
    mesh = two_boxes(element)
    write(mesh, tmp_path / "mesh.xdmf")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mesh.h5", "mesh.xdmf", "mesh_sides.xdmf"]
    read = meshio.read(tmp_path / "mesh_sides.xdmf")
    (block,), (numbers,) = read.cells, read.cell_data["side"]
    assert list(read.field_data) == list(mesh.sides)
    for name, (number, dimension) in read.field_data.items():
        assert dimension == element.shape.dimension - 1
        assert np.array_equal(block.data[numbers == number], mesh.face_cells(name))


def test_without_h5py_xdmf_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(ParameterError, match=r'format = \'xdmf\': needs h5py: pip install "gearcad\[mesh\]"'):
        write(box(Element.TRI6), tmp_path / "mesh.xdmf")
    assert not list(tmp_path.iterdir())


def test_sides_of_bdf_are_sets_of_nodes(tmp_path: Path) -> None:
    mesh = two_boxes(Element.HEX20)
    write(mesh, tmp_path / "mesh.bdf")
    rows = (tmp_path / "mesh.bdf").read_text().splitlines()
    assert max(map(len, rows)) <= 80
    names = dict(row.removeprefix("$ set ").split(": ") for row in rows if row.startswith("$ set "))
    assert list(names.values()) == list(mesh.sides)
    found: dict[str, list[int]] = {}
    for word, cards in groupby(_cards(rows), key=lambda card: card[0]):
        for card in cards if word == "SET1" else ():
            found[names[card[1]]] = [int(node) - 1 for node in card[2:]]
    for name in mesh.sides:
        assert found[name] == list(mesh.nodes(name))


def _cards(rows: list[str]) -> Iterator[list[str]]:
    """The fields of each card of eight characters, continued over lines."""
    card: list[str] = []
    for row in rows[rows.index("BEGIN BULK") + 1 :]:
        fields = [row[at : at + 8].strip() for at in range(0, min(len(row), 72), 8)]
        if fields[0] == "+":
            card += fields[1:]
            continue
        if card:
            yield card
        card = fields


def test_places_in_bdf_keep_sixteen_characters(tmp_path: Path) -> None:
    mesh = box(Element.HEX8)
    far = ElementMesh(mesh.element, mesh.points / 3 - [1234.5, 0.1, 99.0], mesh.cells, mesh.parts, {})
    write(far, tmp_path / "mesh.bdf")
    assert np.abs(meshio.read(tmp_path / "mesh.bdf").points - far.points).max() < 1e-10


def test_another_suffix_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"format = 'stl': must be one of 'msh', 'vtu', 'inp'"):
        write(box(Element.TRI6), tmp_path / "gear.stl")
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("reader")
def test_a_callers_gmsh_stays(tmp_path: Path) -> None:
    gmsh.model.add("mine")
    write(box(Element.TRI6), tmp_path / "mesh.unv")
    assert gmsh.is_initialized()
    assert gmsh.model.list().count("mine") == 1
    assert "gearcad" not in gmsh.model.list()
    assert gmsh.model.get_current() == "mine"
