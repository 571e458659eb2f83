"""The cone of the end chamfers, the same on both ends of the teeth."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.geometry.gear import Gear

__all__ = ["EndCone"]


@dataclass(frozen=True)
class EndCone:
    """`face_radius` (mm) is where the cone meets the end plane, infinite without a chamfer; `slope` the tangent of its angle to
    the axis. `side` is 1 where the tips lie outside that circle, -1 on a ring, whose tips lie inside it.
    """

    face_radius: float
    slope: float
    side: int

    @classmethod
    def of(cls, gear: Gear) -> EndCone:
        slope = math.tan(math.radians(gear.body.end_chamfer_angle))
        side = -1 if gear.internal else 1
        if not gear.body.end_chamfer:
            return cls(side * math.inf, slope, side)
        return cls(gear.profile.tip_diameter / 2 - side * gear.body.end_chamfer * slope, slope, side)

    def snapped(self, radii: Iterable[float], near: float) -> EndCone:
        """The cone with its face radius moved onto the first of some radii that is nearer than `near` (mm)."""
        return next((replace(self, face_radius=radius) for radius in radii if abs(radius - self.face_radius) < near), self)

    @property
    def present(self) -> bool:
        return math.isfinite(self.face_radius)

    @property
    def sine(self) -> float:
        """Sine of its angle to the axis."""
        return self.slope / math.hypot(1.0, self.slope)

    def beyond(self, radius: ArrayLike) -> Floats:
        """How far (mm) a radius (mm) is beyond the face radius towards the tips: where it is above 0, there is the cone."""
        result: Floats = self.side * (np.asarray(radius, float) - self.face_radius)
        return result

    def setback(self, radius: ArrayLike) -> Floats:
        """Axial distance (mm) of the surface from the end plane at `radius` (mm)."""
        result: Floats = np.maximum(self.beyond(radius) / self.slope, 0.0)
        return result

    def radius(self, setback: float) -> float:
        """Radius (mm) at an axial distance (mm) from the end plane."""
        return self.face_radius + self.side * setback * self.slope
