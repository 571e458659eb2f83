"""Scuffing temperatures: integral (ISO/TR 13989-2:2000) and flash (ISO/TR 13989-1:2000), of numbers or arrays.

Lengths in mm, angles in degrees. With a ring as the wheel gear ratio and centre distance are negative (ISO 21771).

Numbers in the text are equations of ISO/TR 13989-1. Places are Gamma = (T1Y - T1C)/T1C: 0 at the pitch point.

Numbers in the text are equations of ISO/TR 13989-2. All functions take numbers, or arrays of many meshes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, PerGear, Role, freeze
from gearcad.core.values import magnitude
from gearcad.geometry import GearPair
from gearcad.geometry.pair_data import PairSizes
from gearcad.material import Material, MaterialGroup
from gearcad.rating.options import Lubrication, OilType, RatingOptions

Size = float | Floats
"""A number, or an array of many meshes; functions of numbers give a number."""


@dataclass(frozen=True, kw_only=True)
class SlidingMesh:
    """Sizes of a mesh. Where the pinion drives, contact begins at the wheel's tip, A, and ends at the pinion's, E.

    `wheel_part` and `pinion_part` are the contact ratios of their tips, epsilon_2 and epsilon_1, on either side of the pitch
    point; `tip_curvature` is the pinion's radius of curvature at E in the transverse section.
    """

    gear_ratio: Size
    centre_distance: Size
    normal_pressure_angle: Size
    helix_angle: Size
    transverse_pressure_angle: Size
    working_pressure_angle: Size
    base_helix_angle: Size
    wheel_part: Size
    pinion_part: Size
    tip_curvature: Size
    total_contact_ratio: Size
    driver: Role = Role.PINION

    @classmethod
    def of(cls, pair: PairSizes[Any], total_contact_ratio: Size, driver: Role = Role.PINION) -> SlidingMesh:
        """Return the sizes of a pair, or of many, on the path of contact between the tip form circles."""
        path, pinion = pair.path_of_contact, pair.gears.pinion
        return cls(
            gear_ratio=pair.gear_ratio,
            centre_distance=pair.centre_distance,
            normal_pressure_angle=pinion.rack.pressure_angle,
            helix_angle=magnitude(pinion.helix_angle),
            transverse_pressure_angle=pinion.transverse_pressure_angle,
            working_pressure_angle=pair.working_transverse_pressure_angle,
            base_helix_angle=magnitude(pinion.base_helix_angle),
            wheel_part=(path.C - path.A) / pinion.transverse_base_pitch,
            pinion_part=(path.E - path.C) / pinion.transverse_base_pitch,
            tip_curvature=path.E,
            total_contact_ratio=total_contact_ratio,
            driver=driver,
        )

    @property
    def approach(self) -> Size:
        """epsilon_f: the contact ratio until the pitch point, of the tip that is driven."""
        return self.wheel_part if self.driver is Role.PINION else self.pinion_part

    @property
    def recess(self) -> Size:
        """epsilon_a: the contact ratio from the pitch point on, of the tip that drives."""
        return self.pinion_part if self.driver is Role.PINION else self.wheel_part

    @property
    def base_tangent(self) -> Size:
        """T1T2 = a sin alpha_wt."""
        return self.centre_distance * np.sin(np.radians(self.working_pressure_angle))

    @cached_property
    def pitch_radius(self) -> Size:
        """rho of both flanks together at the pitch point, transverse: u/(1 + u)^2 a sin alpha_wt (13989-1, 6)."""
        u = self.gear_ratio
        return u / (1 + u) ** 2 * self.base_tangent

    @cached_property
    def angle_factor(self) -> Size:
        """X_alpha_beta = 1.22 (sin alpha_wt cos alpha_n cos beta)^0.25/sqrt(cos alpha_wt cos alpha_t) (13989-2, 13).

        Part 1 prints a shorter form (A.8), 2 to 3 % below the table that both parts have; this one is the table's.
        """
        a_n, beta = np.radians(self.normal_pressure_angle), np.radians(self.helix_angle)
        a_t, a_wt = np.radians(self.transverse_pressure_angle), np.radians(self.working_pressure_angle)
        found: Size = 1.22 * (np.sin(a_wt) * np.cos(a_n) * np.cos(beta)) ** 0.25 / np.sqrt(np.cos(a_wt) * np.cos(a_t))
        return found


CONDUCTIVITY = 50.0
"""Thermal conductivity lambda_M (N/(s·K)) of steel (13989-2, 5.3)."""

HEAT_CAPACITY = 3.8
"""Heat capacity c_v (N/(mm²·K)) of steel, per volume (13989-2, 5.3)."""

_NITRIDED = (MaterialGroup.NITRIDING_STEEL, MaterialGroup.NITRIDED, MaterialGroup.NITROCARBURISED)

IRON = (
    MaterialGroup.NODULAR_IRON,
    MaterialGroup.FERRITIC_NODULAR_IRON,
    MaterialGroup.MALLEABLE_IRON,
    MaterialGroup.GREY_IRON,
)
"""Material groups of cast iron, whose thermal conductivity differs from that of steel."""


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


LUBRICANT = {
    OilType.MINERAL: 1.0,
    OilType.POLYALPHAOLEFIN: 0.8,
    OilType.POLYGLYCOL: 0.7,
    OilType.SOLUBLE_POLYGLYCOL: 0.6,
    OilType.ESTER: 1.3,
    OilType.TRACTION: 1.5,
}
"""X_L without the viscosity (ISO/TR 13989-1, 27; 13989-2, 5.1)."""

PRESSURE_VISCOSITY = {
    OilType.MINERAL: (26.57, 0.1348),
    OilType.POLYALPHAOLEFIN: (14.66, 0.0507),
    OilType.POLYGLYCOL: (13.92, 0.1572),
    OilType.SOLUBLE_POLYGLYCOL: (13.92, 0.1572),
}
"""c and e in alpha_38 = c eta_38^e (1/GPa, eta in Pa s), of ISO/TR 15144-1 as remembered: unconfirmed."""

LUBRICATION = {Lubrication.DIP: 1.0, Lubrication.SPRAY: 1.2, Lubrication.SUBMERGED: 0.2}
"""Lubrication factor X_S (ISO/TR 13989-1, 22)."""

Given = TypeVar("Given")

USUAL_VISCOSITY, USUAL_TEMPERATURE = 220.0, 70.0
"""Values assumed of an unspecified oil: viscosity in mm²/s at 40 °C, and temperature in °C."""

_USUAL_100 = (
    *((10, 2.637), (15, 3.381), (22, 4.254), (32, 5.290), (46, 6.644), (68, 8.530), (100, 11.067)),
    *((150, 14.544), (220, 18.749), (320, 23.952), (460, 30.34), (680, 39.056), (1000, 49.863), (1500, 64.213)),
)
"""Viscosities (mm²/s) at 40 and 100 °C of oils of viscosity index 95, from the tables L and H of ASTM D2270."""

_TEST_TORQUES = (0.0, 3.3, 13.7, 35.3, 60.8, 94.1, 135.3, 183.4, 239.3, 302.0, 372.6, 450.1, 534.5)
"""Torque (N·m) on the pinion of the load stages 0 to 12 of the FZG test A/8.3/90 (ISO 14635-1)."""


def kinematic_viscosity(viscosity_40: float, viscosity_100: float, temperature: float) -> float:
    """nu (mm²/s) at a temperature (°C), by Walther's line through both: lg lg(nu + 0.7) over lg T (ASTM D341)."""
    cold, hot, now = (math.log10(each + 273.15) for each in (40.0, 100.0, temperature))
    thick, thin = (math.log10(math.log10(each + 0.7)) for each in (viscosity_40, viscosity_100))
    return float(10**10 ** (thick - (thick - thin) * (now - cold) / (hot - cold)) - 0.7)


def usual_viscosity_100(viscosity_40: float) -> float:
    """nu_100 (mm²/s) of viscosity index 95; above ISO VG 1500 in proportion. Raises ParameterError below ISO VG 10."""
    cold, hot = np.log(_USUAL_100).T
    if (thick := math.log(viscosity_40)) < cold[0]:
        permitted = f"must be given, in mm²/s, of an oil below 10 mm²/s at 40 °C, here {viscosity_40:g} mm²/s"
        raise ParameterError("oil_viscosity_100", None, permitted)
    return math.exp(float(np.interp(thick, cold, hot)) + max(thick - float(cold[-1]), 0.0))


def usual_density(viscosity_40: float) -> float:
    """Density (kg/m³) of a mineral oil at 15 °C: 43.37 lg nu_40 + 805.5 (ISO/TR 15144-1, 21)."""
    return 43.37 * math.log10(viscosity_40) + 805.5


def stage_torque(stage: float) -> float:
    """T_1T (N·m) of a load stage: that of the test up to 12, and 3.726 FZG^2 (ISO/TR 13989-2, 97) above it."""
    return 3.726 * stage**2 if stage > 12 else float(np.interp(stage, range(13), _TEST_TORQUES))


@dataclass(frozen=True, kw_only=True)
class Oil:
    """An oil: viscosities in mm²/s, its `density` at 15 °C in kg/m³, its `temperature` in °C; and what of it is `assumed`."""

    viscosity_40: float
    viscosity_100: float
    density: float
    temperature: float
    kind: OilType = OilType.MINERAL
    assumed: tuple[str, ...] = ()

    @classmethod
    def of(cls, options: RatingOptions) -> Oil:
        """Return the oil of a rating; values that are not given are assumed and listed in `assumed`."""
        assumed: list[str] = []

        def known(value: Given | None, usual: Given, words: str) -> Given:
            if value is None:
                assumed.append(words)
            return usual if value is None else value

        nu_40 = known(
            options.oil_viscosity_40,
            USUAL_VISCOSITY,
            f"oil_viscosity_40 = {USUAL_VISCOSITY:g} mm²/s: oil ISO VG {USUAL_VISCOSITY:g}",
        )
        temperature = known(options.oil_temperature, USUAL_TEMPERATURE, f"oil_temperature = {USUAL_TEMPERATURE:g} °C")
        nu_100, density = options.oil_viscosity_100, usual_density(nu_40)
        if nu_100 is None:
            nu_100 = usual_viscosity_100(nu_40)
            assumed.append(f"oil_viscosity_100 = {nu_100:.4g} mm²/s: of viscosity index 95")
        return cls(
            viscosity_40=nu_40,
            viscosity_100=nu_100,
            density=known(options.oil_density, density, f"oil_density = {density:.4g} kg/m³: of a mineral oil"),
            temperature=temperature,
            kind=known(options.oil_type, OilType.MINERAL, f"oil_type = {OilType.MINERAL.value}"),
            assumed=tuple(assumed),
        )

    @property
    def kinematic_viscosity(self) -> float:
        """Kinematic viscosity nu (mm²/s) at the oil's temperature."""
        return kinematic_viscosity(self.viscosity_40, self.viscosity_100, self.temperature)

    @property
    def dynamic_viscosity(self) -> float:
        """eta (mPa·s) at the oil's temperature, which takes 0.7 kg/m³ from the density for each degree."""
        return self.kinematic_viscosity * (self.density - 0.7 * (self.temperature - 15)) / 1000

    @property
    def pressure_viscosity(self) -> float | None:
        """alpha_38 (1/GPa) of the kind of oil at 38 °C, unconfirmed; None of a kind for which there is none."""
        if self.kind not in PRESSURE_VISCOSITY:
            return None
        factor, exponent = PRESSURE_VISCOSITY[self.kind]
        return float(factor * (replace(self, temperature=38.0).dynamic_viscosity / 1000) ** exponent)

    @property
    def lubricant_factor(self) -> float:
        """X_L of the kind of oil, without its viscosity."""
        return LUBRICANT[self.kind]


GREATEST_SPEED = 50.0
"""Circumferential speed (m/s) beyond which friction falls no further."""

FLASH_BULK = 0.47
"""Share of the mean flash temperature that is added to the bulk temperature (22)."""

_STEPS = 40
"""Intervals of each of the stretches AB, BD and DE."""


def flash_scuffing_temperature(stage: float, lubricant: float, structure: float) -> float:
    """Theta_S (°C) = 80 + (0.85 + 1.4 X_W) X_L FZG^2 (99)."""
    return 80 + (0.85 + 1.4 * structure) * lubricant * stage**2


@dataclass(frozen=True, eq=False)
class FlashPath:
    """Places along the path of contact and the share of the load X_Gamma that a flank carries there; read-only arrays.

    The limits of single contact, B and D, stand twice among the places: X_Gamma jumps there.
    """

    places: Floats
    shares: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @classmethod
    def of(cls, pair: GearPair, grade: int) -> FlashPath:
        """Return the path of contact of a pair of an accuracy grade, with unmodified profiles (9.2, 9.4, 9.6).

        Up to a total contact ratio of 2 a flank takes (Q - 2)/15 of the load at A and E and 1/3 more at B and D, where it
        is left alone, Q the grade and at least 7 (57 to 60); above it 1/eps_alpha, the mean of all.
        """
        path = pair.path_of_contact
        first, left, right, last = ((each - path.C) / path.C for each in (path.A, path.B, path.D, path.E))
        if pair.total_contact_ratio > 2:
            places = np.linspace(first, last, 3 * _STEPS + 1)
            shares = np.full_like(places, 1 / pair.transverse_contact_ratio)
        else:
            places = np.concatenate([np.linspace(a, b, _STEPS + 1) for a, b in ((first, left), (left, right), (right, last))])
            grown = (max(grade, 7) - 2) / 15 + np.linspace(0, 1, _STEPS + 1) / 3
            shares = np.minimum(np.concatenate([grown, np.ones(_STEPS + 1), grown[::-1]]), 1.0)
        return cls(places, shares * buttressing(places, pair))

    @property
    def extent(self) -> float:
        """Gamma_E - Gamma_A."""
        return float(self.places[-1] - self.places[0])


def buttressing(places: Floats, pair: GearPair) -> Floats:
    """X_but (49 to 56): lines of contact are stiffer where they begin and end, over 0.2 sin beta_b; 1 of spur gears."""
    stretch = 0.2 * np.sin(np.radians(abs(pair.pinion.base_helix_angle)))
    if stretch == 0:
        return np.ones_like(places)
    peak = 0.3 * min(pair.overlap_ratio, 1.0)
    near = np.minimum(places - places[0], places[-1] - places)
    grown: Floats = 1 + peak * np.clip(1 - near / stretch, 0, None)
    return grown


@dataclass(frozen=True, kw_only=True)
class FlashTemperature:
    """The flash temperature along a path, and the quantities it is computed from.

    `specific_load` w_Bt in N/mm, all load factors in it; `speed` v_t at the working pitch circle in m/s, above 0; `roughness`
    the mean Ra of both flanks (µm), `lubricant` X_L with the viscosity in it, `relief_wanting` the tip relief (µm) that the
    driven tip lacks for the load, C_eff - C_a; `thermo_elastic` X_M, `lubrication` X_S, `mating` X_mp; `oil_temperature` in
    °C.
    """

    mesh: SlidingMesh
    path: FlashPath
    specific_load: float
    speed: float
    roughness: float
    lubricant: float
    thermo_elastic: float
    oil_temperature: float
    relief_wanting: float = 0.0
    lubrication: float = 1.0
    mating: float = 1.0

    @property
    def roughness_factor(self) -> float:
        """X_R = sqrt(Ra) (28), as printed reports have it."""
        return float(self.roughness**0.5)

    @cached_property
    def friction(self) -> float:
        """mu_m = 0.06 (w_Bt/(v_SC rho_C))^0.2 X_L X_R, v_SC = 2 v_t sin alpha_wt (25, 26)."""
        rolling = 2 * min(self.speed, GREATEST_SPEED) * np.sin(np.radians(self.mesh.working_pressure_angle))
        load = self.specific_load / (rolling * self.mesh.pitch_radius)
        return float(0.06 * load**0.2 * self.lubricant * self.roughness_factor)

    @cached_property
    def approach_factor(self) -> Floats:
        """X_J of each place (45 to 48): the shock where teeth meet without enough relief, before the pitch point only."""
        side = -1 if self.mesh.driver is Role.PINION else 1
        before = np.clip(side * self.path.places / self.path.extent, 0, None)
        return 1 + max(self.relief_wanting, 0.0) / 50 * before**3

    @cached_property
    def geometry_factor(self) -> Floats:
        """X_G of each place (A.6, A.7): 0 at the pitch point, where nothing slides."""
        u, place = float(self.mesh.gear_ratio), self.path.places
        slid = np.abs(np.sqrt(1 + place) - np.sqrt(1 - place / u))
        round_ = ((1 + place) * np.abs(u - place)) ** 0.25
        found: Floats = 0.51 * self.mesh.angle_factor * np.sqrt(abs(u + 1)) * slid / round_
        return found

    @cached_property
    def flash(self) -> Floats:
        """Theta_fl (K) of each place (A.5)."""
        heat = self.friction * self.thermo_elastic * self.speed**0.5 / abs(float(self.mesh.centre_distance)) ** 0.25
        load = (self.path.shares * self.specific_load) ** 0.75
        found: Floats = heat * self.approach_factor * self.geometry_factor * load
        found.flags.writeable = False
        return found

    @property
    def mean_flash(self) -> float:
        """Theta_flm (K) (24)."""
        return float(np.trapezoid(self.flash, self.path.places)) / self.path.extent

    @property
    def bulk(self) -> float:
        """Theta_M (°C) = Theta_oil + 0.47 X_S X_mp Theta_flm (22): bulk temperature of the teeth."""
        return self.oil_temperature + FLASH_BULK * self.lubrication * self.mating * self.mean_flash

    @property
    def contact(self) -> Floats:
        """Theta_B (°C) of each place (1)."""
        found: Floats = self.bulk + self.flash
        found.flags.writeable = False
        return found

    @property
    def value(self) -> float:
        """Theta_Bmax (°C) (2)."""
        return self.bulk + float(self.flash.max())

    @property
    def hottest(self) -> float:
        """Gamma of the highest contact temperature."""
        return float(self.path.places[np.argmax(self.flash)])


LEAST_LOAD = 150.0
"""Load w_Bt (N/mm) below which friction falls no further (5.1)."""


INTEGRAL_BULK, MEAN = 0.7, 1.5
"""C_1 and C_2: how much the mean flash temperature counts in that of the bulk, and in the integral temperature."""


def contact_ratio_factor(pinion_part: Size, wheel_part: Size) -> Size:
    """X_eps (39 to 44): the mean flash temperature over that at the pinion's tip, for contact ratios up to 3."""
    e_1, e_2 = pinion_part, wheel_part
    e_a = e_1 + e_2
    alone = e_1**2 + e_2**2
    double = 0.70 * alone - 0.22 * e_a + 0.52 - 0.60 * e_1 * e_2
    long_recess = 0.18 * e_1**2 + 0.70 * e_2**2 + 0.82 * e_1 - 0.52 * e_2 - 0.30 * e_1 * e_2
    long_approach = 0.70 * e_1**2 + 0.18 * e_2**2 - 0.52 * e_1 + 0.82 * e_2 - 0.30 * e_1 * e_2
    deep_recess = 0.44 * e_1**2 + 0.59 * e_2**2 + 0.30 * e_1 - 0.30 * e_2 - 0.15 * e_1 * e_2
    deep_approach = 0.59 * e_1**2 + 0.44 * e_2**2 - 0.30 * e_1 + 0.30 * e_2 - 0.15 * e_1 * e_2
    cases = [
        (e_a < 1, alone),
        ((e_a >= 2) & (e_1 >= e_2), deep_recess),
        (e_a >= 2, deep_approach),
        (e_1 >= 1, long_recess),
        (e_2 >= 1, long_approach),
    ]
    found: Size = np.select([case for case, _ in cases], [value for _, value in cases], double)[()] / (2 * e_a * e_1)
    return found


def approach_factor(recess: Size, approach: Size) -> Size:
    """X_Q (25 to 29): from 1 at epsilon_f/epsilon_a = 1.5 down to 0.6 at 3."""
    found: Size = 1.4 - 4 / 15 * np.clip(approach / recess, 1.5, 3.0)
    return found


def tip_relief_factor(pinion_part: Size, wheel_part: Size, relief: Size) -> Size:
    """X_Ca (32), `relief` the effective tip relief over the one that the load asks for, C_a/C_eff, at most 1."""
    e, q = np.maximum(pinion_part, wheel_part), np.clip(relief, 0.0, 1.0)
    found: Size = 1 + (0.06 + 0.18 * q) * e + (0.02 + 0.69 * q) * e**2
    return found


def integral_scuffing_temperature(test_torque: float, viscosity_40: float, lubricant: float, structure: float) -> float:
    """theta_intS (°C) (94 to 96): the integral temperature at which an oil fails in the test, for flanks of X_W."""
    bulk = 80 + 0.23 * test_torque * lubricant
    mean = 0.2 * test_torque * math.pow(100 / viscosity_40, 0.02) * lubricant
    return bulk + structure * MEAN * mean


@dataclass(frozen=True, kw_only=True)
class IntegralTemperature:
    """The integral temperature of a mesh, and the quantities it is computed from. Numbers, or arrays of one shape.

    `specific_load` w_Bt in N/mm, all load factors in it; `speed` at the reference circle in m/s, above 0; `roughness` the mean
    Ra of both flanks as run in (µm; X_E = 1), `viscosity` eta of the oil in the sump (mPa·s), `relief` C_a/C_eff of the gear
    whose tip relief counts, `lubricant` X_L of the kind of oil, `thermo_elastic` X_M, `lubrication` X_S, `mating` X_mp,
    `oil_temperature` in °C.
    """

    mesh: SlidingMesh
    specific_load: Size
    speed: Size
    roughness: Size
    viscosity: float
    thermo_elastic: float
    oil_temperature: float
    relief: Size = 0.0
    lubricant: float = 1.0
    lubrication: float = 1.0
    mating: float = 1.0

    @cached_property
    def helical_load(self) -> Size:
        """Helical load factor K_Bgamma."""
        return helical_load_factor(self.mesh.total_contact_ratio)

    @property
    def curvature(self) -> Size:
        """Reduced radius of curvature rho_redC (mm) (3): at the pitch point, in the normal section."""
        return self.mesh.pitch_radius / np.cos(np.radians(self.mesh.base_helix_angle))

    @property
    def roughness_factor(self) -> Size:
        """X_R = 2.2 (Ra/rho_redC)^0.25 (7)."""
        return 2.2 * (self.roughness / self.curvature) ** 0.25

    @cached_property
    def friction(self) -> Size:
        """mu_mC = 0.045 (w_Bt K_Bgamma/(v_SC rho_redC))^0.2 eta^-0.05 X_R X_L, v_SC = 2 v tan alpha_wt cos alpha_t (1, 2)."""
        a_t, a_wt = np.radians(self.mesh.transverse_pressure_angle), np.radians(self.mesh.working_pressure_angle)
        load = np.maximum(self.specific_load, LEAST_LOAD) * self.helical_load
        rolling = 2 * np.minimum(self.speed, GREATEST_SPEED) * np.tan(a_wt) * np.cos(a_t)
        oil = self.viscosity**-0.05 * self.lubricant
        found: Size = 0.045 * (load / (rolling * self.curvature)) ** 0.2 * oil * self.roughness_factor
        return found

    @cached_property
    def geometry_factor(self) -> Size:
        """X_BE (22): of the pinion's tip, rho_E2 = a sin alpha_wt - rho_E1."""
        u, rho_1 = self.mesh.gear_ratio, self.mesh.tip_curvature
        rho_2 = self.mesh.base_tangent - rho_1
        slid = np.sqrt(rho_1) - np.sqrt(rho_2 / u)
        found: Size = 0.51 * np.sqrt(np.abs(u + 1)) * slid / (rho_1 * np.abs(rho_2)) ** 0.25
        return found

    @cached_property
    def contact_ratio_factor(self) -> Size:
        """Contact ratio factor X_eps."""
        return contact_ratio_factor(self.mesh.pinion_part, self.mesh.wheel_part)

    @cached_property
    def approach_factor(self) -> Size:
        """Approach factor X_Q."""
        return approach_factor(self.mesh.recess, self.mesh.approach)

    @cached_property
    def tip_relief_factor(self) -> Size:
        """Tip relief factor X_Ca."""
        return tip_relief_factor(self.mesh.pinion_part, self.mesh.wheel_part, self.relief)

    @cached_property
    def tip_flash(self) -> Size:
        """theta_flaE (K) (19): the flash temperature at the pinion's tip, as if it carried all load."""
        size = self.specific_load * self.helical_load
        heat = size**0.75 * np.sqrt(self.speed) / np.abs(self.mesh.centre_distance) ** 0.25
        shape = self.thermo_elastic * self.geometry_factor * self.mesh.angle_factor
        return self.friction * shape * heat / (self.approach_factor * self.tip_relief_factor)

    @property
    def mean_flash(self) -> Size:
        """theta_flaint (K) (18): mean flash temperature over the path of contact."""
        return self.tip_flash * self.contact_ratio_factor

    @property
    def bulk(self) -> Size:
        """Bulk temperature theta_M (°C) (20) of the teeth."""
        return self.oil_temperature + INTEGRAL_BULK * self.lubrication * self.mating * self.mean_flash

    @property
    def value(self) -> Size:
        """Integral temperature theta_int (°C) (17)."""
        return self.bulk + MEAN * self.mean_flash


@dataclass(frozen=True, kw_only=True)
class ScuffingLimits:
    """theta_intS and Theta_S (°C) of an oil between flanks of a structure factor X_W; `test_torque` T_1T in N·m."""

    stage: int
    structure: float
    test_torque: float
    integral: float
    flash: float

    @classmethod
    def of(cls, oil: Oil, stage: int, structure: float) -> ScuffingLimits:
        """Return the scuffing limits of an oil that fails in load stage `stage`, for flanks of structure factor X_W."""
        torque, lubricant = stage_torque(stage), oil.lubricant_factor
        return cls(
            stage=stage,
            structure=structure,
            test_torque=torque,
            integral=integral_scuffing_temperature(torque, oil.viscosity_40, lubricant, structure),
            flash=flash_scuffing_temperature(stage, lubricant * oil.dynamic_viscosity**-0.05, structure),
        )
