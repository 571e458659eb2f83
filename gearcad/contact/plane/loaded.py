"""What a mesh under load is, whatever the model: a position, and the positions of one base pitch."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Generic, Self, TypeVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.pair import PairInMesh
from gearcad.contact.shared.extremes import Extreme, Quantity, Span, add_positions, extreme

__all__ = ["LoadedCycle", "LoadedPosition"]


@dataclass(frozen=True)
class LoadedPosition:
    """One position of a mesh under load: approach and each gear's part of it along the line of action (mm).

    `rigid_approach` (mm) is what of the approach needs no load: until teeth touch whose flanks are modified or out of place.
    `force` is the normal force in the transverse section (N per mm of common face width).
    """

    roll_angle: float
    approach: float
    approach_parts: tuple[float, float]
    rigid_approach: float
    force: float

    @property
    def stiffness(self) -> float:
        """N/(mm um): normal force over the approach under load, per mm of common face width."""
        return self.force / ((self.approach - self.rigid_approach) * 1000)

    @property
    def transmission_error(self) -> float:
        """um along the line of action by which the wheel lags."""
        return self.approach * 1000


M = TypeVar("M", bound=PairInMesh)
P = TypeVar("P", bound=LoadedPosition)


@dataclass(frozen=True)
class LoadedCycle(ABC, Generic[M, P]):
    """Positions evenly over one base pitch at one torque (N m on the pinion), and those `between` them at extremes."""

    model: M
    torque: float
    positions: tuple[P, ...]
    between: tuple[P, ...] = ()

    @abstractmethod
    def solve(self, angle: float) -> P:
        """The position at a roll angle (deg). Raises SolverError."""

    @property
    def every(self) -> tuple[P, ...]:
        """All positions in the order of the roll angles."""
        return tuple(sorted((*self.positions, *self.between), key=lambda position: position.roll_angle))

    def values(self, name: str) -> Floats:
        """A quantity at the even positions, such as "stiffness"."""
        return np.array([getattr(position, name) for position in self.positions])

    def course(self, name: str) -> Floats:
        """A quantity at all positions, such as "roll_angle", in the order of the roll angles."""
        return np.array([getattr(position, name) for position in self.every])

    def mean(self, name: str) -> tuple[Floats, Floats]:
        """The mean of a quantity over the base pitch, by a curve through all positions, and how far straight lines are off."""
        from scipy.interpolate import PchipInterpolator

        if not self.model.repeats:  # nothing joins the last position to the first
            even = self.values(name).mean(axis=0)
            return even, np.zeros_like(even)
        angles, values, pitch = self.course("roll_angle"), self.course(name), self._span.pitch
        beside = np.r_[angles[-3:] - pitch, angles, angles[:3] + pitch]
        curve = PchipInterpolator(beside, np.r_[values[-3:], values, values[:3]])
        mean = curve.integrate(-pitch / 2, pitch / 2) / pitch
        lines = np.diff(angles, append=angles[0] + pitch) @ (values + np.roll(values, -1, axis=0)) / 2 / pitch
        return mean, np.abs(lines - mean)

    def searched(self, quantities: Sequence[Quantity[P]]) -> Self:
        """With positions between the even ones, so that the quantities' greatest values are found."""
        return replace(self, between=(*self.between, *add_positions(self._known, self._span, self.solve, quantities)))

    def extreme(self, quantity: Quantity[P]) -> Extreme | None:
        """The greatest value of all positions, and what may be missed of it; None where there is none."""
        return extreme(self._known, self._span, quantity)

    @property
    def _known(self) -> list[tuple[float, P]]:
        return [(position.roll_angle, position) for position in self.every]

    @property
    def _span(self) -> Span:
        return Span(360 / self.model.pair.pinion.teeth, self.model.repeats)
