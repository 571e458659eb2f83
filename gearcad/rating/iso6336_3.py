"""Tooth root stress by ISO 6336-3:2006, Method B (the same in DIN 3990-3:1987 but for Y_B and Y_DT).

The load acts at the outer point of single pair contact of the virtual gear, and bends the tooth at its `root_section`. Tool,
thinning and root circle are those of the gear as it is cut: a thinned tooth comes from a thicker tooth of the tool, not from
a deeper cut (the standard's x_E).

Lengths in mm, stresses in MPa, angles in degrees; equations and clauses are those of ISO 6336-3:2006.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from gearcad.geometry import Gear, GearPair
from gearcad.geometry.tooling import shaped
from gearcad.notice import Notice
from gearcad.per_gear import Role
from gearcad.rating.editions import Edition
from gearcad.rating.rim import rim_of
from gearcad.rating.ring_formula import ring_section, substitute_radius
from gearcad.rating.root_section import RootSection, root_section
from gearcad.rating.virtual import LoadPoint, VirtualGear, load_point

__all__ = [
    "FormulaRoot",
    "RootRating",
    "deep_tooth_factor",
    "form_factor",
    "helix_angle_factor",
    "loaded_width",
    "nominal_root_stress",
    "root_notices",
    "root_rating",
    "stress_correction_factor",
]

LOAD_DISTRIBUTION_FACTOR = 1.0
"""f_eps of the form factor: 1 in both editions. It came with ISO 6336-3:2019, for helical gears and eps_alphan >= 2."""


@dataclass(frozen=True, kw_only=True)
class FormulaRoot:
    """What the formulas for rings give in place of the generated fillet: rho_fPv (mm), section, Y_F, Y_S, sigma_F0 (MPa)."""

    tool_radius: float
    section: RootSection
    form_factor: float
    stress_correction_factor: float
    nominal_stress: float

    def to_dict(self) -> dict[str, float]:
        """Values under their symbols."""
        return {
            "rho_fPv": self.tool_radius,
            "s_Fn": self.section.chord,
            "rho_F": self.section.fillet_radius,
            "h_Fe": self.section.moment_arm,
            "Y_F": self.form_factor,
            "Y_S": self.stress_correction_factor,
            "sigma_F0": self.nominal_stress,
        }


@dataclass(frozen=True, kw_only=True)
class RootRating:
    """Root stress of one gear: its section, factors, the width that carries (mm) and sigma_F0 without load factors (MPa).

    `formula` has what the standard's formulas say beside it, of a ring that a shaper cutter makes.
    """

    section: RootSection
    load_point: LoadPoint
    form_factor: float
    stress_correction_factor: float
    helix_angle_factor: float
    rim_thickness_factor: float
    deep_tooth_factor: float
    width: float
    nominal_stress: float
    formula: FormulaRoot | None = None

    def to_dict(self) -> dict[str, Any]:
        """Values under their symbols."""
        beside = {} if self.formula is None else {"formula": self.formula.to_dict()}
        return {
            "theta": self.section.tangent_angle,
            "s_Fn": self.section.chord,
            "rho_F": self.section.fillet_radius,
            "h_Fe": self.section.moment_arm,
            "q_s": self.section.notch_parameter,
            "d_en": self.load_point.diameter,
            "alpha_Fen": self.load_point.load_angle,
            "Y_F": self.form_factor,
            "Y_S": self.stress_correction_factor,
            "Y_beta": self.helix_angle_factor,
            "Y_B": self.rim_thickness_factor,
            "Y_DT": self.deep_tooth_factor,
            "b": self.width,
            "sigma_F0": self.nominal_stress,
            **beside,
        }


def form_factor(section: RootSection, load: LoadPoint, virtual: VirtualGear) -> float:
    """Y_F = 6 (h_Fe/m_n) cos alpha_Fen/((s_Fn/m_n)^2 cos alpha_n) (9), times f_eps."""
    m_n = virtual.normal_module
    lever = 6 * section.moment_arm / m_n * math.cos(math.radians(load.load_angle))
    stiff = (section.chord / m_n) ** 2 * math.cos(math.radians(virtual.pressure_angle))
    return lever / stiff * LOAD_DISTRIBUTION_FACTOR


def stress_correction_factor(section: RootSection) -> float:
    """Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)) (36) with L = s_Fn/h_Fe (37)."""
    slimness = section.chord / section.moment_arm
    return (1.2 + 0.13 * slimness) * math.pow(section.notch_parameter, 1 / (1.21 + 2.3 / slimness))


def helix_angle_factor(helix_angle: float, overlap_ratio: float) -> float:
    """Y_beta = 1 - eps_beta |beta|/120 deg (clause 8), with eps_beta at most 1 and |beta| at most 30 deg."""
    return 1 - min(overlap_ratio, 1.0) * min(abs(helix_angle), 30.0) / 120


def deep_tooth_factor(virtual_contact_ratio: float, accuracy_grade: int, edition: Edition) -> float:
    """Y_DT (clause 10): 2.366 - 0.666 eps_alphan from 2.05 to 2.5, then 0.7, for accuracy grade 4 or better; else 1.

    The lower factor also asks for a profile modification that spreads the load; DIN 3990-3 has none.
    """
    if accuracy_grade > 4 or edition is Edition.DIN_1987 or virtual_contact_ratio <= 2.05:
        return 1.0
    return 0.7 if virtual_contact_ratio > 2.5 else 2.366 - 0.666 * virtual_contact_ratio


def loaded_width(pair: GearPair, role: Role) -> float:
    """b (mm) of one gear's root: the common width, and at either end what the gear stands over, at most m_n (clause 5)."""
    common, gear = pair.common_width, pair.gears.pick(role)
    side = common.offset if role is Role.PINION else common.offset - pair.axial_offset
    over = [gear.face_width / 2 - sign * side - common.width / 2 for sign in (1, -1)]
    return common.width + sum(min(each, gear.normal_module) for each in over)


def nominal_root_stress(tangential_force: float, width: float, normal_module: float, factors: float) -> float:
    """sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta Y_B Y_DT (clause 5); `factors` is the product of the five Y, F_t in N."""
    return tangential_force / (width * normal_module) * factors


def root_rating(pair: GearPair, role: Role, tangential_force: float, edition: Edition, accuracy_grade: int) -> RootRating:
    """Root stress of one gear of a pair under the tangential force F_t at the reference circle (N)."""
    gear = pair.gears.pick(role)
    virtual, ratio = VirtualGear.of(gear), _virtual_contact_ratio(pair)
    load = load_point(virtual, ratio)
    section = root_section(gear, virtual, load)
    y_f, y_s = form_factor(section, load, virtual), stress_correction_factor(section)
    y_beta = helix_angle_factor(gear.helix_angle, pair.overlap_ratio)
    y_b = rim_of(gear).factor(edition)
    y_dt = deep_tooth_factor(ratio, accuracy_grade, edition)
    width = loaded_width(pair, role)

    def stress(form: float, correction: float) -> float:
        factors = form * correction * y_beta * y_b * y_dt
        return nominal_root_stress(tangential_force, width, gear.normal_module, factors)

    return RootRating(
        section=section,
        load_point=load,
        form_factor=y_f,
        stress_correction_factor=y_s,
        helix_angle_factor=y_beta,
        rim_thickness_factor=y_b,
        deep_tooth_factor=y_dt,
        width=width,
        nominal_stress=stress(y_f, y_s),
        formula=_formula(gear, virtual, load, stress),
    )


def _formula(gear: Gear, virtual: VirtualGear, load: LoadPoint, stress: Callable[[float, float], float]) -> FormulaRoot | None:
    """Of a ring with a shaper cutter, for which the substitute rack is made; None also where that has no section."""
    if not gear.internal or gear.cutter.teeth is None:
        return None
    radius = substitute_radius(gear, gear.cutter.teeth)
    section = ring_section(gear, virtual, load, radius)
    if section is None:
        return None
    y_f, y_s = form_factor(section, load, virtual), stress_correction_factor(section)
    return FormulaRoot(
        tool_radius=radius, section=section, form_factor=y_f, stress_correction_factor=y_s, nominal_stress=stress(y_f, y_s)
    )


def _virtual_contact_ratio(pair: GearPair) -> float:
    """eps_alphan = eps_alpha/cos^2 beta_b (23)."""
    return pair.transverse_contact_ratio / math.cos(math.radians(pair.pinion.base_helix_angle)) ** 2


def root_notices(pair: GearPair, role: Role, rating: RootRating, edition: Edition) -> Iterator[Notice]:
    """Where one gear leaves the range that part 3 states for its formulas."""
    gear, root = pair.gears.pick(role), f"{role.value} root"
    yield from _section_notices(gear, rating, root)
    if not 1 <= (notch := rating.section.notch_parameter) < 8:
        yield Notice("notch-parameter", f"Y_S is stated for q_s from 1 to 8, here {notch:.3g}", root)
    yield from rim_of(gear).notices(edition, f"{role.value} rim")
    if (ratio := _virtual_contact_ratio(pair)) >= 2:
        text = f"Y_F assumes that one pair of teeth carries alone, but eps_alphan is {ratio:.4f}"
        yield Notice("deep-teeth", text, root)


def _section_notices(gear: Gear, rating: RootRating, root: str) -> Iterator[Notice]:
    """What the section is, or is not."""
    if shaped(gear):
        yield Notice("generated-root", _generated(gear, rating), root)
        return
    if not rating.section.on_fillet:
        text = "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"
        yield Notice("tangent-off-fillet", text, root)
    if gear.root_radius == 0:
        yield Notice("sharp-tool", "Y_F and Y_S are stated for a tool with a rounded tip, here it is sharp", root)


def _generated(gear: Gear, rating: RootRating) -> str:
    """That the section is ours, and what the standard's formulas say."""
    own = (
        f"Y_F and Y_S are those of the fillet as it is generated, at tangents of {rating.section.lean:g} deg (ours, no clause)"
    )
    if not gear.internal:
        return f"{own}; the standard's formulas are of hobs"
    if gear.cutter.teeth is None:
        return f"{own}; the standard's formulas are of shaper cutters, not of a form root"
    if rating.formula is None:
        return f"{own}; the standard's formulas give no section here"
    values = f"Y_F {rating.formula.form_factor:.4g}, Y_S {rating.formula.stress_correction_factor:.4g}"
    here = f"instead of {rating.form_factor:.4g} and {rating.stress_correction_factor:.4g}"
    return f"{own}; the formulas of 2006 have {values} {here}"
