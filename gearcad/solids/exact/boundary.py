"""The boundary of a solid as plain data: shared vertices and edges, faces, and the places at which forms are used again.

A `Recorder` takes it down while it is made; what reads it makes a solid of the CAD kernel, or the text of a file.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.exact.forms import CurveForm, OnSurface, SurfaceForm, Vector

__all__ = ["Boundary", "BoundaryEdge", "BoundaryFace", "Chain", "LaidCurve", "Recorder", "Turn", "backward"]

Chain = list[tuple[int, bool]]
"""Edges in order, each with True if it is run along its own direction."""

PRECISION = 1e-7
"""OpenCASCADE's own smallest distance (mm)."""


class Turn(NamedTuple):
    """A place: lifted by `z` (mm) and turned about the z axis by `angle` (rad)."""

    z: float
    angle: float


class BoundaryEdge(NamedTuple):
    """On a curve in a place (its number), from the vertex `start` at the parameter `first` to `end` at `last`."""

    curve: CurveForm
    place: int
    start: int
    end: int
    first: float
    last: float


class BoundaryFace(NamedTuple):
    """On a surface in a place; its loops run counter-clockwise (holes clockwise) about the surface's own normal.

    That normal points out of the solid if `outward`.
    """

    surface: SurfaceForm
    place: int
    loops: tuple[Chain, ...]
    outward: bool


class LaidCurve(NamedTuple):
    """What `edges` are in the parameters of a surface, each edge in one of the `places`; two curves where an edge is the seam
    of a closed surface.
    """

    edges: Sequence[int]
    surface: SurfaceForm
    places: Sequence[int]
    curves: tuple[OnSurface, ...]


@dataclass(frozen=True, eq=False)
class Boundary:
    """One closed shell. `vertices` are points (mm); everything else names vertices, edges and places by their numbers.

    Curves, surfaces and vertices may differ by the `tolerance` (mm). The first place is that where nothing is moved.
    `sources` has for each vertex the one it is a copy of and the place that copy is moved to; itself and 0 for others.
    """

    tolerance: float
    places: Sequence[Turn]
    vertices: Sequence[Vector]
    sources: Sequence[tuple[int, int]]
    edges: Sequence[BoundaryEdge]
    laid: Sequence[LaidCurve]
    faces: Sequence[BoundaryFace]


def backward(chain: Chain) -> Chain:
    """A chain of edges run the other way."""
    return [(edge, not along) for edge, along in reversed(chain)]


class Recorder:
    """Takes down vertices, edges and faces of one solid (lengths in mm).

    Vertices and edges get twice the `tolerance` to which their curves are fitted: a curve and its surface may differ by
    as much from the exact shape, to opposite sides.
    """

    def __init__(self, tolerance: float) -> None:
        self.tolerance = max(2 * tolerance, PRECISION)
        self.here = 0
        self._places = [Turn(0.0, 0.0)]
        self._vertices: list[Vector] = []
        self._sources: list[tuple[int, int]] = []
        self._edges: list[BoundaryEdge] = []
        self._laid: list[LaidCurve] = []
        self._faces: list[BoundaryFace] = []

    def boundary(self) -> Boundary:
        """What was taken down."""
        return Boundary(self.tolerance, self._places, self._vertices, self._sources, self._edges, self._laid, self._faces)

    def moved(self, z: float, angle: float) -> Recorder:
        """The same recorder, but what is taken down by it stands higher by `z` (mm) and turned by `angle` (rad)."""
        moved = copy(self)
        moved.here = self._place(z, angle)
        return moved

    def turned(self, angle: float) -> int:
        """The place of a thing turned about z (rad)."""
        return self._place(0.0, angle)

    def _place(self, z: float, angle: float) -> int:
        here = self._places[self.here]
        self._places.append(Turn(here.z + z, here.angle + angle))
        return len(self._places) - 1

    def vertex(self, point: Sequence[float]) -> int:
        """A vertex at a point."""
        x, y, z = point
        if self.here:
            place = self._places[self.here]
            cosine, sine = math.cos(place.angle), math.sin(place.angle)
            x, y, z = cosine * x - sine * y, sine * x + cosine * y, z + place.z
        self._sources.append((len(self._vertices), 0))
        self._vertices.append((float(x), float(y), float(z)))
        return len(self._vertices) - 1

    def vertices_around(self, points: Floats, places: Sequence[int]) -> list[list[int]]:
        """Record points (places, n, 3), each row the first one moved to its place; return the vertices by place."""
        if self.here:  # what is moved as a whole has no places in common with what is not
            return [[self.vertex(point) for point in row] for row in points.tolist()]
        first, count = len(self._vertices), points.shape[1]
        self._vertices += [tuple(point) for row in points.tolist() for point in row]
        self._sources += [(first + number, place) for place in places for number in range(count)]
        return np.arange(first, first + len(places) * count).reshape(len(places), count).tolist()

    def edge(self, curve: CurveForm, start: int, end: int, first: float, last: float, place: int | None = None) -> int:
        """An edge on a curve (in a place) from the vertex `start` at the parameter `first` to `end` at `last`."""
        self._edges.append(BoundaryEdge(curve, self.here if place is None else place, start, end, first, last))
        return len(self._edges) - 1

    def edges(self, edges: Iterable[BoundaryEdge]) -> int:
        """Record edges that name their places themselves; return the number of the first one."""
        first = len(self._edges)
        self._edges.extend(edges)
        return first

    def lay(self, edge: int, surface: SurfaceForm, *curves: OnSurface, place: int | None = None) -> None:
        """Give an edge its curve in the parameters of a surface; two curves make it the seam of a closed one."""
        self._laid.append(LaidCurve((edge,), surface, (self.here if place is None else place,), curves))

    def lay_copies(self, edges: Sequence[int], surface: SurfaceForm, curve: OnSurface, places: Sequence[int]) -> None:
        """Give copies of an edge the same curve in the parameters of a surface, each at its place."""
        self._laid.append(LaidCurve(edges, surface, places, (curve,)))

    def face(self, surface: SurfaceForm, loops: Iterable[Chain], *, outward: bool = True, place: int | None = None) -> None:
        """A face; its loops run counter-clockwise (holes clockwise) about the surface's own normal."""
        self._faces.append(BoundaryFace(surface, self.here if place is None else place, tuple(loops), outward))
