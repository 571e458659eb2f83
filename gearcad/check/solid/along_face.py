"""How even the load and the root stress of solid gears are along the face width."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.per_gear import PerGear, Role

__all__ = ["AlongFace", "RootAlongFace", "along_face"]


class RootAlongFace(NamedTuple):
    """The greatest root tension `stress` (n,) in MPa of a cycle at `heights` (n,) in mm of a gear.

    The common face width is from `low` to `high` (mm).
    """

    heights: Floats
    stress: Floats
    low: float
    high: float

    @property
    def across(self) -> Floats:
        """The heights (n,) from the middle of the common width."""
        result: Floats = self.heights - (self.low + self.high) / 2
        return result

    @property
    def common(self) -> Bools:
        """Heights (n,) of the common width."""
        result: Bools = (self.heights >= self.low) & (self.heights <= self.high)
        return result


class AlongFace(NamedTuple):
    """Load per width (n,) in N/mm, transverse, mean of all positions, at places `across` (n,) in mm from the middle of the
    common face width; each gear's root tension.
    """

    across: Floats
    load: Floats
    roots: PerGear[RootAlongFace]

    @property
    def mean(self) -> float:
        """Of the load."""
        return float(np.mean(self.load))

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it."""
        return {
            "across": self.across.tolist(),
            "load": self.load.tolist(),
            **{
                role.value: {"height": root.heights.tolist(), "root_tension": root.stress.tolist()}
                for role, root in self.roots.items()
            },
        }


def along_face(cycle: SolidCycle) -> AlongFace:
    """Of a cycle."""

    def root(role: Role) -> RootAlongFace:
        return RootAlongFace(*cycle.root_along_face(role), *cycle.model.common_heights(role))

    return AlongFace(*cycle.load_along_face, PerGear.each(root))
