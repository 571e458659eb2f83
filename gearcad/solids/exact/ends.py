"""The two ends of a gear: a plane, and the cone of the end chamfer from a radius on towards the tips."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.geometry.gear import Gear
from gearcad.solids.cone import EndCone

__all__ = ["End", "gear_ends"]

_SNAP = 1e-5
"""A chamfer that begins this close (mm) to where two pieces of the outline meet begins there: no slivers."""


@dataclass(frozen=True)
class End:
    """One end face at the height `z` (mm). `inward` is +1 at the lower end (z = 0), -1 at the upper."""

    z: float
    inward: int
    cone: EndCone

    @property
    def widens(self) -> int:
        """+1 where the cone widens upwards, -1 where it does downwards."""
        return self.inward * self.cone.side

    def height(self, radius: ArrayLike) -> Floats:
        """z (mm) of the end's surface at a radius (mm), array."""
        return np.asarray(self.z + self.inward * self.cone.setback(radius))


def gear_ends(gear: Gear, junctions: Iterable[float]) -> tuple[End, End]:
    """Lower and upper end of a gear; a chamfer's face radius snaps to the radii (mm) where pieces of the outline meet."""
    cone = EndCone.of(gear).snapped(junctions, _SNAP)
    return End(0.0, 1, cone), End(gear.face_width, -1, cone)
