"""The outline of one tooth as Bezier pieces and arcs, counter-clockwise, ready to be swept into faces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry.curves import Curve, CurveKind, Land
from gearcad.geometry.gear import Gear
from gearcad.solids import bezier

__all__ = ["Arc", "Piece", "Span", "accuracy_for", "parameter_at_radius", "tooth_outline"]

Floats = NDArray[np.float64]

_SPLIT_DEGREE = 14
"""A curve that needs a higher degree is halved instead: cheaper to evaluate, and better conditioned."""


def accuracy_for(gear: Gear) -> float:
    """Largest deviation (mm) allowed to a fitted section: 1 nm, and less on gears so small that 0.1 ppm of volume shows."""
    return min(1e-6, 2e-7 * gear.normal_module)


@dataclass(frozen=True)
class Span:
    """One Bezier piece of a flank: `poles` (n + 1, 2) in mm run counter-clockwise, u in [0, 1] along them."""

    poles: Floats

    def polar(self, u: Floats) -> tuple[Floats, Floats]:
        """Radius (mm) and polar angle (rad) at u (n,)."""
        x, y = (bezier.bernstein(len(self.poles) - 1, u) @ self.poles).T
        return np.hypot(x, y), np.arctan2(y, x)

    @property
    def radii(self) -> tuple[float, float]:
        """Radius (mm) at u = 0 and u = 1."""
        start, end = np.hypot(*self.poles[[0, -1]].T)
        return float(start), float(end)


@dataclass(frozen=True)
class Arc:
    """A land: arc of `radius` (mm) about the axis between two polar angles (rad), counter-clockwise."""

    radius: float
    first: float
    last: float

    @property
    def radii(self) -> tuple[float, float]:
        return self.radius, self.radius


Piece = Span | Arc


def tooth_outline(gear: Gear) -> tuple[Piece, ...]:
    """Pieces of tooth 0 (centred on +x) from its right root to the next tooth's: right flank, tip, left flank, root land.

    Neighbouring pieces share their end points exactly.
    """
    curves = gear.profile.curves
    tolerance = accuracy_for(gear)
    flank = [piece for curve in curves if not isinstance(curve, Land) for piece in _fitted(curve, 0.0, 1.0, tolerance)]
    _join(flank)
    if curves[0].kind is not CurveKind.ROOT:
        middle = math.pi / gear.teeth
        flank[0][0] = gear.root_diameter / 2 * np.array([math.cos(middle), math.sin(middle)])
    right = [Span(poles * [1, -1]) for poles in flank]
    left = [Span(poles[::-1]) for poles in reversed(flank)]
    tip = right[-1].poles[-1]
    half = -math.atan2(tip[1], tip[0])
    pieces: list[Piece] = [*right, Arc(gear.tip_diameter / 2, -half, half), *left]
    if isinstance(curves[0], Land) and curves[0].kind is CurveKind.ROOT:
        start = float(curves[0].last)
        pieces.append(Arc(gear.root_diameter / 2, start, 2 * math.pi / gear.teeth - start))
    return tuple(pieces)


def _fitted(curve: Curve, first: float, last: float, tolerance: float) -> list[Floats]:
    """Bezier poles of curve on [first, last], halved until the degree is moderate."""

    def points(t: Floats) -> Floats:
        return curve.points(first + t * (last - first))

    def deviation(values: Floats, t: Floats) -> Floats:
        s = first + t * (last - first)
        off, heading = values - curve.points(s), curve.direction(s)
        return np.asarray(np.abs(off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)))

    least = 1 if curve.kind is CurveKind.CHAMFER else 2
    poles = bezier.fit(points, deviation, tolerance, least=least, most=_SPLIT_DEGREE)
    if poles is not None:
        return [poles]
    middle = (first + last) / 2
    return _fitted(curve, first, middle, tolerance) + _fitted(curve, middle, last, tolerance)


def _join(flank: list[Floats]) -> None:
    """Make the shared ends of neighbouring pieces the same numbers (they agree to rounding already)."""
    for before, after in pairwise(flank):
        before[-1] = after[0]


def parameter_at_radius(span: Span, radius: float) -> float:
    """u at which a span crosses `radius` (mm); the radius is monotone along every piece of a flank."""
    low, high = (0.0, 1.0) if span.radii[0] < span.radii[1] else (1.0, 0.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        if float(span.polar(np.array([middle]))[0][0]) < radius:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
