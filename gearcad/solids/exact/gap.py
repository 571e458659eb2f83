"""A double helical gear with a gap: teeth of both halves, and the groove between them."""

from __future__ import annotations

import math

from gearcad.geometry.gear import Gear
from gearcad.geometry.halves import halves
from gearcad.solids.exact.kernel import Edges, Kernel
from gearcad.solids.exact.teeth import add_teeth
from gearcad.solids.exact.tubes import tube

__all__ = ["add_halves"]


def add_halves(gear: Gear, kernel: Kernel) -> tuple[Edges, Edges]:
    """Add the toothed sides of both halves, and what is between them, to the kernel's shell.

    Returns the loops of the lower and the upper end face, counter-clockwise seen from +z.
    """
    lower, upper = halves(gear)
    first, below = add_teeth(lower.gear, kernel)
    above, last = add_teeth(upper.gear, kernel.moved(upper.z, math.radians(upper.rotation)))
    heights, radius = (gear.half_width, upper.z), gear.gap_diameter / 2
    rings = tube(kernel, radius, heights, outward=True)
    for ring, loop, z, outward in zip(rings, (below, above), heights, (True, False), strict=True):
        kernel.face(kernel.plane(z), [loop, ring.loop(along=False)], outward=outward)
    return first, last
