"""Where the gears of a pair, or a rack, stand in mesh: a tooth of the pinion in a space of the mate, backlash split."""

from __future__ import annotations

from typing import NamedTuple

from gearcad.per_gear import PerGear

__all__ = ["Pose", "RackPose", "wheel_pose"]


class Pose(NamedTuple):
    """Place of the wheel beside a pinion that stands unturned at the origin, teeth from z = 0 to its face width.

    `rotation` of the wheel about its own axis (degrees, counter-clockwise seen from +z), then its shift along x (the
    centre distance) and along z (mm).
    """

    rotation: float
    x: float
    z: float


def wheel_pose(*, teeth: PerGear[int], centre_distance: float, z: float, turn: float) -> Pose:
    """Pose of a wheel that begins at height `z` (mm), where the pinion's section is turned by `turn` (degrees).

    A ring stands at minus x: like the pinion's, the teeth of it that mesh are on its side of +x.
    """
    facing = 0.0 if teeth.wheel > 0 and teeth.wheel % 2 else 180 / abs(teeth.wheel)
    return Pose(facing - turn / (teeth.wheel / teeth.pinion), centre_distance, z)


class RackPose(NamedTuple):
    """Place of a rack beside a pinion that stands at the origin, teeth from z = 0 to its face width.

    `rotation` of the rack about z (degrees: its tips then face the pinion), then its shift (mm) along x (the mounting
    distance), y (its travel, from where its own x = 0 is) and z.
    """

    rotation: float
    x: float
    y: float
    z: float
