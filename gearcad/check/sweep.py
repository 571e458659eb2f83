"""What a check tells of each torque of its sweep."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from gearcad.check.summary import by_name, figures
from gearcad.contact.shared.loaded import Cycle
from gearcad.per_gear import PerGear

__all__ = ["SweepPoint", "sweep_point"]


class SweepPoint(NamedTuple):
    """One torque (N·m on the pinion) of the sweep: mean mesh stiffness (N/(mm µm)), greatest pressure (None where all contacts
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


def sweep_point(cycle: Cycle) -> SweepPoint:
    """The figures of a cycle at its torque."""
    few, model = figures(cycle), cycle.model
    turns, _ = cycle.mean("approach_parts")
    # A gear whose flank gives way by u along the line of action turns by u/r_b under the torque F r_b.
    radii = np.array([model.pair.pinion.base_diameter, model.pair.wheel.base_diameter]) / 2
    force = model.force(cycle.torque) * model.width
    stiffness = PerGear(*(force * radii**2 / turns / 1000).tolist())
    return SweepPoint(abs(cycle.torque), few.mesh_stiffness, few.contact_pressure, few.root_tension, stiffness)
