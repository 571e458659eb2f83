"""ElementMesh: nodes, elements and named sides of a body, or of several in one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats, Wholes
from gearcad.meshing.bodies.elements import Element

__all__ = ["Cells", "ElementMesh", "Faces", "joined"]

Cells = NDArray[np.int32]
"""Nodes of elements: half of what a mesh takes, were they longer."""


@dataclass(frozen=True)
class Faces:
    """Sides of elements: which element (n,), and which of its sides (n,), counted from 0 as `Shape.faces` are."""

    elements: Cells
    sides: NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.elements)

    def shifted(self, elements: int) -> Faces:
        """The same sides where so many elements stand before them."""
        return replace(self, elements=self.elements + np.int32(elements))


@dataclass(frozen=True)
class ElementMesh:
    """Elements of one kind.

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
        """Nodes (n, nodes of a face) of a named side, face by face, its vertices first, normals outwards."""
        faces = self.sides[name]
        local = np.array(self.element.shape.faces)[faces.sides]
        found: Cells = self.cells[faces.elements[:, None], local]
        return found

    def nodes(self, name: str) -> Cells:
        """Numbers (n,) of the nodes of a named side, in order."""
        return np.unique(self.face_cells(name))

    def to_meshio(self) -> Any:
        """A meshio.Mesh of elements and faces of sides; parts and sides are its cell sets, nodes of sides its point sets."""
        from gearcad.meshing.bodies.conversions import meshio_mesh

        return meshio_mesh(self)

    def to_skfem(self) -> Any:
        """A mesh of scikit-fem, with the parts as subdomains and the sides as boundaries; nodes have other numbers there."""
        from gearcad.meshing.bodies.conversions import skfem_mesh

        return skfem_mesh(self)

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid, with fields of the nodes for each kind of side. Raises ImportError without PyVista."""
        from gearcad.meshing.bodies.conversions import pyvista_grid

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
