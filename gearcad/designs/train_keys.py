"""Keys of planetary trains and trains, and of the columns of design tables.

The last dot of such a key is the one before the part's own key: a name may have dots, spaces and commas.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, NamedTuple, Self

from gearcad.core.errors import shown
from gearcad.core.quantities import ELSEWHERE, TORQUE, FieldSchema, Words, schema_of
from gearcad.core.records import Role
from gearcad.designs.keys import (
    BESIDE,
    FIELDS,
    GEAR_FIELDS,
    KEYS,
    MOVED,
    OF_SETS,
    OF_SPECS,
    SHARED,
    fields_of_mates,
    flat_fields,
    names_of_materials,
    nearest_key,
    nearest_of,
)
from gearcad.designs.shaft_keys import general_shaft_key, shaft_fields
from gearcad.dynamics.options import OF_PAIRS, OF_TRAINS_OF_PAIRS, DynamicsOptions
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.torque_excitation import TorqueExcitation
from gearcad.dynamics.trains.train import Train
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim, TrainLoad

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def _plain(kind: type[DataclassInstance], *others: str) -> dict[str, FieldSchema]:
    """Return the fields of a type that are no parts, without `others`."""
    return {name: each for name, each in schema_of(kind).items() if each.part is None and name not in others}


_CENTRAL = fields_of_mates() | _plain(Central, "meshes")
_RIM = fields_of_mates() | _plain(Rim)

SET_FIELDS: dict[str, dict[str, FieldSchema]] = {table: _RIM if table.startswith("planet") else _CENTRAL for table in OF_SETS}
"""Fields of the tables of the gears of a set."""

PRE_STAGE: dict[str, FieldSchema] = {
    **{key: field for key, field in FIELDS["pair"].items() if key != "mounting_distance"},
    **_plain(PairStage, "pinion", "wheel"),
    **{f"{role.value}.{key}": field for role in Role for key, field in GEAR_FIELDS.items()},
    **{f"{role.value}.on": schema_of(PairStage)[role.value] for role in Role},
}
"""The keys of a pair before or behind the set; `pinion.on` is the member that its pinion turns with."""

_OF_PAIRS = ("mounting", "modify")
"""Tables that no planetary train has."""

_OF_VIBRATION = ("speed_from", "speed_to", "speeds", "harmonics", "stiffness", "damping_ratio")

PLANETARY: dict[str, dict[str, FieldSchema]] = {
    "planetary": {
        **_plain(PlanetaryTrain, "centrals", "rims", "stages"),
        "profile_shift_split": OF_SPECS["profile_shift_split"],
        **{key: GEAR_FIELDS[key] for key in SHARED},
        **{f"carrier.{key}": field for key, field in _plain(Carrier).items()},
        **{f"pre_stage.{key}": field for key, field in PRE_STAGE.items()},
    },
    **SET_FIELDS,
    **{
        table: dict(flat_fields(kind))
        for table, kind in {**BESIDE, "load": TrainLoad}.items()
        if table not in ("mounting", "modify")
    },
    "dynamics": {key: schema_of(DynamicsOptions)[key] for key in _OF_VIBRATION},
}
PLANETARY["material"] |= names_of_materials(*OF_SETS)
"""The tables of a planetary train, likewise: its [load] is that of the output."""


def explain_unknown_planetary_column(heading: str) -> str:
    """Return the end of the message about a heading of a table of planetary trains that is no key."""
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


MAIN = "train"

ALL = "*"
"""Word in place of a name for all parts of a kind; a part's own value takes precedence."""

TRAIN_PARTS: dict[str, type[DataclassInstance]] = {
    "inertia": Inertia,
    "shaft": Shaft,
    "mesh": ToothMesh,
    "excitation": TorqueExcitation,
}
"""Types of the parts of a train, by the tables of its spec."""

TORQUES = "torques"
"""The part of [train] whose keys are inertias."""

_ELSEWHERE = ("name", "inertias", "shafts", "meshes", "excitations", TORQUES)
"""Fields of a train that no plain key holds."""


@dataclass(frozen=True)
class _OfTorques:
    torques: Annotated[float, TORQUE, Words("torque", "T")]


def _but(kind: type[DataclassInstance], *others: str) -> dict[str, FieldSchema]:
    return {name: field for name, field in schema_of(kind).items() if name not in others}


def _flat(name: str, field: FieldSchema) -> dict[str, FieldSchema]:
    """Return a field, or those of its part with a dot."""
    return {name: field} if field.part is None else {f"{name}.{key}": each for key, each in schema_of(field.part).items()}


TRAIN: dict[str, dict[str, FieldSchema]] = {
    MAIN: _but(Train, *_ELSEWHERE),
    **{table: _but(kind, "name") for table, kind in TRAIN_PARTS.items()},
    "dynamics": {
        key: each
        for name, field in schema_of(DynamicsOptions).items()
        if OF_PAIRS not in field.marks or OF_TRAINS_OF_PAIRS in field.marks
        for key, each in _flat(name, field).items()
    },
}
"""Fields of the keys of each table; keys of parts are without the names."""

_TORQUE = schema_of(_OfTorques)[TORQUES]

PAIR = "pair"
"""Key of a mesh whose own keys are those of a spec of a pair: `mesh.stage 1.pair.pinion.teeth`."""

_TABLES_OF_PAIRS = (*(role.value for role in Role), *BESIDE)
"""Tables of a spec of a pair that may stand in the pair of a mesh; other keys there are those of [pair]."""


@cache
def _fields_in_pairs() -> dict[str, FieldSchema]:
    """Return the fields of all keys in the pair of a mesh; those of lists of shafts as `pinion.shaft[].length`."""
    found = {key: field for key, field in FIELDS[PAIR].items() if key != "name"}
    found |= {f"{table}.{key}": field for table in _TABLES_OF_PAIRS for key, field in FIELDS.get(table, {}).items()}
    owners = tuple(f"{role.value}." for role in Role)
    return found | {key: field for key, field in shaft_fields().items() if key.startswith((*owners, "shafts."))}


def field_in_pair(key: str) -> FieldSchema | None:
    """Return the field of a key in the pair of a mesh, such as `pinion.teeth`, or None."""
    return None if "[]" in key else _fields_in_pairs().get(general_shaft_key(key))


def _in_pair(rest: str) -> tuple[str, str] | None:
    """Return the name of the mesh and the key in its pair of `NAME.pair.KEY`, or None; names may hold that word too."""
    mark = f".{PAIR}."
    for place in (at for at in range(1, len(rest)) if rest.startswith(mark, at)):
        if field_in_pair(rest[place + len(mark) :]) is not None:
            return rest[:place], rest[place + len(mark) :]
    return None


class TrainKey(NamedTuple):
    """A key of a train: of a table, and of the part of this name, "" in [train] and [dynamics]."""

    table: str
    name: str
    field: str

    @classmethod
    def of(cls, key: str) -> Self | None:
        """Return the key in its parts, or None for a key that no train has."""
        table, _, rest = key.partition(".")
        name, _, field = rest.rpartition(".")
        if table == "mesh" and (inside := _in_pair(rest)) is not None:
            return cls(table, inside[0], f"{PAIR}.{inside[1]}")
        if table in TRAIN_PARTS:
            return cls(table, name, field) if name and field in TRAIN[table] else None
        if table == MAIN and rest.startswith(f"{TORQUES}."):
            name = rest[len(TORQUES) + 1 :]
            return cls(MAIN, name, TORQUES) if name else None
        return cls(table, "", rest) if rest in TRAIN.get(table, ()) else None

    def __str__(self) -> str:
        if self.field == TORQUES:
            return f"{MAIN}.{TORQUES}.{self.name}"
        return ".".join(filter(None, self))

    @property
    def schema(self) -> FieldSchema:
        """Schema of the field."""
        if (inside := self.in_pair) and (found := field_in_pair(inside)) is not None:
            return found
        return _TORQUE if self.field == TORQUES else TRAIN[self.table][self.field]

    @property
    def in_pair(self) -> str:
        """Key in the pair of the mesh, such as `pinion.teeth`; "" for a key of the mesh itself and of other parts."""
        return self.field.removeprefix(f"{PAIR}.") if self.table == "mesh" and self.field.startswith(f"{PAIR}.") else ""

    @property
    def general(self) -> str:
        """Key that stands for all parts of its kind, and for all tables of a list of shafts."""
        if self.in_pair:
            return f"{self.table}.{ALL}.{PAIR}.{general_shaft_key(self.in_pair)}"
        return str(self._replace(name=ALL)) if self.name else str(self)


def general_key(key: str) -> str:
    """Return the general key, such as `shaft.*.length` for the key of any shaft's length; a key that belongs to no part is
    unchanged.
    """
    table = key.partition(".")[0]
    found = TrainKey.of(key) if table in TRAIN_PARTS or table == MAIN else None
    return general_shaft_key(key) if found is None else found.general


def explain_unknown_key_of_train(key: str, names: Mapping[str, tuple[str, ...]] | None = None) -> str:
    """Return the end of the message about an unknown key of a train; with `names`, also about a part that this train lacks."""
    table, dot, rest = key.partition(".")
    if rest.startswith(f"{TORQUES}.") and names is not None:
        return _unknown_part("inertia", rest[len(TORQUES) + 1 :], f"{MAIN}.{TORQUES}.{{}}", names)
    near = difflib.get_close_matches(table.lower(), TRAIN, n=1, cutoff=0.75) if dot else []
    if near == ["mesh"] and f".{PAIR}." in rest:
        return _unknown_in_pair(rest, names)
    name, _, field = rest.rpartition(".") if near else ("", "", key)
    table = near[0] if near else ""
    if table in TRAIN_PARTS and field in TRAIN[table] and name and names is not None and name not in _permitted(names[table]):
        return _unknown_part(table, name, f"{table}.{{}}.{field}", names)
    # A key by itself is one of [train] before it is another's.
    for tables in ((table or MAIN,), tuple(TRAIN)):
        if meant := [_full(home, name, spelt, names) for home, spelt in _near(field, tables)]:
            return f"unknown key; did you mean {' or '.join(meant)}?"
    if table:
        return f"unknown key; permitted behind {table}.{'NAME.' if table in TRAIN_PARTS else ''} are {', '.join(TRAIN[table])}"
    return (
        "unknown key; must be one of a train, such as train.model, shaft.NAME.damping_ratio or, for all shafts, shaft.*.modes"
    )


def _unknown_in_pair(rest: str, names: Mapping[str, tuple[str, ...]] | None) -> str:
    """Return the message about a key in the pair of a mesh, of which the pair has none, or the train no such mesh."""
    name, _, inside = rest.partition(f".{PAIR}.")
    if names is not None and name not in _permitted(names["mesh"]):
        return _unknown_part("mesh", name, f"mesh.{{}}.{PAIR}.{inside}", names)
    if found := difflib.get_close_matches(inside, _fields_in_pairs(), n=1, cutoff=0.75):
        return f"unknown key; did you mean mesh.{name}.{PAIR}.{found[0]}?"
    return f"unknown key; must be one of a pair, such as mesh.{name}.{PAIR}.pinion.teeth"


def _unknown_part(table: str, name: str, written: str, names: Mapping[str, tuple[str, ...]]) -> str:
    """Return the message that the train has no part of this name. `written` is the key with a place for a name."""
    known = names[table]
    if near := difflib.get_close_matches(name, known, n=1):
        return f"the train has no {table} {shown(name)}; did you mean {written.format(near[0])}?"
    return f"the train has no {table} {shown(name)}; it has {', '.join(known)}" if known else f"the train has no {table} at all"


def _permitted(known: tuple[str, ...]) -> tuple[str, ...]:
    return (*known, ALL) if known else ()


def _full(table: str, name: str, field: str, names: Mapping[str, tuple[str, ...]] | None) -> str:
    """Return a key, that of all parts where the name is none of them."""
    if table not in TRAIN_PARTS:
        return f"{table}.{field}"
    return f"{table}.{name if name and (names is None or name in names[table]) else ALL}.{field}"


def _near(field: str, tables: Iterable[str]) -> list[tuple[str, str]]:
    """Return the keys of these tables that are spelt so, or else alike, each with its table."""
    known = {key: [home for home in tables if key in TRAIN[home]] for table in tables for key in TRAIN[table]}
    field = field.rpartition(".")[2].lower()
    spelt = [field] if field in known else difflib.get_close_matches(field, known, n=1)
    return [(home, key) for key in spelt for home in known[key]]


_ALL_FIELDS = {
    f"{table}.{key}": field for kind in (PLANETARY, FIELDS) for table, fields in kind.items() for key, field in fields.items()
} | {
    f"{table}.{ALL}.{key}" if table in TRAIN_PARTS else f"{table}.{key}": field
    for table, fields in TRAIN.items()
    for key, field in fields.items()
}
_ALL_FIELDS |= shaft_fields()
_ALL_FIELDS |= {f"mesh.{ALL}.{PAIR}.{key}": field for key, field in _fields_in_pairs().items()}
COUNTS = frozenset(key for key, field in _ALL_FIELDS.items() if field.whole)
LISTS = frozenset(key for key, field in _ALL_FIELDS.items() if field.several)
NESTED = frozenset(key for key, field in _ALL_FIELDS.items() if field.nested)
TEXT_LISTS = frozenset(key for key, field in _ALL_FIELDS.items() if field.texts)
TEXTS = NESTED | frozenset(key for key, field in _ALL_FIELDS.items() if field.text or ELSEWHERE in field.marks)
UNITS = MappingProxyType({key: field.symbol.unit for key, field in _ALL_FIELDS.items() if field.symbol.unit})
"""Units of keys, as documents have them."""
SWITCHES = frozenset(key for key, field in _ALL_FIELDS.items() if field.switch)
"""Full keys of whole numbers, of what may be several numbers (in a cell there is space between them), of lists of lists (a text
in a cell), of lists of texts, of these and words, and of true and false; of a train's parts those of all (`general_key`)."""


_NO_COLUMN = (("gear", "name"), ("pair", "name"), ("rack", "name"))

COLUMNS = {table: tuple(field for field in fields if (table, field) not in _NO_COLUMN) for table, fields in KEYS.items()}
"""Permitted keys of the columns of a design table, by their tables, where the design's own name has a column `name`."""

_USUAL = tuple(table for table in COLUMNS if table not in ("gear", "rack", "spline"))


def nearest_table(name: str) -> str | None:
    """Return the table that was meant by `name`, if any."""
    if name.lower() in TRAIN:
        return name.lower()
    near = difflib.get_close_matches(name.lower(), (*KEYS, *OF_SETS, "planetary"), n=1, cutoff=0.75)
    return near[0] if near else None


def explain_unknown_column(heading: str, main: str) -> str:
    """Return the end of the message about a heading of a design table that is no key;
    bare keys are those of the table `main`.
    """
    if main == "train":
        return explain_unknown_key_of_train(heading)
    if main == "planetary":
        return explain_unknown_planetary_column(heading)
    if heading.lower() == "name":
        return "unknown column; did you mean name?"
    if (moved := MOVED.get(heading)) is not None:
        return f"is no column any more: {moved}"
    first, dot, rest = heading.partition(".")
    table = nearest_table(first) if dot else None
    owner, field = (table, rest) if table else (main, heading)
    # A pair has no [gear], and few have a [rack]; a table with nothing but bare keys may have been meant for pairs.
    owners = [owner, *(name for name in COLUMNS if name != owner and name in (main, *_USUAL))]
    for meant in (field, *(nearest_of(field, FIELDS[name], COLUMNS[name]) for name in owners)):
        if homes := [f"{name}.{meant}" for name in owners if meant in COLUMNS[name]]:
            found = homes[:1] if homes[0].startswith(f"{owner}.") else homes
            return f"unknown column; did you mean {' or '.join(found)}?"
    if table:
        return f"unknown column; permitted behind {table}. are {', '.join(COLUMNS[table])}"
    examples = f"{main}.teeth" if main != "pair" else "pair.normal_module, pinion.teeth"
    return f"unknown column; must be name, or a key of a spec with its table, such as {examples} or load.torque"
