"""K_v by the resonance ratio: ISO 6336-1:2006, Method B (6.5), on plain numbers or arrays of many variants and speeds.

Stiffness per face width in N/(mm·µm), mass per face width in kg/mm, deviations in µm, specific load F_t K_A/b in N/mm.
"""

from __future__ import annotations

import math
from typing import Generic, NamedTuple

import numpy as np

from gearcad.rating.factors.elementwise import Values, chosen, root

__all__ = ["RunningFactors", "dynamic_factor_b", "lower_limit", "resonance_speed", "running_factors"]

_MAIN_END, _SUPERCRITICAL = 1.15, 1.5
"""Resonance ratios at which the main resonance range ends, and the supercritical one begins."""


class RunningFactors(NamedTuple, Generic[Values]):
    """C_v1 ... C_v7 of table 8: pitch, profile and cyclic-stiffness effects below, at and above the main resonance."""

    c_v1: float
    c_v2: Values
    c_v3: Values
    c_v4: Values
    c_v5: float
    c_v6: Values
    c_v7: Values


def resonance_speed(teeth: Values, mesh_stiffness: Values, mass: Values) -> Values:
    """n_E1 (rpm) = 30000/(pi z1) sqrt(c_gamma_alpha/m_red) (6)."""
    return 30000 / (math.pi * teeth) * root(mesh_stiffness / mass)


def lower_limit(specific_load: Values) -> Values:
    """N_S (11), (12): where the main resonance begins; lower for loads below 100 N/mm."""
    return chosen(specific_load < 100, 0.5 + 0.35 * root(specific_load / 100), 0.85)


def running_factors(total_contact_ratio: Values) -> RunningFactors[Values]:
    """Table 8, for a total contact ratio above 1."""
    e, deep = total_contact_ratio, total_contact_ratio > 2
    high = chosen(deep, e, 2.0)  # what the columns of deep teeth are worked out for
    wave: Values = np.sin(math.pi * (e - 2))
    between = chosen(e <= 2.5, 0.125 * wave + 0.875, 1.0)
    return RunningFactors(
        c_v1=0.32,
        c_v2=chosen(deep, 0.57 / (high - 0.3), 0.34),
        c_v3=chosen(deep, 0.096 / (high - 1.56), 0.23),
        c_v4=chosen(deep, (0.57 - 0.05 * high) / (high - 1.44), 0.90),
        c_v5=0.47,
        c_v6=chosen(deep, 0.12 / (high - 1.74), 0.47),
        c_v7=chosen(e <= 1.5, 0.75, between),
    )


def dynamic_factor_b(
    ratio: Values,
    specific_load: Values,
    total_contact_ratio: Values,
    *,
    pitch_effect: Values,
    profile_effect: Values,
    relief_effect: Values,
) -> Values:
    """K_v by the resonance ratio N: (13), (14) below, (20) at, (22) between, (21) above the main resonance.

    Of the effects B_p (15), B_f (16) and B_k (17). All broadcast.
    """
    c, (b_p, b_f, b_k) = running_factors(total_contact_ratio), (pitch_effect, profile_effect, relief_effect)
    subcritical = ratio * (c.c_v1 * b_p + c.c_v2 * b_f + c.c_v3 * b_k) + 1
    main = c.c_v1 * b_p + c.c_v2 * b_f + c.c_v4 * b_k + 1
    supercritical = c.c_v5 * b_p + c.c_v6 * b_f + c.c_v7
    between = supercritical + (main - supercritical) * (_SUPERCRITICAL - ratio) / (_SUPERCRITICAL - _MAIN_END)
    above = chosen(ratio < _SUPERCRITICAL, between, supercritical)
    return chosen(ratio <= lower_limit(specific_load), subcritical, chosen(ratio <= _MAIN_END, main, above))
