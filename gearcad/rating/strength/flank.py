"""What the flanks of a mesh bear: ISO 6336-2:2006, clauses 5 and 10 to 14."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.material import Material, MaterialGroup
from gearcad.per_gear import PerGear, Role
from gearcad.rating.factors import (
    Family,
    equivalent_roughness,
    flank_points,
    flank_roughness_factor,
    flank_size_factor,
    lubricant_factor,
    speed_factor,
    static_work_hardening_factor,
    through_hardened_factor,
    work_hardening_factor,
)
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength.conditions import Conditions
from gearcad.rating.strength.resistance import Resistance

__all__ = ["HARD", "WorkHardening", "brinell", "flank_resistance", "is_soft", "work_hardening"]

_BRINELL_OF_VICKERS = 0.95
"""HB over HV of steel (ISO 18265): part 5 has the hardness of through-hardened steel in HV, Z_W asks for HB."""

_SLOWEST = 1e-6
"""Speed (m/s) that stands for rest, where Z_v and R_zH have a limit."""

_WROUGHT_OR_CAST = (Family.STRUCTURAL, Family.THROUGH_HARDENED)
_IRON = (MaterialGroup.NODULAR_IRON, MaterialGroup.MALLEABLE_IRON)
HARD = (Family.CASE_HARDENED, Family.SURFACE_HARDENED, Family.NITRIDED, Family.NITROCARBURISED)
"""Flanks that smooth and harden those of a soft mate."""


@dataclass(frozen=True, kw_only=True)
class WorkHardening:
    """Z_W of the wheel, of static strength and of endurance; `assumed` says what was not given for it."""

    static: float = 1.0
    endurance: float = 1.0
    assumed: str = ""


def work_hardening(materials: PerGear[Material], conditions: Conditions) -> WorkHardening:
    """Clause 13: of a soft steel wheel whose pinion is hard (13.2) or harder (13.3). Of a pinion it is 1."""
    pinion, wheel = materials
    if pinion.group is None or wheel.group is None or not is_soft(wheel.group):
        return WorkHardening()
    hard, soft = brinell(pinion), brinell(wheel)
    if soft is None:
        return WorkHardening(assumed="the hardness of the wheel is not given: Z_W = 1")
    if Family.of(pinion.group) in HARD:
        return _by_hard_pinion(soft, conditions)
    if hard is None or not is_soft(pinion.group):
        return WorkHardening()
    return WorkHardening(endurance=through_hardened_factor(hard, soft, conditions.gear_ratio))


def is_soft(group: MaterialGroup) -> bool:
    """Structural or through-hardened steel."""
    return Family.of(group) in _WROUGHT_OR_CAST and group not in _IRON


def brinell(material: Material) -> float | None:
    """Hardness of flanks in HB, by that of their group; None where it is not known."""
    if material.hardness is None or material.group is None:
        return None
    structural = Family.of(material.group) is Family.STRUCTURAL
    return material.hardness if structural else _BRINELL_OF_VICKERS * material.hardness


def _by_hard_pinion(hardness: float, conditions: Conditions) -> WorkHardening:
    rough = equivalent_roughness(
        *conditions.flank_roughness,
        conditions.reduced_radius,
        conditions.viscosity_40,
        max(conditions.speed, _SLOWEST),
    )
    return WorkHardening(
        static=static_work_hardening_factor(hardness),
        endurance=work_hardening_factor(hardness, rough),
    )


def flank_resistance(
    role: Role,
    limits: PerGear[float],
    group: MaterialGroup,
    hardening: WorkHardening,
    conditions: Conditions,
    options: RatingOptions,
) -> Resistance:
    """sigma_HG of one gear: sigma_Hlim Z_NT Z_L Z_v Z_R Z_W Z_X (5); the film goes by the softer gear's sigma_Hlim (12)."""
    softer = min(limits)
    roughness = sum(conditions.flank_roughness) / 2
    size = flank_size_factor(conditions.normal_module, group, options.standard)
    wheel = role is Role.WHEEL
    return Resistance(
        reference=limits.pick(role),
        life_symbol="Z_NT",
        points=flank_points(group, pitting=options.pitting_permitted, long_life=options.long_life_factor),
        static={"Z_L": 1.0, "Z_v": 1.0, "Z_R": 1.0, "Z_W": hardening.static if wheel else 1.0, "Z_X": size},
        endurance={
            "Z_L": lubricant_factor(softer, conditions.viscosity_40),
            "Z_v": speed_factor(softer, max(conditions.speed, _SLOWEST)),
            "Z_R": flank_roughness_factor(softer, roughness, conditions.reduced_radius),
            "Z_W": hardening.endurance if wheel else 1.0,
            "Z_X": size,
        },
    )
