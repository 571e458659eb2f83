"""TrainLoad: the torque and speed a planetary train runs at, and what its meshes lose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any

from gearcad.errors import ParameterError, format_number
from gearcad.notice import Notice
from gearcad.ranges import APPLICATION_FACTOR, SPEED, TORQUE, Range
from gearcad.reprs import concise
from gearcad.schema import AssumedNumber, Words, require_fields

__all__ = ["TORQUES", "TrainLoad", "old_torque_notice", "torque_key"]

_EFFICIENCY = Range("", 0.0, 1.0, ends="(]")
_SHARING = Range("", 1.0, 24.0)
"""From equal shares to all of it on one planet of as many as there can be."""

TORQUES = ("output_torque", "input_torque", "torque")
"""Keys of which one gives the torque of a train; `torque` is the old name of one of the others."""


def torque_key(instance: Any) -> str:
    """Return which of TORQUES an object gives. Raises ParameterError unless it is one."""
    given = [key for key in TORQUES if getattr(instance, key) is not None]
    if not given:
        raise ParameterError("output_torque", None, "must be given, in N·m on the output, or input_torque, on the input")
    if len(given) > 1:
        value = getattr(instance, given[1])
        raise ParameterError(given[1], value, f"must be left out beside {given[0]}: one torque follows from the other", "N·m")
    return given[0]


def old_torque_notice(new: str) -> Notice:
    """Return the notice of a train whose torque is given under its old name, `torque`, in place of `new`."""
    return Notice("old-name", f"torque is the old name of {new}, which means the same; write {new} instead", where="load")


@dataclass(frozen=True, kw_only=True)
class TrainLoad:
    """`output_torque` or `input_torque` in N·m, negative if the output drives back, and `speed` of the input in rpm.

    `torque` is the old name of `output_torque`. `mesh_efficiency` is that of every mesh with the carrier at rest: 1 has no
    losses. `application_factor` K_A multiplies the torque in the ratings, and so does `mesh_load_factor` K_gamma, by how much
    the planet that carries most carries more than its share; None takes what is computed of the sharing. Raises ParameterError.
    """

    output_torque: Annotated[float | None, TORQUE, Words("torque on the output", "T")] = None
    input_torque: Annotated[float | None, TORQUE, Words("torque on the input", "T")] = None
    torque: Annotated[float | None, TORQUE, Words("torque on the output, old name", "T")] = None
    speed: Annotated[float, SPEED, Words("speed of the input", "n")] = 0.0
    mesh_efficiency: Annotated[float, _EFFICIENCY, Words("efficiency of a mesh", "η")] = AssumedNumber(1.0)
    application_factor: Annotated[float, APPLICATION_FACTOR, Words("application factor", "K_A", "ISO 6336-1")] = AssumedNumber(
        1.0
    )
    mesh_load_factor: Annotated[float | None, _SHARING, Words("mesh load factor of the planets", "K_γ", "ISO 6336-1")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        torque_key(self)

    @property
    def given_torque(self) -> float:
        """The torque that is given (N·m), on the output or on the input."""
        value: float = getattr(self, torque_key(self))
        return value

    @property
    def on_input(self) -> bool:
        """Whether the torque that is given is that of the input."""
        return self.input_torque is not None

    def times(self, factor: float) -> TrainLoad:
        """Return the same load with `factor` times its torque."""
        return replace(self, **{torque_key(self): self.given_torque * factor})

    def torque_words(self, output: str, input_: str) -> str:
        """Return the torque and the member on which it acts, in words."""
        return f"{format_number(self.given_torque)} N·m on {input_ if self.on_input else output}"

    @property
    def notices(self) -> Iterator[Notice]:
        """What to know of it: that its torque has its old name."""
        if self.torque is not None:
            yield old_torque_notice("output_torque")
