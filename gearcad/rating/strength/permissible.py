"""Permissible stresses of flanks (ISO 6336-2:2006) and roots (ISO 6336-3:2006)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic

import numpy as np

from gearcad.core.records import PerGear, Role
from gearcad.core.values import Values, larger
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.load import Load
from gearcad.material import Material, MaterialGroup
from gearcad.rating.editions import both
from gearcad.rating.factors import (
    cautious_strength,
    equivalent_roughness,
    flank_points,
    flank_roughness_factor,
    flank_size_factor,
    lubricant_factor,
    mesh_radius,
    notch_sensitivity_factor,
    root_points,
    root_size_factor,
    root_surface_factor,
    speed_factor,
    static_notch_sensitivity_factor,
    static_work_hardening_factor,
    through_hardened_factor,
    work_hardening_factor,
)
from gearcad.rating.load_factor_formulas import circumferential_speed
from gearcad.rating.material_limits import Family
from gearcad.rating.options import RatingOptions
from gearcad.rating.root_stress import RootRating
from gearcad.rating.strength.duty import Resistance

VISCOSITY = 220.0
"""Viscosity of an oil ISO VG 220 at 40 °C (mm²/s), which is assumed where none is given."""

FLANK_ROUGHNESS = 4.8
ROOT_ROUGHNESS = 20.0
"""Rz (µm) that are assumed of ground flanks and of milled roots."""


@dataclass(frozen=True, kw_only=True)
class Conditions(Generic[Values]):
    """Viscosity at 40 °C (mm²/s), speed at the reference circle (m/s), rho_red at the pitch point (mm), Rz (µm), m_n (mm).

    `assumed` says in words what was not given.
    """

    viscosity_40: float
    speed: Values
    reduced_radius: Values
    flank_roughness: PerGear[float]
    root_roughness: PerGear[float]
    normal_module: Values
    gear_ratio: Values
    assumed: tuple[str, ...] = ()

    @classmethod
    def of(cls, pair: GearPair | RackPair, load: Load, options: RatingOptions) -> Conditions[float]:
        """Return the conditions of a pair at the speed of the load."""
        pinion = pair.pinion
        teeth: PerGear[Gear | Rack] = PerGear(pinion, pair.wheel if isinstance(pair, GearPair) else pair.rack)
        given = {name: PerGear(*(getattr(gear, name, None) for gear in teeth)) for name in _ROUGHNESS}
        return Conditions(
            viscosity_40=viscosity_of(options),
            speed=circumferential_speed(pinion.reference_diameter, load.speed),
            reduced_radius=_reduced_radius(pair),
            flank_roughness=_or(given["flank_roughness"], FLANK_ROUGHNESS),
            root_roughness=_or(given["root_roughness"], ROOT_ROUGHNESS),
            normal_module=pinion.normal_module,
            gear_ratio=pair.gear_ratio if isinstance(pair, GearPair) else math.inf,
            assumed=tuple(_assumed(given, options, "wheel" if isinstance(pair, GearPair) else "rack")),
        )


def viscosity_of(options: RatingOptions) -> float:
    """Return the viscosity at 40 °C (mm²/s), given or assumed."""
    return VISCOSITY if options.oil_viscosity_40 is None else options.oil_viscosity_40


_ROUGHNESS = {"flank_roughness": FLANK_ROUGHNESS, "root_roughness": ROOT_ROUGHNESS}


def _or(values: PerGear[float | None], assumed: float) -> PerGear[float]:
    return values.map(lambda value: assumed if value is None else value)


def _reduced_radius(pair: GearPair | RackPair) -> float:
    """Return the reduced radius of curvature rho_red (mm); of a pinion and a rack that of the pinion's flank."""
    tangent = math.tan(math.radians(pair.working_transverse_pressure_angle))
    if isinstance(pair, RackPair):
        return pair.pinion.base_diameter / 2 * tangent
    return mesh_radius(pair.pinion.base_diameter, pair.wheel.base_diameter, tangent)


def _assumed(given: dict[str, PerGear[float | None]], options: RatingOptions, mate: str) -> Iterator[str]:
    if options.oil_viscosity_40 is None:
        yield f"oil_viscosity_40 = {VISCOSITY:g} mm²/s: oil ISO VG 220"
    for name, roughness in given.items():
        lacking = [gear for gear, value in zip(("pinion", mate), roughness, strict=True) if value is None]
        if lacking:
            yield f"{name} = {_ROUGHNESS[name]:g} µm (Rz) of {' and '.join(lacking)}"


_BRINELL_OF_VICKERS = 0.95
"""HB over HV of steel (ISO 18265): part 5 has the hardness of through-hardened steel in HV, Z_W asks for HB."""

_SLOWEST = 1e-6
"""Speed (m/s) that represents rest, where Z_v and R_zH have a limit."""

_WROUGHT_OR_CAST = (Family.STRUCTURAL, Family.THROUGH_HARDENED)
_IRON = (MaterialGroup.NODULAR_IRON, MaterialGroup.MALLEABLE_IRON)
HARD = (Family.CASE_HARDENED, Family.SURFACE_HARDENED, Family.NITRIDED, Family.NITROCARBURISED)
"""Flanks that smooth and harden those of a soft mate."""


@dataclass(frozen=True, kw_only=True)
class WorkHardening(Generic[Values]):
    """Z_W of the wheel, of static strength and of endurance; `assumed` says what was not given for it."""

    static: Values = 1.0
    endurance: Values = 1.0
    assumed: str = ""


def work_hardening(materials: PerGear[Material], conditions: Conditions[Values]) -> WorkHardening[Values]:
    """Return Z_W by clause 13: for a soft steel wheel whose pinion is hard (13.2) or harder (13.3). Of a pinion it is 1."""
    pinion, wheel = materials
    if pinion.group is None or wheel.group is None or pinion.plastic or wheel.plastic or not is_soft(wheel.group):
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


def _by_hard_pinion(hardness: float, conditions: Conditions[Values]) -> WorkHardening[Values]:
    rough = equivalent_roughness(
        *conditions.flank_roughness,
        conditions.reduced_radius,
        conditions.viscosity_40,
        larger(conditions.speed, _SLOWEST),
    )
    return WorkHardening(
        static=static_work_hardening_factor(hardness),
        endurance=work_hardening_factor(hardness, rough),
    )


def flank_resistance(
    role: Role,
    limits: PerGear[float],
    group: MaterialGroup,
    hardening: WorkHardening[Values],
    conditions: Conditions[Values],
    options: RatingOptions,
) -> Resistance[Values]:
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
            "Z_v": speed_factor(softer, larger(conditions.speed, _SLOWEST)),
            "Z_R": flank_roughness_factor(softer, roughness, conditions.reduced_radius),
            "Z_W": hardening.endurance if wheel else 1.0,
            "Z_X": size,
        },
    )


Y_ST = 2.0
"""Stress correction factor of the gears that sigma_Flim was measured on."""


@dataclass(frozen=True, kw_only=True)
class NotchStrength(Generic[Values]):
    """The strength (MPa) that Y_delta_relT goes by; None of groups that need none. `assumed`: in words, if it was not given."""

    value: Values | None
    assumed: str = ""


def notch_strength(material: Material, group: MaterialGroup, notch_parameter: Values) -> NotchStrength[Values]:
    """Return the material's own, or that of its group which makes the factor least."""
    grey = Family.of(group) is Family.GREY_IRON
    name, own = ("tensile_strength", material.tensile_strength) if grey else ("yield_strength", material.yield_strength)
    if own is not None or (cautious := cautious_strength(notch_parameter, group)) is None:
        return NotchStrength(value=own)
    of_one = not isinstance(cautious, np.ndarray)
    assumed = f"{name} = {cautious:g} MPa of {group.value}: where Y_delta_relT is least" if of_one else ""
    return NotchStrength(value=cautious, assumed=assumed)


def root_resistance(
    role: Role,
    limit: float,
    group: MaterialGroup,
    strength: Values | None,
    root: RootRating[Values],
    conditions: Conditions[Values],
    options: RatingOptions,
) -> Resistance[Values]:
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
