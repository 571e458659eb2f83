"""Load factors of ISO 6336-1:2006 as formulas (K_v, K_Hbeta, K_Halpha): functions of numbers, or of arrays of many variants.

The mesh is a row of equal springs over the face width, and the flanks stand off by a line: stiffness c_gamma_beta in
N/(mm·µm), misalignment F_beta in µm, mean specific load F_m/b = F_t K_A K_v/b in N/mm, lengths in mm. Numbers give a number;
arrays broadcast.

Stiffness per face width in N/(mm·µm), mass per face width in kg/mm, deviations in µm, specific load F_t K_A/b in N/mm.

Specific load F_t K_A/b in N/mm, speed at the reference circle in m/s. Numbers give a number, arrays broadcast.

`mean_load` is F_m/b = F_t K_A K_gamma K_v/b in N/mm. Numbers give a number, arrays broadcast.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import Generic, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import require_number, require_whole
from gearcad.core.records import Floats, PerGear
from gearcad.core.values import Values, chosen, larger, magnitude, root, smaller
from gearcad.geometry import Gear, GearPair
from gearcad.material import MaterialGroup
from gearcad.rating.editions import Edition
from gearcad.rating.options import BearingArrangement, HelixModification

_LEAST_RATIO = 3.0
"""b/h below which the root's factor takes no further notice of the height."""

_OTHERWISE = 1.0
"""A b_cal/b in place of those that another formula has, so that none divides by 0."""


def bearing_width(misalignment: Values, stiffness: Values, mean_load: Values) -> Values:
    """b_cal/b: width that would carry, as a part of the face width; above 1 all of it does, and how evenly."""
    with np.errstate(divide="ignore"):
        share: Values = np.divide(2 * mean_load, np.abs(misalignment) * stiffness)
    return chosen(share <= 1, root(share), 0.5 + share / 2)


def face_load_factor(misalignment: Values, stiffness: Values, mean_load: Values) -> Values:
    """K_Hbeta: greatest load per width over the mean one, at an effective misalignment F_beta_y of the mesh.

    sqrt(2 F_beta_y c_gamma_beta/(F_m/b)) where only part of the width carries (K at least 2), else
    1 + F_beta_y c_gamma_beta/(2 F_m/b).
    """
    width = bearing_width(misalignment, stiffness, mean_load)
    whole = chosen((width > 1) & (width < np.inf), width, _OTHERWISE)
    return chosen(width <= 1, 2 / width, chosen(width < np.inf, 2 * whole / (2 * whole - 1), 1.0))


def face_load_exponent(width_to_height: Values) -> Values:
    """N_F = (b/h)^2/(1 + b/h + (b/h)^2); b/h below 3 counts as 3."""
    ratio = chosen(width_to_height > _LEAST_RATIO, width_to_height, _LEAST_RATIO)
    return ratio**2 / (1 + ratio + ratio**2)


def root_face_load_factor(flank_factor: Values, width_to_height: Values) -> Values:
    """K_Fbeta = K_Hbeta^N_F."""
    result: Values = flank_factor ** face_load_exponent(width_to_height)
    return result


def width_to_height(pair: GearPair) -> float:
    """b/h: the smaller of both gears' face width over tooth depth h = (d_a - d_f)/2."""
    return min(gear.face_width / ((gear.tip_diameter - gear.root_diameter) / 2) for gear in pair.gears)


_MAIN_END, _SUPERCRITICAL = 1.15, 1.5
"""Resonance ratios at which the main resonance range ends, and the supercritical one begins."""


class RunningFactors(NamedTuple, Generic[Values]):
    """C_v1 ... C_v7 of table 8: pitch, profile and cyclic-stiffness effects below, at and above the main resonance."""

    c_v1: float
    c_v2: Values
    c_v3: Values
    c_v4: Values
    c_v5: float
    c_v6: Values
    c_v7: Values


def circumferential_speed(diameter: Values, speed: float) -> Values:
    """Return the speed v = pi d n/60000 (m/s) on a diameter (mm), from rpm; a magnitude."""
    return math.pi * diameter * abs(speed) / 60_000


def resonance_speed(teeth: Values, mesh_stiffness: Values, mass: Values) -> Values:
    """n_E1 (rpm) = 30000/(pi z1) sqrt(c_gamma_alpha/m_red) (6)."""
    return 30000 / (math.pi * teeth) * root(mesh_stiffness / mass)


def lower_limit(specific_load: Values) -> Values:
    """N_S (11), (12): where the main resonance begins; lower for loads below 100 N/mm."""
    return chosen(specific_load < 100, 0.5 + 0.35 * root(specific_load / 100), 0.85)


def running_factors(total_contact_ratio: Values) -> RunningFactors[Values]:
    """Table 8, for a total contact ratio above 1."""
    e, deep = total_contact_ratio, total_contact_ratio > 2
    high = chosen(deep, e, 2.0)  # what the columns of deep teeth are worked out for
    wave: Values = np.sin(math.pi * (e - 2))
    between = chosen(e <= 2.5, 0.125 * wave + 0.875, 1.0)
    return RunningFactors(
        c_v1=0.32,
        c_v2=chosen(deep, 0.57 / (high - 0.3), 0.34),
        c_v3=chosen(deep, 0.096 / (high - 1.56), 0.23),
        c_v4=chosen(deep, (0.57 - 0.05 * high) / (high - 1.44), 0.90),
        c_v5=0.47,
        c_v6=chosen(deep, 0.12 / (high - 1.74), 0.47),
        c_v7=chosen(e <= 1.5, 0.75, between),
    )


class DeviationEffects(NamedTuple, Generic[Values]):
    """B_p (15), B_f (16), B_k (17): deviations and relief over the deflection that c' would have under the load."""

    pitch: Values
    profile: Values
    relief: Values

    @classmethod
    def of(
        cls, single_stiffness: Values, specific_load: Values, pitch: Values, profile: Values, tip_relief: float
    ) -> DeviationEffects[Values]:
        """Return the effects of deviations (µm) that running-in leaves, (18) and (19), and of the tip relief C_a (µm)."""
        stiffness = single_stiffness / specific_load
        return DeviationEffects(stiffness * pitch, stiffness * profile, magnitude(1 - stiffness * tip_relief))


def dynamic_factor_b(
    ratio: Values,
    specific_load: Values,
    total_contact_ratio: Values,
    *,
    pitch_effect: Values,
    profile_effect: Values,
    relief_effect: Values,
) -> Values:
    """K_v by the resonance ratio N: (13), (14) below, (20) at, (22) between, (21) above the main resonance.

    Of the effects B_p (15), B_f (16) and B_k (17). All broadcast.
    """
    c, (b_p, b_f, b_k) = running_factors(total_contact_ratio), (pitch_effect, profile_effect, relief_effect)
    subcritical = ratio * (c.c_v1 * b_p + c.c_v2 * b_f + c.c_v3 * b_k) + 1
    main = c.c_v1 * b_p + c.c_v2 * b_f + c.c_v4 * b_k + 1
    supercritical = c.c_v5 * b_p + c.c_v6 * b_f + c.c_v7
    between = supercritical + (main - supercritical) * (_SUPERCRITICAL - ratio) / (_SUPERCRITICAL - _MAIN_END)
    above = chosen(ratio < _SUPERCRITICAL, between, supercritical)
    return chosen(ratio <= lower_limit(specific_load), subcritical, chosen(ratio <= _MAIN_END, main, above))


_SLOW, _FAST = 5.0, 10.0
"""Circumferential speeds (m/s) up to which nothing, and beyond which most, is held back by speed."""


class RunningIn(Enum):
    """Kinds of running-in of flanks."""

    THROUGH_HARDENED = "through hardened"
    """Structural and through-hardened steel, cast steel, perlitic and bainitic nodular iron: St, V, GGG, GTS."""

    CAST_IRON = "cast iron"
    """Grey iron and ferritic nodular iron: GG, GGG (ferr.)."""

    SURFACE_HARDENED = "surface hardened"
    """Case-hardened, nitrided, flame- or induction-hardened steel: Eh, IF, NT, NV."""

    @classmethod
    def of(cls, group: MaterialGroup) -> RunningIn:
        """Return the kind of running-in of a group of materials."""
        if group in (MaterialGroup.GREY_IRON, MaterialGroup.FERRITIC_NODULAR_IRON):
            return cls.CAST_IRON
        return cls.SURFACE_HARDENED if group in _HARDENED else cls.THROUGH_HARDENED

    @property
    def needs_flank_limit(self) -> bool:
        """Whether the running-in allowance depends on sigma_H_lim."""
        return self is RunningIn.THROUGH_HARDENED


_HARDENED = (
    MaterialGroup.CASE_HARDENED,
    MaterialGroup.SURFACE_HARDENED,
    MaterialGroup.NITRIDING_STEEL,
    MaterialGroup.NITRIDED,
    MaterialGroup.NITROCARBURISED,
)


class _Rule(NamedTuple):
    """Part of a deviation that wears off, and its most (µm) at slow, medium and high speed.

    Through-hardened flanks have all of them times MPa, over sigma_H_lim.
    """

    part: float
    most: tuple[float, float, float]

    def allowance(self, deviation: float | Floats, speed: ArrayLike, softness: float | Floats) -> Floats:
        """Return the running-in allowance (µm) of deviations (µm) at circumferential speeds (m/s); all broadcast."""
        v = np.abs(np.asarray(speed, float))
        most = np.select([v <= _SLOW, v <= _FAST], self.most[:2], self.most[2])
        result: Floats = np.minimum(np.minimum(self.part * deviation, most) / softness, deviation)
        return result


_ALPHA = {
    RunningIn.THROUGH_HARDENED: _Rule(160, (math.inf, 12800, 6400)),
    RunningIn.CAST_IRON: _Rule(0.275, (math.inf, 22, 11)),
    RunningIn.SURFACE_HARDENED: _Rule(0.075, (3, 3, 3)),
}
_BETA = {
    RunningIn.THROUGH_HARDENED: _Rule(320, (math.inf, 25600, 12800)),
    RunningIn.CAST_IRON: _Rule(0.55, (math.inf, 45, 22)),
    RunningIn.SURFACE_HARDENED: _Rule(0.15, (6, 6, 6)),
}


def running_in_alpha(
    deviation: float | Floats, kind: RunningIn, speed: ArrayLike, flank_limit: float | Floats | None = None
) -> Floats:
    """y_alpha (8.3.5): running-in allowance (µm) of deviations f_pb or f_falpha at circumferential speeds (m/s); all broadcast.

    For two materials it is the mean of theirs. Through-hardened gears need their `flank_limit` sigma_H_lim (MPa). Raises
    ParameterError.
    """
    return _ALPHA[kind].allowance(deviation, speed, _softness(kind, flank_limit))


def running_in_beta(
    misalignment: float | Floats, kind: RunningIn, speed: ArrayLike, flank_limit: float | Floats | None = None
) -> Floats:
    """y_beta (clause 7): running-in allowance (µm) of an initial misalignment F_beta_x; F_beta_y = F_beta_x - y_beta.

    Arguments are those of `running_in_alpha`.
    """
    return _BETA[kind].allowance(misalignment, speed, _softness(kind, flank_limit))


def running_in_relief(flank_limit: Values) -> Values:
    """C_ay (6.5): the tip relief (µm) that running in makes, by sigma_H_lim (MPa); for two materials the mean of theirs."""
    return (flank_limit / 97 - 18.45) ** 2 / 18 + 1.5


class FlankWear(NamedTuple):
    """Running-in of the flanks of both gears, and their limits sigma_Hlim (MPa); of two materials the mean of both counts."""

    kinds: PerGear[RunningIn]
    flank_limits: PerGear[float | Floats | None]

    def alpha(self, deviation: float | Floats, speed: ArrayLike) -> Floats:
        """y_alpha (µm) of deviations f_pb or f_falpha at circumferential speeds (m/s)."""
        pinion, wheel = (running_in_alpha(deviation, kind, speed, limit) for kind, limit in zip(*self, strict=True))
        return (pinion + wheel) / 2

    def beta(self, misalignment: float | Floats, speed: ArrayLike) -> Floats:
        """y_beta (µm) of misalignments F_beta_x."""
        pinion, wheel = (running_in_beta(misalignment, kind, speed, limit) for kind, limit in zip(*self, strict=True))
        return (pinion + wheel) / 2


def _softness(kind: RunningIn, flank_limit: float | Floats | None) -> float | Floats:
    if not kind.needs_flank_limit:
        return 1.0
    require_number("flank_limit", flank_limit if flank_limit is None else float(np.min(flank_limit)), "MPa", above=0)
    assert flank_limit is not None  # a number: seen to just now
    return flank_limit


LEAST_LOAD = 100.0
"""Specific load (N/mm) below which Method C takes no notice of it."""

_SPUR = (2.1, 3.9, 7.5, 14.9, 26.8, 39.1, 52.8, 76.6, 102.6, 146.3)
_HELICAL = (1.9, 3.5, 6.7, 13.3, 23.9, 34.8, 47.0, 68.2, 91.4, 130.3)
_FIRST_GRADE, _LAST_GRADE = 3, 12
"""K_1 of grades 3 to 12 of ISO 1328-1:1995."""

STATED = 3.0
"""Speed measure (m/s) up to which Method C is stated for all gears."""

_K2_SPUR, _K2_HELICAL = 0.0193, 0.0087


def speed_measure(speed: Values, teeth: Values, gear_ratio: Values) -> Values:
    """v z_1/100 sqrt(u^2/(1 + u^2)) in m/s: the speed on which K_v of Method C depends. For a ring u is negative."""
    return speed * teeth / 100 * root(gear_ratio**2 / (1 + gear_ratio**2))


def speed_measure_limit(overlap_ratio: float) -> float:
    """Return the limit of Method C: 3 m/s, and 10 m/s for helical gears with an overlap ratio of at least 1."""
    return 10.0 if overlap_ratio >= 1 else STATED


def dynamic_factor_c(
    specific_load: Values, measure: Values, overlap_ratio: Values, accuracy_grade: int, edition: Edition = Edition.ISO_2006
) -> Values:
    """K_v = 1 + (K_1/(F_t K_A/b) + K_2) K_3 v z_1/100 sqrt(u^2/(1 + u^2)), between spur and helical by eps_beta up to 1.

    `measure` is that of `speed_measure`. K_3 is 2 up to 0.2 m/s of it and 2.071 - 0.357 times it up to 3 m/s, where it is 1 and
    stays so: the printed line would let K_v fall from there on, below 1 at last. DIN 3990-1 has no K_3. Raises ParameterError
    for an accuracy grade below 3.
    """
    require_whole("accuracy_grade", accuracy_grade, at_least=_FIRST_GRADE, at_most=_LAST_GRADE)
    load = chosen(specific_load > LEAST_LOAD, specific_load, LEAST_LOAD)
    k_3 = chosen(measure <= 0.2, 2.0, chosen(measure < STATED, 2.071 - 0.357 * measure, 1.0))
    factor = measure if edition is Edition.DIN_1987 else measure * k_3
    spur = 1 + (_SPUR[accuracy_grade - _FIRST_GRADE] / load + _K2_SPUR) * factor
    helical = 1 + (_HELICAL[accuracy_grade - _FIRST_GRADE] / load + _K2_HELICAL) * factor
    return spur - chosen(overlap_ratio < 1, overlap_ratio, 1.0) * (spur - helical)


def body_mass(
    tip_diameter: Values, root_diameter: Values, base_diameter: Values, inner_diameter: Values, density: Values
) -> Values:
    """m* (kg/mm) = pi/8 rho |1 - q^4| d_m^4/d_b^2, d_m = (d_a + d_f)/2 and q = d_i/d_m: per width of the face.

    The density in kg/m³. `inner_diameter` d_i is that of the opening; of a ring, whose diameters may be negative, it is that
    of its outside, so that q is above 1.
    """
    middle = (tip_diameter + root_diameter) / 2
    return math.pi / 8 * density * 1e-9 * magnitude(middle**4 - inner_diameter**4) / base_diameter**2


def pair_mass(pinion: Values, wheel: Values) -> Values:
    """m_red (kg/mm) = m_1 m_2/(m_1 + m_2); infinite is the mass of a gear that is held."""
    return 1 / (1 / pinion + 1 / wheel)


def inner_diameter(gear: Gear) -> float | None:
    """d_i (mm): of the bore, or inside the rim of a gear with a web; outside the rim of a ring, None where it has none."""
    body = gear.body
    if gear.internal:
        given = body.rim_diameter
        return given if given or not body.rim_thickness else abs(gear.root_diameter) + 2 * body.rim_thickness
    return max(gear.root_diameter - 2 * body.rim_thickness, 0.0) if body.rim_thickness else body.bore


def mass_of(gear: Gear, density: float) -> float:
    """m* (kg/mm) of a gear, by its density (kg/m³); a ring whose rim is not given is held: infinite."""
    inside = inner_diameter(gear)
    if inside is None:
        return math.inf
    return body_mass(gear.tip_diameter, gear.root_diameter, gear.base_diameter, inside, density)


STIFFENING_RATIO = 1.15
"""d_1/d_sh from which on a pinion stiffens its shaft."""

_ARRANGEMENTS = {
    BearingArrangement.BETWEEN_NEAR: (0.8, 0.48),
    BearingArrangement.BETWEEN_FAR: (-0.8, -0.48),
    BearingArrangement.OVERHUNG: (1.33, 1.33),
    BearingArrangement.SECOND_MESH_NEAR: (-0.6, -0.36),
    BearingArrangement.SECOND_MESH_FAR: (-1.0, -0.6),
}
"""K' of figure 13, without and with stiffening."""


class HelixFactors(NamedTuple):
    """B_1 and B_2, the remaining shares of f_sh and f_ma, and the compliance of the pinion (µm per N/mm) (57)."""

    deflection: float
    manufacture: float
    compliance: float = 0.023


_HELIX = {
    HelixModification.NONE: HelixFactors(1.0, 1.0),
    HelixModification.CROWNING: HelixFactors(1.0, 0.5),
    HelixModification.FULL_CROWNING: HelixFactors(0.5, 0.5),
    HelixModification.HELIX_CORRECTION: HelixFactors(0.1, 1.0),
    HelixModification.CORRECTION_AND_CROWNING: HelixFactors(0.1, 0.5),
    HelixModification.END_RELIEF: HelixFactors(0.7, 0.7),
}
"""Values of table 8."""

_HELIX_DIN = {
    HelixModification.CROWNING: HelixFactors(1.0, 0.5, 0.012),
    HelixModification.FULL_CROWNING: HelixFactors(1.0, 0.5, 0.012),
    HelixModification.END_RELIEF: HelixFactors(1.0, 0.7, 0.016),
}
"""DIN 3990-1 has another compliance in place of B_1."""

UNLOADED_ENDS = frozenset(
    (
        HelixModification.CROWNING,
        HelixModification.FULL_CROWNING,
        HelixModification.CORRECTION_AND_CROWNING,
        HelixModification.END_RELIEF,
    )
)
"""Modifications that leave little load to the ends of the teeth: K_Fbeta is then K_Hbeta (7.6)."""


def helix_factors(modification: HelixModification, edition: Edition) -> HelixFactors:
    """Return the factors B_1, B_2 and the compliance (57) for a helix modification by an edition."""
    return (_HELIX_DIN if edition is Edition.DIN_1987 else {}).get(modification, _HELIX[modification])


def arrangement_factor(arrangement: BearingArrangement, stiffening: bool, diameter_ratio: Values) -> Values:
    """K' (figure 13): less where the pinion stiffens its shaft, from d_1/d_sh = 1.15 on."""
    plain, stiff = _ARRANGEMENTS[arrangement]
    return chosen(diameter_ratio >= STIFFENING_RATIO, stiff, plain) if stiffening else plain


def offset_limit(arrangement: BearingArrangement) -> float:
    """Return the most s/l that figure 13 has."""
    return 0.5 if arrangement is BearingArrangement.OVERHUNG else 0.3


def shaft_term(
    arrangement: Values, bearing_span: Values, offset: Values, reference_diameter: Values, shaft_diameter: Values
) -> Values:
    """K' l s/d_1^2 (d_1/d_sh)^4 of (57): how a shaft bends, by K' of `arrangement_factor`; 0 between bearings alike far."""
    return arrangement * bearing_span * offset * reference_diameter**2 / shaft_diameter**4


def shaft_deflection(
    mean_load: Values,
    width: Values,
    reference_diameter: Values,
    *,
    shaft_term: Values,
    branch: float = 1.0,
    compliance: float = 0.023,
    double_helical: bool = False,
) -> Values:
    """f_sh = 0.023 F_m/b (|B* + K' l s/d_1^2 (d_1/d_sh)^4 - 0.3| + 0.3) (b/d_1)^2 (57): the pinion's bending and twist.

    `branch` B* is 1 where all power goes through this mesh, 1 + 2 (100 - k)/k for k % of it; `shaft_term` that of the function.
    Double helical pinions (58) have twice the compliance, B* is more by 0.5, and `width` is that of one half.
    """
    if double_helical:
        branch, compliance = branch + 0.5, 2 * compliance
    bracket = magnitude(branch + shaft_term - 0.3) + 0.3
    return compliance * mean_load * bracket * (width / reference_diameter) ** 2


def manufacturing_misalignment(pinion_slope: Values, wheel_slope: Values) -> Values:
    """f_ma = sqrt(f_Hbeta1^2 + f_Hbeta2^2) (64)."""
    return root(pinion_slope**2 + wheel_slope**2)


def least_misalignment(mean_load: Values, greatest_slope: Values) -> Values:
    """F_beta_x_min (55), (56): the larger of 0.005 mm µm/N times F_m/b and half of the larger f_Hbeta."""
    return larger(0.005 * mean_load, 0.5 * greatest_slope)


def initial_misalignment(deflection: Values, manufacture: Values, factors: HelixFactors, least: Values) -> Values:
    """F_beta_x = 1.33 B_1 f_sh + B_2 f_ma (52), no less than `least`."""
    return larger(1.33 * factors.deflection * deflection + factors.manufacture * manufacture, least)


def proven_misalignment(deflection: Values, compensation: Values, factors: HelixFactors, least: Values) -> Values:
    """F_beta_x = |1.33 B_1 f_sh - f_Hbeta5| (53), with a contact pattern that shows that both lie opposite.

    `compensation` is f_Hbeta5, the helix slope deviation of accuracy grade 5 (corrigendum of 2008), or f_ma by DIN 3990-1:1987
    where that is given.
    """
    return larger(magnitude(1.33 * factors.deflection * deflection - compensation), least)


def transverse_load_factor(
    total_contact_ratio: Values, mesh_stiffness: Values, deviation: Values, allowance: Values, mean_load: Values
) -> Values:
    """K_Halpha = K_Falpha before their limits, (71) up to eps_gamma = 2 and (72) above.

    eps_gamma/2 (0.9 + 0.4 q) and 0.9 + 0.4 sqrt(2 (eps_gamma - 1)/eps_gamma) q, with q = c_gamma_alpha (f - y_alpha)/(F_tH/b):
    stiffness in N/(mm·µm), deviation and what runs in in µm, F_tH/b = F_t K_A K_gamma K_v K_Hbeta/b in N/mm.
    """
    e, q = total_contact_ratio, mesh_stiffness * (deviation - allowance) / mean_load
    return chosen(e <= 2, e / 2 * (0.9 + 0.4 * q), 0.9 + 0.4 * root(2 * (e - 1) / e) * q)


def flank_limit(total_contact_ratio: Values, transverse_contact_ratio: Values, contact_ratio_factor: Values) -> Values:
    """eps_gamma/(eps_alpha Z_eps^2): all of the load on one pair of teeth."""
    return total_contact_ratio / (transverse_contact_ratio * contact_ratio_factor**2)


def root_limit(total_contact_ratio: Values, transverse_contact_ratio: Values) -> Values:
    """eps_gamma/(0.25 eps_alpha + 0.75): the same of the root."""
    return total_contact_ratio / (0.25 * transverse_contact_ratio + 0.75)


def within(factor: Values, limit: Values) -> Values:
    """Return a factor, at most its limit, and never below 1."""
    return larger(smaller(factor, limit), 1.0)
