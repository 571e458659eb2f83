"""Curves that make the outline of a tooth: lands, fillets, involutes and tip chamfers, and polylines within a chord error.

Each is evaluated at s in [0, 1] (array of any shape), root side first, and gives the polar form (radius in mm, half
tooth angle in radians), and the direction of travel. Cartesian points are those of the left flank of tooth 0, which is
centred on +x, so y > 0; the right flank is the mirror image. Angles are radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats
from gearcad.geometry.involute import involute_at_roll

if TYPE_CHECKING:
    from gearcad.geometry.fillets import FilletTool

AIM = 0.98
"""Share of the chord error that the local rule aims at: where the bend changes along a chord it is off by up to 1 %."""


class CurveKind(Enum):
    """Kind of a curve in the outline of a tooth."""

    ROOT = "root"
    FILLET = "trochoid"
    INVOLUTE = "involute"
    CHAMFER = "tip chamfer"
    TIP = "tip"


class PlaneCurve(Protocol):
    """A piece of any outline, evaluated at s in [0, 1] (array of any shape)."""

    @property
    def kind(self) -> Enum: ...

    def direction(self, s: ArrayLike) -> Floats:
        """Direction of travel as an angle from +x (rad)."""

    def points(self, s: ArrayLike) -> Floats:
        """Cartesian points (..., 2) in mm."""


class Curve(PlaneCurve, Protocol):
    """A piece of the outline of half a tooth, from root to tip on the left flank of tooth 0."""

    @property
    def kind(self) -> CurveKind: ...

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        """Radius (mm) and half tooth angle (rad) at s."""


class _Cartesian:
    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        raise NotImplementedError

    def points(self, s: ArrayLike) -> Floats:
        radius, angle = self.polar(s)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)


@dataclass(frozen=True)
class Land(_Cartesian):
    """Arc about the gear axis (the root land or the tip land)."""

    kind: CurveKind
    radius: float
    first: float
    last: float

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        s = np.asarray(s, float)
        return np.full(s.shape, self.radius), self.first + s * (self.last - self.first)

    def direction(self, s: ArrayLike) -> Floats:
        return self.polar(s)[1] - np.pi / 2


@dataclass(frozen=True)
class Fillet(_Cartesian):
    """Fillet that the tool tip cuts up to theta = `last`; s is linear in arcsinh(tan theta), which spreads the bend."""

    tool: FilletTool
    last: float
    half_pitch: float
    kind: CurveKind = CurveKind.FILLET

    def theta(self, s: ArrayLike) -> Floats:
        return np.arctan(np.sinh(np.asarray(s, float) * math.asinh(math.tan(self.last))))

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = self.tool.cut(self.theta(s))
        return radius, self.half_pitch - angle

    def direction(self, s: ArrayLike) -> Floats:
        return self.tool.direction(self.theta(s), self.half_pitch)


@dataclass(frozen=True)
class Involute(_Cartesian):
    """Involute between two roll angles (rad); s is linear in the roll angle.

    On an `internal` tooth, whose tip is the end of the lesser roll, the half angle grows outwards.
    """

    base_radius: float
    base_half_angle: float
    first: float
    last: float
    internal: bool = False
    kind: CurveKind = CurveKind.INVOLUTE

    def roll(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        roll = self.roll(s)
        turned = involute_at_roll(roll)
        angle = self.base_half_angle + turned if self.internal else self.base_half_angle - turned
        return self.base_radius * np.hypot(1.0, roll), angle

    def direction(self, s: ArrayLike) -> Floats:
        if self.internal:
            return self.base_half_angle + self.roll(s) - np.pi
        return self.base_half_angle - self.roll(s)


@dataclass(frozen=True)
class Chamfer(_Cartesian):
    """Straight tip chamfer at 45 degrees to the radius through its end on the flank; `run` is its radial extent there (mm).

    It runs outwards, or inwards on an `internal` tooth.
    """

    radius: float
    angle: float
    run: float
    internal: bool = False
    kind: CurveKind = CurveKind.CHAMFER

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        run = np.asarray(s, float) * self.run
        along = self.radius - run if self.internal else self.radius + run
        return np.hypot(along, run), self.angle - np.arctan2(run, along)

    def direction(self, s: ArrayLike) -> Floats:
        return np.full(np.shape(s), self.angle - (3 if self.internal else 1) * np.pi / 4)


def parameters_within(curve: PlaneCurve, chord_error: float) -> Floats:
    """Parameters s (n,), 0 ... 1, at which a polyline stays within `chord_error` (mm) of the curve.

    Points lie densest where the curve bends most: the local chord is sqrt(8 e / curvature).
    """
    fine = np.linspace(0.0, 1.0, 257)
    points, heading = curve.points(fine), curve.direction(fine)
    length = np.hypot(*np.diff(points, axis=0).T)
    turn = np.abs(np.diff(heading))
    effort = np.r_[0.0, np.cumsum(np.sqrt(turn * length / (8 * AIM * chord_error)))]
    count = max(1, math.ceil(effort[-1] * (1 - 1e-12)))
    s: Floats = np.interp(np.linspace(0.0, effort[-1], count + 1), effort, fine)
    s[0], s[-1] = 0.0, 1.0
    return s
