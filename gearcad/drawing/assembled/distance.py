"""The distance of two axes as a size, with the limits of DIN 3964 where a class is given."""

from __future__ import annotations

from gearcad.drawing.words import Size
from gearcad.geometry import GearPair, RackPair

__all__ = ["distance_size"]


def distance_size(pair: GearPair | RackPair) -> Size:
    """From axis to axis (mm, a magnitude), or from a pinion's axis to the reference line of a rack."""
    if isinstance(pair, RackPair):
        return Size(value=pair.mounting_distance)
    if pair.centre_distance_tolerance is None:
        return Size(value=abs(pair.centre_distance))
    allowance = pair.centre_distance_allowance / 1000
    return Size(value=abs(pair.centre_distance), fit=pair.centre_distance_tolerance, upper=allowance, lower=-allowance)
