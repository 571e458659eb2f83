"""Formulas of VDI 2736-2:2014 for cylindrical gears of plastic, in plastic or in steel: loss, temperature, stresses, wear.

The text of the guideline was not at hand: what a printed report (FVA-Workbench, steel 51 with plastic 52) has confirmed is the
loss H_V, the contact ratios of the addenda, the active flank, the temperature in oil, Z_E with both moduli, mean wear and
deformation. Coefficients of heat are by one public program, coefficients of friction as remembered. mm, N, W, °C, MPa.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from gearcad.core.records import PerGear, Role
from gearcad.geometry import Gear, GearPair
from gearcad.load import ToothLubrication
from gearcad.material import Material
from gearcad.rating.contact_stress import contact_ratio_factor, helix_angle_factor, zone_factor
from gearcad.rating.editions import Edition
from gearcad.rating.root_section import VirtualGear, load_point, root_section
from gearcad.rating.root_stress import form_factor, loaded_width, stress_correction_factor
from gearcad.rating.root_stress import helix_angle_factor as root_helix_angle_factor

Y_ST = 2.0
"""Stress correction factor of the reference gears, Y_St."""

REQUIRED_ROOT, REQUIRED_FLANK, REQUIRED_STATIC = 2.0, 1.4, 1.5
"""Required safeties S_Fmin, S_Hmin and S_Smin where none are given."""

PERMITTED_WEAR = 0.1
"""Permitted mean wear of a flank, W_zul/m_n."""

PERMITTED_LOCAL_WEAR = 0.2
"""Permitted wear at the worst place of a flank, in m_n."""

PERMITTED_DEFORMATION = 0.1
"""Permitted deformation of a pair of teeth that transmits rotation, in m_n, as remembered."""


def tip_contact_ratios(pair: GearPair) -> PerGear[float]:
    """Return eps_1 and eps_2, the contact ratios of the addenda: z/(2 pi) (tan alpha_aN - tan alpha_wt), of usable tips."""
    working = math.tan(math.radians(pair.working_transverse_pressure_angle))

    def ratio(gear: Gear) -> float:
        tip = math.tan(math.acos(gear.base_diameter / gear.tip_form_diameter))
        return gear.teeth / (2 * math.pi) * (tip - working)

    return pair.gears.map(ratio)


def degree_of_tooth_loss(pair: GearPair) -> float:
    """Return the degree of tooth loss H_V.

    pi (u + 1)/(z_2 cos beta_b) (1 - eps_1 - eps_2 + eps_1^2 + eps_2^2); for eps_alpha above 2 the bracket is eps_alpha/2.
    """
    one, two = tip_contact_ratios(pair)
    bracket = (one + two) / 2 if one + two > 2 else 1 - one - two + one**2 + two**2
    lean = math.cos(math.radians(pair.pinion.base_helix_angle))
    return math.pi * (pair.gear_ratio + 1) / (pair.wheel.teeth * lean) * bracket


def active_flank_lengths(pair: GearPair) -> PerGear[float]:
    """Return l_Fl (mm) of both gears, the lengths of the flanks that touch: (d_Na^2 - d_Nf^2)/(4 d_b)."""
    line = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))

    def length(role: Role) -> float:
        gear, mate = pair.gears.pick(role), pair.gears.pick(role.mate)
        end = line - math.sqrt(mate.tip_form_diameter**2 - mate.base_diameter**2) / 2
        root = 2 * math.hypot(gear.base_diameter / 2, end)
        return float((gear.tip_form_diameter**2 - root**2) / (4 * gear.base_diameter))

    return PerGear.each(length)


class TipRoot(NamedTuple):
    """Root of a tooth that is loaded at its tip: Y_Fa, Y_Sa, Y_eps, Y_beta, and the width (mm) that carries."""

    form_factor: float
    stress_correction_factor: float
    contact_ratio_factor: float
    helix_angle_factor: float
    width: float

    def stress(self, force: float, normal_module: float) -> float:
        """Return sigma_F0 (MPa) under a tangential force (N)."""
        factors = self.form_factor * self.stress_correction_factor * self.contact_ratio_factor * self.helix_angle_factor
        return factors * force / (self.width * normal_module)


@dataclass(frozen=True)
class PlasticGeometry:
    """Figures of the teeth that the rating of a pair takes."""

    pair: GearPair

    @cached_property
    def tip_ratios(self) -> PerGear[float]:
        """Contact ratios of the addenda eps_1 and eps_2."""
        return tip_contact_ratios(self.pair)

    @cached_property
    def tooth_loss(self) -> float:
        """Degree of tooth loss H_V."""
        return degree_of_tooth_loss(self.pair)

    @cached_property
    def flank_lengths(self) -> PerGear[float]:
        """Lengths of the active flanks l_Fl (mm)."""
        return active_flank_lengths(self.pair)

    @cached_property
    def roots(self) -> PerGear[TipRoot]:
        """Roots of both gears under a load at the tip.

        Y_Fa and Y_Sa are those of ISO 6336-3 with the load at the tip, Y_eps = 0.25 + 0.75/eps_alpha.
        """
        pair = self.pair

        def root(role: Role) -> TipRoot:
            gear = pair.gears.pick(role)
            virtual = VirtualGear.of(gear)
            load = load_point(virtual, 1.0)  # no pitch inside the tip: the load is at the tip
            section = root_section(gear, virtual, load)
            return TipRoot(
                form_factor(section, load, virtual),
                stress_correction_factor(section),
                0.25 + 0.75 / pair.transverse_contact_ratio,
                root_helix_angle_factor(gear.helix_angle, pair.overlap_ratio),
                loaded_width(pair, role),
            )

        return PerGear.each(root)

    @cached_property
    def contact_factors(self) -> tuple[float, float, float]:
        """Z_H, Z_eps and Z_beta = sqrt(cos beta)."""
        pinion = self.pair.pinion
        return (
            zone_factor(pinion.base_helix_angle, pinion.transverse_pressure_angle, self.pair.working_transverse_pressure_angle),
            contact_ratio_factor(self.pair.transverse_contact_ratio, self.pair.overlap_ratio),
            helix_angle_factor(pinion.helix_angle, Edition.DIN_1987),
        )


class HeatCoefficients(NamedTuple):
    """k_theta of flank and root, in K (m/s)^0.75 mm^1.75/W."""

    flank: float
    root: float


IN_STEEL = HeatCoefficients(6300.0, 895.0)
IN_PLASTIC = HeatCoefficients(9000.0, 2148.0)
IN_OIL = HeatCoefficients(0.0, 0.0)
"""Coefficients of plastic in steel, of plastic in plastic, and where oil carries the heat away."""


@dataclass(frozen=True, kw_only=True)
class ToothHeat:
    """Heat of a mesh: rolling power (W), H_V, face width (mm), z_1, v_t (m/s), m_n (mm), R_lambdaG/A_G (K/W), ED."""

    ambient: float
    power: float
    tooth_loss: float
    width: float
    teeth: int
    velocity: float
    normal_module: float
    housing: float
    duty: float

    def temperature(self, friction: float, coefficient: float) -> float:
        """Return the temperature (°C) of a flank or root of a heat coefficient k_theta under a coefficient of friction.

        theta = theta_0 + P mu H_V (k_theta/(b z_1 (v_t m_n)^0.75) + R_lambdaG/A_G) ED^0.64.
        """
        if not self.power:
            return self.ambient
        near = coefficient / (self.width * self.teeth * math.pow(self.velocity * self.normal_module, 0.75))
        return self.ambient + self.power * friction * self.tooth_loss * (near + self.housing) * math.pow(self.duty, 0.64)


_GREASE, _OIL = 0.09, 0.04
_DRY = {
    ("PA", "steel"): 0.20,
    ("PA", "PA"): 0.40,
    ("PA", "POM"): 0.18,
    ("POM", "steel"): 0.20,
    ("POM", "POM"): 0.28,
}
_FAMILIES = ("POM", "PA")


def usual_friction(materials: PerGear[Material], lubrication: ToothLubrication) -> float | None:
    """Return the usual coefficient of friction of two materials; None for dry ones of which none is known.

    The families of plastics are told by the beginnings of their names: POM and PA.
    """
    if lubrication is not ToothLubrication.DRY:
        return _OIL if lubrication is ToothLubrication.OIL else _GREASE

    def family(material: Material) -> str:
        if not material.plastic:
            return "steel"
        return next((each for each in _FAMILIES if material.name.upper().startswith(each)), "")

    both = sorted(map(family, materials), key=lambda each: (each == "steel", each))
    return _DRY.get((both[0], both[1]))


def mean_wear(
    torque: float, cycles: float, tooth_loss: float, wear_coefficient: float, width: float, teeth: int, length: float
) -> float:
    """Return W_m (µm), the mean wear of the flanks of a gear: 2 pi T N H_V k_w/(b z l_Fl) 1000.

    T (N·m) and the load cycles N of a tooth are the gear's own; k_w in mm³/(N·m), b and l_Fl in mm.
    """
    return 2 * math.pi * torque * cycles * tooth_loss * wear_coefficient / (width * teeth * length) * 1000


def tooth_deformation(force: float, width: float, helix_angle: float, moduli: PerGear[float]) -> float:
    """Return lambda (mm), the deformation of a pair of teeth at their tips: 7.5 F_t/(b cos beta) (1/E_1 + 1/E_2)."""
    across = width * math.cos(math.radians(helix_angle))
    return 7.5 * force / across * sum(1 / modulus for modulus in moduli)
