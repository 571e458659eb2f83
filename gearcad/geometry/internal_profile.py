"""InternalProfile: the one exact outline of a tooth of a ring, in magnitudes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry.curves import Chamfer, Involute
from gearcad.geometry.involute import inverse_involute, involute_at_roll
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.profile import LEAST_LAND, RADIUS_SLACK, ToothProfile

__all__ = ["InternalProfile"]


@dataclass(frozen=True, kw_only=True)
class InternalProfile(ToothProfile):
    """Exact transverse outline of one tooth of a ring: root land outside, fillet, involute, tip chamfer, tip land inside.

    Tooth 0 is centred on +x with its tip towards the axis. Diameters (mm), teeth and roll angles are magnitudes;
    `base_half_angle` (degrees) is s_n/(m_n |z|) - inv alpha_t, the half tooth angle at R less inv alpha_R, and may be negative.
    The messages of its errors have the signs of ISO 21771, as users give and read them.
    """

    internal: ClassVar[bool] = True

    def __repr__(self) -> str:
        return f"<InternalProfile: {self.teeth:.6g} teeth, diameters {self.root_diameter:.6g} to {self.tip_diameter:.6g} mm>"

    def __post_init__(self) -> None:
        if self.tip_diameter <= self.base_diameter:
            permitted = f"must be below {at_most(-self.base_diameter)} mm: an involute begins outside the base circle"
            raise GeometryError("tip_diameter", -self.tip_diameter, permitted, "mm")
        if self.tip_diameter >= self.form_diameter:
            permitted = (
                f"must be above {at_least(-self.form_diameter)} mm, the root form circle: no involute is left on the flank"
            )
            raise GeometryError("tip_diameter", -self.tip_diameter, permitted, "mm")
        if self.tip_thickness < LEAST_LAND:
            permitted = f"must be at most {at_most(-self._pointed_diameter)} mm (pointed tooth)"
            raise GeometryError("tip_diameter", -self.tip_diameter, permitted, "mm")
        if self.tip_chamfer:
            self._refuse_wrong_chamfer()

    def _refuse_wrong_chamfer(self) -> None:
        deepest = (self.form_diameter - self.tip_diameter) / 2
        if self.tip_chamfer >= deepest:
            permitted = f"must be below {at_most(deepest)} mm: no involute is left between it and the root form circle"
            raise GeometryError("tip_chamfer", self.tip_chamfer, permitted, "mm")
        if self.tip_diameter * self.land_half_angle < LEAST_LAND:
            permitted = f"must be at most {self._widest_chamfer(deepest)} mm: no tip land is left"
            raise GeometryError("tip_chamfer", self.tip_chamfer, permitted, "mm")

    @property
    def tip_form_diameter(self) -> float:
        """Tip form circle |d_Fa| (mm), where the involute ends: the tip circle and the chamfers."""
        return self.tip_diameter + 2 * self.tip_chamfer

    @cached_property
    def _pointed_diameter(self) -> float:
        """Diameter (mm) at which the flanks meet, and what a land of LEAST_LAND needs; a tooth is pointed inside it."""
        angle = math.radians(inverse_involute(max(math.radians(-self.base_half_angle), 0.0)))
        return self.base_diameter / math.cos(angle) + 2 * LEAST_LAND / max(math.tan(angle), 1e-3)

    @cached_property
    def _flank(self) -> Involute:
        return Involute(
            self.base_diameter / 2,
            math.radians(self.base_half_angle),
            self._roll(self.form_diameter / 2),
            self._roll(self.tip_form_diameter / 2),
            internal=True,
        )

    def _chamfer_of(self, height: float) -> Chamfer:
        radius, tip = self.tip_diameter / 2 + height, self.tip_diameter / 2
        run = (radius - math.sqrt(2 * tip**2 - radius**2)) / 2
        return Chamfer(radius, float(self._involute_half_angle(radius)), run, internal=True)

    def half_angle(self, radius: ArrayLike) -> Any:
        """Transverse half tooth angle in degrees at `radius` (mm), on fillet, involute and tip chamfer alike.

        Scalar or array. Raises ParameterError for a radius outside tip circle ... root circle.
        """
        given = np.asarray(radius, float)
        root, tip = self.root_diameter / 2, self.tip_diameter / 2
        outside = ~((given >= tip * (1 - RADIUS_SLACK)) & (given <= root * (1 + RADIUS_SLACK)))
        if np.any(outside):
            worst = float(given[outside].flat[0])
            raise ParameterError("radius", worst, f"must be from {tip:.10g} to {root:.10g} mm (tip to root circle)", "mm")
        flat = np.clip(given.ravel(), tip, root)
        result = np.asarray(self._involute_half_angle(flat))
        deep = flat > self.form_diameter / 2
        if np.any(deep):
            theta = self.tool.theta_at(flat[deep], self._last_theta)
            result[deep] = self._half_pitch - self.tool.cut(theta)[1]
        high = flat < self.tip_form_diameter / 2
        if self.tip_chamfer and np.any(high):
            start = self._chamfer.radius
            run = (start - np.sqrt(2 * flat[high] ** 2 - start**2)) / 2
            result[high] = self._chamfer.angle - np.arctan2(run, start - run)
        degrees = np.degrees(result).reshape(given.shape)
        return float(degrees) if degrees.ndim == 0 else degrees

    def _involute_half_angle(self, radius: ArrayLike) -> Any:
        base = self.base_diameter / 2
        radius = np.asarray(radius, float)
        tangent = np.sqrt((radius - base) * (radius + base)) / base
        return math.radians(self.base_half_angle) + involute_at_roll(tangent)
