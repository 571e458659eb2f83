"""Tetrahedra of second order made of those of the first, with all nodes of the surface on the exact faces of a gear."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.errors import SolverError
from gearcad.geometry import Gear
from gearcad.geometry.halves import halves
from gearcad.geometry.helix import height_in_half
from gearcad.geometry.turned import flank_curves
from gearcad.meshing.bodies.brep import Filled, Surface
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.exact_flanks import ExactFlank
from gearcad.meshing.bodies.gear_faces import GearFace
from gearcad.meshing.bodies.mended import mended, poor_elements
from gearcad.meshing.bodies.mesh import Cells
from gearcad.meshing.bodies.parted import inner_edges, part_edges
from gearcad.solids.exact.ends import End, gear_ends
from gearcad.solids.exact.outline import tooth_outline

__all__ = ["quadratic"]

_OFF = 1e-5
"""A node that is farther (mm) from the face it is said to be on is on another one."""

_TRIES = 4
"""Times that poor elements are parted: those beside them may be the next."""

_ROUND = ((0, 1), (1, 2), (2, 0))
"""Edges of a triangle."""


def quadratic(gear: Gear, faces: Sequence[GearFace], filled: Filled) -> tuple[Floats, Cells]:
    """Points (n, 3) in mm, vertices first, then the middles of edges, and cells (m, 10): order of nodes as TET10 has it.

    Nodes on flanks, fillets, chamfers and lands are on the exact, modified ones. Raises SolverError if a vertex is not on
    the face that it was said to be on.
    """
    filled = replace(filled, tetrahedra=_upright(filled))
    for _ in range(_TRIES):
        points, cells, free = _curved(gear, faces, filled)
        poor = poor_elements(points, cells)
        edges = inner_edges(filled.points, filled.tetrahedra[poor], free[cells[poor, 4:]])
        if not edges:
            break
        parted = part_edges(filled.points, filled.tetrahedra, edges)
        filled = replace(filled, points=parted[0], tetrahedra=parted[1])
    return points, cells


def _curved(gear: Gear, faces: Sequence[GearFace], filled: Filled) -> tuple[Floats, Cells, Bools]:
    """Points, cells, and which of the points are middles of edges inside."""
    edges, middles = _edges(filled.tetrahedra)
    surface = _Surface(gear, faces, filled, edges)
    vertices, along = surface.vertices()
    points = np.concatenate([vertices, surface.middles(vertices, along)])
    cells = np.concatenate([filled.tetrahedra, len(vertices) + middles], 1, dtype=np.int32)
    return mended(points, cells, surface.inner_middles), cells, surface.inner_middles


def _upright(filled: Filled) -> Cells:
    """Tetrahedra whose first three vertices are counter-clockwise seen from the fourth."""
    a, b, c, d = np.moveaxis(filled.points[filled.tetrahedra], 1, 0)
    below = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    return np.where(below[:, None], filled.tetrahedra[:, [0, 2, 1, 3]], filled.tetrahedra)


def _edges(cells: Cells) -> tuple[Cells, Cells]:
    """Edges (n, 2), lower vertex first, in order, and those (m, 6) of each tetrahedron."""
    keys, found = np.unique(_keys(cells[:, Element.TET10.shape.edges]), return_inverse=True)
    return np.stack(np.divmod(keys, _BASE), -1).astype(np.int32), found.reshape(-1, 6).astype(np.int32)


_BASE = 2**31


def _keys(pairs: Cells) -> Wholes:
    """A number for each pair of nodes (..., 2), whatever their order."""
    low, high = np.moveaxis(np.sort(pairs, -1).astype(np.int64), -1, 0)
    found: Wholes = low * _BASE + high
    return found


class _Meshed(NamedTuple):
    """A face with the numbers of the nodes and edges on it."""

    face: GearFace
    nodes: Cells
    edges: Wholes


@dataclass(frozen=True)
class _Swept:
    """Nodes on a piece of the flanks of all teeth, and the edges between them, each with its tooth."""

    flank: ExactFlank
    nodes: Cells
    teeth: Wholes
    edges: Wholes
    edge_teeth: Wholes


@dataclass(frozen=True)
class _Surface:
    """Nodes and edges of a mesh by the faces that they are on."""

    gear: Gear
    faces: Sequence[GearFace]
    filled: Filled
    edges: Cells

    # ------------------------------------------------------------------ which are where

    @cached_property
    def _edge_numbers(self) -> list[Wholes]:
        """Numbers of the edges on each face."""
        known = _keys(self.edges)
        return [np.unique(np.searchsorted(known, _keys(cells[:, _ROUND]))) for cells in self.filled.triangles]

    def _on(self, surface: Surface) -> Iterator[_Meshed]:
        """Faces on a kind of surface."""
        for face, cells, edges in zip(self.faces, self.filled.triangles, self._edge_numbers, strict=True):
            if face.surface is surface:
                yield _Meshed(face, np.unique(cells), edges)

    def _marked(self, surface: Surface) -> tuple[Bools, Bools]:
        """Which nodes, and which edges, are on a kind of surface."""
        nodes, edges = np.zeros(len(self.filled.points), bool), np.zeros(len(self.edges), bool)
        for meshed in self._on(surface):
            nodes[meshed.nodes] = edges[meshed.edges] = True
        return nodes, edges

    @cached_property
    def _swept(self) -> list[_Swept]:
        """Flanks, a piece after the other."""
        groups: dict[tuple[int, bool], list[_Meshed]] = {}
        for meshed in self._on(Surface.SPLINE):
            assert meshed.face.curve is not None
            groups.setdefault((meshed.face.curve, meshed.face.left), []).append(meshed)
        curves = flank_curves(self.gear)
        return [
            _Swept(
                ExactFlank(self.gear, curves[curve], left),
                np.concatenate([each.nodes for each in members]),
                np.concatenate([np.full(len(each.nodes), each.face.tooth) for each in members]),
                np.concatenate([each.edges for each in members]),
                np.concatenate([np.full(len(each.edges), each.face.tooth) for each in members]),
            )
            for (curve, left), members in groups.items()
        ]

    @cached_property
    def _ends(self) -> tuple[End, End]:
        half = halves(self.gear)[0].gear if self.gear.double_helix.present else self.gear
        return gear_ends(half, [piece.start[0] for piece in tooth_outline(half)])

    @cached_property
    def _on_cones(self) -> tuple[Bools, Bools]:
        return self._marked(Surface.CONE)

    def _end_heights(self, radius: Floats, z: Floats) -> Floats:
        """Heights (mm) of the nearer end at these radii (mm); the halves of a double helical gear have two each."""
        (lower, upper), width = self._ends, self.gear.face_width
        inside = height_in_half(self.gear, z)
        heights = np.where(inside < self.gear.half_width / 2, lower.height(radius), upper.height(radius))
        return np.where(inside == z, heights, width - heights)

    @property
    def inner_middles(self) -> Bools:
        """Which of all nodes, vertices before middles, are in the middle of an edge inside."""
        free = np.ones(len(self.filled.points) + len(self.edges), bool)
        free[: len(self.filled.points)] = False
        free[len(self.filled.points) + np.concatenate(self._edge_numbers)] = False
        return free

    # ------------------------------------------------------------------ where they go

    def vertices(self) -> tuple[Floats, list[Floats]]:
        """Vertices (n, 3), and the parameters along the profile of those on each piece of the flanks, NaN elsewhere."""
        points, found = self.filled.points.copy(), []
        for swept in self._swept:
            at = points[swept.nodes]
            s = swept.flank.nearest(at, swept.teeth)
            moved = self._placed(swept.flank, s, at[:, 2], swept.teeth, self._on_cones[0][swept.nodes])
            if (off := float(np.abs(moved - self.filled.points[swept.nodes]).max(initial=0.0))) > _OFF:
                raise SolverError(f"a node of the mesh is {off:.3g} mm from the face of the gear that it belongs to")
            points[swept.nodes] = moved
            along = np.full(len(points), np.nan)
            along[swept.nodes] = s
            found.append(along)
        return points, found

    def middles(self, vertices: Floats, along: Sequence[Floats]) -> Floats:
        """Middles (n, 3) of the edges."""
        points: Floats = vertices[self.edges].mean(1)
        conical = self._on_cones[1]
        points[conical] = self._round_cone(points[conical])
        for face, _, edges in self._on(Surface.CYLINDER):
            points[edges] = _at_radius(points[edges], np.array(face.radius), face.axis)
        for swept, s in zip(self._swept, along, strict=True):
            ends, at = s[self.edges[swept.edges]], points[swept.edges]
            middle = swept.flank.nearest(at, swept.edge_teeth)
            for end in (0.0, 1.0):  # an edge along an end of the curve stays there
                middle = np.where((ends == end).all(-1), end, middle)
            points[swept.edges] = self._placed(swept.flank, middle, at[:, 2], swept.edge_teeth, conical[swept.edges])
        return points

    def _placed(self, flank: ExactFlank, s: Floats, z: Floats, teeth: Wholes, conical: Bools) -> Floats:
        """Points (n, 3) of a flank; those that are on the cone of an end chamfer too are as high as that is."""
        radius, _ = flank.curve.curve.polar(s)
        return flank.points(s, np.where(conical, self._end_heights(radius, z), z), teeth)

    def _round_cone(self, points: Floats) -> Floats:
        """Points (n, 3) moved onto the cones of the end chamfers."""
        lower, upper = self._ends
        inside = height_in_half(self.gear, points[:, 2])
        setback = np.minimum(inside - lower.z, upper.z - inside)
        return _at_radius(points, lower.cone.face_radius + lower.cone.side * setback * lower.cone.slope)


def _at_radius(points: Floats, radius: Floats, axis: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Points (n, 3) moved to a radius (mm) about an axis (mm)."""
    middle = np.array([*axis, 0.0])
    moved: Floats = points - middle
    moved[:, :2] *= (radius / np.hypot(moved[:, 0], moved[:, 1]))[:, None]
    moved += middle
    return moved
