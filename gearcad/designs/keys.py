"""Which keys a spec may have, and what to say about one that it may not."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

from gearcad.check.options import CheckOptions
from gearcad.designs.design import DesignKind
from gearcad.designs.train_keys import ALL, TRAIN, explain_unknown_key_of_train
from gearcad.designs.train_keys import PARTS as TRAIN_PARTS
from gearcad.drawing.options import DrawingOptions, PartDrawing
from gearcad.dynamics.options import DynamicsOptions
from gearcad.geometry import Gear, GearPair, Rack, RackPair, ShiftSplit
from gearcad.geometry.diametral import MODULE_OR_PITCH
from gearcad.geometry.tooth_allowance import THINNING_OR_ALLOWANCE
from gearcad.load import Load
from gearcad.material import Material
from gearcad.meshing.options import MeshOptions
from gearcad.mounting import Mounting
from gearcad.per_gear import Role
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim, TrainLoad
from gearcad.rating.options import RatingOptions
from gearcad.schema import ELSEWHERE, FieldSchema, Words, parts_of, schema_of
from gearcad.symbols import Symbol

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = [
    "ALTERNATIVES",
    "BESIDE",
    "COLUMNS",
    "COUNTS",
    "FIELDS",
    "KEYS",
    "LISTS",
    "MAIN_TABLES",
    "NESTED",
    "OF_SETS",
    "OWN_MATERIAL",
    "PARTS",
    "PARTS_BESIDE",
    "PLANETARY",
    "PRE_STAGE",
    "SHARED",
    "SPEEDS",
    "SWITCHES",
    "TEXTS",
    "TEXT_LISTS",
    "Cell",
    "Fields",
    "explain_unknown_column",
    "explain_unknown_key",
    "explain_unknown_planetary_column",
    "explain_unknown_table",
    "nearest_key",
    "nearest_table",
    "permitted_words",
]

_MOST_LISTED, _NEAREST, _MOST_KEYS = 12, 5, 30
"""Permitted keys that a line can bear, and of more those that it names; a table's keys that it bears at the most."""

Fields = Mapping[str, Mapping[str, FieldSchema]]
"""What the keys of the tables of a kind of designs say of themselves."""

Cell = int | float | str | tuple[float, ...]
"""What a spec and a cell of a design table can both hold."""

PARTS = parts_of(Gear)
"""Fields of a gear that have fields of their own, and their types."""

MAIN_TABLES = {
    DesignKind.GEAR: ("gear",),
    DesignKind.PAIR: ("pair", *(role.value for role in Role)),
    DesignKind.RACK: ("rack",),
    DesignKind.RACK_PAIR: ("pair", "pinion", "rack"),
    DesignKind.TRAIN: ("train",),
    DesignKind.PLANETARY: ("planetary",),
}
"""The tables without which a spec makes no gear, no rack, no pair of them, no train; the first is what bare keys are of."""

BESIDE: dict[str, type[DataclassInstance]] = {
    "material": Material,
    "load": Load,
    "mounting": Mounting,
    "check": CheckOptions,
    "mesh": MeshOptions,
    "dynamics": DynamicsOptions,
    "rating": RatingOptions,
    "drawing": DrawingOptions,
}
"""The tables that stand beside those of the gears, and what they make."""

PARTS_BESIDE = {table: parts_of(kind) for table, kind in BESIDE.items()}
"""Fields of these that have fields of their own, and their types."""


@dataclass(frozen=True)
class _OfSpecs:
    """Keys that only specs have: their numbers stand in fields of other names."""

    rack: Annotated[str, Words("named basic rack", "", "ISO 53")] = "ISO53_A"
    profile_shift_split: Annotated[ShiftSplit, Words("how two automatic profile shifts share their sum")] = (
        ShiftSplit.EQUAL_SPECIFIC_SLIDING
    )


def _names_of_materials(*owners: str) -> dict[str, FieldSchema]:
    """Keys of [material] that name that of one gear."""
    name = schema_of(Material)["name"]
    return {owner: replace(name, name=owner, symbol=Symbol("", "", "ISO 6336-5", f"material of {owner}")) for owner in owners}


def _flat(kind: type[DataclassInstance]) -> Iterator[tuple[str, FieldSchema]]:
    """Keys and fields of a type, those of its parts behind the others, with a dot; `rack` alone is the name of one."""
    parts = {}
    for name, field in schema_of(kind).items():
        if field.part is None:
            yield name, field
        else:
            parts[name] = field.part
    for part, its in parts.items():
        if part in _OF_SPECS:
            yield part, _OF_SPECS[part]
        yield from ((f"{part}.{name}", field) for name, field in _flat(its))


_OF_SPECS = schema_of(_OfSpecs)
_GEAR = dict(_flat(Gear))

OWN_MATERIAL = {f"material.{key}": field for key, field in schema_of(Material).items()}
"""Keys of a gear that has mates: its own material, whose fields count before those of [material]."""

OWN_DRAWING = {f"drawing.{key}": field for key, field in schema_of(PartDrawing).items()}
"""Keys of a gear: what its own drawing has, which counts before [drawing]."""

_OF_PAIRS = _GEAR | OWN_MATERIAL | OWN_DRAWING
_PAIR = schema_of(GearPair)
_RACK = dict(_flat(Rack))

_OF_DRAWINGS = ("accuracy_grade", "flank_roughness", "root_roughness")
_PLAIN_SHARED = (*MODULE_OR_PITCH, "helix_angle", "face_width", "tip_alteration", *THINNING_OR_ALLOWANCE, *_OF_DRAWINGS)
_OF_ONE = ("cutter",)
SHARED = (*_PLAIN_SHARED, *(key for key in _GEAR if (part := key.partition(".")[0]) in PARTS and part not in _OF_ONE))
"""Keys of a gear that may stand in [pair] for both; the helix angle there is the pinion's, and no cutter makes both."""

ALTERNATIVES = (MODULE_OR_PITCH, THINNING_OR_ALLOWANCE)
"""Keys of a gear one of which is given: its own counts before any of them that is shared."""

FIELDS: dict[str, dict[str, FieldSchema]] = {
    "gear": _GEAR | OWN_DRAWING,
    "pair": {key: _PAIR[key] for key in ("name", "centre_distance", "centre_distance_tolerance", "axial_offset")}
    | {"mounting_distance": schema_of(RackPair)["mounting_distance"]}
    | {"profile_shift_split": _OF_SPECS["profile_shift_split"]}
    | {key: _GEAR[key] for key in SHARED},
    "pinion": _OF_PAIRS,
    "wheel": _OF_PAIRS,
    "rack": _RACK | OWN_MATERIAL | OWN_DRAWING,
    **{table: dict(_flat(kind)) for table, kind in BESIDE.items()},
}
FIELDS["material"] |= _names_of_materials("pinion", "wheel", "rack")
"""What each key of each table says of itself, the keys flattened with dots."""

KEYS = {table: tuple(fields) for table, fields in FIELDS.items()}
"""Permitted keys of each table."""


def _plain(kind: type[DataclassInstance], *others: str) -> dict[str, FieldSchema]:
    """The fields of a type that are no parts, without `others`."""
    return {name: each for name, each in schema_of(kind).items() if each.part is None and name not in others}


_CENTRAL = _OF_PAIRS | _plain(Central, "meshes")
_RIM = _OF_PAIRS | _plain(Rim)

OF_SETS: dict[str, dict[str, FieldSchema]] = {
    "sun": _CENTRAL,
    "planet": _RIM,
    "ring": _CENTRAL,
    "planet_2": _RIM,
    "sun_2": _CENTRAL,
    "ring_2": _CENTRAL,
}
"""The tables of the gears of a set of planets; `_2` is the second of its kind."""

PRE_STAGE: dict[str, FieldSchema] = {
    **{key: field for key, field in FIELDS["pair"].items() if key != "mounting_distance"},
    **_plain(PairStage, "pinion", "wheel"),
    **{f"{role.value}.{key}": field for role in Role for key, field in _GEAR.items()},
    **{f"{role.value}.on": schema_of(PairStage)[role.value] for role in Role},
}
"""The keys of a pair before or behind the set; `pinion.on` is the member that its pinion turns with."""

SPEEDS = "speeds"
"""The part of [planetary] whose keys are members."""

_OF_VIBRATION = ("speed_from", "speed_to", "speeds", "harmonics", "stiffness", "damping_ratio")

PLANETARY: dict[str, dict[str, FieldSchema]] = {
    "planetary": {
        **_plain(PlanetaryTrain, "centrals", "rims", "stages"),
        "profile_shift_split": _OF_SPECS["profile_shift_split"],
        **{key: _GEAR[key] for key in SHARED},
        **{f"carrier.{key}": field for key, field in _plain(Carrier).items()},
        **{f"pre_stage.{key}": field for key, field in PRE_STAGE.items()},
    },
    **OF_SETS,
    **{table: dict(_flat(kind)) for table, kind in {**BESIDE, "load": TrainLoad}.items() if table != "mounting"},
    "dynamics": {key: schema_of(DynamicsOptions)[key] for key in _OF_VIBRATION},
}
PLANETARY["material"] |= _names_of_materials(*OF_SETS)
"""The tables of a planetary train, likewise: its [load] is that of the output."""

_EACH = {
    f"{table}.{key}": field for kind in (PLANETARY, FIELDS) for table, fields in kind.items() for key, field in fields.items()
} | {
    f"{table}.{ALL}.{key}" if table in TRAIN_PARTS else f"{table}.{key}": field
    for table, fields in TRAIN.items()
    for key, field in fields.items()
}
COUNTS = frozenset(key for key, field in _EACH.items() if field.whole)
LISTS = frozenset(key for key, field in _EACH.items() if field.several)
NESTED = frozenset(key for key, field in _EACH.items() if field.nested)
TEXT_LISTS = frozenset(key for key, field in _EACH.items() if field.texts)
TEXTS = NESTED | frozenset(key for key, field in _EACH.items() if field.text or ELSEWHERE in field.marks)
SWITCHES = frozenset(key for key, field in _EACH.items() if field.members == (bool,))
"""Full keys of whole numbers, of what may be several numbers (in a cell there is space between them), of lists of lists (a text
in a cell), of lists of texts, of these and words, and of true and false; of a train's parts those of all (`general_key`)."""

_MOVED = {
    "check.pinion_tip_relief": "write pinion.modification.tip_relief and pinion.modification.tip_relief_length (mm)",
    "check.wheel_tip_relief": "write wheel.modification.tip_relief and wheel.modification.tip_relief_length (mm)",
    "check.tip_relief_length": "write modification.tip_relief_length of pair, pinion or wheel, in mm and not in modules",
}
"""Where keys of earlier specs went."""

_NO_COLUMN = (("gear", "name"), ("pair", "name"), ("rack", "name"))

COLUMNS = {table: tuple(field for field in fields if (table, field) not in _NO_COLUMN) for table, fields in KEYS.items()}
"""The same for the columns of a design table, where the design's own name has a column `name`."""

_USUAL = tuple(table for table in COLUMNS if table not in ("gear", "rack"))


def explain_unknown_table(table: str, fields: Fields = FIELDS) -> str:
    """The end of the message about a table that is not one of ours."""
    if near := difflib.get_close_matches(table, fields, n=1):
        return f"unknown table; did you mean [{near[0]}]?"
    return f"unknown table; permitted are {', '.join(f'[{name}]' for name in fields)}"


def explain_unknown_key(table: str, key: str) -> str:
    """The end of the message about a key that `table` does not have: where it belongs, or the nearest one."""
    if (moved := _MOVED.get(f"{table}.{key}")) is not None:
        return f"is no key any more: {moved}"
    homes = [f"[{name}]" for name, keys in KEYS.items() if key in keys and name not in ("gear", "rack") and key not in KEYS]
    if not homes and key in KEYS["rack"]:
        homes = ["[rack]"]
    if homes and table != "gear":
        return f"unknown key here; it belongs in {' or '.join(homes)}"
    known = KEYS[table]
    if (near := _nearest(key, FIELDS[table], known)) is not None:
        return f"unknown key; did you mean {near}?"
    return f"unknown key; {permitted_words(key, known) if len(known) > _MOST_KEYS else 'permitted are ' + ', '.join(known)}"


def permitted_words(key: str, permitted: Collection[str]) -> str:
    """What may stand in the place of a key that is like none: of many the nearest."""
    if len(permitted) <= _MOST_LISTED:
        return f"permitted are {', '.join(permitted)}"
    nearest = difflib.get_close_matches(key, permitted, n=_NEAREST, cutoff=0.0)
    return f"the nearest of the {len(permitted)} permitted are {', '.join(nearest)}"


def nearest_key(key: str, fields: Mapping[str, FieldSchema]) -> str | None:
    """The key whose symbol, last word or spelling is nearest."""
    return _nearest(key, fields, tuple(fields))


def _nearest(key: str, fields: Mapping[str, FieldSchema], known: tuple[str, ...]) -> str | None:
    """The known key of a table whose symbol, last word or spelling is nearest."""
    by_symbol = {fields[name].symbol.symbol: name for name in known if fields[name].symbol.symbol}
    by_tail = {name.rpartition(".")[2]: name for name in reversed(known)}
    if key in by_symbol:
        return by_symbol[key]
    part, dot, _ = key.partition(".")
    beside = {name: name for name in known if dot and name.startswith(f"{part}.")}
    for spellings in (beside, by_tail, {name: name for name in known}):
        if near := difflib.get_close_matches(key.lower(), spellings, n=1):
            return spellings[near[0]]
    return None


def nearest_table(name: str) -> str | None:
    """The table that was meant by `name`, if any."""
    if name.lower() in TRAIN:
        return name.lower()
    near = difflib.get_close_matches(name.lower(), (*KEYS, *OF_SETS, "planetary"), n=1, cutoff=0.75)
    return near[0] if near else None


def explain_unknown_planetary_column(heading: str) -> str:
    """The end of the message about a heading of a table of planetary trains that is no key."""
    first, dot, rest = heading.partition(".")
    near = difflib.get_close_matches(first.lower(), PLANETARY, n=1, cutoff=0.75) if dot else []
    table, field = (near[0], rest) if near else ("planetary", heading)
    if heading.lower() == "name":
        return "unknown column; did you mean name?"
    for meant in (field, nearest_key(field, PLANETARY[table])):
        homes = [f"{owner}.{meant}" for owner in dict.fromkeys((table, *PLANETARY)) if meant in PLANETARY[owner]]
        if homes:
            found = homes[:1] if homes[0].startswith(f"{table}.") else homes
            return f"unknown column; did you mean {' or '.join(found)}?"
    return "unknown column; must be name, or a key of a spec with its table, such as planetary.planets or sun.teeth"


def explain_unknown_column(heading: str, main: str) -> str:
    """The end of the message about a heading of a design table that is no key; bare keys are those of the table `main`."""
    if main == "train":
        return explain_unknown_key_of_train(heading)
    if main == "planetary":
        return explain_unknown_planetary_column(heading)
    if heading.lower() == "name":
        return "unknown column; did you mean name?"
    if (moved := _MOVED.get(heading)) is not None:
        return f"is no column any more: {moved}"
    first, dot, rest = heading.partition(".")
    table = nearest_table(first) if dot else None
    owner, field = (table, rest) if table else (main, heading)
    # A pair has no [gear], and few have a [rack]; a table with nothing but bare keys may have been meant for pairs.
    owners = [owner, *(name for name in COLUMNS if name != owner and name in (main, *_USUAL))]
    for meant in (field, *(_nearest(field, FIELDS[name], COLUMNS[name]) for name in owners)):
        if homes := [f"{name}.{meant}" for name in owners if meant in COLUMNS[name]]:
            found = homes[:1] if homes[0].startswith(f"{owner}.") else homes
            return f"unknown column; did you mean {' or '.join(found)}?"
    if table:
        return f"unknown column; permitted behind {table}. are {', '.join(COLUMNS[table])}"
    examples = f"{main}.teeth" if main != "pair" else "pair.normal_module, pinion.teeth"
    return f"unknown column; must be name, or a key of a spec with its table, such as {examples} or load.torque"
