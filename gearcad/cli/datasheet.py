"""The geometry data sheet on the screen: words, symbol, unit and value of everything a design derives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from gearcad import symbols
from gearcad.cli.sheet_lines import ABSENT, NOTHING, OF_PAIR, Line, block, columns, flattened, pair_lines, value_text
from gearcad.designs.design import Design, DesignKind
from gearcad.designs.keys import BESIDE, FIELDS, Fields
from gearcad.errors import format_number
from gearcad.geometry import Gear, Rack
from gearcad.geometry.derived import is_given
from gearcad.material import Material
from gearcad.schema import symbols_of

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["plain_datasheet", "print_datasheet"]

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

_WIDE = 96
"""Console width from which the column of sources fits."""


_OF_EVERY_RATING = ("standard", "accuracy", "accuracy_grade")


def plain_datasheet(design: Design, width: int) -> str:
    """The sheet as `print_datasheet` prints it on what knows no styles, for a window of so many characters."""
    return "".join(f"{line.text}\n" for line in _lines(design, with_source=width >= _WIDE))


def print_datasheet(design: Design, console: Console) -> None:
    """Print the sheet: a column per gear, then the pair, material, load, mounting and rating, then the warnings."""
    from rich.text import Text

    for line in _lines(design, with_source=console.width >= _WIDE):
        # Soft wrap: a narrow window may break a line, but never cut a number.
        console.print(Text(line.text, style=line.style), soft_wrap=True)


def _lines(design: Design, *, with_source: bool) -> Iterator[Line]:
    document = design.to_dict()
    if design.kind is DesignKind.TRAIN:
        from gearcad.cli.train_sheet import train_lines

        yield from (Line(*each) for each in train_lines(document))
        yield from _warnings(design)
        return
    gears = {name: flattened(document[name] | _in_use(gear)) for name, gear in design.gears.items()}
    pair = flattened(document.get("pair", {})) | document.get("drive", {})
    yield Line(f"{design.name}: {_title(design, document)}", "bold")
    yield Line("lengths in mm, angles in degrees" + (", clauses of ISO 21771:2007" if with_source else ""), "dim")
    yield Line("")
    if gears:
        yield Line(columns(NOTHING, gears, with_source=False), "bold")
    for title, keys in _GEAR_BLOCKS.items() if gears else ():
        rows = [(_OF_GEAR[key], [_shown(values, key) for values in gears.values()]) for key in keys.split()]
        if title == "Diameters" and pair:
            rows += [(OF_PAIR[key], [value_text(value) for value in pair[key]]) for key in symbols.PER_GEAR if key in pair]
        yield from block(title, [row for row in rows if set(row[1]) != {ABSENT}], with_source)
    if isinstance(rack := design.described.get("rack"), Rack):
        yield from _rack_lines(rack, with_source)
    yield from pair_lines({"": pair} if pair else {}, with_source)
    fields: Fields = FIELDS
    if design.kind is DesignKind.PLANETARY:
        from gearcad.cli.planetary_sheet import planetary_lines
        from gearcad.designs.planetary_keys import PLANETARY as fields

        yield from planetary_lines(document["planetary"], with_source)
    yield from _material_lines(document, with_source)
    for table in ("load", "mounting", "rating"):
        rows = [
            (fields[table][key].symbol, [_given(value)]) for key, value in _shown_of(table, document.get(table, {})).items()
        ]
        yield from block(table.capitalize(), rows, with_source)
    yield from _warnings(design)


def _material_lines(document: Mapping[str, Any], with_source: bool) -> Iterator[Line]:
    """The material of all gears, or a column for each."""
    every = document.get("materials", {})
    if not every and "material" in document:
        every = {"": document["material"]}
    if not every:
        return
    if len(every) > 1:
        yield Line(columns(NOTHING, every, with_source=False), "bold")
    rows = [
        (symbol, [ABSENT if of[key] is None else _given(of[key]) for of in every.values()])
        for key, symbol in symbols_of(Material).items()
        if any(of[key] is not None for of in every.values())
    ]
    yield from block("Material", rows, with_source)


def _shown_of(table: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """What is there; of the mounting what is not 0, and of the rating, which has much, what is not as ever."""
    there = {key: value for key, value in values.items() if value is not None and not (table == "mounting" and value == 0)}
    if table != "rating" or not there:
        return there
    usual = asdict(BESIDE["rating"]())
    return {key: value for key, value in there.items() if key in _OF_EVERY_RATING or value != usual[key]}


def _in_use(gear: Gear) -> dict[str, Any]:
    """What the sheet shows of a gear otherwise than its document.

    Modifications that do something, a diametral pitch that was given, and that some gauges are for spur rings.
    """
    shown = {"modification": gear.modification.in_use} | _given_pitch(gear)
    return shown | (_OF_SPUR_RINGS if gear.internal and gear.helix_angle else {})


def _given_pitch(part: Gear | Rack) -> dict[str, Any]:
    """The diametral pitch, if it was given."""
    pitch = part.normal_diametral_pitch
    return {"normal_diametral_pitch": pitch if is_given(pitch) else None}


def _rack_lines(rack: Rack, with_source: bool) -> Iterator[Line]:
    """The blocks of a rack."""
    values = flattened(rack.to_dict() | _given_pitch(rack))
    yield Line(columns(NOTHING, ["rack"], with_source=False), "bold")
    for title, keys in _RACK_BLOCKS.items():
        rows = [(_OF_RACK[key], [value_text(values[key])]) for key in keys.split()]
        yield from block(title, [row for row in rows if row[1] != [ABSENT]], with_source)


def _warnings(design: Design) -> Iterator[Line]:
    if not design.warnings:
        yield Line("No warnings.", "green")
        return
    yield Line(f"Warnings ({len(design.warnings)})", "bold yellow")
    for warning in design.warnings:
        yield Line(f"  {warning}", "yellow")


def _title(design: Design, document: Mapping[str, Any]) -> str:
    if isinstance(rack := design.described.get("rack"), Rack):
        teeth = " / ".join(map(str, [*(gear.teeth for gear in design.gears.values()), rack.teeth]))
        return f"{'helical' if rack.helix_angle else 'spur'} {'pinion and ' if design.gears else ''}rack, z = {teeth}"
    teeth = " / ".join(str(gear.teeth) for gear in design.gears.values())
    if design.kind is DesignKind.PLANETARY:
        return f"planetary train of type {document['planetary']['set_type']}, z = {teeth}"
    double = any(gear.double_helix.present for gear in design.gears.values())
    helical = any(gear.helix_angle for gear in design.gears.values())
    teeth_are = "double helical" if double else "helical" if helical else "spur"
    internal = any(gear.internal for gear in design.gears.values())
    return f"{'internal ' if internal else ''}{teeth_are} {design.kind.value}, z = {teeth}"


def _shown(values: Mapping[str, Any], key: str) -> str:
    """The value, or a dash for a feature of the body, a cutter or a modification that is not there."""
    owner = _BELONGS_TO.get(key, key)
    missing = (None, 0) if owner.startswith("body.") else (None,)
    return ABSENT if "." in owner and values.get(owner) in missing else value_text(values.get(key))


def _given(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        if isinstance(value[0], tuple):
            from gearcad.designs.cells import nested_text

            return nested_text(value)
        return " ... ".join(map(format_number, value))
    return value if isinstance(value, str) else format_number(value)
