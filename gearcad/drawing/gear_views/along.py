"""Along: where points of a gear's half section are on paper. Lengths of the part and of paper in mm."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from gearcad.drawing.gear_views.meridian import Corner, overall
from gearcad.drawing.shapes import Line, Pen, Point
from gearcad.geometry import Gear

__all__ = ["Along"]


@dataclass(frozen=True)
class Along:
    """The axis is horizontal, at height 0 of the paper; the height `middle` of the gear is at the origin.

    `direction` is 1 where the gear's z goes to the right, -1 to the left. The keyway, on the gear's +x, is above the axis:
    one looks from +y where z goes to the right, from -y else.
    """

    scale: float
    middle: float
    direction: int = 1

    @classmethod
    def of(cls, gear: Gear, scale: float, direction: int = 1) -> Self:
        """The middle between the outermost end faces at the origin."""
        return cls(scale, sum(overall(gear)) / 2, direction)

    def across(self, height: float) -> float:
        """Where a height along the axis is, to the right of the origin."""
        return self.direction * self.scale * (height - self.middle)

    def point(self, height: float, radius: float) -> Point:
        """A point above the axis, below it if `radius` is negative."""
        return self.across(height), self.scale * radius

    def points(self, corners: Iterable[Corner]) -> list[Point]:
        return [self.point(*corner) for corner in corners]

    def line(self, start: Corner, end: Corner, pen: Pen = Pen.OUTLINE, *, beyond: float = 0.0) -> Line:
        """From one to another, so far (mm of paper) beyond both ends of a line along the axis."""
        (x, y), (right, top) = sorted((self.point(*start), self.point(*end)))
        return Line((x - beyond, y), (right + beyond, top), pen)
