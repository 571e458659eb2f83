"""The halves of a double helical gear, each a single helical gear in its place."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from gearcad.errors import GeometryError, format_number
from gearcad.geometry.double_helix import DoubleHelix
from gearcad.geometry.gear import Gear

__all__ = ["Half", "halves", "refuse_halves"]


class Half(NamedTuple):
    """One half: a gear of its width and hand, that begins at height `z` (mm) and is turned by `rotation` (degrees)."""

    gear: Gear
    z: float
    rotation: float


def halves(gear: Gear) -> tuple[Half, Half]:
    """Lower and upper half of a double helical gear.

    The upper one is the mirror image of the lower one, turned by the offset. Modifications along the face are those of each
    half.
    """
    lower = replace(gear, face_width=gear.half_width, double_helix=DoubleHelix())
    mirrored = replace(gear.modification, twist=0.0 - gear.modification.twist)
    upper = replace(lower, helix_angle=-gear.helix_angle, modification=mirrored)
    turned = math.copysign(gear.twist, gear.helix_angle) + 360 / gear.tooth_count * gear.double_helix.offset
    return Half(lower, 0.0, 0.0), Half(upper, gear.face_width - gear.half_width, turned)


def refuse_halves(gear: Gear, what: str) -> None:
    """Raise GeometryError for a double helical gear where only one hand is treated, with the half that would do."""
    if gear.double_helix.present:
        half = format_number(round(gear.half_width, 6))
        permitted = f"must be left out for {what}: take one half, of face width {half} mm, and half the torque"
        raise GeometryError("double_helix.gap_width", gear.double_helix.gap_width, permitted, "mm")
