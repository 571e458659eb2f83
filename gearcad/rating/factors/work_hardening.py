"""Z_W of ISO 6336-2:2006, clause 13: what a hard mate, or a harder one, adds to the flanks of the softer wheel.

A ground, surface-hardened pinion smooths and hardens a through-hardened wheel (13.2.1); of two through-hardened gears the
harder pinion does (13.2.2). Hardness is Brinell's. The pinion itself has 1.
"""

from __future__ import annotations

from gearcad.rating.factors.elementwise import Values, bounded, chosen, power

__all__ = ["equivalent_roughness", "static_work_hardening_factor", "through_hardened_factor", "work_hardening_factor"]


def work_hardening_factor(hardness: Values, roughness: Values) -> Values:
    """Z_W = (1.2 - (HB - 130)/1700) (3/R_zH)^0.15 (13.2.1): the wheel's hardness, which counts from 130 to 470 HB.

    Never below 1: a pinion so rough wears the wheel, which the standard does not rate (IACS UR M56, 2.11).
    `roughness` is that of the pinion as the wheel feels it, R_zH (µm), see `equivalent_roughness`.
    """
    smoothed = (1.2 - (bounded(hardness, 130, 470) - 130) / 1700) * power(3 / roughness, 0.15)
    return bounded(smoothed, 1, 1.2)


def equivalent_roughness(
    pinion_roughness: Values, wheel_roughness: Values, reduced_radius: Values, viscosity_40: Values, speed: Values
) -> Values:
    """R_zH = R_z1 (10/rho_red)^0.33 (R_z1/R_z2)^0.66/(nu_40 v/1500)^0.33 (13.2.1), from 3 to 16 µm.

    Rz in µm before running in, rho_red in mm, nu_40 in mm²/s, v at the reference circle in m/s, above 0.
    """
    smoothing = power(10 / reduced_radius, 0.33) * power(pinion_roughness / wheel_roughness, 0.66)
    return bounded(pinion_roughness * smoothing / power(viscosity_40 * speed / 1500, 0.33), 3, 16)


def through_hardened_factor(pinion_hardness: Values, wheel_hardness: Values, gear_ratio: Values) -> Values:
    """Z_W = 1 + A (u - 1) (13.2.2), A = 0.00898 HB_1/HB_2 - 0.00829 from HB_1/HB_2 = 1.2 to 1.7; below it is 1.

    u, of a ring its amount, counts from 1 to 20.
    """
    ratio = pinion_hardness / wheel_hardness
    slope = chosen(ratio > 1.7, 0.00698, 0.00898 * ratio - 0.00829)
    return 1 + chosen(ratio < 1.2, 0.0, slope) * (bounded(gear_ratio, 1, 20) - 1)


def static_work_hardening_factor(hardness: Values) -> Values:
    """Z_W of static strength = 1.05 - (HB - 130)/6800 (13.2.1, to be verified): of a soft wheel with a hard pinion."""
    return 1.05 - (bounded(hardness, 130, 470) - 130) / 6800
