"""A double helical gear with a gap: teeth of both halves, and the groove between them."""

from __future__ import annotations

import math

from gearcad.geometry.gear import Gear
from gearcad.geometry.halves import halves
from gearcad.solids.exact.boundary import Chain, Recorder
from gearcad.solids.exact.forms import level_plane
from gearcad.solids.exact.teeth import add_teeth
from gearcad.solids.exact.tubes import tube

__all__ = ["add_halves"]


def add_halves(gear: Gear, recorder: Recorder) -> tuple[Chain, Chain]:
    """Add the toothed sides of both halves, and what is between them.

    Returns the loops of the lower and the upper end face, counter-clockwise seen from +z.
    """
    lower, upper = halves(gear)
    first, below = add_teeth(lower.gear, recorder)
    above, last = add_teeth(upper.gear, recorder.moved(upper.z, math.radians(upper.rotation)))
    heights, radius = (gear.half_width, upper.z), gear.gap_diameter / 2
    rings = tube(recorder, radius, heights, outward=True)
    for ring, loop, z, outward in zip(rings, (below, above), heights, (True, False), strict=True):
        recorder.face(level_plane(z), [loop, ring.loop(along=False)], outward=outward)
    return first, last
