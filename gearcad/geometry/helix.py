"""The helix: how far the teeth turn along the axis."""

from __future__ import annotations

import math

from gearcad.geometry.gear_data import GearData

__all__ = ["twist"]


def twist(gear: GearData, height: float = 1.0) -> float:
    """Angle (rad) by which the section at a height z (mm) is turned: z tan(beta)/r, positive for a right-hand helix.

    That of 1 mm is the twist rate (rad/mm).
    """
    return height * math.tan(math.radians(gear.helix_angle)) / (abs(gear.reference_diameter) / 2)
