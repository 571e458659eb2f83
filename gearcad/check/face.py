"""Face load factors by ISO 6336-1, Method C, for what a check knows of the misalignment."""

from __future__ import annotations

from typing import NamedTuple

from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded_left import gears_loaded_left
from gearcad.geometry import Gear
from gearcad.per_gear import PerGear
from gearcad.rating.face_load import face_load_factor, root_face_load_factor, width_to_height

__all__ = ["FaceFactors", "face_factors"]


class FaceFactors(NamedTuple):
    """F_beta_y (µm), K_H_beta and K_F_beta."""

    misalignment: float
    flank: float
    root: float


def face_factors(task: CheckTask) -> FaceFactors:
    """From the mounting's misalignment and both helix angle modifications, over the common face width, and from nothing else.

    Deflections of shafts and bodies, crowning, end relief and running in are no part of it; K_v is 1.
    """
    rating = task.rating
    misalignment = task.mounting.misalignment + sum(_mismatch(task))
    flank = face_load_factor(misalignment, rating.stiffness.mesh_beta, rating.specific_load)
    return FaceFactors(misalignment, flank, root_face_load_factor(flank, width_to_height(task.pair)))


def _mismatch(task: CheckTask) -> PerGear[float]:
    """By how much (µm) the gap grows towards larger z over the common width, by the helix angle modification of each gear."""
    width, carries_left = task.pair.common_width.width, task.torque > 0

    def grows(gear: Gear) -> float:
        hand = -1 if gear.helix_angle < 0 else 1
        depth = gear.modification.helix_angle_modification * hand * (-1 if carries_left else 1)
        return depth * width / gear.face_width

    return gears_loaded_left(task.pair).map(grows)
