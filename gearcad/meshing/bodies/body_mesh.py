"""The body of one gear in hexahedra: its section swept along the helix, nodes of modified flanks on the modified surface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.geometry.helix import height_in_half, section_turn
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.layers import body_planes, check_planes
from gearcad.meshing.bodies.mesh import Cells, ElementMesh, Faces
from gearcad.meshing.bodies.modified import Turns, modification_turns
from gearcad.meshing.bodies.section_mesh import NO_CONTACTS, mesh_section
from gearcad.meshing.section.outline import MeshSizes
from gearcad.meshing.section.swept import Stack
from gearcad.notice import Notice

__all__ = ["mesh_body", "swept_notices"]


_AS_FILES = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19]
"""Nodes of a hexahedron in the order of `Element`, of those that a stack has: both planes, then half-way."""

_BELOW, _ABOVE, _FIRST_SIDE = 0, 1, 2
"""Sides of a hexahedron: those on planes, and that over the section's first edge."""


def mesh_body(
    gear: Gear,
    *,
    teeth: int | None,
    held_radius: float,
    sizes: MeshSizes,
    planes: Floats | None,
    element: Element,
    contacts: Mapping[int, ContactZone] = NO_CONTACTS,
) -> ElementMesh:
    """Mesh a gear down, or a ring out, to `held_radius` (mm) in hexahedra between `planes` (n,), heights in mm.

    Planes None are those of the sizes.

    `teeth`, `contacts` and the named sides are those of `mesh_section`; here are also "end_back" at z = 0 and "end_front" at
    the face width. Keyway, hub and end chamfers are left out: `swept_notices` says so. Quality is for the caller to measure.
    Raises ParameterError, GeometryError and SolverError.
    """
    if element not in (Element.HEX8, Element.HEX20):
        raise ParameterError("element", element.value, 'must be "hex20" or "hex8" for a swept body')
    planes = body_planes(gear, sizes) if planes is None else np.asarray(planes, float)
    check_planes(gear, planes)
    section = mesh_section(
        gear, teeth=teeth, held_radius=held_radius, sizes=sizes, element=Element.QUAD8, contacts=contacts, modified=False
    )
    return _Swept(gear, section, planes, element).mesh


def swept_notices(gear: Gear) -> list[Notice]:
    """What of a gear's body swept hexahedra do not have."""
    body = gear.body
    features = {
        "keyway": body.keyway_width,
        "hub": body.hub_diameter,
        "bolt holes": body.bolt_holes,
        "end chamfers": body.end_chamfer,
    }
    missing = [name for name, size in features.items() if size]
    if not missing:
        return []
    words = " and ".join([*([", ".join(missing[:-1])] if missing[1:] else []), missing[-1]])
    return [Notice("swept-body", f"hexahedra are swept along the helix, without {words}; tet10 has them")]


@dataclass(frozen=True)
class _Swept:
    """A section of quadrangles of the exact gear, its vertices first, and the planes between which it is swept."""

    gear: Gear
    section: ElementMesh
    planes: Floats
    element: Element

    @property
    def mesh(self) -> ElementMesh:
        points, cells = self._points(), self._cells()
        return ElementMesh(self.element, points, cells, {"gear": slice(0, len(cells))}, self._sides(), self._matched())

    @cached_property
    def _layers(self) -> int:
        return len(self.planes) - 1

    @cached_property
    def _vertices(self) -> int:
        return 1 + int(self.section.cells[:, :4].max())

    @cached_property
    def _stack(self) -> Stack:
        if self.element is Element.HEX8:
            return Stack(self._vertices, 0, self._layers)
        return Stack(len(self.section.points), self._vertices, self._layers)

    def _cells(self) -> Cells:
        """Layer by layer, each as the quadrangles of the section."""
        quads = self.section.cells[:, :4] if self.element is Element.HEX8 else self.section.cells
        order = slice(None) if self.element is Element.HEX8 else _AS_FILES
        lowest = self._stack.elements(quads.astype(np.int64), 0)[:, order]
        rise = self._stack.elements(quads[:1].astype(np.int64), 1)[:, order] - lowest[:1]
        cells = np.empty((self._layers, *lowest.shape), np.int32)
        for layer, part in enumerate(cells):
            np.add(lowest, layer * rise, out=part, casting="same_kind")
        return cells.reshape(-1, lowest.shape[1])

    # ------------------------------------------------------------------ places

    def _points(self) -> Floats:
        """Each plane turned by the helix, and its nodes by what modifies their flanks."""
        stack = self._stack
        middles = (self.planes[1:] + self.planes[:-1]) / 2
        heights = np.r_[self.planes, middles] if stack.half else self.planes
        turns = modification_turns(self.section, self.gear, height_in_half(self.gear, heights))
        points = np.empty((stack.total, 3))
        for number, z in enumerate(heights):
            layer = number - len(self.planes)
            start, count = (stack.plane(number), stack.nodes) if layer < 0 else (stack.middle(layer), stack.half)
            self._place(points[start : start + count], turns, number, float(z))
        return points

    def _place(self, points: Floats, turns: Turns, number: int, z: float) -> None:
        """Set the points (n, 3) of the first nodes of the section at a height."""
        angle = section_turn(self.gear, np.asarray(z)) + (turns.at(number)[: len(points)] if len(turns.fields) else 0.0)
        cosine, sine = np.cos(angle), np.sin(angle)
        x, y = self.section.points[: len(points), :2].T
        points[:, 0] = cosine * x - sine * y
        points[:, 1] = sine * x + cosine * y
        points[:, 2] = z

    # ------------------------------------------------------------------ names

    def _sides(self) -> dict[str, Faces]:
        quads = len(self.section.cells)
        found = {name: self._over(faces) for name, faces in self.section.sides.items()}
        lowest = np.arange(quads, dtype=np.int32)
        found["end_back"] = Faces(lowest, np.full(quads, _BELOW, np.int8))
        found["end_front"] = Faces(lowest + np.int32(quads * (self._layers - 1)), np.full(quads, _ABOVE, np.int8))
        return found

    def _over(self, edges: Faces) -> Faces:
        """Sides of hexahedra over edges of the section."""
        starts = np.arange(self._layers, dtype=np.int32)[:, None] * np.int32(len(self.section.cells))
        sides = np.tile(edges.sides + np.int8(_FIRST_SIDE), self._layers)
        return Faces((starts + edges.elements).ravel(), sides)

    def _matched(self) -> dict[str, Wholes]:
        return {name: np.stack([self._above(nodes) for nodes in pairs.T], -1) for name, pairs in self.section.matched.items()}

    def _above(self, nodes: Wholes) -> Wholes:
        """All nodes of the mesh above section nodes."""
        return self._stack.over(nodes[nodes < self._stack.nodes])
