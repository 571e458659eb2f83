"""The keyway in a bore: centred on +x, through the whole gear."""

from __future__ import annotations

import math

from gearcad.geometry import Body

__all__ = ["keyway_half_angle"]


def keyway_half_angle(body: Body) -> float:
    """Half of the angle (rad) over which the keyway opens the bore."""
    return math.asin(body.keyway_width / body.bore)
