"""Three thin lines for the direction of the flanks on the half that one sees from outside (ISO 2203), from the helix itself."""

from __future__ import annotations

import math

import numpy as np

from gearcad.drawing.gear_views.along import Along
from gearcad.drawing.shapes import Figure, Pen, Point, Polyline
from gearcad.geometry import Gear
from gearcad.geometry.helix import section_turn

__all__ = ["flank_directions"]

_SPACING = 3.0
_LONGEST = 24.0
"""Distance between the lines, and length of one, mm of paper; less where there is no room."""

_NEAREST, _FURTHEST = 0.1, 0.9
"""Between which parts of the reference radius the lines are, below the axis."""

_SHARE = 0.7
"""Of the width of the teeth of one hand, that the lines take at most."""


def flank_directions(gear: Gear, along: Along) -> Figure:
    """The lines of a helical gear, three V of a double helical one; nothing of a spur gear.

    A tooth on the side that one sees passes the height of the axis at mid face width: what it rises there on paper is what
    its section turns about the axis, times the radius.
    """
    if not gear.helix_angle:
        return Figure()
    radius = gear.reference_diameter / 2
    room = (_FURTHEST - _NEAREST) * radius * along.scale
    tangent, cosine = (function(math.radians(abs(gear.helix_angle))) for function in (math.tan, math.cos))
    spacing = min(_SPACING / cosine, room / 5)
    longest = min(_LONGEST * cosine, (room - 2 * spacing) / tangent) / along.scale
    middle = -(_FURTHEST + _NEAREST) / 2 * radius * along.scale
    rows = [_row(gear, along, heights) for heights in _heights(gear, min(longest, _SHARE * gear.half_width))]
    ups = [middle + step * spacing for step in (-1, 0, 1)]
    return Figure(tuple(Polyline.straight([(x, y + up) for x, y in row], Pen.THIN) for row in rows for up in ups))


def _heights(gear: Gear, length: float) -> list[tuple[float, ...]]:
    """Heights along the axis of the points of each line, `length` (mm) of it for each hand."""
    middle, half = gear.face_width / 2, gear.half_width
    if not gear.double_helix.present:
        return [(middle - length / 2, middle + length / 2)]
    if not gear.double_helix.gap_width:
        return [(middle - length, middle, middle + length)]
    return [(centre - length / 2, centre + length / 2) for centre in (half / 2, gear.face_width - half / 2)]


def _row(gear: Gear, along: Along, heights: tuple[float, ...]) -> list[Point]:
    """A line on paper, its middle at the height of the axis."""
    turned = section_turn(gear, np.array(heights)) * gear.reference_diameter / 2
    turned -= (turned.min() + turned.max()) / 2
    rise = -along.direction * along.scale * turned  # the keyway side, +x, is up, and one looks from +y or from -y
    return [(along.across(z), float(y)) for z, y in zip(heights, rise, strict=True)]
