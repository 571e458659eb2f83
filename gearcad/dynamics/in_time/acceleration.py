"""What a rising speed asks of a train: the torque that speeds up its own inertias, through the meshes. SI units."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.trains.parts import parts_of
from gearcad.dynamics.trains.system import System
from gearcad.dynamics.trains.train import Train

__all__ = ["Acceleration", "acceleration"]

_NOTHING = 1e-9
"""Of the greatest power: rounding."""


class Acceleration(NamedTuple):
    """What the coordinates of a System feel (n,) of 1 rad/s² of the first pinion; `why` they feel nothing, "" if they do."""

    felt: Floats
    why: str


def acceleration(train: Train, system: System, *, backwards: bool = False) -> Acceleration:
    """With all inertias at the ratios of the teeth, sped up by the one on which the torque drives (`backwards`: is driven)."""
    nothing = np.zeros(system.size)
    if train.held:
        return Acceleration(nothing, "the ends of its shafts are held")
    parts, first = parts_of(train), train.meshes[0].pinion
    if parts.free.shape[1] != 1:
        return Acceleration(nothing, "its parts turn by themselves")
    ratios = np.array([train.speed_ratios[inertia.name] for inertia in parts.inertias])
    power = parts.torque * ratios * (-1.0 if backwards else 1.0)
    least = _NOTHING * float(np.abs(power).max())
    driving = [inertia.name for inertia, each in zip(parts.inertias, power, strict=True) if each > least]
    if len(driving) != 1:
        return Acceleration(nothing, f"{len(driving) or 'no'} torques drive it")
    names = system.names[1]
    free = np.linalg.eigh(system.stiffness_matrix())[1][:, 0]
    turn = free / (system.inertias[:, names.index(first)] @ free)
    drive = system.inertias[:, names.index(driving[0])]
    return Acceleration(drive * float(turn @ turn) / float(drive @ turn) - turn, "")


def per_common_period(teeth: int, order: int) -> float:
    """Speed of a pinion of so many teeth (rad/s) where the common period of `order` of its teeth has a frequency of 1/s."""
    return 2 * math.pi * order / teeth
