"""Factors of load and heat that both scuffing temperatures share. Numbers, or arrays of one shape."""

from __future__ import annotations

import math

import numpy as np

from gearcad.material import Material, MaterialGroup
from gearcad.per_gear import PerGear
from gearcad.rating.scuffing.sliding import Size

__all__ = ["IRON", "helical_load_factor", "mating_factor", "structure_factor", "thermo_elastic_factor"]

CONDUCTIVITY = 50.0
"""lambda_M (N/(s·K)) of steel (13989-2, 5.3)."""

HEAT_CAPACITY = 3.8
"""c_v (N/(mm²·K)) of steel, per volume (13989-2, 5.3)."""

_NITRIDED = (MaterialGroup.NITRIDING_STEEL, MaterialGroup.NITRIDED, MaterialGroup.NITROCARBURISED)

IRON = (
    MaterialGroup.NODULAR_IRON,
    MaterialGroup.FERRITIC_NODULAR_IRON,
    MaterialGroup.MALLEABLE_IRON,
    MaterialGroup.GREY_IRON,
)
"""Groups that conduct heat otherwise than steel does."""


def helical_load_factor(total_contact_ratio: Size) -> Size:
    """K_Bgamma = 1 + 0.2 sqrt((epsilon_gamma - 2)(5 - epsilon_gamma)) (13989-2, 5): 1 up to 2, 1.3 from 3.5 on."""
    e = np.clip(total_contact_ratio, 2.0, 3.5)
    found: Size = 1 + 0.2 * np.sqrt((e - 2) * (5 - e))
    return found


def thermo_elastic_factor(materials: PerGear[Material]) -> float:
    """X_M (K N^-0.75 s^0.5 m^-0.5 mm): E_r^0.25/B_M, 50.0 of steel (13989-1, A.9 to A.14; 13989-2, 11 and 12).

    E_r = 2/((1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2), and B_M = sqrt(lambda_M c_v), of which both gears have that of steel.
    """
    softness = sum((1 - each.poisson_ratio**2) / each.youngs_modulus for each in materials)
    return math.sqrt(1000) * math.pow(2 / softness, 0.25) / math.sqrt(CONDUCTIVITY * HEAT_CAPACITY)


def structure_factor(materials: PerGear[Material]) -> float:
    """X_W (13989-2, table 3): 1.5 of nitrided flanks, 1 of all others; of two materials the lower one decides."""
    return min(1.5 if each.group in _NITRIDED else 1.0 for each in materials)


def mating_factor(contacts: float) -> float:
    """X_mp = (1 + n_p)/2 (13989-1, 23) for a gear that `contacts` others heat."""
    return (1 + contacts) / 2
