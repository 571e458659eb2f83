"""Triangles between two chains of points that run side by side: across a tooth, or once around the axis.

Chains are given by polar angle (rad) and vertex number, counter-clockwise seen from +z; so are the triangles. Always the
chain goes on whose next edge has its middle first, which keeps every triangle's corners within half an edge of each other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gearcad.arrays import Floats, Wholes

__all__ = ["Chain", "keyway_order", "middles", "upright", "zip_levels", "zip_rings"]

Chain = tuple[Sequence[float], Sequence[int]]

_TIE = 1e-12
"""Angle (rad) by which one edge is put before another that has the same middle."""


def zip_levels(lower: Chain, upper: Chain) -> list[tuple[int, int, int]]:
    """Triangles between two open chains, `lower` nearer to the axis."""
    (a, inner), (b, outer) = lower, upper
    i = j = 0
    faces = []
    while i < len(a) - 1 or j < len(b) - 1:
        if j == len(b) - 1 or (i < len(a) - 1 and a[i] + a[i + 1] <= b[j] + b[j + 1]):
            faces.append((inner[i + 1], inner[i], outer[j]))
            i += 1
        else:
            faces.append((outer[j], outer[j + 1], inner[i]))
            j += 1
    return faces


def upright(corners: Floats, least: float) -> bool:
    """Whether all triangles with corners (n, 3, 2) in mm run counter-clockwise and are nowhere lower than `least` (mm)."""
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    longest = np.hypot(*np.moveaxis(corners - np.roll(corners, 1, axis=1), -1, 0)).max(axis=1)
    return bool(np.all(area > least * longest))


def middles(angle: Floats) -> Floats:
    """Angle of the middle of every edge of a closed chain, in -pi ... pi."""
    middle = angle + 0.5 * np.mod(np.roll(angle, -1) - angle, 2 * np.pi)
    result: Floats = np.mod(middle + np.pi, 2 * np.pi) - np.pi
    return result


def keyway_order(order: Floats, wall: float, lower_wall: int, outer: Floats) -> Floats:
    """The order in which to zip the edges of a bore with keyway: their middles, `order`, with those of its walls moved.

    A wall runs radially, so its middle does not tell which outer points it faces: that must be one beyond the angle
    `wall` (rad) at which the bore ends. `lower_wall` is the number of that edge; the floor and the upper wall follow.
    `outer` are the angles of the points of the outer chain. The edges before and after keep their sequence.
    """
    points = np.sort(np.mod(outer + np.pi, 2 * np.pi) - np.pi)
    below = int(np.searchsorted(points, -wall, side="right"))
    above = int(np.searchsorted(points, wall, side="left"))
    first = 0.5 * (points[below - 1] + points[below]) - _TIE
    last = 0.5 * (points[above - 1] + points[above]) + _TIE
    result = np.clip(order, first, last)
    result[:lower_wall] = np.minimum(order[:lower_wall], first)
    result[lower_wall] = first
    result[lower_wall + 2] = last
    result[lower_wall + 3 :] = np.maximum(order[lower_wall + 3 :], last)
    return result


def zip_rings(inner: Wholes, inner_order: Floats, outer: Wholes, outer_order: Floats) -> Wholes:
    """Triangles (n, 3) between two closed chains around the axis, each zipped in the order of its edges' angles.

    Edge i runs from vertex i to vertex i + 1, and the last one back to the first; orders are in -pi ... pi.
    """
    inner, inner_order = _from_the_back(inner, inner_order)
    outer, outer_order = _from_the_back(outer, outer_order)
    opposite = np.searchsorted(outer_order, inner_order, side="left") % len(outer)
    facing = np.searchsorted(inner_order, outer_order, side="right") % len(inner)
    inside = np.stack([np.roll(inner, -1), inner, outer[opposite]], -1)
    outside = np.stack([outer, np.roll(outer, -1), inner[facing]], -1)
    return np.concatenate([inside, outside])


def _from_the_back(ring: Wholes, order: Floats) -> tuple[Wholes, Floats]:
    first = int(np.argmin(order))
    return np.roll(ring, -first), np.roll(order, -first)
