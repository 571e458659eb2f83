"""Shape functions of quadratic edges and triangles, and their slopes."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats, Wholes

__all__ = [
    "GAUSS",
    "TRIANGLE_PLACES",
    "TRIANGLE_WEIGHTS",
    "edge_shapes",
    "edge_slopes",
    "edges_of",
    "triangle_shapes",
    "triangle_slopes",
]

GAUSS = 1 / np.sqrt(3)
"""Gauss's two places on an edge from -1 to 1: there strains of quadratic elements are most accurate."""

_ROOT = np.sqrt(38 - 44 * np.sqrt(0.4))
_INNER, _OUTER = (8 - np.sqrt(10) + _ROOT) / 18, (8 - np.sqrt(10) - _ROOT) / 18
_SHARE = np.sqrt(213125 - 53320 * np.sqrt(10)) / 3720

TRIANGLE_PLACES = np.array([[s, t] for a in (_INNER, _OUTER) for s, t in ((a, a), (1 - 2 * a, a), (a, 1 - 2 * a))])
TRIANGLE_WEIGHTS = np.repeat([1 / 6 + _SHARE, 1 / 6 - _SHARE], 3)
"""Six places in a triangle, and their shares, that integrate polynomials of degree 4 (Strang and Fix 1973; Dunavant 1985)."""


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
