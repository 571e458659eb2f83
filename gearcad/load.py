"""Load: the torque and speed a pair runs at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.core.quantities import APPLICATION_FACTOR, SPEED, TORQUE, AssumedNumber, Words, require_fields
from gearcad.core.records import concise

__all__ = ["Load"]


@dataclass(frozen=True, kw_only=True)
class Load:
    """`torque` on the pinion in N·m (positive turns it counter-clockwise seen from +z), `speed` in rpm.

    `application_factor` K_A multiplies the torque in the ratings. Raises ParameterError.
    """

    torque: Annotated[float, TORQUE, Words("torque on the pinion", "T_1", "ISO 6336-1")]
    speed: Annotated[float, SPEED, Words("speed of the pinion", "n_1", "ISO 6336-1")] = 0.0
    application_factor: Annotated[float, APPLICATION_FACTOR, Words("application factor", "K_A", "ISO 6336-1")] = AssumedNumber(
        1.0
    )

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
