"""The blank of a ring: end faces, rim and bolt holes, on edges shared with the teeth."""

from __future__ import annotations

import math

from gearcad.geometry.gear import Gear
from gearcad.solids.exact.boundary import Chain, Recorder, backward
from gearcad.solids.exact.forms import Point, level_plane
from gearcad.solids.exact.tubes import tube
from gearcad.solids.rim import require_rim

__all__ = ["add_ring_blank"]


def add_ring_blank(gear: Gear, recorder: Recorder, lower: Chain, upper: Chain) -> None:
    """Add end faces, rim and bolt holes; `lower` and `upper` are the loops of the toothed opening.

    Loops run counter-clockwise seen from +z. Raises GeometryError for a ring without a rim diameter.
    """
    heights = (0.0, gear.face_width)
    rim = tube(recorder, require_rim(gear) / 2, heights, outward=True)
    holes = [tube(recorder, gear.body.bolt_diameter / 2, heights, axis, outward=False) for axis in _bolts(gear)]
    for which, opening in enumerate((lower, upper)):
        loops = [rim[which].loop(along=True), backward(opening), *(hole[which].loop(along=False) for hole in holes)]
        recorder.face(level_plane(heights[which]), loops, outward=which == 1)


def _bolts(gear: Gear) -> list[Point]:
    """Axes of the bolt holes (mm), the first on +x."""
    radius, count = gear.body.bolt_circle / 2, gear.body.bolt_holes
    angles = [2 * math.pi * i / count for i in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
