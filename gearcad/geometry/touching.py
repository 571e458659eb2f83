"""Where flanks touch in a transverse section, as the pinion turns: on plain numbers."""

from __future__ import annotations

import math

from gearcad.geometry.gear_data import GearData
from gearcad.geometry.profile import ToothProfile

__all__ = ["first_touch"]


def first_touch(gear: GearData, profile: ToothProfile, pressure_angle: float) -> float:
    """Where on the line of action (mm from T1) the left flank of tooth 0 is while that tooth points at the mate.

    r_b (psi_b + alpha_wt), psi_b the half tooth angle on the base circle; `pressure_angle` is the working transverse one
    (degrees). Turned by phi (rad, counter-clockwise) the flank is r_b phi further on, the other left flanks whole base pitches
    away. Right flanks are as far along the mirrored line, and r_b phi back.
    """
    return gear.base_diameter / 2 * math.radians(profile.base_half_angle + pressure_angle)
