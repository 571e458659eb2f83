"""The geometry data sheet on the screen: words, symbol, unit and value of everything a design derives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from itertools import starmap
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad import symbols
from gearcad.cli.train_sheet import train_lines
from gearcad.designs.cells import nested_text
from gearcad.designs.design import Design, DesignKind
from gearcad.designs.keys import FIELDS, PLANETARY
from gearcad.designs.kinds.planetary import PlanetaryDesign
from gearcad.designs.kinds.train import TrainDesign
from gearcad.errors import format_number
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.derived import is_given
from gearcad.material import Material
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim
from gearcad.rating.options import RatingOptions
from gearcad.schema import symbols_of

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["print_datasheet"]

_OF_GEAR = symbols_of(Gear) | symbols.GEAR
_OF_RACK = symbols_of(Rack) | symbols.RACK
_OF_PAIR = symbols_of(GearPair) | symbols_of(RackPair) | symbols.PAIR | symbols.RACK_PAIR | symbols.DRIVE
_OF_PAIR["tip_clearances.pinion"] = symbols.PAIR["tip_clearances"]._replace(words="tip clearance of the pinion")


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

_PAIR_BLOCKS = {
    "Mesh": "gear_ratio centre_distance reference_centre_distance axial_offset mounting_distance back_distance"
    " shifted_distance zero_backlash_distance pitch_line_height working_transverse_pressure_angle"
    " profile_shift_sum zero_backlash_shift_sum tip_alteration circumferential_backlash normal_backlash axial_force_ratio"
    " tip_clearances.pinion tip_clearances.rack",
    "Backlash within tolerances": "centre_distance_tolerance "
    + " ".join(k for k in _OF_PAIR if k.startswith("backlash_limits.")),
    "Motion": "travel_per_revolution travel_per_degree rack_force rack_speed",
    "Contact": "transverse_contact_ratio usable_contact_ratio overlap_ratio total_contact_ratio common_width.width"
    " common_width.offset contact_line_lengths.minimum contact_line_lengths.mean contact_line_lengths.maximum"
    " active_root_diameter active_root_depth",
    "Line of action, from T1": "path_of_contact.A path_of_contact.B path_of_contact.C path_of_contact.D path_of_contact.E",
    "Free of interference by (negative: it is there)": "interference_margins.involute interference_margins.pinion_fillet"
    " interference_margins.wheel_fillet interference_margins.trochoid interference_margins.radial",
}

_TRAIN_KEYS = (
    "set_type planets input output fixed ratio basic_ratio centre_distance planet_angles positions tip_distance".split()
)
_OF_TRAIN = symbols_of(PlanetaryTrain) | symbols.PLANETARY
_OF_MEMBER = symbols_of(Central) | symbols_of(Rim) | symbols_of(Carrier) | symbols.PLANETARY_MEMBER

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

_ABSENT = "-"

_NOTHING = symbols.Symbol("", "", "", "")

_WIDTH = 12
"""Of a column of values."""

_WIDE = 96
"""Console width from which the column of sources fits."""


_OF_EVERY_RATING = ("standard", "accuracy", "accuracy_grade")
_USUAL_RATING = asdict(RatingOptions())


class _Line(NamedTuple):
    """One line of the sheet and its style on a terminal."""

    text: str
    style: str = ""


def print_datasheet(design: Design, console: Console) -> None:
    """Print the sheet: a column per gear, then the pair, material, load, mounting and rating, then the warnings."""
    from rich.text import Text

    for line in _lines(design, with_source=console.width >= _WIDE):
        # Soft wrap: a narrow window may break a line, but never cut a number.
        console.print(Text(line.text, style=line.style), soft_wrap=True)


def _lines(design: Design, *, with_source: bool) -> Iterator[_Line]:
    document = design.to_dict()
    if isinstance(design, TrainDesign):
        yield from starmap(_Line, train_lines(document))
        yield from _warnings(design)
        return
    gears = {name: _flat(document[name] | _in_use(gear)) for name, gear in design.gears.items()}
    pair = _flat(document.get("pair", {})) | document.get("drive", {})
    yield _Line(f"{design.name}: {_title(design)}", "bold")
    yield _Line("lengths in mm, angles in degrees" + (", clauses of ISO 21771:2007" if with_source else ""), "dim")
    yield _Line("")
    if gears:
        yield _Line(_columns(_NOTHING, gears, with_source=False), "bold")
    for title, keys in _GEAR_BLOCKS.items() if gears else ():
        rows = [(_OF_GEAR[key], [_shown(values, key) for values in gears.values()]) for key in keys.split()]
        if title == "Diameters" and pair:
            rows += [(_OF_PAIR[key], [_value(value) for value in pair[key]]) for key in symbols.PER_GEAR if key in pair]
        yield from _block(title, [row for row in rows if set(row[1]) != {_ABSENT}], with_source)
    if isinstance(rack := design.described.get("rack"), Rack):
        yield from _rack_lines(rack, with_source)
    yield from _pair_lines({"": pair} if pair else {}, with_source)
    if isinstance(design, PlanetaryDesign):
        yield from _train_lines(design.to_dict()["planetary"], with_source)
    fields = PLANETARY if design.kind is DesignKind.PLANETARY else FIELDS
    yield from _material_lines(document, with_source)
    for block in ("load", "mounting", "rating"):
        given = {key: value for key, value in document.get(block, {}).items() if _is_shown(block, key, value)}
        rows = [(fields[block][key].symbol, [_given(value)]) for key, value in given.items()]
        yield from _block(block.capitalize(), rows, with_source)
    yield from _warnings(design)


def _material_lines(document: Mapping[str, Any], with_source: bool) -> Iterator[_Line]:
    """The material of all gears, or a column for each."""
    every = document.get("materials", {})
    if not every and "material" in document:
        every = {"": document["material"]}
    if len(every) > 1:
        yield _Line(_columns(_NOTHING, every, with_source=False), "bold")
    rows = [
        (symbol, [_ABSENT if of[key] is None else _given(of[key]) for of in every.values()])
        for key, symbol in symbols_of(Material).items()
        if any(of[key] is not None for of in every.values())
    ]
    yield from _block("Material", rows, with_source)


def _is_shown(block: str, key: str, value: Any) -> bool:
    """What is there; of the mounting what is not 0, and of the rating, which has much, what is not as ever."""
    if value is None or (block == "mounting" and value == 0):
        return False
    return block != "rating" or key in _OF_EVERY_RATING or value != _USUAL_RATING[key]


def _pair_lines(pairs: Mapping[str, dict[str, Any]], with_source: bool, width: int = _WIDTH) -> Iterator[_Line]:
    """The blocks of pairs, a column each."""
    for title, keys in _PAIR_BLOCKS.items() if pairs else ():
        known = [key for key in keys.split() if any(key in pair for pair in pairs.values())]
        rows = [(_OF_PAIR[key], [_value(pair.get(key)) for pair in pairs.values()]) for key in known]
        yield from _block(title, rows, with_source, width)


def _train_lines(train: Mapping[str, Any], with_source: bool) -> Iterator[_Line]:
    """The blocks of a planetary train: what it is, its members, and a column for each mesh and stage."""
    rows = [(_OF_TRAIN[key], [_train_value(train[key])]) for key in _TRAIN_KEYS if train.get(key) is not None]
    yield from _block("Planetary train", rows, with_source)
    for name, member in train["members"].items():
        given = {key: value for key, value in member.items() if value not in (None, [], 0) or key == "support_stiffness"}
        rows = [(_OF_MEMBER[key], [_train_value(value)]) for key, value in given.items() if value is not None]
        yield from _block(name, [row for row in rows if row[0].words], with_source)
    pairs = {name: _flat(pair) for name, pair in (*train["meshes"].items(), *train["stages"].items())}
    width = max(_WIDTH, *(len(name) + 2 for name in pairs))
    yield _Line(_columns(_NOTHING, pairs, with_source=False, width=width), "bold")
    yield from _pair_lines(pairs, with_source, width)


def _train_value(value: Any) -> str:
    return " ".join(map(format_number, value)) if isinstance(value, list) else _value(value)


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


def _rack_lines(rack: Rack, with_source: bool) -> Iterator[_Line]:
    """The blocks of a rack."""
    values = _flat(rack.to_dict() | _given_pitch(rack))
    yield _Line(_columns(_NOTHING, ["rack"], with_source=False), "bold")
    for title, keys in _RACK_BLOCKS.items():
        rows = [(_OF_RACK[key], [_value(values[key])]) for key in keys.split()]
        yield from _block(title, [row for row in rows if row[1] != [_ABSENT]], with_source)


def _block(title: str, rows: list[tuple[symbols.Symbol, list[str]]], with_source: bool, width: int = _WIDTH) -> Iterator[_Line]:
    if rows:
        yield _Line(title, "bold cyan")
        for symbol, values in rows:
            yield _Line(_columns(symbol, values, with_source=with_source, width=width))
        yield _Line("")


def _columns(symbol: symbols.Symbol, values: Iterable[str], *, with_source: bool, width: int = _WIDTH) -> str:
    """One line of 76 characters, or some more with the source behind."""
    numbers = "".join(f"{value:>{width}}" for value in values)
    line = f"  {symbol.words:<37}{symbol.symbol:<6} {symbol.unit:<6}{numbers}"
    return f"{line:<80}{symbol.source}".rstrip() if with_source else line.rstrip()


def _warnings(design: Design) -> Iterator[_Line]:
    if not design.warnings:
        yield _Line("No warnings.", "green")
        return
    yield _Line(f"Warnings ({len(design.warnings)})", "bold yellow")
    for warning in design.warnings:
        yield _Line(f"  {warning}", "yellow")


def _title(design: Design) -> str:
    if isinstance(rack := design.described.get("rack"), Rack):
        teeth = " / ".join(map(str, [*(gear.teeth for gear in design.gears.values()), rack.teeth]))
        return f"{'helical' if rack.helix_angle else 'spur'} {'pinion and ' if design.gears else ''}rack, z = {teeth}"
    teeth = " / ".join(str(gear.teeth) for gear in design.gears.values())
    if isinstance(design, PlanetaryDesign):
        return f"planetary train of type {design.train.set_type.value}, z = {teeth}"
    double = any(gear.double_helix.present for gear in design.gears.values())
    helical = any(gear.helix_angle for gear in design.gears.values())
    teeth_are = "double helical" if double else "helical" if helical else "spur"
    internal = any(gear.internal for gear in design.gears.values())
    return f"{'internal ' if internal else ''}{teeth_are} {design.kind.value}, z = {teeth}"


def _flat(document: Mapping[str, Any]) -> dict[str, Any]:
    """Nested keys joined by a dot."""
    flat: dict[str, Any] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            flat |= {f"{key}.{inner}": item for inner, item in value.items()}
        else:
            flat[key] = value
    return flat


def _shown(values: Mapping[str, Any], key: str) -> str:
    """The value, or a dash for a feature of the body, a cutter or a modification that is not there."""
    owner = _BELONGS_TO.get(key, key)
    missing = (None, 0) if owner.startswith("body.") else (None,)
    return _ABSENT if "." in owner and values.get(owner) in missing else _value(values.get(key))


def _value(value: Any) -> str:
    """Four digits after the point: 0.1 µm, and enough of a ratio or an angle."""
    if value is None:
        return _ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    # Adding zero turns a rounded -0.0 into a plain one.
    return f"{round(value, 4) + 0.0:.4f}" if isinstance(value, float) else str(value)


def _given(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        if isinstance(value[0], tuple):
            return nested_text(value)
        return " ... ".join(map(format_number, value))
    return value if isinstance(value, str) else format_number(value)
