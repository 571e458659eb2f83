"""One end of a tooth as levels: pairs of profile points of equal radius, and chains of points from flank to flank on each.

Within one tooth, profile points are numbered 0 ... period, and points added on its levels -1, -2, ...
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.zipper import Chain

__all__ = ["Cap", "GearEnd", "ToothEnd", "points_at"]


@dataclass(frozen=True)
class GearEnd:
    """One end of a gear: its side's `first_vertex` there, what lies inside the teeth (mm), and the `step` of arcs (rad)."""

    first_vertex: int
    top: bool
    inner_radius: float
    step: float


@dataclass(frozen=True)
class Cap:
    """Vertices (n, 3) added, faces (m, 3) as seen from outside at the top, and the ring on the end plane with its angles."""

    vertices: Floats
    faces: Wholes
    ring: Wholes
    ring_angle: Floats


class ToothEnd:
    """The levels of tooth 0 on one end; `own` are the points added, each on a level at an angle."""

    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int) -> None:
        self.grid, self.end, self.next_vertex = grid, end, next_vertex
        self.z = grid.layers.width - grid.setback if end.top else grid.setback
        self.turn = grid.layers.turn(self.z)
        right, left = (turns[-1 if end.top else 0] for turns in grid.turns)
        self.right, self.left = right - grid.half_angle, left + grid.half_angle
        self.own: list[tuple[int, float]] = []

    def opposite(self, level: int) -> int:
        """Number of the point on the left flank."""
        return 2 * self.grid.flank_steps + self.grid.tip_steps - level

    def span(self, level: int) -> tuple[float, float]:
        """Angles of the right and the left flank there."""
        return self.turn[level] + self.right[level], self.turn[level] + self.left[level]

    def tip(self) -> Chain:
        """Angles and numbers along the tip land."""
        level, (right, left) = self.grid.flank_steps, self.span(self.grid.flank_steps)
        return np.linspace(right, left, self.grid.tip_steps + 1).tolist(), list(range(level, self.opposite(level) + 1))

    def chain(self, level: int, between: Sequence[float]) -> Chain:
        """Angles and numbers along a level from the right flank to the left one; adds points at the angles `between`."""
        right, left = self.span(level)
        first = len(self.own)
        self.own += [(level, angle) for angle in between]
        return [right, *between, left], [level, *(-1 - first - j for j in range(len(between))), self.opposite(level)]

    # ------------------------------------------------------------------ all teeth

    def numbers(self, tooth: Wholes) -> Wholes:
        """Vertex numbers for all teeth (teeth, ...) of the numbers used within one."""
        grid = self.grid
        which = np.arange(grid.teeth).reshape(-1, *(1 for _ in tooth.shape))
        on_side = self.end.first_vertex + (which * grid.period + tooth) % (grid.teeth * grid.period)
        result: Wholes = np.where(tooth >= 0, on_side, self.next_vertex + which * len(self.own) - 1 - tooth)
        return result

    def own_vertices(self) -> Floats:
        """The points added on all teeth (n, 3)."""
        level = np.array([i for i, _ in self.own], int)
        angle = np.array([a for _, a in self.own]) + 2 * math.pi / self.grid.teeth * np.arange(self.grid.teeth)[:, None]
        return points_at(self.grid.radius[level], angle, self.z[level])

    @property
    def end_plane(self) -> float:
        """Height z (mm) of the end plane."""
        return self.grid.layers.width if self.end.top else 0.0


def points_at(radius: Floats, angle: Floats, z: Floats) -> Floats:
    """Points (n, 3) from polar coordinates, broadcast together."""
    return np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), z), -1).reshape(-1, 3)
