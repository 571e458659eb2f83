"""Curves that make the outline of a tooth: lands, fillets, involutes and tip chamfers, and polylines within a chord error.

Each is evaluated at s in [0, 1] (array of any shape), root side first, and gives the polar form (radius in mm, half
tooth angle in radians), and the direction of travel. Cartesian points are those of the left flank of tooth 0, which is
centred on +x, so y > 0; the right flank is the mirror image. Angles are radians.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats
from gearcad.geometry.involute import involute_at_roll

if TYPE_CHECKING:
    from gearcad.geometry.cutter_flank import CutterFlank
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
        """Return the direction of travel as an angle from +x (rad)."""

    def points(self, s: ArrayLike) -> Floats:
        """Cartesian points (..., 2) in mm."""


class Curve(PlaneCurve, Protocol):
    """A piece of the outline of half a tooth, from root to tip on the left flank of tooth 0."""

    @property
    def kind(self) -> CurveKind: ...

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        """Return the radius (mm) and half tooth angle (rad) at s."""


class PolarCurve:
    """A curve by its polar coordinates."""

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        raise NotImplementedError

    def points(self, s: ArrayLike) -> Floats:
        radius, angle = self.polar(s)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)


@dataclass(frozen=True)
class Land(PolarCurve):
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
class Fillet(PolarCurve):
    """Fillet that the tool tip cuts from theta = `first` to `last`; s is linear in arcsinh(tan theta), to spread the bend."""

    tool: FilletTool
    last: float
    half_pitch: float
    kind: CurveKind = CurveKind.FILLET
    first: float = 0.0

    @property
    def _ends(self) -> tuple[float, float]:
        return math.asinh(math.tan(self.first)), math.asinh(math.tan(self.last))

    def theta(self, s: ArrayLike) -> Floats:
        first, last = self._ends
        return np.arctan(np.sinh(first + np.asarray(s, float) * (last - first)))

    def parameter(self, theta: ArrayLike) -> Floats:
        """Parameter s at which theta (rad) of the tool's tip cuts."""
        first, last = self._ends
        place: Floats = (np.arcsinh(np.tan(np.asarray(theta, float))) - first) / (last - first)
        return place

    def half_angle(self, radius: ArrayLike) -> Floats:
        """Return half tooth angle (rad) at radii (mm) on the curve."""
        angle: Floats = self.half_pitch - self.tool.cut(self.tool.theta_at(radius, self.last))[1]
        return angle

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = self.tool.cut(self.theta(s))
        return radius, self.half_pitch - angle

    def direction(self, s: ArrayLike) -> Floats:
        return self.tool.direction(self.theta(s), self.half_pitch)


@dataclass(frozen=True)
class Involute(PolarCurve):
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

    def half_angle(self, radius: ArrayLike) -> Floats:
        """Return half tooth angle (rad) at radii (mm) that are not inside the base circle."""
        radius = np.asarray(radius, float)
        turned = involute_at_roll(np.sqrt((radius - self.base_radius) * (radius + self.base_radius)) / self.base_radius)
        return self.base_half_angle + turned if self.internal else self.base_half_angle - turned

    def direction(self, s: ArrayLike) -> Floats:
        if self.internal:
            return self.base_half_angle + self.roll(s) - np.pi
        return self.base_half_angle - self.roll(s)


@dataclass(frozen=True)
class WheelArc(PolarCurve):
    """Arc that the rounded tip of a form wheel leaves: about (`x`, `y`) in mm, from angle `first` to `last` (rad, from +x)."""

    x: float
    y: float
    radius: float
    first: float
    last: float
    kind: CurveKind = CurveKind.FILLET

    def _angle(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)

    def points(self, s: ArrayLike) -> Floats:
        angle = self._angle(s)
        return np.stack([self.x + self.radius * np.cos(angle), self.y + self.radius * np.sin(angle)], -1)

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        x, y = np.moveaxis(self.points(s), -1, 0)
        return np.hypot(x, y), np.arctan2(y, x)

    def direction(self, s: ArrayLike) -> Floats:
        return self._angle(s) + math.copysign(math.pi / 2, self.last - self.first)

    def half_angle(self, radius: ArrayLike) -> Floats:
        """Return half tooth angle (rad) at radii (mm) on the arc: where two circles meet."""
        radius = np.asarray(radius, float)
        apart = math.hypot(self.x, self.y)
        cosine = (radius**2 + apart**2 - self.radius**2) / (2 * radius * apart)
        middle = (self.first + self.last) / 2 - math.atan2(self.y, self.x)
        side = -1.0 if math.sin(middle) < 0 else 1.0
        return math.atan2(self.y, self.x) + side * np.arccos(np.clip(cosine, -1.0, 1.0))

    def parameter_at(self, radius: ArrayLike) -> Floats:
        """Return the parameters s at radii (mm) on the arc."""
        half = self.half_angle(radius)
        angle = np.arctan2(np.asarray(radius) * np.sin(half) - self.y, np.asarray(radius) * np.cos(half) - self.x)
        middle = (self.first + self.last) / 2
        turned = middle + np.angle(np.exp(1j * (angle - middle)))
        place: Floats = (turned - self.first) / (self.last - self.first)
        return place


@dataclass(frozen=True)
class FlankTrace(PolarCurve):
    """Piece of a fillet that the straight flank of a cutter's protuberance cuts, between two ways (mm) along that flank."""

    flank: CutterFlank
    last: float
    half_pitch: float
    first: float = 0.0
    kind: CurveKind = CurveKind.FILLET

    def _way(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = self.flank.cut(self._way(s))
        return radius, self.half_pitch - angle

    def direction(self, s: ArrayLike) -> Floats:
        return self.flank.direction(self._way(s), self.half_pitch)

    def half_angle(self, radius: ArrayLike) -> Floats:
        """Return half tooth angle (rad) at radii (mm) on the curve."""
        angle: Floats = self.half_pitch - self.flank.cut(self.flank.way_at(radius, self.first, self.last))[1]
        return angle

    def parameter_at(self, radius: ArrayLike) -> Floats:
        """Return the parameters s at radii (mm) on the curve."""
        place: Floats = (self.flank.way_at(radius, self.first, self.last) - self.first) / (self.last - self.first)
        return place


RootCurve = Fillet | Involute | WheelArc | FlankTrace
"""A smooth piece of a fillet; that of an involute is cut by the flank of a protuberance."""


@dataclass(frozen=True)
class FilletChain(PolarCurve):
    """Pieces of a fillet, root side first, as one curve with corners at the parameters `breaks`."""

    pieces: tuple[RootCurve, ...]
    kind: CurveKind = CurveKind.FILLET

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        """Parameters (inner ones) at which pieces meet, in proportion to their lengths."""
        s = np.linspace(0.0, 1.0, 33)
        lengths = [float(np.hypot(*np.diff(piece.points(s), axis=0).T).sum()) for piece in self.pieces]
        return tuple((np.cumsum(lengths[:-1]) / sum(lengths)).tolist())

    def _each(self, s: ArrayLike) -> Iterator[tuple[RootCurve, Any, Floats]]:
        """Yield each piece, the mask of parameters that are on it, and its own parameters there."""
        s = np.asarray(s, float)
        ends = (0.0, *self.breaks, 1.0)
        number = np.searchsorted(self.breaks, s, side="right")
        for index, (piece, (first, last)) in enumerate(zip(self.pieces, pairwise(ends), strict=True)):
            mask = number == index
            yield piece, mask, (s[mask] - first) / (last - first)

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = np.empty(np.shape(s)), np.empty(np.shape(s))
        for piece, mask, own in self._each(s):
            radius[mask], angle[mask] = piece.polar(own)
        return radius, angle

    def direction(self, s: ArrayLike) -> Floats:
        heading = np.empty(np.shape(s))
        for piece, mask, own in self._each(s):
            heading[mask] = piece.direction(own)
        return heading

    def half_angle(self, radius: ArrayLike) -> Floats:
        """Return half tooth angle (rad) at radii (mm) on the curve, along which radii rise (fall on a ring)."""
        radius = np.asarray(radius, float)
        ends = [float(piece.polar(1.0)[0]) for piece in self.pieces[:-1]]
        side = 1.0 if float(self.polar(0.0)[0]) < float(self.polar(1.0)[0]) else -1.0
        number = np.searchsorted(side * np.array(ends), side * radius, side="left")
        angle = np.empty(radius.shape)
        for index, piece in enumerate(self.pieces):
            mask = number == index
            if np.any(mask):
                angle[mask] = piece.half_angle(radius[mask])
        return angle


@dataclass(frozen=True)
class Chamfer(PolarCurve):
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

    def half_angle(self, radius: ArrayLike) -> Floats:
        """Return half tooth angle (rad) at radii (mm) on the chamfer."""
        radius, side = np.asarray(radius, float), -1 if self.internal else 1
        run = side * (np.sqrt(2 * radius**2 - self.radius**2) - self.radius) / 2
        angle: Floats = self.angle - np.arctan2(run, self.radius + side * run)
        return angle

    def direction(self, s: ArrayLike) -> Floats:
        return np.full(np.shape(s), self.angle - (3 if self.internal else 1) * np.pi / 4)


def parameter_at(curve: Curve, radius: Floats) -> Floats:
    """Return the parameters of points of a fillet's piece at radii (mm) between its ends."""
    if isinstance(curve, WheelArc | FlankTrace):
        return curve.parameter_at(radius)
    assert isinstance(curve, Fillet)
    return curve.parameter(curve.tool.theta_at(radius, curve.last))


def parameters_within(curve: PlaneCurve, chord_error: float) -> Floats:
    """Return the parameters s (n,), 0 ... 1, at which a polyline stays within `chord_error` (mm) of the curve.

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
