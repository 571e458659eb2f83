"""Scuffing of a pair under its load: both temperatures, and the margins to those at which its oil fails."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple, Protocol

import numpy as np

from gearcad.core.records import Notice, PerGear, Role
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.rating.editions import both
from gearcad.rating.options import Lubrication, OilType, RatingOptions
from gearcad.rating.scuffing_temperatures import (
    GREATEST_SPEED,
    IRON,
    LEAST_LOAD,
    LUBRICATION,
    FlashPath,
    FlashTemperature,
    IntegralTemperature,
    Oil,
    ScuffingLimits,
    SlidingMesh,
    mating_factor,
    structure_factor,
    thermo_elastic_factor,
)
from gearcad.rating.tooth_stiffness import MeshStiffness, mesh_stiffness

LEAST_MARGIN = 50.0
"""Distance (K) to the scuffing temperature that ISO/TR 13989-1, 10.5, gives as one to ask for."""


class Risk(StrEnum):
    """Risk of scuffing."""

    HIGH = "high"
    CRITICAL = "critical"
    LOW = "low"


def integral_risk(safety: float) -> Risk:
    """Return the risk for a safety S_int (ISO/TR 13989-2, 6.1.1): high below 1, critical up to 2, low above."""
    return Risk.HIGH if safety < 1 else Risk.CRITICAL if safety <= 2 else Risk.LOW


def flash_risk(margin: float) -> Risk:
    """Return the risk for a margin Theta_S - Theta_B (K): high below 0, critical below 50 K, low from there on."""
    return Risk.HIGH if margin < 0 else Risk.CRITICAL if margin < LEAST_MARGIN else Risk.LOW


@dataclass(frozen=True, kw_only=True)
class Scuffing:
    """Temperatures in °C where there are any, `limits` where the oil's load stage is known; else `reason` says why not.

    `flash` alone can be missing: its notice says why.
    """

    oil: Oil
    integral: IntegralTemperature | None = None
    flash: FlashTemperature | None = None
    limits: ScuffingLimits | None = None
    assumed: tuple[str, ...] = ()
    verify: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    reason: str = ""

    @property
    def judged(self) -> bool:
        """Whether the rating has a safety."""
        return self.integral_safety is not None

    @property
    def integral_safety(self) -> float | None:
        """S_int = theta_intS/theta_int (ISO/TR 13989-2, 14)."""
        if self.integral is None or self.limits is None:
            return None
        return self.limits.integral / float(self.integral.value)

    @property
    def load_safety(self) -> float | None:
        """S_SL = (theta_intS - theta_oil)/(theta_int - theta_oil) (ISO/TR 13989-2, 15): about how much more load would do."""
        if self.integral is None or self.limits is None:
            return None
        return (self.limits.integral - self.oil.temperature) / (float(self.integral.value) - self.oil.temperature)

    @property
    def flash_safety(self) -> float | None:
        """S_B = (Theta_S - Theta_oil)/(Theta_B - Theta_oil) (ISO/TR 13989-1, 100)."""
        if self.flash is None or self.limits is None:
            return None
        return (self.limits.flash - self.oil.temperature) / (self.flash.value - self.oil.temperature)

    @property
    def safeties(self) -> dict[str, float]:
        """Safeties that are known, under their symbols."""
        both = {"S_int": self.integral_safety, "S_B": self.flash_safety}
        return {symbol: value for symbol, value in both.items() if value is not None}

    @property
    def margin(self) -> float | None:
        """Theta_S - Theta_B (K) (ISO/TR 13989-1, 10.5)."""
        return None if self.flash is None or self.limits is None else self.limits.flash - self.flash.value

    @property
    def integral_risk(self) -> Risk | None:
        """Risk by S_int; None if S_int is not known."""
        return None if self.integral_safety is None else integral_risk(self.integral_safety)

    @property
    def flash_risk(self) -> Risk | None:
        """Risk by Theta_S - Theta_B; None if the margin is not known."""
        return None if self.margin is None else flash_risk(self.margin)

    @property
    def risk(self) -> Risk | None:
        """The worse of both."""
        known = [each for each in (self.integral_risk, self.flash_risk) if each is not None]
        return min(known, key=list(Risk).index) if known else None

    def to_dict(self) -> dict[str, Any]:
        """Return the values under their symbols, by method; unknown values are left out."""
        return {
            "oil": self._oil(),
            **({} if self.integral is None else {"integral": self._integral(self.integral)}),
            **({} if self.flash is None else {"flash": self._flash(self.flash)}),
            **({} if self.risk is None else {"risk": self.risk.value}),
            **({"reason": self.reason} if self.reason else {}),
            "assumed": list(self.assumed),
            "verify": list(self.verify),
            "unconfirmed": list(self.verify),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def _oil(self) -> dict[str, Any]:
        oil, limits = self.oil, self.limits
        test = {} if limits is None else {"FZG": limits.stage, "T_1T": limits.test_torque, "X_W": limits.structure}
        return {
            "type": oil.kind.value,
            "nu_40": oil.viscosity_40,
            "nu_100": oil.viscosity_100,
            "rho_15": oil.density,
            "theta_oil": oil.temperature,
            "nu_oil": oil.kinematic_viscosity,
            "eta_oil": oil.dynamic_viscosity,
            **test,
        }

    def _integral(self, found: IntegralTemperature) -> dict[str, Any]:
        values = {
            "w_Bt": found.specific_load,
            "K_Bgamma": found.helical_load,
            "v": found.speed,
            "mu_mC": found.friction,
            "X_L": found.lubricant,
            "X_R": found.roughness_factor,
            "X_M": found.thermo_elastic,
            "X_alphabeta": found.mesh.angle_factor,
            "X_BE": found.geometry_factor,
            "X_eps": found.contact_ratio_factor,
            "X_Q": found.approach_factor,
            "X_Ca": found.tip_relief_factor,
            "X_S": found.lubrication,
            "X_mp": found.mating,
            "theta_flaE": found.tip_flash,
            "theta_flaint": found.mean_flash,
            "theta_M": found.bulk,
            "theta_int": found.value,
            **({} if self.limits is None else {"theta_intS": self.limits.integral}),
            **({} if self.integral_safety is None else {"S_int": self.integral_safety}),
            **({} if self.load_safety is None else {"S_SL": self.load_safety}),
        }
        risk = {} if self.integral_risk is None else {"risk": self.integral_risk.value}
        return {**{name: float(value) for name, value in values.items()}, **risk}

    def _flash(self, found: FlashTemperature) -> dict[str, Any]:
        path, hottest = found.path, int(np.argmax(found.flash))
        values = {
            "w_Bt": found.specific_load,
            "v_t": found.speed,
            "mu_m": found.friction,
            "X_L": found.lubricant,
            "X_R": found.roughness_factor,
            "X_M": found.thermo_elastic,
            "X_J": found.approach_factor[hottest],
            "X_Gamma": path.shares[hottest],
            "Gamma": found.hottest,
            "Gamma_A": path.places[0],
            "Gamma_E": path.places[-1],
            "theta_flm": found.mean_flash,
            "theta_flmax": found.flash[hottest],
            "theta_M": found.bulk,
            "theta_B": found.value,
            **({} if self.limits is None else {"theta_S": self.limits.flash}),
            **({} if self.flash_safety is None else {"S_B": self.flash_safety}),
            **({} if self.margin is None else {"margin": self.margin}),
        }
        along = {"Gamma": path.places, "X_Gamma": path.shares, "theta_fl": found.flash, "theta_B": found.contact}
        return {
            **{name: float(value) for name, value in values.items()},
            **({} if self.flash_risk is None else {"risk": self.flash_risk.value}),
            "path": {name: values.tolist() for name, values in along.items()},
        }


LEAST_SPEED = 1.0
"""Circumferential speed (m/s) below which friction is higher than the formula says (ISO/TR 13989-2, 5.1)."""

DEEPEST = 2.5
"""Transverse contact ratio up to which ISO/TR 13989-2, 6.1, holds."""

FINE = 6
"""The coarsest accuracy grade whose tip relief ISO/TR 13989-2, 6.1.12, counts."""


def scuffing_notices(
    pair: GearPair, options: RatingOptions, integral: IntegralTemperature, flash: FlashTemperature | None
) -> Iterator[Notice]:
    """Yield a notice for each limit of validity that is passed, and what the rating does there."""
    load, speed = float(integral.specific_load), float(integral.speed)
    if load < LEAST_LOAD:
        text = f"friction is that of {LEAST_LOAD:g} N/mm in the integral temperature, the load is {load:.4g} N/mm"
        yield Notice("scuffing-low-load", f"scuffing: {text}")
    if speed > GREATEST_SPEED:
        text = f"friction is that of {GREATEST_SPEED:g} m/s, the speed is {speed:.4g} m/s"
        yield Notice("scuffing-high-speed", f"scuffing: {text}")
    elif speed < LEAST_SPEED:
        text = f"at {speed:.3g} m/s, below {LEAST_SPEED:g} m/s, friction is higher than ISO/TR 13989 says"
        yield Notice("scuffing-low-speed", f"scuffing: {text}")
    if (ratio := pair.transverse_contact_ratio) > DEEPEST:
        text = f"ISO/TR 13989-2 holds for contact ratios up to {DEEPEST:g}, here {ratio:.4f}"
        yield Notice("scuffing-contact-ratio", f"scuffing: {text}")
    if flash is None:
        text = f"a spur pair with a contact ratio of 2 and more, here {ratio:.4f}, has no shares of load in ISO/TR 13989-1"
        yield Notice("no-flash-temperature", f"scuffing: no flash temperature: {text}")
    elif (helical := float(integral.helical_load)) > 1:
        hotter = 100 * (helical**0.75 - 1)
        text = f"the flash temperature leaves K_Bgamma = {helical:.4g} out, which would raise it by {hotter:.2g} %"
        yield Notice("helical-load-factor", f"scuffing: {text}: sources do not agree")
    grade = max(options.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade for gear in pair.gears)
    if integral.relief > 0 and grade > FINE:
        text = f"X_Ca counts tip relief, which ISO/TR 13989-2 does up to accuracy grade {FINE}, here {grade}"
        yield Notice("relief-of-coarse-gears", f"scuffing: {text}")


def uncertain(pair: GearPair, options: RatingOptions, integral: IntegralTemperature) -> Iterator[str]:
    """Yield the symbols of values that rest on a single source, or on memory."""
    yield from ("X_J", "X_Gamma")
    if float(integral.helical_load) > 1:
        yield "K_Bgamma"
    if options.scuffing_stage is not None and options.relative_structure_factor is None:
        yield "X_W"
    if options.oil_type not in (None, OilType.MINERAL):
        yield "X_L"
    if options.oil_supply is not Lubrication.DIP:
        yield "X_S"
    if max(both(options.contacts_per_turn)) != 1:
        yield "X_mp"
    if pair.internal:
        yield from ("X_BE", "X_G")


USUAL_ROUGHNESS = 4.8
"""Roughness Rz (µm) assumed of flanks for which none is given."""

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
    """Tip reliefs: the effective one over the required one (part 2), and the lack at the driven tip (µm, part 1)."""

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
    integral, flash = _temperatures(
        SlidingMesh.of(pair, pair.total_contact_ratio, driver), pair, materials, load, load_factors, options, oil
    )
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


def _reliefs(pair: GearPair, mesh: SlidingMesh, specific_load: float, stiffness: MeshStiffness[float]) -> _Reliefs:
    """Return the ratio of C_eff to the load F_t K_A K_gamma/b (N/mm): by c' (spur) or c_gamma_alpha (part 2, 33 to 38; part 1,
    B.1).

    The driving gear's relief counts where its recess is long, epsilon_a > 1.5 epsilon_f; else that of the driven one.
    """
    rigid = stiffness.mesh_alpha if pair.pinion.helix_angle else stiffness.single
    driving, driven = (pair.gears.pick(role).modification.tip_relief for role in (mesh.driver, mesh.driver.mate))
    counted = driving if mesh.recess > 1.5 * mesh.approach else driven
    across = math.cos(math.radians(pair.pinion.transverse_pressure_angle))
    return _Reliefs(min(counted * rigid / specific_load, 1.0), specific_load / (across * stiffness.mesh_alpha) - driven)


def _not_covered(pair: GearPair, load: Load) -> str:
    """Return the reason why there are no temperatures; "" if there are."""
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
