"""Meridian: a ring as a section through its axis has it, and where that is on paper. Lengths of the part and of paper in mm."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from gearcad.drawing.shapes import Point
from gearcad.geometry import Gear
from gearcad.rating.rim import outer_diameter
from gearcad.solids.cone import EndCone

__all__ = ["Corner", "Meridian"]

Corner = tuple[float, float]
"""Height z and radius."""


@dataclass(frozen=True)
class Meridian:
    """The axis is horizontal, at height 0 of the paper, mid face width at the origin. All radii are magnitudes.

    `direction` is 1 where z goes to the right, -1 to the left. A bolt hole, on +x, is above the axis.
    """

    gear: Gear
    scale: float
    direction: int = 1

    def point(self, height: float, radius: float) -> Point:
        """Above the axis, below it if `radius` is negative."""
        return self.direction * self.scale * (height - self.gear.face_width / 2), self.scale * radius

    def points(self, corners: Iterable[Corner], side: int = 1) -> list[Point]:
        """Those above the axis, or (-1) their mirror images."""
        return [self.point(height, side * radius) for height, radius in corners]

    # ------------------------------------------------------------------ radii

    @property
    def tip(self) -> float:
        return self.gear.profile.tip_diameter / 2

    @property
    def root(self) -> float:
        return self.gear.profile.root_diameter / 2

    @property
    def reference(self) -> float:
        return self.gear.profile.reference_diameter / 2

    @cached_property
    def cone(self) -> EndCone:
        """Of the end chamfers."""
        return EndCone.of(self.gear)

    @property
    def corner(self) -> float:
        """Where the teeth's end faces begin: at the tips, or outside a chamfer."""
        return self.cone.face_radius if self.cone.present else self.tip

    @property
    def is_open(self) -> bool:
        """Whether nobody said where the ring ends."""
        return self.gear.body.rim_diameter is None

    @property
    def rim(self) -> float:
        """Where the ring ends, or the view does: there is then enough to carry the teeth, and the bolt holes."""
        holes = self.gear.body.bolt_circle + 2 * self.gear.body.bolt_diameter
        return max(outer_diameter(self.gear), holes if self.is_open else 0.0) / 2

    @property
    def holes(self) -> tuple[float, float] | None:
        """Least and greatest radius of bolt holes; None without any."""
        body = self.gear.body
        if not body.bolt_holes:
            return None
        return (body.bolt_circle - body.bolt_diameter) / 2, (body.bolt_circle + body.bolt_diameter) / 2

    # ------------------------------------------------------------------ outlines

    def along_teeth(self, radius: float) -> list[Corner]:
        """From z = 0 on along the teeth at a radius, and their end chamfers."""
        width, back = self.gear.face_width, float(self.cone.setback(radius))
        flat = [(back, radius), (width - back, radius)]
        return [(0.0, self.corner), *flat, (width, self.corner)] if back else flat

    @property
    def edges(self) -> list[Corner]:
        """Circles of the teeth that one sees behind the section, where they begin and end."""
        return list(dict.fromkeys(self.along_teeth(self.tip)))
