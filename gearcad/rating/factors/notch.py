"""How much of a notch the material feels: Y_delta_relT of ISO 6336-3:2006, clause 13. Strengths in MPa.

The strength that counts is sigma_S of structural steel, sigma_0.2 of through-hardened steel and of perlitic, bainitic and
malleable iron, sigma_B of grey iron; the other groups need none.
"""

from __future__ import annotations

import math

from gearcad.errors import ParameterError
from gearcad.material import MaterialGroup
from gearcad.rating.factors.elementwise import Values, interpolated, power
from gearcad.rating.factors.families import Family, is_cast_steel, per_family

__all__ = [
    "cautious_strength",
    "notch_sensitivity_factor",
    "slip_layer_thickness",
    "static_notch_sensitivity_factor",
    "strength_range",
]

_SLIP_LAYERS: dict[Family, tuple[tuple[float, float], ...]] = per_family(
    {
        (Family.STRUCTURAL,): ((300.0, 0.0833), (400.0, 0.0445)),
        (Family.THROUGH_HARDENED,): ((500.0, 0.0281), (600.0, 0.0194), (800.0, 0.0064), (1000.0, 0.0014)),
        (Family.GREY_IRON,): ((150.0, 0.3124), (300.0, 0.3095)),
        (Family.FERRITIC_NODULAR_IRON,): ((0.0, 0.3095),),
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): ((0.0, 0.003),),
        (Family.NITRIDED, Family.NITROCARBURISED): ((0.0, 0.1005),),
    }
)
"""Strength and rho' (mm), table 2; one point where no strength counts."""

_STATIC_LINES = per_family(
    {
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): (0.44, 0.12),
        (Family.NITRIDED, Family.NITROCARBURISED): (0.2, 0.6),
        (Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON): (0.0, 1.0),
    }
)
"""a and b of a Y_S + b."""

_CAST_STEEL = (0.07, 0.86)

_STATIC_SUPPORT = {Family.STRUCTURAL: (0.93, 200.0), Family.THROUGH_HARDENED: (0.82, 300.0)}
"""How much a notch is relieved, by the fourth root of a reference over the strength."""


def strength_range(group: MaterialGroup) -> tuple[float, float] | None:
    """The strengths (MPa) between which table 2 has rho' of a group, which stays beyond; None where none counts."""
    points = _SLIP_LAYERS[Family.of(group)]
    return None if len(points) == 1 else (points[0][0], points[-1][0])


def cautious_strength(notch_parameter: float, group: MaterialGroup) -> float | None:
    """The strength in the range of a group that makes Y_delta_relT least, for a material whose own is not known."""
    ends = strength_range(group)
    return None if ends is None else min(ends, key=lambda each: notch_sensitivity_factor(notch_parameter, group, each))


def slip_layer_thickness(group: MaterialGroup, strength: float | None = None) -> float:
    """rho' (mm, table 2): by the strength between its values, and that of the nearest beyond. Raises ParameterError."""
    points = _SLIP_LAYERS[Family.of(group)]
    return points[0][1] if len(points) == 1 else interpolated(_known(strength, group), points)


def notch_sensitivity_factor(notch_parameter: Values, group: MaterialGroup, strength: float | None = None) -> Values:
    """Y_delta_relT = (1 + sqrt(0.2 rho' (1 + 2 q_s)))/(1 + sqrt(1.2 rho')), 1 at q_sT = 2.5. Raises ParameterError."""
    rho = slip_layer_thickness(group, strength)
    return (1 + power(0.2 * rho * (1 + 2 * notch_parameter), 0.5)) / (1 + math.sqrt(1.2 * rho))


def static_notch_sensitivity_factor(
    stress_correction_factor: Values, group: MaterialGroup, strength: float | None = None
) -> Values:
    """Y_delta_relT of static strength by Y_S, 1 at Y_ST = 2 (to be verified). Raises ParameterError.

    Steel: (1 + c (Y_S - 1) r)/(1 + c r), r the fourth root of 200 MPa (St, c = 0.93) or 300 MPa (V, c = 0.82) over the
    strength; others a Y_S + b, and cast irons that are not malleable or perlitic 1.
    """
    family = Family.of(group)
    if is_cast_steel(group) or family in _STATIC_LINES:
        a, b = _CAST_STEEL if is_cast_steel(group) else _STATIC_LINES[family]
        return a * stress_correction_factor + b
    c, reference = _STATIC_SUPPORT[family]
    relief = c * math.pow(reference / _known(strength, group), 0.25)
    return (1 + relief * (stress_correction_factor - 1)) / (1 + relief)


def _known(strength: float | None, group: MaterialGroup) -> float:
    if strength is None:
        name = "tensile_strength" if Family.of(group) is Family.GREY_IRON else "yield_strength"
        raise ParameterError(name, strength, f"must be given for {group.value}: Y_delta_relT needs it", "MPa")
    return strength
