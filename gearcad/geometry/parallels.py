"""Parallels and scaled copies of the curves of a tooth, and the corners between them.

The parallel is that of the surface that a curve sweeps along the tooth, seen in the transverse section again. Of an involute it
is the same involute, turned; of what a rounded tip of a tool leaves it is what a tip of another radius leaves about the same
centre. Lengths in mm, angles in radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats
from gearcad.geometry.curves import Curve, CurveKind, Involute, PolarCurve
from gearcad.geometry.involute import root_between


class CrossingFault(Exception):
    """Two curves that should cross and do not."""


class _Wrapped(PolarCurve):
    curve: Curve

    @property
    def kind(self) -> CurveKind:
        """The kind of the curve itself."""
        return self.curve.kind


@dataclass(frozen=True)
class ScaledCurve(_Wrapped):
    """A curve whose radii are scaled by `radial`, and its half tooth angles by `angular`."""

    curve: Curve
    radial: float
    angular: float

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        radius, angle = self.curve.polar(s)
        return radius * self.radial, angle * self.angular

    def direction(self, s: ArrayLike) -> Floats:
        angle = self.curve.polar(s)[1]
        slant = self.curve.direction(s) - angle  # to the line from the axis
        across, along = np.sin(slant), np.cos(slant)
        change = np.arctan2((self.angular - 1) * across * along, along**2 + self.angular * across**2)
        tilted: Floats = slant + change + angle * self.angular
        return tilted


@dataclass(frozen=True)
class PartOfCurve(_Wrapped):
    """A curve from parameter `first` to `last`, which may be outside of it."""

    curve: Curve
    first: float
    last: float

    def _own(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        return self.curve.polar(self._own(s))

    def direction(self, s: ArrayLike) -> Floats:
        return self.curve.direction(self._own(s))


def part_of(curve: Curve, first: float, last: float) -> Curve:
    """Return a curve from parameter `first` to `last`: an involute stays one."""
    if (first, last) == (0.0, 1.0):
        return curve
    if isinstance(curve, Involute):
        return replace(curve, first=float(curve.roll(first)), last=float(curve.roll(last)))
    if isinstance(curve, ParallelCurve):
        return replace(curve, curve=part_of(curve.curve, first, last))
    return PartOfCurve(curve, first, last)


@dataclass(frozen=True)
class Corner:
    """The point at `radius` (mm) and half tooth angle `angle` where two pieces meet; its direction turns between theirs."""

    radius: float
    angle: float
    first: float
    last: float
    kind: CurveKind

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        shape = np.shape(s)
        return np.full(shape, self.radius), np.full(shape, self.angle)

    def points(self, s: ArrayLike) -> Floats:
        radius, angle = self.polar(s)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)


@dataclass(frozen=True)
class ParallelCurve(_Wrapped):
    """The parallel of what a curve sweeps, `distance` (mm) out of the material (negative: into it).

    `twist` (rad/mm) is by how much the section turns along the axis. With t the direction of the curve at p, and m = p.t, the
    normal of the swept surface is (n, -+twist m) / w, w^2 = 1 + (twist m)^2. A step e along it ends at another height, from
    where the screw brings it back by the angle +-e twist^2 m / w. The direction in the section turns with that.
    """

    curve: Curve
    distance: float
    twist: float = 0.0
    internal: bool = False

    def _moved(self, s: ArrayLike) -> tuple[Floats, Floats, Floats]:
        """Return the points (..., 2) after the step, the angle by which the screw turns them, and the directions before."""
        heading = self.curve.direction(s)
        radius, angle = self.curve.polar(s)
        out = -1.0 if self.internal else 1.0
        gain = self.twist * radius * np.cos(angle - heading)
        step, size = out * self.distance, np.hypot(1.0, gain)
        x = radius * np.cos(angle) - step * np.sin(heading) / size
        y = radius * np.sin(angle) + step * np.cos(heading) / size
        return np.stack([x, y], -1), step * self.twist * gain / size, heading

    def polar(self, s: ArrayLike) -> tuple[Floats, Floats]:
        points, turn, _ = self._moved(s)
        x, y = np.moveaxis(points, -1, 0)
        return np.hypot(x, y), np.arctan2(y, x) + turn

    def direction(self, s: ArrayLike) -> Floats:
        _, turn, heading = self._moved(s)
        return heading + turn


def parallel_involute(flank: Involute, distance: float, twist: float) -> Involute:
    """Return the parallel of an involute, `distance` (mm) out of the tooth: turned by e/(r_b cos beta_b), moved along itself.

    The roll angle grows by e cos beta_b/r_b, and falls on an internal tooth.
    """
    cosine = 1 / math.hypot(1.0, twist * flank.base_radius)
    along = distance * cosine / flank.base_radius * (-1 if flank.internal else 1)
    half = flank.base_half_angle + distance / (flank.base_radius * cosine)
    return replace(flank, base_half_angle=half, first=flank.first + along, last=flank.last + along)


_STEPS = 40
_NEAR = 1e-13


def crossing(one: Curve, other: Curve) -> tuple[float, float]:
    """Return the parameters near the end of `one` and the beginning of `other` at which they, or what goes on from them, cross.

    Newton's method on the points. Raises CrossingFault where it does not settle.
    """
    a, b = 1.0, 0.0
    for _ in range(_STEPS):
        gap = one.points(a) - other.points(b)
        if math.hypot(*gap) < _NEAR * float(one.polar(a)[0]):
            return a, b
        columns = np.stack([_speed(one, a), -_speed(other, b)], -1)
        if abs(np.linalg.det(columns)) < 1e-300:
            break
        step = np.linalg.solve(columns, -gap)
        a, b = a + float(step[0]), b + float(step[1])
        if not (-1 < a < 3 and -2 < b < 2):
            break
    if math.hypot(*(one.points(a) - other.points(b))) < 1e-11:
        return a, b
    raise CrossingFault


def _speed(curve: Curve, s: float) -> Floats:
    step = 1e-6
    speed: Floats = (curve.points(s + step) - curve.points(s - step)) / (2 * step)
    return speed


def reaches(curve: Curve, radius: float) -> float:
    """Return the parameter at which a curve, or what goes on from its end, has a radius (mm). Raises CrossingFault."""
    start, end = (float(curve.polar(s)[0]) for s in (0.0, 1.0))
    way = math.copysign(1.0, end - start)

    def excess(s: float) -> float:
        return way * (float(curve.polar(s)[0]) - radius)

    high, step = 1.0, 0.125
    while excess(high) < 0:
        if way * (float(curve.polar(high + step)[0]) - float(curve.polar(high)[0])) <= 0 or high > 4:
            raise CrossingFault
        high += step
    if excess(0.0) >= 0:
        raise CrossingFault
    return root_between(excess, 0.0, high, xtol=1e-16, rtol=8.9e-16)


_PLACES = 257


def leaves(curve: Curve, flank: Involute) -> float:
    """Return the last parameter at which a fillet's piece is on an external involute, inside of it before and outside beyond.

    Raises CrossingFault where it is nowhere inside.
    """

    def excess(s: float) -> float:
        radius, half = curve.polar(s)
        return float(half) - float(flank.half_angle(max(float(radius), flank.base_radius)))

    places = 1 - np.linspace(1.0, 0.0, _PLACES) ** 2  # close together at the end
    inside = [s for s in places.tolist() if float(curve.polar(s)[0]) >= flank.base_radius and excess(s) < 0]
    if not inside or excess(1.0) < 0:
        raise CrossingFault
    return root_between(excess, max(inside), 1.0, xtol=1e-16, rtol=8.9e-16)


def runs_on(curve: Curve) -> bool:
    """Return whether a curve nowhere runs against its own direction, as a parallel does beyond the centre of curvature."""
    s = np.linspace(0.0, 1.0, _PLACES)
    way, heading = np.diff(curve.points(s), axis=0), curve.direction((s[1:] + s[:-1]) / 2)
    ahead = way[:, 0] * np.cos(heading) + way[:, 1] * np.sin(heading)
    return bool(np.all(ahead > 0)) or bool(np.all(np.hypot(*way.T) < 1e-15))
