"""Points moved onto the exact flanks, fillets and tip chamfers of a gear, as modified: those of all teeth at once."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.helix import height_in_half, section_turn
from gearcad.geometry.turned import FlankCurve

__all__ = ["ExactFlank"]

_SAMPLES = 513
"""Points of a curve among which the nearest one is where a search begins."""

_STEPS = 12
"""Newton's method takes three or four; a modification, which turns less than a part in a thousand, takes some more."""

_SAME = 1e-6
"""Points this close (mm) to the end of a curve, along it, are its end: so far may a boundary representation be off."""


@dataclass(frozen=True)
class ExactFlank:
    """A piece of the left, or right, flanks of all teeth of a gear, one surface a tooth. Its parameters are s along the curve,
    0 at the root, and z in mm.
    """

    gear: Gear
    curve: FlankCurve
    left: bool

    def points(self, s: Floats, z: Floats, teeth: Wholes) -> Floats:
        """Points (n, 3) of the surfaces of these teeth."""
        radius, angle = self.curve.curve.polar(s)
        angle = self._sign * angle + self._turn(s, z, teeth)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1)

    def nearest(self, points: Floats, teeth: Wholes) -> Floats:
        """Parameters (n,) of the points of the surfaces of these teeth that are nearest at the same height.

        Those of points at an end of the curve are 0 or 1 and nothing near it.
        """
        s = self._nearest_sample(points, teeth)
        for _ in range(_STEPS):
            off = self._unturned(points, s, teeth) - self.curve.curve.points(s)
            heading = self.curve.curve.direction(s)
            along = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
            s = np.clip(s + along / self._speed(s), 0.0, 1.0)
        length = self._speed(s)
        s = np.where(s * length < _SAME, 0.0, s)
        found: Floats = np.where((1 - s) * length < _SAME, 1.0, s)
        return found

    @property
    def _sign(self) -> int:
        return 1 if self.left else -1

    def _turn(self, s: Floats, z: Floats, teeth: Wholes) -> Floats:
        """Angles (rad) by which points of tooth 0 at z = 0 are turned into place."""
        own = self.curve.turn(self.gear.flank_form, s, height_in_half(self.gear, z), left=self.left)
        found: Floats = own + section_turn(self.gear, z) + 2 * math.pi / self.gear.tooth_count * teeth
        return found

    def _unturned(self, points: Floats, s: Floats, teeth: Wholes) -> Floats:
        """Points (n, 2) as they lie beside the curve, which is that of a left flank."""
        x, y, z = points.T
        turn = -self._turn(s, z, teeth)
        cosine, sine = np.cos(turn), np.sin(turn)
        return np.stack([x * cosine - y * sine, self._sign * (x * sine + y * cosine)], -1)

    @cached_property
    def _samples(self) -> tuple[Floats, Floats, Floats]:
        """Parameters (n,), the curve's points there (n, 2) and the length (mm) that one of its parameter is (n,)."""
        s = np.linspace(0.0, 1.0, _SAMPLES)
        points = self.curve.curve.points(s)
        slopes = np.gradient(points, s, axis=0)
        return s, points, np.hypot(*slopes.T)

    def _speed(self, s: Floats) -> Floats:
        parameters, _, speeds = self._samples
        return np.interp(s, parameters, speeds)

    def _nearest_sample(self, points: Floats, teeth: Wholes) -> Floats:
        from scipy.spatial import cKDTree

        parameters, samples, _ = self._samples
        middle = np.full(len(points), 0.5)
        _, nearest = cKDTree(samples).query(self._unturned(points, middle, teeth))
        found: Floats = parameters[nearest]
        return found
