"""The ends of external teeth as triangles: plane face, cone of the end chamfer, down to the ring that the body joins.

A tooth is covered by strips between levels: pairs of profile points of equal radius. A level that lies on the cone, or
that must stand clear of something below, is an arc with points on a fixed set of angles, so that the strips run along
the generators of the cone and never fold; any other level is the straight line between its two profile points.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats, Wholes, distinct
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.tooth_end import Cap, GearEnd, ToothEnd, points_at
from gearcad.solids.facets.zipper import Chain, zip_levels

__all__ = ["cap_teeth"]


_CLEAR = 0.01
"""A level has no point of its own nearer to its ends than this share of the step."""


def cap_teeth(grid: ToothGrid, end: GearEnd, next_vertex: int) -> Cap:
    """Cover the teeth on one end; new vertices are numbered from `next_vertex`."""
    return _Capper(grid, end, next_vertex).cap()


class _Capper(ToothEnd):
    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int) -> None:
        super().__init__(grid, end, next_vertex)
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
        vertices, faces, around = self.own_vertices(), self.numbers(tooth), self.numbers(ring).ravel()
        if grid.cone.face_radius < grid.radius[0]:
            return self._down_the_cone(vertices, faces.reshape(-1, 3), around, angle)
        return Cap(vertices, faces.reshape(-1, 3), around, angle)

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
            fixed = self.turn[tip] + distinct(np.concatenate([right[tip] - beyond, land, left[tip] + beyond]))
        else:
            fixed = self.turn[0] + np.linspace(right[0], left[0], math.ceil(foot / min(most, foot)) + 1)
        straight = foot <= most
        arcs = []
        for i in range(tip):
            straight = straight or (i > 0 and radius[i] * math.cos((left[i] - right[i]) / 2) > radius[i - 1])
            arcs.append(fixed if i >= first_on_cone or not straight else nothing)
        return arcs

    def _level(self, i: int) -> Chain:
        if i == self.grid.flank_steps:
            return self.tip()
        right, left = self.span(i)
        clear = _CLEAR * self.end.step
        fixed = self.arcs[i]
        return self.chain(i, fixed[(fixed > right + clear) & (fixed < left - clear)].tolist())

    def _down_the_cone(self, vertices: Floats, faces: Wholes, ring: Wholes, angle: Floats) -> Cap:
        """The cone reaches below the teeth: go on along its generators to the circle where it meets the end plane."""
        circle = points_at(np.array(self.grid.cone.face_radius), angle, np.array(self.end_plane))
        inner = self.next_vertex + len(vertices) + np.arange(len(ring))
        outer_next, inner_next = np.roll(ring, -1), np.roll(inner, -1)
        strip = np.concatenate([np.stack([inner, ring, outer_next], -1), np.stack([inner, outer_next, inner_next], -1)])
        return Cap(np.concatenate([vertices, circle]), np.concatenate([faces, strip]), inner, angle)
