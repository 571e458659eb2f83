"""Load: the torque and speed a pair runs at."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.errors import plain_numbers
from gearcad.ranges import APPLICATION_FACTOR, SPEED, TORQUE
from gearcad.reprs import concise

__all__ = ["Load"]


@dataclass(frozen=True, kw_only=True)
class Load:
    """`torque` on the pinion in N·m (positive turns it counter-clockwise seen from +z), `speed` in rpm.

    `application_factor` K_A multiplies the torque in the ratings. Raises ParameterError.
    """

    torque: float
    speed: float = 0.0
    application_factor: float = 1.0

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        TORQUE.require("torque", self.torque)
        SPEED.require("speed", self.speed)
        APPLICATION_FACTOR.require("application_factor", self.application_factor)
