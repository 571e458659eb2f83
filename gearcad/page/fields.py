"""Fields of the inputs of a spec, as the schema has them, and the shift diagram of a design."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from enum import Enum
from functools import cache, lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.core.errors import GearcadError, SpecError
from gearcad.core.quantities import Choice, FieldSchema, Member, Range, Whole, is_given, schema_of
from gearcad.core.records import Floats, Role
from gearcad.core.symbols import Symbol
from gearcad.designs.cells import list_text, nested_text, texts_cell
from gearcad.designs.design import Design
from gearcad.designs.gear_designs import GearDesign
from gearcad.designs.keys import (
    BESIDE,
    FIELDS,
    MAIN_TABLES,
    OF_GEAR_PAIRS,
    OF_RACK_PAIRS,
    OF_SETS,
    SHAFTS,
    SPEEDS,
    DesignKind,
    Fields,
)
from gearcad.designs.pair_designs import PairDesign, RackPairDesign
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.ranking import gear_tables, ranked_rows
from gearcad.designs.reader import kind_of, type_of
from gearcad.designs.spec import AUTO, CLEAR
from gearcad.geometry import Gear
from gearcad.geometry.gear_parts import NAMED_RACKS
from gearcad.geometry.tool_shelf import Shelf
from gearcad.load import Load
from gearcad.material import GRADED_GROUPS, MaterialQuality
from gearcad.sizing.geometry import Axis, Free, ShiftMap, gear_map, pair_map

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_TITLES = {
    "rack": "Basic rack",
    "shaft": "Splined shaft",
    "hub": "Splined hub",
    "cutter": "Shaper cutter",
    "premachining": "Cut before finishing",
    "finishing": "Finishing of the flanks",
    "making": "As made",
    "modification": "Flank modifications",
}
"""Titles of parts that are not their names."""

_LATER = ("mounting", "mesh", "dynamics", "drawing", "check", "rating", "verify", "modify")
"""Tables that users need later, which the page shows folded if the spec does not have them."""

_OF_PAIRS = ("load", "mounting", "modify")
"""Tables whose defaults no planetary train has."""

_GRADES = tuple(f"{group} {quality}" for group in GRADED_GROUPS for quality in MaterialQuality)
_OFFERED = {"rack": tuple(NAMED_RACKS), "material": _GRADES, "profile_shift": (AUTO,), "tip_alteration": (AUTO, CLEAR)}
"""Words that specs take at keys of these names, beside numbers or names of one's own; tools have names of their own."""

_DIGITS, _USED_DIGITS = 15, 7
"""Significant digits of numbers: all that were typed, and of those that follow what one reads."""

_INTERNAL, _EXTERNAL = ("ring",), ("pinion", "sun", "planet")
"""Gears that have internal, or external teeth in every spec."""

NO_PINION = {"torque": Symbol("T", "N·m", "", "torque"), "speed": Symbol("n", "rpm", "", "speed")}
"""Symbols of the load of a design that has no pinion."""

_OWN_PARTS = tuple(role.value for role in Role)
"""Parts of a family that are seen before any of it is given: the gears of a pair."""

_MEMBERS = ("planetary.input", "planetary.output", "planetary.fixed")


def fields_of(design: Design | None, tables: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The tables of a kind's specs in order, each with its groups of fields: what the browser makes inputs of.

    `tables` are what the spec says; they tell the kind if they make no design. A train's parts are lists of tables, which stand
    in its text only: of a train these are the keys that are of no part.
    """
    kind = kind_of(tables) if design is None else design.kind
    members = members_of(design)
    return [
        {
            "table": table,
            "title": table_title(table),
            "folded": table in _LATER and table not in tables,
            "groups": list(_groups(table, fields, members)),
        }
        for table, fields in _tables(kind, tables, members).items()
    ]


def members_of(design: Design | None) -> tuple[str, ...]:
    """Return the members of a planetary train, each of which can have a speed; none for other designs."""
    return tuple(design.train.members) if isinstance(design, PlanetaryDesign) else ()


@lru_cache(maxsize=64)
def field_keys(kind: DesignKind, members: tuple[str, ...]) -> frozenset[str]:
    """Return the keys of all fields that the specs of a kind have, without gears of a set that only some have."""
    return frozenset(f"{table}.{key}" for table, fields in _tables(kind, {}, members).items() for key in fields)


def ranked_fields(design: Design | None, tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return the inputs that matter most, which the browser shows first: titles of the gears' columns, and keys by rows.

    The fields of these keys are those of `fields_of`; a row of one key is that of all gears.
    """
    kind = kind_of(tables) if design is None else design.kind
    known = {f"{table}.{key}" for table, fields in _tables(kind, tables, ()).items() for key in fields}
    rows = [{"keys": list(row.keys), "shared": row.shared} for row in ranked_rows(kind, tables, known)]
    return {"columns": [table_title(table) for table in gear_tables(kind, tables)], "rows": rows}


def table_title(table: str) -> str:
    """Return the title of a table: its name in words."""
    return table.replace("_", " ").capitalize()


def part_title(part: str) -> str:
    """Return the title of a part of a table."""
    return _TITLES.get(part, table_title(part))


def words_of(key: str, field: FieldSchema) -> str:
    """Return the words for a key: those of its symbol, otherwise its name without underscores."""
    return field.symbol.words or key.rpartition(".")[2].replace("_", " ")


def _speeds(members: tuple[str, ...]) -> dict[str, FieldSchema]:
    """Return fields for the speeds (rpm) of a train's members, which a spec may give in addition to the speed of the input."""
    speed = schema_of(Load)["speed"]
    return {
        f"{SPEEDS}.{each}": replace(speed, name=each, required=False, symbol=Symbol("n", "rpm", "", each)) for each in members
    }


def _tables(kind: DesignKind, tables: Mapping[str, Any], members: tuple[str, ...]) -> Fields:
    if kind is DesignKind.PLANETARY:
        from gearcad.designs.train_keys import PLANETARY

        found = {table: PLANETARY[table] for table in PLANETARY if table not in OF_SETS or table in tables}
        return found | {"planetary": {**found["planetary"], **_speeds(members)}}
    if kind is DesignKind.TRAIN:
        from gearcad.designs.train_keys import MAIN, TRAIN

        return {table: TRAIN[table] for table in (MAIN, "dynamics")}
    if kind is DesignKind.SHAFT:
        from gearcad.shafts.arrangement import ShaftOptions

        return {SHAFTS: schema_of(ShaftOptions)}
    made = type_of(kind)
    beside = [table for table in BESIDE if hasattr(made, table)]
    found = {table: FIELDS[table] for table in (*MAIN_TABLES[kind], *beside)}
    if "pair" in found:
        others = OF_GEAR_PAIRS if kind is DesignKind.RACK_PAIR else OF_RACK_PAIRS
        found["pair"] = {key: field for key, field in found["pair"].items() if key not in others}
    if "load" in found and not found.keys() & {role.value for role in Role}:
        found["load"] = {key: replace(field, symbol=NO_PINION.get(key, field.symbol)) for key, field in found["load"].items()}
    return found


def _groups(table: str, fields: Mapping[str, FieldSchema], members: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    """The fields of a table, those of its parts together, each with the titles of its part.

    A part that has parts of its own is a family with them, of which those inside others are `inner`.
    """
    groups: dict[str, list[dict[str, Any]]] = {"": []}
    for key, field in fields.items():
        groups.setdefault(key.rpartition(".")[0], []).append(_field(f"{table}.{key}", field, members))
    firsts = Counter(part.partition(".")[0] for part in groups)
    for part, of_part in groups.items():
        names = part.split(".") if part else []
        family = names.pop(0) if names and firsts[names[0]] > 1 else ""
        titles = [part_title(each) for each in names]
        inner = bool(family and names) and not (len(names) == 1 and names[0] in _OWN_PARTS)
        yield {"part": part, "family": family and part_title(family), "titles": titles, "inner": inner, "fields": of_part}


def _field(key: str, field: FieldSchema, members: tuple[str, ...]) -> dict[str, Any]:
    """Return the description of one field for the browser. Numbers are typed as text, so that unfinished input is not lost."""
    symbol = field.symbol
    least, most, negative = _bounds(key, field)
    return {
        "key": key,
        "words": words_of(key, field),
        "symbol": symbol.symbol,
        "parts": symbol.parts,
        "unit": "°" if symbol.unit == "deg" else symbol.unit,
        "source": symbol.source,
        "choices": _choices(field),
        "offered": list(members if key in _MEMBERS else (*field.words, *_offered(key))),
        "number": not (field.several or field.nested or field.text),
        "whole": field.whole,
        "least": least,
        "most": most,
        "negative": negative,
        "signed": isinstance(field.permitted, Range) and field.permitted.signed and bool(field.permitted.least),
    }


def _bounds(key: str, field: FieldSchema) -> tuple[float | None, float | None, int | None]:
    """Return the least and the greatest value of a number, or of its size where it has a least size; None for no bound.

    The third is the greatest negative value of a number of teeth that may be an internal gear's too.
    """
    permitted = field.permitted
    if isinstance(permitted, Range):
        if permitted.signed and not permitted.least:
            return None if permitted.most is None else -permitted.most, permitted.most, None
        return permitted.least, permitted.most, None
    if isinstance(permitted, Whole):
        gear, highest = key.split(".")[-2].partition("_")[0], permitted.negative and permitted.negative[0]
        if highest is not None and gear in _INTERNAL:
            return -permitted.most, highest, None
        return permitted.least, permitted.most, None if gear in _EXTERNAL else highest
    return None, None, None


def _offered(key: str) -> tuple[str, ...]:
    table, _, name = key.rpartition(".")
    if name == "tool":
        return tool_names()
    if table in ("gear", "rack"):
        return () if name in ("profile_shift", "tip_alteration") else _OFFERED.get(name, ())
    if table == "material" or table.endswith(".material"):
        return _GRADES if name == "name" or name in (*OF_SETS, "pinion", "wheel", "rack") else ()
    return _OFFERED.get(name, ())


@cache
def tool_names() -> tuple[str, ...]:
    """Return the names of the tools of the user's table, if it can be read, and of that of gearcad."""
    try:
        return tuple(dict.fromkeys(row.name for row in Shelf(Path("/")).rows()))
    except SpecError:
        return tuple(dict.fromkeys(row.name for row in Shelf.own()))


def _choices(field: FieldSchema) -> list[str]:
    """Return the words that a field can hold; empty if it can hold anything else."""
    if field.switch:
        return ["true", "false"]
    if isinstance(field.permitted, Choice):
        return list(field.permitted.words)
    kind = field.choices or (field.permitted.choices if isinstance(field.permitted, Member) else None)
    return [str(member.value) for member in kind] if kind is not None else []


def given_texts(tables: Mapping[str, Any]) -> dict[str, str]:
    """Return the values of a spec as typed text, under dotted keys. Values that no field can hold are left to the text view."""
    return _texts(tables, "")


def used_texts(design: Design, tables: Mapping[str, Any]) -> dict[str, str]:
    """Return the values that a design uses (given, shared, derived or default) under the same keys. Empty fields show them."""
    used = dict(_by_default(design.kind))
    for table, content in design.to_dict().items():
        if isinstance(content, Mapping):
            used |= _texts(content, f"{_named(tables).get(table, table)}.", _USED_DIGITS)
    return used


def _named(tables: Mapping[str, Any]) -> dict[str, str]:
    """The tables of a train's gears by the names that their users gave them: documents have them under these."""
    named = {table: tables[table].get("name") for table in OF_SETS if isinstance(tables.get(table), Mapping)}
    return {name: table for table, name in named.items() if isinstance(name, str)}


@cache
def _by_default(kind: DesignKind) -> Mapping[str, str]:
    """Return the default values, as typed text, of tables that stand beside a gear."""
    made: dict[str, str] = {}
    for table in BESIDE if kind is not DesignKind.PLANETARY else [each for each in BESIDE if each not in _OF_PAIRS]:
        made |= _texts(_defaults(BESIDE[table]), f"{table}.")
    return MappingProxyType(made)


def _defaults(kind: type[DataclassInstance]) -> dict[str, Any]:
    """The defaults of a type's fields that have one."""
    return {each.name: each.default for each in fields(kind) if each.default is not MISSING and each.default is not None}


def _texts(content: Mapping[str, Any], before: str, digits: int = _DIGITS) -> dict[str, str]:
    return {key: text for key, value in _flat(content, before) if (text := _typed(key, value, digits)) is not None}


def _flat(content: Mapping[str, Any], before: str) -> Iterator[tuple[str, Any]]:
    for name, value in content.items():
        key = f"{before}{name}"
        if isinstance(value, Mapping):
            yield from _flat(value, f"{key}.")
        else:
            yield key, value


def _typed(key: str, value: Any, digits: int) -> str | None:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, str | int):
        return str(value)
    if isinstance(value, float):
        return repr(float(f"{value:.{digits}g}") + 0.0).removesuffix(".0")
    if isinstance(value, list | tuple) and value:
        try:
            if all(isinstance(each, int | float) for each in value):
                return list_text(value)
            if all(isinstance(each, list | tuple) for each in value) and not isinstance(value[0][0], str):
                return nested_text(value)
            return texts_cell(value, key)
        except (GearcadError, IndexError, TypeError):
            return None
    return None


_SIZE = 49
"""Values of an axis: between them lines are straight."""

_SHIFTS, _HELIX, _TEETH = (-0.8, 1.4), (0.0, 30.0), (5, 60)
"""Least ranges of the axes: profile shift, helix angle (degrees), number of teeth."""


@dataclass(frozen=True)
class Variable:
    """An input that the user moves: its value, its keys with the sign under each, and the range in which it is shown."""

    free: Free
    value: float
    keys: Mapping[str, int]
    least: float
    most: float

    @property
    def step(self) -> float:
        """Change of the value in one step: 1 tooth, 0.1 degrees, or 0.01 for other inputs."""
        return {Free.TEETH: 1.0, Free.HELIX: 0.1}.get(self.free, 0.01)

    def typed(self, value: float) -> dict[str, str]:
        """Return the text that the user would type for another value, under each of its keys."""
        if self.free is Free.TEETH:
            return {key: str(round(value)) for key in self.keys}
        digits = 1 if self.free is Free.HELIX else 3
        return {key: repr(round(sign * value, digits) + 0.0) for key, sign in self.keys.items()}

    @property
    def axis(self) -> Axis:
        """The values that a map has of it."""
        return Axis(self.free, _between(self.least, self.most))


@dataclass(frozen=True)
class LimitMap:
    """A map, the variables across and up in it, and the variables that the user moves beside it."""

    map: ShiftMap
    across: Variable
    up: Variable
    others: tuple[Variable, ...]

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All that one moves: the axes first."""
        return (self.across, self.up, *self.others)


LIMITED = (DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK_PAIR)
"""Kinds of designs that have a shift diagram."""


def limit_map(design: Design, tables: Mapping[str, Any]) -> LimitMap | None:
    """The shift diagram of a design, whose spec has these tables; None for a kind that has none."""
    try:
        if isinstance(design, PairDesign):
            return _of_pair(design, tables)
        if isinstance(design, GearDesign):
            return _of_gear(design.gear, "gear", _helix(design.gear, {"gear.helix_angle": 1}))
        if isinstance(design, RackPairDesign):
            return _of_gear(design.gears["pinion"], "pinion", None)
    except GearcadError:
        pass
    return None


def _of_gear(gear: Gear, table: str, helix: Variable | None) -> LimitMap:
    most = max(_TEETH[1], math.ceil(gear.teeth * 1.2 / 20) * 20)
    teeth = Variable(Free.TEETH, gear.teeth, {f"{table}.teeth": 1}, min(_TEETH[0], gear.teeth), most)
    shift = _shift(Free.FIRST, gear, f"{table}.profile_shift")
    found = gear_map(gear, teeth.axis.values, shift.axis.values)
    return LimitMap(found, teeth, shift, () if helix is None else (helix,))


def _of_pair(design: PairDesign, tables: Mapping[str, Any]) -> LimitMap:
    pair, own = design.pair, {role: _table(tables, role.value) for role in Role}
    shifts = {
        Role.PINION: _shift(Free.FIRST, pair.pinion, "pinion.profile_shift"),
        Role.WHEEL: _shift(Free.SECOND, pair.wheel, "wheel.profile_shift"),
    }
    helix = _helix(pair.pinion, _helix_keys(tables, mirrored=1 if pair.internal else -1))
    tips = [table.get("tip_alteration", _table(tables, "pair").get("tip_alteration", AUTO)) for table in own.values()]
    options = {"distance": is_given(pair.centre_distance), "auto_tips": tips == [AUTO, AUTO]}
    automatic = [role for role in Role if own[role].get("profile_shift") == AUTO]
    if automatic:
        rest = automatic[-1]
        across = shifts[rest.mate]
        return LimitMap(pair_map(pair, across.axis, helix.axis, rest=rest, **options), across, helix, ())
    across, up = shifts[Role.PINION], shifts[Role.WHEEL]
    return LimitMap(pair_map(pair, across.axis, up.axis, rest=None, **options), across, up, (helix,))


def _shift(free: Free, gear: Gear, key: str) -> Variable:
    x = gear.profile_shift
    least, most = min(_SHIFTS[0], math.floor(2 * x) / 2 - 0.3), max(_SHIFTS[1], math.ceil(2 * x) / 2 + 0.4)
    return Variable(free, x, {key: 1}, least, most)


def _helix(gear: Gear, keys: Mapping[str, int]) -> Variable:
    """Return the variable for the magnitude of a helix angle (degrees); the hand stays."""
    hand, size = (-1 if gear.helix_angle < 0 else 1), abs(gear.helix_angle)
    most = max(_HELIX[1], math.ceil(size / 10) * 10)
    return Variable(Free.HELIX, size, {key: hand * sign for key, sign in keys.items()}, _HELIX[0], most)


def _helix_keys(tables: Mapping[str, Any], mirrored: int) -> dict[str, int]:
    """Return the keys under which the spec of a pair has, or would have, its helix angle, with the sign under each."""
    signs = {"pinion": 1, "wheel": mirrored}
    of_gears = {f"{table}.helix_angle": sign for table, sign in signs.items() if "helix_angle" in _table(tables, table)}
    return of_gears or {"pair.helix_angle": 1}


def _table(tables: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = tables.get(name)
    return table if isinstance(table, Mapping) else {}


def _between(least: float, most: float) -> Floats:
    return np.linspace(least, most, _SIZE)
