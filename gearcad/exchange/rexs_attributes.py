"""Attributes of REXS 1.6 that gearcad writes and reads: their units, and the keys of specs that they stand for."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from gearcad.geometry import Gear

VERSION = "1.6"
"""Version of REXS that is written."""

READ_VERSIONS = ("1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7")
"""Versions that are read; the attributes of gears have kept their names since 1.0."""

CUSTOM = "custom_gearcad_"
"""Beginning of attributes that REXS does not have: other programs leave out what begins with custom_."""

NOT_GIVEN = "custom_gearcad_not_given"
"""Attribute with a list of keys whose values are written for others, and follow from other keys."""

STEP = "custom_gearcad_step"
"""Attribute of a tool that says whose keys it has: rack, cutter or premachining."""

_OF_UNITS = {
    "mm": (
        "face_width normal_module tip_diameter root_diameter inner_diameter outer_diameter width center_distance "
        "tooth_tip_chamfer chamfer_at_tooth_end protuberance_amount machining_allowance machining_allowance_tolerance "
        "u_coordinate_on_shaft u_coordinate_on_shaft_inner_side u_coordinate_on_shaft_outer_side length outer_diameter_begin "
        "outer_diameter_end inner_diameter_begin inner_diameter_end tip_relief_depth tip_relief_datum_diameter "
        "tip_relief_datum_length root_relief_depth root_relief_datum_diameter root_relief_datum_length profile_crowning_at_tip "
        "profile_crowning_at_root profile_slope profile_twist helix_crowning_amount_datum_face "
        "helix_crowning_amount_non_datum_face helix_slope end_relief_depth_datum_face end_relief_depth_non_datum_face "
        "end_relief_length_datum_face end_relief_length_non_datum_face support_vector u_axis_vector w_axis_vector"
    ),
    "deg": ("helix_angle_reference_diameter normal_pressure_angle protuberance_angle rotating_angle_around_neg_u_axis"),
    "mum": (
        "averaged_peak_to_valley_height_flank averaged_peak_to_valley_height_root misalignment_in_v_direction "
        "misalignment_in_w_direction"
    ),
    "none": (
        "number_of_teeth addendum_modification_coefficient addendum_modification_coefficient_after_finishing "
        "addendum_coefficient_basic_profile addendum_coefficient_reference_profile tip_radius_factor shape_of_relief "
        "shape_of_profile_crowning shape_of_helix_crowning tooth_thickness_deviation_tolerance_series_din_3967_1978 "
        "application_factor_iso_6336_2006 poisson_ratio material_designation defines_speed defines_torque transmits_torque "
        "axial_force_absorption radial_force_absorption bearing_type catalogue_designation catalogue_value_e axial_factor_y_1 "
        "axial_factor_y_2 reference_component_for_position number_of_gears gear_shift_index datum_face_orientation"
    ),
    "N / mm^2": "elastic_modulus yield_strength tensile_strength endurance_limit_flank endurance_limit_root",
    "kg / dm^3": "density density_at_15_degree_celsius",
    "HV": "surface_hardness_vickers",
    "HB": "surface_hardness_brinell",
    "HRC": "core_hardness_rockwell",
    "1 / min": "rotational_speed",
    "N m": "torque_around_u_axis torque_around_v_axis torque_around_w_axis",
    "N": "force_u_direction force_v_direction force_w_direction",
    "kN": "radial_dynamic_load_rating radial_static_load_rating fatigue_limit_load",
    "N / m": "radial_stiffness axial_stiffness",
    "N mm / rad": "bending_stiffness",
    "mm^2 / s": "viscosity_at_40_degree_celsius viscosity_at_100_degree_celsius",
    "C": "temperature_lubricant",
    "h": "operating_time",
    "kW": "power",
}

UNITS: Mapping[str, str] = MappingProxyType({name: unit for unit, names in _OF_UNITS.items() for name in names.split()})
"""Unit of each attribute as REXS writes it."""

_SAME_UNITS = {"": "none", "°": "deg", "-": "none"}
"""Other spellings of units in files: of versions up to 1.5, and of other programs."""


def same_unit(written: str, unit: str) -> bool:
    """Return whether a unit in a file is that of an attribute; none at all counts as that."""
    return not written or _SAME_UNITS.get(written, written) == unit


class KeyAttribute(NamedTuple):
    """A key of a spec and the attribute of REXS that says the same: value there = value of the key times `factor`."""

    key: str
    attribute: str
    factor: float = 1.0


OF_GEAR = (
    KeyAttribute("normal_module", "normal_module"),
    KeyAttribute("face_width", "face_width"),
    KeyAttribute("helix_angle", "helix_angle_reference_diameter"),
    KeyAttribute("flank_roughness", "averaged_peak_to_valley_height_flank"),
    KeyAttribute("root_roughness", "averaged_peak_to_valley_height_root"),
    KeyAttribute("body.bore", "inner_diameter"),
    KeyAttribute("body.end_chamfer", "chamfer_at_tooth_end"),
)
"""Keys that stand on the gear itself, beside the number of teeth and the diameters, whose sign is that of no ring in REXS."""

OF_FLANK = (
    KeyAttribute("rack.pressure_angle", "normal_pressure_angle"),
    KeyAttribute("rack.addendum", "addendum_coefficient_basic_profile"),
    KeyAttribute("profile_shift", "addendum_modification_coefficient"),
    KeyAttribute("body.tip_chamfer", "tooth_tip_chamfer"),
)
"""Keys that stand on both flanks."""

OF_MODIFICATIONS: Mapping[str, tuple[KeyAttribute, ...]] = MappingProxyType(
    {
        "tip_relief": (
            KeyAttribute("tip_relief", "tip_relief_depth", 1e-3),
            KeyAttribute("tip_relief_length", "tip_relief_datum_length"),
        ),
        "root_relief": (
            KeyAttribute("root_relief", "root_relief_depth", 1e-3),
            KeyAttribute("root_relief_length", "root_relief_datum_length"),
        ),
        "profile_crowning": (
            KeyAttribute("profile_crowning", "profile_crowning_at_tip", 1e-3),
            KeyAttribute("profile_crowning", "profile_crowning_at_root", 1e-3),
        ),
        "profile_slope": (KeyAttribute("pressure_angle_modification", "profile_slope", 1e-3),),
        "helix_crowning": (
            KeyAttribute("lead_crowning", "helix_crowning_amount_datum_face", 1e-3),
            KeyAttribute("lead_crowning", "helix_crowning_amount_non_datum_face", 1e-3),
        ),
        "end_relief_datum_face": (
            KeyAttribute("end_relief", "end_relief_depth_datum_face", 1e-3),
            KeyAttribute("end_relief_length", "end_relief_length_datum_face"),
        ),
        "end_relief_non_datum_face": (
            KeyAttribute("end_relief", "end_relief_depth_non_datum_face", 1e-3),
            KeyAttribute("end_relief_length", "end_relief_length_non_datum_face"),
        ),
        "helix_slope": (KeyAttribute("helix_angle_modification", "helix_slope", 1e-3),),
        "profile_twist": (KeyAttribute("twist", "profile_twist", 1e-3),),
    }
)
"""Components that modify a flank, and the keys of `modification` behind their attributes; the first is the amount."""

SHAPES = {"tip_relief": "tip_relief_shape", "root_relief": "root_relief_shape"} | dict.fromkeys(
    ("end_relief_datum_face", "end_relief_non_datum_face"), "end_relief_shape"
)
"""Components with a `shape_of_relief`, and its key; "linear" and "parabolic" are the words of both."""

OF_TOOL = (
    KeyAttribute("rack.dedendum", "addendum_coefficient_reference_profile"),
    KeyAttribute("rack.root_radius", "tip_radius_factor"),
)
"""Keys of the rack that a tool which makes the whole tooth has: its addendum is the dedendum of the gear's rack."""

OF_PREMACHINING = (
    KeyAttribute("premachining.tool_addendum", "addendum_coefficient_reference_profile"),
    KeyAttribute("premachining.tool_tip_radius", "tip_radius_factor"),
    KeyAttribute("premachining.protuberance", "protuberance_amount"),
    KeyAttribute("premachining.protuberance_angle", "protuberance_angle"),
    KeyAttribute("premachining.tool_pressure_angle", "normal_pressure_angle"),
    KeyAttribute("premachining.tool_module", "normal_module"),
)
"""Keys of a tool that cuts before finishing."""

OF_SETTINGS = (
    KeyAttribute("premachining.stock", "machining_allowance"),
    KeyAttribute("premachining.stock_tolerance", "machining_allowance_tolerance"),
)
"""Keys of the settings with which that tool is used."""

OF_CUTTER = (
    KeyAttribute("cutter.profile_shift", "addendum_modification_coefficient"),
    KeyAttribute("cutter.tip_radius", "tip_radius_factor"),
)
"""Keys of a shaper cutter beside its number of teeth."""

OF_MATERIAL = (
    KeyAttribute("youngs_modulus", "elastic_modulus"),
    KeyAttribute("poisson_ratio", "poisson_ratio"),
    KeyAttribute("density", "density", 1e-3),
    KeyAttribute("yield_strength", "yield_strength"),
    KeyAttribute("tensile_strength", "tensile_strength"),
    KeyAttribute("contact_endurance_limit", "endurance_limit_flank"),
    KeyAttribute("root_endurance_limit", "endurance_limit_root"),
    KeyAttribute("core_hardness", "core_hardness_rockwell"),
)
"""Keys of a material beside its name and the hardness of the flanks, whose unit is that of the group."""

OF_LUBRICANT = (
    KeyAttribute("oil_viscosity_40", "viscosity_at_40_degree_celsius"),
    KeyAttribute("oil_viscosity_100", "viscosity_at_100_degree_celsius"),
    KeyAttribute("oil_density", "density_at_15_degree_celsius", 1e-3),
)
"""Keys of [rating] that are the lubricant's."""

OF_SEGMENT = (
    KeyAttribute("length", "length"),
    KeyAttribute("outer_diameter", "outer_diameter_begin"),
    KeyAttribute("outer_diameter", "outer_diameter_end"),
    KeyAttribute("inner_diameter", "inner_diameter_begin"),
    KeyAttribute("inner_diameter", "inner_diameter_end"),
)
"""Keys of a segment of a shaft."""

OF_BEARING = (
    KeyAttribute("position", "u_coordinate_on_shaft_inner_side"),
    KeyAttribute("C", "radial_dynamic_load_rating", 1e-3),
    KeyAttribute("C0", "radial_static_load_rating", 1e-3),
    KeyAttribute("C_u", "fatigue_limit_load", 1e-3),
    KeyAttribute("e", "catalogue_value_e"),
    KeyAttribute("Y1", "axial_factor_y_1"),
    KeyAttribute("d", "inner_diameter"),
    KeyAttribute("D", "outer_diameter"),
    KeyAttribute("B", "width"),
)
"""Keys of a bearing beside its name, kind and stiffness; Y and Y2 are both `axial_factor_y_2`, of one kind or the other."""

STIFFNESSES = (
    KeyAttribute("radial_stiffness", "radial_stiffness", 1e6),
    KeyAttribute("axial_stiffness", "axial_stiffness", 1e6),
    KeyAttribute("tilting_stiffness", "bending_stiffness", 1e3),
)
"""Stiffness of bearings: N/µm is 1e6 N/m, N·m/rad is 1e3 N mm/rad."""

RIGID = 1e20
"""Stiffness (N/m, N mm/rad) that stands for a rigid support, as the programs of FVA write it."""

LEAST_RIGID = 1e19
"""Stiffness in a file from which a support is rigid."""

BEARING_TYPES = {
    "deep groove": "radial_grooved_ball_bearing",
    "angular contact": "angular_contact_ball_bearing",
    "cylindrical": "radial_roller_bearing",
    "tapered": "radial_tapered_roller_bearing",
    "spherical": "radial_self_aligning_roller_bearing",
}
"""Kinds of bearings, and their `bearing_type`."""

ABSORPTIONS = {"right": "negative", "left": "positive"}
"""Side to which a bearing pushes the shaft, and the direction of the axial forces that it takes up."""

SERIES = re.compile(r"[a-z]{1,2}\d{2}")
"""A deviation of DIN 3967 with the series of its tolerance, such as cd25."""


def attribute_value(value: float, factor: float) -> float:
    """Return the value of an attribute for that of a key: short decimals stay short."""
    return value * factor if factor >= 1 else value / round(1 / factor)


def key_value(written: float, factor: float) -> float:
    """Return the value of a key that makes the value of an attribute."""
    return written if factor == 1 else plainest(written / factor, lambda value: attribute_value(value, factor), written)


def plainest(value: float, forward: Callable[[float], float], written: float) -> float:
    """Return the value with the fewest digits that `forward` turns into what is written; `value` where none does."""
    for digits in (6, 9, 12, 14):
        short = round(value, digits)
        if forward(short) == written:
            return short
    if forward(value) != written:
        for near in (math.nextafter(value, math.inf), math.nextafter(value, -math.inf)):
            if forward(near) == written:
                return near
    return value


def finished_shift(gear: Gear, thinning: float) -> float:
    """Return x_E, the profile shift coefficient of the finished teeth: x - A_sn/(2 m_n tan alpha_n); thinning A_sn in mm."""
    return shift_with_thinning(gear.profile_shift, float(gear.normal_module), gear.rack.pressure_angle, thinning)


def shift_with_thinning(profile_shift: float, normal_module: float, pressure_angle: float, thinning: float) -> float:
    """Return x_E of a profile shift coefficient; module and thinning in mm, the angle in degrees."""
    return profile_shift - thinning / (2 * normal_module * math.tan(math.radians(pressure_angle)))


def custom_id(key: str) -> str:
    """Return the name of the attribute that keeps a key which REXS does not have: letters, digits and _ alone."""
    return CUSTOM + re.sub(r"[^a-z0-9]+", "_", key.lower())
