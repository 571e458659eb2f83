"""The blank of an external gear: end faces, hubs, and the bore with its keyway, on edges shared with the teeth."""

from __future__ import annotations

import math

from gearcad.geometry.gear import Gear
from gearcad.solids.exact.boundary import Chain, Recorder
from gearcad.solids.exact.forms import LineOnSurface, cylinder_along_z, level_circle, level_plane, straight_line, upright_plane
from gearcad.solids.exact.tubes import Contour, add_tube, circle, tube
from gearcad.solids.keyway import keyway_half_angle

__all__ = ["add_blank"]


def add_blank(gear: Gear, recorder: Recorder, lower: Chain, upper: Chain) -> None:
    """Add end faces, hubs and bore; `lower` and `upper` are the outer loops of the toothed part.

    Loops run counter-clockwise seen from +z.
    """
    body = gear.body
    back, front = body.hub_ends
    heights = (-back, gear.face_width + front)
    opening = [_opening(gear, recorder, z) for z in heights] if body.bore else None
    if opening:
        _add_opening(gear, recorder, opening[0], opening[1], heights)
    for which, (loop, hub) in enumerate(((lower, back), (upper, front))):
        face_z = gear.face_width * which
        hole = opening[which].loop(along=False) if opening else None
        if hub:
            low, high = sorted((face_z, heights[which]))
            rings = tube(recorder, body.hub_diameter / 2, (low, high), outward=True)
            inner, outer = (rings[1], rings[0]) if which == 0 else (rings[0], rings[1])
            recorder.face(level_plane(face_z), [loop, inner.loop(along=False)], outward=which == 1)
            loop = outer.loop(along=True)
        loops = [loop, hole] if hole else [loop]
        recorder.face(level_plane(heights[which]), loops, outward=which == 1)


def _keyway_corners(gear: Gear) -> list[tuple[float, float]]:
    """Bore meets upper wall, bore meets lower wall, lower and upper corner of the floor (mm)."""
    radius, half = gear.body.bore / 2, gear.body.keyway_width / 2
    wall = math.sqrt(radius**2 - half**2)
    floor = radius + gear.body.keyway_depth
    return [(wall, half), (wall, -half), (floor, -half), (floor, half)]


def _opening(gear: Gear, recorder: Recorder, z: float) -> Contour:
    """Contour of bore and keyway at height z: the arc of the bore, lower wall, floor, upper wall."""
    radius = gear.body.bore / 2
    if not gear.body.keyway_width:
        return circle(recorder, radius, z)
    corners = _keyway_corners(gear)
    starts = [recorder.vertex((x, y, z)) for x, y in corners]
    angle = keyway_half_angle(gear.body)
    edges = [recorder.edge(level_circle(radius, z), starts[0], starts[1], angle, 2 * math.pi - angle)]
    for k in (1, 2, 3):
        after = (k + 1) % 4
        line, length = straight_line((*corners[k], z), (*corners[after], z))
        edges.append(recorder.edge(line, starts[k], starts[after], 0.0, length))
    return Contour(edges, starts)


def _add_opening(gear: Gear, recorder: Recorder, low: Contour, high: Contour, heights: tuple[float, float]) -> None:
    """The wall of bore and keyway."""
    radius = gear.body.bore / 2
    if not gear.body.keyway_width:
        add_tube(recorder, radius, low, high, heights, outward=False)
        return
    corners = _keyway_corners(gear)
    angle = keyway_half_angle(gear.body)
    lines = [straight_line((*corner, heights[0]), (*corner, heights[1])) for corner in corners]
    uprights = [recorder.edge(line, low.starts[k], high.starts[k], 0.0, length) for k, (line, length) in enumerate(lines)]
    cylinder = cylinder_along_z(radius)
    recorder.lay(uprights[0], cylinder, LineOnSurface(angle, heights[0], 0, 1))
    recorder.lay(uprights[1], cylinder, LineOnSurface(2 * math.pi - angle, heights[0], 0, 1))
    for ring, z in zip((low, high), heights, strict=True):
        recorder.lay(ring.edges[0], cylinder, LineOnSurface(0, z, 1, 0))
    for k in range(4):
        after = (k + 1) % 4
        loop = [(low.edges[k], True), (uprights[after], True), (high.edges[k], False), (uprights[k], False)]
        (x0, y0), (x1, y1) = corners[k], corners[after]
        surface = upright_plane((x0, y0, heights[0]), (x1 - x0, y1 - y0)) if k else cylinder
        recorder.face(surface, [loop], outward=False)
