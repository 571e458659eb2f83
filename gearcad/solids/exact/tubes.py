"""Closed contours on the end faces, and the round walls between two of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from gearcad.solids.exact.kernel import ORIGIN, Edges, Kernel, Point, backward

__all__ = ["Contour", "add_tube", "circle", "tube"]


@dataclass(frozen=True)
class Contour:
    """Edges of a closed contour at one height, counter-clockwise seen from +z, and the vertex each starts from."""

    edges: list[Any]
    starts: list[Any]

    def loop(self, *, along: bool) -> Edges:
        loop = [(edge, True) for edge in self.edges]
        return loop if along else backward(loop)


def circle(kernel: Kernel, radius: float, z: float, axis: Point = ORIGIN) -> Contour:
    """A circle about an axis through the point (x, y); it starts on the side of +x."""
    start = kernel.vertex((axis[0] + radius, axis[1], z))
    return Contour([kernel.edge(kernel.circle(radius, z, axis), start, start, 0.0, 2 * math.pi)], [start])


def tube(kernel: Kernel, radius: float, heights: tuple[float, float], axis: Point = ORIGIN, *, outward: bool) -> list[Contour]:
    """Add a round wall about an axis from one height to the other; its circles at both."""
    low, high = (circle(kernel, radius, z, axis) for z in heights)
    add_tube(kernel, radius, low, high, heights, axis, outward=outward)
    return [low, high]


def add_tube(
    kernel: Kernel,
    radius: float,
    low: Contour,
    high: Contour,
    heights: Sequence[float],
    axis: Point = ORIGIN,
    *,
    outward: bool,
) -> None:
    """A full cylinder between two circles; its seam lies on the side of +x."""
    surface, x, y = kernel.cylinder(radius, axis), axis[0] + radius, axis[1]
    line, length = kernel.line((x, y, heights[0]), (x, y, heights[1]))
    seam = kernel.edge(line, low.starts[0], high.starts[0], 0.0, length)
    kernel.lay(seam, surface, kernel.line_2d(2 * math.pi, heights[0], 0, 1), kernel.line_2d(0, heights[0], 0, 1))
    for ring, z in zip((low, high), heights, strict=True):
        kernel.lay(ring.edges[0], surface, kernel.line_2d(0, z, 1, 0))
    loop = [(low.edges[0], True), (seam, True), (high.edges[0], False), (seam, False)]
    kernel.face(surface, [loop], outward=outward)
