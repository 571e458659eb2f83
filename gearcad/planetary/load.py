"""TrainLoad: the torque and speed a planetary train runs at, and what its meshes lose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.ranges import APPLICATION_FACTOR, SPEED, TORQUE, Range
from gearcad.reprs import concise
from gearcad.schema import AssumedNumber, Words, require_fields

__all__ = ["TrainLoad"]

_EFFICIENCY = Range("", 0.0, 1.0, ends="(]")
_SHARING = Range("", 1.0, 24.0)
"""From equal shares to all of it on one planet of as many as there can be."""


@dataclass(frozen=True, kw_only=True)
class TrainLoad:
    """`torque` in N·m on the output, negative if that drives back, and `speed` of the input in rpm.

    `mesh_efficiency` is that of every mesh with the carrier at rest: 1 has no losses. `application_factor` K_A multiplies
    the torque in the ratings, and so does `mesh_load_factor` K_gamma, by how much the planet that carries most carries more
    than its share; None takes what is computed of the sharing. Raises ParameterError.
    """

    torque: Annotated[float, TORQUE, Words("torque on the output", "T")]
    speed: Annotated[float, SPEED, Words("speed of the input", "n")] = 0.0
    mesh_efficiency: Annotated[float, _EFFICIENCY, Words("efficiency of a mesh", "η")] = AssumedNumber(1.0)
    application_factor: Annotated[float, APPLICATION_FACTOR, Words("application factor", "K_A", "ISO 6336-1")] = AssumedNumber(
        1.0
    )
    mesh_load_factor: Annotated[float | None, _SHARING, Words("mesh load factor of the planets", "K_γ", "ISO 6336-1")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
