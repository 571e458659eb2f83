"""Closed contours on the end faces, and the round walls between two of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from gearcad.solids.exact.boundary import Chain, Recorder, backward
from gearcad.solids.exact.forms import ORIGIN, LineOnSurface, Point, cylinder_along_z, level_circle, straight_line

__all__ = ["Contour", "add_tube", "circle", "tube"]


@dataclass(frozen=True)
class Contour:
    """Edges of a closed contour at one height, counter-clockwise seen from +z, and the vertex each starts from."""

    edges: list[int]
    starts: list[int]

    def loop(self, *, along: bool) -> Chain:
        loop = [(edge, True) for edge in self.edges]
        return loop if along else backward(loop)


def circle(recorder: Recorder, radius: float, z: float, axis: Point = ORIGIN) -> Contour:
    """A circle about an axis through the point (x, y); it starts on the side of +x."""
    start = recorder.vertex((axis[0] + radius, axis[1], z))
    return Contour([recorder.edge(level_circle(radius, z, axis), start, start, 0.0, 2 * math.pi)], [start])


def tube(
    recorder: Recorder, radius: float, heights: tuple[float, float], axis: Point = ORIGIN, *, outward: bool
) -> list[Contour]:
    """Add a round wall about an axis from one height to the other; its circles at both."""
    low, high = (circle(recorder, radius, z, axis) for z in heights)
    add_tube(recorder, radius, low, high, heights, axis, outward=outward)
    return [low, high]


def add_tube(
    recorder: Recorder,
    radius: float,
    low: Contour,
    high: Contour,
    heights: Sequence[float],
    axis: Point = ORIGIN,
    *,
    outward: bool,
) -> None:
    """A full cylinder between two circles; its seam lies on the side of +x."""
    surface, x, y = cylinder_along_z(radius, axis), axis[0] + radius, axis[1]
    line, length = straight_line((x, y, heights[0]), (x, y, heights[1]))
    seam = recorder.edge(line, low.starts[0], high.starts[0], 0.0, length)
    recorder.lay(seam, surface, LineOnSurface(2 * math.pi, heights[0], 0, 1), LineOnSurface(0, heights[0], 0, 1))
    for ring, z in zip((low, high), heights, strict=True):
        recorder.lay(ring.edges[0], surface, LineOnSurface(0, z, 1, 0))
    loop = [(low.edges[0], True), (seam, True), (high.edges[0], False), (seam, False)]
    recorder.face(surface, [loop], outward=outward)
