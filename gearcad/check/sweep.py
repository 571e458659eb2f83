"""What a check tells of each torque of its sweep."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from gearcad.check.convergence import FEW_POSITIONS
from gearcad.check.extremes import STRESSES
from gearcad.check.summary import by_name, figures
from gearcad.contact.shared.loaded import Cycle
from gearcad.per_gear import PerGear

__all__ = ["SweepPoint", "SweepTrends", "sweep_point", "sweep_points"]


class SweepPoint(NamedTuple):
    """One torque (N·m on the pinion) of the sweep: mean mesh stiffness (N/(mm·µm)), greatest pressure (None where all contacts
    are near edges) and root tensions (MPa).

    `torsional_stiffness` is M/phi of each gear (N·m/rad).
    """

    torque: float
    mesh_stiffness: float
    contact_pressure: float | None
    root_tension: PerGear[float]
    torsional_stiffness: PerGear[float]

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return by_name(self._asdict())


class SweepTrends(NamedTuple):
    """How the figures of a sweep go with the torque: its `points` in rising order."""

    points: tuple[SweepPoint, ...]

    @classmethod
    def of(cls, sweep: Iterable[SweepPoint]) -> SweepTrends:
        """Of the points in any order."""
        return cls(tuple(sorted(sweep, key=lambda point: point.torque)))

    @property
    def first(self) -> SweepPoint:
        """That of the least torque."""
        return self.points[0]

    @property
    def last(self) -> SweepPoint:
        """That of the greatest torque."""
        return self.points[-1]

    @property
    def pressure_everywhere(self) -> bool:
        """False if all contacts are near edges at some torque."""
        return all(point.contact_pressure is not None for point in self.points)

    @property
    def pressure_exponent(self) -> float | None:
        """Power of the torque with which the greatest pressure grows; None where it is missing, or of a single torque."""
        found = [point.contact_pressure for point in self.points if point.contact_pressure is not None]
        return self._exponent(found) if self.pressure_everywhere else None

    @property
    def root_exponents(self) -> PerGear[float] | None:
        """Powers of the torque with which root tensions grow; None of a single torque."""
        powers = [self._exponent(tensions) for tensions in zip(*(point.root_tension for point in self.points), strict=True)]
        known = [power for power in powers if power is not None]
        return PerGear(*known) if len(known) == len(powers) else None

    def _exponent(self, values: Sequence[float]) -> float | None:
        """From the least torque to the greatest; None if they are one."""
        low, high = self.first.torque, self.last.torque
        return math.log(values[-1] / values[0]) / math.log(high / low) if high > low else None

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        roots = self.root_exponents
        return {
            "contact_pressure_exponent": self.pressure_exponent,
            "root_tension_exponents": roots._asdict() if roots is not None else None,
        }


def sweep_point(cycle: Cycle) -> SweepPoint:
    """The figures of a cycle at its torque."""
    few, model = figures(cycle), cycle.model
    turns, _ = cycle.mean("approach_parts")
    # A gear whose flank gives way by u along the line of action turns by u/r_b under the torque F r_b.
    radii = np.array([model.pair.pinion.base_diameter, model.pair.wheel.base_diameter]) / 2
    force = model.force(cycle.torque) * model.width
    stiffness = PerGear(*(force * radii**2 / turns / 1000).tolist())
    return SweepPoint(abs(cycle.torque), few.mesh_stiffness, few.contact_pressure, few.root_tension, stiffness)


def sweep_points(cycle: Cycle, torques: Iterable[float]) -> tuple[SweepPoint, ...]:
    """Those of a cycle's model at torques (N·m)."""
    cycles = (type(cycle).run(cycle.model, torque, FEW_POSITIONS) for torque in torques)
    return tuple(sweep_point(each.searched(STRESSES)) for each in cycles)
