"""scuffing: both scuffing temperatures of a pair under its load, and what they leave to those at which the oil fails."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple, Protocol

from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.per_gear import PerGear, Role
from gearcad.rating.both import both
from gearcad.rating.iso6336_1 import MeshStiffness, mesh_stiffness
from gearcad.rating.options import RatingOptions
from gearcad.rating.scuffing.flash import FlashPath, FlashTemperature
from gearcad.rating.scuffing.heat import IRON, mating_factor, structure_factor, thermo_elastic_factor
from gearcad.rating.scuffing.integral import IntegralTemperature
from gearcad.rating.scuffing.limits import ScuffingLimits
from gearcad.rating.scuffing.notices import scuffing_notices, uncertain
from gearcad.rating.scuffing.oil import LUBRICATION, Oil
from gearcad.rating.scuffing.result import Scuffing
from gearcad.rating.scuffing.sliding import SlidingMesh

__all__ = ["FlankFactors", "scuffing"]

USUAL_ROUGHNESS = 4.8
"""Rz (µm) of flanks of which nothing is said."""

RZ_OVER_RA = 6.0


class FlankFactors(Protocol):
    """Load factors of a flank: K_A, K_gamma, K_v, K_Hbeta and K_Halpha."""

    @property
    def application(self) -> float: ...
    @property
    def mesh_load(self) -> float: ...
    @property
    def dynamic(self) -> float: ...
    @property
    def face_flank(self) -> float: ...
    @property
    def transverse_flank(self) -> float: ...


class _Reliefs(NamedTuple):
    """Tip relief: what counts over what the load asks for (part 2), and what the driven tip lacks (µm, part 1)."""

    counted: float
    wanting: float


def scuffing(
    pair: GearPair,
    materials: PerGear[Material],
    load: Load,
    load_factors: FlankFactors,
    options: RatingOptions,
    driver: Role = Role.PINION,
) -> Scuffing:
    """Integral and flash temperature of a pair one of whose gears drives, with the margins to those of the oil.

    Without a `scuffing_stage` the temperatures stand alone, and without a speed, or where contact leaves the involutes, there
    is none: `Scuffing.reason` says why. Raises ParameterError for an oil that is not known well enough.
    """
    oil = Oil.of(options)
    supply = () if options.lubrication is not None else (f"lubrication = {options.oil_supply.value}",)
    assumed = [*oil.assumed, *supply, *_assumed(pair, materials)]
    if reason := _not_covered(pair, load):
        return Scuffing(oil=oil, assumed=tuple(assumed), reason=reason)
    integral, flash = _temperatures(SlidingMesh.of(pair, driver), pair, materials, load, load_factors, options, oil)
    stage, structure = options.scuffing_stage, options.relative_structure_factor or structure_factor(materials)
    return Scuffing(
        oil=oil,
        integral=integral,
        flash=flash,
        limits=None if stage is None else ScuffingLimits.of(oil, stage, structure),
        assumed=tuple(assumed),
        verify=tuple(uncertain(pair, options, integral)),
        notices=tuple(scuffing_notices(pair, options, integral, flash)),
        reason="the scuffing_stage of the oil in the FZG test A/8.3/90 is not given" if stage is None else "",
    )


def _temperatures(
    mesh: SlidingMesh,
    pair: GearPair,
    materials: PerGear[Material],
    load: Load,
    factors: FlankFactors,
    options: RatingOptions,
    oil: Oil,
) -> tuple[IntegralTemperature, FlashTemperature | None]:
    width = pair.common_width.width
    force = 2000 * abs(load.torque) / pair.pinion.reference_diameter
    outer = force * factors.application * factors.mesh_load / width
    specific = outer * factors.dynamic * factors.face_flank * factors.transverse_flank
    stiffness = mesh_stiffness(pair, materials, force * factors.application / width)
    relief = _reliefs(pair, mesh, outer, stiffness)
    roughness = sum(gear.flank_roughness or USUAL_ROUGHNESS for gear in pair.gears) / 2 / RZ_OVER_RA
    turning = math.pi * abs(load.speed) / 60_000
    thermo_elastic, lubrication = thermo_elastic_factor(materials), LUBRICATION[options.oil_supply]
    mating = mating_factor(max(both(options.contacts_per_turn)))
    integral = IntegralTemperature(
        mesh=mesh,
        specific_load=specific,
        speed=turning * pair.pinion.reference_diameter,
        roughness=roughness,
        viscosity=oil.dynamic_viscosity,
        lubricant=oil.lubricant_factor,
        thermo_elastic=thermo_elastic,
        relief=relief.counted,
        lubrication=lubrication,
        mating=mating,
        oil_temperature=oil.temperature,
    )
    if pair.pinion.helix_angle == 0 and pair.transverse_contact_ratio >= 2:
        return integral, None
    grade = max(options.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade for gear in pair.gears)
    flash = FlashTemperature(
        mesh=mesh,
        path=FlashPath.of(pair, grade),
        specific_load=specific,
        speed=turning * pair.working_pitch_diameters.pinion,
        roughness=roughness,
        lubricant=oil.lubricant_factor * oil.dynamic_viscosity**-0.05,
        thermo_elastic=thermo_elastic,
        relief_wanting=relief.wanting,
        lubrication=lubrication,
        mating=mating,
        oil_temperature=oil.temperature,
    )
    return integral, flash


def _reliefs(pair: GearPair, mesh: SlidingMesh, specific_load: float, stiffness: MeshStiffness) -> _Reliefs:
    """Over C_eff of the load F_t K_A K_gamma/b (N/mm): by c' (spur) or c_gamma_alpha (part 2, 33 to 38; part 1, B.1).

    The driving gear's relief counts where its recess is long, epsilon_a > 1.5 epsilon_f; else that of the driven one.
    """
    rigid = stiffness.mesh_alpha if pair.pinion.helix_angle else stiffness.single
    driving, driven = (pair.gears.pick(role).modification.tip_relief for role in (mesh.driver, mesh.driver.mate))
    counted = driving if mesh.recess > 1.5 * mesh.approach else driven
    across = math.cos(math.radians(pair.pinion.transverse_pressure_angle))
    return _Reliefs(min(counted * rigid / specific_load, 1.0), specific_load / (across * stiffness.mesh_alpha) - driven)


def _not_covered(pair: GearPair, load: Load) -> str:
    """Why there are no temperatures; "" where there are."""
    path, whole = pair.path_of_contact, pair.base_tangent.length
    if load.speed == 0:
        return "the speed is 0 rpm: nothing slides"
    if path.A <= 0 or (not pair.internal and path.E >= whole):
        return "contact reaches a base circle, where flanks have no curvature"
    if not path.A < path.C < path.E:
        return "the pitch point is outside the path of contact"
    return ""


def _assumed(pair: GearPair, materials: PerGear[Material]) -> Iterator[str]:
    if lacking := [role.value for role, gear in pair.gears.items() if gear.flank_roughness is None]:
        yield f"flank_roughness = {USUAL_ROUGHNESS:g} µm (Rz) of {' and '.join(lacking)}"
    if any(each.group in IRON for each in materials):
        yield "heat conductivity and heat capacity of steel"
