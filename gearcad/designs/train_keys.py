"""The keys of a train in tables and studies: its parts under their names, `shaft.input.length`, or all alike, `shaft.*.length`.

The last dot of such a key is the one before the part's own key: a name may have dots, spaces and commas.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple, Self

from gearcad.dynamics.options import OF_PAIRS, OF_TRAINS_OF_PAIRS, DynamicsOptions
from gearcad.dynamics.trains.members import Inertia, Mesh, Shaft
from gearcad.dynamics.trains.train import Train
from gearcad.errors import shown
from gearcad.ranges import TORQUE
from gearcad.schema import FieldSchema, Words, schema_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["ALL", "MAIN", "PARTS", "TORQUES", "TRAIN", "TrainKey", "explain_unknown_key_of_train", "general_key"]

MAIN = "train"

ALL = "*"
"""In place of a name: all parts of a kind. What a part has of its own goes before it."""

PARTS: dict[str, type[DataclassInstance]] = {"inertia": Inertia, "shaft": Shaft, "mesh": Mesh}
"""What a train is made of, by the tables of its spec."""

TORQUES = "torques"
"""The part of [train] whose keys are inertias."""

_ELSEWHERE = ("name", "inertias", "shafts", "meshes", TORQUES)
"""Fields of a train that no plain key holds."""


@dataclass(frozen=True)
class _OfTorques:
    torques: Annotated[float, TORQUE, Words("torque", "T")]


def _but(kind: type[DataclassInstance], *others: str) -> dict[str, FieldSchema]:
    return {name: field for name, field in schema_of(kind).items() if name not in others}


def _flat(name: str, field: FieldSchema) -> dict[str, FieldSchema]:
    """A field, or those of its part with a dot."""
    return {name: field} if field.part is None else {f"{name}.{key}": each for key, each in schema_of(field.part).items()}


TRAIN: dict[str, dict[str, FieldSchema]] = {
    MAIN: _but(Train, *_ELSEWHERE),
    **{table: _but(kind, "name") for table, kind in PARTS.items()},
    "dynamics": {
        key: each
        for name, field in schema_of(DynamicsOptions).items()
        if OF_PAIRS not in field.marks or OF_TRAINS_OF_PAIRS in field.marks
        for key, each in _flat(name, field).items()
    },
}
"""What the keys of each table say of themselves; those of parts without the names."""

_TORQUE = schema_of(_OfTorques)[TORQUES]


class TrainKey(NamedTuple):
    """A key of a train: of a table, and of the part of this name, "" in [train] and [dynamics]."""

    table: str
    name: str
    field: str

    @classmethod
    def of(cls, key: str) -> Self | None:
        """What a key says; None for one that no train has."""
        table, _, rest = key.partition(".")
        name, _, field = rest.rpartition(".")
        if table in PARTS:
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
        """What it says of itself."""
        return _TORQUE if self.field == TORQUES else TRAIN[self.table][self.field]

    @property
    def general(self) -> str:
        """That of all parts of the kind."""
        return str(self._replace(name=ALL)) if self.name else str(self)


def general_key(key: str) -> str:
    """`shaft.*.length` for the key of any shaft's length; a key that is of no part as it is."""
    table = key.partition(".")[0]
    found = TrainKey.of(key) if table in PARTS or table == MAIN else None
    return key if found is None else found.general


def explain_unknown_key_of_train(key: str, names: Mapping[str, tuple[str, ...]] | None = None) -> str:
    """The end of the message about a key that no train has, or that this one with parts of these `names` has not."""
    table, dot, rest = key.partition(".")
    if rest.startswith(f"{TORQUES}.") and names is not None:
        return _unknown_part("inertia", rest[len(TORQUES) + 1 :], f"{MAIN}.{TORQUES}.{{}}", names)
    near = difflib.get_close_matches(table.lower(), TRAIN, n=1, cutoff=0.75) if dot else []
    name, _, field = rest.rpartition(".") if near else ("", "", key)
    table = near[0] if near else ""
    if table in PARTS and field in TRAIN[table] and name and names is not None and name not in _permitted(names[table]):
        return _unknown_part(table, name, f"{table}.{{}}.{field}", names)
    # A key by itself is one of [train] before it is another's.
    for tables in ((table or MAIN,), tuple(TRAIN)):
        if meant := [_full(home, name, spelt, names) for home, spelt in _near(field, tables)]:
            return f"unknown key; did you mean {' or '.join(meant)}?"
    if table:
        return f"unknown key; permitted behind {table}.{'NAME.' if table in PARTS else ''} are {', '.join(TRAIN[table])}"
    return (
        "unknown key; must be one of a train, such as train.model, shaft.NAME.damping_ratio or, for all shafts, shaft.*.modes"
    )


def _unknown_part(table: str, name: str, written: str, names: Mapping[str, tuple[str, ...]]) -> str:
    """That the train has no such part; its key is `written` with a name put in."""
    known = names[table]
    if near := difflib.get_close_matches(name, known, n=1):
        return f"the train has no {table} {shown(name)}; did you mean {written.format(near[0])}?"
    return f"the train has no {table} {shown(name)}; it has {', '.join(known)}" if known else f"the train has no {table} at all"


def _permitted(known: tuple[str, ...]) -> tuple[str, ...]:
    return (*known, ALL) if known else ()


def _full(table: str, name: str, field: str, names: Mapping[str, tuple[str, ...]] | None) -> str:
    """A key, that of all parts where the name is none of them."""
    if table not in PARTS:
        return f"{table}.{field}"
    return f"{table}.{name if name and (names is None or name in names[table]) else ALL}.{field}"


def _near(field: str, tables: Iterable[str]) -> list[tuple[str, str]]:
    """Keys of these tables that are spelt so, or else alike, each with its table."""
    known = {key: [home for home in tables if key in TRAIN[home]] for table in tables for key in TRAIN[table]}
    field = field.rpartition(".")[2].lower()
    spelt = [field] if field in known else difflib.get_close_matches(field, known, n=1)
    return [(home, key) for key in spelt for home in known[key]]
