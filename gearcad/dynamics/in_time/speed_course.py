"""How speed and torque run over time: straight lines between corners, steps where a time stands twice. SI units."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats, Indices
from gearcad.errors import ParameterError

__all__ = ["Course", "Line"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """Straight lines through `value` (k,) at `time` (k,) in s, level beyond its ends; it jumps where a time stands twice."""

    time: Floats
    value: Floats

    def __post_init__(self) -> None:
        time, value = np.atleast_1d(np.array(self.time, float)), np.atleast_1d(np.array(self.value, float))
        if time.ndim != 1 or time.shape != value.shape or not np.isfinite(time).all() or (np.diff(time) < 0).any():
            raise ParameterError("time", f"{time.shape}", "must rise, with one value each", "s")
        if not np.isfinite(value).all():
            raise ParameterError("value", "not finite", "must be finite numbers")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "value", value)

    @classmethod
    def level(cls, value: float) -> Line:
        """The same at all times."""
        return cls(time=np.zeros(1), value=np.array([value]))

    @property
    def sums(self) -> Floats:
        """(k,) integrals from the first corner to each."""
        return np.concatenate([[0.0], np.cumsum(np.diff(self.time) * (self.value[1:] + self.value[:-1]) / 2)])

    def values(self, time: ArrayLike) -> Floats:
        """At any times (s); behind a jump where one is."""
        which, after, slope = self._after(time)
        return np.asarray(self.value[which] + slope * after, float)

    def integrals(self, time: ArrayLike) -> Floats:
        """From the first corner to any times (s)."""
        which, after, slope = self._after(time)
        return np.asarray(self.sums[which] + after * (self.value[which] + slope * after / 2), float)

    def _after(self, time: ArrayLike) -> tuple[Indices, Floats, Floats]:
        """The corner before each time, the time since, and the slope there."""
        at, steps = np.asarray(time, float), np.diff(self.time)
        slopes = np.append(np.divide(np.diff(self.value), steps, out=np.zeros_like(steps), where=steps > 0), 0.0)
        which = np.maximum(np.searchsorted(self.time, at, side="right") - 1, 0)
        after = at - self.time[which]
        return which, after, np.where(after < 0, 0.0, slopes[which])


@dataclass(frozen=True, kw_only=True, eq=False)
class Course:
    """`frequency` of the common period of all meshes (Hz), negative where they turn back; `torque` a factor of the load.

    `turns` of the common period have passed at the first corner of the frequency.
    """

    frequency: Line
    torque: Line = field(default_factory=lambda: Line.level(1.0))
    turns: float = 0.0

    @classmethod
    def steady(cls, frequency: float) -> Course:
        """One speed under the whole load; the frequency is that of the common period (Hz)."""
        return cls(frequency=Line.level(frequency))
