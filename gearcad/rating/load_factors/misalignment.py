"""How far flanks stand off across the face width: ISO 6336-1:2006, 7.5, Method C. Deviations in µm, lengths in mm.

`mean_load` is F_m/b = F_t K_A K_gamma K_v/b in N/mm. Numbers give a number, arrays broadcast.
"""

from __future__ import annotations

from typing import NamedTuple

from gearcad.rating.editions import Edition
from gearcad.rating.factors.elementwise import Values, chosen, magnitude, root
from gearcad.rating.load_factor_options import BearingArrangement, HelixModification

__all__ = [
    "UNLOADED_ENDS",
    "HelixFactors",
    "arrangement_factor",
    "helix_factors",
    "initial_misalignment",
    "least_misalignment",
    "manufacturing_misalignment",
    "offset_limit",
    "proven_misalignment",
    "shaft_deflection",
    "shaft_term",
]

STIFFENING_RATIO = 1.15
"""d_1/d_sh from which on a pinion stiffens its shaft."""

_ARRANGEMENTS = {
    BearingArrangement.BETWEEN_NEAR: (0.8, 0.48),
    BearingArrangement.BETWEEN_FAR: (-0.8, -0.48),
    BearingArrangement.OVERHUNG: (1.33, 1.33),
    BearingArrangement.SECOND_MESH_NEAR: (-0.6, -0.36),
    BearingArrangement.SECOND_MESH_FAR: (-1.0, -0.6),
}
"""K' of figure 13, without and with stiffening."""


class HelixFactors(NamedTuple):
    """B_1 and B_2 of what is left of f_sh and f_ma, and how far (µm) a pinion gives way per load (57)."""

    deflection: float
    manufacture: float
    compliance: float = 0.023


_HELIX = {
    HelixModification.NONE: HelixFactors(1.0, 1.0),
    HelixModification.CROWNING: HelixFactors(1.0, 0.5),
    HelixModification.FULL_CROWNING: HelixFactors(0.5, 0.5),
    HelixModification.HELIX_CORRECTION: HelixFactors(0.1, 1.0),
    HelixModification.CORRECTION_AND_CROWNING: HelixFactors(0.1, 0.5),
    HelixModification.END_RELIEF: HelixFactors(0.7, 0.7),
}
"""Table 8."""

_HELIX_DIN = {
    HelixModification.CROWNING: HelixFactors(1.0, 0.5, 0.012),
    HelixModification.FULL_CROWNING: HelixFactors(1.0, 0.5, 0.012),
    HelixModification.END_RELIEF: HelixFactors(1.0, 0.7, 0.016),
}
"""DIN 3990-1 has another compliance in place of B_1."""

UNLOADED_ENDS = frozenset(
    (
        HelixModification.CROWNING,
        HelixModification.FULL_CROWNING,
        HelixModification.CORRECTION_AND_CROWNING,
        HelixModification.END_RELIEF,
    )
)
"""Modifications that leave little load to the ends of the teeth: K_Fbeta is then K_Hbeta (7.6)."""


def helix_factors(modification: HelixModification, edition: Edition) -> HelixFactors:
    """Those of a helix modification."""
    return (_HELIX_DIN if edition is Edition.DIN_1987 else {}).get(modification, _HELIX[modification])


def arrangement_factor(arrangement: BearingArrangement, stiffening: bool, diameter_ratio: Values) -> Values:
    """K' (figure 13): less where the pinion stiffens its shaft, from d_1/d_sh = 1.15 on."""
    plain, stiff = _ARRANGEMENTS[arrangement]
    return chosen(diameter_ratio >= STIFFENING_RATIO, stiff, plain) if stiffening else plain


def offset_limit(arrangement: BearingArrangement) -> float:
    """The most s/l that figure 13 has."""
    return 0.5 if arrangement is BearingArrangement.OVERHUNG else 0.3


def shaft_term(
    arrangement: Values, bearing_span: Values, offset: Values, reference_diameter: Values, shaft_diameter: Values
) -> Values:
    """K' l s/d_1^2 (d_1/d_sh)^4 of (57): how a shaft bends, by K' of `arrangement_factor`; 0 between bearings alike far."""
    return arrangement * bearing_span * offset * reference_diameter**2 / shaft_diameter**4


def shaft_deflection(
    mean_load: Values,
    width: Values,
    reference_diameter: Values,
    *,
    shaft_term: Values,
    branch: float = 1.0,
    compliance: float = 0.023,
    double_helical: bool = False,
) -> Values:
    """f_sh = 0.023 F_m/b (|B* + K' l s/d_1^2 (d_1/d_sh)^4 - 0.3| + 0.3) (b/d_1)^2 (57): the pinion's bending and twist.

    `branch` B* is 1 where all power goes through this mesh, 1 + 2 (100 - k)/k for k % of it; `shaft_term` that of the function.
    Double helical pinions (58) have twice the compliance, B* is more by 0.5, and `width` is that of one half.
    """
    if double_helical:
        branch, compliance = branch + 0.5, 2 * compliance
    bracket = magnitude(branch + shaft_term - 0.3) + 0.3
    return compliance * mean_load * bracket * (width / reference_diameter) ** 2


def manufacturing_misalignment(pinion_slope: Values, wheel_slope: Values) -> Values:
    """f_ma = sqrt(f_Hbeta1^2 + f_Hbeta2^2) (64)."""
    return root(pinion_slope**2 + wheel_slope**2)


def least_misalignment(mean_load: Values, greatest_slope: Values) -> Values:
    """F_beta_x_min (55), (56): the larger of 0.005 mm µm/N times F_m/b and half of the larger f_Hbeta."""
    return larger(0.005 * mean_load, 0.5 * greatest_slope)


def initial_misalignment(deflection: Values, manufacture: Values, factors: HelixFactors, least: Values) -> Values:
    """F_beta_x = 1.33 B_1 f_sh + B_2 f_ma (52), no less than `least`."""
    return larger(1.33 * factors.deflection * deflection + factors.manufacture * manufacture, least)


def proven_misalignment(deflection: Values, compensation: Values, factors: HelixFactors, least: Values) -> Values:
    """F_beta_x = |1.33 B_1 f_sh - f_Hbeta5| (53), with a contact pattern that shows that both lie opposite.

    `compensation` is f_Hbeta5, the helix slope deviation of accuracy grade 5 (corrigendum of 2008), or f_ma by DIN 3990-1:1987
    where that is given.
    """
    return larger(magnitude(1.33 * factors.deflection * deflection - compensation), least)


def larger(one: Values, other: Values) -> Values:
    """The larger of two values."""
    return chosen(one > other, one, other)
