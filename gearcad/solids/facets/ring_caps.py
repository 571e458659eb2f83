"""The ends of a ring's teeth as triangles: plane face, cone of the end chamfer, out to the chain that the body joins.

As on external teeth strips run between levels, but a ring's tooth grows outwards, and a straight line across it dips towards
the tip. So strips are tried from the tip on: straight, or as arcs of more and more chords until one is straight, on the cone as
arcs with points on its generators; the first whose triangles all face upwards is taken. Where none does, the fillets have
turned along the root circle. There strips end, and what is left of the fillets and the root lands between them make the chain.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes, distinct
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.tooth_end import Cap, GearEnd, ToothEnd, points_at
from gearcad.solids.facets.zipper import Chain, upright, zip_levels

__all__ = ["cap_ring_teeth"]


_CLEAR = 0.01
"""A level on the cone has no point of its own nearer to its ends than this share of the step."""

_CHORDS = (1, 2, 4, 8, 16, 32)
"""Of an arc across a tooth."""


def cap_ring_teeth(grid: ToothGrid, end: GearEnd, next_vertex: int, least: float) -> Cap:
    """Cover the teeth on one end; new vertices are numbered from `next_vertex`. No triangle is lower than `least` (mm)."""
    return _RingCapper(grid, end, next_vertex, least).cap()


class _RingCapper(ToothEnd):
    def __init__(self, grid: ToothGrid, end: GearEnd, next_vertex: int, least: float) -> None:
        super().__init__(grid, end, next_vertex)
        self.least = least
        self.on_cone = self._generators()

    def cap(self) -> Cap:
        grid, pitch = self.grid, 2 * math.pi / self.grid.teeth
        faces, neck, (neck_angle, neck_number) = self._strips()
        below = range(neck)
        right, left = ([self.span(i)[side] for i in below] for side in (0, 1))
        angles = [*right, *neck_angle, *reversed(left)]
        space = np.linspace(angles[-1], angles[0] + pitch, grid.root_steps + 1)[1:-1]
        land = range(self.opposite(0) + 1, grid.period)
        stop = None if grid.root_steps else -1  # no root land: the next tooth begins where this one ends
        angle = np.array([*angles, *space][:stop], float)
        number = np.array([*below, *neck_number, *(self.opposite(i) for i in reversed(below)), *land][:stop], np.int64)
        level = np.array([*below, *(neck for _ in neck_number), *reversed(below), *(0 for _ in space)][:stop], np.int64)
        around = (angle + pitch * np.arange(grid.teeth)[:, None]).ravel()
        set_back = np.tile(grid.setback[level] > 0, grid.teeth)
        cap = Cap(self.own_vertices(), self.numbers(faces).reshape(-1, 3), self.numbers(number).ravel(), around)
        return self._up_the_cone(cap, set_back) if set_back.any() else cap

    # ------------------------------------------------------------------ strips

    def _strips(self) -> tuple[Wholes, int, Chain]:
        """Triangles of one tooth, and the outermost level to which they reach."""
        inner, faces = self.tip(), list[tuple[int, int, int]]()
        for level in reversed(range(self.grid.flank_steps)):
            before = len(self.own)
            for between in self._candidates(level, inner):
                outer = self.chain(level, between)
                strip = zip_levels(inner, outer)
                if self._faces_up(level, inner, outer, strip):
                    break
                del self.own[before:]
            else:
                return np.array(faces).reshape(-1, 3), level + 1, inner
            inner = outer
            faces += strip
        return np.array(faces).reshape(-1, 3), 0, inner

    def _candidates(self, level: int, inner: Chain) -> Iterator[list[float]]:
        """Angles of points between both ends of a level, outside the chain `inner`."""
        right, left = self.span(level)
        if self.on_cone is not None and level >= self.grid.face_level:
            clear = _CLEAR * self.end.step
            yield self.on_cone[(self.on_cone > right + clear) & (self.on_cone < left - clear)].tolist()
            return
        straight = len(inner[0]) == 2
        for chords in _CHORDS[:1] if straight else _CHORDS:
            yield np.linspace(right, left, chords + 1)[1:-1].tolist()

    def _generators(self) -> Floats | None:
        """Angles of the points on the cone: those of the tip land, parted if need be, and further ones by the step."""
        grid, tip, step = self.grid, self.grid.flank_steps, self.end.step
        if not grid.cone.present or grid.face_level == tip:
            return None
        right, left = self.span(tip)
        parts = max(1, math.ceil((left - right) / max(grid.tip_steps, 1) / step - 1e-9))
        land = np.linspace(right, left, parts * grid.tip_steps + 1)
        beyond = step * np.arange(1, math.ceil(2 * math.pi / step))
        return distinct(np.concatenate([right - beyond, land, left + beyond]))

    def _faces_up(self, level: int, inner: Chain, outer: Chain, strip: list[tuple[int, int, int]]) -> bool:
        radius = self.grid.radius
        places = {
            number: (r * math.cos(angle), r * math.sin(angle))
            for (angles, numbers), r in ((inner, radius[level + 1]), (outer, radius[level]))
            for angle, number in zip(angles, numbers, strict=True)
        }
        return upright(np.array([[places[number] for number in face] for face in strip]), self.least)

    # ------------------------------------------------------------------ the cone beyond the strips

    def _up_the_cone(self, cap: Cap, set_back: Bools) -> Cap:
        """Where the chain lies on the cone, go on along its generators to the circle where that meets the end plane."""
        count = int(set_back.sum())
        circle = points_at(np.array(self.grid.cone.face_radius), cap.ring_angle[set_back], np.array(self.end_plane))
        outer = cap.ring.copy()
        outer[set_back] = self.next_vertex + len(cap.vertices) + np.arange(count)
        following, beyond = np.roll(cap.ring, -1), np.roll(outer, -1)
        strip = np.concatenate(
            [
                np.stack([cap.ring, outer, beyond], -1)[set_back],
                np.stack([cap.ring, beyond, following], -1)[np.roll(set_back, -1)],
            ]
        )
        return Cap(np.concatenate([cap.vertices, circle]), np.concatenate([cap.faces, strip]), outer, cap.ring_angle)
