"""The one table from field name to symbol, unit, source and words: data sheet, CSV headers and drawings read it.

Keys are those of `Gear.to_dict()`, `GearPair.to_dict()`, `Material` and `Load`, nested ones joined by a dot
(`rack.root_radius`, `path_of_contact.A`). Clauses are those of ISO 21771:2007 unless another standard is named; an empty
source means that the quantity is our own.
"""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["GEAR", "LOAD", "MATERIAL", "PAIR", "Symbol"]


class Symbol(NamedTuple):
    """How one quantity is written: the standard's symbol, its unit ("" for numbers), the clause, and plain words."""

    symbol: str
    unit: str
    source: str
    words: str


GEAR = {
    "name": Symbol("", "", "", "name"),
    "teeth": Symbol("z", "", "4.1", "number of teeth"),
    "normal_module": Symbol("m_n", "mm", "4.2", "normal module"),
    "face_width": Symbol("b", "mm", "4.1", "face width"),
    "helix_angle": Symbol("β", "deg", "4.2", "helix angle (right hand +)"),
    "profile_shift": Symbol("x", "", "4.2", "profile shift coefficient"),
    "tip_alteration": Symbol("k", "", "4.5", "tip alteration coefficient"),
    "tooth_thinning": Symbol("A_sn", "mm", "7.3", "tooth thinning (normal)"),
    "rack.pressure_angle": Symbol("α_n", "deg", "ISO 53", "normal pressure angle"),
    "rack.addendum": Symbol("h_aP*", "", "ISO 53", "addendum of the rack"),
    "rack.dedendum": Symbol("h_fP*", "", "ISO 53", "dedendum of the rack"),
    "rack.root_radius": Symbol("ρ_fP*", "", "ISO 53", "root radius of the rack"),
    "body.bore": Symbol("", "mm", "", "bore"),
    "body.keyway_width": Symbol("", "mm", "DIN 6885", "keyway width"),
    "body.keyway_depth": Symbol("t_2", "mm", "DIN 6885", "keyway depth from the bore"),
    "body.hub_diameter": Symbol("", "mm", "", "hub diameter"),
    "body.hub_length": Symbol("", "mm", "", "hub length on each side"),
    "body.hub_side": Symbol("", "", "", "side of the hub"),
    "body.rim_diameter": Symbol("", "mm", "", "rim diameter (internal gears)"),
    "body.end_chamfer": Symbol("", "mm", "", "end chamfer, axial length"),
    "body.end_chamfer_angle": Symbol("", "deg", "", "end chamfer, angle to the axis"),
    "body.tip_chamfer": Symbol("h_K", "mm", "6.1", "tip chamfer, radial height"),
    "transverse_module": Symbol("m_t", "mm", "4.2", "transverse module"),
    "transverse_pressure_angle": Symbol("α_t", "deg", "4.3", "transverse pressure angle"),
    "base_helix_angle": Symbol("β_b", "deg", "4.3", "base helix angle"),
    "lead": Symbol("p_z", "mm", "4.2", "lead"),
    "virtual_teeth": Symbol("z_n", "", "4.7", "virtual number of teeth"),
    "reference_diameter": Symbol("d", "mm", "4.2", "reference diameter"),
    "base_diameter": Symbol("d_b", "mm", "4.3", "base diameter"),
    "tip_diameter": Symbol("d_a", "mm", "4.5", "tip diameter"),
    "tip_form_diameter": Symbol("d_Fa", "mm", "7.6", "tip form diameter"),
    "form_diameter": Symbol("d_Ff", "mm", "7.6", "root form diameter"),
    "root_diameter": Symbol("d_f", "mm", "4.5", "root diameter"),
    "undercut": Symbol("", "", "7.7", "undercut"),
    "normal_tooth_thickness": Symbol("s_n", "mm", "4.7", "normal tooth thickness"),
    "transverse_tooth_thickness": Symbol("s_t", "mm", "4.7", "transverse tooth thickness"),
    "tip_thickness": Symbol("s_an", "mm", "7.9", "normal tip thickness"),
    "transverse_pitch": Symbol("p_t", "mm", "4.4", "transverse pitch"),
    "transverse_base_pitch": Symbol("p_bt", "mm", "4.4", "transverse base pitch"),
    "span_teeth": Symbol("k", "", "Annex A", "teeth spanned"),
    "span_measurement": Symbol("W_k", "mm", "Annex A", "span measurement"),
    "span_contact_diameter": Symbol("d_yk", "mm", "Annex A", "span touches at diameter"),
    "ball_diameter": Symbol("D_M", "mm", "Annex A", "ball or pin diameter"),
    "over_balls": Symbol("M_dK", "mm", "Annex A", "over two balls"),
    "over_pins": Symbol("M_dR", "mm", "Annex A", "over two pins"),
    "pin_axial_shift": Symbol("", "mm", "", "pins apart along the axis"),
}

PAIR = {
    "centre_distance": Symbol("a", "mm", "5.2", "centre distance"),
    "axial_offset": Symbol("", "mm", "", "axial offset of the wheel"),
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
    "overlap_ratio": Symbol("ε_β", "", "5.4", "overlap ratio"),
    "total_contact_ratio": Symbol("ε_γ", "", "5.4", "total contact ratio"),
    "tip_clearances": Symbol("c", "mm", "5.2", "tip clearance in the mate's root"),
    "circumferential_backlash": Symbol("j_wt", "mm", "5.5", "circumferential backlash"),
    "normal_backlash": Symbol("j_bn", "mm", "5.5", "normal backlash"),
    "active_root_diameters": Symbol("d_Nf", "mm", "5.4", "active root diameter"),
    "path_of_contact.A": Symbol("T1A", "mm", "5.4", "first contact, from T1"),
    "path_of_contact.B": Symbol("T1B", "mm", "5.4", "single contact begins"),
    "path_of_contact.C": Symbol("T1C", "mm", "5.4", "pitch point"),
    "path_of_contact.D": Symbol("T1D", "mm", "5.4", "single contact ends"),
    "path_of_contact.E": Symbol("T1E", "mm", "5.4", "last contact"),
    "contact_line_lengths.minimum": Symbol("", "mm", "5.4", "contact lines, least total length"),
    "contact_line_lengths.mean": Symbol("", "mm", "5.4", "contact lines, mean total length"),
    "contact_line_lengths.maximum": Symbol("", "mm", "5.4", "contact lines, greatest total length"),
}

MATERIAL = {
    "name": Symbol("", "", "", "material"),
    "youngs_modulus": Symbol("E", "MPa", "", "Young's modulus"),
    "poisson_ratio": Symbol("ν", "", "", "Poisson's ratio"),
    "density": Symbol("ρ", "kg/m³", "", "density"),
    "yield_strength": Symbol("σ_y", "MPa", "", "yield strength"),
    "contact_limit": Symbol("σ_HP", "MPa", "ISO 6336-2", "permissible contact stress"),
    "root_limit": Symbol("σ_FP", "MPa", "ISO 6336-3", "permissible root stress"),
}

LOAD = {
    "torque": Symbol("T_1", "N·m", "ISO 6336-1", "torque on the pinion"),
    "speed": Symbol("n_1", "rpm", "ISO 6336-1", "speed of the pinion"),
    "application_factor": Symbol("K_A", "", "ISO 6336-1", "application factor"),
}
