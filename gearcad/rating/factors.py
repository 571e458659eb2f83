"""Factors of permissible stress (ISO 6336-2, ISO 6336-3, DIN 3990): functions of numbers, or of arrays of many variants.

Points are (load cycles, factor). Before the first the factor is the static one, after the last it stays.

Of static strength all three are 1.

The strength that counts is sigma_S of structural steel, sigma_0.2 of through-hardened steel and of perlitic, bainitic and
malleable iron, sigma_B of grey iron; the other groups need none.

Of static strength both are 1.

A ground, surface-hardened pinion smooths and hardens a through-hardened wheel (13.2.1); of two through-hardened gears the
harder pinion does (13.2.2). Hardness is Brinell's. The pinion itself has 1.
"""

from __future__ import annotations

import math
from typing import Any

from gearcad.core.errors import ParameterError, require_number
from gearcad.core.values import (
    Numbers,
    Values,
    bounded,
    chosen,
    fourth_root,
    interpolated,
    interpolated_in_logs,
    interpolated_over_log,
    power,
    root,
)
from gearcad.material import MaterialGroup
from gearcad.rating.editions import Edition
from gearcad.rating.material_limits import Family, is_cast_steel, per_family

_CLAUSES = {
    2: {
        "Z_H": "6.1",
        "Z_B": "6.2",
        "Z_D": "6.2",
        "Z_E": "7",
        "Z_eps": "8",
        "Z_beta": "9",
        "Z_NT": "11",
        "Z_L": "12",
        "Z_v": "12",
        "Z_R": "12",
        "Z_W": "13",
        "Z_X": "14",
        **dict.fromkeys(("sigma_H0", "sigma_H", "sigma_HG", "sigma_HP"), "5"),
    },
    3: {
        "Y_F": "6",
        "Y_S": "7",
        "Y_beta": "8",
        "Y_B": "9",
        "Y_DT": "10",
        "Y_NT": "12",
        "Y_delta_relT": "13",
        "Y_RrelT": "14",
        "Y_X": "15",
        "Y_M": "annex B",
        **dict.fromkeys(("Y_ST", "sigma_F0", "sigma_F", "sigma_FG", "sigma_FP"), "5"),
    },
}
"""Clauses of ISO 6336:2006 that define each quantity, by part."""

_OWN = {
    Edition.ISO_2006: (),
    Edition.ISO_2019: ("Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT"),
    Edition.DIN_1987: ("Z_beta", "Z_X", "Y_B", "Y_DT"),
}
"""Quantities that an edition defines differently from that of 2006."""

_TRANSITION = "between static strength and endurance limit, and the static value, by one public transcription of DIN 3990-11"
_FLANK_2019 = "f_ZCa is as remembered of ISO 6336-2:2019"


def citations(edition: Edition) -> dict[str, str]:
    """Part and clause by symbol. Other editions than that of 2006 are cited where they differ, without a clause."""
    return {
        symbol: edition.dated_part(part)
        if symbol in _OWN[edition]
        else f"{Edition.ISO_2006.dated_part(part)}, {clause if ' ' in clause else f'clause {clause}'}"
        for part, clauses in _CLAUSES.items()
        for symbol, clause in clauses.items()
    }


def to_verify(
    edition: Edition, *, internal: bool = False, limited_flank: bool = False, limited_root: bool = False
) -> dict[str, str]:
    """Return the reason why a factor is to be verified, by symbol.

    `limited_flank`: load cycles of a flank are fewer than its endurance limit asks for; `limited_root` is the same for a root.
    """
    found = {"Z_D": "that of a ring is as remembered of ISO 6336-2:2006"} if internal else {}
    if edition is Edition.ISO_2019:
        found |= {
            "Z_B": _FLANK_2019,
            "Z_D": _FLANK_2019,
            "Y_F": "f_eps is as remembered of ISO 6336-3:2019",
            "Y_beta": "by one public transcription of ISO 6336-3:2019",
            "Y_DT": "taken as 1 beside f_eps of ISO 6336-3:2019",
        }
    if limited_flank:
        found |= dict.fromkeys(("Z_L", "Z_v", "Z_R", "Z_W", "Z_X"), _TRANSITION)
    if limited_root:
        found |= dict.fromkeys(("Y_delta_relT", "Y_RrelT", "Y_X"), _TRANSITION)
    return found


Points = tuple[tuple[float, float], ...]
"""Load cycles and factors, cycles rising, factors not."""

LONG_LIFE = 1e10
"""Load cycles from which on a factor is that of long life."""

_STEEL = (
    Family.STRUCTURAL,
    Family.THROUGH_HARDENED,
    Family.CASE_HARDENED,
    Family.SURFACE_HARDENED,
)
_NITRIDED_AND_IRON = (Family.NITRIDED, Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON)

_FLANK: dict[Family, Points] = per_family(
    {
        _STEEL: ((1e5, 1.6), (5e7, 1.0)),
        _NITRIDED_AND_IRON: ((1e5, 1.3), (2e6, 1.0)),
        (Family.NITROCARBURISED,): ((1e5, 1.1), (2e6, 1.0)),
    }
)
_FLANK_WITH_PITTING: Points = ((6e5, 1.6), (1e7, 1.3), (1e9, 1.0))
"""Points of the life factor of the flank where some pitting is permitted, for steel; the standard has no such line for other
materials.
"""

_ROOT: dict[Family, Points] = per_family(
    {
        (Family.STRUCTURAL, Family.THROUGH_HARDENED): ((1e4, 2.5), (3e6, 1.0)),
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): ((1e3, 2.5), (3e6, 1.0)),
        _NITRIDED_AND_IRON: ((1e3, 1.6), (3e6, 1.0)),
        (Family.NITROCARBURISED,): ((1e3, 1.1), (3e6, 1.0)),
    }
)


def flank_points(group: MaterialGroup, *, pitting: bool = False, long_life: float = 0.85) -> Points:
    """Z_NT (table 2): from the static strength over the endurance limit to `long_life` at 10^10 cycles.

    `pitting`: some of it is permitted, which the standard knows of steel that is not nitrided; others take no notice.
    `long_life` is from 0.85, to 1.0 where lubrication, material and experience are best. Raises ParameterError.
    """
    family = Family.of(group)
    points = _FLANK_WITH_PITTING if pitting and family in _STEEL else _FLANK[family]
    return _to_long_life(points, long_life)


def root_points(group: MaterialGroup, *, long_life: float = 0.85) -> Points:
    """Y_NT (table 1): as `flank_points`."""
    return _to_long_life(_ROOT[Family.of(group)], long_life)


def flank_life_factor(cycles: Values, group: MaterialGroup, *, pitting: bool = False, long_life: float = 0.85) -> Values:
    """Z_NT after so many load cycles of a flank, see `flank_points`. Raises ParameterError."""
    return interpolated_in_logs(cycles, flank_points(group, pitting=pitting, long_life=long_life))


def root_life_factor(cycles: Values, group: MaterialGroup, *, long_life: float = 0.85) -> Values:
    """Y_NT after so many load cycles of a root, see `root_points`. Raises ParameterError."""
    return interpolated_in_logs(cycles, root_points(group, long_life=long_life))


def static_cycles(points: Points) -> float:
    """Load cycles up to which the static strength holds."""
    return points[0][0]


def endurance_cycles(points: Points) -> float:
    """Load cycles from which on the endurance limit would hold, were it not for long life: the last corner but one."""
    return points[-2][0]


def cycles_at(factor: Values, points: Points) -> Values:
    """Return the greatest number of load cycles that has a factor: the inverse of the life factor.

    0 for more than the static factor, infinite for that of long life and less.
    """
    rising = [(value, number) for number, value in reversed(points)]
    limited = interpolated_in_logs(factor, rising)
    return chosen(factor > points[0][1], 0.0, chosen(factor <= points[-1][1], math.inf, limited))


def _to_long_life(points: Points, long_life: float) -> Points:
    require_number("long_life", long_life, at_least=0.85, at_most=1.0)
    return (*points, (LONG_LIFE, long_life))


def transition(cycles: Values, static: Values, endurance: Values, points: Points) -> Values:
    """Return a factor after a number of load cycles, from its values for static strength and for the endurance limit.

    endurance (static/endurance)^w, w = ln Z_NT(N)/ln Z_NT,stat by the `points` of Z_NT or Y_NT, 0 for long life: so sigma_G
    follows straight lines in log-log with the corners of the life factor (ISO 6336-2 and -3, 5.3; to be verified). So go Z_L,
    Z_v, Z_R, Z_W, Z_X, Y_delta_relT, Y_RrelT and Y_X.
    """
    static_logarithm = math.log(points[0][1])
    shares = [(number, max(0.0, math.log(factor) / static_logarithm)) for number, factor in points]
    return endurance * power(static / endurance, interpolated_over_log(cycles, shares))


def lubricant_factor(flank_limit: Values, viscosity_40: Values) -> Values:
    """Z_L = C_ZL + 4 (1 - C_ZL)/(1.2 + 134/nu_40)^2 (12.2): sigma_Hlim in MPa, the viscosity at 40 °C in mm²/s."""
    c_zl = _oil_share(flank_limit)
    return c_zl + 4 * (1 - c_zl) / power(1.2 + 134 / viscosity_40, 2)


def speed_factor(flank_limit: Values, speed: Values) -> Values:
    """Z_v = C_Zv + 2 (1 - C_Zv)/sqrt(0.8 + 32/v) (12.3), C_Zv = C_ZL + 0.02; v at the reference circle, above 0 m/s."""
    c_zv = _oil_share(flank_limit) + 0.02
    return c_zv + 2 * (1 - c_zv) / power(0.8 + 32 / speed, 0.5)


def flank_roughness_factor(flank_limit: Values, roughness: Values, reduced_radius: Values) -> Values:
    """Z_R = (3/R_z10)^C_ZR (12.4), C_ZR = 0.32 - 0.0002 sigma_Hlim from 0.15 to 0.08.

    `roughness` is the mean Rz of both flanks (µm) after running in, `reduced_radius` rho_red at the pitch point (mm), see
    `mesh_radius`.
    """
    c_zr = bounded(0.32 - 0.0002 * flank_limit, 0.08, 0.15)
    return power(3 / relative_roughness(roughness, roughness, reduced_radius), c_zr)


def relative_roughness(roughness_pinion: Values, roughness_wheel: Values, reduced_radius: Values) -> Values:
    """R_z10 = (R_z1 + R_z2)/2 (10/rho_red)^(1/3) (12.4): the mean Rz (µm), as it would count at rho_red = 10 mm."""
    return (roughness_pinion + roughness_wheel) / 2 * power(10 / reduced_radius, 1 / 3)


def mesh_radius(pinion_base_diameter: Values, wheel_base_diameter: Values, working_tangent: Values) -> Values:
    """rho_red = rho_1 rho_2/(rho_1 + rho_2) (mm), rho = d_b/2 tan alpha_wt (12.4); d_b2 of a ring is negative."""
    rho_1, rho_2 = pinion_base_diameter / 2 * working_tangent, wheel_base_diameter / 2 * working_tangent
    return rho_1 * rho_2 / (rho_1 + rho_2)


def _oil_share(flank_limit: Values) -> Values:
    """C_ZL = sigma_Hlim/4375 + 0.6357, 0.83 up to 850 MPa and 0.91 from 1200 MPa on."""
    return bounded(flank_limit / 4375 + 0.6357, 0.83, 0.91)


ONE_WAY = 1.0
OCCASIONALLY_REVERSED = 0.9
IDLER = 0.7
"""Y_M of idlers and planets, loaded both ways in every turn."""

_LEVEL = per_family(
    {
        (Family.CASE_HARDENED,): (0.8, 0.7),
        (Family.SURFACE_HARDENED,): (0.4, 0.6),
        (Family.NITRIDED, Family.NITROCARBURISED): (0.3, 0.3),
        (Family.STRUCTURAL, Family.THROUGH_HARDENED): (0.3, 0.5),
    }
)
"""M of endurance and of static strength; the former less 0.15 Y_S where case-hardened."""

_MEAN_STRESS_CAST_STEEL = (0.4, 0.6)


def mean_stress_factor(stress_ratio: Values, sensitivity: Values) -> Values:
    """Y_M = 1/(1 - R (1 - M)/(1 + M)) (B.2); R is the least over the greatest root stress, taken as 0 where it is positive."""
    return 1 / (1 - bounded(stress_ratio, -1e9, 0) * (1 - sensitivity) / (1 + sensitivity))


def mean_stress_sensitivity(
    group: MaterialGroup, stress_correction_factor: Values, *, static: bool = False, shot_peened: bool = False
) -> Values:
    """M (table B.1): how much the mean stress counts. `static` is that of static strength.

    `shot_peened` counts for case-hardened roots. Raises ParameterError for cast iron, of which the annex has none.
    """
    family = Family.of(group)
    if family not in _LEVEL or group in (MaterialGroup.NODULAR_IRON, MaterialGroup.MALLEABLE_IRON):
        raise ParameterError("group", group.value, "must be a steel: ISO 6336-3, annex B has no cast iron")
    hard = family is Family.CASE_HARDENED
    peened = hard and shot_peened
    endurance, ultimate = (
        _MEAN_STRESS_CAST_STEEL if is_cast_steel(group) else _LEVEL[Family.SURFACE_HARDENED if peened else family]
    )
    falling = 0.15 if hard and not peened and not static else 0.0
    return (ultimate if static else endurance) - falling * stress_correction_factor


_SLIP_LAYERS: dict[Family, tuple[tuple[float, float], ...]] = per_family(
    {
        (Family.STRUCTURAL,): ((300.0, 0.0833), (400.0, 0.0445)),
        (Family.THROUGH_HARDENED,): ((500.0, 0.0281), (600.0, 0.0194), (800.0, 0.0064), (1000.0, 0.0014)),
        (Family.GREY_IRON,): ((150.0, 0.3124), (300.0, 0.3095)),
        (Family.FERRITIC_NODULAR_IRON,): ((0.0, 0.3095),),
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): ((0.0, 0.003),),
        (Family.NITRIDED, Family.NITROCARBURISED): ((0.0, 0.1005),),
    }
)
"""Strength and rho' (mm), table 2; one point where no strength counts."""

_STATIC_LINES = per_family(
    {
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): (0.44, 0.12),
        (Family.NITRIDED, Family.NITROCARBURISED): (0.2, 0.6),
        (Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON): (0.0, 1.0),
    }
)
"""Coefficients a and b of the line a Y_S + b."""

_CAST_STEEL = (0.07, 0.86)

_STATIC_SUPPORT = {Family.STRUCTURAL: (0.93, 200.0), Family.THROUGH_HARDENED: (0.82, 300.0)}
"""Static notch support of a family: factor, and reference strength (MPa) of which the fourth root is taken."""


def strength_range(group: MaterialGroup) -> tuple[float, float] | None:
    """Return the strengths (MPa) between which table 2 has rho' of a group, which stays beyond; None where none counts."""
    points = _SLIP_LAYERS[Family.of(group)]
    return None if len(points) == 1 else (points[0][0], points[-1][0])


def cautious_strength(notch_parameter: Values, group: MaterialGroup) -> Values | None:
    """Return the strength in the range of a group that makes Y_delta_relT least, for a material whose own is not known."""
    if (ends := strength_range(group)) is None:
        return None
    low, high = (notch_sensitivity_factor(notch_parameter, group, end) for end in ends)
    return chosen(low <= high, *ends)


def slip_layer_thickness(group: MaterialGroup, strength: Numbers | None = None) -> Numbers:
    """rho' (mm, table 2): by the strength between its values, and that of the nearest beyond. Raises ParameterError."""
    points = _SLIP_LAYERS[Family.of(group)]
    return points[0][1] if len(points) == 1 else interpolated(_known(strength, group), points)


def notch_sensitivity_factor(notch_parameter: Values, group: MaterialGroup, strength: Numbers | None = None) -> Values:
    """Y_delta_relT = (1 + sqrt(0.2 rho' (1 + 2 q_s)))/(1 + sqrt(1.2 rho')), 1 at q_sT = 2.5. Raises ParameterError."""
    rho: Any = slip_layer_thickness(group, strength)
    result: Values = (1 + power(0.2 * rho * (1 + 2 * notch_parameter), 0.5)) / (1 + root(1.2 * rho))
    return result


def static_notch_sensitivity_factor(
    stress_correction_factor: Values, group: MaterialGroup, strength: Numbers | None = None
) -> Values:
    """Y_delta_relT of static strength by Y_S, 1 at Y_ST = 2 (to be verified). Raises ParameterError.

    Steel: (1 + c (Y_S - 1) r)/(1 + c r), r the fourth root of 200 MPa (St, c = 0.93) or 300 MPa (V, c = 0.82) over the
    strength; others a Y_S + b, and cast irons that are not malleable or perlitic 1.
    """
    family = Family.of(group)
    if is_cast_steel(group) or family in _STATIC_LINES:
        a, b = _CAST_STEEL if is_cast_steel(group) else _STATIC_LINES[family]
        return a * stress_correction_factor + b
    c, reference = _STATIC_SUPPORT[family]
    relief: Any = c * fourth_root(reference / _known(strength, group))
    result: Values = (1 + relief * (stress_correction_factor - 1)) / (1 + relief)
    return result


def _known(strength: Numbers | None, group: MaterialGroup) -> Numbers:
    if strength is None:
        name = "tensile_strength" if Family.of(group) is Family.GREY_IRON else "yield_strength"
        raise ParameterError(name, strength, f"must be given for {group.value}: Y_delta_relT needs it", "MPa")
    return strength


_FLANK_DIN = per_family(
    {
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED): (10.0, 1.05, 0.005, 0.9),
        (Family.NITRIDED, Family.NITROCARBURISED): (7.5, 1.08, 0.011, 0.75),
    }
)
"""Normal module from which on it tells, and a, b and the least of a - b m_n."""

_SIZE_ROOT = per_family(
    {
        (Family.STRUCTURAL, Family.THROUGH_HARDENED): (1.03, 0.006, 0.85),
        (Family.CASE_HARDENED, Family.SURFACE_HARDENED, Family.NITRIDED, Family.NITROCARBURISED): (1.05, 0.01, 0.8),
        (Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON): (1.075, 0.015, 0.7),
    }
)
"""a, b and the least of a - b m_n; each is 1 at m_n = 5 mm."""


def flank_size_factor(normal_module: Values, group: MaterialGroup, edition: Edition) -> Values:
    """Z_X: 1, but in DIN 3990-2 for large modules (mm) of hardened surfaces, 1.05 - 0.005 m_n or 1.08 - 0.011 m_n."""
    start, a, b, least = (0.0, 1.0, 0.0, 1.0)
    if edition is Edition.DIN_1987:
        start, a, b, least = _FLANK_DIN.get(Family.of(group), (start, a, b, least))
    return chosen(normal_module > start, bounded(a - b * normal_module, least, 1.0), 1.0)


def root_size_factor(normal_module: Values, group: MaterialGroup) -> Values:
    """Y_X (table 3): 1 up to a normal module of 5 mm, then 1.03 - 0.006 m_n and the like, down to a least value."""
    a, b, least = _SIZE_ROOT[Family.of(group)]
    return bounded(a - b * normal_module, least, 1.0)


ROUGHEST = 40.0
"""Rz (µm) up to which the standard states the formulas."""

_BRITTLE_OR_NITRIDED = (Family.GREY_IRON, Family.FERRITIC_NODULAR_IRON, Family.NITRIDED, Family.NITROCARBURISED)

_COLUMNS = per_family(
    {
        (Family.THROUGH_HARDENED, Family.CASE_HARDENED, Family.SURFACE_HARDENED): (1.12, 1.674, 0.529, 0.1),
        (Family.STRUCTURAL,): (1.07, 5.306, 4.203, 0.01),
        _BRITTLE_OR_NITRIDED: (
            1.025,
            4.299,
            3.259,
            0.0058,
        ),
    }
)
"""Y of smooth fillets; a, b and c of a - b (Rz + 1)^c."""


def root_surface_factor(roughness: Values, group: MaterialGroup) -> Values:
    """Y_RrelT = 1.674 - 0.529 (Rz + 1)^0.1 and the like, Rz of the fillet in µm; below 1 µm a number, 1.12.

    The numbers do not meet at 1 µm: there the standard jumps by 0.004 to 0.013. Beyond `ROUGHEST` the formulas go on.
    """
    smooth, a, b, c = _COLUMNS[Family.of(group)]
    return chosen(roughness < 1, smooth, a - b * power(roughness + 1, c))


def work_hardening_factor(hardness: Values, roughness: Values) -> Values:
    """Z_W = (1.2 - (HB - 130)/1700) (3/R_zH)^0.15 (13.2.1): the wheel's hardness, which counts from 130 to 470 HB.

    Never below 1: a pinion so rough wears the wheel, which the standard does not rate (IACS UR M56, 2.11).
    `roughness` is that of the pinion as the wheel feels it, R_zH (µm), see `equivalent_roughness`.
    """
    smoothed = (1.2 - (bounded(hardness, 130, 470) - 130) / 1700) * power(3 / roughness, 0.15)
    return bounded(smoothed, 1, 1.2)


def equivalent_roughness(
    pinion_roughness: Values, wheel_roughness: Values, reduced_radius: Values, viscosity_40: Values, speed: Values
) -> Values:
    """R_zH = R_z1 (10/rho_red)^0.33 (R_z1/R_z2)^0.66/(nu_40 v/1500)^0.33 (13.2.1), from 3 to 16 µm.

    Rz in µm before running in, rho_red in mm, nu_40 in mm²/s, v at the reference circle in m/s, above 0.
    """
    smoothing = power(10 / reduced_radius, 0.33) * power(pinion_roughness / wheel_roughness, 0.66)
    return bounded(pinion_roughness * smoothing / power(viscosity_40 * speed / 1500, 0.33), 3, 16)


def through_hardened_factor(pinion_hardness: Values, wheel_hardness: Values, gear_ratio: Values) -> Values:
    """Z_W = 1 + A (u - 1) (13.2.2), A = 0.00898 HB_1/HB_2 - 0.00829 from HB_1/HB_2 = 1.2 to 1.7; below it is 1.

    u, of a ring its amount, counts from 1 to 20.
    """
    ratio = pinion_hardness / wheel_hardness
    slope = chosen(ratio > 1.7, 0.00698, 0.00898 * ratio - 0.00829)
    return 1 + chosen(ratio < 1.2, 0.0, slope) * (bounded(gear_ratio, 1, 20) - 1)


def static_work_hardening_factor(hardness: Values) -> Values:
    """Z_W of static strength = 1.05 - (HB - 130)/6800 (13.2.1, to be verified): of a soft wheel with a hard pinion."""
    return 1.05 - (bounded(hardness, 130, 470) - 130) / 6800
