"""RackProfile: the exact outline of a rack's tooth, in the transverse section, from which solids and drawings start.

The tooth is centred on x = 0 with its tip up, y counts from the reference line, z towards the viewer: its left half has x < 0.
Square to the teeth flanks are straight and fillets arcs of circles; along the rack all is stretched by 1/cos beta.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import ParameterError
from gearcad.geometry.curves import PlaneCurve
from gearcad.geometry.profile import LEAST_LAND, RADIUS_SLACK

__all__ = ["FilletArc", "RackCurve", "RackCurveKind", "RackProfile", "Straight"]


class RackCurveKind(Enum):
    """What a piece of the outline is; the value is its name in files."""

    ROOT = "root land"
    FILLET = "fillet"
    FLANK = "flank"
    CHAMFER = "tip chamfer"
    TIP = "tip land"


class RackCurve(PlaneCurve, Protocol):
    """A piece of the outline of the left half of a tooth, root side first."""

    @property
    def kind(self) -> RackCurveKind: ...


@dataclass(frozen=True)
class Straight:
    """A land, a flank or a chamfer, between two points (mm)."""

    kind: RackCurveKind
    start: tuple[float, float]
    end: tuple[float, float]

    def points(self, s: ArrayLike) -> Floats:
        s = np.asarray(s, float)[..., None]
        points: Floats = (1 - s) * np.array(self.start) + s * np.array(self.end)
        return points

    def direction(self, s: ArrayLike) -> Floats:
        (x, y), (to_x, to_y) = self.start, self.end
        return np.full(np.shape(s), math.atan2(to_y - y, to_x - x))


@dataclass(frozen=True)
class FilletArc:
    """The fillet: a circle about (`x`, `y`) in the normal section (mm), from its lowest point over the angle `last` (rad).

    `stretch` is 1/cos beta, by which the transverse section is wider.
    """

    x: float
    y: float
    radius: float
    last: float
    stretch: float
    kind: RackCurveKind = RackCurveKind.FILLET

    def points(self, s: ArrayLike) -> Floats:
        theta = np.asarray(s, float) * self.last
        return np.stack([(self.x + self.radius * np.sin(theta)) * self.stretch, self.y - self.radius * np.cos(theta)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        theta = np.asarray(s, float) * self.last
        return np.arctan2(np.sin(theta), np.cos(theta) * self.stretch)


@dataclass(frozen=True, kw_only=True)
class RackProfile:
    """Exact transverse outline of one tooth of a rack: root land, fillet, flank, tip chamfer, tip land.

    Normal pitch and thickness on the reference line, heights, radius of the fillets and height of the tip chamfer (45 degrees
    in the transverse section) in mm; angles in degrees. Normally obtained as `rack.profile`.
    """

    normal_pitch: float
    normal_thickness: float
    pressure_angle: float
    helix_angle: float
    tip_height: float
    root_depth: float
    root_radius: float
    tip_chamfer: float = 0.0

    @property
    def stretch(self) -> float:
        """1/cos beta."""
        return 1 / math.cos(math.radians(self.helix_angle))

    @property
    def pitch(self) -> float:
        """Transverse pitch (mm)."""
        return self.normal_pitch * self.stretch

    @property
    def slope(self) -> float:
        """tan alpha_t: how fast a flank leans in."""
        return math.tan(math.radians(self.pressure_angle)) * self.stretch

    @property
    def form_depth(self) -> float:
        """Where the straight flank begins, below the reference line (mm)."""
        return self.root_depth - self.root_radius * (1 - math.sin(math.radians(self.pressure_angle)))

    @cached_property
    def _fillet(self) -> FilletArc:
        """u = s_n/2 + (h_f - rho) tan a_n + rho/cos a_n from the middle of the tooth, v = -(h_f - rho)."""
        angle, depth = math.radians(self.pressure_angle), self.root_depth - self.root_radius
        u = self.normal_thickness / 2 + depth * math.tan(angle) + self.root_radius / math.cos(angle)
        return FilletArc(-u, -depth, self.root_radius, math.pi / 2 - angle, self.stretch)

    @property
    def root_land(self) -> float:
        """Width of the root land along the rack (mm); 0 where fillets meet."""
        width = self.pitch + 2 * self._fillet.x * self.stretch
        return width if width >= LEAST_LAND else 0.0

    @cached_property
    def curves(self) -> tuple[RackCurve, ...]:
        """Curves of the left half of a tooth from the middle of the space to the middle of the tooth.

        The root land is absent where the fillets meet, the fillet where there is no radius, the chamfer where there is none.
        """
        fillet, tip = self._fillet, self.tip_height
        middle = (-self.pitch / 2, -self.root_depth)
        foot = (fillet.x * self.stretch, -self.root_depth)
        form = (-self.half_thickness_on_flank(-self.form_depth), -self.form_depth)
        if not (self.root_land or self.root_radius):  # flanks meet, rounding or not
            form = middle
        end = (-self.half_thickness_on_flank(tip - self.tip_chamfer), tip - self.tip_chamfer)
        top = (end[0] + self.tip_chamfer, tip)
        curves: list[RackCurve] = [Straight(RackCurveKind.FLANK, form, end)]
        if self.root_radius:
            curves.insert(0, fillet)
        if self.root_land:
            curves.insert(0, Straight(RackCurveKind.ROOT, middle, foot))
        if self.tip_chamfer:
            curves.append(Straight(RackCurveKind.CHAMFER, end, top))
        return (*curves, Straight(RackCurveKind.TIP, top, (0.0, tip)))

    def half_thickness_on_flank(self, height: float) -> float:
        """Half the transverse tooth thickness (mm) at a height (mm) if the flank went on to there."""
        return float(self._on_flank(height))

    def _on_flank(self, height: ArrayLike) -> Floats:
        return self.normal_thickness / 2 * self.stretch - np.asarray(height, float) * self.slope

    def half_thickness(self, height: ArrayLike) -> Any:
        """Half the transverse tooth thickness (mm) at a height over the reference line (mm, root to tip), scalar or array.

        Raises ParameterError for heights outside root ... tip.
        """
        given = np.asarray(height, float)
        slack = RADIUS_SLACK * self.normal_pitch
        outside = ~((given >= -self.root_depth - slack) & (given <= self.tip_height + slack))
        if np.any(outside):
            permitted = f"must be from {-self.root_depth:.10g} to {self.tip_height:.10g} mm (root to tip)"
            raise ParameterError("height", float(given[outside].flat[0]), permitted, "mm")
        half = self._on_flank(given)
        fillet, end = self._fillet, self.tip_height - self.tip_chamfer
        below = np.clip(fillet.y - given, -fillet.radius, fillet.radius)
        along = np.sqrt((fillet.radius - below) * (fillet.radius + below))
        half = np.where(given < -self.form_depth, -(fillet.x + along) * self.stretch, half)
        half = np.where(given > end, self._on_flank(end) - (given - end), half)
        return float(half) if half.ndim == 0 else half
