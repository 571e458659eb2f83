"""Double helical gears of triangles: two halves that are open in the middle of the gap, or at the apex, and joined there."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.halves import halves
from gearcad.solids.facets.builder import Builder, wall
from gearcad.solids.facets.caps import cap_teeth
from gearcad.solids.facets.disc import DiscBuilder
from gearcad.solids.facets.sampling import ToothGrid, tooth_grid
from gearcad.solids.facets.zipper import middles, zip_rings

__all__ = ["double_facets"]


def double_facets(gear: Gear, chord_error: float) -> tuple[Floats, Wholes]:
    """Vertices (n, 3) in mm and faces (m, 3) of a double helical gear, within `chord_error` (mm) of the exact surface."""
    half = halves(gear)[0].gear
    grid = tooth_grid(half, chord_error, apex=not gear.double_helix.gap_width)
    pitch = 2 * math.pi / gear.tooth_count
    turned = replace(grid, layers=replace(grid.layers, start=pitch * gear.double_helix.offset))
    back, front = gear.body.hub_ends
    lower = _HalfBuilder(gear, half, grid, chord_error, back)
    upper = _HalfBuilder(gear, half, turned, chord_error, front)
    mirrored = np.concatenate(upper.vertices) * [1, 1, -1] + [0, 0, gear.face_width]
    numbers = lower.count + np.arange(upper.count)
    numbers[upper.open] = lower.open
    faces = np.concatenate([*lower.faces, numbers[np.concatenate(upper.faces)][:, ::-1]])
    vertices = np.concatenate([*lower.vertices, mirrored])
    used, again = np.unique(faces, return_inverse=True)
    return vertices[used], again.reshape(faces.shape)


class _HalfBuilder(DiscBuilder):
    """Builds the lower half, with a hub of a length (mm) below, up to the middle of the gear: `open` are vertices there."""

    def __init__(self, whole: Gear, half: Gear, grid: ToothGrid, chord_error: float, hub: float) -> None:
        Builder.__init__(self, half, grid, chord_error)
        middle = whole.face_width / 2
        self.faces.append(self.side())
        self.opening = self._opening(-hub, middle)
        self._end(top=False, hub=hub)
        rings = [self._gap(whole.gap_diameter / 2, middle)] if whole.double_helix.gap_width else [self._apex()]
        if self.opening is not None:
            rings.append(self.opening[2])
        self.open: Wholes = np.concatenate(rings)

    def _apex(self) -> Wholes:
        """The outline of all teeth in the middle."""
        around = self.grid.teeth * self.grid.period
        return self.grid.layers.count * around + np.arange(around)

    def _gap(self, radius: float, middle: float) -> Wholes:
        """The inner end of the teeth, and the ground of the gap (mm) up to the middle."""
        cap = cap_teeth(self.grid, self._tooth_end(radius, top=True), self.count)
        self.add(cap.vertices)
        circle, heights = self.circle(radius), (self.gear.face_width, middle)
        near, far = (self.add(np.column_stack([circle, np.full(len(circle), z)])) for z in heights)
        around = np.arctan2(circle[:, 1], circle[:, 0])
        self.faces += [cap.faces, zip_rings(near, middles(around), cap.ring, middles(cap.ring_angle)), wall(near, far)]
        return far
