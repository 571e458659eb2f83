"""The bracket of a pair: two shafts through the bores, standing on one arm with round ends."""

from __future__ import annotations

import math

from gearcad.errors import GeometryError
from gearcad.geometry.gear import Gear
from gearcad.geometry.pair import GearPair
from gearcad.per_gear import PerGear
from gearcad.solids.exact.boundary import Boundary, Chain, Recorder
from gearcad.solids.exact.forms import (
    CircleCurve,
    CylinderSurface,
    Frame,
    LineOnSurface,
    level_plane,
    straight_line,
    upright_plane,
)
from gearcad.solids.exact.tubes import tube

__all__ = ["bracket_boundary"]

_ARM = 0.6
"""Half the width of the arm as a share of the thicker shaft's diameter."""

_TOLERANCE = 1e-7
"""Of edges and vertices (mm): planes, cylinders and circles are exact."""


def bracket_boundary(pair: GearPair) -> Boundary:
    """The bracket where the pair stands, its arm below the gears. Raises GeometryError for gears without bores."""
    gears, pose = pair.gears, pair.wheel_pose()
    bores, heights = gears.map(_bore), PerGear(0.0, pose.z)
    low = min(z - gear.body.hub_ends[0] for z, gear in zip(heights, gears, strict=True))
    high = max(z + gear.face_width + gear.body.hub_ends[1] for z, gear in zip(heights, gears, strict=True))
    thickest = max(bores)
    gap, thickness = 0.1 * thickest, 0.5 * thickest
    bottom = low - gap - thickness
    recorder = Recorder(_TOLERANCE / 2)
    under, over = _arm(recorder, pose.x, _ARM * thickest, (bottom, bottom + thickness))
    recorder.face(level_plane(bottom), [under], outward=False)
    feet: list[Chain] = []
    for x, bore in zip((0.0, pose.x), bores, strict=True):
        foot, head = tube(recorder, bore / 2, (bottom + thickness, high + gap), (x, 0.0), outward=True)
        feet.append(foot.loop(along=False))
        recorder.face(level_plane(high + gap), [head.loop(along=True)])
    recorder.face(level_plane(bottom + thickness), [over, *feet])
    return recorder.boundary()


def _bore(gear: Gear) -> float:
    if not gear.body.bore:
        raise GeometryError("body.bore", gear.body.bore, "must be above 0 mm for a shaft with a bracket", "mm")
    return gear.body.bore


def _arm(recorder: Recorder, length: float, radius: float, heights: tuple[float, float]) -> tuple[Chain, Chain]:
    """The sides of an arm from x = 0 to `length`, rounded about both; its contours, counter-clockwise seen from +z."""
    corners = [(0.0, -radius), (length, -radius), (length, radius), (0.0, radius)]
    rings = [[recorder.vertex((x, y, z)) for x, y in corners] for z in heights]
    rise = heights[1] - heights[0]
    uprights = [
        recorder.edge(straight_line((x, y, heights[0]), (x, y, heights[1]))[0], low, high, 0.0, rise)
        for (x, y), low, high in zip(corners, *rings, strict=True)
    ]
    contours: tuple[Chain, Chain] = ([], [])
    for k, (x, y) in enumerate(corners):
        after = (k + 1) % 4
        to_x, to_y = corners[after]
        ends = []
        surface = upright_plane((x, y, heights[0]), (to_x - x, 0.0)) if k % 2 == 0 else _round_end(x, y, radius)
        for contour, ring, z in zip(contours, rings, heights, strict=True):
            if isinstance(surface, CylinderSurface):
                circle = CircleCurve(surface.frame._replace(origin=(x, 0.0, z)), radius)
                edge = recorder.edge(circle, ring[k], ring[after], 0.0, math.pi)
                recorder.lay(edge, surface, LineOnSurface(0, z, 1, 0))
            else:
                line, reach = straight_line((x, y, z), (to_x, to_y, z))
                edge = recorder.edge(line, ring[k], ring[after], 0.0, reach)
            contour.append((edge, True))
            ends.append(edge)
        if isinstance(surface, CylinderSurface):
            recorder.lay(uprights[k], surface, LineOnSurface(0, heights[0], 0, 1))
            recorder.lay(uprights[after], surface, LineOnSurface(math.pi, heights[0], 0, 1))
        low, high = ends
        recorder.face(surface, [[(low, True), (uprights[after], True), (high, False), (uprights[k], False)]])
    return contours


def _round_end(x: float, y: float, radius: float) -> CylinderSurface:
    """The half cylinder that begins at a corner: u = 0 there."""
    return CylinderSurface(Frame((x, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, math.copysign(1.0, y), 0.0)), radius)
