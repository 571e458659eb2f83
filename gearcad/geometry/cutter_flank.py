"""Straight flank of a shaper cutter's protuberance, and the curve that it cuts into a gear or a ring.

The flank goes on from the tip corner in a straight line of the transverse section. Its normal has one direction, so the moment
of the normal about the cutter's axis falls in proportion to the way along it, and what it cuts is known in closed form.
Lengths in mm, angles in radians; magnitudes as in `ShaperTip`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats
from gearcad.geometry.fillets import ShaperTip
from gearcad.geometry.involute import involute_at_roll, root_between

_PLACES = 257
"""Places along the flank that are compared with the cutter's own flank."""

_HALVINGS = 60
"""Steps in which the place of a radius is bracketed: 2^-60 of the flank."""


@dataclass(frozen=True)
class CutterFlank:
    """The straight flank of the protuberance of a cutter whose corner is `tip`, a `way` (mm, radially) below the corner's end.

    `outside` (rad): by how much the involute that the corner touches stands out of the cutter's own flank, on its base circle.
    """

    tip: ShaperTip
    outside: float

    @cached_property
    def _start(self) -> tuple[float, float]:
        """End of the corner, radially and across from the cutter's axis, its middle on the radial line."""
        along, across = self.tip.corner(np.array(self.tip.corner_end))
        return float(along), float(across)

    @property
    def _angle(self) -> float:
        assert self.tip.protuberance_angle is not None
        return self.tip.protuberance_angle

    @cached_property
    def _slope(self) -> float:
        """Part of the flank's way that goes across, in the transverse section."""
        return math.tan(self._angle) / math.cos(self.tip.helix_angle)

    @cached_property
    def _normal(self) -> float:
        """Direction delta of its normal from the corner's radial line."""
        return math.pi / 2 - math.atan(self._slope)

    @cached_property
    def _foot(self) -> float:
        """Place (mm) of the flank along its normal, from the foot of the cutter's axis on that: one for the whole flank."""
        along, across = self._start
        return along * math.cos(self._normal) + across * math.sin(self._normal)

    def points(self, way: ArrayLike) -> tuple[Floats, Floats]:
        """Return points radially and across from the cutter's axis, the corner's middle on the radial line."""
        way = np.asarray(way, float)
        return self._start[0] - way, self._start[1] + way * self._slope

    def _moment(self, way: Floats) -> Floats:
        along, across = self.points(way)
        moment: Floats = along * math.sin(self._normal) - across * math.cos(self._normal)
        return moment

    # ------------------------------------------------------------------ its ends

    @cached_property
    def first(self) -> float:
        """Way (mm) from which on the normal comes through the pitch point."""
        if not self.tip.rolls:
            return 0.0
        start, rate = float(self._moment(np.array(0.0))), math.hypot(1.0, self._slope)
        return max((start - self.tip.working_radius) / rate, 0.0)

    @cached_property
    def last(self) -> float:
        """Way (mm) at which the flank meets the cutter's own, or the cutter's base circle where it does not."""
        deepest = max(self._start[0] - self.tip.base_radius, 0.0)
        places = np.linspace(0.0, deepest, _PLACES)
        met = np.flatnonzero(self._out(places) <= 0)
        if not len(met) or met[0] == 0:
            return deepest
        low, high = places[met[0] - 1], places[met[0]]
        return root_between(lambda way: float(self._out(np.array(way))), low, high, xtol=1e-15, rtol=8.9e-16)

    def _out(self, way: Floats) -> Floats:
        """Return the angle (rad) by which points of the flank stand out of the cutter's own."""
        along, across = self.points(way)
        base = self.tip.base_radius
        radius = np.maximum(np.hypot(along, across), base)
        own = self.tip.base_half_angle - self.outside - involute_at_roll(np.sqrt((radius - base) * (radius + base)) / base)
        angle: Floats = self.tip.middle_angle + np.arctan2(across, along) - own
        return angle

    # ------------------------------------------------------------------ what it cuts

    def _gamma(self, way: Floats) -> Floats:
        """Direction of the normal from the line of centres where a place cuts: sin gamma = h/r_w0."""
        return np.arcsin(np.clip(self._moment(way) / self.tip.working_radius, -1.0, 1.0))

    def cut(self, way: ArrayLike) -> tuple[Floats, Floats]:
        """Return the points that the flank cuts: radius (mm) and angle from the middle of the tooth space (rad)."""
        way, tip = np.asarray(way, float), self.tip
        if not tip.rolls:
            along, across = self.points(way)
            return np.hypot(along, across), tip.middle_angle + np.arctan2(across, along)
        gamma = self._gamma(way)
        reach = self._foot - tip.working_radius * np.cos(gamma)
        x, y = tip.pitch_radius + tip.side * reach * np.cos(gamma), reach * np.sin(gamma)
        return np.hypot(x, y), np.arctan2(y, x) - tip.share * self._turn(gamma)

    def direction(self, way: ArrayLike, half_pitch: float) -> Floats:
        """Return the direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""
        way, tip = np.asarray(way, float), self.tip
        if not tip.rolls:
            return np.full(way.shape, half_pitch - (self._normal + tip.middle_angle) - math.pi / 2)
        gamma = self._gamma(way)
        heading: Floats = half_pitch + tip.share * self._turn(gamma) - tip.side * gamma - math.pi / 2
        return heading

    def _turn(self, gamma: Floats) -> Floats:
        """Return the turn of the cutter (rad) where the normal has the direction gamma."""
        return gamma - self._normal - self.tip.middle_angle

    def way_at(self, radius: ArrayLike, first: float, last: float) -> Floats:
        """Return the ways (n,) between two that cut at radii (mm), which rise along the flank (fall on a ring)."""
        radius = np.atleast_1d(np.asarray(radius, float))
        low, high, side = np.full(radius.shape, first), np.full(radius.shape, last), -self.tip.side
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            below = side * self.cut(middle)[0] < side * radius
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        way: Floats = (low + high) / 2
        return way
