"""Symbols, units, clauses and plain words of all quantities.

Inputs say it at their own fields (see `schema`). Keys are those of what `Gear.to_dict()` and `GearPair.to_dict()` derive, of
`Rating.to_dict()`, and of the figures of a check, nested ones joined by a dot (`path_of_contact.A`); GEAR_RATING holds those
under a rating's "pinion" and "wheel". Clauses are those of ISO 21771:2007 unless another standard is named; an empty
source means that the quantity is our own.
"""

from __future__ import annotations

import re
from enum import Enum
from functools import lru_cache
from typing import NamedTuple

__all__ = [
    "CHECK",
    "CHECK_COLUMNS",
    "COURSES",
    "DRAW",
    "DRIVE",
    "DYNAMICS",
    "GEAR",
    "GEAR_RATING",
    "INDEX",
    "LOAD_FACTOR_DETAILS",
    "MASS",
    "MESH",
    "MODIFY",
    "MODIFY_FIGURES",
    "MODIFY_ON_SHAFTS",
    "PAIR",
    "PER_GEAR",
    "PLANETARY",
    "PLANETARY_MEMBER",
    "PLASTIC",
    "RACK",
    "RACK_PAIR",
    "RATING",
    "RING_FORMULA",
    "SCUFFING",
    "SHAFT",
    "SHAFTS",
    "SHAFT_SEGMENT",
    "SPLINE",
    "STIFFNESS",
    "STRENGTH",
    "STRENGTH_FACTORS",
    "STRENGTH_FIGURES",
    "TOLERANCES",
    "Better",
    "Symbol",
    "parts_of",
]


INDEX = r"_((?:[^\s*/,;)]|,(?=[^\W\d_]))*[^\s*/,;).:])"
"""Pattern of the index of a symbol with the mark before it, such as `_n` in m_n."""

_INDEX = re.compile(INDEX)


class Better(Enum):
    """The better one of two values of a quantity."""

    HIGHER = "higher"
    LOWER = "lower"


class Symbol(NamedTuple):
    """Symbol of one quantity: the standard's symbol, its unit ("" for numbers), the clause, and plain words.

    `better` says which of two values is the better one, where that is known whatever the design.
    """

    symbol: str
    unit: str
    source: str
    words: str
    better: Better | None = None

    @property
    def parts(self) -> tuple[tuple[str, str], ...]:
        """The symbol in pieces, each a text and the index behind it: F_t K_A/b is ("F", "t"), (" K", "A"), ("/b", "")."""
        return parts_of(self.symbol)


@lru_cache(maxsize=2048)
def parts_of(text: str) -> tuple[tuple[str, str], ...]:
    """Return words with symbols in them in pieces, each a text and the index behind it."""
    pieces = [*_INDEX.split(text), ""]
    return tuple(each for each in zip(pieces[::2], pieces[1::2], strict=True) if any(each))


GEAR = {
    "profile_shift_khk": Symbol("x", "", "KHK", "profile shift in KHK's sign (rings)"),
    "transverse_module": Symbol("m_t", "mm", "4.2", "transverse module"),
    "transverse_pressure_angle": Symbol("α_t", "deg", "4.3", "transverse pressure angle"),
    "base_helix_angle": Symbol("β_b", "deg", "4.3", "base helix angle"),
    "lead": Symbol("p_z", "mm", "4.2", "lead"),
    "tool_file": Symbol("", "", "", "table of the tool"),
    "cutter_tip_diameter": Symbol("d_a0", "mm", "", "cutter, tip diameter for this root"),
    "virtual_teeth": Symbol("z_n", "", "4.7", "virtual number of teeth"),
    "reference_diameter": Symbol("d", "mm", "4.2", "reference diameter"),
    "base_diameter": Symbol("d_b", "mm", "4.3", "base diameter"),
    "tip_form_diameter": Symbol("d_Fa", "mm", "7.6", "tip form diameter"),
    "form_diameter": Symbol("d_Ff", "mm", "7.6", "root form diameter"),
    "undercut": Symbol("", "", "7.7", "undercut"),
    "normal_tooth_thickness": Symbol("s_n", "mm", "4.7", "normal tooth thickness"),
    "transverse_tooth_thickness": Symbol("s_t", "mm", "4.7", "transverse tooth thickness"),
    "tip_thickness": Symbol("s_an", "mm", "7.9", "normal tip thickness"),
    "transverse_pitch": Symbol("p_t", "mm", "4.4", "transverse pitch"),
    "transverse_base_pitch": Symbol("p_bt", "mm", "4.4", "transverse base pitch"),
    "span_teeth": Symbol("k", "", "Annex A", "teeth spanned"),
    "span_spaces": Symbol("k", "", "Annex A", "spaces spanned (spur rings)"),
    "span_measurement": Symbol("W_k", "mm", "Annex A", "span measurement"),
    "span_contact_diameter": Symbol("d_yk", "mm", "Annex A", "span touches at diameter"),
    "ball_diameter": Symbol("D_M", "mm", "Annex A", "ball or pin diameter"),
    "over_balls": Symbol("M_dK", "mm", "Annex A", "over two balls"),
    "over_pins": Symbol("M_dR", "mm", "Annex A", "over two pins"),
    "between_balls": Symbol("M_dK", "mm", "Annex A", "between two balls (rings)"),
    "between_pins": Symbol("M_dR", "mm", "Annex A", "between two pins (spur rings)"),
    "pin_axial_shift": Symbol("", "mm", "", "pins apart along the axis"),
    "thickness_limits.allowance_upper": Symbol("A_sne", "µm", "DIN 3967", "upper allowance of tooth thickness"),
    "thickness_limits.allowance_lower": Symbol("A_sni", "µm", "DIN 3967", "lower allowance of tooth thickness"),
    "thickness_limits.normal_tooth_thickness_greatest": Symbol("s_n", "mm", "", "normal tooth thickness, greatest"),
    "thickness_limits.normal_tooth_thickness_least": Symbol("s_n", "mm", "", "normal tooth thickness, least"),
    "thickness_limits.span_measurement_greatest": Symbol("W_k", "mm", "", "span measurement, greatest"),
    "thickness_limits.span_measurement_least": Symbol("W_k", "mm", "", "span measurement, least"),
    "thickness_limits.over_balls_greatest": Symbol("M_dK", "mm", "", "over two balls, greatest"),
    "thickness_limits.over_balls_least": Symbol("M_dK", "mm", "", "over two balls, least"),
    "thickness_limits.over_pins_greatest": Symbol("M_dR", "mm", "", "over two pins, greatest"),
    "thickness_limits.over_pins_least": Symbol("M_dR", "mm", "", "over two pins, least"),
    "thickness_limits.between_balls_greatest": Symbol("M_dK", "mm", "", "between two balls, greatest"),
    "thickness_limits.between_balls_least": Symbol("M_dK", "mm", "", "between two balls, least"),
    "thickness_limits.between_pins_greatest": Symbol("M_dR", "mm", "", "between two pins, greatest"),
    "thickness_limits.between_pins_least": Symbol("M_dR", "mm", "", "between two pins, least"),
    "premachining.residual_undercut": Symbol("s_pr", "mm", "ISO 6336-3", "residual undercut, p_rP0 - q"),
    "premachining.greatest_undercut": Symbol("", "mm", "", "undercut below the flank, greatest"),
    "premachining.root_diameter": Symbol("d_f", "mm", "4.5", "root diameter, as cut"),
    "premachining.root_form_diameter": Symbol("d_Ff", "mm", "7.6", "root form diameter, wheel free"),
    "premachining.precut.normal_tooth_thickness": Symbol("s_n", "mm", "4.7", "before finishing, thickness"),
    "premachining.precut.span_teeth": Symbol("k", "", "Annex A", "before finishing, teeth spanned"),
    "premachining.precut.span_measurement": Symbol("W_k", "mm", "Annex A", "before finishing, span"),
    "premachining.precut.ball_diameter": Symbol("D_M", "mm", "Annex A", "before finishing, ball or pin"),
    "premachining.precut.over_balls": Symbol("M_dK", "mm", "Annex A", "before finishing, over balls"),
    "premachining.precut.between_balls": Symbol("M_dK", "mm", "Annex A", "before finishing, between balls"),
    "premachining.precut.tip_thickness": Symbol("s_an", "mm", "7.9", "before finishing, tip thickness"),
    "premachining.precut.tip_diameter": Symbol("d_a", "mm", "4.5", "before finishing, tip diameter"),
    "premachining.precut.form_diameter": Symbol("d_Ff", "mm", "7.6", "before finishing, root form diameter"),
    "premachining.least_stock.stock": Symbol("q", "mm", "", "least stock"),
    "premachining.least_stock.residual_undercut": Symbol("s_pr", "mm", "", "least stock, residual undercut"),
    "premachining.least_stock.root_form_diameter": Symbol("d_Ff", "mm", "", "least stock, root form diameter"),
    "premachining.most_stock.stock": Symbol("q", "mm", "", "greatest stock"),
    "premachining.most_stock.residual_undercut": Symbol("s_pr", "mm", "", "greatest stock, residual undercut"),
    "premachining.most_stock.root_form_diameter": Symbol("d_Ff", "mm", "", "greatest stock, root form diameter"),
    "making.nominal.tip_diameter": Symbol("d_a", "mm", "4.5", "nominal, tip diameter"),
    "making.nominal.root_diameter": Symbol("d_f", "mm", "4.5", "nominal, root diameter"),
    "making.nominal.form_diameter": Symbol("d_Ff", "mm", "7.6", "nominal, root form diameter"),
    "making.nominal.normal_tooth_thickness": Symbol("s_n", "mm", "4.7", "nominal, thickness"),
    "making.nominal.span_teeth": Symbol("k", "", "Annex A", "nominal, teeth spanned"),
    "making.nominal.span_measurement": Symbol("W_k", "mm", "Annex A", "nominal, span"),
    "making.nominal.ball_diameter": Symbol("D_M", "mm", "Annex A", "nominal, ball or pin"),
    "making.nominal.over_balls": Symbol("M_dK", "mm", "Annex A", "nominal, over balls"),
    "making.nominal.between_balls": Symbol("M_dK", "mm", "Annex A", "nominal, between balls"),
    "making.nominal.face_width": Symbol("b", "mm", "4.1", "nominal, face width"),
    "making.nominal.bore": Symbol("", "mm", "", "nominal, bore"),
    "making.as_made.tip_diameter": Symbol("d_a", "mm", "4.5", "as made, tip diameter"),
    "making.as_made.root_diameter": Symbol("d_f", "mm", "4.5", "as made, root diameter"),
    "making.as_made.form_diameter": Symbol("d_Ff", "mm", "7.6", "as made, root form diameter"),
    "making.as_made.normal_tooth_thickness": Symbol("s_n", "mm", "4.7", "as made, thickness"),
    "making.as_made.span_teeth": Symbol("k", "", "Annex A", "as made, teeth spanned"),
    "making.as_made.span_measurement": Symbol("W_k", "mm", "Annex A", "as made, span"),
    "making.as_made.ball_diameter": Symbol("D_M", "mm", "Annex A", "as made, ball or pin"),
    "making.as_made.over_balls": Symbol("M_dK", "mm", "Annex A", "as made, over balls"),
    "making.as_made.between_balls": Symbol("M_dK", "mm", "Annex A", "as made, between balls"),
    "making.as_made.face_width": Symbol("b", "mm", "4.1", "as made, face width"),
    "making.as_made.bore": Symbol("", "mm", "", "as made, bore"),
    "making.cavity.ball_diameter": Symbol("D_M", "mm", "", "cavity, ball or pin"),
    "making.cavity.between_balls": Symbol("", "mm", "", "cavity, between balls"),
    "making.cavity.over_balls": Symbol("", "mm", "", "cavity, over balls (rings)"),
    "making.path_offset": Symbol("", "mm", "", "path, distance from the part"),
    "modification.tip_relief_transition_source": Symbol("", "", "", "tip relief, transition from"),
    "modification.tip_relief_rounding": Symbol("w", "µm", "", "tip relief, rounding at its start"),
    "modification.root_relief_transition_source": Symbol("", "", "", "root relief, transition from"),
    "modification.root_relief_rounding": Symbol("w", "µm", "", "root relief, rounding at its start"),
}

PAIR = {
    "common_width.width": Symbol("b_w", "mm", "5.2", "common face width"),
    "common_width.offset": Symbol("", "mm", "", "middle of b_w from the pinion's"),
    "gear_ratio": Symbol("u", "", "5.1", "gear ratio"),
    "reference_centre_distance": Symbol("a_d", "mm", "5.2", "reference centre distance"),
    "profile_shift_sum": Symbol("Σx", "", "5.3", "sum of the profile shifts"),
    "zero_backlash_shift_sum": Symbol("Σx_0", "", "5.3", "shift sum without backlash"),
    "working_transverse_pressure_angle": Symbol("α_wt", "deg", "5.2", "working transverse pressure angle"),
    "working_pitch_diameters": Symbol("d_w", "mm", "5.2", "working pitch diameter"),
    "tip_alteration": Symbol("k", "", "5.2", "tip alteration that keeps clearance"),
    "transverse_contact_ratio": Symbol("ε_α", "", "5.4", "transverse contact ratio"),
    "usable_contact_ratio": Symbol("", "", "", "contact ratio above the form circles"),
    "axial_force_ratio": Symbol("F_a/F_t", "", "", "axial force over tangential force"),
    "overlap_ratio": Symbol("ε_β", "", "5.4", "overlap ratio"),
    "total_contact_ratio": Symbol("ε_γ", "", "5.4", "total contact ratio"),
    "tip_clearances": Symbol("c", "mm", "5.2", "tip clearance in the mate's root"),
    "circumferential_backlash": Symbol("j_wt", "mm", "5.5", "circumferential backlash"),
    "normal_backlash": Symbol("j_bn", "mm", "5.5", "normal backlash"),
    "backlash_limits.centre_distance_allowance": Symbol("A_a", "µm", "DIN 3964", "allowance of the centre distance, ±"),
    "backlash_limits.circumferential_least": Symbol("j_wt", "mm", "5.5", "circumferential backlash, least"),
    "backlash_limits.circumferential_greatest": Symbol("j_wt", "mm", "5.5", "circumferential backlash, greatest"),
    "backlash_limits.normal_least": Symbol("j_bn", "mm", "5.5", "normal backlash, least"),
    "backlash_limits.normal_greatest": Symbol("j_bn", "mm", "5.5", "normal backlash, greatest"),
    "active_root_diameters": Symbol("d_Nf", "mm", "5.4", "active root diameter"),
    "path_of_contact.A": Symbol("T1A", "mm", "5.4", "first contact, from T1"),
    "path_of_contact.B": Symbol("T1B", "mm", "5.4", "single contact begins"),
    "path_of_contact.C": Symbol("T1C", "mm", "5.4", "pitch point"),
    "path_of_contact.D": Symbol("T1D", "mm", "5.4", "single contact ends"),
    "path_of_contact.E": Symbol("T1E", "mm", "5.4", "last contact"),
    "specific_sliding.pinion_A": Symbol("ζ_A1", "", "5.4", "specific sliding at A, pinion"),
    "specific_sliding.wheel_A": Symbol("ζ_A2", "", "5.4", "specific sliding at A, wheel"),
    "specific_sliding.pinion_E": Symbol("ζ_E1", "", "5.4", "specific sliding at E, pinion"),
    "specific_sliding.wheel_E": Symbol("ζ_E2", "", "5.4", "specific sliding at E, wheel"),
    "specific_sliding.greatest": Symbol("ζ", "", "5.4", "specific sliding, greatest", Better.LOWER),
    "contact_line_lengths.minimum": Symbol("", "mm", "5.4", "contact lines, least total length"),
    "contact_line_lengths.mean": Symbol("", "mm", "5.4", "contact lines, mean total length"),
    "contact_line_lengths.maximum": Symbol("", "mm", "5.4", "contact lines, greatest total length"),
    "interference_margins.involute": Symbol("", "mm", "", "ring's tip to the base tangent point"),
    "interference_margins.pinion_fillet": Symbol("", "mm", "", "ring's tip to the pinion's fillet"),
    "interference_margins.wheel_fillet": Symbol("", "mm", "", "pinion's tip to the ring's fillet"),
    "interference_margins.trochoid": Symbol("", "mm", "", "tips beside the mesh (trochoid)"),
    "interference_margins.radial": Symbol("", "mm", "", "tips when put in radially"),
}

COURSES: dict[str, Symbol] = {
    "specific_sliding_path.distance": Symbol("T1Y", "mm", "5.4", "places along the path of contact, from T1"),
    "specific_sliding_path.pinion": Symbol("ζ_1", "", "5.4", "specific sliding along the path, pinion"),
    "specific_sliding_path.wheel": Symbol("ζ_2", "", "5.4", "specific sliding along the path, wheel"),
}
"""Lists along the path of contact in the document of a pair."""

MASS = Symbol("m", "kg", "", "mass of the solid", Better.LOWER)
"""Symbol of the mass of a gear, which follows from its solid and its material."""

RACK = {
    "transverse_module": GEAR["transverse_module"],
    "transverse_pressure_angle": GEAR["transverse_pressure_angle"],
    "base_helix_angle": GEAR["base_helix_angle"],
    "normal_pitch": Symbol("p_n", "mm", "4.4", "normal pitch"),
    "transverse_pitch": Symbol("p_t", "mm", "4.4", "transverse pitch, along the rack"),
    "transverse_base_pitch": GEAR["transverse_base_pitch"],
    "tip_height": Symbol("h_a", "mm", "4.5", "tip above the reference line"),
    "tip_form_height": Symbol("h_Fa", "mm", "", "end of the flank above that line"),
    "form_depth": Symbol("h_Ff", "mm", "", "begin of the flank below that line"),
    "root_depth": Symbol("h_f", "mm", "4.5", "root below the reference line"),
    "total_height": Symbol("", "mm", "", "total height"),
    "normal_tooth_thickness": GEAR["normal_tooth_thickness"],
    "transverse_tooth_thickness": GEAR["transverse_tooth_thickness"],
    "tip_thickness": GEAR["tip_thickness"],
    "pin_diameter": Symbol("D_M", "mm", "Annex A", "ball or pin diameter"),
    "over_pin": Symbol("M", "mm", "", "over a pin, from the back"),
    "premachining.residual_undercut": GEAR["premachining.residual_undercut"],
    "premachining.greatest_undercut": GEAR["premachining.greatest_undercut"],
    "premachining.root_depth": Symbol("h_f", "mm", "4.5", "root depth, as cut"),
    "premachining.root_form_depth": Symbol("h_Ff", "mm", "", "begin of the flank, wheel free"),
    "premachining.precut.normal_tooth_thickness": GEAR["premachining.precut.normal_tooth_thickness"],
    "premachining.precut.pin_diameter": GEAR["premachining.precut.ball_diameter"],
    "premachining.precut.over_pin": Symbol("M", "mm", "", "before finishing, over a pin"),
    "premachining.precut.tip_thickness": GEAR["premachining.precut.tip_thickness"],
    "premachining.precut.tip_height": Symbol("h_a", "mm", "4.5", "before finishing, tip height"),
    "premachining.precut.form_depth": Symbol("h_Ff", "mm", "", "before finishing, begin of the flank"),
    "premachining.least_stock.stock": GEAR["premachining.least_stock.stock"],
    "premachining.least_stock.residual_undercut": GEAR["premachining.least_stock.residual_undercut"],
    "premachining.least_stock.root_form_depth": Symbol("h_Ff", "mm", "", "least stock, begin of the flank"),
    "premachining.most_stock.stock": GEAR["premachining.most_stock.stock"],
    "premachining.most_stock.residual_undercut": GEAR["premachining.most_stock.residual_undercut"],
    "premachining.most_stock.root_form_depth": Symbol("h_Ff", "mm", "", "greatest stock, begin of the flank"),
}

RACK_PAIR = {
    "back_distance": Symbol("", "mm", "", "axis to the rack's back"),
    "shifted_distance": Symbol("", "mm", "", "mounting distance r + x m_n"),
    "zero_backlash_distance": Symbol("", "mm", "", "mounting distance without backlash"),
    "pitch_line_height": Symbol("", "mm", "", "pitch line above the reference line"),
    "travel_per_revolution": Symbol("", "mm", "", "travel per turn of the pinion"),
    "travel_per_degree": Symbol("", "mm", "", "travel per degree of the pinion"),
    "tip_clearances.rack": Symbol("c", "mm", "5.2", "tip clearance of the rack"),
    "active_root_diameter": Symbol("d_Nf", "mm", "5.4", "active root diameter of the pinion"),
    "active_root_depth": Symbol("h_Nf", "mm", "", "active flank of the rack ends below"),
}
"""Symbols of a pinion and a rack, beside those that they have in common with PAIR."""

SPLINE = {
    "fit": Symbol("", "", "", "tolerance class"),
    "root": Symbol("", "", "", "root"),
    "edition": Symbol("", "", "", "edition of the standard"),
    "designation": Symbol("", "", "", "designation"),
    "standard": Symbol("", "", "", "standard of the spline"),
    "nominal_diameter": Symbol("d_B", "mm", "DIN 5480-1", "nominal diameter"),
    "centring": Symbol("", "", "", "centring"),
    "module": Symbol("m", "mm", "", "module"),
    "diametral_pitch": Symbol("P", "1/inch", "", "diametral pitch"),
    "pressure_angle": Symbol("α", "deg", "", "pressure angle"),
    "teeth": Symbol("z", "", "", "number of teeth"),
    "profile_shift": Symbol("x", "", "", "profile shift (sign of the shaft)"),
    "length": Symbol("b", "mm", "", "length of the engagement"),
    "reference_diameter": GEAR["reference_diameter"]._replace(source=""),
    "base_diameter": GEAR["base_diameter"]._replace(source=""),
    "tip_diameter": Symbol("d_a", "mm", "", "tip diameter"),
    "root_diameter": Symbol("d_f", "mm", "", "root diameter"),
    "root_radius": Symbol("ρ_f", "mm", "", "root fillet radius (of the tool)"),
    "form_diameter": Symbol("d_Ff", "mm", "", "root form diameter"),
    "form_diameter_max": Symbol("d_Ff", "mm", "", "root form diameter, at most"),
    "form_diameter_min": Symbol("d_Ff", "mm", "", "root form diameter, at least"),
    "form_clearance": Symbol("c_F", "mm", "", "form clearance"),
    "tooth_thickness": Symbol("s", "mm", "", "basic tooth thickness"),
    "tooth_thickness_effective_max": Symbol("s_v", "mm", "", "effective tooth thickness, greatest"),
    "tooth_thickness_effective_min": Symbol("s_v", "mm", "", "effective tooth thickness, least"),
    "tooth_thickness_actual_max": Symbol("s", "mm", "", "actual tooth thickness, greatest"),
    "tooth_thickness_actual_min": Symbol("s", "mm", "", "actual tooth thickness, least"),
    "tooth_thickness_built": Symbol("s", "mm", "", "tooth thickness of the solid"),
    "space_width": Symbol("e", "mm", "", "basic space width"),
    "space_width_effective_max": Symbol("e_v", "mm", "", "effective space width, greatest"),
    "space_width_effective_min": Symbol("e_v", "mm", "", "effective space width, least"),
    "space_width_actual_max": Symbol("e", "mm", "", "actual space width, greatest"),
    "space_width_actual_min": Symbol("e", "mm", "", "actual space width, least"),
    "space_width_built": Symbol("e", "mm", "", "space width of the solid"),
    "deviation": Symbol("A", "µm", "", "deviation of the effective size"),
    "tolerance_actual": Symbol("T_act", "µm", "", "tolerance of the actual size"),
    "tolerance_effective": Symbol("T_eff", "µm", "", "tolerance of form and pitch"),
    "pin_diameter": Symbol("D_M", "mm", "", "pin diameter"),
    "over_pins": Symbol("M_1", "mm", "", "over two pins"),
    "over_pins_max": Symbol("M_1", "mm", "", "over two pins, greatest"),
    "over_pins_min": Symbol("M_1", "mm", "", "over two pins, least"),
    "between_pins": Symbol("M_2", "mm", "", "between two pins"),
    "between_pins_max": Symbol("M_2", "mm", "", "between two pins, greatest"),
    "between_pins_min": Symbol("M_2", "mm", "", "between two pins, least"),
    "pin_factor": Symbol("A_M", "", "", "factor of change dM/ds"),
    "span_teeth": Symbol("k", "", "", "number of teeth or spaces spanned"),
    "span_measurement": Symbol("W_k", "mm", "", "span measurement"),
    "span_measurement_max": Symbol("W_k", "mm", "", "span measurement, greatest"),
    "span_measurement_min": Symbol("W_k", "mm", "", "span measurement, least"),
    "bore": Symbol("", "mm", "", "bore of the shaft"),
    "outer_diameter": Symbol("", "mm", "", "outer diameter of the hub"),
    "effective_play_min": Symbol("c_v", "mm", "", "effective play, least"),
    "effective_play_max": Symbol("c_v", "mm", "", "effective play, greatest"),
    "actual_play_min": Symbol("c", "mm", "", "actual play, least"),
    "actual_play_max": Symbol("c", "mm", "", "actual play, greatest"),
    "backlash_angle": Symbol("", "deg", "", "backlash angle at mean tolerances"),
}
"""Symbols of splines, by their keys under "shaft", "hub" and "joint"."""

SHAFTS = {
    "L10h": Symbol("L_10h", "h", "ISO 281", "least basic life of the bearings", Better.HIGHER),
    "Lnmh": Symbol("L_nmh", "h", "ISO 281", "least modified life of the bearings", Better.HIGHER),
    "deflection": Symbol("", "µm", "", "greatest deflection of the shafts", Better.LOWER),
    "equivalent_stress": Symbol("σ_v", "MPa", "", "greatest nominal stress of the shafts", Better.LOWER),
    "S_D": Symbol("S_D", "", "DIN 743", "least safety of shoulders against fatigue", Better.HIGHER),
    "S_F": Symbol("S_F", "", "DIN 743", "least safety of shoulders against yield", Better.HIGHER),
    "critical_speed": Symbol("n_1", "rpm", "", "lowest critical speed of bending", Better.HIGHER),
    "f_sh": Symbol("f_sh", "µm", "ISO 6336-1", "deformation of the shafts over the face"),
    "K_Hbeta": Symbol("K_Hβ", "", "ISO 6336-1", "face load factor on the shafts", Better.LOWER),
}
"""Symbols of the figures of `shafts`, one line a design."""

SHAFT = {
    "mesh_position": Symbol("", "mm", "", "middle of the face on the shaft"),
    "length": Symbol("", "mm", "", "length of the shaft"),
    "mass": Symbol("m", "kg", "", "mass"),
    "centre_of_mass": Symbol("", "mm", "", "centre of mass from the left end"),
    "polar_inertia": Symbol("J", "kg·m²", "", "moment of inertia about the axis"),
    "transverse_inertia": Symbol("J_t", "kg·m²", "", "moment of inertia across the axis"),
    "torsional_stiffness": Symbol("", "N·m/rad", "", "torsional stiffness, end to end"),
}
"""Symbols of the sizes of a shaft."""

SHAFT_SEGMENT = {
    "position": Symbol("z", "mm", "", "begins at"),
    "length": Symbol("l", "mm", "", "length of the segment"),
    "outer_diameter": Symbol("d", "mm", "", "outer diameter"),
    "inner_diameter": Symbol("d_i", "mm", "", "inner diameter"),
    "area": Symbol("A", "mm²", "", "area of the section"),
    "second_moment": Symbol("I", "mm⁴", "", "second moment of area"),
    "section_modulus": Symbol("W_b", "mm³", "", "section modulus of bending"),
    "mass": Symbol("m", "kg", "", "mass of the segment"),
}
"""Symbols of a segment of a shaft."""

DRIVE = {
    "rack_force": Symbol("F", "N", "", "force along the rack, without losses"),
    "rack_speed": Symbol("v", "m/s", "", "speed of the rack"),
}
"""Symbols of a load on a rack."""

PLANETARY = {
    "set_type": Symbol("", "", "", "type of the set, A to D"),
    "basic_ratio": Symbol("i_0", "", "", "basic ratio, carrier at rest"),
    "positions": Symbol("q", "", "", "places where planets fit"),
    "free_tip_distance": Symbol("", "mm", "", "distance between planets' tips"),
    "ratio": Symbol("i", "", "", "ratio, speed of input over output"),
    "efficiency": Symbol("η", "", "", "efficiency from input to output", Better.HIGHER),
    "efficiency_back": Symbol("η", "", "", "efficiency from output to input"),
    "planet_speed_relative": Symbol("", "rpm", "", "speed of a planet on its pin"),
    "mesh_load_factor": Symbol("K_γ", "", "ISO 6336-1", "greatest share of a planet, 1 where all carry alike", Better.LOWER),
    "torsional_stiffness": Symbol("", "N·m/rad", "", "torsional stiffness at the output"),
    "frequency_1": Symbol("f_1", "Hz", "", "first natural frequency"),
    "frequency_2": Symbol("f_2", "Hz", "", "second natural frequency"),
    "frequency_3": Symbol("f_3", "Hz", "", "third natural frequency"),
}
"""Symbols of a planetary train in data.json and planetary.json beside its inputs, as tables of results have it."""

PLANETARY_MEMBER = {
    "meshes": Symbol("", "", "", "rim that it meshes with"),
    "speed": Symbol("n", "rpm", "", "speed"),
    "torque": Symbol("T", "N·m", "", "torque from outside"),
}
"""Symbols of each member and shaft, likewise."""

PER_GEAR = ("working_pitch_diameters", "active_root_diameters", "tip_clearances")
"""Keys of PAIR that pinion and wheel each have."""

_CONTACT_FACTORS = {
    "Z_H": Symbol("Z_H", "", "ISO 6336-2, 6.1", "zone factor"),
    "Z_E": Symbol("Z_E", "√MPa", "ISO 6336-2, 7", "elasticity factor"),
    "Z_eps": Symbol("Z_ε", "", "ISO 6336-2, 8", "contact ratio factor"),
    "Z_beta": Symbol("Z_β", "", "ISO 6336-2, 9", "helix angle factor of the contact stress"),
    "Z_B": Symbol("Z_B", "", "ISO 6336-2, 6.2", "single contact factor of the pinion"),
    "Z_D": Symbol("Z_D", "", "ISO 6336-2, 6.2", "single contact factor of the wheel"),
}

RATING = {
    "edition": Symbol("", "", "", "standard"),
    "F_t": Symbol("F_t", "N", "ISO 6336-1", "tangential force at the reference circle"),
    "F_bn": Symbol("F_bn", "N", "ISO 6336-1", "normal force in the base tangent plane"),
    "K_A": Symbol("K_A", "", "ISO 6336-1", "application factor"),
    "w_t": Symbol("F_t K_A/b", "N/mm", "ISO 6336-1, 9", "specific load"),
    "q_prime": Symbol("q'", "mm·µm/N", "ISO 6336-1 (82)", "least flexibility of a pair of teeth"),
    "c_th": Symbol("c'_th", "N/(mm·µm)", "ISO 6336-1 (81)", "theoretical single stiffness"),
    "C_M": Symbol("C_M", "", "ISO 6336-1 (83)", "correction factor of the stiffness"),
    "C_R": Symbol("C_R", "", "ISO 6336-1 (84)", "gear blank factor"),
    "C_B": Symbol("C_B", "", "ISO 6336-1 (86)", "basic rack factor"),
    "xi": Symbol("E/E_St", "", "ISO 6336-1 (88)", "material factor of the stiffness"),
    "c_prime": Symbol("c'", "N/(mm·µm)", "ISO 6336-1 (80)", "single stiffness from 100 N/mm on"),
    "c_gamma_alpha": Symbol("c_γα", "N/(mm·µm)", "ISO 6336-1 (91)", "mesh stiffness from 100 N/mm on"),
    "c_gamma_beta": Symbol("c_γβ", "N/(mm·µm)", "ISO 6336-1 (92)", "mesh stiffness for K_Hβ from 100 N/mm on"),
    "low_load_factor": Symbol("", "", "ISO 6336-1 (90)", "factor of a low load on the stiffness"),
    "c_prime_lowload": Symbol("c'", "N/(mm·µm)", "ISO 6336-1 (90)", "single stiffness at this load"),
    "c_gamma_alpha_lowload": Symbol("c_γα", "N/(mm·µm)", "ISO 6336-1 (91)", "mesh stiffness at this load"),
    "c_gamma_beta_lowload": Symbol("c_γβ", "N/(mm·µm)", "ISO 6336-1 (92)", "mesh stiffness for K_Hβ at this load"),
    **_CONTACT_FACTORS,
    "sigma_H0": Symbol("σ_H0", "MPa", "ISO 6336-2, 5", "nominal contact stress"),
    "rho_C": Symbol("ρ_C", "mm", "Hertz", "reduced radius of curvature at the pitch point"),
    "p_0": Symbol("p_0", "MPa", "Hertz", "peak pressure at the pitch point"),
    "b_H": Symbol("b_H", "mm", "Hertz", "half width of contact at the pitch point"),
}

_ROOT_FACTORS = {
    "Y_F": Symbol("Y_F", "", "ISO 6336-3 (9)", "form factor"),
    "Y_S": Symbol("Y_S", "", "ISO 6336-3 (36)", "stress correction factor"),
    "Y_beta": Symbol("Y_β", "", "ISO 6336-3, 8", "helix angle factor of the root stress"),
    "Y_B": Symbol("Y_B", "", "ISO 6336-3, 9", "rim thickness factor"),
    "Y_DT": Symbol("Y_DT", "", "ISO 6336-3, 10", "deep tooth factor"),
}

GEAR_RATING = {
    "theta": Symbol("θ", "deg", "ISO 6336-3 (14)", "angle of the 30° tangent (60° on a ring) on the tool's tip"),
    "s_Fn": Symbol("s_Fn", "mm", "ISO 6336-3 (15)", "chord of the root section"),
    "rho_F": Symbol("ρ_F", "mm", "ISO 6336-3 (17)", "radius of the fillet at the root section"),
    "h_Fe": Symbol("h_Fe", "mm", "ISO 6336-3 (18)", "arm of the load at the root section"),
    "q_s": Symbol("q_s", "", "ISO 6336-3 (38)", "notch parameter"),
    "d_en": Symbol("d_en", "mm", "ISO 6336-3 (28)", "diameter of the load on the virtual gear"),
    "alpha_Fen": Symbol("α_Fen", "deg", "ISO 6336-3 (31)", "angle of the load"),
    **_ROOT_FACTORS,
    "b": Symbol("b", "mm", "ISO 6336-3, 5", "width that carries at the root"),
    "sigma_F0": Symbol("σ_F0", "MPa", "ISO 6336-3, 5", "nominal root stress"),
    "sigma_H": Symbol("σ_H", "MPa", "ISO 6336-2, 5", "contact stress with K_A", Better.LOWER),
    "sigma_F": Symbol("σ_F", "MPa", "ISO 6336-3, 5", "root stress with K_A", Better.LOWER),
}

_OF_FLANKS = {
    "f_pt": ("f_pt", "1", "single pitch deviation"),
    "F_pk": ("F_pk", "1", "sector pitch deviation, over z/8 pitches"),
    "F_p": ("F_p", "1", "cumulative pitch deviation"),
    "f_Halpha": ("f_Hα", "1", "profile slope deviation"),
    "f_falpha": ("f_fα", "1", "profile form deviation"),
    "F_alpha": ("F_α", "1", "profile deviation"),
    "f_Hbeta": ("f_Hβ", "1", "helix slope deviation"),
    "f_fbeta": ("f_fβ", "1", "helix form deviation"),
    "F_beta": ("F_β", "1", "helix deviation"),
    "F_r": ("F_r", "2", "runout"),
}
_COMPOSITE = {
    "F_i2": ("F_i″", "2", "radial composite deviation"),
    "f_i2": ("f_i″", "2", "radial tooth-to-tooth deviation"),
    "f_i1": ("f_i′", "1", "tooth-to-tooth deviation, single flank"),
    "F_i1": ("F_i′", "1", "composite deviation, single flank"),
}

TOLERANCES = {
    **{
        key: Symbol(symbol, "µm", f"ISO 1328-{part}", words) for key, (symbol, part, words) in (_OF_FLANKS | _COMPOSITE).items()
    },
    **{
        "f_pT" if key == "f_pt" else f"{key}T": Symbol(f"{symbol.removesuffix('t')}T", "µm", "ISO 1328-1:2013", words)
        for key, (symbol, _, words) in _OF_FLANKS.items()
    },
}
"""Symbols of flank tolerances, by the editions of 1995 and of 2013."""

_LOAD_FACTORS = {
    "K_v": Symbol("K_v", "", "ISO 6336-1, 6", "dynamic factor", Better.LOWER),
    "K_Hbeta": Symbol("K_Hβ", "", "ISO 6336-1, 7", "face load factor of contact", Better.LOWER),
    "K_Fbeta": Symbol("K_Fβ", "", "ISO 6336-1, 7", "face load factor of the root", Better.LOWER),
    "K_Halpha": Symbol("K_Hα", "", "ISO 6336-1, 8", "transverse load factor of contact", Better.LOWER),
    "K_Falpha": Symbol("K_Fα", "", "ISO 6336-1, 8", "transverse load factor of the root", Better.LOWER),
}

STRENGTH_FACTORS = {
    "K_A": RATING["K_A"],
    "K_gamma": Symbol("K_γ", "", "ISO 6336-1, 4", "mesh load factor"),
    **_LOAD_FACTORS,
    **_CONTACT_FACTORS,
    "Z_NT": Symbol("Z_NT", "", "ISO 6336-2, 11", "life factor of contact"),
    "Z_L": Symbol("Z_L", "", "ISO 6336-2, 12", "lubricant factor"),
    "Z_v": Symbol("Z_v", "", "ISO 6336-2, 12", "velocity factor"),
    "Z_R": Symbol("Z_R", "", "ISO 6336-2, 12", "roughness factor of the flanks"),
    "Z_W": Symbol("Z_W", "", "ISO 6336-2, 13", "work hardening factor"),
    "Z_X": Symbol("Z_X", "", "ISO 6336-2, 14", "size factor of contact"),
    **_ROOT_FACTORS,
    "Y_ST": Symbol("Y_ST", "", "ISO 6336-3, 5", "stress correction factor of the test gears"),
    "Y_NT": Symbol("Y_NT", "", "ISO 6336-3, 12", "life factor of the root"),
    "Y_delta_relT": Symbol("Y_δrelT", "", "ISO 6336-3, 13", "relative notch sensitivity factor"),
    "Y_RrelT": Symbol("Y_RrelT", "", "ISO 6336-3, 14", "relative surface factor of the root"),
    "Y_X": Symbol("Y_X", "", "ISO 6336-3, 15", "size factor of the root"),
    "Y_M": Symbol("Y_M", "", "ISO 6336-3, B", "mean stress influence factor"),
}
"""Symbols of the factors of a full rating, of the load, the stresses and the permissible stresses."""

STRENGTH = {
    **STRENGTH_FACTORS,
    "sigma_Hlim": Symbol("σ_Hlim", "MPa", "ISO 6336-5", "endurance limit of contact stress"),
    "sigma_Flim": Symbol("σ_Flim", "MPa", "ISO 6336-5", "endurance limit of root stress"),
    "sigma_H0": RATING["sigma_H0"],
    "sigma_H": Symbol("σ_H", "MPa", "ISO 6336-2, 5", "contact stress with all load factors", Better.LOWER),
    "sigma_HG": Symbol("σ_HG", "MPa", "ISO 6336-2, 5", "pitting stress limit"),
    "sigma_HP": Symbol("σ_HP", "MPa", "ISO 6336-2, 5", "permissible contact stress"),
    "sigma_F0": GEAR_RATING["sigma_F0"],
    "sigma_F": Symbol("σ_F", "MPa", "ISO 6336-3, 5", "root stress with all load factors", Better.LOWER),
    "sigma_FG": Symbol("σ_FG", "MPa", "ISO 6336-3, 5", "root stress limit"),
    "sigma_FP": Symbol("σ_FP", "MPa", "ISO 6336-3, 5", "permissible root stress"),
    "S_H": Symbol("S_H", "", "ISO 6336-2, 5", "safety of the flank against pitting", Better.HIGHER),
    "S_F": Symbol("S_F", "", "ISO 6336-3, 5", "safety of the root against breakage", Better.HIGHER),
    "S_int": Symbol("S_int", "", "ISO/TR 13989-2", "safety against scuffing, integral temperature", Better.HIGHER),
    "S_B": Symbol("S_B", "", "ISO/TR 13989-1", "safety against scuffing, flash temperature", Better.HIGHER),
    "N_L": Symbol("N_L", "", "ISO 6336-2, 11", "load cycles of a tooth"),
}
"""Symbols of a full rating: symbols, clauses and words of its factors, stresses and safeties."""

PLASTIC = {
    "P": Symbol("P", "W", "VDI 2736-2", "rolling power"),
    "v_t": Symbol("v_t", "m/s", "VDI 2736-2", "velocity of the working pitch circles"),
    "mu": Symbol("μ", "", "VDI 2736-2", "coefficient of friction"),
    "H_V": Symbol("H_V", "", "VDI 2736-2", "degree of tooth loss"),
    "eps_1": Symbol("ε_1", "", "VDI 2736-2", "contact ratio of the pinion's addendum"),
    "eps_2": Symbol("ε_2", "", "VDI 2736-2", "contact ratio of the wheel's addendum"),
    "temperature.flank": Symbol("θ_Fla", "°C", "VDI 2736-2", "temperature of the flanks", Better.LOWER),
    "temperature.root": Symbol("θ_Fu", "°C", "VDI 2736-2", "temperature of the roots", Better.LOWER),
    "E": Symbol("E", "MPa", "VDI 2736-2", "Young's modulus at the temperature of the flanks"),
    "K_F": Symbol("K_F", "", "VDI 2736-2", "load factor of gears of plastic"),
    "sigma_HlimN": Symbol("σ_HlimN", "MPa", "VDI 2736-2", "flank strength at its temperature, after the load cycles"),
    "Y_Fa": Symbol("Y_Fa", "", "VDI 2736-2", "form factor with the load at the tip"),
    "Y_Sa": Symbol("Y_Sa", "", "VDI 2736-2", "stress correction factor with the load at the tip"),
    "Y_eps": Symbol("Y_ε", "", "VDI 2736-2", "contact ratio factor of the root"),
    "sigma_F": Symbol("σ_F", "MPa", "VDI 2736-2", "root stress with the load at the tip", Better.LOWER),
    "sigma_FlimN": Symbol("σ_FlimN", "MPa", "VDI 2736-2", "root strength at its temperature, after the load cycles"),
    "static": Symbol("σ_Fmax", "MPa", "VDI 2736-2", "static root stress", Better.LOWER),
    "static_permitted": Symbol("σ_FPmax", "MPa", "VDI 2736-2", "permissible static root stress"),
    "l_Fl": Symbol("l_Fl", "mm", "VDI 2736-2", "length of the flank that touches"),
    "k_w": Symbol("k_w", "mm³/(N·m)", "VDI 2736-2", "wear coefficient"),
    "wear": Symbol("W_m", "µm", "VDI 2736-2", "mean wear of the flanks", Better.LOWER),
    "wear_permitted": Symbol("W_zul", "µm", "VDI 2736-2", "permitted mean wear"),
    "deformation": Symbol("λ", "mm", "VDI 2736-2", "deformation of a pair of teeth", Better.LOWER),
    "deformation_permitted": Symbol("λ_zul", "mm", "VDI 2736-2", "permitted deformation"),
}
"""Symbols of the rating of gears of plastic, of what has one value and of what has one for each gear."""

STRENGTH_FIGURES = {
    "passed": Symbol("", "", "", "whether all required safeties are reached; empty where that was not judged or not asked for"),
    "strength": Symbol("", "", "", "verdict on strength"),
    "S_H": STRENGTH["S_H"],
    "S_F": STRENGTH["S_F"],
    "S_H_min": Symbol("S_H", "", "ISO 6336-2, 5", "lower safety of both flanks"),
    "S_F_min": Symbol("S_F", "", "ISO 6336-3, 5", "lower safety of both roots"),
    "S_int": STRENGTH["S_int"],
    "S_B": STRENGTH["S_B"],
    "permissible_torque": Symbol("T_1", "N·m", "ISO 6336-1", "torque on the pinion with the required safeties"),
    "life": Symbol("", "h", "ISO 6336-6", "life at the required safeties; empty without end"),
    "life_infinite": Symbol("", "", "ISO 6336-6", "whether that is without end"),
    **{key: symbol for key, symbol in STRENGTH_FACTORS.items() if key not in ("K_A", "K_gamma")},  # which are inputs
    **{key: STRENGTH[key] for key in ("sigma_H", "sigma_HG", "sigma_F", "sigma_FG")},
}
"""Symbols of a rating in a table of results."""

RING_FORMULA = {
    "rho_fPv": Symbol("ρ_fPv", "mm", "ISO 6336-3", "tip radius of the rack that stands for a ring's cutter, by formula"),
    "s_Fn": Symbol("s_Fn", "mm", "ISO 6336-3", "chord of the root section of a ring, by formula"),
    "rho_F": Symbol("ρ_F", "mm", "ISO 6336-3", "radius of the fillet of a ring at the root section, by formula"),
    "h_Fe": Symbol("h_Fe", "mm", "ISO 6336-3", "arm of the load at the root section of a ring, by formula"),
    "Y_F": Symbol("Y_F", "", "ISO 6336-3 (9)", "form factor of a ring, by formula"),
    "Y_S": Symbol("Y_S", "", "ISO 6336-3 (36)", "stress correction factor of a ring, by formula"),
    "sigma_F0": Symbol("σ_F0", "MPa", "ISO 6336-3, 5", "nominal root stress of a ring, by formula"),
}
"""Under "formula" of a ring's values: what the standard's formulas give beside the section of the generated fillet."""

SCUFFING = {
    "oil.type": Symbol("", "", "", "kind of oil"),
    "oil.nu_40": Symbol("ν_40", "mm²/s", "", "viscosity of the oil at 40 °C"),
    "oil.nu_100": Symbol("ν_100", "mm²/s", "", "viscosity of the oil at 100 °C"),
    "oil.rho_15": Symbol("ρ_15", "kg/m³", "", "density of the oil at 15 °C"),
    "oil.theta_oil": Symbol("θ_oil", "°C", "", "temperature of the oil"),
    "oil.nu_oil": Symbol("ν_θ", "mm²/s", "ASTM D341", "viscosity of the oil as it runs"),
    "oil.eta_oil": Symbol("η_θ", "mPa·s", "ASTM D341", "dynamic viscosity of the oil as it runs"),
    "oil.FZG": Symbol("FZG", "", "ISO 14635-1", "load stage of the oil, A/8.3/90"),
    "oil.T_1T": Symbol("T_1T", "N·m", "ISO 14635-1", "torque of the load stage"),
    "oil.X_W": Symbol("X_W", "", "ISO/TR 13989-2, table 3", "relative structure factor"),
    "integral.w_Bt": Symbol("w_Bt", "N/mm", "ISO/TR 13989-2 (4)", "specific load with its factors"),
    "integral.K_Bgamma": Symbol("K_Bγ", "", "ISO/TR 13989-2 (5)", "helical load factor"),
    "integral.v": Symbol("v", "m/s", "", "speed at the reference circle"),
    "integral.mu_mC": Symbol("μ_mC", "", "ISO/TR 13989-2 (1)", "mean coefficient of friction"),
    "integral.X_L": Symbol("X_L", "", "ISO/TR 13989-2, 5.1", "lubricant factor"),
    "integral.X_R": Symbol("X_R", "", "ISO/TR 13989-2 (7)", "roughness factor"),
    "integral.X_M": Symbol("X_M", "", "ISO/TR 13989-2 (11)", "thermal flash factor"),
    "integral.X_alphabeta": Symbol("X_αβ", "", "ISO/TR 13989-2 (13)", "pressure angle factor"),
    "integral.X_BE": Symbol("X_BE", "", "ISO/TR 13989-2 (22)", "geometry factor at the pinion's tip"),
    "integral.X_eps": Symbol("X_ε", "", "ISO/TR 13989-2 (39)", "contact ratio factor"),
    "integral.X_Q": Symbol("X_Q", "", "ISO/TR 13989-2 (25)", "approach factor"),
    "integral.X_Ca": Symbol("X_Ca", "", "ISO/TR 13989-2 (32)", "tip relief factor"),
    "integral.X_S": Symbol("X_S", "", "ISO/TR 13989-1 (22)", "lubrication factor"),
    "integral.X_mp": Symbol("X_mp", "", "ISO/TR 13989-1 (23)", "multiple mating factor"),
    "integral.theta_flaE": Symbol("θ_flaE", "K", "ISO/TR 13989-2 (19)", "flash temperature at the pinion's tip"),
    "integral.theta_flaint": Symbol("θ_flaint", "K", "ISO/TR 13989-2 (18)", "mean flash temperature"),
    "integral.theta_M": Symbol("θ_M", "°C", "ISO/TR 13989-2 (20)", "bulk temperature"),
    "integral.theta_int": Symbol("θ_int", "°C", "ISO/TR 13989-2 (17)", "integral temperature"),
    "integral.theta_intS": Symbol("θ_intS", "°C", "ISO/TR 13989-2 (94)", "scuffing integral temperature"),
    "integral.S_int": Symbol("S_intS", "", "ISO/TR 13989-2 (14)", "safety against scuffing, integral temperature"),
    "integral.S_SL": Symbol("S_SL", "", "ISO/TR 13989-2 (15)", "load safety against scuffing"),
    "integral.risk": Symbol("", "", "ISO/TR 13989-2, 6.1.1", "risk of scuffing, integral temperature"),
    "flash.w_Bt": Symbol("w_Bt", "N/mm", "ISO/TR 13989-1 (11)", "specific load with its factors"),
    "flash.v_t": Symbol("v_t", "m/s", "", "speed at the working pitch circle"),
    "flash.mu_m": Symbol("μ_m", "", "ISO/TR 13989-1 (25)", "mean coefficient of friction"),
    "flash.X_L": Symbol("X_L", "", "ISO/TR 13989-1 (27)", "lubricant factor"),
    "flash.X_R": Symbol("X_R", "", "ISO/TR 13989-1 (28)", "roughness factor"),
    "flash.X_M": Symbol("X_M", "", "ISO/TR 13989-1 (A.9)", "thermo-elastic factor"),
    "flash.X_J": Symbol("X_J", "", "ISO/TR 13989-1 (46)", "approach factor, at the hottest place"),
    "flash.X_Gamma": Symbol("X_Γ", "", "ISO/TR 13989-1, 9", "share of the load, at the hottest place"),
    "flash.Gamma": Symbol("Γ", "", "ISO/TR 13989-1 (30)", "hottest place on the line of action"),
    "flash.Gamma_A": Symbol("Γ_A", "", "ISO/TR 13989-1 (30)", "first contact"),
    "flash.Gamma_E": Symbol("Γ_E", "", "ISO/TR 13989-1 (33)", "last contact"),
    "flash.theta_flm": Symbol("Θ_flm", "K", "ISO/TR 13989-1 (24)", "mean flash temperature"),
    "flash.theta_flmax": Symbol("Θ_flmax", "K", "ISO/TR 13989-1 (A.5)", "greatest flash temperature"),
    "flash.theta_M": Symbol("Θ_M", "°C", "ISO/TR 13989-1 (22)", "bulk temperature"),
    "flash.theta_B": Symbol("Θ_B", "°C", "ISO/TR 13989-1 (2)", "greatest contact temperature"),
    "flash.theta_S": Symbol("Θ_S", "°C", "ISO/TR 13989-1 (99)", "scuffing temperature"),
    "flash.S_B": Symbol("S_B", "", "ISO/TR 13989-1 (100)", "safety against scuffing, flash temperature"),
    "flash.margin": Symbol("Θ_S - Θ_B", "K", "ISO/TR 13989-1, 10.5", "margin to the scuffing temperature"),
    "flash.risk": Symbol("", "", "ISO/TR 13989-1, 10.5", "risk of scuffing, flash temperature"),
    "risk": Symbol("", "", "", "risk of scuffing, the higher of both"),
}

LOAD_FACTOR_DETAILS = {
    "m_red": Symbol("m_red", "kg/mm", "ISO 6336-1 (30)", "reduced mass of both bodies per face width"),
    "n_E1": Symbol("n_E1", "rpm", "ISO 6336-1 (6)", "resonance speed"),
    "N": Symbol("N", "", "ISO 6336-1 (9)", "resonance ratio"),
    "N_S": Symbol("N_S", "", "ISO 6336-1 (11)", "resonance ratio where the main resonance begins"),
    "f_pb": Symbol("f_pb", "µm", "ISO 6336-1, 6.5", "base pitch deviation"),
    "f_falpha": Symbol("f_fα", "µm", "ISO 6336-1, 6.5", "profile form deviation"),
    "y_p": Symbol("y_p", "µm", "ISO 6336-1 (18)", "running in of the base pitch deviation"),
    "y_f": Symbol("y_f", "µm", "ISO 6336-1 (19)", "running in of the profile form deviation"),
    "C_a": Symbol("C_a", "µm", "ISO 6336-1, 6.5", "tip relief that counts in K_v"),
    "B_p": Symbol("B_p", "", "ISO 6336-1 (15)", "effect of the pitch deviation on K_v"),
    "B_f": Symbol("B_f", "", "ISO 6336-1 (16)", "effect of the profile deviation on K_v"),
    "B_k": Symbol("B_k", "", "ISO 6336-1 (17)", "effect of the tip relief on K_v"),
    "v_z1_100": Symbol("v z_1/100 √(u²/(1+u²))", "m/s", "ISO 6336-1, 6.6", "speed that K_v of Method C goes by"),
    "F_m_b": Symbol("F_m/b", "N/mm", "ISO 6336-1, 7", "specific load with K_A, K_γ and K_v"),
    "f_sh": Symbol("f_sh", "µm", "ISO 6336-1 (57)", "misalignment by the deflection of shafts"),
    "f_Hbeta": Symbol("f_Hβ", "µm", "ISO 1328-1", "helix slope deviation"),
    "f_ma": Symbol("f_ma", "µm", "ISO 6336-1 (64)", "misalignment by manufacture"),
    "B_1": Symbol("B_1", "", "ISO 6336-1, table 8", "what a helix modification leaves of f_sh"),
    "B_2": Symbol("B_2", "", "ISO 6336-1, table 8", "what a helix modification leaves of f_ma"),
    "F_betax_min": Symbol("F_βx,min", "µm", "ISO 6336-1 (55)", "least initial misalignment"),
    "F_betax": Symbol("F_βx", "µm", "ISO 6336-1 (52)", "initial misalignment"),
    "y_beta": Symbol("y_β", "µm", "ISO 6336-1, 7.5", "running in of the misalignment"),
    "F_betay": Symbol("F_βy", "µm", "ISO 6336-1, 7.5", "effective misalignment"),
    "c_gamma_beta": Symbol("c_γβ", "N/(mm·µm)", "ISO 6336-1 (92)", "mesh stiffness for K_Hβ at this load"),
    "K_Hbeta_end_of_face": Symbol("K_Hβ", "", "ISO 6336-1, annex E", "K_Hβ of the line load carried on to the end of the face"),
    "f_sh_C": Symbol("f_sh", "µm", "ISO 6336-1 (57)", "misalignment by shafts, by Method C"),
    "K_Hbeta_C": Symbol("K_Hβ", "", "ISO 6336-1, 7.5", "K_Hβ by Method C"),
    "K_Hbeta_C_shafts": Symbol("K_Hβ", "", "ISO 6336-1, 7.5", "K_Hβ by Method C with f_sh of the shafts"),
    "K_Hbeta_straight": Symbol("K_Hβ", "", "ISO 6336-1, 7.5", "K_Hβ of a straight gap f_sh + f_ma"),
    "b_h": Symbol("b/h", "", "ISO 6336-1, 7.6", "face width over tooth height, smaller of both gears"),
    "N_F": Symbol("N_F", "", "ISO 6336-1, 7.6", "exponent of K_Fβ"),
    "F_tH_b": Symbol("F_tH/b", "N/mm", "ISO 6336-1, 8.3", "specific load with K_A, K_γ, K_v and K_Hβ"),
    "y_alpha": Symbol("y_α", "µm", "ISO 6336-1, 8.3", "running in of the deviation behind K_Hα"),
    "c_gamma_alpha": Symbol("c_γα", "N/(mm·µm)", "ISO 6336-1 (91)", "mesh stiffness at this load"),
    "K_alpha": Symbol("K_Hα", "", "ISO 6336-1 (71)", "transverse load factor before its limits"),
    "K_Halpha_max": Symbol("K_Hα", "", "ISO 6336-1, 8.3", "most that K_Hα can be"),
    "K_Falpha_max": Symbol("K_Fα", "", "ISO 6336-1, 8.3", "most that K_Fα can be"),
}
"""Figures behind the load factors of a rating."""

CHECK = {
    "passed": Symbol("", "", "", "whether numerics are passed, and strength where it is asked for"),
    "numerics": Symbol("", "", "", "verdict of the gates of the computation"),
    "strength": Symbol("", "", "", "verdict of the gates of strength"),
    "mesh_stiffness_mean": Symbol("c_γ", "N/(mm·µm)", "", "mean mesh stiffness per common face width"),
    "mesh_stiffness_max": Symbol("c_γ", "N/(mm·µm)", "", "greatest mesh stiffness per common face width"),
    "mesh_stiffness_min": Symbol("c_γ", "N/(mm·µm)", "", "least mesh stiffness per common face width"),
    "single_stiffness": Symbol("c'", "N/(mm·µm)", "", "stiffness of one pair of teeth per common face width"),
    "transmission_error_peak_to_peak": Symbol("", "µm", "", "transmission error, peak to peak"),
    "transmission_error_harmonics": Symbol("", "µm", "", "transmission error at the tooth frequency and its multiples"),
    "contact_pressure": Symbol("p_0", "MPa", "", "greatest pressure away from edges"),
    "contact_pressure_across": Symbol("", "mm", "", "place of the greatest pressure, from the middle of the common face width"),
    "contact_pressure_radius": Symbol("", "mm", "", "radius of the greatest pressure"),
    "contact_pressure_pitch_point": Symbol("p_0", "MPa", "", "pressure at the pitch point"),
    "half_width_pitch_point": Symbol("b_H", "mm", "", "half width of contact at the pitch point"),
    "share_pitch_point": Symbol("", "", "", "share of the load of the pair of teeth at the pitch point"),
    "von_mises": Symbol("", "MPa", "", "greatest von Mises stress below the contact"),
    "von_mises_depth": Symbol("", "mm", "", "depth of that stress below the flank"),
    "von_mises_half_plane": Symbol("", "MPa", "", "greatest von Mises stress below the contact of a half-plane"),
    "root_tension": Symbol("σ_F", "MPa", "", "greatest tension in the fillets"),
    "root_tension_radius": Symbol("", "mm", "", "radius of the greatest tension"),
    "root_tension_height": Symbol("", "mm", "", "height of the greatest tension over the lower end"),
    "root_compression": Symbol("", "MPa", "", "greatest compression in the fillets"),
    "bore_tension_pinion": Symbol("", "MPa", "", "greatest tension on the pinion's bore, where nothing keeps it round"),
    "bore_tension_wheel": Symbol("", "MPa", "", "greatest tension on the wheel's bore, where nothing keeps it round"),
    "corner_positions": Symbol("", "", "", "positions where the edge of a tip touches"),
    "contact_length_mean": Symbol("", "mm", "", "mean length of the lines that carry"),
    "line_load_max": Symbol("", "N/mm", "", "greatest line load away from edges"),
    "face_load_factor": Symbol("K_Hβ", "", "", "face load factor of contact"),
    "root_face_load_factor": Symbol("K_Fβ", "", "", "face load factor of the root"),
}

CHECK_COLUMNS = {
    "strength_fe": Symbol("", "", "", "verdict of the safeties by finite elements, for information"),
    "gates_failed": Symbol("", "", "", "comparisons that decide and are not passed"),
    "hertz_pressure_deviation": Symbol("", "%", "", "peak pressures from Hertz's, at the worst"),
    "hertz_half_width_deviation": Symbol("", "%", "", "half widths of contact from Hertz's, at the worst"),
    "torque_deviation": Symbol("", "%", "", "torque that the body bears from the applied one, at the worst"),
    "discretisation_error_mesh_stiffness": Symbol("", "%", "", "estimated error of the mean mesh stiffness"),
    "discretisation_error_root_tension": Symbol("", "%", "", "estimated error of the root tension"),
    "sampling_error_root_tension": Symbol("", "%", "", "error that the positions may leave in root stresses"),
    "sampling_error_contact_pressure": Symbol("", "%", "", "error that the positions may leave in the contact pressure"),
    "root_stress_deviation": Symbol("", "%", "", "root tension from σ_F0 of the standard"),
    "mesh_stiffness_deviation": Symbol("", "%", "", "mean mesh stiffness from c_γα of the standard"),
    "single_stiffness_deviation": Symbol("", "%", "", "stiffness of one pair of teeth from c' of the standard"),
    "contact_pressure_deviation": Symbol("", "%", "", "greatest pressure from the standard's contact stress"),
    "contact_pressure_pitch_point_deviation": Symbol("", "%", "", "pressure at the pitch point from σ_H0 of the standard"),
    "contact_length_deviation": Symbol("", "%", "", "mean length of the lines that carry from the geometric one"),
    "line_load_deviation": Symbol("", "%", "", "greatest line load from the even one"),
    "face_load_factor_deviation": Symbol("", "%", "", "K_Hβ from Method C"),
    "root_face_load_factor_deviation": Symbol("", "%", "", "K_Fβ from Method C"),
    "S_H": Symbol("S_H", "", "ISO 6336-2, 5", "safety of the flank by the rating"),
    "S_H_fe": Symbol("S_H", "", "", "safety of the flank by finite elements"),
    "S_H_required": Symbol("S_Hmin", "", "", "safety that is required of flanks"),
    "S_F": Symbol("S_F", "", "ISO 6336-3, 5", "safety of the root by the rating"),
    "S_F_fe": Symbol("S_F", "", "", "safety of the root by finite elements"),
    "S_F_required": Symbol("S_Fmin", "", "", "safety that is required of roots"),
}
"""Symbols of a check in tables of results, beside those of its summary."""

STIFFNESS = {
    "mean": Symbol("", "N/µm", "", "mean secant mesh stiffness"),
    "maximum": Symbol("", "N/µm", "", "greatest secant mesh stiffness"),
    "minimum": Symbol("", "N/µm", "", "least secant mesh stiffness"),
    "pitch_point": Symbol("", "N/µm", "", "secant mesh stiffness at the pitch point"),
    "transmission_error_peak_to_peak": Symbol("", "µm", "", "transmission error, peak to peak"),
    "single_stiffness": Symbol("", "N/µm", "", "stiffness of one pair of teeth"),
    "tangent_mean": Symbol("", "N/µm", "", "mean tangent mesh stiffness"),
    "c_gamma_beta": Symbol("c_γβ", "N/(mm·µm)", "ISO 6336-1", "mean secant mesh stiffness per common face width"),
    "c_gamma_alpha": Symbol("c_γα", "N/(mm·µm)", "ISO 6336-1", "mean tangent mesh stiffness per common face width"),
    "mean_over_path": Symbol("", "N/µm", "", "mean over the path of contact, which counts double contact twice"),
    "deviation_from_3d": Symbol("", "", "", "deviation of the mean from that of solid bodies"),
}
"""Symbols of each method, as stiffness.json has them."""

DYNAMICS = {
    "stiffness_method": Symbol("", "", "", "method of the mesh stiffness"),
    "mesh_stiffness_mean": STIFFNESS["mean"],
    "mesh_stiffness_tangent_mean": STIFFNESS["tangent_mean"],
    "natural_frequency": Symbol("f_n", "Hz", "", "natural frequency of the pair"),
    "static_approach": Symbol("", "µm", "", "approach of the flanks at rest"),
    "contact_ratio": Symbol("", "", "", "usable contact ratio"),
    "resonance_speed_iso6336": Symbol("n_E1", "rpm", "ISO 6336-1, 6", "resonance speed by the standard"),
    "course_speed": Symbol("n_1", "rpm", "", "speed of the course"),
    "kv": Symbol("K_v", "", "ISO 6336-1, 6", "dynamic factor at that speed"),
    "kv_highest": Symbol("K_v", "", "ISO 6336-1, 6", "highest dynamic factor of the chart"),
    "kv_highest_speed": Symbol("n_1", "rpm", "", "speed of the highest dynamic factor"),
    "kv_errors_median": Symbol("K_v", "", "", "highest median of the dynamic factor with tooth errors"),
    "kv_errors_upper": Symbol("K_v", "", "", "highest 95 % quantile of the dynamic factor with tooth errors"),
    "kv_highest_mesh": Symbol("", "", "", "mesh of the highest dynamic factor"),
} | {f"frequency_{n}": Symbol(f"f_{n}", "Hz", "", f"natural frequency {n} of those that twist the train") for n in range(1, 7)}
"""Symbols of a pair or a train, beside what its options have."""

TRAIN = {"held": Symbol("", "", "", "whether a shaft holds the train")}

TRAIN_PARTS = {
    "inertia": {
        "speed_ratio": Symbol("", "", "", "turns per turn of the first mesh's pinion"),
        "speed": Symbol("n", "rpm", "", "speed"),
        "torque": Symbol("T", "N·m", "", "torque from outside"),
    },
    "shaft": {"inertia": Symbol("J", "kg·m²", "", "inertia about the axis")},
    "mesh": {
        "gear_ratio": Symbol("u", "", "", "base radius of the wheel over that of the pinion"),
        "reduced_mass": Symbol("m_red", "kg", "", "reduced mass of both gears"),
        "natural_frequency": Symbol("f", "Hz", "", "natural frequency of both gears by themselves"),
        "tooth_frequency": Symbol("f_z", "Hz", "", "tooth frequency at the train's speed"),
        "static_force": Symbol("F", "N", "", "mean force between the flanks"),
    },
    "excitation": {"mean_left_out": Symbol("T", "N·m", "", "mean of the file's torque, which is left out")},
}
"""Symbols of derived values of a train and its parts, as data.json has them."""

TRAIN_DYNAMICS = {
    "kv": DYNAMICS["kv"],
    "kv_highest": DYNAMICS["kv_highest"],
    "kv_highest_speed": DYNAMICS["kv_highest_speed"],
    "kv_errors_median": DYNAMICS["kv_errors_median"],
    "kv_errors_upper": DYNAMICS["kv_errors_upper"],
    "shaft_overload": Symbol("", "", "", "greatest torque of the chart over the static one"),
    "shaft_overload_speed": Symbol("n_1", "rpm", "", "speed of that torque"),
}
"""Symbols of each mesh or shaft of a train, whose name stands behind."""

DRAW = {"sheets": Symbol("", "", "", "sheets that were drawn")}

MESH = {
    "passed": Symbol("", "", "", "whether the gates of the meshes are passed"),
    "nodes": Symbol("", "", "", "nodes of all meshes"),
    "elements": Symbol("", "", "", "elements of all meshes"),
    "bytes": Symbol("", "bytes", "", "memory of nodes and elements"),
    "least_scaled_jacobian": Symbol("", "", "", "least scaled Jacobian of an element"),
    "largest_aspect": Symbol("", "", "", "longest over shortest edge of an element, at the most"),
    "least_angle": Symbol("", "deg", "", "least angle between edges of a face"),
    "node_deviation": Symbol("", "mm", "", "nodes from the exact flanks and fillets, at the most"),
    "face_deviation": Symbol("", "µm", "", "flanks and fillets between nodes from the exact ones, at the most"),
    "mean_offset": Symbol("", "µm", "", "surface from the exact one on the mean"),
}
"""Symbols of all meshes of a design, as mesh.json has them."""

MODIFY = {
    "torque": Symbol("T_1", "N·m", "", "torque of the modifications, on the pinion"),
    "pressure_bound": Symbol("", "MPa", "", "bound of the contact pressure"),
    "variants": Symbol("", "", "", "variants that were tried"),
}

MODIFY_FIGURES = {
    name: CHECK[name]
    for name in (
        "transmission_error_peak_to_peak",
        "transmission_error_harmonics",
        "contact_pressure",
        "root_tension",
        "face_load_factor",
    )
} | {"edge_positions": Symbol("", "", "", "positions where the edge of a tip touches")}
"""Symbols of a mesh before and after a modification."""

MODIFY_ON_SHAFTS = {
    "f_sh": LOAD_FACTOR_DETAILS["f_sh"],
    "f_ma": LOAD_FACTOR_DETAILS["f_ma"],
    "K_Hbeta_before": Symbol("K_Hβ", "", "ISO 6336-1, annex E", "face load factor on the shafts, before"),
    "K_Hbeta_after": Symbol("K_Hβ", "", "ISO 6336-1, annex E", "face load factor on the shafts, after", Better.LOWER),
}
"""Symbols of the load over the face on shafts, before and after a modification."""
