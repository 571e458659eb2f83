"""The root section of a tooth: by the equations of ISO 6336-3:2006 for hobs, or on the fillet that the tool really generates.

An external tooth is cut where tangents at 30 degrees to its middle touch the fillet, that of a ring at 60 degrees. The
standard's E, G, H and theta describe the very trochoid of a hob that gear.profile is made of, so both ways give the same
section there. For the roots of rings and shaped gears the standard has a substitute rack, which is far from a shaper cutter
(see `ring_formula`); their section is taken from the generated fillet. That is ours: no clause of the standard says so.

Lengths in mm, angles in degrees; equations are those of ISO 6336-3:2006.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.geometry.bracketed import root_between
from gearcad.geometry.tooling import corner_radius, shaped
from gearcad.geometry.trochoid import FilletTool
from gearcad.rating.virtual import LoadPoint, VirtualGear
from gearcad.rating.virtual_tool import virtual_tool

__all__ = ["RootSection", "generated_section", "hob_section", "lean_of", "root_section", "tangent_angle", "tool_half_width"]

_LEAN, _RING_LEAN = 30.0, 60.0
"""Angle (deg) between the middle of the tooth and the tangents at the section, of external teeth and of rings."""

_STEP, _OFFSETS, _SLOPE = 1e-3, np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0])
"""Of theta (rad), for slopes along the fillet; places in steps, and their weights."""

_SHARP = 1e-4
"""Radius of the fillet, in normal modules, below which its section is a sharp corner."""


@dataclass(frozen=True, kw_only=True)
class RootSection:
    """Section at the 30-degree tangents: `tangent_angle` theta (deg), chord s_Fn, fillet radius rho_F, and the arm h_Fe (mm).

    `lean` (deg) is the angle of the tangents to the middle of the tooth, 60 on a ring. `on_fillet` is False where the tangent
    would touch beyond the fillet, on the flank: then the formulas do not hold.
    """

    tangent_angle: float
    chord: float
    fillet_radius: float
    moment_arm: float
    on_fillet: bool
    lean: float = _LEAN

    @property
    def notch_parameter(self) -> float:
        """q_s = s_Fn/(2 rho_F) (38)."""
        return self.chord / (2 * self.fillet_radius)


def lean_of(gear: Gear) -> float:
    """Angle (deg) of the tangents at its root section to the middle of the tooth."""
    return _RING_LEAN if gear.internal else _LEAN


def root_section(gear: Gear, virtual: VirtualGear, load: LoadPoint) -> RootSection:
    """The section at the tangents to the fillet, and the arm at which the load bends it.

    Raises GeometryError for teeth without such a section, as of a gear with three.
    """
    return (generated_section if shaped(gear) else hob_section)(gear, virtual, load)


# ---------------------------------------------------------------------- cut by a hob


def tool_half_width(gear: Gear) -> float:
    """E (10) (mm): from the middle of the tool's tooth to the centre of its tip arc.

    pi m_n/4 - h_fP tan alpha_n - (1 - sin alpha_n) rho_fP/cos alpha_n, plus half the tooth thinning. No protuberance.
    """
    m_n, alpha_n = gear.normal_module, math.radians(gear.rack.pressure_angle)
    corner = (1 - math.sin(alpha_n)) * gear.root_radius / math.cos(alpha_n)
    return m_n * (math.pi / 4 - gear.dedendum * math.tan(alpha_n) - corner) + gear.tooth_thinning / 2


def tangent_angle(g: float, h: float, virtual_teeth: float) -> float | None:
    """theta (rad) of theta = (2 G/z_n) tan theta - H (14), by Newton from the standard's pi/6; None where there is none."""
    slope, theta, step = 2 * g / virtual_teeth, math.pi / 6, math.inf
    for _ in range(50):
        step = (theta - slope * math.tan(theta) + h) / (1 - slope / math.cos(theta) ** 2)
        theta -= step
        if abs(step) < 1e-15:
            break
    return theta if abs(step) < 1e-12 and 1e-9 < theta < math.pi / 2 else None


def hob_section(gear: Gear, virtual: VirtualGear, load: LoadPoint) -> RootSection:
    """By the equations for a hob: that of its own rack.

    G = rho_fP/m_n - h_fP/m_n + x (12), H = (2/z_n) (pi/2 - E/m_n) - pi/3 (13), then s_Fn (15), rho_F (17) and h_Fe (18).
    Raises GeometryError for teeth without such a section.
    """
    m_n, z_n, rho = gear.normal_module, virtual.teeth, gear.root_radius
    g = rho - gear.dedendum + gear.profile_shift
    h = 2 / z_n * (math.pi / 2 - tool_half_width(gear) / m_n) - math.pi / 3
    theta = tangent_angle(g, h, z_n)
    if theta is None:
        raise _no_tangent(gear)
    centre = g / math.cos(theta) - rho
    s_fn = z_n * math.sin(math.pi / 3 - theta) + math.sqrt(3) * centre
    rho_f = rho + 2 * g**2 / (math.cos(theta) * (z_n * math.cos(theta) ** 2 - 2 * g))
    gamma_e, alpha_fen = math.radians(load.half_angle), math.radians(load.load_angle)
    lever = (math.cos(gamma_e) - math.sin(gamma_e) * math.tan(alpha_fen)) * load.diameter / m_n
    height = z_n * math.cos(math.pi / 3 - theta) + centre
    return RootSection(
        tangent_angle=math.degrees(theta),
        chord=m_n * s_fn,
        fillet_radius=m_n * rho_f,
        moment_arm=m_n * (lever - height) / 2,
        # Undercut takes away only the top of the fillet, where it leans by less than the involute there.
        on_fillet=theta <= math.pi / 2 - math.radians(virtual.pressure_angle),
    )


def _no_tangent(gear: Gear) -> GeometryError:
    return GeometryError("teeth", gear.teeth, "must be more for a rating: no tangent at 30 deg touches the fillet")


# ---------------------------------------------------------------------- on the generated fillet


def generated_section(gear: Gear, virtual: VirtualGear, load: LoadPoint) -> RootSection:
    """On the fillet that the tool generates on the virtual gear: chord, radius of curvature and place are those of the curve.

    The force is tangential to the base circle, so it meets the middle of the tooth at r_bn/cos alpha_Fen. Raises GeometryError
    for teeth without such a section, with a sharp corner there, or whose load passes beyond it.
    """
    fillet = _GeneratedFillet(virtual_tool(gear, virtual), math.pi / abs(virtual.teeth), gear.internal)
    theta = fillet.theta_at(math.radians(lean_of(gear)))
    if theta is None:
        permitted = f"must be others for a rating: no tangent at {lean_of(gear):g} deg touches the fillet"
        raise GeometryError("teeth", gear.teeth, permitted)
    (x,), (y,) = fillet.points(np.array([theta]))
    radius, meets = fillet.curvature_radius(theta), virtual.base_diameter / 2 / math.cos(math.radians(load.load_angle))
    arm = float(meets - virtual.side * x)
    if radius < _SHARP * gear.normal_module:
        permitted = f"must be above {_SHARP:g} for a rating: stress has no limit in a sharp corner"
        raise GeometryError("cutter.tip_radius", corner_radius(gear), permitted)
    if arm <= 0:
        permitted = "must be others for a rating: the load passes beyond the root section, and does not bend the tooth"
        raise GeometryError("profile_shift", gear.profile_shift, permitted)
    return RootSection(
        tangent_angle=math.degrees(theta),
        chord=float(2 * y),
        fillet_radius=radius,
        moment_arm=arm,
        on_fillet=True,
        lean=lean_of(gear),
    )


@dataclass(frozen=True)
class _GeneratedFillet:
    """What a tool's tip cuts from a tooth on +x (y > 0), by its angle theta (rad); `internal` with the tip inside the root."""

    tool: FilletTool
    half_pitch: float
    internal: bool

    def points(self, theta: Floats) -> tuple[Floats, Floats]:
        """x and y (mm)."""
        radius, angle = self.tool.cut(theta)
        return radius * np.cos(self.half_pitch - angle), radius * np.sin(self.half_pitch - angle)

    def lean(self, theta: ArrayLike) -> Floats:
        """Angle (rad) between the tangent and the middle of the tooth: a right angle on the root circle, falling from there."""
        direction = self.tool.direction(theta, self.half_pitch)
        return math.pi + direction if self.internal else -direction

    def theta_at(self, lean: float) -> float | None:
        """Where the fillet leans so much (rad); None where it does not."""
        if not self.lean(0.0) > lean > self.lean(self.tool.last_angle):
            return None
        return root_between(lambda theta: float(self.lean(theta)) - lean, 0.0, self.tool.last_angle, xtol=1e-15, rtol=8.9e-16)

    def curvature_radius(self, theta: float) -> float:
        """Radius of curvature (mm), from differences of fourth order along the curve."""
        near = theta + _STEP * _OFFSETS
        (x, y), lean = self.points(near), self.lean(near)
        return float(math.hypot(_SLOPE @ x, _SLOPE @ y) / abs(_SLOPE @ lean))
