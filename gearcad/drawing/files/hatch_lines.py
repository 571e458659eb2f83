"""The lines of a hatch within its edges. Lengths in mm of paper."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise

from gearcad.drawing.shapes import Point, Polyline, Vertex

__all__ = ["hatch_lines"]

_SHORTEST = 1e-6


def hatch_lines(edges: Iterable[Iterable[Vertex]], angle: float, spacing: float) -> Iterator[tuple[Point, Point]]:
    """Lines at an angle (degrees), one of them through the origin if it went so far, inside an odd number of closed edges.

    A line that passes a corner is inside one of its two sides only, so none is lost or goes astray there.
    """
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turned = [
        [(x * cosine + y * sine, (y * cosine - x * sine) / spacing) for x, y in Polyline(tuple(edge), closed=True).points]
        for edge in edges
    ]
    sides = [side for row in turned for side in pairwise(row)]
    crossings: dict[int, list[float]] = {}
    for (x, low), (far, high) in sides:
        for number in range(math.ceil(min(low, high)), math.ceil(max(low, high))):
            crossings.setdefault(number, []).append(x + (far - x) * (number - low) / (high - low))
    for number in sorted(crossings):
        row, up = sorted(crossings[number]), number * spacing
        for start, end in zip(row[::2], row[1::2], strict=True):
            if end - start > _SHORTEST:
                yield _turned(start, up, cosine, sine), _turned(end, up, cosine, sine)


def _turned(along: float, up: float, cosine: float, sine: float) -> Point:
    return along * cosine - up * sine, along * sine + up * cosine
