"""Shape functions of quadratic edges and triangles, and their slopes."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats, Wholes

__all__ = ["GAUSS", "edge_shapes", "edge_slopes", "edges_of", "triangle_shapes", "triangle_slopes"]

GAUSS = 1 / np.sqrt(3)
"""Gauss's two places on an edge from -1 to 1: there strains of quadratic elements are most accurate."""


def edges_of(chain: Wholes) -> Wholes:
    """End, middle, end of each edge, (n, 3), of a chain of nodes end, middle, end, middle ... end."""
    return np.stack([chain[:-1:2], chain[1::2], chain[2::2]], -1)


def edge_shapes(s: Floats) -> Floats:
    """Values (n, 3) at places from -1 to 1 on an edge, of its end, middle and other end."""
    return np.stack([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2], -1)


def edge_slopes(s: Floats) -> Floats:
    """Their derivatives (n, 3)."""
    return np.stack([s - 0.5, -2 * s, s + 0.5], -1)


def triangle_shapes(local: Floats) -> Floats:
    """Values (n, 6) at points (n, 2) of a triangle's own coordinates: of its vertices, and of the nodes 0-1, 1-2, 2-0."""
    s, t = local.T
    r = 1 - s - t
    return np.stack([r * (2 * r - 1), s * (2 * s - 1), t * (2 * t - 1), 4 * r * s, 4 * s * t, 4 * t * r], -1)


def triangle_slopes(local: Floats) -> Floats:
    """Their derivatives (n, 6, 2)."""
    s, t = local.T
    r, zero = 1 - s - t, np.zeros_like(s)
    by_s = np.stack([1 - 4 * r, 4 * s - 1, zero, 4 * (r - s), 4 * t, -4 * t], -1)
    by_t = np.stack([1 - 4 * r, zero, 4 * t - 1, -4 * s, 4 * s, 4 * (r - t)], -1)
    return np.stack([by_s, by_t], -1)
