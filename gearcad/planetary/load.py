"""TrainLoad: the torque and speed a planetary train runs at, and what its meshes lose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.ranges import APPLICATION_FACTOR, SPEED, TORQUE, Range
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["TrainLoad"]

_EFFICIENCY = Range("", 0.0, 1.0, ends="(]")


@dataclass(frozen=True, kw_only=True)
class TrainLoad:
    """`torque` in N·m on the output, negative if that drives back, and `speed` of the input in rpm.

    `mesh_efficiency` is that of every mesh with the carrier at rest: 1 has no losses. `application_factor` K_A multiplies
    the torque in the ratings. Raises ParameterError.
    """

    torque: Annotated[float, TORQUE, Words("torque on the output", "T")]
    speed: Annotated[float, SPEED, Words("speed of the input", "n")] = 0.0
    mesh_efficiency: Annotated[float, _EFFICIENCY, Words("efficiency of a mesh", "η")] = 1.0
    application_factor: Annotated[float, APPLICATION_FACTOR, Words("application factor", "K_A", "ISO 6336-1")] = 1.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
