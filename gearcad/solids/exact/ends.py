"""The two ends of a gear: a plane, and the cone of the end chamfer beyond a radius."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.geometry.gear import Gear

__all__ = ["End", "gear_ends"]

_SNAP = 1e-5
"""A chamfer that begins this close (mm) to where two pieces of the outline meet begins there: no slivers."""


@dataclass(frozen=True)
class End:
    """One end face. `inward` is +1 at the lower end (z = 0), -1 at the upper; `edge_radius` is where the cone begins
    (infinite without a chamfer); `tangent` of the angle between the cone and the axis."""

    z: float
    inward: int
    edge_radius: float
    tangent: float

    @property
    def chamfered(self) -> bool:
        return math.isfinite(self.edge_radius)

    @property
    def sine(self) -> float:
        """Sine of the cone's half angle."""
        return self.tangent / math.hypot(1.0, self.tangent)

    def height(self, radius: ArrayLike) -> NDArray[np.float64]:
        """z (mm) of the end's surface at a radius (mm), array."""
        radius = np.asarray(radius, float)
        if not self.chamfered:
            return np.full(radius.shape, self.z)
        return np.asarray(self.z + self.inward * np.maximum(radius - self.edge_radius, 0.0) / self.tangent)

    def radius(self, z: float) -> float:
        """Radius (mm) of the cone at a height z (mm)."""
        return self.edge_radius + abs(z - self.z) * self.tangent


def gear_ends(gear: Gear, junctions: Iterable[float]) -> tuple[End, End]:
    """Lower and upper end of a gear; a chamfer's small radius snaps to the radii (mm) where pieces of the outline meet."""
    radius, tangent = math.inf, 1.0
    if gear.body.end_chamfer:
        tangent = math.tan(math.radians(gear.body.end_chamfer_angle))
        radius = gear.tip_diameter / 2 - gear.body.end_chamfer * tangent
        radius = next((near for near in junctions if abs(near - radius) < _SNAP), radius)
    return End(0.0, 1, radius, tangent), End(gear.face_width, -1, radius, tangent)
