"""Silhouette: where the outline of a gear's half section ends, and its faces are. Lengths of paper in mm."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.drawing.gear_views.along import Along
from gearcad.drawing.gear_views.meridian import opening_radius, overall
from gearcad.drawing.shapes import Point
from gearcad.geometry import Gear
from gearcad.solids.cone import EndCone

__all__ = ["Silhouette"]


@dataclass(frozen=True)
class Silhouette:
    """The outline of a gear where `along` has it."""

    gear: Gear
    along: Along

    @property
    def tip(self) -> float:
        """Radius of the tips (mm of the part)."""
        return self.gear.tip_diameter / 2

    @property
    def corner(self) -> float:
        """Radius of the outermost corner of the teeth's end faces (mm of the part): less than that of the tips by a chamfer."""
        return min(self.tip, EndCone.of(self.gear).face_radius)

    @property
    def ends(self) -> tuple[float, float]:
        """Heights of the end faces of all at the left and at the right (mm of the part)."""
        low, high = overall(self.gear)
        return (low, high) if self.along.direction > 0 else (high, low)

    @property
    def tooth_ends(self) -> tuple[float, float]:
        """The same of the teeth."""
        width = self.gear.face_width
        return (0.0, width) if self.along.direction > 0 else (width, 0.0)

    @property
    def left(self) -> float:
        return self.along.across(self.ends[0])

    @property
    def right(self) -> float:
        return self.along.across(self.ends[1])

    @property
    def top(self) -> float:
        """As far as the lowest point is below the axis."""
        return self.along.scale * self.tip

    def end_face(self, height: float) -> tuple[Point, Point]:
        """The flat face of the body at one of the `ends`, above the axis, from the opening outwards."""
        body = self.gear.body
        on_hub = not 0.0 <= height <= self.gear.face_width
        outer = body.hub_diameter / 2 if on_hub else min(self.corner, self.gear.root_diameter / 2)
        return self.along.point(height, opening_radius(self.gear)), self.along.point(height, outer)
