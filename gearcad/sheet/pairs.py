"""The blocks of pairs, a column each: a pair of gears, a pinion and its rack, the meshes and stages of a planetary train."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcad import symbols
from gearcad.geometry import GearPair, RackPair
from gearcad.schema import symbols_of
from gearcad.sheet.blocks import Block, Row, Section, block, value_text

__all__ = ["OF_PAIR", "pair_section"]

OF_PAIR = symbols_of(GearPair) | symbols_of(RackPair) | symbols.PAIR | symbols.RACK_PAIR | symbols.DRIVE
OF_PAIR["tip_clearances.pinion"] = symbols.PAIR["tip_clearances"]._replace(words="tip clearance of the pinion")


_PAIR_BLOCKS = {
    "Mesh": "gear_ratio centre_distance reference_centre_distance axial_offset mounting_distance back_distance"
    " shifted_distance zero_backlash_distance pitch_line_height working_transverse_pressure_angle"
    " profile_shift_sum zero_backlash_shift_sum tip_alteration circumferential_backlash normal_backlash axial_force_ratio"
    " tip_clearances.pinion tip_clearances.rack",
    "Backlash within tolerances": "centre_distance_tolerance "
    + " ".join(k for k in OF_PAIR if k.startswith("backlash_limits.")),
    "Motion": "travel_per_revolution travel_per_degree rack_force rack_speed",
    "Contact": "transverse_contact_ratio usable_contact_ratio overlap_ratio total_contact_ratio common_width.width"
    " common_width.offset contact_line_lengths.minimum contact_line_lengths.mean contact_line_lengths.maximum"
    " active_root_diameter active_root_depth",
    "Line of action, from T1": "path_of_contact.A path_of_contact.B path_of_contact.C path_of_contact.D path_of_contact.E",
    "Specific sliding": "specific_sliding.pinion_A specific_sliding.wheel_A specific_sliding.pinion_E specific_sliding.wheel_E"
    " specific_sliding.greatest",
    "Free of interference by (negative: it is there)": "interference_margins.involute interference_margins.pinion_fillet"
    " interference_margins.wheel_fillet interference_margins.trochoid interference_margins.radial",
}


def pair_section(pairs: Mapping[str, Mapping[str, Any]]) -> Section:
    """Of flattened documents, by the names of the columns; a single pair that needs no name is called ""."""
    blocks: list[Block] = []
    for title, keys in _PAIR_BLOCKS.items():
        blocks += block(title, (_row(key, pairs) for key in keys.split() if any(key in pair for pair in pairs.values())))
    return Section(tuple(filter(None, pairs)), tuple(blocks))


def _row(key: str, pairs: Mapping[str, Mapping[str, Any]]) -> Row:
    values = tuple(pair.get(key) for pair in pairs.values())
    return Row(f"pair.{key}", OF_PAIR[key], values, tuple(map(value_text, values)))
