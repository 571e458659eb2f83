"""A wedge of shaft in the bore under one tooth sector: quadratic triangles on the nodes of its bore."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.sector import SectorMesh

__all__ = ["with_shaft"]


_HOLLOW = 0.03
"""Inner over outer diameter of what stands for a solid shaft: a wedge cannot end in a point."""

_LONGEST = 0.25
"""Longest edge along a radius, over the radius."""

_GROWTH = 1.3
"""An edge along a radius over the one outside it."""


def with_shaft(mesh: SectorMesh, shaft_bore: float) -> SectorMesh:
    """The sector and its share of a shaft with a bore of `shaft_bore` (mm), 0 for a solid one.

    The sector's nodes and triangles come first; its cuts go on through the shaft, and it is held in the shaft's bore.
    """
    arc = mesh.sides[Side.HELD]
    outer, angle = np.hypot(*mesh.points[arc[0]]), 2 * np.arctan2(*mesh.points[arc[0], ::-1])
    radii = _radii(float(outer), max(shaft_bore / 2, _HOLLOW * float(outer)), float(angle) / (len(arc) // 2))
    added = (radii[1:, None, None] / outer) * mesh.points[arc]
    numbers = np.concatenate([arc[None], len(mesh.points) + np.arange(added[..., 0].size).reshape(added.shape[:2])])
    sides = dict(mesh.sides)
    sides[Side.AHEAD] = np.r_[sides[Side.AHEAD], numbers[1:, 0]]
    sides[Side.BEHIND] = np.r_[numbers[:0:-1, -1], sides[Side.BEHIND]]
    sides[Side.HELD] = numbers[-1]
    return SectorMesh(np.r_[mesh.points, added.reshape(-1, 2)], np.r_[mesh.triangles, _triangles(numbers)], sides)


def _radii(outer: float, inner: float, angle: float) -> Floats:
    """Radii (mm) of the circles of nodes: edges as long as they are wide at first, `angle` (rad), then longer by and by."""
    ends = [outer]
    while ends[-1] > inner * (1 + angle / 2):
        ends.append(max(inner, ends[-1] * (1 - min(angle, _LONGEST))))
        angle *= _GROWTH
    ends[-1] = inner
    return np.interp(np.arange(2 * len(ends) - 1) / 2, np.arange(len(ends)), ends)


def _triangles(numbers: Wholes) -> Wholes:
    """Two quadratic triangles in every cell of a grid of nodes, whose rows go inwards and whose columns go clockwise."""

    def at(row: int, column: int) -> Wholes:
        rows, columns = numbers.shape
        return numbers[row : row + rows - 2 : 2, column : column + columns - 2 : 2].ravel()

    upper = (at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1))
    lower = (at(0, 0), at(2, 2), at(0, 2), at(1, 1), at(1, 2), at(0, 1))
    triangles: Wholes = np.r_[np.stack(upper, -1), np.stack(lower, -1)]
    return triangles
