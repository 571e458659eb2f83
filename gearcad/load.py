"""Load: the torque and speed a pair runs at."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.errors import plain_numbers, require_number

__all__ = ["Load"]


@dataclass(frozen=True, kw_only=True)
class Load:
    """`torque` on the pinion in N·m (positive turns it counter-clockwise seen from +z), `speed` in rpm.

    `application_factor` K_A multiplies the torque in the ratings. Raises ParameterError.
    """

    torque: float
    speed: float = 0.0
    application_factor: float = 1.0

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("torque", self.torque, "N·m")
        require_number("speed", self.speed, "rpm")
        require_number("application_factor", self.application_factor, above=0)
