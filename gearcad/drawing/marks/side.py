"""Side: on which side of an outline a mark stands, and points by how far along an edge and outwards they are."""

from __future__ import annotations

from enum import Enum

from gearcad.drawing.shapes import Point

__all__ = ["Side"]


class Side(Enum):
    """Of a figure, and of an edge: where its outside is. The value is the way outwards."""

    LEFT = (-1.0, 0.0)
    RIGHT = (1.0, 0.0)
    ABOVE = (0.0, 1.0)
    BELOW = (0.0, -1.0)

    @property
    def is_upright(self) -> bool:
        """Whether edges with their outside here, and dimension lines here, are vertical."""
        return self in (Side.LEFT, Side.RIGHT)

    @property
    def outwards(self) -> float:
        """1 or -1: the sign of a step outwards."""
        return sum(self.value)

    def point(self, along: float, out: float) -> Point:
        """The point at `along` (x of horizontal edges, y of vertical ones) whose other coordinate is `out`."""
        return (out, along) if self.is_upright else (along, out)

    def along(self, point: Point) -> float:
        """x of horizontal edges, y of vertical ones."""
        return point[1] if self.is_upright else point[0]

    def out(self, point: Point) -> float:
        """y of horizontal edges, x of vertical ones."""
        return point[0] if self.is_upright else point[1]
