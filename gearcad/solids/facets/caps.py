"""The ends of the teeth as triangles: plane face, cone of the end chamfer, down to the ring that the body joins.

A tooth is covered by strips between levels: pairs of profile points of equal radius. A level that lies on the cone, or
that must stand clear of something below, is an arc with points on a fixed set of angles, so that the strips run along
the generators of the cone and never fold; any other level is the straight line between its two profile points.
Within one tooth, profile points are numbered 0 ... period, and points added on its levels -1, -2, ...
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.zipper import Chain, zip_levels

__all__ = ["Cap", "GearEnd", "cap_teeth"]


_CLEAR = 0.01
"""A level has no point of its own nearer to its ends than this share of the step."""


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


def cap_teeth(grid: ToothGrid, end: GearEnd, next_vertex: int) -> Cap:
    """Cover the teeth on one end; new vertices are numbered from `next_vertex`."""
    return _Capper(grid, end, next_vertex).cap()


class _Capper:
    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int) -> None:
        self.grid, self.end, self.next_vertex = grid, end, next_vertex
        self.z = grid.layers.width - grid.setback if end.top else grid.setback
        self.turn = grid.layers.kappa * self.z
        right, left = (turns[-1 if end.top else 0] for turns in grid.turns)
        self.right, self.left = right - grid.half_angle, left + grid.half_angle
        self.own: list[tuple[int, float]] = []
        self.arcs = self._arc_angles()

    def cap(self) -> Cap:
        grid = self.grid
        levels = [self._level(i) for i in range(grid.flank_steps + 1)]
        tooth = np.array([face for low, high in pairwise(levels) for face in zip_levels(low, high)])
        foot_angle, foot = levels[0]
        land = np.arange(foot[-1] + 1, grid.period)
        pitch = 2 * math.pi / grid.teeth
        space = np.linspace(foot_angle[-1], foot_angle[0] + pitch, grid.root_steps + 1)[1:-1]
        start = None if grid.root_steps else -1  # no root land: the next tooth begins where this one ends
        ring = np.concatenate([np.array(foot[:start]), land]).astype(np.int64)
        angle = (np.concatenate([np.array(foot_angle[:start]), space]) + pitch * np.arange(grid.teeth)[:, None]).ravel()
        vertices, faces, around = self._own_vertices(), self._numbers(tooth), self._numbers(ring).ravel()
        if grid.cone.face_radius < grid.radius[0]:
            return self._down_the_cone(vertices, faces.reshape(-1, 3), around, angle)
        return Cap(vertices, faces.reshape(-1, 3), around, angle)

    # ------------------------------------------------------------------ levels

    def _arc_angles(self) -> list[Floats]:
        """For every level below the tip the angles at which it has points, if its ends leave room; none: a straight line."""
        grid = self.grid
        radius, right, left = grid.radius, self.right, self.left
        tip, nothing = grid.flank_steps, np.array([])
        first_on_cone = grid.face_level if grid.cone.present else tip
        foot = left[0] - right[0]
        gap = radius[0] - self.end.inner_radius
        most = math.sqrt(gap / radius[0]) if self.end.inner_radius else math.inf
        if first_on_cone < tip:
            land = np.linspace(right[tip], left[tip], grid.tip_steps + 1)
            beyond = self.end.step * np.arange(1, math.ceil(2 * math.pi / self.end.step))
            fixed = self.turn[tip] + np.unique(np.concatenate([right[tip] - beyond, land, left[tip] + beyond]))
        else:
            fixed = self.turn[0] + np.linspace(right[0], left[0], math.ceil(foot / min(most, foot)) + 1)
        straight = foot <= most
        arcs = []
        for i in range(tip):
            straight = straight or (i > 0 and radius[i] * math.cos((left[i] - right[i]) / 2) > radius[i - 1])
            arcs.append(fixed if i >= first_on_cone or not straight else nothing)
        return arcs

    def _level(self, i: int) -> Chain:
        """Angles and numbers along level i from the right flank to the left one; adds the level's own points."""
        grid = self.grid
        right, left = self.turn[i] + self.right[i], self.turn[i] + self.left[i]
        opposite = 2 * grid.flank_steps + grid.tip_steps - i
        if i == grid.flank_steps:
            return np.linspace(right, left, grid.tip_steps + 1).tolist(), list(range(i, opposite + 1))
        clear = _CLEAR * self.end.step
        fixed = self.arcs[i]
        between = fixed[(fixed > right + clear) & (fixed < left - clear)].tolist()
        first = len(self.own)
        self.own += [(i, angle) for angle in between]
        return [right, *between, left], [i, *(-1 - first - j for j in range(len(between))), opposite]

    # ------------------------------------------------------------------ all teeth

    def _numbers(self, tooth: Wholes) -> Wholes:
        """Vertex numbers for all teeth (teeth, ...) of the numbers used within one."""
        grid = self.grid
        which = np.arange(grid.teeth).reshape(-1, *(1 for _ in tooth.shape))
        on_side = self.end.first_vertex + (which * grid.period + tooth) % (grid.teeth * grid.period)
        result: Wholes = np.where(tooth >= 0, on_side, self.next_vertex + which * len(self.own) - 1 - tooth)
        return result

    def _own_vertices(self) -> Floats:
        level = np.array([i for i, _ in self.own], int)
        angle = np.array([a for _, a in self.own]) + 2 * math.pi / self.grid.teeth * np.arange(self.grid.teeth)[:, None]
        return _points(self.grid.radius[level], angle, self.z[level])

    def _down_the_cone(self, vertices: Floats, faces: Wholes, ring: Wholes, angle: Floats) -> Cap:
        """The cone reaches below the teeth: go on along its generators to the circle where it meets the end plane."""
        z = self.grid.layers.width if self.end.top else 0.0
        circle = _points(np.array(self.grid.cone.face_radius), angle, np.array(z))
        inner = self.next_vertex + len(vertices) + np.arange(len(ring))
        outer_next, inner_next = np.roll(ring, -1), np.roll(inner, -1)
        strip = np.concatenate([np.stack([inner, ring, outer_next], -1), np.stack([inner, outer_next, inner_next], -1)])
        return Cap(np.concatenate([vertices, circle]), np.concatenate([faces, strip]), inner, angle)


def _points(radius: Floats, angle: Floats, z: Floats) -> Floats:
    return np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), z), -1).reshape(-1, 3)
