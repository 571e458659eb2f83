"""The helix: how far the teeth turn along the axis."""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.gear_data import GearData

__all__ = ["height_in_half", "section_turn", "twist"]


def twist(gear: GearData, height: float = 1.0) -> float:
    """Angle (rad) by which the section at a height z (mm) is turned: z tan(beta)/r, positive for a right-hand helix.

    That of 1 mm is the twist rate (rad/mm).
    """
    return height * math.tan(math.radians(gear.helix_angle)) / (abs(gear.reference_diameter) / 2)


def height_in_half(gear: GearData, heights: Floats) -> Floats:
    """Heights z (mm) above the outer end of the half that they are in: halves of double helical gears are mirror images."""
    if not gear.double_helix.present:
        return heights
    below: Floats = np.minimum(heights, gear.face_width - heights)
    return below


def section_turn(gear: GearData, heights: Floats) -> Floats:
    """Angles (rad) by which sections at heights z (mm) are turned, those of the upper half of a double helical gear too."""
    turned = twist(gear) * height_in_half(gear, heights)
    if not gear.double_helix.offset:
        return turned
    pitch = 2 * math.pi / gear.tooth_count
    on: Floats = turned + np.where(heights > gear.face_width / 2, pitch * gear.double_helix.offset, 0.0)
    return on
