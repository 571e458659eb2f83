"""Fillets that a rack with a rounded tip and a pinion-type shaper cutter really cut, in the transverse section.

Bare equations, without any judgement on whether the tool is feasible. Lengths in mm, angles in radians (these are the
locals of a formula, shared between the profile and its tests). The tool is described in the normal section: u along
the rolling line from the centre of the tool's tooth, v away from the gear's axis. In the transverse section u is
stretched by 1/cos(beta), so the tip CIRCLE of the tool becomes an ELLIPSE there.

Bare equations, without any judgement on whether the cutter is feasible. Lengths in mm, angles in radians. The cutter is a
screw of the same lead as the gear, so the section is enough; there the corner, a circle in the normal section, is an ELLIPSE:
radial semi-axis rho, tangential rho/cos(beta). Radii, centre distance and numbers of teeth are magnitudes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.core.records import Floats
from gearcad.geometry.involute import root_between, where_root_is


class FilletTool(Protocol):
    """The rounded tip of what cuts the fillets of a gear, from theta = 0 on the root circle to `last_angle` at the flank."""

    @property
    def last_angle(self) -> float: ...

    def cut(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Return the points that the tip cuts: radius (mm) and angle from the middle of the tooth space (rad)."""

    def direction(self, theta: ArrayLike, half_pitch: float) -> NDArray[np.float64]:
        """Return the direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""

    def theta_at(self, radius: ArrayLike, last: float) -> NDArray[np.float64]:
        """theta in [0, last] that cuts at a radius (mm), to machine precision."""

    def undercuts(self, base_radius: float, sine: float) -> bool:
        """Return whether part of the involute is cut away; base radius in mm, `sine` of the transverse pressure angle."""

    def form_radius(self, base_radius: float, sine: float) -> float:
        """Return the radius (mm) of the root form circle where nothing is undercut."""


class ProtuberanceCut(NamedTuple):
    """Involute that the flank of a protuberance cuts: base radius (mm), half tooth angle there, rolls (rad) of its ends.

    The first roll is negative where the end of the tip arc is too deep to touch it.
    """

    base_radius: float
    base_half_angle: float
    first: float
    last: float


@dataclass(frozen=True, kw_only=True)
class ToolTip:
    """The rounded tip corner of a hob or rack, set to cut one gear.

    `radius` of the tip (mm, normal section), `u` and `v` of its centre (mm), `pressure_angle` (normal) and
    `helix_angle` in radians, `reference_radius` r of the gear (mm). The tip arc runs over
    theta = 0 (its deepest point) ... `last_angle` (where the straight flank begins). With a `protuberance` (mm) the arc stands
    out of the flank by it, and runs on to a straight flank at `protuberance_angle` (rad).
    """

    radius: float
    u: float
    v: float
    pressure_angle: float
    helix_angle: float
    reference_radius: float
    protuberance: float = 0.0
    protuberance_angle: float | None = None

    @classmethod
    def cutting(
        cls,
        *,
        normal_module: float,
        pressure_angle: float,
        helix_angle: float,
        reference_radius: float,
        depth: float,
        shift: float,
        radius: float,
        thinning: float,
    ) -> ToolTip:
        """Return the tip of a tool that reaches `depth` (mm) below the reference circle with the profile shift `shift` (mm).

        u_c = pi m_n/4 + t/2 - x m_n tan a_n - (e - rho) tan a_n - rho/cos a_n,  v_c = -(e - rho);  e = depth.
        """
        tangent, cosine = math.tan(pressure_angle), math.cos(pressure_angle)
        u = math.pi * normal_module / 4 + thinning / 2 - shift * tangent - (depth - radius) * tangent - radius / cosine
        return cls(
            radius=radius,
            u=u,
            v=radius - depth,
            pressure_angle=pressure_angle,
            helix_angle=helix_angle,
            reference_radius=reference_radius,
        )

    @property
    def last_angle(self) -> float:
        """theta where the tip arc ends: at the straight flank, pi/2 - a_n, or that of the protuberance, pi/2 - a_pr."""
        return math.pi / 2 - (self.pressure_angle if self.protuberance_angle is None else self.protuberance_angle)

    @property
    def tangent_angle(self) -> float:
        """theta where the tip arc is farthest out across the flank: pi/2 - a_n."""
        return math.pi / 2 - self.pressure_angle

    @cached_property
    def sine(self) -> float:
        """Sine of the transverse pressure angle of the tool."""
        return math.sin(math.atan(math.tan(self.pressure_angle) / math.cos(self.helix_angle)))

    def flank_at(self, v: float) -> float:
        """Return u (mm) of the straight flank at a height v (mm): the tip arc stands out of it by the protuberance."""
        angle = self.pressure_angle
        touched = self.u + self.radius * math.cos(angle) + (v - self.v + self.radius * math.sin(angle)) * math.tan(angle)
        return touched - self.protuberance / math.cos(angle)

    def protuberance_flank(self, half_pitch: float) -> ProtuberanceCut | None:
        """Return what the straight flank of the protuberance cuts: an involute of the base radius r cos a_pr,t.

        It begins at the end of the tip arc and ends where it meets the tool's flank. None where all of it lies too deep to cut.
        `half_pitch` of the gear in radians.
        """
        if self.protuberance_angle is None:
            return None
        angle, cosine, r = self.protuberance_angle, math.cos(self.helix_angle), self.reference_radius
        u, v = self.u + self.radius * math.cos(angle), self.v - self.radius * math.sin(angle)
        own, slope = math.tan(self.pressure_angle), math.tan(angle)
        end = (u - v * slope - self.flank_at(0.0)) / (own - slope)
        transverse = math.atan(slope / cosine)
        sine, base = math.sin(transverse), r * math.cos(transverse)

        def roll_length(depth: float) -> float:
            return r * sine + depth / sine

        if roll_length(end) <= 0:
            return None
        half_angle = half_pitch - (u - v * slope) / (cosine * r) + math.tan(transverse) - transverse
        return ProtuberanceCut(base, half_angle, roll_length(v) / base, roll_length(end) / base)

    @property
    def flank_depth(self) -> float:
        """Depth h = e - rho (1 - sin a_n) below the reference circle that the straight flank of the tool reaches (mm)."""
        return -self.v + self.radius * math.sin(self.pressure_angle)

    def outline(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Tip arc in the transverse section at zero roll: xi along the rolling line, eta from it (mm)."""
        theta = np.asarray(theta, float)
        xi = (self.u + self.radius * np.sin(theta)) / math.cos(self.helix_angle)
        return xi, self.v - self.radius * np.cos(theta)

    def roll(self, theta: ArrayLike) -> Any:
        """Return the roll angle of the gear (rad) at which the tool point theta cuts: phi = (X - xi)/r."""
        theta = np.asarray(theta, float)
        xi, eta = self.outline(theta)
        return (-eta * np.tan(theta) * math.cos(self.helix_angle) - xi) / self.reference_radius

    def cut(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Return the points that the tip arc cuts: radius (mm) and angle from the middle of the tooth space (rad)."""
        theta = np.asarray(theta, float)
        _, eta = self.outline(theta)
        across = -eta * np.tan(theta) * math.cos(self.helix_angle)
        along = self.reference_radius + eta
        return np.hypot(across, along), np.arctan2(across, along) - self.roll(theta)

    def direction(self, theta: ArrayLike, half_pitch: float) -> NDArray[np.float64]:
        """Return the direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""
        theta = np.asarray(theta, float)
        slope: NDArray[np.float64] = np.arctan(np.tan(theta) * math.cos(self.helix_angle))
        return half_pitch + np.asarray(self.roll(theta)) - np.pi / 2 + slope

    def undercuts(self, base_radius: float, sine: float) -> bool:
        """Return whether the tip cuts away part of the involute: h > r sin^2 alpha_t;
        `sine` of the transverse pressure angle.
        """
        return self.flank_depth > self.reference_radius * sine**2

    def form_radius(self, base_radius: float, sine: float) -> float:
        """Return the radius (mm) of the root form circle where nothing is undercut; base radius in mm, `sine` of alpha_t."""
        roll_length = self.reference_radius * sine - self.flank_depth / sine
        return math.hypot(base_radius, roll_length)

    def theta_at(self, radius: ArrayLike, last: float) -> NDArray[np.float64]:
        """Inverse of `cut`: theta in [0, last] that cuts at `radius` (mm), to machine precision.

        Solves F(theta) = R^2 - r_f^2 without cancellation, F = X^2 + 2 rho sin^2(theta/2) (2 r + eta + eta_0), by Newton
        on sqrt(F), which is nearly linear, kept inside a shrinking bracket.
        """
        r, bottom = self.reference_radius, self.v - self.radius
        radius = np.atleast_1d(np.asarray(radius, float))
        goal = np.sqrt(np.maximum((radius - (r + bottom)) * (radius + (r + bottom)), 0.0))
        cosine = math.cos(self.helix_angle)

        def root_of_f(theta: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
            c, s = np.cos(theta), np.sin(theta)
            tangent = s / c
            eta = self.v - self.radius * c
            across = -eta * tangent * cosine
            f = across**2 + 2 * self.radius * np.sin(theta / 2) ** 2 * (2 * r + eta + bottom)
            slope = eta**2 * tangent / c**2 * cosine**2 + self.radius * s * (r + eta + cosine**2 * eta * tangent**2)
            return np.sqrt(f), slope

        return where_root_is(goal, last, root_of_f)


_ROUNDING = 1e-12
"""Resolution of theta, as a share of the corner, which is above rounding; the error left after a Newton step of this size is
far below it.
"""


class _Normal(NamedTuple):
    """The normal of the corner: its direction delta from the middle's radial line (rad), and length |p'|/rho of the tangent.

    `moment` h about the cutter's axis and `short`, how much nearer that axis' foot on it the point is than the tip (mm).
    """

    delta: Floats
    stretch: Floats
    moment: Floats
    short: Floats


class _Contact(NamedTuple):
    """Points at which the corner cuts: its normal, of direction gamma in space from the line of centres, at a turn phi of the
    cutter.

    `reach` l along the normal from the pitch point to the point, and its `rise` since theta = 0 (mm).
    """

    normal: _Normal
    gamma: Floats
    turn: Floats
    rise: Floats
    reach: Floats


@dataclass(frozen=True, kw_only=True)
class ShaperTip:
    """The rounded tip corner of a shaper cutter, set to cut one gear.

    `radius` rho of the corner (mm, normal section), `base_radius` r_b0 and `base_half_angle` psi_b0 (half tooth angle on the
    base circle) of the cutter, `centre_distance` a_0 (mm) from the gear's axis to the cutter's, `root_radius` r_f (mm) of the
    gear, `teeth` of gear and `cutter_teeth`. An `internal` gear may be its own counterpart: centre distance 0, nothing rolls,
    the corner is the fillet.
    The corner runs over theta = 0 (its outermost point) ... `last_angle` (where the cutter's involute begins). With a
    `protuberance_angle` (rad, to the radial line through the middle of the corner) the involute that the corner touches stands
    out of the cutter's flank, and the corner runs on to the straight flank of the protuberance.
    """

    radius: float
    base_radius: float
    base_half_angle: float
    helix_angle: float
    centre_distance: float
    root_radius: float
    teeth: float
    cutter_teeth: float
    internal: bool
    protuberance_angle: float | None = None

    # ------------------------------------------------------------------ the cutter

    @cached_property
    def tip_radius(self) -> float:
        """Tip radius r_a0 (mm) of the cutter, which reaches the root circle."""
        return abs(self.root_radius - self.centre_distance)

    @cached_property
    def _c(self) -> float:
        """Cosine of the helix angle, c = cos(beta): the corner is wider by 1/c."""
        return math.cos(self.helix_angle)

    @property
    def _middle_radius(self) -> float:
        """Radius r_M of the middle of the corner."""
        return self.tip_radius - self.radius

    def corner(self, theta: Floats) -> tuple[Floats, Floats]:
        """Return the points of the corner, radially and across, from the cutter's axis with the corner's middle on the radial
        line.
        """
        return self._middle_radius + self.radius * np.cos(theta), self.radius / self._c * np.sin(theta)

    def outline(self, theta: ArrayLike) -> tuple[Floats, Floats]:
        """Return the points of the corner along and across the middle of the cutter's tooth, from the cutter's axis (mm)."""
        along, across = self.corner(np.asarray(theta, float))
        cosine, sine = math.cos(self.middle_angle), math.sin(self.middle_angle)
        return along * cosine - across * sine, along * sine + across * cosine

    def _normal(self, theta: Floats) -> _Normal:
        """h = r_M sin delta - rho (1 - c^2)/(c D) sin theta cos theta, D the stretch.

        The point's place along the normal, from the foot of the cutter's axis, is r_M cos delta + rho/D, and at theta = 0 r_a0.
        """
        moment, delta, stretch = self._moment(theta)
        excess, sine = (1 - self._c) * (1 + self._c), np.sin(theta)
        wide = self.radius * excess * sine**2 / (stretch * (1 + stretch))
        return _Normal(delta, stretch, moment, 2 * self._middle_radius * np.sin(delta / 2) ** 2 - wide)

    def _moment(self, theta: Any) -> tuple[Any, Any, Any]:
        """h, and delta and D on which it depends."""
        sine, cosine, excess = np.sin(theta), np.cos(theta), (1 - self._c) * (1 + self._c)
        stretch = np.sqrt(1 - excess * sine**2)
        delta = np.arctan2(self._c * sine, cosine)
        moment = self._middle_radius * np.sin(delta) - self.radius * excess / (self._c * stretch) * sine * cosine
        return moment, delta, stretch

    @cached_property
    def last_angle(self) -> float:
        """theta up to which the corner cuts: its end, or the place beyond which its normal misses the pitch point."""
        end = self.corner_end
        if self.protuberance_angle is None:
            return end
        if not self.rolls or float(self._moment(end)[0]) <= self.working_radius:
            return end
        # Beyond this place the normal of the corner does not come through the pitch point any more.
        limit = root_between(lambda theta: float(self._moment(theta)[0]) - self.working_radius, self.tangent_angle, end)
        return limit * (1 - _ROUNDING)

    @property
    def corner_end(self) -> float:
        """theta where the corner ends: at the cutter's involute, or at the flank of a protuberance, pi/2 - a_pr."""
        return self.tangent_angle if self.protuberance_angle is None else math.pi / 2 - self.protuberance_angle

    @cached_property
    def tangent_angle(self) -> float:
        """theta where the corner touches the cutter's involute: its normal touches the base circle, h = r_b0."""
        if self.radius == 0:
            # A sharp edge turns from the tip circle's normal to the involute's: sin delta = r_b0/r_a0.
            return math.atan2(self.base_radius, self._c * self._root_of(self.tip_radius))

        def excess(theta: float) -> float:
            return float(self._moment(theta)[0]) - self.base_radius

        return root_between(excess, 0.0, math.pi / 2, xtol=1e-15, rtol=8.9e-16)

    def _root_of(self, radius: float) -> float:
        """Return the roll length of the cutter's involute at a radius (mm)."""
        return math.sqrt(max((radius - self.base_radius) * (radius + self.base_radius), 0.0))

    @property
    def feasible(self) -> bool:
        """Whether the corner reaches the cutter's involute: the middle of the corner lies beyond the base circle, nearly."""
        return float(self._moment(math.pi / 2)[0]) > self.base_radius

    @cached_property
    def _join(self) -> tuple[float, float]:
        """Radius (mm) and angle from the corner's middle (rad) of the join, on the cutter."""
        along, across = self.corner(np.array(self.tangent_angle))
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
    def side(self) -> int:
        """Return on which side the gear's axis is: +1 behind the cutter's (a ring), -1 before the cutter's tip."""
        return 1 if self.internal else -1

    @cached_property
    def working_radius(self) -> float:
        """r_w0 = a_0 z_0/(|z| -+ z_0) of the cutter (mm)."""
        return self.centre_distance * self.cutter_teeth / (self.teeth - self.side * self.cutter_teeth)

    @cached_property
    def pitch_radius(self) -> float:
        """r_w = a_0 |z|/(|z| -+ z_0) of the gear (mm)."""
        return self.centre_distance * self.teeth / (self.teeth - self.side * self.cutter_teeth)

    @property
    def rolls(self) -> bool:
        """Whether the cutter rolls with the gear; it does not where it is the gear's own counterpart."""
        return self.centre_distance > 0

    def _contact(self, theta: Floats) -> _Contact:
        """Return the contact at which `theta` cuts: its normal passes through the pitch point, sin gamma = h/r_w0."""
        normal = self._normal(theta)
        gamma = np.arcsin(normal.moment / self.working_radius)
        rise = 2 * self.working_radius * np.sin(gamma / 2) ** 2 - normal.short
        reach = self.side * (self.root_radius - self.pitch_radius) + rise
        return _Contact(normal, gamma, gamma - normal.delta - self.middle_angle, rise, reach)

    def cut(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Return the points that the corner cuts: radius (mm) and angle from the middle of the tooth space (rad)."""
        theta = np.asarray(theta, float)
        if not self.rolls:
            along, across = self.corner(theta)
            return np.hypot(along, across), self.middle_angle + np.arctan2(across, along)
        contact = self._contact(theta)
        x = self.pitch_radius + self.side * contact.reach * np.cos(contact.gamma)
        y = contact.reach * np.sin(contact.gamma)
        return np.hypot(x, y), np.arctan2(y, x) - self.share * contact.turn

    @property
    def share(self) -> float:
        """z_0/|z|: how far the gear turns when the cutter does."""
        return self.cutter_teeth / self.teeth

    def turn(self, theta: ArrayLike) -> Floats:
        """Turn phi of the cutter (rad) where theta cuts."""
        theta = np.asarray(theta, float)
        return self._contact(theta).turn if self.rolls else np.zeros_like(theta)

    def seen(self, along: ArrayLike, across: ArrayLike, turn: ArrayLike) -> tuple[Any, Any]:
        """Return points of the cutter (mm) after a rotation by `turn` (rad), in the frame of the gear that turned with it.

        Radius (mm) and angle from the middle of the tooth space (rad). `along` and `across` are from the cutter's axis, its
        tooth centred on the first.
        """
        along, across, turn = np.asarray(along), np.asarray(across), np.asarray(turn)
        x, y = along * np.cos(turn) - across * np.sin(turn), along * np.sin(turn) + across * np.cos(turn)
        x = self.centre_distance + self.side * x
        return np.hypot(x, y), np.arctan2(y, x) - turn * self.share

    def direction(self, theta: ArrayLike, half_pitch: float) -> Floats:
        """Return the direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""
        theta = np.asarray(theta, float)
        if not self.rolls:
            return half_pitch - (self._normal(theta).delta + self.middle_angle) - math.pi / 2
        contact = self._contact(theta)
        return half_pitch + self.share * contact.turn - self.side * contact.gamma - math.pi / 2

    # ------------------------------------------------------------------ where it ends

    def form_radius(self, base_radius: float, sine: float) -> float:
        """Return the radius (mm) of the root form circle where nothing is undercut: sqrt(r_b^2 + (a_0 sin a_w0 +- t_F0)^2).

        `base_radius` (mm) of the gear; `sine` of the transverse pressure angle is that of a rack's rolling, not needed here.
        """
        return math.hypot(base_radius, self._reach(base_radius))

    def action(self, base_radius: float) -> float:
        """a_0 sin a_w0 (mm): the line of action between the gear's base circle and the cutter's."""
        bases = base_radius - self.side * self.base_radius
        return math.sqrt(max((self.centre_distance - bases) * (self.centre_distance + bases), 0.0))

    def _reach(self, base_radius: float) -> float:
        """Return the roll length (mm) on the gear where the join cuts; negative where it would be beyond the base circle."""
        return self.action(base_radius) + self.side * self.join_length

    def undercuts(self, base_radius: float, sine: float) -> bool:
        """Return whether the corner cuts away part of an involute with this base radius (mm); that of a ring it never does."""
        return not self.internal and self._reach(base_radius) < 0

    def theta_at(self, radius: ArrayLike, last: float) -> Floats:
        """Inverse of `cut`: theta in [0, last] that cuts at `radius` (mm), to machine precision."""
        radius = np.atleast_1d(np.asarray(radius, float))
        way = self.side * (self.root_radius - radius)
        goal = np.sqrt(np.maximum(way * (radius + self.root_radius), 0.0))
        root_of = self._rolled_square if self.rolls else self._square
        return where_root_is(goal, last, root_of, resolution=_ROUNDING)

    def _rolled_square(self, theta: Floats) -> tuple[Floats, Floats]:
        """Root of F = +-(r_f^2 - R^2), which rises along the fillet, without cancellation, and F'/2.

        With l from the pitch point to the point along the normal, R^2 = r_w^2 + l^2 +- 2 r_w l cos gamma;
        l' = h (gamma' - delta') and h' = q delta' - rho D/c for the place q along the normal.
        """
        c, side, own, pitch = self._c, self.side, self.working_radius, self.pitch_radius
        normal, gamma, _, rise, reach = self._contact(theta)
        square = 4 * pitch * reach * np.sin(gamma / 2) ** 2 - rise * (side * (2 * reach - rise) + 2 * pitch)
        turned = c / normal.stretch**2
        bent = ((self.tip_radius - normal.short) * turned - self.radius * normal.stretch / c) / (own * np.cos(gamma))
        across = own * (bent - turned) * (side * reach + pitch * np.cos(gamma))
        slope = np.sin(gamma) * (pitch * reach * bent - across)
        return np.sqrt(np.maximum(square, 0.0)), slope

    def _square(self, theta: Floats) -> tuple[Floats, Floats]:
        """Return the root of F = r_f^2 - |p|^2 of the corner itself, and F'/2."""
        wide = self.radius**2 * (1 / self._c**2 - 1)
        square = 4 * self._middle_radius * self.radius * np.sin(theta / 2) ** 2 - wide * np.sin(theta) ** 2
        slope = np.sin(theta) * (self._middle_radius * self.radius - wide * np.cos(theta))
        return np.sqrt(np.maximum(square, 0.0)), slope
