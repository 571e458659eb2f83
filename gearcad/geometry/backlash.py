"""Backlash of two gears on plain numbers with signed teeth, and what tolerances let it be. Lengths in mm, angles in degrees."""

from __future__ import annotations

import math
from typing import NamedTuple

from gearcad.geometry.involute import involute
from gearcad.per_gear import PerGear

__all__ = ["Backlash", "BacklashLimits", "backlash", "settled"]

_ROUNDING = 1e-12
"""Of the numbers of which a difference is: what is left below that is rounding, and is told as 0."""


def settled(difference: float, size: float) -> float:
    """Return a difference of numbers of that size, 0 where rounding alone is left of it."""
    return 0.0 if abs(difference) <= _ROUNDING * abs(size) else difference


class Backlash(NamedTuple):
    """j_wt along the working pitch circles, and j_bn along the base normal (mm); negative where teeth would overlap."""

    circumferential: float
    normal: float


class BacklashLimits(NamedTuple):
    """Backlash at the least, of thick teeth on near axes, and at the most (mm).

    Of the allowances of tooth thickness and, by `centre_distance_allowance` A_a (µm, ±), of the distance; not of deviations of
    flanks and axes, of temperature or of bent shafts.
    """

    centre_distance_allowance: float
    circumferential_least: float
    circumferential_greatest: float
    normal_least: float
    normal_greatest: float


def backlash(
    *,
    teeth: PerGear[int],
    base_half_angles: PerGear[float],
    base_diameters: PerGear[float],
    base_helix_angle: float,
    centre_distance: float,
) -> Backlash:
    """The working pitch less both tooth thicknesses on the working pitch circles, of gears at a centre distance."""
    ratio = teeth.wheel / teeth.pinion
    pressure_angle = math.degrees(math.acos((base_diameters.pinion + base_diameters.wheel) / (2 * centre_distance)))
    working = involute(pressure_angle)
    gap = 2 * math.pi / teeth.pinion
    for half_angle, turn in zip(base_half_angles, (1.0, ratio), strict=True):
        gap -= 2 * turn * (math.radians(half_angle) - working)
    along = gap * (2 * centre_distance / (1 + ratio)) / 2
    across = math.cos(math.radians(pressure_angle))
    return Backlash(along, along * across * math.cos(math.radians(base_helix_angle)))
