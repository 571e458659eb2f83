"""A run in time with changing speed or torque: the [dynamics.transient] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from gearcad.errors import GeometryError
from gearcad.ranges import DURATION, SAMPLING, SPEED, Range
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["TransientOptions"]

_FACTOR = Range("", -1e3, 1e3)
_TIME = DURATION._replace(least=0.0)


@dataclass(frozen=True, kw_only=True)
class TransientOptions:
    """Speed and torque over a `duration` (s). Raises ParameterError and GeometryError.

    The speed of the first pinion runs in a straight line from `speed_from` to `speed_to` (rpm; None: what the other is, or the
    speed of the course at one speed), negative where it turns back. All torques and preloads are those of the train times a
    factor: `torque_from`, and from `torque_at` (s; None: half of the duration) on `torque_to` (None: no change), over
    `torque_over` seconds, 0 for a step. Before time 0 the train has settled at what it begins with. `sampling` (Hz; None: 16
    samples a tooth at the greatest speed) is that of the courses: the greatest forces are those of all steps between.
    """

    speed_from: Annotated[float | None, SPEED, Words("speed at the beginning", "n_1")] = None
    speed_to: Annotated[float | None, SPEED, Words("speed at the end", "n_1")] = None
    duration: Annotated[float, DURATION, Words("how long it takes")] = 1.0
    torque_from: Annotated[float, _FACTOR, Words("factor of the torques at the beginning")] = 1.0
    torque_to: Annotated[float | None, _FACTOR, Words("factor of the torques at the end")] = None
    torque_at: Annotated[float | None, _TIME, Words("when the torques begin to change")] = None
    torque_over: Annotated[float, _TIME, Words("how long the torques change")] = 0.0
    sampling: Annotated[float | None, SAMPLING, Words("samples per second")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if self.torque_to is None and (self.torque_at is not None or self.torque_over):
            key = "torque_over" if self.torque_at is None else "torque_at"
            raise GeometryError(key, getattr(self, key), "needs torque_to, the factor of the torques at the end", "s")
        if self.torque_to is not None and self.changes_at + self.torque_over > self.duration:
            key = "torque_over" if self.torque_over else "torque_at"
            most = self.duration - (self.changes_at if self.torque_over else 0.0)
            permitted = f"must be at most {most:g} s: the torques change within the duration of {self.duration:g} s"
            raise GeometryError(key, getattr(self, key), permitted, "s")

    @property
    def changes_at(self) -> float:
        """When the torques begin to change (s)."""
        return self.duration / 2 if self.torque_at is None else self.torque_at

    @property
    def final_torque(self) -> float:
        """The factor at the end."""
        return self.torque_from if self.torque_to is None else self.torque_to

    def speeds(self, otherwise: float) -> tuple[float, float]:
        """At the beginning and at the end (rpm); `otherwise` where neither is given."""
        given = [each for each in (self.speed_from, self.speed_to) if each is not None] or [otherwise]
        return given[0], given[-1]
