"""Three thin lines for the direction of a ring's flanks, on the far side of its opening (ISO 2203), from the helix itself."""

from __future__ import annotations

import math

import numpy as np

from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.shapes import Figure, Pen, Point, Polyline
from gearcad.geometry.helix import section_turn

__all__ = ["flank_directions"]

_SPACING = 3.0
_LONGEST = 24.0
"""Distance between the lines, and length of one, mm of paper; less where there is no room."""

_SHARE = 0.7
"""Of the face width, that the lines take at most."""

_MIDDLE, _ROOM = -0.5, 0.7
"""Where the lines are, and the height that they take at most, over the tip radius."""


def flank_directions(ring: Meridian) -> Figure:
    """The lines of a helical ring; nothing of a spur ring.

    One looks at the far side: what a tooth there rises on paper is what its section turns about the axis, times the radius,
    to the other side than that of a tooth on the near side of an external gear.
    """
    gear = ring.gear
    if not gear.helix_angle:
        return Figure()
    room = _ROOM * ring.tip * ring.scale
    spacing = min(_SPACING, room / 6)
    tangent = abs(math.tan(math.radians(gear.helix_angle)))
    longest = min(_LONGEST * math.cos(math.atan(tangent)), (room - 2 * spacing) / tangent) / ring.scale
    middle = _MIDDLE * ring.tip * ring.scale
    row = _row(ring, min(longest, _SHARE * gear.face_width))
    return Figure(tuple(Polyline.straight([(x, y + middle + step * spacing) for x, y in row], Pen.THIN) for step in (-1, 0, 1)))


def _row(ring: Meridian, length: float) -> list[Point]:
    """A line on paper about mid face width, `length` (mm of the part) of the axis."""
    middle = ring.gear.face_width / 2
    heights = np.array([middle - length / 2, middle + length / 2])
    turned = section_turn(ring.gear, heights) * ring.reference
    rise = ring.direction * ring.scale * (turned - turned.mean())  # +x is up, and the far side is on -y where one is on +y
    return [(ring.point(z, 0.0)[0], float(y)) for z, y in zip(heights, rise, strict=True)]
