"""How large a mesh and its named sides are: lengths and areas of sections, areas and volumes of bodies."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.meshing.bodies.interpolation import shape_slopes, shape_values
from gearcad.meshing.bodies.mesh import ElementMesh

__all__ = ["Measure", "measure_side", "measure_whole"]


_CHUNK = 100_000
"""Faces that are looked at together: what is kept of them meanwhile stays small beside the mesh."""

_GAUSS = ((-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9))
"""Places and weights that are exact up to the fifth power: that is what a curved face of second order needs."""

_TRIANGLE = ((0.445948490915965, 0.223381589678011), (0.091576213509771, 0.109951743655322))
"""The coordinate that two vertices share, and the weight of each of the three places: exact up to the fourth power."""


class Measure(NamedTuple):
    """Length (mm) or area (mm²) of a side, and the integral of x·n over it (mm² or mm³)."""

    size: float
    enclosed: float


def measure_side(mesh: ElementMesh, name: str) -> Measure:
    """The measure of a named side."""
    nodes, face = mesh.face_cells(name), mesh.element.shape.face
    parts = [_measure(mesh.points[nodes[start : start + _CHUNK]], face) for start in range(0, len(nodes), _CHUNK)]
    return Measure(sum(part.size for part in parts), sum(part.enclosed for part in parts))


def measure_whole(mesh: ElementMesh) -> float:
    """Area (mm²) of a section or volume (mm³) of a body, by the theorem of Gauss: its named sides are all of its surface."""
    return sum(measure_side(mesh, name).enclosed for name in mesh.sides) / mesh.element.shape.dimension


def _measure(places: Floats, face: str) -> Measure:
    """Of faces together, with nodes at `places` (n, nodes, 3)."""
    local, weights = _quadrature(face)
    size = enclosed = 0.0
    for values, slopes, weight in zip(shape_values(face, local), shape_slopes(face, local), weights, strict=True):
        at, along = np.einsum("a,nac->nc", values, places), np.einsum("da,nac->dnc", slopes, places)
        normal = np.cross(along[0], along[1] if len(along) == 2 else [0.0, 0.0, 1.0])
        size += weight * float(np.linalg.norm(normal, axis=-1).sum())
        enclosed += weight * float((at * normal).sum())
    return Measure(size, enclosed)


@cache
def _quadrature(face: str) -> tuple[Floats, Floats]:
    """Places (n, 1 or 2) in a face's own coordinates, and their weights (n,)."""
    places, weights = zip(*(_of_triangles() if face == "tri6" else _of_products(1 if face == "line3" else 2)), strict=True)
    return np.array(places), np.array(weights)


def _of_products(dimension: int) -> Iterator[tuple[list[float], float]]:
    for each in product(_GAUSS, repeat=dimension):
        yield [place for place, _ in each], math.prod(weight for _, weight in each)


def _of_triangles() -> Iterator[tuple[list[float], float]]:
    for share, weight in _TRIANGLE:
        for place in ([share, share], [1 - 2 * share, share], [share, 1 - 2 * share]):
            yield place, weight / 2
