"""ElementMesh: nodes, elements and named sides of a body, and conversion to other libraries."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.core.records import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.meshing.fem import Element, node_places, shape_values

BORE = "bore"
"""The inner circle of an external gear, that is none where its section is a full disc."""

GAP = "gap"
"""The ground between the halves of a double helical gear; its ends are "gap_back" and "gap_front"."""

BACK = "back"
"""Name of the back of a rack."""

RIM = "rim"
"""Name of the outside of a ring."""


def body_side(gear: Gear) -> str:
    """Return the side where the body ends away from the teeth."""
    return RIM if gear.internal else BORE


def rises(gear: Gear, name: str) -> bool:
    """Return whether the "left" or "right" flank is the one with y > 0 of a tooth on +x: the left one is, but that of a ring
    not.
    """
    return (name == "left") != gear.internal


def named_left(gear: Gear, *, positive: bool) -> bool:
    """Return whether the flank with y > 0 of a tooth on +x (else that with y < 0) is the left flank."""
    return positive != gear.internal


Cells = NDArray[np.int32]
"""Numbers of the nodes of elements, of 4 bytes: with 8 they would take half of the memory of a mesh."""


@dataclass(frozen=True)
class Faces:
    """Sides of elements: which element (n,), and which of its sides (n,), counted from 0 as `Shape.faces` are."""

    elements: Cells
    sides: NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.elements)

    def shifted(self, elements: int) -> Faces:
        """Return the same sides for a mesh in which `elements` others stand before them."""
        return replace(self, elements=self.elements + np.int32(elements))


@dataclass(frozen=True)
class ElementMesh:
    """Mesh of elements of one kind: nodes, elements and named surfaces.

    `points` (n, 3) in mm, z = 0 in sections; `cells` (m, nodes of an element), from 0. `parts` are the bodies, each a slice of
    the elements: {"gear": ...}, or {"pinion": ..., "wheel": ...}. `sides` are the named parts of the surface; no side of an
    element has two names. `matched` are nodes (k, 2) of cyclic cuts that turn into each other: those of "cut_behind" and
    of "cut_ahead".
    """

    element: Element
    points: Floats
    cells: Cells
    parts: Mapping[str, slice]
    sides: Mapping[str, Faces]
    matched: Mapping[str, Wholes] = field(default_factory=dict)

    def face_cells(self, name: str) -> Cells:
        """Return the nodes (n, nodes of a face) of a named side, face by face, its vertices first, normals outwards."""
        faces = self.sides[name]
        local = np.array(self.element.shape.faces)[faces.sides]
        found: Cells = self.cells[faces.elements[:, None], local]
        return found

    def nodes(self, name: str) -> Cells:
        """Return the numbers (n,) of the nodes of a named side, in order."""
        return np.unique(self.face_cells(name))

    def to_meshio(self) -> Any:
        """Return a meshio.Mesh of elements and faces of sides; parts and sides are its cell sets, nodes of sides its point
        sets.
        """

        return meshio_mesh(self)

    def to_skfem(self) -> Any:
        """Return a mesh of scikit-fem, with the parts as subdomains and the sides as boundaries; nodes have other numbers
        there.
        """

        return skfem_mesh(self)

    def to_pyvista(self) -> Any:
        """Return a pyvista.UnstructuredGrid, with fields of the nodes for each kind of side. Raises ImportError without
        PyVista.
        """

        return pyvista_grid(self)

    @cached_property
    def nbytes(self) -> int:
        """Memory (bytes) of nodes and elements."""
        return self.points.nbytes + self.cells.nbytes


def joined(meshes: Mapping[str, ElementMesh]) -> ElementMesh:
    """Several meshes of one kind of element as one, their sides and parts named after them: "pinion_bore"."""
    first = next(iter(meshes.values()))
    parts: dict[str, slice] = {}
    sides: dict[str, Faces] = {}
    matched: dict[str, Wholes] = {}
    cells, nodes, elements = list[Cells](), 0, 0
    for name, mesh in meshes.items():
        cells.append(mesh.cells + np.int32(nodes))
        parts[name] = slice(elements, elements + len(mesh.cells))
        sides |= {f"{name}_{side}": faces.shifted(elements) for side, faces in mesh.sides.items()}
        matched |= {f"{name}_{cut}": pairs + nodes for cut, pairs in mesh.matched.items()}
        nodes += len(mesh.points)
        elements += len(mesh.cells)
    points = np.concatenate([mesh.points for mesh in meshes.values()])
    return ElementMesh(first.element, points, np.concatenate(cells), parts, sides, matched)


NOWHERE = -1
"""Number for nodes that are on no tooth's side of that kind."""

_TOOTH = re.compile(r"(.+)_(\d+)")


def side_fields(mesh: ElementMesh) -> Iterator[tuple[str, NDArray[np.int16] | NDArray[np.uint8]]]:
    """Yield a field of the nodes for each kind of side, one at a time.

    "left_flank" holds the tooth's number on the nodes of all left flanks, and -1 elsewhere; what is there once, as "bore",
    is 1 on its nodes and 0 elsewhere.
    """
    kinds = [
        (match[1], int(match[2]), name) if (match := _TOOTH.fullmatch(name)) else (name, None, name) for name in mesh.sides
    ]
    for kind, sides in groupby(sorted(kinds, key=lambda each: each[0]), key=lambda each: each[0]):
        field: NDArray[np.int16] | NDArray[np.uint8] | None = None
        for _, tooth, name in sides:
            if field is None:
                field = np.zeros(len(mesh.points), np.uint8) if tooth is None else np.full(len(mesh.points), NOWHERE, np.int16)
            field[mesh.face_cells(name)] = 1 if tooth is None else tooth
        assert field is not None
        yield kind, field


def part_numbers(mesh: ElementMesh) -> NDArray[np.uint8]:
    """Return the number (m,) of the part to which each element belongs, from 1."""
    numbers = np.empty(len(mesh.cells), np.uint8)
    for number, part in enumerate(mesh.parts.values(), 1):
        numbers[part] = number
    return numbers


MESHIO_WORDS = {
    "tri6": "triangle6",
    "quad8": "quad8",
    "hex8": "hexahedron",
    "hex20": "hexahedron20",
    "tet10": "tetra10",
    "line3": "line3",
    "quad4": "quad",
    "line2": "line",
    "tri3": "triangle",
    "quad9": "quad9",
    "hex27": "hexahedron27",
}
"""Names of elements and faces in meshio; the order of their nodes is ours."""

_LINEAR_FACES = {"line3": "line2", "tri6": "tri3", "quad4": "quad4", "quad8": "quad4"}
"""Faces as scikit-fem reads them: their vertices."""

_FACE_NODES = {"line2": 2, "tri3": 3, "quad4": 4, "line3": 3, "tri6": 6, "quad8": 8}

_VTK_FACES = (5, 3, 2, 4, 0, 1)
"""Our sides of a hexahedron in the order of VTK's nodes in faces: -x, +x, -y, +y, -z, +z."""

_VTK_KINDS = {Element.TRI6: 22, Element.QUAD8: 23, Element.HEX8: 12, Element.HEX20: 25, Element.TET10: 24}
"""Numbers of VTK's cells; the order of their nodes is ours."""


def vtk_grid(mesh: ElementMesh) -> Any:
    """Return a vtkUnstructuredGrid that shares nodes and elements with the mesh.

    Fields of its nodes are the kinds of sides (see `side_fields`), of its elements "part", which counts from 1; of the whole
    it is "matched_cut", nodes (k, 2), where there is a cyclic cut.
    """
    grid = vtk_elements(mesh.element, mesh.points, mesh.cells)
    for name, values in side_fields(mesh):
        grid.GetPointData().AddArray(_vtk_array(values, name))
    grid.GetCellData().AddArray(_vtk_array(part_numbers(mesh), "part"))
    for cut, pairs in mesh.matched.items():
        grid.GetFieldData().AddArray(_vtk_array(pairs.astype(np.int32), f"matched_{cut}"))
    return grid


def vtk_elements(element: Element, points: Floats, cells: NDArray[Any], fields: Mapping[str, Floats] | None = None) -> Any:
    """Return a vtkUnstructuredGrid of elements with nodes `cells` (m, n) at `points` (k, 3) and fields of the nodes."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

    grid, places, nodes = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    places.SetData(_vtk_array(points, "points"))
    grid.SetPoints(places)
    whole = np.int32 if cells.size < 2**31 else np.int64
    offsets = np.arange(0, cells.size + 1, cells.shape[1], dtype=whole)
    nodes.SetData(_vtk_array(offsets, "offsets"), _vtk_array(cells.ravel().astype(whole, copy=False), "nodes"))
    grid.SetCells(_VTK_KINDS[element], nodes)
    for name, values in (fields or {}).items():
        grid.GetPointData().AddArray(_vtk_array(values, name))
    return grid


def _vtk_array(values: NDArray[Any], name: str) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk

    made = numpy_to_vtk(np.ascontiguousarray(values))
    made.SetName(name)
    return made


def pyvista_grid(mesh: ElementMesh) -> Any:
    """Return the mesh as a pyvista.UnstructuredGrid. Raises ImportError without PyVista."""
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("ElementMesh.to_pyvista needs PyVista: pip install pyvista") from error
    return pyvista.UnstructuredGrid(vtk_grid(mesh))


def meshio_mesh(mesh: ElementMesh) -> Any:
    """Return a meshio.Mesh: elements, then faces of all sides; parts and sides are its cell sets, nodes of sides its point
    sets.
    """
    made = _with_sets(mesh, mesh.element.value, mesh.points, mesh.cells, mesh.element.shape.face)
    made.point_sets = {name: mesh.nodes(name) for name in mesh.sides}
    return made


_NEWTON_STEP = 1e-9
"""Step of Newton's method, in shares of an element, after which a place is within rounding: the next one would be its square.

In short elements far from the origin, scikit-fem's own search asks for steps that are smaller than rounding.
"""


def skfem_mesh(mesh: ElementMesh) -> Any:
    """Return a mesh of scikit-fem, of second order as ours is; parts are its subdomains, sides its boundaries.

    hex20 and quad8 gain the nodes inside of faces and elements that scikit-fem wants, where their own shape functions put
    them: the geometry stays as it is. Nodes have numbers of scikit-fem's own. Its search for places in hexahedra and
    quadrangles ends where rounding does; meshes that it makes of this one, by refining it or so, have its own search again.
    """
    from skfem.io.meshio import from_meshio
    from skfem.mapping import MappingIsoparametric

    mesh = _vertices_first(mesh)
    kind, points, cells = mesh.element.value, mesh.points, mesh.cells
    if mesh.element is Element.HEX20:
        kind, (points, cells) = "hex27", _with_centres(*_with_face_nodes(mesh), np.arange(20), "hex20")
    elif mesh.element is Element.QUAD8:
        kind, (points, cells) = "quad9", _with_centres(points, cells, np.arange(8), "quad8")
    found = from_meshio(_with_sets(mesh, kind, points, cells, _LINEAR_FACES[mesh.element.shape.face]), ignore_orientation=True)
    if not found.affine:
        mapping = MappingIsoparametric(found, found.elem(), found.bndelem)
        mapping.invF = partial(mapping.invF, newton_tol=_NEWTON_STEP)
        found._cached_mapping = mapping
    return found


def _vertices_first(mesh: ElementMesh) -> ElementMesh:
    """Return the mesh with its nodes numbered as scikit-fem takes them: those between vertices after all vertices."""
    between = np.ones(len(mesh.points), bool)
    between[mesh.cells[:, : mesh.element.shape.vertices]] = False
    order = np.argsort(between, kind="stable")
    number = np.empty(len(order), np.int32)
    number[order] = np.arange(len(order))
    return replace(mesh, points=mesh.points[order], cells=number[mesh.cells])


def _with_sets(mesh: ElementMesh, kind: str, points: Floats, cells: Cells, face: str) -> Any:
    """Return a meshio.Mesh of elements and faces of these kinds, with our parts and sides as its cell sets."""
    import meshio

    faces = [mesh.face_cells(name)[:, : _FACE_NODES[face]] for name in mesh.sides]
    blocks = [(MESHIO_WORDS[kind], cells)]
    if faces:
        blocks.append((MESHIO_WORDS[face], np.concatenate(faces)))
    none, start = np.empty(0, np.int64), 0
    numbers = np.arange(max(len(rows) for _, rows in blocks))
    sets = {name: [numbers[part], none][: len(blocks)] for name, part in mesh.parts.items()}
    for name, rows in zip(mesh.sides, faces, strict=True):
        sets[name] = [none, numbers[start : start + len(rows)]]
        start += len(rows)
    return meshio.Mesh(points, blocks, cell_sets=sets)


def _with_face_nodes(mesh: ElementMesh) -> tuple[Floats, Cells]:
    """Return the points and elements (m, 26) of hexahedra with a node more in each face, in VTK's order."""
    faces = mesh.cells[:, np.array(mesh.element.shape.faces)[list(_VTK_FACES)]].reshape(-1, 8)
    _, first, number = np.unique(np.sort(faces[:, :4]), axis=0, return_index=True, return_inverse=True)
    middles = shape_values("quad8", np.full((1, 2), 0.5))[0] @ mesh.points[faces[first]]
    cells = np.concatenate([mesh.cells, len(mesh.points) + number.reshape(-1, 6)], axis=1)
    return np.concatenate([mesh.points, middles]), cells.astype(np.int32)


def _with_centres(points: Floats, cells: Cells, own: Wholes, kind: str) -> tuple[Floats, Cells]:
    """Return the points and elements with a node more in the middle of each, where the shape functions of this kind put it."""
    middle = shape_values(kind, np.full((1, node_places(kind).shape[1]), 0.5))[0]
    centres = middle @ points[cells[:, own]]
    numbers = np.arange(len(points), len(points) + len(cells), dtype=np.int32)
    return np.concatenate([points, centres]), np.c_[cells, numbers]
