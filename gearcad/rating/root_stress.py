"""Tooth root stress by ISO 6336-3:2006, Method B (but for Y_B, Y_DT in DIN 3990-3:1987, and Y_F, Y_beta, Y_DT in 2019).

The load acts at the outer point of single pair contact of the virtual gear, and bends the tooth at its `root_section`. Tool,
thinning and root circle are those of the gear as it is cut: a thinned tooth comes from a thicker tooth of the tool, not from
a deeper cut (the standard's x_E).

Lengths in mm, stresses in MPa, angles in degrees; equations and clauses are those of ISO 6336-3:2006.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Generic, NamedTuple

from gearcad.core.errors import GeometryError
from gearcad.core.records import Notice, Role
from gearcad.core.values import Values, chosen, cos, magnitude, radians, smaller
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.gear_tools import shaped, wheel_tip_radius
from gearcad.rating.editions import Edition, helix_angle_divisor, load_distribution_factor
from gearcad.rating.root_section import (
    LoadPoint,
    RootSection,
    VirtualGear,
    load_point,
    ring_section,
    root_section,
    substitute_radius,
)
from gearcad.rating.tooth_stiffness import rim_of


@dataclass(frozen=True, kw_only=True)
class FormulaRoot:
    """Results of the formulas for rings, in place of the generated fillet: rho_fPv (mm), section, Y_F, Y_S, sigma_F0 (MPa)."""

    tool_radius: float
    section: RootSection[float]
    form_factor: float
    stress_correction_factor: float
    nominal_stress: float

    @classmethod
    def of(cls, rating: RootRating[float], tool_radius: float) -> FormulaRoot:
        """Return the section, factors and stress of a rating by formula; `tool_radius` is rho_fPv (mm)."""
        return cls(
            tool_radius=tool_radius,
            section=rating.section,
            form_factor=rating.form_factor,
            stress_correction_factor=rating.stress_correction_factor,
            nominal_stress=rating.nominal_stress,
        )

    def to_dict(self) -> dict[str, float]:
        """Return the values under their symbols."""
        return {
            "rho_fPv": self.tool_radius,
            "s_Fn": self.section.chord,
            "rho_F": self.section.fillet_radius,
            "h_Fe": self.section.moment_arm,
            "Y_F": self.form_factor,
            "Y_S": self.stress_correction_factor,
            "sigma_F0": self.nominal_stress,
        }


_MOST_NOTCH = 2.0
"""Root of t_g/rho_g from which on the standard has no factor for a grinding notch."""


class GrindingNotch(NamedTuple):
    """Step that a finishing wheel leaves in the fillet: depth t_g and radius rho_g (mm)."""

    depth: float
    radius: float

    @classmethod
    def of(cls, part: Gear | Rack) -> GrindingNotch | None:
        """Return the notch of a gear or a rack whose wheel ends in stock that the tool has left; None without one.

        Raises GeometryError for one that is too sharp for the standard's factor.
        """
        outline, given = part.profile.root, part.finishing.notch_depth
        if outline is None or not outline.wheel or part.residual_undercut >= 0:
            return None
        depth = -part.residual_undercut if given is None else given
        notch = cls(depth, part.wheel_tip_radius if isinstance(part, Rack) else wheel_tip_radius(part))
        if math.sqrt(notch.depth / notch.radius) >= _MOST_NOTCH:
            permitted = (
                f"must be above {notch.depth / _MOST_NOTCH**2:.6g} mm for a rating: Y_Sg holds for sqrt(t_g/rho_g) below 2"
            )
            raise GeometryError("finishing.wheel_tip_radius", notch.radius, permitted, "mm")
        return notch

    def factor(self, stress_correction_factor: Values) -> Values:
        """Y_Sg = 1.3 Y_S/(1.3 - 0.6 sqrt(t_g/rho_g)) (7.3, grinding notches)."""
        return 1.3 * stress_correction_factor / (1.3 - 0.6 * math.sqrt(self.depth / self.radius))


@dataclass(frozen=True, kw_only=True)
class RootRating(Generic[Values]):
    """Root stress of one gear: its section, factors, the width that carries (mm) and sigma_F0 without load factors (MPa).

    `formula` has what the standard's formulas say beside it, of a ring that a shaper cutter makes. With a grinding `notch` the
    stress correction factor is Y_Sg.
    """

    section: RootSection[Values]
    load_point: LoadPoint[Values]
    form_factor: Values
    stress_correction_factor: Values
    helix_angle_factor: Values
    rim_thickness_factor: Values
    deep_tooth_factor: Values
    width: Values
    nominal_stress: Values
    formula: FormulaRoot | None = None
    notch: GrindingNotch | None = None

    @property
    def factors(self) -> dict[str, Values]:
        """Factors of the root stress under their symbols, in the order of all outputs."""
        return {
            "Y_F": self.form_factor,
            "Y_S": self.stress_correction_factor,
            "Y_beta": self.helix_angle_factor,
            "Y_B": self.rim_thickness_factor,
            "Y_DT": self.deep_tooth_factor,
        }

    def to_dict(self) -> dict[str, Any]:
        """Return the values under their symbols."""
        beside: dict[str, Any] = {} if self.formula is None else {"formula": self.formula.to_dict()}
        if self.notch is not None:
            beside["grinding_notch"] = {
                "t_g": self.notch.depth,
                "rho_g": self.notch.radius,
                "Y_S": self.stress_correction_factor / self.notch.factor(1.0),
                "Y_Sg": self.stress_correction_factor,
            }
        return {
            "theta": self.section.tangent_angle,
            "s_Fn": self.section.chord,
            "rho_F": self.section.fillet_radius,
            "h_Fe": self.section.moment_arm,
            "q_s": self.section.notch_parameter,
            **self.load_point.to_dict(),
            **self.factors,
            "b": self.width,
            "sigma_F0": self.nominal_stress,
            **beside,
        }


def form_factor(
    section: RootSection[Values], load: LoadPoint[Values], virtual: VirtualGear[Values], load_distribution: Values = 1.0
) -> Values:
    """Y_F = 6 (h_Fe/m_n) cos alpha_Fen/((s_Fn/m_n)^2 cos alpha_n) (9), times f_eps, which came with the edition of 2019."""
    m_n = virtual.normal_module
    lever = 6 * section.moment_arm / m_n * cos(radians(load.load_angle))
    stiff = (section.chord / m_n) ** 2 * math.cos(math.radians(virtual.pressure_angle))
    return lever / stiff * load_distribution


def stress_correction_factor(section: RootSection[Values]) -> Values:
    """Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)) (36) with L = s_Fn/h_Fe (37)."""
    slimness = section.chord / section.moment_arm
    result: Values = (1.2 + 0.13 * slimness) * section.notch_parameter ** (1 / (1.21 + 2.3 / slimness))
    return result


def helix_angle_factor(helix_angle: Values, overlap_ratio: Values, edition: Edition = Edition.ISO_2006) -> Values:
    """Y_beta = 1 - eps_beta |beta|/120 deg (clause 8), with eps_beta at most 1 and |beta| at most 30 deg; 2019: /cos^3 beta."""
    plain = 1 - smaller(overlap_ratio, 1.0) * smaller(magnitude(helix_angle), 30.0) / 120
    return plain / helix_angle_divisor(helix_angle) if edition is Edition.ISO_2019 else plain


def deep_tooth_factor(virtual_contact_ratio: Values, accuracy_grade: int, edition: Edition) -> Values:
    """Y_DT (clause 10): 2.366 - 0.666 eps_alphan from 2.05 to 2.5, then 0.7, for accuracy grade 4 or better; else 1.

    The lower factor also asks for a profile modification that spreads the load; DIN 3990-3 has none. In the edition of 2019
    f_eps spreads it, to be verified: it is not taken twice.
    """
    if accuracy_grade > 4 or edition is not Edition.ISO_2006:
        return 1.0
    falling = chosen(virtual_contact_ratio > 2.5, 0.7, 2.366 - 0.666 * virtual_contact_ratio)
    return chosen(virtual_contact_ratio > 2.05, falling, 1.0)


def loaded_width(pair: GearPair, role: Role) -> float:
    """b (mm) of one gear's root: the common width, and at either end what the gear stands over, at most m_n (clause 5)."""
    common, gear = pair.common_width, pair.gears.pick(role)
    side = common.offset if role is Role.PINION else common.offset - pair.axial_offset
    over = [gear.face_width / 2 - sign * side - common.width / 2 for sign in (1, -1)]
    return common.width + sum(min(each, gear.normal_module) for each in over)


def nominal_root_stress(tangential_force: Values, width: Values, normal_module: Values, factors: Values) -> Values:
    """sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta Y_B Y_DT (clause 5); `factors` is the product of the five Y, F_t in N."""
    return tangential_force / (width * normal_module) * factors


def virtual_contact_ratio(transverse_contact_ratio: Values, base_helix_angle: Values) -> Values:
    """eps_alphan = eps_alpha/cos^2 beta_b (23)."""
    return transverse_contact_ratio / cos(radians(base_helix_angle)) ** 2


@dataclass(frozen=True, kw_only=True)
class RootMesh(Generic[Values]):
    """Load on the roots of a mesh: F_t at the reference circle (N), eps_alphan, eps_beta, helix angle (deg); and the rules."""

    tangential_force: Values
    virtual_contact_ratio: Values
    overlap_ratio: Values
    helix_angle: Values
    edition: Edition
    accuracy_grade: int

    @classmethod
    def of(cls, pair: GearPair | RackPair, tangential_force: float, edition: Edition, accuracy_grade: int) -> RootMesh[float]:
        """Return the load and rules of the roots of a pair, under `tangential_force` F_t (N)."""
        pinion = pair.pinion
        return RootMesh(
            tangential_force=tangential_force,
            virtual_contact_ratio=virtual_contact_ratio(pair.transverse_contact_ratio, pinion.base_helix_angle),
            overlap_ratio=pair.overlap_ratio,
            helix_angle=pinion.helix_angle,
            edition=edition,
            accuracy_grade=accuracy_grade,
        )

    @cached_property
    def load_distribution(self) -> Values:
        """Load distribution factor f_eps: 1 except in the edition of 2019."""
        if self.edition is not Edition.ISO_2019:
            return 1.0
        return load_distribution_factor(self.virtual_contact_ratio, self.overlap_ratio)

    @cached_property
    def helix_angle_factor(self) -> Values:
        """Helix angle factor Y_beta of both gears."""
        return helix_angle_factor(self.helix_angle, self.overlap_ratio, self.edition)

    def rating(
        self,
        section: RootSection[Values],
        load: LoadPoint[Values],
        virtual: VirtualGear[Values],
        *,
        width: Values,
        rim_thickness_factor: float,
        notch: GrindingNotch | None = None,
    ) -> RootRating[Values]:
        """Return the root rating of a tooth that carries over `width` (mm)."""
        y_f, y_s = form_factor(section, load, virtual, self.load_distribution), stress_correction_factor(section)
        if notch is not None:
            y_s = notch.factor(y_s)
        y_beta = self.helix_angle_factor
        y_dt = deep_tooth_factor(self.virtual_contact_ratio, self.accuracy_grade, self.edition)
        factors = y_f * y_s * y_beta * rim_thickness_factor * y_dt
        return RootRating(
            section=section,
            load_point=load,
            form_factor=y_f,
            stress_correction_factor=y_s,
            helix_angle_factor=y_beta,
            rim_thickness_factor=rim_thickness_factor,
            deep_tooth_factor=y_dt,
            width=width,
            nominal_stress=nominal_root_stress(self.tangential_force, width, virtual.normal_module, factors),
            notch=notch,
        )


def root_rating(gear: Gear, mesh: RootMesh[float], width: float) -> RootRating[float]:
    """Root stress of a gear that carries over a width (mm); with a tolerance of its stock, the one with the greater stress."""
    if tolerance := gear.premachining.stock_tolerance:
        stocks = [gear.stock + sign * tolerance for sign in (-1, 1)]
        ends = [_root_rating(gear.with_stock(stock), mesh, width) for stock in stocks if gear.can_have_stock(stock)]
        return max([*ends, _root_rating(gear, mesh, width)], key=lambda rating: rating.nominal_stress)
    return _root_rating(gear, mesh, width)


def _root_rating(gear: Gear, mesh: RootMesh[float], width: float) -> RootRating[float]:
    """Root stress of a gear, whose stock is as it is told, that carries over a width (mm)."""
    virtual = VirtualGear.of(gear)
    load, y_b = load_point(virtual, mesh.virtual_contact_ratio), rim_of(gear).factor(mesh.edition)

    def rated(section: RootSection[float]) -> RootRating[float]:
        return mesh.rating(section, load, virtual, width=width, rim_thickness_factor=y_b, notch=GrindingNotch.of(gear))

    found = rated(root_section(gear, virtual, load))
    if not gear.internal or gear.root_cutter.teeth is None:
        return found
    # The substitute rack is made for rings of a shaper cutter.
    radius = substitute_radius(gear, gear.root_cutter.teeth)
    section = ring_section(gear, virtual, load, radius)
    return found if section is None else replace(found, formula=FormulaRoot.of(rated(section), radius))


def root_notices(gear: Gear, role: Role, rating: RootRating[float], mesh: RootMesh[float]) -> Iterator[Notice]:
    """Yield a notice for each way in which one gear leaves the range that ISO 6336-3 states for its formulas."""
    root = f"{role.value} root"
    yield from _section_notices(gear, rating, root)
    yield from finishing_notices(gear, rating, root)
    yield from notch_notices(rating, root)
    yield from rim_of(gear).notices(mesh.edition, f"{role.value} rim")
    yield from deep_notices(mesh, root)


def finishing_notices(part: Gear | Rack, rating: RootRating[float], root: str) -> Iterator[Notice]:
    """Yield notices of a grinding notch, and of a stock with a tolerance."""
    if rating.notch is not None:
        size = f"{rating.notch.depth:.4g} mm deep with a radius of {rating.notch.radius:.4g} mm"
        plain = rating.stress_correction_factor / rating.notch.factor(1.0)
        yield Notice("notch-in-root", f"Y_S is Y_Sg of a grinding notch {size}; without it Y_S is {plain:.3f}", root)
    if part.premachining.stock_tolerance:
        yield Notice(
            "stock-tolerance", "of both ends of the tolerance of the stock, the root with the greater stress is rated", root
        )


def notch_notices(rating: RootRating[float], root: str) -> Iterator[Notice]:
    """Yield a notice if q_s is outside the range that Y_S is stated for."""
    if not 1 <= (notch := rating.section.notch_parameter) < 8:
        yield Notice("notch-parameter", f"Y_S is stated for q_s from 1 to 8, here {notch:.3g}", root)


def deep_notices(mesh: RootMesh[float], root: str) -> Iterator[Notice]:
    """Yield a notice if more than one pair of teeth carries at any time."""
    if (ratio := mesh.virtual_contact_ratio) >= 2:
        text = f"Y_F assumes that one pair of teeth carries alone, but eps_alphan is {ratio:.4f}"
        yield Notice("deep-teeth", text, root)


def _section_notices(gear: Gear, rating: RootRating[float], root: str) -> Iterator[Notice]:
    """Yield notices on how the section was found, or why the formulas do not hold for it."""
    if shaped(gear):
        yield Notice("generated-root", _generated(gear, rating), root)
        return
    if not rating.section.on_fillet:
        text = "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"
        yield Notice("tangent-off-fillet", text, root)
    if gear.root_radius == 0:
        yield Notice("sharp-tool", "Y_F and Y_S are stated for a tool with a rounded tip, here it is sharp", root)


def _generated(gear: Gear, rating: RootRating[float]) -> str:
    """Return the text that names the generated section as our own method, and gives the values of the standard's formulas."""
    own = (
        f"Y_F and Y_S are those of the fillet as it is generated, at tangents of {rating.section.lean:g} deg (ours, no clause)"
    )
    if not gear.internal:
        return f"{own}; the standard's formulas are of hobs"
    if gear.root_cutter.teeth is None:
        return f"{own}; the standard's formulas are of shaper cutters, not of a form root"
    if rating.formula is None:
        return f"{own}; the standard's formulas give no section here"
    form, stress = rating.formula.form_factor, rating.formula.stress_correction_factor
    here = f"{rating.form_factor:.4g} and {rating.stress_correction_factor:.4g}"
    return f"{own}; the formulas of 2006 have Y_F {form:.4g}, Y_S {stress:.4g} instead of {here}"
