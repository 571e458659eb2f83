"""Files that gmsh writes: UNV and MED, with named groups of elements and of sides."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from gearcad.errors import SolverError
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.mesh import Cells
from gearcad.meshing.files.gmsh_kinds import KINDS, ORDERS, nodes_of_parts
from gearcad.meshing.gmsh_library import load_gmsh

__all__ = ["write_with_gmsh"]


_END_OF_UNV = b"    -1\n"
"""Line that ends each part of a universal file."""


def write_with_gmsh(mesh: ElementMesh, path: Path) -> None:
    """Write what the suffix of `path` says. Parts are groups of elements, sides groups of their own elements after those.

    Groups count from 1, the parts first. Raises SolverError where gmsh cannot write the file.
    """
    gmsh = load_gmsh()
    with _model(gmsh):
        _add_parts(gmsh.model, mesh)
        _add_sides(gmsh.model, mesh)
        try:
            gmsh.write(str(path))
        except Exception as error:  # gmsh raises nothing finer
            raise SolverError(f"gmsh could not write {path.name}: {error}") from error
    if path.suffix == ".unv" and not _ends_with(path, _END_OF_UNV):  # gmsh does not look at what it writes
        raise SolverError(f"gmsh could not write all of {path.name}: the disk is full, or larger files are not permitted")


def _ends_with(path: Path, end: bytes) -> bool:
    with path.open("rb") as file:
        file.seek(-min(len(end), path.stat().st_size), os.SEEK_END)
        return file.read() == end


@contextmanager
def _model(gmsh: Any) -> Iterator[None]:
    """A model of our own, also beside those of a caller who uses gmsh."""
    ours = not gmsh.is_initialized()
    if ours:
        gmsh.initialize(interruptible=False)  # the other way works in the main thread only
    terminal = gmsh.option.get_number("General.Terminal")
    try:
        gmsh.option.set_number("General.Terminal", 0)
        gmsh.model.add("gearcad")
        yield
    finally:
        if ours:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            gmsh.option.set_number("General.Terminal", terminal)


def _add_parts(model: Any, mesh: ElementMesh) -> None:
    """The parts as entities with the nodes that no part before them has."""
    dimension = mesh.element.shape.dimension
    parts = zip(mesh.parts.items(), nodes_of_parts(mesh), strict=True)
    for tag, ((name, part), nodes) in enumerate(parts, 1):
        model.add_discrete_entity(dimension, tag)
        model.mesh.add_nodes(dimension, tag, nodes + 1, mesh.points[nodes].ravel())
        _add_elements(model, tag, mesh.element.value, mesh.cells[part][:, ORDERS[mesh.element]], part.start)
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
    model.mesh.add_elements_by_type(tag, KINDS[kind], numbers, cells.ravel() + np.int64(1))
