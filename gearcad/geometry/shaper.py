"""The fillet that a pinion-type shaper cutter really cuts: the envelope of its tip's rounded corner, in the transverse section.

Bare equations, without any judgement on whether the cutter is feasible. Lengths in mm, angles in radians. The cutter is a
screw of the same lead as the gear, so the section is enough; there the corner, a circle in the normal section, is an ELLIPSE:
radial semi-axis rho, tangential rho/cos(beta). Radii, centre distance and numbers of teeth are magnitudes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats

__all__ = ["ShaperTip"]


@dataclass(frozen=True, kw_only=True)
class ShaperTip:
    """The rounded tip corner of a shaper cutter, set to cut one gear.

    `radius` of the corner (mm, normal section), `tip_radius` r_a0, `base_radius` r_b0 and `base_half_angle` psi_b0 (half tooth
    angle on the base circle) of the cutter, `centre_distance` a_0 (mm) from the gear's axis to the cutter's, `teeth` of gear
    and `cutter_teeth`. An `internal` gear may be its own counterpart: centre distance 0, nothing rolls, the corner is the
    fillet.
    The corner runs over theta = 0 (its outermost point) ... `last_angle` (where the cutter's involute begins).
    """

    radius: float
    tip_radius: float
    base_radius: float
    base_half_angle: float
    helix_angle: float
    centre_distance: float
    teeth: float
    cutter_teeth: float
    internal: bool

    # ------------------------------------------------------------------ the cutter

    @property
    def _stretch(self) -> float:
        """c = cos(beta): the corner is wider by 1/c."""
        return math.cos(self.helix_angle)

    @property
    def _middle_radius(self) -> float:
        """r_M, of the middle of the corner."""
        return self.tip_radius - self.radius

    def _corner(self, theta: Floats) -> tuple[Floats, Floats]:
        """Points of the corner, radially and across, from the cutter's axis with the corner's middle on the radial line."""
        return self._middle_radius + self.radius * np.cos(theta), self.radius / self._stretch * np.sin(theta)

    def outline(self, theta: ArrayLike) -> tuple[Floats, Floats]:
        """Points of the corner along and across the middle of the cutter's tooth, from the cutter's axis (mm)."""
        along, across = self._corner(np.asarray(theta, float))
        cosine, sine = math.cos(self.middle_angle), math.sin(self.middle_angle)
        return along * cosine - across * sine, along * sine + across * cosine

    def _normal(self, theta: Floats) -> Floats:
        """delta: direction of the normal of the corner, from that radial line."""
        return np.arctan2(self._stretch * np.sin(theta), np.cos(theta))

    def _moment(self, theta: Floats) -> Floats:
        """h: moment of the normal about the cutter's axis (mm)."""
        along, across = self._corner(theta)
        delta = self._normal(theta)
        moment: Floats = along * np.sin(delta) - across * np.cos(delta)
        return moment

    @cached_property
    def last_angle(self) -> float:
        """theta where the corner joins the cutter's involute: its normal touches the base circle, h = r_b0."""
        if self.radius == 0:
            # A sharp edge turns from the tip circle's normal to the involute's: sin delta = r_b0/r_a0.
            return math.atan2(self.base_radius, self._stretch * self._root_of(self.tip_radius))
        from scipy.optimize import brentq

        def excess(theta: float) -> float:
            return float(self._moment(np.array(theta))) - self.base_radius

        return float(brentq(excess, 0.0, math.pi / 2, xtol=1e-15, rtol=8.9e-16))

    def _root_of(self, radius: float) -> float:
        """Roll length of the cutter's involute at a radius (mm)."""
        return math.sqrt(max((radius - self.base_radius) * (radius + self.base_radius), 0.0))

    @property
    def feasible(self) -> bool:
        """Whether the corner reaches the cutter's involute: the middle of the corner lies beyond the base circle, nearly."""
        return float(self._moment(np.array(math.pi / 2))) > self.base_radius

    @cached_property
    def _join(self) -> tuple[float, float]:
        """Radius (mm) and angle from the corner's middle (rad) of the join, on the cutter."""
        along, across = self._corner(np.array(self.last_angle))
        return float(np.hypot(along, across)), float(np.arctan2(across, along))

    @cached_property
    def join_length(self) -> float:
        """t_F0: roll length of the cutter's involute at the join (mm)."""
        return self._root_of(self._join[0])

    @cached_property
    def middle_angle(self) -> float:
        """psi_M: half angle of the cutter's tooth at the middle of the corner; negative where the two corners overlap."""
        roll = self.join_length / self.base_radius
        return self.base_half_angle - (roll - math.atan(roll)) - self._join[1]

    # ------------------------------------------------------------------ what it cuts

    @property
    def _working_radius(self) -> float:
        """r_w0 = a_0 z_0/(|z| -+ z_0)."""
        sign = -1 if self.internal else 1
        return self.centre_distance * self.cutter_teeth / (self.teeth + sign * self.cutter_teeth)

    @property
    def rolls(self) -> bool:
        """Whether the cutter rolls with the gear; it does not where it is the gear's own counterpart."""
        return self.centre_distance > 0

    @property
    def share(self) -> float:
        """z_0/|z|: how far the gear turns when the cutter does."""
        return self.cutter_teeth / self.teeth

    def turns(self, theta: ArrayLike) -> tuple[Floats, Floats]:
        """Direction gamma of the normal in space, from the line of centres, and turn phi of the cutter where theta cuts (rad).

        The normal passes through the pitch point: sin gamma = h/r_w0.
        """
        theta = np.asarray(theta, float)
        delta = self._normal(theta)
        if not self.rolls:
            return delta + self.middle_angle, np.zeros_like(theta)
        gamma = np.arcsin(self._moment(theta) / self._working_radius)
        return gamma, gamma - delta - self.middle_angle

    def cut(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Points that the corner cuts: radius (mm) and angle from the middle of the tooth space (rad)."""
        theta = np.asarray(theta, float)
        return self.seen(*self.outline(theta), self.turns(theta)[1])

    def seen(self, along: ArrayLike, across: ArrayLike, turn: ArrayLike) -> tuple[Any, Any]:
        """Points of the cutter (mm) where it has turned by `turn` (rad), seen from the gear that turned with it.

        Radius (mm) and angle from the middle of the tooth space (rad). `along` and `across` are from the cutter's axis, its
        tooth centred on the first.
        """
        along, across, turn = np.asarray(along), np.asarray(across), np.asarray(turn)
        x, y = along * np.cos(turn) - across * np.sin(turn), along * np.sin(turn) + across * np.cos(turn)
        x = self.centre_distance + x if self.internal else self.centre_distance - x
        return np.hypot(x, y), np.arctan2(y, x) - turn * self.share

    def direction(self, theta: ArrayLike, half_pitch: float) -> Floats:
        """Direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""
        theta = np.asarray(theta, float)
        gamma, turn = self.turns(theta)
        if self.internal:
            return half_pitch - (gamma - turn * self.share) - math.pi / 2
        return half_pitch + turn * self.share - math.pi / 2 + gamma

    # ------------------------------------------------------------------ where it ends

    def form_radius(self, base_radius: float, sine: float) -> float:
        """Radius (mm) of the root form circle where nothing is undercut: sqrt(r_b^2 + (a_0 sin a_w0 +- t_F0)^2).

        `base_radius` (mm) of the gear; `sine` of the transverse pressure angle is that of a rack's rolling, not needed here.
        """
        return math.hypot(base_radius, self._reach(base_radius))

    def _reach(self, base_radius: float) -> float:
        """Roll length (mm) on the gear where the join cuts; negative where it would be beyond the base circle."""
        if self.internal:
            whole = math.sqrt(max(self.centre_distance**2 - (base_radius - self.base_radius) ** 2, 0.0))
            return whole + self.join_length
        whole = math.sqrt(max(self.centre_distance**2 - (base_radius + self.base_radius) ** 2, 0.0))
        return whole - self.join_length

    def undercuts(self, base_radius: float, sine: float) -> bool:
        """Whether the corner cuts away part of an involute with this base radius (mm); that of a ring it never does."""
        return not self.internal and self._reach(base_radius) < 0

    def theta_at(self, radius: ArrayLike, last: float) -> Floats:
        """Inverse of `cut`: theta in [0, last] that cuts at `radius` (mm).

        The radius runs one way along the fillet; from the root circle on it goes with theta squared, so halving and Newton's
        rule work on the root of the way that is left.
        """
        radius = np.atleast_1d(np.asarray(radius, float))
        root = float(self.cut(0.0)[0])
        goal = np.sqrt(np.maximum(np.abs(radius - root), 0.0))
        low, high = np.zeros_like(goal), np.full_like(goal, last)
        theta = np.clip(goal / max(math.sqrt(abs(float(self.cut(last)[0]) - root)), 1e-300), 0, 1) * last
        for _ in range(80):
            value = np.sqrt(np.abs(self.cut(theta)[0] - root))
            ahead = np.sqrt(np.abs(self.cut(theta + 1e-7 * last)[0] - root))
            slope = (ahead - value) / (1e-7 * last)
            miss = value - goal
            low, high = np.where(miss < 0, theta, low), np.where(miss > 0, theta, high)
            trial = theta - miss / np.where(slope > 0, slope, 1.0)
            inside = (slope > 0) & (trial >= low) & (trial <= high)
            new = np.where(miss == 0, theta, np.where(inside, trial, 0.5 * (low + high)))
            done = bool(np.all(np.abs(new - theta) <= 4e-16 * last))
            theta = new
            if done:
                break
        return theta
