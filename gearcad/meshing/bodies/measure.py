"""How large a mesh and its named sides are: lengths and areas of sections, areas and volumes of bodies."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.meshing.bodies.interpolation import shape_slopes, shape_values
from gearcad.meshing.bodies.mesh import ElementMesh

__all__ = ["Measure", "measure_side", "measure_whole", "openness", "together"]


_CHUNK = 100_000
"""Faces that are looked at together: what is kept of them meanwhile stays small beside the mesh."""

_GAUSS = ((-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9))
"""Places and weights that are exact up to the fifth power: that is what a curved face of second order needs."""

_TRIANGLE = ((0.445948490915965, 0.223381589678011), (0.091576213509771, 0.109951743655322))
"""The coordinate that two vertices share, and the weight of each of the three places: exact up to the fourth power."""


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
    """The measure of sides together."""
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
    """The measure of a named side."""
    nodes, face = mesh.face_cells(name), mesh.element.shape.face
    parts = [_measure(mesh.points[nodes[start : start + _CHUNK]], face) for start in range(0, len(nodes), _CHUNK)]
    return together(parts)


def measure_whole(mesh: ElementMesh) -> float:
    """Area (mm²) of a section or volume (mm³) of a body, by the theorem of Gauss: its named sides are all of its surface."""
    return sum(measure_side(mesh, name).enclosed for name in mesh.sides) / mesh.element.shape.dimension


def _measure(places: Floats, face: str) -> Measure:
    """Of faces together, with nodes at `places` (n, nodes, 3)."""
    local, weights = _quadrature(face)
    size, outward, moments = 0.0, np.zeros(3), np.zeros(3)
    for values, slopes, weight in zip(shape_values(face, local), shape_slopes(face, local), weights, strict=True):
        at, along = np.einsum("a,nac->nc", values, places), np.einsum("da,nac->dnc", slopes, places)
        normal = np.cross(along[0], along[1] if len(along) == 2 else [0.0, 0.0, 1.0])
        size += weight * float(np.linalg.norm(normal, axis=-1).sum())
        outward += weight * normal.sum(axis=0)
        moments += weight * (at * normal).sum(axis=0)
    return Measure(size, outward, moments)


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
