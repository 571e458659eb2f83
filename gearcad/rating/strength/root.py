"""What the roots of a mesh bear: ISO 6336-3:2006, clauses 5 and 11 to 15."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.material import Material, MaterialGroup
from gearcad.per_gear import Role
from gearcad.rating.both import both
from gearcad.rating.factors import (
    Family,
    cautious_strength,
    notch_sensitivity_factor,
    root_points,
    root_size_factor,
    root_surface_factor,
    static_notch_sensitivity_factor,
)
from gearcad.rating.iso6336_3 import RootRating
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength.conditions import Conditions
from gearcad.rating.strength.resistance import Resistance

__all__ = ["Y_ST", "NotchStrength", "notch_strength", "root_resistance"]

Y_ST = 2.0
"""Stress correction factor of the gears that sigma_Flim was measured on."""


@dataclass(frozen=True, kw_only=True)
class NotchStrength:
    """The strength (MPa) that Y_delta_relT goes by; None of groups that need none. `assumed`: in words, if it was not given."""

    value: float | None
    assumed: str = ""


def notch_strength(material: Material, group: MaterialGroup, notch_parameter: float) -> NotchStrength:
    """The material's own, or that of its group which makes the factor least."""
    grey = Family.of(group) is Family.GREY_IRON
    name, own = ("tensile_strength", material.tensile_strength) if grey else ("yield_strength", material.yield_strength)
    if own is not None or (cautious := cautious_strength(notch_parameter, group)) is None:
        return NotchStrength(value=own)
    return NotchStrength(value=cautious, assumed=f"{name} = {cautious:g} MPa of {group.value}: where Y_delta_relT is least")


def root_resistance(
    role: Role,
    limit: float,
    group: MaterialGroup,
    strength: float | None,
    root: RootRating,
    conditions: Conditions,
    options: RatingOptions,
) -> Resistance:
    """sigma_FG of one gear: sigma_Flim Y_ST Y_NT Y_delta_relT Y_RrelT Y_X (5), and Y_M; static: Y_RrelT = Y_X = 1."""
    mean_stress = both(options.mean_stress_factor).pick(role)
    return Resistance(
        reference=limit * Y_ST,
        life_symbol="Y_NT",
        points=root_points(group, long_life=options.long_life_factor),
        static={
            "Y_delta_relT": static_notch_sensitivity_factor(root.stress_correction_factor, group, strength),
            "Y_RrelT": 1.0,
            "Y_X": 1.0,
            "Y_M": mean_stress,
        },
        endurance={
            "Y_delta_relT": notch_sensitivity_factor(root.section.notch_parameter, group, strength),
            "Y_RrelT": root_surface_factor(conditions.root_roughness.pick(role), group),
            "Y_X": root_size_factor(conditions.normal_module, group),
            "Y_M": mean_stress,
        },
    )
