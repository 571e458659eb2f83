"""Keys that a spec may have, and messages for a key that is not permitted."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from importlib import import_module
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from gearcad.core.quantities import FieldSchema, Words, parts_of, schema_of
from gearcad.core.records import Role
from gearcad.core.symbols import Symbol
from gearcad.geometry import Gear, GearPair, Rack, RackPair, ShiftSplit
from gearcad.geometry.fits import THINNING_OR_ALLOWANCE
from gearcad.geometry.gear_parts import MODULE_OR_PITCH


class DesignKind(Enum):
    """Kind of design that a spec makes.

    The value names the main table of the spec; that of a pinion and a rack is [pair], that of a gearbox [planetary].
    """

    GEAR = "gear"
    PAIR = "pair"
    RACK = "rack"
    RACK_PAIR = "rack_pair"
    TRAIN = "train"
    PLANETARY = "planetary"
    SPLINE = "spline"
    SHAFT = "shaft"
    GEARBOX = "planetary_gearbox"

    @property
    def words(self) -> str:
        """Name of the kind for readers, such as "rack and pinion" or "planetary train"."""
        words = {
            "rack_pair": "rack and pinion",
            "planetary": "planetary train",
            "planetary_gearbox": "gearbox of planetary sets",
        }
        return words.get(self.value, self.value)


if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_MOST_LISTED, _NEAREST, _MOST_KEYS = 12, 5, 30
"""Permitted keys that a line can bear, and of more those that it names; a table's keys that it bears at the most."""

Fields = Mapping[str, Mapping[str, FieldSchema]]
"""Fields of the keys of all tables of a kind of design."""

Cell = int | float | str | tuple[float, ...]
"""Value that both a spec and a cell of a design table can hold."""

PARTS = parts_of(Gear)
RACK_PARTS = parts_of(Rack)
"""Fields of a gear that have fields of their own, and their types."""

MAIN_TABLES = {
    DesignKind.GEAR: ("gear",),
    DesignKind.PAIR: ("pair", *(role.value for role in Role)),
    DesignKind.RACK: ("rack",),
    DesignKind.RACK_PAIR: ("pair", "pinion", "rack"),
    DesignKind.TRAIN: ("train",),
    DesignKind.PLANETARY: ("planetary",),
    DesignKind.SPLINE: ("spline",),
    DesignKind.SHAFT: ("shafts",),
    DesignKind.GEARBOX: ("planetary",),
}
"""The tables without which a spec makes no gear, no rack, no pair of them, no train; the first is what bare keys are of."""

OF_GEAR_PAIRS = ("centre_distance", "centre_distance_tolerance", "axial_offset", "profile_shift_split")
OF_RACK_PAIRS = ("mounting_distance",)
"""Keys of [pair] that only two gears have, and those that only a pinion and a rack have."""

OF_GEARBOXES = {"set", "states"}
"""Keys of [planetary] by which a spec is that of a gearbox of several sets."""


GEARBOX_FILE = "planetary.gearbox"
"""Column of a design table of gearboxes: the spec of which the row changes values."""


def is_gearbox(tables: Mapping[str, Any]) -> bool:
    """Return whether the tables of a spec are those of a gearbox of several planetary sets."""
    main = tables.get("planetary")
    return isinstance(main, Mapping) and bool(OF_GEARBOXES & set(main))


SHAFTS = "shafts"
"""The table of the options of shafts."""

OF_SHAFTS = ("shaft", "bearing", "force")
"""Lists of tables that describe a shaft: its segments, its bearings, and forces on it."""

OF_SHAFTED_GEARS = (*OF_SHAFTS, "mesh_position", "coupling")
"""Keys of a gear of a pair that belong to its shaft."""

RIGID_SHAFTS = "rigid-shafts"
"""Code of the notice that shafts are described, and not taken into account."""


def has_shafts(tables: Mapping[str, Any]) -> bool:
    """Return whether the tables of a pair's spec have anything of shafts."""
    own = (content for role in Role if isinstance(content := tables.get(role.value), Mapping))
    return SHAFTS in tables or any(key in content for content in own for key in OF_SHAFTED_GEARS)


def without_shafts(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the tables of a pair's spec without what is of shafts; as they are where none is described."""
    if not has_shafts(tables):
        return tables
    found = {name: content for name, content in tables.items() if name != SHAFTS}
    for role in Role:
        if isinstance(content := found.get(role.value), Mapping):
            found[role.value] = {key: each for key, each in content.items() if key not in OF_SHAFTED_GEARS}
    return found


OF_SETS = ("sun", "planet", "ring", "planet_2", "sun_2", "ring_2")
"""Tables of the gears of a planetary set; `_2` marks the second of its kind."""

SPEEDS = "speeds"
"""The part of [planetary] whose keys are members."""

_HOMES = {
    "material": "material.Material",
    "load": "load.Load",
    "mounting": "mounting.Mounting",
    "check": "check.options.CheckOptions",
    "mesh": "meshing.options.MeshOptions",
    "dynamics": "dynamics.options.DynamicsOptions",
    "rating": "rating.options.RatingOptions",
    "drawing": "drawing.options.DrawingOptions",
    "verify": "verification.claims.VerificationOptions",
    "modify": "contact.load_range.ModifyOptions",
}


def _kind_beside(table: str) -> type[DataclassInstance]:
    room, _, name = _HOMES[table].rpartition(".")
    kind: type[DataclassInstance] = getattr(import_module(f"gearcad.{room}"), name)
    return kind


Value = TypeVar("Value")


class LazyTable(Mapping[str, Value]):
    """A mapping of `names`; `make` is called once for each value, at its first use."""

    def __init__(self, names: Iterable[str], make: Callable[[str], Value]) -> None:
        self._names, self._make = tuple(names), make
        self._made: dict[str, Value] = {}

    def __getitem__(self, name: str) -> Value:
        if name not in self._made:
            if name not in self._names:
                raise KeyError(name)
            self._made[name] = self._make(name)
        return self._made[name]

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


BESIDE = LazyTable(_HOMES, _kind_beside)
"""Tables beside those of the gears, and the types that they make, imported only for specs that have them."""


def _splines() -> type[DataclassInstance]:
    from gearcad.geometry.spline import SplineJoint

    return SplineJoint


PARTS_BESIDE = LazyTable((*_HOMES, "spline"), lambda table: parts_of(_splines() if table == "spline" else BESIDE[table]))
"""Fields of these, and of a spline, that have fields of their own, and their types."""


@dataclass(frozen=True)
class _OfSpecs:
    """Keys that only specs have: their numbers stand in fields of other names."""

    rack: Annotated[str, Words("named basic rack", "", "ISO 53")] = "ISO53_A"
    profile_shift_split: Annotated[ShiftSplit, Words("how two automatic profile shifts share their sum")] = (
        ShiftSplit.EQUAL_SPECIFIC_SLIDING
    )


def names_of_materials(*owners: str) -> dict[str, FieldSchema]:
    """Return the keys of [material] that name that of one gear."""
    name = schema_of(BESIDE["material"])["name"]
    return {
        owner: replace(name, name=owner, symbol=Symbol("", "", "ISO 6336-5", f"material of {owner}"), default=None)
        for owner in owners
    }


def flat_fields(kind: type[DataclassInstance]) -> Iterator[tuple[str, FieldSchema]]:
    """Yield the keys and fields of a type, those of its parts behind the others, with a dot;
    `rack` alone is the name of one.
    """
    parts = {}
    for name, field in schema_of(kind).items():
        if field.part is None:
            yield name, field
        else:
            parts[name] = field.part
    for part, its in parts.items():
        if part in OF_SPECS:
            yield part, OF_SPECS[part]
        yield from ((f"{part}.{name}", field) for name, field in flat_fields(its))


OF_SPECS = schema_of(_OfSpecs)
GEAR_FIELDS = dict(flat_fields(Gear))


def _own_drawing() -> dict[str, FieldSchema]:
    """Return the keys of a gear: what its own drawing has, which counts before [drawing]."""
    from gearcad.drawing.options import PartDrawing

    return {f"drawing.{key}": field for key, field in schema_of(PartDrawing).items()}


def _own_material() -> dict[str, FieldSchema]:
    """Return the keys of a gear that has mates: its own material, whose fields count before those of [material]."""
    return {f"material.{key}": field for key, field in schema_of(BESIDE["material"]).items()}


def fields_of_mates() -> dict[str, FieldSchema]:
    """Return the fields of a gear that has mates, by their keys."""
    return GEAR_FIELDS | _own_material() | _own_drawing()


_OF_DRAWINGS = ("accuracy_grade", "flank_roughness", "root_roughness")
_PLAIN_SHARED = (*MODULE_OR_PITCH, "helix_angle", "face_width", "tip_alteration", *THINNING_OR_ALLOWANCE, *_OF_DRAWINGS, "tool")
_OF_ONE = ("cutter",)
SHARED = (*_PLAIN_SHARED, *(key for key in GEAR_FIELDS if (part := key.partition(".")[0]) in PARTS and part not in _OF_ONE))
"""Keys of a gear that may stand in [pair] for both; the helix angle there is the pinion's, and no cutter makes both."""

ALTERNATIVES = (MODULE_OR_PITCH, THINNING_OR_ALLOWANCE)
"""Keys of a gear one of which is given: its own counts before any of them that is shared."""


def _fields(table: str) -> dict[str, FieldSchema]:
    if table == "gear":
        return GEAR_FIELDS | _own_drawing()
    if table in ("pinion", "wheel"):
        return fields_of_mates()
    if table == "rack":
        return dict(flat_fields(Rack)) | _own_material() | _own_drawing()
    if table == "pair":
        return _fields_of_pairs()
    if table == "spline":
        return dict(flat_fields(_splines()))
    found = dict(flat_fields(BESIDE[table]))
    return found | names_of_materials("pinion", "wheel", "rack") if table == "material" else found


def _fields_of_pairs() -> dict[str, FieldSchema]:
    pair = schema_of(GearPair)
    return {
        **{key: pair[key] for key in ("name", "centre_distance", "centre_distance_tolerance", "axial_offset")},
        "mounting_distance": schema_of(RackPair)["mounting_distance"],
        "profile_shift_split": OF_SPECS["profile_shift_split"],
        **{key: GEAR_FIELDS[key] for key in SHARED},
    }


FIELDS = LazyTable(("gear", "pair", "pinion", "wheel", "rack", "spline", *_HOMES), _fields)
"""Field of each key of each table; the keys are flattened with dots."""


def field_of(table: str, key: str) -> FieldSchema | None:
    """Return the schema of a key in a table, or None for an unknown key.

    The drawing module is imported only for keys that a gear itself does not have.
    """
    if table in ("gear", "pinion", "wheel") and key in GEAR_FIELDS:
        return GEAR_FIELDS[key]
    return FIELDS[table].get(key)


KEYS = LazyTable(FIELDS, lambda table: tuple(FIELDS[table]))
"""Permitted keys of each table."""

MOVED = {
    "check.pinion_tip_relief": "write pinion.modification.tip_relief and pinion.modification.tip_relief_length (mm)",
    "check.wheel_tip_relief": "write wheel.modification.tip_relief and wheel.modification.tip_relief_length (mm)",
    "check.tip_relief_length": "write modification.tip_relief_length of pair, pinion or wheel, in mm and not in modules",
}
"""New places of keys that earlier specs had."""


def explain_unknown_table(table: str, fields: Fields = FIELDS) -> str:
    """Return the end of the message about a table that is not one of ours."""
    if near := difflib.get_close_matches(table, fields, n=1):
        return f"unknown table; did you mean [{near[0]}]?"
    return f"unknown table; permitted are {', '.join(f'[{name}]' for name in fields)}"


_ALONE = ("gear", "rack", "spline")
"""Tables of designs of one part, or of a spline, whose keys other tables have too."""


def explain_unknown_key(table: str, key: str) -> str:
    """Return the end of the message about a key that `table` does not have: where it belongs, or the nearest one."""
    if (moved := MOVED.get(f"{table}.{key}")) is not None:
        return f"is no key any more: {moved}"
    homes = [f"[{name}]" for name, keys in KEYS.items() if name not in _ALONE and key in keys and key not in KEYS]
    if not homes and key in KEYS["rack"]:
        homes = ["[rack]"]
    if homes and table != "gear":
        return f"unknown key here; it belongs in {' or '.join(homes)}"
    known = KEYS[table]
    inner, _, own = key.rpartition(".")
    if inner and own in known:
        return f"unknown key here; {own} is a key of the table of the gear itself, not of its {inner}"
    if inner and table in ("pinion", "wheel") and own in KEYS["pair"]:
        return "unknown key here; it belongs in [pair]"
    if (near := nearest_of(key, FIELDS[table], known)) is not None:
        return f"unknown key; did you mean {near}?"
    return f"unknown key; {permitted_words(key, known) if len(known) > _MOST_KEYS else 'permitted are ' + ', '.join(known)}"


def permitted_words(key: str, permitted: Collection[str]) -> str:
    """Return words that list the permitted keys. If there are many, list only those nearest to `key`."""
    if len(permitted) <= _MOST_LISTED:
        return f"permitted are {', '.join(permitted)}"
    nearest = difflib.get_close_matches(key, permitted, n=_NEAREST, cutoff=0.0)
    return f"the nearest of the {len(permitted)} permitted are {', '.join(nearest)}"


def nearest_key(key: str, fields: Mapping[str, FieldSchema]) -> str | None:
    """Return the key whose symbol, last word or spelling is nearest."""
    return nearest_of(key, fields, tuple(fields))


def nearest_of(key: str, fields: Mapping[str, FieldSchema], known: tuple[str, ...]) -> str | None:
    """Return the known key of a table whose symbol, last word or spelling is nearest."""
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
