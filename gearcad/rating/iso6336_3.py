"""Tooth root stress by ISO 6336-3:2006, Method B (the same in DIN 3990-3:1987 but for Y_B and Y_DT).

The load acts at the outer point of single pair contact of the virtual gear; the section is where tangents at 30 degrees to
the middle of the tooth touch the fillet. The standard's E, G, H and theta describe the very trochoid that gear.profile is
made of, so both give the same section; tool, thinning and root circle are those of the gear as it is cut: a thinned tooth
comes from a thicker tooth of the tool, not from a deeper cut (the standard's x_E).

Lengths in mm, stresses in MPa, angles in degrees; equations and clauses are those of ISO 6336-3:2006.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from gearcad.errors import GeometryError
from gearcad.geometry import Gear, GearPair
from gearcad.notice import Notice
from gearcad.per_gear import Role
from gearcad.rating.editions import Edition
from gearcad.rating.virtual import LoadPoint, VirtualGear, load_point

__all__ = [
    "RootRating",
    "RootSection",
    "deep_tooth_factor",
    "form_factor",
    "helix_angle_factor",
    "loaded_width",
    "nominal_root_stress",
    "rim_thickness_factor",
    "rim_thickness_ratio",
    "root_notices",
    "root_rating",
    "root_section",
    "stress_correction_factor",
    "tangent_angle",
]

RIM_LIMIT = 1.2
"""s_R/h_t (external gears) from which on a rim is as good as a solid body."""

LOAD_DISTRIBUTION_FACTOR = 1.0
"""f_eps of the form factor: 1 in both editions. It came with ISO 6336-3:2019, for helical gears and eps_alphan >= 2."""


@dataclass(frozen=True, kw_only=True)
class RootSection:
    """Section at the 30-degree tangents: `tangent_angle` theta (deg), chord s_Fn, fillet radius rho_F, and the arm h_Fe (mm).

    `on_fillet` is False where the tangent would touch beyond the fillet, on the flank: then the formulas do not hold.
    """

    tangent_angle: float
    chord: float
    fillet_radius: float
    moment_arm: float
    on_fillet: bool

    @property
    def notch_parameter(self) -> float:
        """q_s = s_Fn/(2 rho_F) (38)."""
        return self.chord / (2 * self.fillet_radius)


@dataclass(frozen=True, kw_only=True)
class RootRating:
    """Root stress of one gear: its section, factors, the width that carries (mm) and sigma_F0 without load factors (MPa)."""

    section: RootSection
    load_point: LoadPoint
    form_factor: float
    stress_correction_factor: float
    helix_angle_factor: float
    rim_thickness_factor: float
    deep_tooth_factor: float
    width: float
    nominal_stress: float

    def to_dict(self) -> dict[str, Any]:
        """Values under their symbols."""
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
        }


def tool_half_width(gear: Gear) -> float:
    """E (10) (mm): from the middle of the tool's tooth to the centre of its tip arc.

    pi m_n/4 - h_fP tan alpha_n - (1 - sin alpha_n) rho_fP/cos alpha_n, plus half the tooth thinning. No protuberance.
    """
    m_n, alpha_n = gear.normal_module, math.radians(gear.rack.pressure_angle)
    corner = (1 - math.sin(alpha_n)) * gear.root_radius / math.cos(alpha_n)
    return m_n * (math.pi / 4 - gear.dedendum * math.tan(alpha_n) - corner) + gear.tooth_thinning / 2


def tangent_angle(g: float, h: float, virtual_teeth: float) -> float | None:
    """theta (rad) of theta = (2 G/z_n) tan theta - H (14), by Newton from the standard's pi/6; None where there is none."""
    slope, theta, step = 2 * g / virtual_teeth, math.pi / 6, math.inf
    for _ in range(50):
        step = (theta - slope * math.tan(theta) + h) / (1 - slope / math.cos(theta) ** 2)
        theta -= step
        if abs(step) < 1e-15:
            break
    return theta if abs(step) < 1e-12 and 1e-9 < theta < math.pi / 2 else None


def root_section(gear: Gear, virtual: VirtualGear, load: LoadPoint) -> RootSection:
    """The section at the 30-degree tangents and the arm at which the load bends it.

    G = rho_fP/m_n - h_fP/m_n + x (12), H = (2/z_n) (pi/2 - E/m_n) - pi/3 (13), then s_Fn (15), rho_F (17) and h_Fe (18).
    Raises GeometryError for teeth without such a section, as of a gear with three.
    """
    m_n, z_n, rho = gear.normal_module, virtual.teeth, gear.root_radius
    g = rho - gear.dedendum + gear.profile_shift
    h = 2 / z_n * (math.pi / 2 - tool_half_width(gear) / m_n) - math.pi / 3
    theta = tangent_angle(g, h, z_n)
    if theta is None:
        raise GeometryError("teeth", gear.teeth, "must be more for a rating: no tangent at 30 deg touches the fillet")
    centre = g / math.cos(theta) - rho
    s_fn = z_n * math.sin(math.pi / 3 - theta) + math.sqrt(3) * centre
    rho_f = rho + 2 * g**2 / (math.cos(theta) * (z_n * math.cos(theta) ** 2 - 2 * g))
    gamma_e, alpha_fen = math.radians(load.half_angle), math.radians(load.load_angle)
    lever = (math.cos(gamma_e) - math.sin(gamma_e) * math.tan(alpha_fen)) * load.diameter / m_n
    height = z_n * math.cos(math.pi / 3 - theta) + centre
    return RootSection(
        tangent_angle=math.degrees(theta),
        chord=m_n * s_fn,
        fillet_radius=m_n * rho_f,
        moment_arm=m_n * (lever - height) / 2,
        # Undercut takes away only the top of the fillet, where it leans by less than the involute there.
        on_fillet=theta <= math.pi / 2 - math.radians(virtual.pressure_angle),
    )


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


def rim_thickness_ratio(gear: Gear) -> float:
    """s_R/h_t: rim below the root circle, down to the web if one is given, else to bore and keyway, over the tooth height."""
    rim = gear.body.rim_thickness or (gear.root_diameter - gear.body.opening_diameter) / 2
    return rim / ((gear.tip_diameter - gear.root_diameter) / 2)


def rim_thickness_factor(ratio: float, edition: Edition) -> float:
    """Y_B = 1.6 ln(2.242 h_t/s_R) (clause 9) for s_R/h_t below 1.2, else 1; DIN 3990-3 has none."""
    return 1.0 if ratio >= RIM_LIMIT or edition is Edition.DIN_1987 else 1.6 * math.log(2.242 / ratio)


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
    y_b = rim_thickness_factor(rim_thickness_ratio(gear), edition)
    y_dt = deep_tooth_factor(ratio, accuracy_grade, edition)
    width = loaded_width(pair, role)
    return RootRating(
        section=section,
        load_point=load,
        form_factor=y_f,
        stress_correction_factor=y_s,
        helix_angle_factor=y_beta,
        rim_thickness_factor=y_b,
        deep_tooth_factor=y_dt,
        width=width,
        nominal_stress=nominal_root_stress(tangential_force, width, gear.normal_module, y_f * y_s * y_beta * y_b * y_dt),
    )


def _virtual_contact_ratio(pair: GearPair) -> float:
    """eps_alphan = eps_alpha/cos^2 beta_b (23)."""
    return pair.transverse_contact_ratio / math.cos(math.radians(pair.pinion.base_helix_angle)) ** 2


def root_notices(pair: GearPair, role: Role, rating: RootRating) -> Iterator[Notice]:
    """Where one gear leaves the range that part 3 states for its formulas."""
    gear, root = pair.gears.pick(role), f"{role.value} root"
    if not rating.section.on_fillet:
        text = "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"
        yield Notice("tangent-off-fillet", text, root)
    if gear.root_radius == 0:
        yield Notice("sharp-tool", "Y_F and Y_S are stated for a tool with a rounded tip, here it is sharp", root)
    if not 1 <= (notch := rating.section.notch_parameter) < 8:
        yield Notice("notch-parameter", f"Y_S is stated for q_s from 1 to 8, here {notch:.3g}", root)
    if (rim := rim_thickness_ratio(gear)) < RIM_LIMIT:
        said = "is at most 0.5, which the standard asks to avoid" if rim <= 0.5 else f"weakens the root (below {RIM_LIMIT:g})"
        factor = rating.rim_thickness_factor
        known = f"Y_B = {factor:.4g}" if factor > 1 else "the standard chosen has no factor for it"
        yield Notice("thin-rim", f"{rim:.3g} tooth heights under the root {said}; {known}", f"{role.value} rim")
    if (ratio := _virtual_contact_ratio(pair)) >= 2:
        text = f"Y_F assumes that one pair of teeth carries alone, but eps_alphan is {ratio:.4f}"
        yield Notice("deep-teeth", text, root)
