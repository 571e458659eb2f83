"""The outline of one tooth as Bezier pieces and arcs, counter-clockwise, ready to be swept into faces."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.curves import Curve, CurveKind, Land
from gearcad.geometry.gear import Gear
from gearcad.geometry.modification import FlankForm
from gearcad.geometry.turned import FlankCurve, flank_curves
from gearcad.solids.exact import bezier

__all__ = ["FlankSpan", "LandArc", "Piece", "accuracy_for", "parameter_at_radius", "tooth_outline"]

Error = Callable[[Floats, Floats], Floats]

_SPLIT_DEGREE = 14
"""A curve that needs a higher degree is halved instead: cheaper to evaluate, and better conditioned."""

_SAME = 1e-7
"""Radii (mm) closer than this are the same for the kernel."""


def accuracy_for(gear: Gear) -> float:
    """Largest deviation (mm) allowed to a fitted section: 1 nm, and less on gears so small that 0.1 ppm of volume shows."""
    return min(1e-6, 2e-7 * gear.normal_module)


@dataclass(frozen=True, eq=False)
class FlankSpan:
    """One Bezier piece of a flank: `poles` (n + 1, 2) in mm run counter-clockwise, u in [0, 1] along them.

    It is `curve` from the parameter `first` at u = 0 to `last` at u = 1, on the left or right flank.
    """

    poles: Floats
    curve: FlankCurve
    first: float
    last: float
    left: bool

    def polar(self, u: Floats) -> tuple[Floats, Floats]:
        """Radius (mm) and polar angle (rad) at u (n,)."""
        x, y = (bezier.bernstein(len(self.poles) - 1, u) @ self.poles).T
        return np.hypot(x, y), np.arctan2(y, x)

    def turn(self, form: FlankForm, u: Floats, z: Floats) -> Floats:
        """Angle (rad) by which the modifications turn the point at u at height z (mm); u and z broadcast."""
        return self.curve.turn(form, self.first + u * (self.last - self.first), z, left=self.left)

    @property
    def start(self) -> tuple[float, float]:
        """Radius (mm) and polar angle (rad) at u = 0."""
        x, y = self.poles[0]
        return math.hypot(x, y), math.atan2(y, x)

    @property
    def radii(self) -> tuple[float, float]:
        """Radius (mm) at u = 0 and u = 1."""
        start, end = np.hypot(*self.poles[[0, -1]].T)
        return float(start), float(end)


@dataclass(frozen=True)
class LandArc:
    """A land: arc of `radius` (mm) about the axis between two polar angles (rad), counter-clockwise."""

    radius: float
    first: float
    last: float

    @property
    def start(self) -> tuple[float, float]:
        """Radius (mm) and polar angle (rad)."""
        return self.radius, self.first


Piece = FlankSpan | LandArc


def tooth_outline(gear: Gear, cuts: Sequence[float] = ()) -> tuple[Piece, ...]:
    """Pieces of tooth 0 (centred on +x) from its right root to the next tooth's: right flank, tip, left flank, root land.

    Neighbouring pieces share their end points exactly. They are those of the exact profile, before any modification, but
    end where its depth is not smooth, and at the radii `cuts` (mm).
    """
    curves = gear.profile.curves
    fitted = _fitted_throughout if gear.modification.present else _fitted
    flank = [
        piece
        for curve in flank_curves(gear)
        for first, last in pairwise(_cut(curve.curve, cuts))
        for piece in fitted(curve, first, last, accuracy_for(gear))
    ]
    _join([piece.poles for piece in flank])
    half_pitch, root = math.pi / gear.tooth_count, gear.profile.root_diameter / 2
    if curves[0].kind is not CurveKind.ROOT:
        flank[0].poles[0] = root * np.array([math.cos(half_pitch), math.sin(half_pitch)])
    right = [replace(piece, poles=piece.poles * [1, -1], left=False) for piece in flank]
    left = [replace(piece, poles=piece.poles[::-1], first=piece.last, last=piece.first) for piece in reversed(flank)]
    tip = right[-1].poles[-1]
    half = -math.atan2(tip[1], tip[0])
    pieces: list[Piece] = [*right, LandArc(gear.profile.tip_diameter / 2, -half, half), *left]
    if isinstance(curves[0], Land) and curves[0].kind is CurveKind.ROOT:
        start = float(curves[0].last)
        pieces.append(LandArc(root, start, 2 * half_pitch - start))
    return tuple(pieces)


def _cut(curve: Curve, radii: Sequence[float]) -> list[float]:
    """Parameters from 0 to 1, with those between where a curve crosses one of the radii (mm)."""
    start, end = (float(curve.polar(s)[0]) for s in (0.0, 1.0))
    side = 1 if start < end else -1  # the radii of a ring's flank fall
    inside, last = list[float](), side * start
    for cut in sorted(side * radius for radius in radii):
        if last + _SAME < cut < side * end - _SAME:
            inside.append(cut)
            last = cut
    return [0.0, *(_crossing(lambda s: side * float(curve.polar(s)[0]), cut, 0.0, 1.0) for cut in inside), 1.0]


def _fitted(curve: FlankCurve, first: float, last: float, tolerance: float) -> list[FlankSpan]:
    """Spans of a curve of the left flank on [first, last], root to tip, within `tolerance` (mm) along the normal."""

    def deviation(values: Floats, s: Floats) -> Floats:
        off, heading = values - curve.curve.points(s), curve.curve.direction(s)
        return np.asarray(np.abs(off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)))

    return _halved(curve, first, last, deviation, tolerance)


def _fitted_throughout(curve: FlankCurve, first: float, last: float, tolerance: float) -> list[FlankSpan]:
    """The same within a quarter of it and along the curve too: modifications turn a point by what its parameter says."""

    def deviation(values: Floats, s: Floats) -> Floats:
        return np.asarray(np.hypot(*(values - curve.curve.points(s)).T))

    return _halved(curve, first, last, deviation, 0.25 * tolerance)


def _halved(curve: FlankCurve, first: float, last: float, deviation: Error, tolerance: float) -> list[FlankSpan]:
    """The span of a curve on [first, last], or those of its halves, until the degree is moderate."""

    def parameter(t: Floats) -> Floats:
        return first + t * (last - first)

    poles = bezier.fit(
        lambda t: curve.curve.points(parameter(t)),
        lambda values, t: deviation(values, parameter(t)),
        tolerance,
        least=1 if curve.curve.kind is CurveKind.CHAMFER else 2,
        most=_SPLIT_DEGREE,
    )
    if poles is not None:
        return [FlankSpan(poles, curve, first, last, left=True)]
    middle = (first + last) / 2
    halves = (first, middle), (middle, last)
    return [span for half in halves for span in _halved(curve, *half, deviation, tolerance)]


def _join(flank: list[Floats]) -> None:
    """Make the shared ends of neighbouring pieces the same numbers (they agree to rounding already)."""
    for before, after in pairwise(flank):
        before[-1] = after[0]


def parameter_at_radius(span: FlankSpan, radius: float) -> float:
    """u at which a span crosses `radius` (mm); the radius is monotone along every piece of a flank."""
    low, high = (0.0, 1.0) if span.radii[0] < span.radii[1] else (1.0, 0.0)
    return _crossing(lambda u: float(span.polar(np.array([u]))[0][0]), radius, low, high)


def _crossing(rising: Callable[[float], float], value: float, low: float, high: float) -> float:
    """Where a function that rises from `low` to `high` has a value."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        if rising(middle) < value:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
