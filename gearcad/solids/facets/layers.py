"""The layers of a triangulated tooth: the screw that carries them, the cones that cut them short, and how many there are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear
from gearcad.geometry.helix import twist

__all__ = ["EndCone", "Screw", "aim_for", "arc_step", "least_distance"]


_CONVEX = 0.75
"""Share of the chord error for the edges on modified flanks: a triangle on a convex place deviates up to 4/3 as much inside."""

_MARGIN = 20.0
"""Least stretch of a column beyond a cone, in chord errors: the corner where a relief begins is off the layers by no more."""


def arc_step(radius: float, chord_error: float) -> float:
    """Largest angle (rad) that a chord of a circle may span within `chord_error` (mm)."""
    return 2 * math.acos(max(1 - chord_error / radius, 0.5))


def least_distance(gear: Gear, chord_error: float) -> float:
    """Distance (mm) below which two points are made one: nothing against the chord error, or two steps of a float32."""
    return max(1e-3 * chord_error, 3e-7 * gear.tip_diameter / 2)


def aim_for(gear: Gear, chord_error: float) -> float:
    """Largest deviation (mm) of an edge that keeps a gear's triangles within `chord_error` (mm)."""
    return _CONVEX * chord_error if gear.modification.present else chord_error


@dataclass(frozen=True)
class EndCone:
    """The chamfer cone on both ends of the tip cylinder: `slope` is the tangent of its angle to the axis.

    `face_radius` (mm) is where the cone meets the end plane, infinite without a chamfer.
    """

    face_radius: float
    slope: float

    @classmethod
    def of(cls, gear: Gear) -> EndCone:
        slope = math.tan(math.radians(gear.body.end_chamfer_angle))
        if not gear.body.end_chamfer:
            return cls(math.inf, slope)
        return cls(gear.tip_diameter / 2 - gear.body.end_chamfer * slope, slope)

    @property
    def present(self) -> bool:
        return math.isfinite(self.face_radius)

    def setback(self, radius: Floats) -> Floats:
        """Axial distance (mm) of the surface from the end plane at `radius` (mm)."""
        result: Floats = np.maximum((radius - self.face_radius) / self.slope, 0.0)
        return result


@dataclass(frozen=True)
class Screw:
    """The motion that sweeps the section: turn per height `kappa` (rad/mm, signed) over `width` (mm).

    `knots` are the heights (mm) of the layers that every column has, both ends first and last; `counts` the number of
    layers between them. A column that a cone cuts short of a knot has `margin` (mm) for the layers up to it.
    """

    kappa: float
    width: float
    knots: tuple[float, ...]
    counts: tuple[int, ...]
    margin: float = 0.0

    @classmethod
    def of(cls, gear: Gear, chord_error: float) -> Screw:
        kappa = twist(gear)
        width = gear.face_width
        if not gear.modification.present:
            step = arc_step(gear.tip_diameter / 2, chord_error)
            layers = max(1, math.ceil(abs(kappa) * width / step - 1e-9))
            return cls(kappa, width, (0.0, width), (layers,))
        knots = (0.0, *gear.flank_form.height_breaks, width)
        aim = aim_for(gear, chord_error)
        counts = tuple(_layers(gear, kappa, low, high, aim) for low, high in pairwise(knots))
        return cls(kappa, width, knots, counts, min(_MARGIN * chord_error, (width / 2 - gear.body.end_chamfer) / 4))

    @property
    def layers(self) -> int:
        return sum(self.counts)

    def heights(self, setback: Floats) -> Floats:
        """Heights z (layers + 1, n) in mm of the points whose columns stop short of both ends by `setback` (n,)."""
        if len(self.counts) == 1:
            share = np.linspace(0.0, 1.0, self.layers + 1)[:, None]
            result: Floats = setback + share * (self.width - 2 * setback)
            return result
        inner = np.array(self.knots[1:-1])[:, None]
        low, high = setback + self.margin, self.width - setback - self.margin
        knots = [
            setback,
            *np.where(inner <= self.width / 2, np.maximum(inner, low), np.minimum(inner, high)),
            self.width - setback,
        ]
        parts = [np.linspace(a, b, n, endpoint=False) for (a, b), n in zip(pairwise(knots), self.counts, strict=True)]
        return np.concatenate([*parts, knots[-1][None]])


def _layers(gear: Gear, kappa: float, low: float, high: float, aim: float) -> int:
    """Layers between two heights (mm): so many that half of the bend of a modified flank along z would use up `aim` (mm).

    The other half is left to the bend of the profile, as both add up in a diagonal.
    """
    form, radius = gear.flank_form, gear.tip_diameter / 2
    ends, z = np.array([[form.first], [form.last]]), np.array([low, (low + high) / 2, high])
    depth = np.concatenate([form.depth(ends, z, left=left) for left in (True, False)])
    rise = np.abs(depth[:, 0] - 2 * depth[:, 1] + depth[:, 2]).max() / 2 * radius / form.base_radius
    sagitta = radius * (kappa * (high - low)) ** 2 / 8 + 2 * rise
    return max(1, math.ceil(math.sqrt(sagitta / aim) - 1e-9))
