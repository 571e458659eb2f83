"""The exact outline of a rack's teeth between two places along it. Lengths in mm of the part."""

from __future__ import annotations

import math
from itertools import pairwise

from gearcad.drawing.shapes import Vertex
from gearcad.drawing.tooth_outline import tooth_outline
from gearcad.geometry import Rack

__all__ = ["teeth_between"]

_NOTHING = 1e-9


def teeth_between(rack: Rack, low: float, high: float, middle: float) -> tuple[Vertex, ...]:
    """From left to right, cut off at both places; `middle` is that of any tooth."""
    pitch, tooth = rack.transverse_pitch, tooth_outline(rack)
    first, last = (math.floor((place - middle) / pitch + 0.5) for place in (low, high))
    row: list[Vertex] = []
    for number in range(first, last + 1):
        row[-1:] = [(x + middle + number * pitch, y, bulge) for x, y, bulge in tooth]
    found: list[Vertex] = []
    for start, end in pairwise(row):
        if end[0] <= low + _NOTHING or start[0] >= high - _NOTHING:
            continue
        begin, finish = max(start[0], low), min(end[0], high)
        whole = begin == start[0] and finish == end[0]
        piece = (start, end) if whole else _cut(start, end, begin, finish)
        found[-1:] = [piece[0], (piece[1][0], piece[1][1], 0.0)]
    return tuple(found)


def _cut(start: Vertex, end: Vertex, low: float, high: float) -> tuple[Vertex, Vertex]:
    """What of a line or an arc, x rising along it, is between two places."""
    (x, y, bulge), (to_x, to_y, _) = start, end
    if not bulge:
        heights = [y + (to_y - y) * (place - x) / (to_x - x) for place in (low, high)]
        return (low, heights[0], 0.0), (high, heights[1], 0.0)
    towards = (1 - bulge**2) / (4 * bulge)  # the centre is so many chords to the left of the chord's middle
    centre = (x + to_x) / 2 - towards * (to_y - y), (y + to_y) / 2 + towards * (to_x - x)
    radius = math.dist(centre, (x, y))
    side = -1 if bulge > 0 else 1  # x rises along an arc to the left only below its centre
    heights = [centre[1] + side * math.sqrt(max(radius**2 - (place - centre[0]) ** 2, 0.0)) for place in (low, high)]
    chord = math.dist((low, heights[0]), (high, heights[1]))
    angle = 2 * math.asin(min(1.0, chord / (2 * radius)))
    return (low, heights[0], math.copysign(math.tan(angle / 4), bulge)), (high, heights[1], 0.0)
