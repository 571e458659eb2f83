"""The layers of a triangulated tooth: how many there are, at which heights, and the screw that turns them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear
from gearcad.geometry.helix import twist
from gearcad.solids.facets.tolerance import HELIX_SHARE, aim_for, arc_step, outermost_radius

__all__ = ["Layers"]


_MARGIN = 20.0
"""Least stretch of a column beyond a cone, in chord errors: the corner where a relief begins is off the layers by no more."""


@dataclass(frozen=True)
class Layers:
    """Copies of the section between the ends, turned by `kappa` (rad/mm, signed) per height, over `width` (mm).

    `knots` are the heights (mm) of the layers that every column has, both ends first and last; `counts` the number of
    layers between them. A column that a cone cuts short of a knot has `margin` (mm) for the layers up to it. The section at
    z = 0 is turned by `start` (rad). An `apex` is an upper end where a mirror image goes on: no cone cuts columns short there.
    """

    kappa: float
    width: float
    knots: tuple[float, ...]
    counts: tuple[int, ...]
    margin: float = 0.0
    start: float = 0.0
    apex: bool = False

    @classmethod
    def of(cls, gear: Gear, chord_error: float) -> Layers:
        kappa = twist(gear)
        width = gear.face_width
        if not gear.modification.present:
            step = arc_step(outermost_radius(gear), HELIX_SHARE * chord_error if gear.internal else chord_error)
            count = max(1, math.ceil(abs(kappa) * width / step - 1e-9))
            return cls(kappa, width, (0.0, width), (count,))
        knots = (0.0, *gear.flank_form.height_breaks, width)
        aim = aim_for(gear, chord_error)
        counts = tuple(_count(gear, kappa, low, high, aim) for low, high in pairwise(knots))
        return cls(kappa, width, knots, counts, min(_MARGIN * chord_error, (width / 2 - gear.body.end_chamfer) / 4))

    def turn(self, z: Floats) -> Floats:
        """Angle (rad) by which the section at heights z (mm) is turned."""
        return self.start + self.kappa * z

    @property
    def count(self) -> int:
        """Number of stretches between layers over the whole width."""
        return sum(self.counts)

    def heights(self, setback: Floats) -> Floats:
        """Heights z (count + 1, n) in mm of the points whose columns stop short of the ends by `setback` (n,)."""
        above = 0.0 * setback if self.apex else setback
        if len(self.counts) == 1:
            share = np.linspace(0.0, 1.0, self.count + 1)[:, None]
            result: Floats = setback + share * (self.width - (setback + above))
            return result
        inner = np.array(self.knots[1:-1])[:, None]
        low, high = setback + self.margin, self.width - above - self.margin
        knots = [
            setback,
            *np.where(inner <= self.width / 2, np.maximum(inner, low), np.minimum(inner, high)),
            self.width - above,
        ]
        parts = [np.linspace(a, b, n, endpoint=False) for (a, b), n in zip(pairwise(knots), self.counts, strict=True)]
        return np.concatenate([*parts, knots[-1][None]])


def _count(gear: Gear, kappa: float, low: float, high: float, aim: float) -> int:
    """Layers between two heights (mm): so many that half of the bend of a modified flank along z would use up `aim` (mm).

    The other half is left to the bend of the profile, as both add up in a diagonal.
    """
    form, radius = gear.flank_form, outermost_radius(gear)
    ends, z = np.array([[form.first], [form.last]]), np.array([low, (low + high) / 2, high])
    depth = np.concatenate([form.depth(ends, z, left=left) for left in (True, False)])
    rise = np.abs(depth[:, 0] - 2 * depth[:, 1] + depth[:, 2]).max() / 2 * radius / form.base_radius
    sagitta = radius * (kappa * (high - low)) ** 2 / 8 + 2 * rise
    return max(1, math.ceil(math.sqrt(sagitta / aim) - 1e-9))
