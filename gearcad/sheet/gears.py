"""The blocks of gears, a column each, and of a rack."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcad import symbols
from gearcad.geometry import Gear, Rack
from gearcad.geometry.derived import is_given
from gearcad.schema import symbols_of
from gearcad.sheet.blocks import ABSENT, Block, Row, Section, block, flattened, value_text
from gearcad.sheet.pairs import OF_PAIR

__all__ = ["gear_section", "rack_section"]

_OF_GEAR = symbols_of(Gear) | symbols.GEAR
_OF_RACK = symbols_of(Rack) | symbols.RACK


def _of_part(part: str) -> str:
    """The fields of one part of a gear."""
    return " ".join(key for key in _OF_GEAR if key.startswith(f"{part}."))


_GEAR_BLOCKS = {
    "Teeth": "teeth normal_module normal_diametral_pitch helix_angle profile_shift profile_shift_khk"
    " tip_alteration tooth_thinning face_width virtual_teeth lead",
    "Basic rack": _of_part("rack"),
    "Shaper cutter": _of_part("cutter") + " cutter_tip_diameter",
    "Double helix": _of_part("double_helix"),
    "Transverse section": "transverse_module transverse_pressure_angle base_helix_angle transverse_pitch transverse_base_pitch",
    "Diameters": "tip_diameter tip_form_diameter reference_diameter base_diameter form_diameter root_diameter undercut",
    "Tooth thickness": "normal_tooth_thickness transverse_tooth_thickness tip_thickness",
    "Inspection": "span_teeth span_spaces span_measurement span_contact_diameter ball_diameter over_balls over_pins"
    " between_balls between_pins pin_axial_shift",
    "Within the tooth thickness allowance": _of_part("thickness_limits"),
    "Flank modifications": _of_part("modification"),
    "Body": _of_part("body"),
}
_PLACED = {"name", *" ".join(_GEAR_BLOCKS.values()).split()}
_GEAR_BLOCKS["Teeth"] += "".join(f" {key}" for key in _OF_GEAR if key not in _PLACED)

_RACK_BLOCKS = {
    "Rack": "teeth length normal_module normal_diametral_pitch helix_angle face_width height total_height tip_alteration"
    " tooth_thinning tip_chamfer",
    "Basic rack": " ".join(key for key in _OF_RACK if key.startswith("rack.")),
    "Transverse section": "transverse_module transverse_pressure_angle base_helix_angle normal_pitch transverse_pitch"
    " transverse_base_pitch",
    "Height of teeth": "tip_height tip_form_height form_depth root_depth",
    "Tooth thickness": "normal_tooth_thickness transverse_tooth_thickness tip_thickness",
    "Inspection": "pin_diameter over_pin",
}

_BELONGS_TO = {
    "cutter.profile_shift": "cutter.teeth",
    "double_helix.offset": "double_helix.gap_width",
    "body.keyway_depth": "body.keyway_width",
    "body.hub_length": "body.hub_diameter",
    "body.hub_side": "body.hub_diameter",
    "body.end_chamfer_angle": "body.end_chamfer",
}
"""Features of a body, a cutter and a double helix that mean nothing without another one."""

_OF_SPUR_RINGS = {"span_measurement": "spur only", "between_pins": "spur only"}
"""What the sheet of a helical ring says of them."""


def gear_section(gears: Mapping[str, Gear], document: Mapping[str, Any], pair: Mapping[str, Any]) -> Section:
    """The gears of a design's document, and beside their diameters those that each has in its `pair`."""
    every = {name: flattened(document[name] | _in_use(gear)) for name, gear in gears.items()}
    blocks: list[Block] = []
    for title, keys in _GEAR_BLOCKS.items():
        rows = [_gear_row(key, every) for key in keys.split()]
        if title == "Diameters":
            rows += [_row(f"pair.{key}", OF_PAIR[key], pair[key]) for key in symbols.PER_GEAR if key in pair]
        blocks += block(title, (row for row in rows if set(row.texts) != {ABSENT}))
    return Section(tuple(every), tuple(blocks))


def rack_section(rack: Rack) -> Section:
    """The blocks of a rack."""
    values = flattened(rack.to_dict() | _given_pitch(rack))
    blocks: list[Block] = []
    for title, keys in _RACK_BLOCKS.items():
        rows = (_row(f"rack.{key}", _OF_RACK[key], [values[key]]) for key in keys.split())
        blocks += block(title, (row for row in rows if row.texts != (ABSENT,)))
    return Section(("rack",), tuple(blocks))


def _gear_row(key: str, gears: Mapping[str, Mapping[str, Any]]) -> Row:
    return _row(
        f"gear.{key}", _OF_GEAR[key], [values.get(key) if _is_there(values, key) else None for values in gears.values()]
    )


def _row(key: str, symbol: symbols.Symbol, values: Any) -> Row:
    return Row(key, symbol, tuple(values), tuple(map(value_text, values)))


def _is_there(values: Mapping[str, Any], key: str) -> bool:
    """Not a feature of the body, a cutter or a modification without what it belongs to."""
    owner = _BELONGS_TO.get(key, key)
    missing = (None, 0) if owner.startswith("body.") else (None,)
    return "." not in owner or values.get(owner) not in missing


def _in_use(gear: Gear) -> dict[str, Any]:
    """What the sheet shows of a gear otherwise than its document.

    Modifications that do something, a diametral pitch that was given, and that some gauges are for spur rings.
    """
    shown = {"modification": gear.flank_form.in_use} | _given_pitch(gear)
    return shown | (_OF_SPUR_RINGS if gear.internal and gear.helix_angle else {})


def _given_pitch(part: Gear | Rack) -> dict[str, Any]:
    """The diametral pitch, if it was given."""
    pitch = part.normal_diametral_pitch
    return {"normal_diametral_pitch": pitch if is_given(pitch) else None}
