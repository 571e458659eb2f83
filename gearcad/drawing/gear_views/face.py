"""The view of an external gear along its axis, the keyway up (ISO 2203)."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.drawing.gear_views.section import BEYOND_AXIS, chamfer_pen
from gearcad.drawing.marks import centre_cross
from gearcad.drawing.shapes import Circle, Figure, Pen, Polyline, Shape
from gearcad.geometry import Body, Gear
from gearcad.solids.cone import EndCone
from gearcad.solids.keyway import keyway_half_angle

__all__ = ["end_face", "opening"]


def end_face(gear: Gear, scale: float, *, front: bool = True) -> Figure:
    """Outlines and centre lines, the axis at the origin; the end that one sees is that at z = face width, or that at z = 0."""
    body, reach = gear.body, scale * gear.tip_diameter / 2 + BEYOND_AXIS
    hub = body.hub_ends[front]
    tip, chamfered = gear.tip_diameter / 2, EndCone.of(gear).face_radius
    pen = chamfer_pen(scale * (tip - chamfered))  # the radius is infinite where there is no chamfer
    seen = [tip, *([body.hub_diameter / 2] if hub else [])]
    shapes: list[Shape] = [
        *(Circle((0.0, 0.0), scale * chamfered, each) for each in (pen,) if each is not None),
        *(Circle((0.0, 0.0), scale * radius) for radius in seen),
        Circle((0.0, 0.0), scale * gear.reference_diameter / 2, Pen.CENTRE),
        *opening(body, scale),
        *centre_cross((0.0, 0.0), reach).shapes,
    ]
    return Figure(tuple(shapes))


def opening(body: Body, scale: float) -> Iterator[Shape]:
    """The bore as a circle, or with its keyway as one closed line."""
    if not body.keyway_width:
        if body.bore:
            yield Circle((0.0, 0.0), scale * body.bore / 2)
        return
    half, floor = scale * body.keyway_width / 2, scale * (body.bore / 2 + body.keyway_depth)
    angle = keyway_half_angle(body)
    wall = scale * body.bore / 2 * math.cos(angle)
    around = math.tan((2 * math.pi - 2 * angle) / 4)
    corners = ((-half, wall, around), (half, wall, 0.0), (half, floor, 0.0), (-half, floor, 0.0))
    yield Polyline(corners, closed=True)
