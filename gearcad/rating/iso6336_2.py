"""Contact stress of the flanks by ISO 6336-2:2006, Method B (but for Z_beta in DIN 3990-2:1987, and Z_B, Z_D in 2019).

Stresses in MPa, angles in degrees; clauses are those of ISO 6336-2:2006.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.errors import GeometryError
from gearcad.geometry import Gear, GearPair
from gearcad.material import Material, MaterialGroup, elastic_constants
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.edition_2019 import modification_factor, relieved
from gearcad.rating.editions import Edition
from gearcad.rating.hertz import reduced_modulus

__all__ = [
    "FlankRating",
    "contact_factor",
    "contact_ratio_factor",
    "elasticity_factor",
    "elasticity_notices",
    "elasticity_of",
    "flank_notices",
    "flank_rating",
    "helix_angle_factor",
    "nominal_contact_stress",
    "profile_factor",
    "zone_factor",
]


@dataclass(frozen=True, kw_only=True)
class FlankRating:
    """Factors of the contact stress and the nominal stress sigma_H0 at the pitch point (MPa), without any load factor.

    Inside the path of contact the flanks bear `contact_factors` times that: Z_B sigma_H0 (pinion) and Z_D sigma_H0 (wheel).
    """

    zone_factor: float
    elasticity_factor: float
    contact_ratio_factor: float
    helix_angle_factor: float
    contact_factors: PerGear[float]
    nominal_stress: float

    def to_dict(self) -> dict[str, float]:
        """Values under their symbols."""
        return {
            "Z_H": self.zone_factor,
            "Z_E": self.elasticity_factor,
            "Z_eps": self.contact_ratio_factor,
            "Z_beta": self.helix_angle_factor,
            "Z_B": self.contact_factors.pinion,
            "Z_D": self.contact_factors.wheel,
            "sigma_H0": self.nominal_stress,
        }


def zone_factor(base_helix_angle: float, transverse_pressure_angle: float, working_transverse_pressure_angle: float) -> float:
    """Z_H = sqrt(2 cos beta_b cos alpha_wt/(cos^2 alpha_t sin alpha_wt)) (6.1): curvature at the pitch point."""
    beta_b, alpha_t, alpha_wt = map(
        math.radians, (base_helix_angle, transverse_pressure_angle, working_transverse_pressure_angle)
    )
    return math.sqrt(2 * math.cos(beta_b) * math.cos(alpha_wt) / (math.cos(alpha_t) ** 2 * math.sin(alpha_wt)))


def elasticity_factor(youngs_moduli: tuple[float, float], poisson_ratios: tuple[float, float]) -> float:
    """Z_E = sqrt(1/(pi ((1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2))), clause 7 (19), in sqrt(MPa)."""
    return math.sqrt(reduced_modulus(youngs_moduli, poisson_ratios) / math.pi)


_LEAST_OF_STEEL = 190000.0

_USUAL_MODULI = {
    MaterialGroup.GREY_IRON: "118000 to 126000",
    MaterialGroup.NODULAR_IRON: "173000",
    MaterialGroup.FERRITIC_NODULAR_IRON: "173000",
}
"""Young's modulus (MPa) from which on a metal is a steel; and those of irons, as DIN 3990-2, table 1, has them (recalled)."""


def elasticity_of(materials: PerGear[Material]) -> float:
    """Z_E of two gears."""
    return elasticity_factor(*elastic_constants(materials))


def elasticity_notices(materials: PerGear[Material]) -> Iterator[Notice]:
    """Irons whose Young's modulus is that of steel, which nobody may have meant."""
    for material in dict.fromkeys(materials):
        usual = _USUAL_MODULI.get(material.group) if material.group is not None else None
        if usual is not None and material.youngs_modulus >= _LEAST_OF_STEEL:
            here = f"{material.name} of group {material.group} has Young's modulus {material.youngs_modulus:g} MPa, as steel"
            yield Notice("modulus-of-steel", f"Z_E: {here}; that of this group is usually {usual} MPa")


def contact_ratio_factor(transverse_contact_ratio: float, overlap_ratio: float) -> float:
    """Z_eps (clause 8): sqrt((4 - eps_alpha)/3 (1 - eps_beta) + eps_beta/eps_alpha), with eps_beta at most 1."""
    overlap = min(overlap_ratio, 1.0)
    return math.sqrt((4 - transverse_contact_ratio) / 3 * (1 - overlap) + overlap / transverse_contact_ratio)


def helix_angle_factor(helix_angle: float, edition: Edition) -> float:
    """Z_beta (clause 9): 1/sqrt(cos beta) since the corrigendum of 2008; sqrt(cos beta) in DIN 3990-2."""
    root = math.sqrt(math.cos(math.radians(helix_angle)))
    return root if edition is Edition.DIN_1987 else 1 / root


def contact_factor(curvature: float, overlap_ratio: float) -> float:
    """Z_B or Z_D (6.2): at least 1, M for a spur pair, M - eps_beta (M - 1) between, 1 from eps_beta = 1 on.

    `curvature` is M_1 or M_2 of `single_contact_curvature`.
    """
    overlap = min(overlap_ratio, 1.0)
    return max(curvature - overlap * (curvature - 1), 1.0)


def profile_factor(edition: Edition, pinion: Gear, modified: bool) -> float:
    """f_ZCa of the edition of 2019, by which Z_B and Z_D are multiplied, by whether profiles are taken back; 1 in others."""
    return modification_factor(pinion.helix_angle, modified=modified) if edition is Edition.ISO_2019 else 1.0


def single_contact_curvature(pair: GearPair) -> PerGear[float]:
    """M_1 (17) and M_2 (18): how much the inner point of single contact of either gear is more curved than the pitch point.

    M_1 = tan alpha_wt/sqrt((sqrt(d_a1^2/d_b1^2 - 1) - 2 pi/z_1) (sqrt(d_a2^2/d_b2^2 - 1) - (eps_alpha - 1) 2 pi/z_2)), with
    the tip form circles for d_a; M_2 with the gears exchanged, z_2 < 0 for a ring. Raises GeometryError where such a point is
    off the involute.
    """
    rest = pair.transverse_contact_ratio - 1
    tangent = math.tan(math.radians(pair.working_transverse_pressure_angle))

    def from_tip(role: Role, pitches: float) -> float:
        """Roll length over base radius, so many base pitches below the tip."""
        gear = pair.gears.pick(role)
        return math.sqrt((gear.tip_form_diameter / gear.base_diameter) ** 2 - 1) - pitches * (2 * math.pi / gear.teeth)

    def curvature(own: Role) -> float:
        inner, outer = from_tip(own, 1), from_tip(own.mate, rest)
        if inner <= 0 or outer <= 0:
            size, below = ("larger", own) if inner <= 0 else ("smaller", own.mate)
            permitted = f"must be {size} for a rating: single contact begins below the {below.value}'s base circle"
            raise GeometryError("tip_diameter", pair.gears.pick(own).tip_diameter, permitted, "mm")
        return tangent / math.sqrt(inner * outer)

    return PerGear.each(curvature)


def nominal_contact_stress(pair: GearPair, factors: float, tangential_force: float) -> float:
    """sigma_H0 = Z_H Z_E Z_eps Z_beta sqrt(F_t/(d_1 b) (u + 1)/u) (clause 5), b the common face width, u < 0 for a ring.

    `factors` is the product of the four Z; F_t at the reference circle, in N.
    """
    d_1, b, u = pair.pinion.reference_diameter, pair.common_width.width, pair.gear_ratio
    return factors * math.sqrt(tangential_force / (d_1 * b) * (u + 1) / u)


def flank_rating(pair: GearPair, materials: PerGear[Material], tangential_force: float, edition: Edition) -> FlankRating:
    """Contact stress of a pair under the tangential force F_t at the reference circle (N)."""
    pinion = pair.pinion
    zone = zone_factor(pinion.base_helix_angle, pinion.transverse_pressure_angle, pair.working_transverse_pressure_angle)
    elasticity = elasticity_of(materials)
    ratio = contact_ratio_factor(pair.transverse_contact_ratio, pair.overlap_ratio)
    helix = helix_angle_factor(pinion.helix_angle, edition)
    curvatures = single_contact_curvature(pair) if pair.overlap_ratio < 1 else PerGear(1.0, 1.0)
    raised = profile_factor(edition, pinion, relieved(pinion.modification, pair.wheel.modification))
    contact = curvatures.map(lambda curvature: raised * contact_factor(curvature, pair.overlap_ratio))
    if pair.internal:
        contact = PerGear(contact.pinion, 1.0)  # Z_D is 1 for a ring (6.2, to be verified)
    return FlankRating(
        zone_factor=zone,
        elasticity_factor=elasticity,
        contact_ratio_factor=ratio,
        helix_angle_factor=helix,
        contact_factors=contact,
        nominal_stress=nominal_contact_stress(pair, zone * elasticity * ratio * helix, tangential_force),
    )


def flank_notices(pair: GearPair) -> Iterator[Notice]:
    """Where the pair leaves the range that part 2 states for its formulas."""
    if (ratio := pair.transverse_contact_ratio) > 2:
        text = f"Z_eps, Z_B and Z_D hold for a contact ratio up to 2, here {ratio:.4f}"
        yield Notice("flank-contact-ratio", f"sigma_H: {text}: two pairs of teeth share the load at any time")
