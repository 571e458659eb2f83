"""How good the triangles and quadrangles of a mesh are: their shape, and what the curved edges make of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.meshing.section.shapes import triangle_slopes

__all__ = ["LEAST_SCALED_JACOBIAN", "MeshQuality", "mesh_quality", "scaled_jacobians"]


_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])

LEAST_SCALED_JACOBIAN = 0.1
"""Below it a quadrangle is too distorted to be used: its sharpest corner has 6 degrees."""


@dataclass(frozen=True)
class MeshQuality:
    """`least_angle` (deg); gamma, twice the radius of the inner circle over the outer's, 1 for an equilateral triangle.

    `least_jacobian` is the smallest ratio of an element's Jacobian at a vertex to that of the straight triangle: 1 for
    straight edges, 0 or less where a curved edge folds the element.
    """

    triangles: int
    least_angle: float
    least_gamma: float
    mean_gamma: float
    least_jacobian: float


def mesh_quality(points: Floats, triangles: NDArray[np.int64]) -> MeshQuality:
    """The quality of quadratic triangles (m, 6) with nodes at `points` (n, 2)."""
    corners = points[triangles[:, :3]]
    sides = np.linalg.norm(corners[:, [1, 2, 0]] - corners[:, [2, 0, 1]], axis=-1)  # side k faces corner k
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    twice_area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    a, b, c = sides.T
    gamma = 4 * twice_area**2 / ((a + b + c) * a * b * c)  # 2 r/R with r = A/s and R = a b c/(4 A)
    squares = sides**2
    cosines = (squares.sum(axis=1)[:, None] - 2 * squares) / (2 * a * b * c)[:, None] * sides
    jacobian = _jacobians(points[triangles]) / twice_area[:, None]
    return MeshQuality(
        triangles=len(triangles),
        least_angle=float(np.degrees(np.arccos(np.clip(cosines, -1, 1))).min()),
        least_gamma=float(gamma.min()),
        mean_gamma=float(gamma.mean()),
        least_jacobian=float(jacobian.min()),
    )


def _jacobians(nodes: Floats) -> Floats:
    """Determinant of the quadratic map at the three corners of each element (m, 6, 2)."""
    found = []
    for slopes in triangle_slopes(_CORNERS):
        along_s, along_t = np.ascontiguousarray(slopes.T)
        x, y = np.einsum("a,mac->cm", along_s, nodes), np.einsum("a,mac->cm", along_t, nodes)
        found.append(x[0] * y[1] - x[1] * y[0])
    return np.stack(found, -1)


_QUAD_PLACES = np.array([[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)])
"""Corners, middles of edges and centre of a quadrangle."""

_QUAD_NODES = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], float)


def scaled_jacobians(nodes: Floats) -> Floats:
    """Least scaled Jacobian (m,) of quadratic quadrangles with nodes at `nodes` (m, 8, 2).

    The sine of the angle between the two directions of the map, at corners, middles and centre: 1 for a rectangle, 0 or less
    where an element folds.
    """
    slopes = np.stack([_serendipity_slopes(*place) for place in _QUAD_PLACES])
    first, second = np.einsum("pka,mac->kmpc", slopes, nodes)
    area = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    result: Floats = (area / np.linalg.norm(first, axis=-1) / np.linalg.norm(second, axis=-1)).min(axis=1)
    return result


def _serendipity_slopes(x: float, y: float) -> Floats:
    """Slopes (2, 8) of the shape functions at a place."""
    a, b = _QUAD_NODES.T
    corner = a * b != 0
    by_x = np.where(corner, a * (1 + b * y) * (2 * a * x + b * y) / 4, np.where(a == 0, -x * (1 + b * y), a * (1 - y * y) / 2))
    by_y = np.where(corner, b * (1 + a * x) * (a * x + 2 * b * y) / 4, np.where(b == 0, -y * (1 + a * x), b * (1 - x * x) / 2))
    return np.stack([by_x, by_y])
