"""How good the triangles of a mesh are: their shape, and what the curved edges make of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["MeshQuality", "mesh_quality"]

Floats = NDArray[np.float64]

_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


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
    for s, t in _CORNERS:
        u = 1 - s - t
        along_s = np.array([1 - 4 * u, 4 * s - 1, 0, 4 * (u - s), 4 * t, -4 * t])
        along_t = np.array([1 - 4 * u, 0, 4 * t - 1, -4 * s, 4 * s, 4 * (u - t)])
        x, y = np.einsum("a,mac->cm", along_s, nodes), np.einsum("a,mac->cm", along_t, nodes)
        found.append(x[0] * y[1] - x[1] * y[0])
    return np.stack(found, -1)
