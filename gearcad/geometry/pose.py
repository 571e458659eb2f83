"""Where the gears of a pair stand when they mesh: a tooth of the pinion in a space of the wheel, backlash split."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from gearcad.geometry.helix import twist

if TYPE_CHECKING:
    from gearcad.geometry.pair import GearPair

__all__ = ["MeshPose", "mesh_pose"]


class MeshPose(NamedTuple):
    """Place of the wheel beside a pinion that stands unturned at the origin, teeth from z = 0 to its face width.

    `rotation` of the wheel about its own axis (degrees, counter-clockwise seen from +z), then its shift along x (the
    centre distance) and along z (mm).
    """

    rotation: float
    x: float
    z: float


def mesh_pose(pair: GearPair, pinion_rotation: float = 0.0) -> MeshPose:
    """Pose of the wheel with the middles of the gears in one plane (moved by `axial_offset`), at any pinion rotation (deg)."""
    z = (pair.pinion.face_width - pair.wheel.face_width) / 2 + pair.axial_offset
    turn = pinion_rotation + math.degrees(twist(pair.pinion, z))
    facing = 0.0 if pair.wheel.teeth % 2 else 180 / pair.wheel.teeth
    return MeshPose(facing - turn / pair.gear_ratio, pair.centre_distance, z)
