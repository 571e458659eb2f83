"""Stiffness of quadratic hexahedra with 20 nodes: shape functions and quadrature from scikit-fem, matrices all at once."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.material import Material
from gearcad.meshing.section.swept import SweptMesh, turned

__all__ = ["PLACES", "lame", "layer_matrices", "slopes_at", "stiffness_matrices"]


_CORNERS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
_MIDDLES = np.array([[0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5]])
PLACES = np.array(
    [
        *([x, y, z] for z in (0.0, 1.0) for x, y in (*_CORNERS, *_MIDDLES)),
        *([x, y, 0.5] for x, y in _CORNERS),
    ]
)
"""Our order of the nodes in the unit cube: lower face, upper face, half-way up."""

_ORDER = 5
"""Of quadrature: 3 x 3 x 3 points. Fewer leave hexahedra with zero-energy modes, more change nothing that shows."""


class _Quadrature(NamedTuple):
    slopes: Floats  # (points, 20, 3) of the shape functions
    weights: Floats


@cache
def _rule() -> _Quadrature:
    from skfem import ElementHexS2
    from skfem.quadrature import get_quadrature

    places, weights = get_quadrature(ElementHexS2.refdom, _ORDER)
    return _Quadrature(slopes_at(places), weights)


def slopes_at(places: Floats) -> Floats:
    """Slopes (n, 20, 3) of the shape functions at places (3, n) in the unit cube."""
    from skfem import ElementHexS2

    element = ElementHexS2()
    index = [int(np.argmin(np.abs(element.doflocs - place).sum(axis=1))) for place in PLACES]
    slopes: Floats = np.stack([element.lbasis(places, k)[1] for k in index])
    return slopes.transpose(2, 0, 1)


def lame(material: Material) -> tuple[float, float]:
    """lambda, mu (MPa)."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))


def stiffness_matrices(points: Floats, material: Material) -> Floats:
    """Matrices (m, 60, 60) in N/mm of hexahedra with nodes at `points` (m, 20, 3), dof 3 a + i."""
    rule, (first, second) = _rule(), lame(material)
    jacobian = np.einsum("qak,mai->mqik", rule.slopes, points)
    volume = np.linalg.det(jacobian) * rule.weights
    slopes = np.einsum("qak,mqki->mqai", rule.slopes, np.linalg.inv(jacobian), optimize=True)
    count = len(points)
    flat = slopes.reshape(count, len(rule.weights), 60)
    product = ((flat * volume[..., None]).transpose(0, 2, 1) @ flat).reshape(count, 20, 3, 20, 3)
    trace = np.einsum("maibi->mab", product)
    matrices = first * product + second * product.transpose(0, 1, 4, 3, 2)
    for axis in range(3):
        matrices[:, :, axis, :, axis] += second * trace
    result: Floats = matrices.reshape(count, 60, 60)
    return result


def layer_matrices(mesh: SweptMesh, quads: Wholes, layer: int, material: Material) -> Floats:
    """Matrices (m, 60, 60) of the hexahedra over section quadrangles (m, 8), in the axes that turn with the section."""
    thickness = float(mesh.planes[layer + 1] - mesh.planes[layer])
    levels = np.repeat([-0.5, 0.5, 0.0], [8, 8, 4]) * thickness
    flat = mesh.section.points[quads][:, [*range(8), *range(8), *range(4)]]
    angles = mesh.rate * levels
    places = turned(flat.reshape(-1, 2), np.tile(angles, len(quads))).reshape(len(quads), 20, 2)
    points = np.concatenate([places, np.broadcast_to(levels[:, None], (len(quads), 20, 1))], -1)
    turn = np.zeros((60, 60))
    cosine, sine = np.cos(angles), np.sin(angles)
    x = 3 * np.arange(20)
    turn[x, x], turn[x, x + 1], turn[x + 1, x], turn[x + 1, x + 1], turn[x + 2, x + 2] = cosine, -sine, sine, cosine, 1
    result: Floats = turn.T @ stiffness_matrices(points, material) @ turn
    return result
