"""External gears of triangles: end faces, cones, hubs, bore and keyway."""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry import Body, Gear
from gearcad.solids.facets.builder import Builder, wall
from gearcad.solids.facets.caps import cap_teeth
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.tolerance import arc_step
from gearcad.solids.facets.tooth_end import GearEnd
from gearcad.solids.facets.zipper import keyway_order, middles, zip_rings
from gearcad.solids.keyway import keyway_half_angle

__all__ = ["DiscBuilder"]


class DiscBuilder(Builder):
    """Builds an external gear."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        super().__init__(gear, grid, chord_error)
        self.faces.append(self.side())
        back, front = gear.body.hub_ends
        self.opening = self._opening(-back, gear.face_width + front)
        self._end(top=False, hub=back)
        self._end(top=True, hub=front)

    def _opening(self, bottom: float, top: float) -> tuple[Floats, Wholes, Wholes] | None:
        """Wall of bore and keyway; angles of its points, and their numbers at the bottom and at the top."""
        body = self.gear.body
        if not body.bore:
            return None
        loop = self.circle(body.bore / 2)
        if body.keyway_width:
            loop = _keyed_bore(body, 2 * np.pi / len(loop))
        low, high = (self.add(np.column_stack([loop, np.full(len(loop), z)])) for z in (bottom, top))
        self.faces.append(wall(low, high)[:, ::-1])
        return np.arctan2(loop[:, 1], loop[:, 0]), low, high

    def _tooth_end(self, inner_radius: float, *, top: bool) -> GearEnd:
        """One end of the teeth around something of a radius (mm)."""
        first = self.grid.layers.count * self.grid.teeth * self.grid.period if top else 0
        step = arc_step(self.gear.tip_diameter / 2, self.chord_error)
        return GearEnd(first_vertex=first, top=top, inner_radius=inner_radius, step=step)

    def _end(self, *, top: bool, hub: float) -> None:
        """End faces of teeth, cone, hub of a length (mm) and bore. Built as seen from outside at the top, turned over below."""
        body, faces = self.gear.body, list[Wholes]()
        z = self.gear.face_width if top else 0.0
        inner = (body.hub_diameter if hub else body.opening_diameter) / 2
        cap = cap_teeth(self.grid, self._tooth_end(inner, top=top), self.count)
        self.add(cap.vertices)
        faces.append(cap.faces)
        ring, angle = cap.ring, cap.ring_angle
        if hub:
            circle = self.circle(body.hub_diameter / 2)
            far = z + hub if top else z - hub
            near_ring, far_ring = (self.add(np.column_stack([circle, np.full(len(circle), level)])) for level in (z, far))
            around = np.arctan2(circle[:, 1], circle[:, 0])
            faces += [zip_rings(near_ring, middles(around), ring, middles(angle)), wall(near_ring, far_ring)]
            ring, angle, z = far_ring, around, far
        faces.append(self._centre(ring, angle, z, top=top))
        found = np.concatenate(faces)
        self.faces.append(found if top else found[:, ::-1])

    def _centre(self, ring: Wholes, angle: Floats, z: float, *, top: bool) -> Wholes:
        """From the innermost ring of an end to the bore, or to a point on the axis."""
        if self.opening is None:
            middle = self.add(np.array([[0.0, 0.0, z]]))
            return np.stack([np.repeat(middle, len(ring)), ring, np.roll(ring, -1)], -1)
        around, low, high = self.opening
        order, body = middles(around), self.gear.body
        if body.keyway_width:
            order = keyway_order(order, keyway_half_angle(body), (len(order) - 3) // 2, angle)
        return zip_rings(high if top else low, order, ring, middles(angle))


def _keyed_bore(body: Body, step: float) -> Floats:
    """Outline (2 h + 3, 2) of a bore with keyway, from the far side: h chords, wall, floor, wall, h chords."""
    radius, half_width, ends = body.bore / 2, body.keyway_width / 2, keyway_half_angle(body)
    angle = np.linspace(ends, np.pi, math.ceil((np.pi - ends) / step) + 1)
    upper = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    floor = [[radius + body.keyway_depth, -half_width], [radius + body.keyway_depth, half_width]]
    return np.concatenate([(upper * [1, -1])[::-1], floor, upper[:-1]])
