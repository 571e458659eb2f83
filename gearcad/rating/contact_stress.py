"""Contact stress of flanks: Hertz's line contact, and ISO 6336-2:2006 or DIN 3990-2:1987, Method B.

z is the depth below the surface, x lies across the line of contact and y along it; the bodies are in plane strain.
Stresses are given on the axis of symmetry x = 0, where they are principal stresses; tension is positive.

Stresses in MPa, angles in degrees; clauses are those of ISO 6336-2:2006.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, at_most, plain_numbers, require_number
from gearcad.core.records import Floats, Notice, PerGear, Role
from gearcad.core.values import Values, cos, larger, radians, root, sin, smaller
from gearcad.geometry import GearPair
from gearcad.geometry.toothed import GearSizes
from gearcad.material import Material, MaterialGroup, Materials, elastic_constants, of_both
from gearcad.rating.editions import Edition, modification_factor, relieved

Size = TypeVar("Size", float, Floats)

_GOLDEN = (math.sqrt(5) - 1) / 2


class StressPeak(NamedTuple):
    """The greatest value of a stress on the axis of symmetry (MPa), and the depth (mm) where it occurs."""

    depth: float
    value: float


@dataclass(frozen=True, eq=False)
class Stresses:
    """Stresses on the axis of symmetry at `depth` (mm), in MPa: read-only arrays of one shape."""

    depth: Floats
    sigma_x: Floats
    sigma_y: Floats
    sigma_z: Floats
    largest_shear: Floats
    von_mises: Floats


def reduced_modulus(youngs_moduli: tuple[float, float], poisson_ratios: tuple[float, float]) -> float:
    """E* of two bodies in plane strain (MPa): 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 (Johnson, before 4.21)."""
    flexibility = [(1 - nu**2) / modulus for modulus, nu in zip(youngs_moduli, poisson_ratios, strict=True)]
    return 1 / sum(flexibility)


def reduced_radius(radii: tuple[float, float]) -> float:
    """R of two cylinders (mm): 1/R = 1/R_1 + 1/R_2 (Johnson, before 4.21); the radius of a hollow one is negative."""
    return radii[0] * radii[1] / (radii[0] + radii[1])


def half_width(load_per_width: Size, radius: Size, modulus: float) -> Size:
    """a (mm): a^2 = 4 P R/(pi E*) (Johnson 4.43). Numbers, or arrays of one shape."""
    result: Size = np.sqrt(4 * load_per_width * radius / (math.pi * modulus))
    return result


def half_width_by_curvature(load_per_width: float, curvature: float, modulus: float) -> float:
    """Return half width a (mm) from the relative curvature 1/R (1/mm).

    The result is infinite where a concave surface is more curved than the convex one.
    """
    return math.sqrt(4 * load_per_width / (math.pi * modulus * curvature)) if curvature > 0 else math.inf


def peak_pressure(load_per_width: Size, radius: Size, modulus: float) -> Size:
    """p_0 (MPa) in the middle of the contact: sqrt(P E*/(pi R)) = 2 P/(pi a) (Johnson 4.45). Numbers, or arrays."""
    result: Size = np.sqrt(load_per_width * modulus / (math.pi * radius))
    return result


@dataclass(frozen=True, kw_only=True)
class LineContact:
    """Two cylinders under a load per length of their line of contact.

    `load_per_width` P in N/mm, `radius` R the reduced radius of curvature in mm, `modulus` E* the reduced modulus in MPa,
    `poisson_ratio` that of the body whose stresses are wanted. Raises ParameterError.
    """

    load_per_width: float
    radius: float
    modulus: float
    poisson_ratio: float = 0.3

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("load_per_width", self.load_per_width, "N/mm", above=0)
        require_number("radius", self.radius, "mm", above=0)
        require_number("modulus", self.modulus, "MPa", above=0)
        require_number("poisson_ratio", self.poisson_ratio, at_least=0, at_most=0.5)

    @property
    def half_width(self) -> float:
        """Half width a of the contact (mm)."""
        return float(half_width(self.load_per_width, self.radius, self.modulus))

    @property
    def peak_pressure(self) -> float:
        """p_0 (MPa) in the middle of the contact."""
        return float(peak_pressure(self.load_per_width, self.radius, self.modulus))

    def pressure(self, x: ArrayLike) -> Any:
        """Return the pressure (MPa) at `x` (mm) from the middle: p_0 sqrt(1 - x^2/a^2), 0 outside (Johnson 4.44). Scalar or
        array.
        """
        across = np.asarray(x, float) / self.half_width
        found = self.peak_pressure * np.sqrt(np.clip(1 - across**2, 0, None))
        return float(found) if found.ndim == 0 else found

    def stresses(self, depth: ArrayLike) -> Stresses:
        """Return the stresses on the axis of symmetry at `depth` (mm, 0 or more; scalar or array). Raises ParameterError.

        sigma_z = -p_0 a/s and sigma_x = -p_0 ((a^2 + 2 z^2)/(a s) - 2 z/a) with s = sqrt(a^2 + z^2) (Johnson 4.46),
        the latter written as -p_0 a^3/(s (s + z)^2), which keeps its digits at any depth; sigma_y = nu (sigma_x + sigma_z).
        """
        z = np.array(depth, float)
        if not np.all(z >= 0):
            require_number("depth", float(np.min(z)), "mm", at_least=0)
        a, p_0 = self.half_width, self.peak_pressure
        s = np.hypot(a, z)
        sigma_z = -p_0 * a / s
        sigma_x = -p_0 * a**3 / (s * (s + z) ** 2)
        sigma_y = self.poisson_ratio * (sigma_x + sigma_z)
        # Nowhere on the axis is another stress below sigma_z.
        shear = (np.maximum(sigma_x, sigma_y) - sigma_z) / 2
        squares = (sigma_x - sigma_y) ** 2 + (sigma_y - sigma_z) ** 2 + (sigma_z - sigma_x) ** 2
        arrays = [np.asarray(found) for found in (z, sigma_x, sigma_y, sigma_z, shear, np.sqrt(squares / 2))]
        for array in arrays:
            array.flags.writeable = False
        return Stresses(*arrays)

    @property
    def greatest_shear(self) -> StressPeak:
        """The largest shear stress on the axis: 0.30028 p_0 at 0.78615 a for steel (Johnson 4.48: 0.30 p_0 at 0.78 a).

        With z = a sinh t the shear in the plane x-z is p_0 sinh t e^-t/cosh t, greatest where tanh t is the golden
        section. That in the plane y-z, p_0 (1/cosh t - 2 nu e^-t)/2, exceeds it for nu below 0.24.
        """
        nu = self.poisson_ratio
        in_section = math.atanh(_GOLDEN)
        b = 1 + 2 * nu
        along = math.log((b + math.sqrt(b**2 + 4 * nu * (1 - nu))) / (2 * (1 - nu))) / 2
        return self._greatest("largest_shear", (in_section, along))

    @property
    def greatest_von_mises(self) -> StressPeak:
        """The largest von Mises stress on the axis: 0.55752 p_0 at 0.70429 a for nu = 0.3.

        With z = a sinh t and T = tanh t it is p_0 e^-t sqrt((1 - 2 nu)^2 + 3 T^2), stationary where
        3 T^3 + 3 T^2 - 3 T + (1 - 2 nu)^2 = 0; for nu up to 0.19 it is greatest at the surface, (1 - 2 nu) p_0.
        """
        roots = np.roots([3, 3, -3, (1 - 2 * self.poisson_ratio) ** 2])
        inside = [float(root.real) for root in roots if abs(root.imag) < 1e-9 and 0 < root.real < 1]
        return self._greatest("von_mises", (0.0, *(math.atanh(root) for root in inside)))

    def _greatest(self, name: str, candidates: tuple[float, ...]) -> StressPeak:
        """Return the largest value of one of the `stresses` among the candidates t = arsinh(z/a)."""
        found = self.stresses(self.half_width * np.sinh(candidates))
        values = getattr(found, name)
        best = int(np.argmax(values))
        return StressPeak(float(found.depth[best]), float(values[best]))


def base_normal_force(pair: GearPair, torque: float) -> float:
    """F_bn = F_bt/cos beta_b with F_bt = |T_1|/r_b1: what all flanks carry together (N), for `torque` on the pinion (N·m)."""
    transverse = 2000 * abs(torque) / pair.pinion.base_diameter
    return transverse / math.cos(math.radians(pair.pinion.base_helix_angle))


def contact_at(
    pair: GearPair, material: Materials, *, distance: float, force: float, length: float | None = None
) -> LineContact:
    """Contact of one pair of teeth at `distance` from T1 on the line of action (mm, transverse section).

    `force` is what this pair of teeth carries, normal to the flanks (N), `length` the line that it spreads over evenly (mm;
    None: a line across the common face width, b/cos beta_b). The radii of curvature are those of the normal section,
    distance/cos beta_b and (T1T2 - distance)/cos beta_b, negative on the hollow flank of a ring. Raises GeometryError for a
    place that is not between T1 and T2, of an internal pair not beyond T1.

    Of two materials, stresses below the surface are those of the pinion.
    """
    materials = of_both(material)
    whole = pair.base_tangent.length
    if not 0 < distance < (math.inf if pair.internal else whole):
        permitted = f"must be above 0 and below {at_most(whole)} mm, between the base tangent points T1 and T2"
        if pair.internal:
            permitted = "must be above 0 mm, beyond the base tangent point T1"
        raise GeometryError("distance", distance, permitted, "mm")
    lean = math.cos(math.radians(pair.pinion.base_helix_angle))
    if length is None:
        length = pair.common_width.width / lean
    return LineContact(
        load_per_width=force / length,
        radius=reduced_radius((distance / lean, (whole - distance) / lean)),
        modulus=reduced_modulus(*elastic_constants(materials)),
        poisson_ratio=materials.pinion.poisson_ratio,
    )


def pitch_point_contact(pair: GearPair, material: Materials, torque: float) -> LineContact:
    """Contact at the pitch point of the middle plane under `torque` on the pinion (N·m).

    The force is spread evenly over all lines of contact at that roll angle: over the common face width of a spur pair
    that carries on one tooth there.
    """
    return contact_at(
        pair,
        material,
        distance=pair.path_of_contact.C,
        force=base_normal_force(pair, torque),
        length=pair.contact_line_length(0.0),
    )


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

    @property
    def factors(self) -> dict[str, float]:
        """Factors of the contact stress under their symbols, in the order of all outputs."""
        return {
            "Z_H": self.zone_factor,
            "Z_E": self.elasticity_factor,
            "Z_eps": self.contact_ratio_factor,
            "Z_beta": self.helix_angle_factor,
            "Z_B": self.contact_factors.pinion,
            "Z_D": self.contact_factors.wheel,
        }

    def to_dict(self) -> dict[str, float]:
        """Return the values under their symbols."""
        return {**self.factors, "sigma_H0": self.nominal_stress}


def zone_factor(
    base_helix_angle: Values, transverse_pressure_angle: Values, working_transverse_pressure_angle: Values
) -> Values:
    """Z_H = sqrt(2 cos beta_b cos alpha_wt/(cos^2 alpha_t sin alpha_wt)) (6.1): curvature at the pitch point."""
    alpha_t, alpha_wt = radians(transverse_pressure_angle), radians(working_transverse_pressure_angle)
    return root(2 * cos(radians(base_helix_angle)) * cos(alpha_wt) / (cos(alpha_t) ** 2 * sin(alpha_wt)))


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
    """Yield notices of irons whose Young's modulus is that of steel, which is probably a mistake."""
    for material in dict.fromkeys(materials):
        usual = _USUAL_MODULI.get(material.group) if material.group is not None else None
        if usual is not None and material.youngs_modulus >= _LEAST_OF_STEEL:
            here = f"{material.name} of group {material.group} has Young's modulus {material.youngs_modulus:g} MPa, as steel"
            yield Notice("modulus-of-steel", f"Z_E: {here}; that of this group is usually {usual} MPa")


def contact_ratio_factor(transverse_contact_ratio: Values, overlap_ratio: Values) -> Values:
    """Z_eps (clause 8): sqrt((4 - eps_alpha)/3 (1 - eps_beta) + eps_beta/eps_alpha), with eps_beta at most 1."""
    overlap = smaller(overlap_ratio, 1.0)
    return root((4 - transverse_contact_ratio) / 3 * (1 - overlap) + overlap / transverse_contact_ratio)


def helix_angle_factor(helix_angle: Values, edition: Edition) -> Values:
    """Z_beta (clause 9): 1/sqrt(cos beta) since the corrigendum of 2008; sqrt(cos beta) in DIN 3990-2."""
    cosine = root(cos(radians(helix_angle)))
    return cosine if edition is Edition.DIN_1987 else 1 / cosine


def contact_factor(curvature: Values, overlap_ratio: Values) -> Values:
    """Z_B or Z_D (6.2): at least 1, M for a spur pair, M - eps_beta (M - 1) between, 1 from eps_beta = 1 on.

    `curvature` is M_1 or M_2 of `single_contact_curvature`.
    """
    overlap = smaller(overlap_ratio, 1.0)
    return larger(curvature - overlap * (curvature - 1), 1.0)


def profile_factor(edition: Edition, helix_angle: Values, modified: bool) -> Values:
    """Return f_ZCa of the edition of 2019, by which Z_B and Z_D are multiplied, for modified or unmodified profiles; 1 in other
    editions.
    """
    return modification_factor(helix_angle, modified=modified) if edition is Edition.ISO_2019 else 1.0


def single_contact_curvature(pair: GearPair) -> PerGear[float]:
    """M_1 (17) and M_2 (18): how much the inner point of single contact of either gear is more curved than the pitch point.

    See `inner_point_rolls`. Raises GeometryError where such a point is off the involute.
    """
    tangent = math.tan(math.radians(pair.working_transverse_pressure_angle))

    def curvature(own: Role) -> float:
        inner, outer = inner_point_rolls(pair.gears, pair.transverse_contact_ratio, own)
        if inner <= 0 or outer <= 0:
            size, below = ("larger", own) if inner <= 0 else ("smaller", own.mate)
            permitted = f"must be {size} for a rating: single contact begins below the {below.value}'s base circle"
            raise GeometryError("tip_diameter", pair.gears.pick(own).tip_diameter, permitted, "mm")
        return tangent / math.sqrt(inner * outer)

    return PerGear.each(curvature)


def inner_point_rolls(gears: PerGear[Any], transverse_contact_ratio: Values, own: Role) -> tuple[Values, Values]:
    """Return the roll lengths over base radii of both flanks at the inner point of single contact of the gear `own`, its own
    first.

    Either is above 0 where the point is on the involutes: in M_1 = tan alpha_wt/sqrt((sqrt(d_a1^2/d_b1^2 - 1) - 2 pi/z_1)
    (sqrt(d_a2^2/d_b2^2 - 1) - (eps_alpha - 1) 2 pi/z_2)), with the tip form circles for d_a, they are the two factors below
    the root. M_2 is with the gears exchanged, z_2 < 0 for a ring.
    """
    return _roll(gears.pick(own), 1), _roll(gears.pick(own.mate), transverse_contact_ratio - 1)


def _roll(gear: GearSizes[Values], pitches: Values) -> Values:
    """Return the roll length over base radius, so many base pitches below the tip."""
    return root((gear.tip_form_diameter / gear.base_diameter) ** 2 - 1) - pitches * (2 * math.pi / gear.teeth)


def nominal_contact_stress(
    factors: Values, tangential_force: Values, reference_diameter: Values, width: Values, gear_ratio: Values
) -> Values:
    """sigma_H0 = Z_H Z_E Z_eps Z_beta sqrt(F_t/(d_1 b) (u + 1)/u) (clause 5), b the common face width, u < 0 for a ring.

    `factors` is the product of the four Z; F_t at the reference circle, in N.
    """
    return factors * root(tangential_force / (reference_diameter * width) * (gear_ratio + 1) / gear_ratio)


def flank_rating(pair: GearPair, materials: PerGear[Material], tangential_force: float, edition: Edition) -> FlankRating:
    """Contact stress of a pair under the tangential force F_t at the reference circle (N)."""
    pinion = pair.pinion
    zone = zone_factor(pinion.base_helix_angle, pinion.transverse_pressure_angle, pair.working_transverse_pressure_angle)
    elasticity = elasticity_of(materials)
    ratio = contact_ratio_factor(pair.transverse_contact_ratio, pair.overlap_ratio)
    helix = helix_angle_factor(pinion.helix_angle, edition)
    curvatures = single_contact_curvature(pair) if pair.overlap_ratio < 1 else PerGear(1.0, 1.0)
    raised = profile_factor(edition, pinion.helix_angle, relieved(pinion.modification, pair.wheel.modification))
    contact = curvatures.map(lambda curvature: raised * contact_factor(curvature, pair.overlap_ratio))
    if pair.internal:
        contact = PerGear(contact.pinion, 1.0)  # Z_D is 1 for a ring (6.2, to be verified)
    return FlankRating(
        zone_factor=zone,
        elasticity_factor=elasticity,
        contact_ratio_factor=ratio,
        helix_angle_factor=helix,
        contact_factors=contact,
        nominal_stress=nominal_contact_stress(
            zone * elasticity * ratio * helix,
            tangential_force,
            pinion.reference_diameter,
            pair.common_width.width,
            pair.gear_ratio,
        ),
    )


def flank_notices(pair: GearPair) -> Iterator[Notice]:
    """Yield a notice if the pair's transverse contact ratio is above 2, the range that ISO 6336-2 states for its formulas."""
    if (ratio := pair.transverse_contact_ratio) > 2:
        text = f"Z_eps, Z_B and Z_D hold for a contact ratio up to 2, here {ratio:.4f}"
        yield Notice("flank-contact-ratio", f"sigma_H: {text}: two pairs of teeth share the load at any time")
