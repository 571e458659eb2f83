"""The oil film: Z_L, Z_v and Z_R of ISO 6336-2:2006, clause 12. Endurance limits are those of the softer gear of the mesh.

Of static strength all three are 1.
"""

from __future__ import annotations

from gearcad.rating.factors.elementwise import Values, bounded, power

__all__ = ["flank_roughness_factor", "lubricant_factor", "mesh_radius", "relative_roughness", "speed_factor"]


def lubricant_factor(flank_limit: Values, viscosity_40: Values) -> Values:
    """Z_L = C_ZL + 4 (1 - C_ZL)/(1.2 + 134/nu_40)^2 (12.2): sigma_Hlim in MPa, the viscosity at 40 °C in mm²/s."""
    c_zl = _oil_share(flank_limit)
    return c_zl + 4 * (1 - c_zl) / power(1.2 + 134 / viscosity_40, 2)


def speed_factor(flank_limit: Values, speed: Values) -> Values:
    """Z_v = C_Zv + 2 (1 - C_Zv)/sqrt(0.8 + 32/v) (12.3), C_Zv = C_ZL + 0.02; v at the reference circle, above 0 m/s."""
    c_zv = _oil_share(flank_limit) + 0.02
    return c_zv + 2 * (1 - c_zv) / power(0.8 + 32 / speed, 0.5)


def flank_roughness_factor(flank_limit: Values, roughness: Values, reduced_radius: Values) -> Values:
    """Z_R = (3/R_z10)^C_ZR (12.4), C_ZR = 0.32 - 0.0002 sigma_Hlim from 0.15 to 0.08.

    `roughness` is the mean Rz of both flanks (µm) after running in, `reduced_radius` rho_red at the pitch point (mm), see
    `mesh_radius`.
    """
    c_zr = bounded(0.32 - 0.0002 * flank_limit, 0.08, 0.15)
    return power(3 / relative_roughness(roughness, roughness, reduced_radius), c_zr)


def relative_roughness(roughness_pinion: Values, roughness_wheel: Values, reduced_radius: Values) -> Values:
    """R_z10 = (R_z1 + R_z2)/2 (10/rho_red)^(1/3) (12.4): the mean Rz (µm), as it would count at rho_red = 10 mm."""
    return (roughness_pinion + roughness_wheel) / 2 * power(10 / reduced_radius, 1 / 3)


def mesh_radius(pinion_base_diameter: Values, wheel_base_diameter: Values, working_tangent: Values) -> Values:
    """rho_red = rho_1 rho_2/(rho_1 + rho_2) (mm), rho = d_b/2 tan alpha_wt (12.4); d_b2 of a ring is negative."""
    rho_1, rho_2 = pinion_base_diameter / 2 * working_tangent, wheel_base_diameter / 2 * working_tangent
    return rho_1 * rho_2 / (rho_1 + rho_2)


def _oil_share(flank_limit: Values) -> Values:
    """C_ZL = sigma_Hlim/4375 + 0.6357, 0.83 up to 850 MPa and 0.91 from 1200 MPa on."""
    return bounded(flank_limit / 4375 + 0.6357, 0.83, 0.91)
