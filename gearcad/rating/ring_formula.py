"""The root of a ring by the formulas of ISO 6336-3:2006: a rack-like tooth in place of what the shaper cutter generates.

They are shown beside the section of the generated fillet, which rates the ring: the substitute rack is far from the cutter
where the profile shift is large. To be verified: the formulas are as remembered, and as they agree with values computed
elsewhere; z_n is signed throughout, rho_F included, as the generated fillet wants it.

Lengths in mm, angles in degrees, but in units of the normal module and radians inside the formulas.
"""

from __future__ import annotations

import math

from gearcad.geometry import Gear
from gearcad.geometry.tooling import corner_radius
from gearcad.rating.root_section import RootSection, lean_of, tangent_angle
from gearcad.rating.virtual import LoadPoint, VirtualGear

__all__ = ["ring_section", "substitute_radius"]


def substitute_radius(gear: Gear, cutter_teeth: int) -> float:
    """rho_fPv (mm) of the rack that stands for the cutter: rho_fP + (x_0 + h_fP - rho_fP)^1.95/(3.156 1.036^z_0) in m_n."""
    rho, reach = corner_radius(gear), gear.cutter.profile_shift + gear.dedendum
    return gear.normal_module * (rho + math.pow(max(reach - rho, 0.0), 1.95) / (3.156 * math.pow(1.036, cutter_teeth)))


def ring_section(gear: Gear, virtual: VirtualGear, load: LoadPoint, radius: float) -> RootSection | None:
    """The section at the 60-degree tangents of a ring whose substitute rack has a tip of `radius` rho_fPv (mm).

    G = rho_fPv - h_fP + x, H = (2/z_n) (pi/2 - E) - pi/6, theta as of external gears; then
    s_Fn = z_n sin(pi/6 - theta) + G/cos theta - rho_fPv, rho_F = rho_fPv + 2 G^2/(cos theta (z_n cos^2 theta - 2 G)),
    h_Fe = ((cos gamma_e - sin gamma_e tan alpha_Fen) d_en - z_n cos(pi/6 - theta) - sqrt(3) (G/cos theta - rho_fPv))/2.
    None where they give no section.
    """
    m_n, z_n, rho = gear.normal_module, virtual.teeth, radius / gear.normal_module
    g = rho - gear.dedendum + gear.profile_shift
    h = 2 / z_n * (math.pi / 2 - _half_width(gear, rho)) - math.pi / 6
    theta = tangent_angle(g, h, z_n)
    if theta is None:
        return None
    centre = g / math.cos(theta) - rho
    s_fn = z_n * math.sin(math.pi / 6 - theta) + centre
    rho_f = rho + 2 * g**2 / (math.cos(theta) * (z_n * math.cos(theta) ** 2 - 2 * g))
    gamma_e, alpha_fen = math.radians(load.half_angle), math.radians(load.load_angle)
    lever = (math.cos(gamma_e) - math.sin(gamma_e) * math.tan(alpha_fen)) * load.diameter / m_n
    h_fe = (lever - z_n * math.cos(math.pi / 6 - theta) - math.sqrt(3) * centre) / 2
    if min(s_fn, rho_f, h_fe) <= 0:
        return None
    return RootSection(
        tangent_angle=math.degrees(theta),
        chord=m_n * s_fn,
        fillet_radius=m_n * rho_f,
        moment_arm=m_n * h_fe,
        on_fillet=True,
        lean=lean_of(gear),
    )


def _half_width(gear: Gear, rho: float) -> float:
    """E/m_n = pi/4 - h_fP tan alpha_n - (1 - sin alpha_n) rho/cos alpha_n, and half the thinning; `rho` in normal modules."""
    alpha_n = math.radians(gear.rack.pressure_angle)
    corner = (1 - math.sin(alpha_n)) * rho / math.cos(alpha_n)
    return math.pi / 4 - gear.dedendum * math.tan(alpha_n) - corner + gear.tooth_thinning / gear.normal_module / 2
