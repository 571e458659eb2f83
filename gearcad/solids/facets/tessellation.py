"""A gear as triangles, straight from the exact profile: structured, closed by construction, no more of them than needed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import GeometryError, ParameterError, require_number
from gearcad.geometry import Body, Gear
from gearcad.geometry.halves import refuse_halves
from gearcad.geometry.limits import at_least
from gearcad.solids.facets.caps import GearEnd, cap_teeth
from gearcad.solids.facets.sampling import ToothGrid, tooth_grid
from gearcad.solids.facets.tolerance import arc_step
from gearcad.solids.facets.zipper import keyway_order, middles, zip_rings
from gearcad.solids.keyway import keyway_half_angle

__all__ = ["Facets", "tessellate"]


_LEAST_CHORD_ERROR = 2e-7
"""Least chord error as a share of the tip diameter: mesh files hold float32, which steps by up to 6e-8 of it."""

_MOST_CHORD_ERROR = 0.01
"""Coarsest chord error in normal modules, so that small teeth keep their shape; a tenth of the thinnest wall."""

_LEAST_SIDES = 8
"""A bore keeps at least so many sides, however small it is."""


@dataclass(frozen=True)
class Facets:
    """A closed surface of triangles: `vertices` (n, 3) in mm, `faces` (m, 3), counter-clockwise from outside; read-only."""

    vertices: Floats
    faces: Wholes

    def __post_init__(self) -> None:
        self.vertices.flags.writeable = False
        self.faces.flags.writeable = False

    @property
    def volume(self) -> float:
        """Enclosed volume in mm³."""
        a, b, c = (self.vertices[self.faces[:, corner]] for corner in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


def tessellate(gear: Gear, chord_error: float = 0.005) -> Facets:
    """Triangles of the whole gear with its flanks as modified, nowhere more than `chord_error` (mm) from the exact surface.

    Teeth from z = 0 to the face width, hubs beyond. Errors above 0.01 m_n are made that, so that small teeth keep their
    shape. Raises ParameterError for a chord error that is not positive, or below what the float32 of mesh files resolves.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    refuse_halves(gear, "facets")
    if gear.internal:
        raise GeometryError("teeth", gear.teeth, "must be above 0: facets of internal gears are not made yet")
    least = _LEAST_CHORD_ERROR * gear.tip_diameter
    if chord_error < least:
        permitted = f"must be at least {at_least(least)} mm for a tip diameter of {gear.tip_diameter:.6g} mm (single precision)"
        raise ParameterError("chord_error", chord_error, permitted, "mm")
    error = min(chord_error, _MOST_CHORD_ERROR * gear.normal_module)
    grid = tooth_grid(gear, error)
    builder = _Builder(gear, grid, error)
    return Facets(np.concatenate(builder.vertices), np.concatenate(builder.faces))


class _Builder:
    """Collects the vertices and faces of one gear."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        self.gear, self.grid, self.chord_error = gear, grid, chord_error
        self.vertices: list[Floats] = []
        self.faces: list[Wholes] = []
        self.count = 0
        self._side()
        back, front = gear.body.hub_ends
        self.opening = self._opening(-back, gear.face_width + front)
        self._end(top=False)
        self._end(top=True)

    def add(self, points: Floats) -> Wholes:
        """Append points (n, 3); their vertex numbers."""
        self.vertices.append(points)
        self.count += len(points)
        return np.arange(self.count - len(points), self.count)

    def _side(self) -> None:
        """The grid of all teeth: layers x teeth x period, every cell cut along its better diagonal."""
        grid, layers = self.grid, self.grid.layers
        radius, setback, angle = grid.outline
        z = layers.heights(setback)[:, None, :]
        turn = angle[:, None, :] + 2 * np.pi / grid.teeth * np.arange(grid.teeth)[:, None] + layers.kappa * z
        x, y, z = np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), z)
        numbers = self.add(np.stack([x, y, z], -1).reshape(-1, 3)).reshape(layers.count + 1, -1)
        a, d = numbers[:-1], numbers[1:]
        b, c = np.roll(a, -1, axis=1), np.roll(d, -1, axis=1)
        falling = np.tile(grid.falling_cells, grid.teeth)
        first = np.stack([a, b, np.where(falling, d, c)], -1)
        second = np.stack([np.where(falling, b, a), c, d], -1)
        self.faces.append(np.stack([first, second], -2).reshape(-1, 3))

    def _opening(self, bottom: float, top: float) -> tuple[Floats, Wholes, Wholes] | None:
        """Wall of bore and keyway; angles of its points, and their numbers at the bottom and at the top."""
        body = self.gear.body
        if not body.bore:
            return None
        loop = self._circle(body.bore / 2)
        if body.keyway_width:
            loop = _keyed_bore(body, 2 * np.pi / len(loop))
        low, high = (self.add(np.column_stack([loop, np.full(len(loop), z)])) for z in (bottom, top))
        self.faces.append(_wall(low, high)[:, ::-1])
        return np.arctan2(loop[:, 1], loop[:, 0]), low, high

    def _circle(self, radius: float) -> Floats:
        sides = max(_LEAST_SIDES, math.ceil(2 * math.pi / arc_step(radius, self.chord_error)))
        angle = -np.pi + 2 * np.pi / sides * np.arange(sides)
        return radius * np.column_stack([np.cos(angle), np.sin(angle)])

    def _end(self, *, top: bool) -> None:
        """End faces of teeth, cone, hub and bore. Built as seen from outside at the top, turned over at the bottom."""
        body, faces = self.gear.body, list[Wholes]()
        hub = body.hub_ends[top]
        z = self.gear.face_width if top else 0.0
        end = GearEnd(
            first_vertex=self.grid.layers.count * self.grid.teeth * self.grid.period if top else 0,
            top=top,
            inner_radius=(body.hub_diameter if hub else body.opening_diameter) / 2,
            step=arc_step(self.gear.tip_diameter / 2, self.chord_error),
        )
        cap = cap_teeth(self.grid, end, self.count)
        self.add(cap.vertices)
        faces.append(cap.faces)
        ring, angle = cap.ring, cap.ring_angle
        if hub:
            circle = self._circle(body.hub_diameter / 2)
            far = z + hub if top else z - hub
            near_ring, far_ring = (self.add(np.column_stack([circle, np.full(len(circle), level)])) for level in (z, far))
            around = np.arctan2(circle[:, 1], circle[:, 0])
            faces += [zip_rings(near_ring, middles(around), ring, middles(angle)), _wall(near_ring, far_ring)]
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


def _wall(low: Wholes, high: Wholes) -> Wholes:
    """Wall between two equal rings, facing away from the axis."""
    following, above = np.roll(low, -1), np.roll(high, -1)
    return np.concatenate([np.stack([low, following, above], -1), np.stack([low, above, high], -1)])


def _keyed_bore(body: Body, step: float) -> Floats:
    """Outline (2 h + 3, 2) of a bore with keyway, from the far side: h chords, wall, floor, wall, h chords."""
    radius, half_width, ends = body.bore / 2, body.keyway_width / 2, keyway_half_angle(body)
    angle = np.linspace(ends, np.pi, math.ceil((np.pi - ends) / step) + 1)
    upper = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    floor = [[radius + body.keyway_depth, -half_width], [radius + body.keyway_depth, half_width]]
    return np.concatenate([(upper * [1, -1])[::-1], floor, upper[:-1]])
