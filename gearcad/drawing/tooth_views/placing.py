"""Placing: where points of a tooth are on its detail, that of a gear on circles, that of a rack on lines.

A place is a height - a radius, or a height over a rack's reference line - and how far it is to the right of the middle of the
tooth: an angle in radians, or a length. Lengths of the part and of paper in mm; the reference line is at height 0 of the paper.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

from gearcad.drawing.shapes import Arc, Line, Pen, Point, Polyline
from gearcad.drawing.tooth_outline import tooth_outline
from gearcad.geometry import Gear, Rack
from gearcad.rating.rim import outer_diameter

__all__ = ["OnCircles", "OnLines", "Placing", "placing"]

_BODY = 0.5
"""How much of the body is shown below the roots, over the depth of the teeth."""

_WALL = 0.8
"""At most so much of what there is of it."""


class Placing(ABC):
    """Of a tooth at a scale."""

    def __init__(self, scale: float) -> None:
        self.scale = scale

    middle_of_space: float
    """How far the middles of both spaces are from that of the tooth."""

    root: float
    """Height of the root."""

    end: float
    """Height at which the view ends, within the body."""

    @abstractmethod
    def point(self, height: float, aside: float) -> Point:
        """A place on paper."""

    @abstractmethod
    def level(self, height: float, start: float, end: float, pen: Pen) -> Arc | Line:
        """A part of a circle or line from left to right."""

    @abstractmethod
    def further(self, aside: float, paper: float) -> float:
        """A place so much (mm of paper) further to the right on the reference line."""

    @abstractmethod
    def flank(self, height: float) -> float | None:
        """Where the flank on the right, or its fillet, is at a height; None below the root and above the tip."""

    @abstractmethod
    def outline(self) -> Polyline:
        """The tooth and half a space on both sides."""

    @property
    def limit(self) -> list[Point]:
        """Along the end of what is shown of the body, from the left end of the outline to the right one."""
        steps = [self.middle_of_space * step / 8 for step in range(-8, 9)]
        low = [self.point(self.end, aside) for aside in steps]
        return [self.point(self.root, steps[0]), *low, self.point(self.root, steps[-1])]


class OnCircles(Placing):
    """A tooth of a gear, its axis below it."""

    def __init__(self, gear: Gear, scale: float) -> None:
        super().__init__(scale)
        self._gear, self._profile = gear, gear.profile
        self._reference = gear.profile.reference_diameter / 2
        self.middle_of_space = math.pi / gear.tooth_count
        self.root = gear.profile.root_diameter / 2
        body = outer_diameter(gear) if gear.internal else gear.body.opening_diameter
        way = _WALL * (body / 2 - self.root)
        deep = _BODY * (self.root - gear.profile.tip_diameter / 2)
        self.end = self.root + min(way, deep, key=abs)

    def point(self, height: float, aside: float) -> Point:
        return self.scale * height * math.sin(aside), self.scale * (height * math.cos(aside) - self._reference)

    def level(self, height: float, start: float, end: float, pen: Pen) -> Arc:
        centre = 0.0, -self.scale * self._reference
        return Arc(centre, self.scale * height, 90 - math.degrees(end), 90 - math.degrees(start), pen)

    def further(self, aside: float, paper: float) -> float:
        return aside + paper / self.scale / self._reference

    def flank(self, height: float) -> float | None:
        low, high = sorted((self._profile.tip_diameter / 2, self.root))
        return math.radians(self._profile.half_angle(height)) if low <= height <= high else None

    def outline(self) -> Polyline:
        points = ((self.scale * x, self.scale * (y - self._reference), bulge) for x, y, bulge in tooth_outline(self._gear))
        return Polyline(tuple(points))


class OnLines(Placing):
    """A tooth of a rack."""

    def __init__(self, rack: Rack, scale: float) -> None:
        super().__init__(scale)
        self._rack = rack
        self.middle_of_space = rack.transverse_pitch / 2
        self.root = -rack.root_depth
        self.end = self.root - min(_BODY * (rack.root_depth + rack.tip_height), _WALL * (rack.height - rack.root_depth))

    def point(self, height: float, aside: float) -> Point:
        return self.scale * aside, self.scale * height

    def level(self, height: float, start: float, end: float, pen: Pen) -> Line:
        return Line(self.point(height, start), self.point(height, end), pen)

    def further(self, aside: float, paper: float) -> float:
        return aside + paper / self.scale

    def flank(self, height: float) -> float | None:
        return float(self._rack.profile.half_thickness(height)) if self.root <= height <= self._rack.tip_height else None

    def outline(self) -> Polyline:
        return Polyline(tuple((self.scale * x, self.scale * y, bulge) for x, y, bulge in tooth_outline(self._rack)))


def placing(gear: Gear | Rack, scale: float) -> Placing:
    """As its kind asks for."""
    return OnLines(gear, scale) if isinstance(gear, Rack) else OnCircles(gear, scale)
