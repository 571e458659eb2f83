"""Meshes as objects of other libraries, with their parts and sides: VTK and PyVista, meshio, scikit-fem."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.fields import part_numbers, side_fields
from gearcad.meshing.bodies.interpolation import local_places, shape_values
from gearcad.meshing.bodies.mesh import Cells, ElementMesh

__all__ = ["MESHIO_WORDS", "meshio_mesh", "pyvista_grid", "skfem_mesh", "vtk_grid"]

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
"""What meshio calls elements and faces; the order of their nodes is ours."""

_LINEAR_FACES = {"line3": "line2", "tri6": "tri3", "quad4": "quad4", "quad8": "quad4"}
"""Faces as scikit-fem reads them: their vertices."""

_FACE_NODES = {"line2": 2, "tri3": 3, "quad4": 4, "line3": 3, "tri6": 6, "quad8": 8}

_VTK_FACES = (5, 3, 2, 4, 0, 1)
"""Our sides of a hexahedron in the order of VTK's nodes in faces: -x, +x, -y, +y, -z, +z."""

_VTK_KINDS = {Element.TRI6: 22, Element.QUAD8: 23, Element.HEX8: 12, Element.HEX20: 25, Element.TET10: 24}
"""Numbers of VTK's cells; the order of their nodes is ours."""


def vtk_grid(mesh: ElementMesh) -> Any:
    """A vtkUnstructuredGrid that shares nodes and elements with the mesh.

    Fields of its nodes are the kinds of sides (see `side_fields`), of its elements "part", which counts from 1; of the whole
    it is "matched_cut", nodes (k, 2), where there is a cyclic cut.
    """
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

    def array(values: Any, name: str) -> Any:
        made = numpy_to_vtk(np.ascontiguousarray(values))
        made.SetName(name)
        return made

    grid, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(array(mesh.points, "points"))
    grid.SetPoints(points)
    nodes = mesh.element.shape.nodes
    offsets = np.arange(0, mesh.cells.size + 1, nodes, dtype=np.int32 if mesh.cells.size < 2**31 else np.int64)
    cells.SetData(array(offsets, "offsets"), array(mesh.cells.ravel().astype(offsets.dtype, copy=False), "nodes"))
    grid.SetCells(_VTK_KINDS[mesh.element], cells)
    for name, field in side_fields(mesh):
        grid.GetPointData().AddArray(array(field, name))
    grid.GetCellData().AddArray(array(part_numbers(mesh), "part"))
    for cut, pairs in mesh.matched.items():
        grid.GetFieldData().AddArray(array(pairs.astype(np.int32), f"matched_{cut}"))
    return grid


def pyvista_grid(mesh: ElementMesh) -> Any:
    """The same as pyvista.UnstructuredGrid. Raises ImportError without PyVista."""
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("ElementMesh.to_pyvista needs PyVista: pip install pyvista") from error
    return pyvista.UnstructuredGrid(vtk_grid(mesh))


def meshio_mesh(mesh: ElementMesh) -> Any:
    """A meshio.Mesh: elements, then faces of all sides; parts and sides are its cell sets, nodes of sides its point sets."""
    made = _with_sets(mesh, mesh.element.value, mesh.points, mesh.cells, mesh.element.shape.face)
    made.point_sets = {name: mesh.nodes(name) for name in mesh.sides}
    return made


def skfem_mesh(mesh: ElementMesh) -> Any:
    """A mesh of scikit-fem, of second order as ours is; parts are its subdomains, sides its boundaries.

    hex20 and quad8 gain the nodes inside of faces and elements that scikit-fem wants, where their own shape functions put
    them: the geometry stays as it is. Nodes have numbers of scikit-fem's own. Its search for places in hexahedra and
    quadrangles ends where rounding does; meshes that it makes of this one, by refining it or so, have its own search again.
    """
    from skfem.io.meshio import from_meshio

    from gearcad.meshing.bodies.rounded_mapping import RoundedMapping

    mesh = _vertices_first(mesh)
    kind, points, cells = mesh.element.value, mesh.points, mesh.cells
    if mesh.element is Element.HEX20:
        kind, (points, cells) = "hex27", _with_centres(*_with_face_nodes(mesh), np.arange(20), "hex20")
    elif mesh.element is Element.QUAD8:
        kind, (points, cells) = "quad9", _with_centres(points, cells, np.arange(8), "quad8")
    found = from_meshio(_with_sets(mesh, kind, points, cells, _LINEAR_FACES[mesh.element.shape.face]), ignore_orientation=True)
    if not found.affine:
        found._cached_mapping = RoundedMapping(found, found.elem(), found.bndelem)
    return found


def _vertices_first(mesh: ElementMesh) -> ElementMesh:
    """The same mesh with its nodes numbered as scikit-fem takes them: those between vertices after all of these."""
    between = np.ones(len(mesh.points), bool)
    between[mesh.cells[:, : mesh.element.shape.vertices]] = False
    order = np.argsort(between, kind="stable")
    number = np.empty(len(order), np.int32)
    number[order] = np.arange(len(order))
    return replace(mesh, points=mesh.points[order], cells=number[mesh.cells])


def _with_sets(mesh: ElementMesh, kind: str, points: Floats, cells: Cells, face: str) -> Any:
    """A meshio.Mesh of elements and faces of these kinds, with our parts and sides as its cell sets."""
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
    """Points and elements (m, 26) of hexahedra with a node more in each face, in VTK's order."""
    faces = mesh.cells[:, np.array(mesh.element.shape.faces)[list(_VTK_FACES)]].reshape(-1, 8)
    _, first, number = np.unique(np.sort(faces[:, :4]), axis=0, return_index=True, return_inverse=True)
    middles = shape_values("quad8", np.zeros((1, 2)))[0] @ mesh.points[faces[first]]
    cells = np.concatenate([mesh.cells, len(mesh.points) + number.reshape(-1, 6)], axis=1)
    return np.concatenate([mesh.points, middles]), cells.astype(np.int32)


def _with_centres(points: Floats, cells: Cells, own: Wholes, kind: str) -> tuple[Floats, Cells]:
    """Points and elements with a node more in the middle of each, where the shape functions of this kind put it."""
    middle = shape_values(kind, np.zeros((1, len(local_places(kind)[0]))))[0]
    centres = middle @ points[cells[:, own]]
    numbers = np.arange(len(points), len(points) + len(cells), dtype=np.int32)
    return np.concatenate([points, centres]), np.c_[cells, numbers]
