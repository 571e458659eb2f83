"""The fillet that a rack with a rounded tip really cuts: the envelope of the tool's tip arc, in the transverse section.

Bare equations, without any judgement on whether the tool is feasible. Lengths in mm, angles in radians (these are the
locals of a formula, shared between the profile and its tests). The tool is described in the normal section: u along
the rolling line from the centre of the tool's tooth, v away from the gear's axis. In the transverse section u is
stretched by 1/cos(beta), so the tip CIRCLE of the tool becomes an ELLIPSE there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.geometry.bracketed import where_root_is

__all__ = ["FilletTool", "ToolTip"]


class FilletTool(Protocol):
    """The rounded tip of what cuts the fillets of a gear, from theta = 0 on the root circle to `last_angle` at the flank."""

    @property
    def last_angle(self) -> float: ...

    def cut(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Points that the tip cuts: radius (mm) and angle from the middle of the tooth space (rad)."""

    def direction(self, theta: ArrayLike, half_pitch: float) -> NDArray[np.float64]:
        """Direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""

    def theta_at(self, radius: ArrayLike, last: float) -> NDArray[np.float64]:
        """theta in [0, last] that cuts at a radius (mm), to machine precision."""

    def undercuts(self, base_radius: float, sine: float) -> bool:
        """Whether part of the involute is cut away; base radius in mm, `sine` of the transverse pressure angle."""

    def form_radius(self, base_radius: float, sine: float) -> float:
        """Radius (mm) of the root form circle where nothing is undercut."""


@dataclass(frozen=True, kw_only=True)
class ToolTip:
    """The rounded tip corner of a hob or rack, set to cut one gear.

    `radius` of the tip (mm, normal section), `u` and `v` of its centre (mm), `pressure_angle` (normal) and
    `helix_angle` in radians, `reference_radius` r of the gear (mm). The tip arc runs over
    theta = 0 (its deepest point) ... `last_angle` (where the straight flank begins).
    """

    radius: float
    u: float
    v: float
    pressure_angle: float
    helix_angle: float
    reference_radius: float

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
        """The tip of a tool that reaches `depth` (mm) below the reference circle with the profile shift `shift` (mm).

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
        """theta where the tip arc joins the straight flank: pi/2 - a_n."""
        return math.pi / 2 - self.pressure_angle

    @property
    def flank_depth(self) -> float:
        """h = e - rho (1 - sin a_n): how far below the reference circle the straight flank of the tool reaches (mm)."""
        return -self.v + self.radius * math.sin(self.pressure_angle)

    def outline(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Tip arc in the transverse section at zero roll: xi along the rolling line, eta from it (mm)."""
        theta = np.asarray(theta, float)
        xi = (self.u + self.radius * np.sin(theta)) / math.cos(self.helix_angle)
        return xi, self.v - self.radius * np.cos(theta)

    def roll(self, theta: ArrayLike) -> Any:
        """Roll angle of the gear (rad) at which the tool point theta cuts: phi = (X - xi)/r."""
        theta = np.asarray(theta, float)
        xi, eta = self.outline(theta)
        return (-eta * np.tan(theta) * math.cos(self.helix_angle) - xi) / self.reference_radius

    def cut(self, theta: ArrayLike) -> tuple[Any, Any]:
        """Points that the tip arc cuts: radius (mm) and angle from the middle of the tooth space (rad)."""
        theta = np.asarray(theta, float)
        _, eta = self.outline(theta)
        across = -eta * np.tan(theta) * math.cos(self.helix_angle)
        along = self.reference_radius + eta
        return np.hypot(across, along), np.arctan2(across, along) - self.roll(theta)

    def direction(self, theta: ArrayLike, half_pitch: float) -> NDArray[np.float64]:
        """Direction of travel from root to tip (rad), on the flank y > 0 of a tooth on +x."""
        theta = np.asarray(theta, float)
        slope: NDArray[np.float64] = np.arctan(np.tan(theta) * math.cos(self.helix_angle))
        return half_pitch + np.asarray(self.roll(theta)) - np.pi / 2 + slope

    def undercuts(self, base_radius: float, sine: float) -> bool:
        """True if the tip cuts away part of the involute: h > r sin^2 alpha_t; `sine` of the transverse pressure angle."""
        return self.flank_depth > self.reference_radius * sine**2

    def form_radius(self, base_radius: float, sine: float) -> float:
        """Radius (mm) of the root form circle where nothing is undercut; base radius in mm, `sine` of alpha_t."""
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
