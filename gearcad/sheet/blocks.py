"""Blocks of data sheets: quantities with symbol, values, and values as they are shown; of gears, racks and pairs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from typing import Any, NamedTuple

from gearcad.core import symbols
from gearcad.core.quantities import is_given, symbols_of
from gearcad.core.records import Notice
from gearcad.core.symbols import Symbol
from gearcad.geometry import Gear, GearPair, Rack, RackPair

ABSENT = "-"
"""Text for an absent value."""


class Row(NamedTuple):
    """One quantity: its key, how it is written, and in each column its value with all digits and as shown.

    Keys are those of `data.json` behind what the columns are of: `gear.tip_diameter`, `pair.path_of_contact.A`.
    """

    key: str
    symbol: Symbol
    values: tuple[Any, ...]
    texts: tuple[str, ...]


class Block(NamedTuple):
    """Rows that belong together."""

    title: str
    rows: tuple[Row, ...]


class Section(NamedTuple):
    """Blocks with the same columns, by the names above them; none above a single column that needs no name.

    `name` says of what they are, where others are alike: a mesh of a train.
    """

    columns: tuple[str, ...]
    blocks: tuple[Block, ...]
    name: str = ""


class Sheet(NamedTuple):
    """The content of a design's data sheet: a title line, its sections, and the notices to know before manufacture.

    `units` gives the units of rows that have none of their own, `clauses` the standards to which the sources belong.
    """

    name: str
    title: str
    units: str
    clauses: str
    sections: tuple[Section, ...]
    notices: tuple[Notice, ...]


def block(title: str, rows: Iterable[Row]) -> tuple[Block, ...]:
    """Return a block of rows, if there are any."""
    found = tuple(rows)
    return (Block(title, found),) if found else ()


def flattened(document: Mapping[str, Any]) -> dict[str, Any]:
    """Nested keys joined by dots."""
    flat: dict[str, Any] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            flat |= {f"{key}.{inner}": item for inner, item in flattened(value).items()}
        else:
            flat[key] = value
    return flat


def value_text(value: Any) -> str:
    """Four digits after the point: 0.1 µm, and enough of a ratio or an angle."""
    if value is None:
        return ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    # Adding zero turns a rounded -0.0 into a plain one.
    return f"{round(value, 4) + 0.0:.4f}" if isinstance(value, float) else str(value)


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
    """Return the section of pairs from their flattened documents, by column name; a single pair without a name is ""."""
    blocks: list[Block] = []
    for title, keys in _PAIR_BLOCKS.items():
        blocks += block(title, (_pairs_row(key, pairs) for key in keys.split() if any(key in pair for pair in pairs.values())))
    return Section(tuple(filter(None, pairs)), tuple(blocks))


def _pairs_row(key: str, pairs: Mapping[str, Mapping[str, Any]]) -> Row:
    values = tuple(pair.get(key) for pair in pairs.values())
    return Row(f"pair.{key}", OF_PAIR[key], values, tuple(map(value_text, values)))


_OF_GEAR = symbols_of(Gear) | symbols.GEAR
_OF_RACK = symbols_of(Rack) | symbols.RACK


def _of_part(part: str) -> str:
    """Return the fields of one part of a gear."""
    return " ".join(key for key in _OF_GEAR if key.startswith(f"{part}."))


_GEAR_BLOCKS = {
    "Teeth": "teeth normal_module normal_diametral_pitch helix_angle profile_shift profile_shift_khk"
    " tip_alteration tooth_thinning face_width virtual_teeth lead",
    "Tool of the shelf": "tool tool_file",
    "Basic rack": _of_part("rack"),
    "Shaper cutter": _of_part("cutter") + " cutter_tip_diameter",
    "Cut before finishing": _of_part("premachining") + " " + _of_part("finishing"),
    "As made": _of_part("making"),
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
    "Cut before finishing": " ".join(key for key in _OF_RACK if key.startswith(("premachining.", "finishing."))),
    "Transverse section": "transverse_module transverse_pressure_angle base_helix_angle normal_pitch transverse_pitch"
    " transverse_base_pitch",
    "Height of teeth": "tip_height tip_form_height form_depth root_depth",
    "Tooth thickness": "normal_tooth_thickness transverse_tooth_thickness tip_thickness",
    "Inspection": "pin_diameter over_pin",
}

_BELONGS_TO = {
    "cutter.profile_shift": "cutter.teeth",
    "premachining.cutter_profile_shift": "premachining.cutter_teeth",
    "finishing.kind": "finishing.end_diameter",
    "finishing.wheel_tip_radius": "finishing.end_diameter",
    "double_helix.offset": "double_helix.gap_width",
    "body.keyway_depth": "body.keyway_width",
    "body.hub_length": "body.hub_diameter",
    "body.hub_side": "body.hub_diameter",
    "body.end_chamfer_angle": "body.end_chamfer",
}
"""Features of a body, a cutter and a double helix that mean nothing without another one."""

_OF_SPUR_RINGS = {"span_measurement": "spur only", "between_pins": "spur only"}
"""Texts that the sheet of a helical ring shows for these gauges."""


def gear_section(gears: Mapping[str, Gear], document: Mapping[str, Any], pair: Mapping[str, Any]) -> Section:
    """Return the gears of a design's document, and beside their diameters those that each has in its `pair`."""
    every = {name: flattened(document[name] | _in_use(gear)) for name, gear in gears.items()}
    blocks: list[Block] = []
    for title, keys in _GEAR_BLOCKS.items():
        rows = [_gear_row(key, every) for key in keys.split()]
        if title == "Diameters":
            rows += [_row(f"pair.{key}", OF_PAIR[key], pair[key]) for key in symbols.PER_GEAR if key in pair]
        blocks += block(title, (row for row in rows if set(row.texts) != {ABSENT}))
    return Section(tuple(every), tuple(blocks))


def rack_section(rack: Rack) -> Section:
    """Return the blocks of a rack."""
    values = flattened(rack.to_dict() | _given_pitch(rack) | _without_root(rack))
    values["finishing.end_diameter"] = values.get("finishing.end_depth")  # what belongs to the end of a gear's flank
    blocks: list[Block] = []
    for title, keys in _RACK_BLOCKS.items():
        rows = (
            _row(f"rack.{key}", _OF_RACK[key], [values.get(key) if _is_there(values, key) else None]) for key in keys.split()
        )
        blocks += block(title, (row for row in rows if row.texts != (ABSENT,)))
    return Section(("rack",), tuple(blocks))


_SPLINE_BLOCKS = {
    "Teeth": "teeth module pressure_angle profile_shift root length",
    "Diameters": "tip_diameter reference_diameter base_diameter form_diameter form_diameter_max form_diameter_min root_diameter"
    " root_radius bore outer_diameter",
    "Fit": "fit deviation tolerance_actual tolerance_effective",
    "Tooth thickness and space width": " ".join(k for k in symbols.SPLINE if k.startswith(("tooth_thickness", "space_width"))),
    "Inspection": "pin_diameter over_pins over_pins_max over_pins_min between_pins between_pins_max between_pins_min pin_factor"
    " span_teeth span_measurement span_measurement_max span_measurement_min",
}
_JOINT_BLOCKS = {
    "Joint": "designation standard edition nominal_diameter diametral_pitch centring form_clearance",
    "Play, along the reference circle": "effective_play_min effective_play_max actual_play_min actual_play_max backlash_angle",
}


def spline_sections(document: Mapping[str, Any], parts: Iterable[str]) -> tuple[Section, Section]:
    """Return the section of the shaft and the hub of a spline's document, as far as they are there, and that of their joint."""
    columns = tuple(parts)
    of_parts = _spline_blocks("spline", _SPLINE_BLOCKS, [document[part] for part in columns])
    return Section(columns, of_parts), Section((), _spline_blocks("joint", _JOINT_BLOCKS, [document["joint"]]))


def shaft_sections(shafts: Mapping[str, Mapping[str, Any]]) -> Iterator[Section]:
    """Yield the sections of shafts by their names: their sizes, then the segments of each."""
    rows = (_row(f"shaft.{key}", of, [each.get(key) for each in shafts.values()]) for key, of in symbols.SHAFT.items())
    yield Section(tuple(shafts), block("Shafts", (row for row in rows if set(row.texts) != {ABSENT})))
    for name, shaft in shafts.items():
        segments = shaft["segments"]
        rows = (
            Row(f"{name}.{key}", of, tuple(each[key] for each in segments), tuple(f"{each[key]:.6g}" for each in segments))
            for key, of in symbols.SHAFT_SEGMENT.items()
        )
        columns = tuple(f"{name} {number}" for number in range(1, len(segments) + 1))
        yield Section(columns if len(columns) > 1 else (), block("Segments", rows))


def _spline_blocks(owner: str, titles: Mapping[str, str], documents: list[Mapping[str, Any]]) -> tuple[Block, ...]:
    """Return the blocks of titles and keys whose rows some of the documents have."""
    blocks: list[Block] = []
    for title, keys in titles.items():
        rows = (_row(f"{owner}.{key}", symbols.SPLINE[key], [each.get(key) for each in documents]) for key in keys.split())
        blocks += block(title, (row for row in rows if set(row.texts) != {ABSENT}))
    return tuple(blocks)


def _gear_row(key: str, gears: Mapping[str, Mapping[str, Any]]) -> Row:
    row = _row(f"gear.{key}", _OF_GEAR[key], [values.get(key) if _is_there(values, key) else None for values in gears.values()])
    if key != "body.bore":
        return row
    splines = [values.get("body.bore_spline") for values in gears.values()]
    texts = [f"{text} ({spline})" if spline else text for text, spline in zip(row.texts, splines, strict=True)]
    return row._replace(texts=tuple(texts))


def _row(key: str, symbol: symbols.Symbol, values: Any) -> Row:
    return Row(key, symbol, tuple(values), tuple(map(value_text, values)))


def _is_there(values: Mapping[str, Any], key: str) -> bool:
    """Return whether a key applies: not one of a feature of the body, a cutter or a modification that is absent."""
    owner = _BELONGS_TO.get(key, key)
    missing = (None, 0) if owner.startswith("body.") else (None,)
    return "." not in owner or values.get(owner) not in missing


def _in_use(gear: Gear) -> dict[str, Any]:
    """Return the fields of a gear that the sheet shows differently from its document.

    They are modifications that do something, a diametral pitch that was given, and a note that some gauges are for spur rings.
    """
    shown = {"modification": gear.flank_form.in_use} | _given_pitch(gear)
    shown |= _without_root(gear)
    return shown | (_OF_SPUR_RINGS if gear.internal and gear.helix_angle else {})


def _without_root(part: Gear | Rack) -> dict[str, Any]:
    """Return the basic rack without what the tool of `premachining` replaces; nothing where there is none."""
    if not part.premachining.present:
        return {}
    return {"rack": {name: value for name, value in asdict(part.rack).items() if name not in ("dedendum", "root_radius")}}


def _given_pitch(part: Gear | Rack) -> dict[str, Any]:
    """Return the diametral pitch, if it was given."""
    pitch = part.normal_diametral_pitch
    return {"normal_diametral_pitch": pitch if is_given(pitch) else None}
