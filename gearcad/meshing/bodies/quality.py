"""Quality of the elements of a mesh, and the size of the mesh and of its named sides."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, JsonObject, Wholes
from gearcad.meshing.bodies.element_mesh import ElementMesh
from gearcad.meshing.fem import Element, quadrature, scaled_jacobians, shape_slopes, shape_values

LEAST_SCALED_JACOBIAN = {
    Element.TRI6: 0.1,
    Element.QUAD8: 0.1,
    Element.HEX8: 0.05,
    Element.HEX20: 0.05,
    Element.TET10: 0.02,
}
"""Least scaled Jacobian of usable elements; below, an element is too distorted. Sections swept at 45 degrees lose half at the
tips of few teeth.
"""

LARGEST_ASPECT = 1e4
"""Largest aspect ratio of usable elements; above, an element is practically flat: a sliver, or over a land of some nanometres.
"""

_CHUNK = 1024
"""Elements that are looked at together: what that takes is small beside any mesh that fills memory."""

_NOTHING = 1e-300
"""Instead of a length or a volume of zero, so that an element without one can be measured."""

_NAMED_ELEMENTS = 5
"""Number of worst elements that a message names."""

_FACE_VERTICES = {"line3": 2, "tri6": 3, "quad4": 4, "quad8": 4}

_NO_PLACE = ("end_", "cut_")
"""Beginnings of names of sides that say little about a place: all over the body."""


@dataclass(frozen=True)
class WorstElement:
    """An element, its number from 0 and its scaled Jacobian, its middle (x, y, z) in mm, and the nearest named side."""

    number: int
    scaled_jacobian: float
    place: tuple[float, float, float]
    near: str

    def __str__(self) -> str:
        x, y, z = self.place
        near = f" near {self.near}" if self.near else ""
        return f"element {self.number + 1} at ({x:.4g}, {y:.4g}, {z:.4g}) mm{near}"

    def to_dict(self) -> JsonObject:
        """Return the element as an entry of mesh.json. Elements are counted from 1, as in files."""
        return {
            "element": self.number + 1,
            "scaled_jacobian": self.scaled_jacobian,
            "place": list(self.place),
            "near": self.near,
        }


@dataclass(frozen=True)
class Quality:
    """Quality of all elements of a mesh. The scaled Jacobian of an element is its least.

    The scaled Jacobian is the volume that three directions of the map span (the area of two), over the product of their
    lengths: 1 for a right-angled element and for an equilateral one of three or four vertices, 0 or less where it folds. Of
    elements of second order it is that of the curved map at all nodes and in the centre. Aspect is the longest over the
    shortest edge; `least_angle` (deg) that between two edges of a face. `worst` come first.
    """

    element: Element
    elements: int
    least_jacobian: float
    mean_jacobian: float
    largest_aspect: float
    mean_aspect: float
    least_angle: float
    worst: tuple[WorstElement, ...]

    def to_dict(self) -> JsonObject:
        """Return the quality as an entry of mesh.json."""
        return {
            "least_scaled_jacobian": self.least_jacobian,
            "mean_scaled_jacobian": self.mean_jacobian,
            "largest_aspect": self.largest_aspect,
            "mean_aspect": self.mean_aspect,
            "least_angle": self.least_angle,
            "worst": [each.to_dict() for each in self.worst],
        }


def quality(mesh: ElementMesh) -> Quality:
    """Measure all elements, some thousand at a time. Raises SolverError for a mesh without elements."""
    if not len(mesh.cells):
        raise SolverError("the mesh has no elements")
    least, aspects, largest, cosine = np.empty(len(mesh.cells)), 0.0, 0.0, -1.0
    for chosen, nodes in _chunks(mesh):
        least[chosen] = scaled_jacobians(mesh.element, nodes).min(axis=1)
        aspect, cosines = _of_edges(mesh.element, nodes)
        aspects, largest, cosine = aspects + aspect.sum(), max(largest, aspect.max()), max(cosine, cosines.max())
    return Quality(
        element=mesh.element,
        elements=len(least),
        least_jacobian=float(least.min()),
        mean_jacobian=float(least.mean()),
        largest_aspect=float(largest),
        mean_aspect=float(aspects / len(least)),
        least_angle=math.degrees(math.acos(min(cosine, 1.0))),
        worst=_worst(mesh, least),
    )


def require_good(measured: Quality, least: float | None = None) -> None:
    """Raise SolverError for a mesh with a scaled Jacobian below the gate of its kind of element, or another, with the place of
    the worst element, or with an element that is as good as flat.
    """
    gate = LEAST_SCALED_JACOBIAN[measured.element] if least is None else least
    if not measured.least_jacobian >= gate:
        worst = measured.worst[0]
        raise SolverError(
            f"the mesh is too distorted: least scaled Jacobian {worst.scaled_jacobian:.3f}, must be at least {gate}; {worst}"
        )
    if not measured.largest_aspect <= LARGEST_ASPECT:
        raise SolverError(
            f"the mesh is too distorted: an edge is {measured.largest_aspect:.3g} times as long as another of its element, "
            f"must be at most {LARGEST_ASPECT:.0f}: some land or fillet of the gear is extremely narrow"
        )


def _chunks(mesh: ElementMesh) -> Iterator[tuple[slice, Floats]]:
    """Yield the elements chunk by chunk, with the coordinates (m, nodes, dimension) of their nodes."""
    dimension = mesh.element.shape.dimension
    for start in range(0, len(mesh.cells), _CHUNK):
        chosen = slice(start, start + _CHUNK)
        yield chosen, mesh.points[mesh.cells[chosen], :dimension]


# ---------------------------------------------------------------------- edges and angles


def _of_edges(element: Element, nodes: Floats) -> tuple[Floats, Floats]:
    """Return two arrays (m,) for elements with nodes at (m, nodes, dimension).

    These are longest over shortest edge, and the greatest cosine between two edges.
    """
    edges = np.array(element.shape.edges)
    vectors = nodes[:, edges[:, 1]] - nodes[:, edges[:, 0]]
    lengths = np.maximum(np.sqrt((vectors**2).sum(axis=-1)), _NOTHING)
    units = vectors / lengths[..., None]
    first, second, sign = _corners(element)
    cosines = sign * np.einsum("mca,mca->mc", units[:, first], units[:, second])
    return lengths.max(axis=1) / lengths.min(axis=1), cosines.max(axis=1)


@cache
def _corners(element: Element) -> tuple[Wholes, Wholes, Floats]:
    """Return the edges that meet at the corners of faces, (n,) and (n,), and -1 where one of them ends there and the other
    begins.
    """
    shape = element.shape
    faces = [range(shape.vertices)] if shape.dimension == 2 else [face[: _FACE_VERTICES[shape.face]] for face in shape.faces]
    ends = np.array(shape.edges)
    meeting = set[tuple[int, int]]()
    for face in faces:
        around = np.flatnonzero(np.isin(ends, face).all(axis=1)).tolist()
        meeting |= {(a, b) for a, b in combinations(around, 2) if np.isin(ends[a], ends[b]).any()}
    first, second = np.array(sorted(meeting)).T
    sign = np.where((ends[first] == ends[second]).any(axis=1), 1.0, -1.0)
    return first, second, sign


# ---------------------------------------------------------------------- the worst


def _worst(mesh: ElementMesh, least: Floats) -> tuple[WorstElement, ...]:
    """Return the elements with the least scaled Jacobians, the worst first."""
    few = np.argpartition(least, min(_NAMED_ELEMENTS, len(least) - 1))[:_NAMED_ELEMENTS]
    few = few[np.argsort(least[few], kind="stable")]
    places = mesh.points[mesh.cells[few, : mesh.element.shape.vertices]].mean(axis=1)
    near = _nearest_sides(mesh, places)
    return tuple(
        WorstElement(int(number), float(least[number]), (float(x), float(y), float(z)), name)
        for number, (x, y, z), name in zip(few, places, near, strict=True)
    )


def _nearest_sides(mesh: ElementMesh, places: Floats) -> list[str]:
    """Return the named sides, if there are any, with the faces nearest to places (n, 3)."""
    names, distances = [""], [np.full(len(places), np.inf)]
    vertices = _FACE_VERTICES[mesh.element.shape.face]
    for name, faces in mesh.sides.items():
        if not any(part in name for part in _NO_PLACE) and len(faces):
            middles = mesh.points[mesh.face_cells(name)[:, :vertices]].mean(axis=1)
            names.append(name)
            distances.append(np.array([((middles - place) ** 2).sum(axis=1).min() for place in places]))
    return [names[k] for k in np.argmin(distances, axis=0)]


_MEASURE_CHUNK = 100_000
"""Faces that are looked at together: what is kept of them meanwhile stays small beside the mesh."""

_ORDERS = {"line3": 5, "tri6": 4, "quad4": 5, "quad8": 5}
"""Orders of quadrature over faces: what a curved face of second order needs."""


class Measure(NamedTuple):
    """Length (mm) or area (mm²) of a side; its outward area as a vector (3,), and the integrals (3,) of x n_x, y n_y and z n_z
    over it (mm² or mm³).
    """

    size: float
    outward: Floats
    moments: Floats

    @property
    def enclosed(self) -> float:
        """The integral of x·n (mm² or mm³)."""
        return float(self.moments.sum())


def together(measures: Iterable[Measure]) -> Measure:
    """Return the measure of sides together."""
    size, outward, moments = 0.0, np.zeros(3), np.zeros(3)
    for each in measures:
        size, outward, moments = size + each.size, outward + each.outward, moments + each.moments
    return Measure(size, outward, moments)


def openness(whole: Measure, dimension: int) -> float:
    """0 if these are all sides of a body, each once: their outward areas add up to nothing, and it is as large by x as by y
    and z. What is missing of one or the other, in shares of the surface and of the body.
    """
    size = whole.moments[:dimension]
    return max(float(np.linalg.norm(whole.outward)) / whole.size, float(np.ptp(size)) / abs(float(size.mean())))


def measure_side(mesh: ElementMesh, name: str) -> Measure:
    """Return the measure of a named side."""
    nodes, face = mesh.face_cells(name), mesh.element.shape.face
    parts = [
        _measure(mesh.points[nodes[start : start + _MEASURE_CHUNK]], face) for start in range(0, len(nodes), _MEASURE_CHUNK)
    ]
    return together(parts)


def measure_whole(mesh: ElementMesh) -> float:
    """Return the area (mm²) of a section or volume (mm³) of a body, by the theorem of Gauss: its named sides are all of its
    surface.
    """
    return sum(measure_side(mesh, name).enclosed for name in mesh.sides) / mesh.element.shape.dimension


def _measure(places: Floats, face: str) -> Measure:
    """Return the measure of faces together, with nodes at `places` (n, nodes, 3)."""
    local, weights = quadrature(face, _ORDERS[face])
    size, outward, moments = 0.0, np.zeros(3), np.zeros(3)
    for values, slopes, weight in zip(shape_values(face, local), shape_slopes(face, local), weights, strict=True):
        at, along = np.einsum("a,nac->nc", values, places), np.einsum("da,nac->dnc", slopes, places)
        normal = np.cross(along[0], along[1] if len(along) == 2 else [0.0, 0.0, 1.0])
        size += weight * float(np.linalg.norm(normal, axis=-1).sum())
        outward += weight * normal.sum(axis=0)
        moments += weight * (at * normal).sum(axis=0)
    return Measure(size, outward, moments)
