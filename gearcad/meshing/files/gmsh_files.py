"""Files that gmsh writes: .msh, UNV and MED, with named groups of elements and of sides."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.arrays import Bools
from gearcad.errors import SolverError
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.mesh import Cells

__all__ = ["write_with_gmsh"]

_KINDS = {"tri6": 9, "quad8": 16, "hex8": 5, "hex20": 17, "tet10": 11, "line3": 8, "quad4": 3}
"""What gmsh calls elements and faces. Faces have its order of nodes already."""

_ORDERS = {
    Element.HEX20: [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
    Element.TET10: [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
}
"""Our nodes in gmsh's order, where that is another one: gmsh reference manual, "Node ordering"."""


def write_with_gmsh(mesh: ElementMesh, path: Path) -> None:
    """Write what the suffix of `path` says. Parts are groups of elements, sides groups of their own elements after those.

    Groups count from 1, the parts first. Raises SolverError where gmsh cannot write the file.
    """
    import gmsh

    with _model(gmsh):
        _add_parts(gmsh.model, mesh)
        _add_sides(gmsh.model, mesh)
        try:
            gmsh.write(str(path))
        except Exception as error:  # gmsh raises nothing finer
            raise SolverError(f"gmsh could not write {path.name}: {error}") from error


@contextmanager
def _model(gmsh: Any) -> Iterator[None]:
    """A model of our own, also beside those of a caller who uses gmsh."""
    ours = not gmsh.is_initialized()
    if ours:
        gmsh.initialize(interruptible=False)  # the other way works in the main thread only
    before = gmsh.option.get_number("General.Terminal"), gmsh.option.get_number("Mesh.Binary")
    try:
        gmsh.option.set_number("General.Terminal", 0)
        gmsh.option.set_number("Mesh.Binary", 1)
        gmsh.model.add("gearcad")
        yield
    finally:
        if ours:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            gmsh.option.set_number("General.Terminal", before[0])
            gmsh.option.set_number("Mesh.Binary", before[1])


def _add_parts(model: Any, mesh: ElementMesh) -> None:
    """The parts as entities with the nodes that no part before them has."""
    dimension, order = mesh.element.shape.dimension, _ORDERS.get(mesh.element, slice(None))
    waiting: Bools = np.ones(len(mesh.points), bool)
    for tag, (name, part) in enumerate(mesh.parts.items(), 1):
        cells = mesh.cells[part]
        own = np.zeros_like(waiting)
        own[cells] = True
        nodes = np.flatnonzero(own & waiting)
        waiting[nodes] = False
        model.add_discrete_entity(dimension, tag)
        model.mesh.add_nodes(dimension, tag, nodes + 1, mesh.points[nodes].ravel())
        _add_elements(model, tag, mesh.element.value, cells[:, order], part.start)
        model.add_physical_group(dimension, [tag], tag, name)


def _add_sides(model: Any, mesh: ElementMesh) -> None:
    """The sides as entities, whose nodes are there already."""
    dimension, elements = mesh.element.shape.dimension - 1, len(mesh.cells)
    for tag, name in enumerate(mesh.sides, len(mesh.parts) + 1):
        faces = mesh.face_cells(name)
        model.add_discrete_entity(dimension, tag)
        _add_elements(model, tag, mesh.element.shape.face, faces, elements)
        model.add_physical_group(dimension, [tag], tag, name)
        elements += len(faces)


def _add_elements(model: Any, tag: int, kind: str, cells: Cells, before: int) -> None:
    """Elements of an entity, numbered from the next after `before`."""
    numbers = np.arange(before + 1, before + 1 + len(cells))
    model.mesh.add_elements_by_type(tag, _KINDS[kind], numbers, cells.ravel() + np.int64(1))
