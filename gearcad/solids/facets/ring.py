"""Rings of triangles: toothed opening, end faces with their cones and bolt holes, rim."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import SolverError
from gearcad.geometry import Gear
from gearcad.solids.facets.builder import LEAST_SIDES, Builder, wall
from gearcad.solids.facets.plate import Plate, bolt_plate
from gearcad.solids.facets.ring_caps import cap_ring_teeth
from gearcad.solids.facets.sampling import ToothGrid
from gearcad.solids.facets.tolerance import arc_step, least_distance, outermost_radius
from gearcad.solids.facets.tooth_end import GearEnd
from gearcad.solids.facets.zipper import middles, upright, zip_rings
from gearcad.solids.rim import require_rim

__all__ = ["RingBuilder"]


_Made = TypeVar("_Made")

_PARTS = tuple(2**n for n in range(11))
"""Into how many parts the chords of a circle are parted, until no triangle between it and what it surrounds is folded."""


class _Loop(NamedTuple):
    """A closed chain on an end plane: vertex numbers, angles (rad), and points (n, 2) in mm."""

    numbers: Wholes
    angle: Floats
    points: Floats


class RingBuilder(Builder):
    """Builds a ring. Its ends are built as seen from outside at the top, the lower one turned over."""

    def __init__(self, gear: Gear, grid: ToothGrid, chord_error: float) -> None:
        super().__init__(gear, grid, chord_error)
        self.rim = require_rim(gear) / 2
        self.faces.append(self.side()[:, ::-1])
        self.ends = {top: self._teeth(top=top) for top in (False, True)}
        if gear.body.bolt_holes:
            self._add_plate(self._plate())
        circle = self._fitted(lambda parts: self.circle(self.rim, parts), lambda circle: circle)
        low, high = (self._surround(circle, top=top).numbers for top in (False, True))
        self.faces.append(wall(low, high))

    def _height(self, *, top: bool) -> float:
        return self.gear.face_width if top else 0.0

    def _add_faces(self, faces: Wholes, *, top: bool) -> None:
        self.faces.append(faces if top else faces[:, ::-1])

    def _teeth(self, *, top: bool) -> _Loop:
        """End faces of the teeth; the chain around them."""
        grid, gear = self.grid, self.gear
        first = grid.layers.count * grid.teeth * grid.period if top else 0
        end = GearEnd(first_vertex=first, top=top, inner_radius=0.0, step=arc_step(self._widest, self.chord_error))
        cap = cap_ring_teeth(grid, end, self.count, least_distance(gear, self.chord_error))
        self.add(cap.vertices)
        self._add_faces(cap.faces, top=top)
        return _Loop(cap.ring, cap.ring_angle, np.concatenate(self.vertices)[cap.ring, :2])

    @property
    def _widest(self) -> float:
        """Radius (mm) to which teeth and cones reach."""
        reach, cone = outermost_radius(self.gear), self.grid.cone
        return max(reach, cone.face_radius) if cone.present else reach

    # ------------------------------------------------------------------ circles

    def _fitted(self, made: Callable[[int], _Made], circle_of: Callable[[_Made], Floats]) -> _Made:
        """What is made of so many parts that no triangle is folded between its circle and what is inside on either end."""
        least = least_distance(self.gear, self.chord_error)
        for parts in _PARTS:
            found = made(parts)
            points = circle_of(found)
            angle = np.arctan2(points[:, 1], points[:, 0])
            if all(upright(np.concatenate([each.points, points])[_between(each, angle)], least) for each in self.ends.values()):
                return found
        raise SolverError(f"the end faces of this ring cannot be parted into triangles within {self.chord_error:g} mm")

    def _surround(self, circle: Floats, *, top: bool) -> _Loop:
        """Add a circle to an end, and the faces up to it, which is then what is to be surrounded."""
        inner = self.ends[top]
        numbers = self.add(np.column_stack([circle, np.full(len(circle), self._height(top=top))]))
        outer = _Loop(numbers, np.arctan2(circle[:, 1], circle[:, 0]), circle)
        faces = _between(inner, outer.angle)
        self._add_faces(np.concatenate([inner.numbers, numbers])[faces], top=top)
        self.ends[top] = outer
        return outer

    # ------------------------------------------------------------------ bolt holes

    def _plate(self) -> Plate:
        body = self.gear.body
        step = min(arc_step(body.bolt_diameter / 2, self.chord_error), 2 * math.pi / LEAST_SIDES)

        def plate(parts: int) -> Plate:
            return bolt_plate(body, self._widest, self.rim, step, parts)

        return self._fitted(plate, lambda found: found.circle)

    def _add_plate(self, plate: Plate) -> None:
        """Faces around the holes on both ends, and the walls of the holes."""
        walls = list[Wholes]()
        for top in (False, True):
            inner = self._surround(plate.circle, top=top)
            rest = plate.points[len(plate.circle) :]
            numbers = np.concatenate(
                [inner.numbers, self.add(np.column_stack([rest, np.full(len(rest), self._height(top=top))]))]
            )
            self._add_faces(numbers[plate.faces], top=top)
            outside = slice(len(plate.circle), 2 * len(plate.circle))
            self.ends[top] = _Loop(numbers[outside], inner.angle, plate.points[outside])
            walls.append(numbers[outside.stop :].reshape(plate.holes.shape[:2]))
        for low, high in zip(*walls, strict=True):
            self.faces.append(wall(low, high)[:, ::-1])


def _between(inner: _Loop, angle: Floats) -> Wholes:
    """Triangles between a chain and a circle around it with points at these angles; they number the chain's points first."""
    count = len(inner.angle)
    return zip_rings(np.arange(count), middles(inner.angle), count + np.arange(len(angle)), middles(angle))
