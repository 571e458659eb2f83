"""Boundary of a solid as plain data: curves, surfaces, shared vertices, edges and faces.

One polynomial span per smooth piece keeps the shared edges of neighbouring faces identical, pole for pole.

Lengths in mm, angles in rad. What they are parametrised by is what ISO 10303-42 and the OpenCASCADE kernel say.

A `Recorder` takes it down while it is made; what reads it makes a solid of the CAD kernel, or the text of a file.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cache
from math import comb
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats

MOST_DEGREE = 25
"""Highest degree of a B-spline that the OpenCASCADE kernel accepts."""


def bernstein(degree: int, t: Floats) -> Floats:
    """Bernstein polynomials of one degree at t (n,): (n, degree + 1)."""
    power = np.arange(degree + 1)
    weight = np.array([comb(degree, int(i)) for i in power], float)
    return np.asarray(weight * t[:, None] ** power * (1 - t[:, None]) ** (degree - power), float)


@cache
def _nodes(degree: int) -> tuple[Floats, Floats]:
    """Chebyshev-Lobatto nodes on [0, 1] and the matrix that turns values there into poles."""
    nodes: Floats = np.asarray(0.5 - 0.5 * np.cos(np.pi * np.arange(degree + 1) / degree), float)
    nodes[0], nodes[-1] = 0.0, 1.0
    to_poles = np.asarray(np.linalg.inv(bernstein(degree, nodes)), float)
    return nodes, to_poles


@cache
def _check(degree: int) -> tuple[Floats, Floats]:
    """Return the points between the nodes (the extremes of the interpolation error lie close to them), and their Bernstein
    values.
    """
    nodes, _ = _nodes(degree)
    t = np.sort(np.concatenate([nodes[:-1] + f * np.diff(nodes) for f in (0.25, 0.5, 0.75)])).astype(float)
    return t, bernstein(degree, t)


def interpolate(function: Callable[[Floats], Floats], degree: int) -> Floats:
    """Return the poles (degree + 1, k) of the Bezier that interpolates `function` ((n,) in [0, 1] -> (n, k)), ends exact."""
    return _through(function(_nodes(degree)[0]))


def interpolate_surface(function: Callable[[Floats, Floats], Floats], degrees: tuple[int, int]) -> Floats:
    """Return the poles (n + 1, m + 1, k) of the Bezier surface of degrees n and m that interpolates `function` ((n,), (m,) ->
    (n, m, k)).

    An edge depends on the values there alone, so neighbours have its poles in common.
    """
    values = function(*(_nodes(degree)[0] for degree in degrees))
    return np.swapaxes(_through(np.swapaxes(_through(values), 0, 1)), 0, 1)


def _through(values: Floats) -> Floats:
    """Return the poles (n + 1, ...) of the Bezier through the values at the nodes of degree n, ends exact."""
    to_poles = _nodes(len(values) - 1)[1]
    poles: Floats = (to_poles @ values.reshape(len(values), -1)).reshape(values.shape)
    poles[0], poles[-1] = values[0], values[-1]
    return poles


def fit(
    function: Callable[[Floats], Floats],
    error: Callable[[Floats, Floats], Floats],
    tolerance: float,
    *,
    least: int = 2,
    most: int = MOST_DEGREE,
) -> Floats | None:
    """Return the poles of the lowest-degree interpolant with `error(values, t) <= tolerance` between the nodes; None if there
    is none.
    """
    for degree in range(least, most + 1):
        poles = interpolate(function, degree)
        t, basis = _check(degree)
        if np.max(error(basis @ poles, t)) <= tolerance:
            return poles
    return None


Point = tuple[float, float]
Vector = tuple[float, float, float]

ORIGIN: Point = (0.0, 0.0)


class Frame(NamedTuple):
    """A right-handed frame: its origin, and unit vectors along its z (`axis`) and x (`along`)."""

    origin: Vector
    axis: Vector
    along: Vector


@dataclass(frozen=True, eq=False)
class StraightLine:
    """Straight line from `start` along the unit vector `direction`; its parameter is the distance."""

    start: Vector
    direction: Vector


@dataclass(frozen=True, eq=False)
class CircleCurve:
    """Circle in the xy plane of its frame; its parameter is the angle from the frame's x."""

    frame: Frame
    radius: float


@dataclass(frozen=True, eq=False)
class EllipseCurve:
    """Ellipse in the xy plane of its frame, its longer half axis `major` along x: major cos t, minor sin t."""

    frame: Frame
    major: float
    minor: float


@dataclass(frozen=True, eq=False)
class BezierCurve:
    """Bezier curve of one span with `poles` (n + 1, 3), parameter `first` ... `last`."""

    poles: Floats
    first: float = 0.0
    last: float = 1.0


@dataclass(frozen=True, eq=False)
class PlaneSurface:
    """Plane surface: the xy plane of its frame."""

    frame: Frame


@dataclass(frozen=True, eq=False)
class CylinderSurface:
    """Cylinder about the z axis of its frame; u is the angle from its x, v the height, the normal points outwards."""

    frame: Frame
    radius: float


@dataclass(frozen=True, eq=False)
class ConeSurface:
    """Cone about the z axis of its frame, with `radius` at its origin, widening along z; v is the slant."""

    frame: Frame
    radius: float
    half_angle: float


@dataclass(frozen=True, eq=False)
class BezierSurface:
    """Bezier surface of one span with `poles` (n + 1, m + 1, 3), parameters u in 0 ... 1 and v in `low` ... `high`."""

    poles: Floats
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class LineOnSurface:
    """Line in the parameters of a surface: from a point on, along a unit vector."""

    u: float
    v: float
    du: float
    dv: float


@dataclass(frozen=True, eq=False)
class BezierOnSurface:
    """Bezier curve in the parameters of a surface: one span with `poles` (n + 1, 2), parameter `first` ... `last`."""

    poles: Floats
    first: float = 0.0
    last: float = 1.0


CurveForm = StraightLine | CircleCurve | EllipseCurve | BezierCurve
SurfaceForm = PlaneSurface | CylinderSurface | ConeSurface | BezierSurface
OnSurface = LineOnSurface | BezierOnSurface


def vector(values: Sequence[float] | Floats) -> Vector:
    """Return three numbers as plain floats."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def unit(direction: Vector) -> Vector:
    """Return a direction as a vector of length 1."""
    x, y, z = direction
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def level_frame(z: float, *, up: bool = True, axis: Point = ORIGIN) -> Frame:
    """Return the frame at height z on an axis through the point (x, y), its x along +x and its z along +z or -z."""
    return Frame((axis[0], axis[1], z), (0.0, 0.0, 1.0 if up else -1.0), (1.0, 0.0, 0.0))


def level_circle(radius: float, z: float, axis: Point = ORIGIN) -> CircleCurve:
    """Return a circle at height z about an upright axis."""
    return CircleCurve(level_frame(z, axis=axis), radius)


def straight_line(start: Sequence[float], end: Sequence[float]) -> tuple[StraightLine, float]:
    """Return the line through two points, and the parameter (distance) of the second."""
    step = np.subtract(end, start)
    length = float(np.linalg.norm(step))
    return StraightLine(vector(start), vector(step / length)), length


def cylinder_along_z(radius: float, axis: Point = ORIGIN) -> CylinderSurface:
    """Return a cylinder about an upright axis, v = 0 at z = 0."""
    return CylinderSurface(level_frame(0.0, axis=axis), radius)


def cone_about_z(radius: float, sine: float, z: float, *, up: bool) -> ConeSurface:
    """Return a cone about the z axis with `radius` (mm) at height z (mm), widening upwards or downwards; `sine` of its half
    angle.
    """
    return ConeSurface(level_frame(z, up=up), radius, math.asin(sine))


def level_plane(z: float) -> PlaneSurface:
    """Return the plane at height z, its normal along +z."""
    return PlaneSurface(level_frame(z))


def upright_plane(start: Sequence[float], along: Sequence[float]) -> PlaneSurface:
    """Return the plane through a point that contains the horizontal direction `along` (x, y) and z; normal along x z."""
    length = math.hypot(*along)
    x, y = along[0] / length, along[1] / length
    return PlaneSurface(Frame(vector(start), (y, -x, 0.0), (x, y, 0.0)))


Chain = list[tuple[int, bool]]
"""Edges in order, each with True if it is run along its own direction."""

PRECISION = 1e-7
"""OpenCASCADE's own smallest distance (mm)."""


class Turn(NamedTuple):
    """A place: lifted by `z` (mm) and turned about the z axis by `angle` (rad)."""

    z: float
    angle: float


class BoundaryEdge(NamedTuple):
    """Edge on a curve in a place (its number), from the vertex `start` at the parameter `first` to `end` at `last`."""

    curve: CurveForm
    place: int
    start: int
    end: int
    first: float
    last: float


class BoundaryFace(NamedTuple):
    """Face on a surface in a place; its loops run counter-clockwise (holes clockwise) about the surface's own normal.

    That normal points out of the solid if `outward`.
    """

    surface: SurfaceForm
    place: int
    loops: tuple[Chain, ...]
    outward: bool


class LaidCurve(NamedTuple):
    """Curves of `edges` in the parameters of a surface, each edge in one of the `places`; two curves where an edge is a seam.

    A seam is an edge at which a closed surface meets itself.
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
    """Return a chain of edges run the other way."""
    return [(edge, not along) for edge, along in reversed(chain)]


class Recorder:
    """Recorder of the vertices, edges and faces of one solid (lengths in mm).

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
        """Return the boundary recorded so far."""
        return Boundary(self.tolerance, self._places, self._vertices, self._sources, self._edges, self._laid, self._faces)

    def moved(self, z: float, angle: float) -> Recorder:
        """Return a recorder of the same solid whose records stand higher by `z` (mm) and turned by `angle` (rad)."""
        moved = copy(self)
        moved.here = self._place(z, angle)
        return moved

    def turned(self, angle: float) -> int:
        """Return the place of a thing turned about z (rad)."""
        return self._place(0.0, angle)

    def _place(self, z: float, angle: float) -> int:
        here = self._places[self.here]
        self._places.append(Turn(here.z + z, here.angle + angle))
        return len(self._places) - 1

    def vertex(self, point: Sequence[float]) -> int:
        """Return a vertex at a point."""
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
        """Return an edge on a curve (in a place) from the vertex `start` at the parameter `first` to `end` at `last`."""
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
