"""A train's values under the keys of tables, and back: inertias, shafts and meshes of its lists are known by their names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from gearcad.designs.files import Where
from gearcad.designs.spec import Given
from gearcad.designs.train_keys import ALL, MAIN, PARTS, TORQUES, TRAIN, TrainKey, explain_unknown_key_of_train
from gearcad.dynamics.options import DynamicsOptions
from gearcad.errors import SpecError, format_number, shown
from gearcad.schema import FieldSchema, parts_of

__all__ = [
    "TrainTables",
    "missing_fault",
    "missing_keys",
    "names_of",
    "tables_of",
    "values_of",
]

_SWITCH = {"true": True, "false": False}


class TrainTables(NamedTuple):
    """Tables as a spec of a train has them, and under what key each of the lists' tables stands: `train.shaft[0]` is
    `shaft.input`."""

    tables: dict[str, Any]
    names: dict[str, str]


# ---------------------------------------------------------------------- from a spec


def values_of(tables: Mapping[str, Any], where: Where) -> dict[str, Given]:
    """The values of a spec under the keys of tables, each with the key under which it is written; that of `train.name` too.

    They need not make a train. Raises SpecError for what is unknown, and for parts that no key can name.
    """
    main, found = _table(tables.get(MAIN, {}), MAIN, where), dict[str, Given]()
    for key, value in main.items():
        if key == TORQUES:
            for name, torque in _table(value, f"{MAIN}.{TORQUES}", where).items():
                found |= _value(TrainKey(MAIN, _spelt(name, f"{MAIN}.{TORQUES}.{name}", where), TORQUES), torque, None, where)
        elif key == "name":
            found["train.name"] = Given(value, "train.name")
        elif key not in PARTS:
            found |= _value(TrainKey(MAIN, "", key), value, None, where)
    for table in PARTS:
        for name, owner, content in _parts(main, table, where):
            for key, value in content.items():
                found |= _value(TrainKey(table, name, key), value, f"{owner}.{key}", where) if key != "name" else {}
    for key, value in _table(tables.get("dynamics", {}), "dynamics", where).items():
        inner = _table(value, f"dynamics.{key}", where) if key in parts_of(DynamicsOptions) else None
        each = {key: value} if inner is None else {f"{key}.{name}": its for name, its in inner.items()}
        for name, its in each.items():
            found |= _value(TrainKey("dynamics", "", name), its, None, where)
    return found


def _table(content: Any, key: str, where: Where) -> Mapping[str, Any]:
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {key} = {format_number(content)}: must be a table", key)
    return content


def _parts(main: Mapping[str, Any], table: str, where: Where) -> Iterator[tuple[str, str, Mapping[str, Any]]]:
    """Name, written key and content of each part of a kind."""
    listed = main.get(table, [])
    if not isinstance(listed, list):
        raise SpecError(f"{where(f'{MAIN}.{table}')}: {MAIN}.{table}: must be headed [[{MAIN}.{table}]], once for each")
    taken: set[str] = set()
    for number, each in enumerate(listed):
        owner = f"{MAIN}.{table}[{number}]"
        content = _table(each, owner, where)
        if "name" not in content:
            raise SpecError(f"{where(owner)}: name is missing in [[{MAIN}.{table}]]", owner)
        name = _spelt(content["name"], f"{owner}.name", where)
        if name in taken:
            raise SpecError(f"{where(f'{owner}.name')}: {shown(f'{owner}.name')} = {shown(name)!r}: names must differ", owner)
        taken.add(name)
        yield name, owner, content


def _spelt(name: Any, key: str, where: Where) -> str:
    """A name that the heading of a column can hold."""
    if not isinstance(name, str) or not name or name != name.strip() or not name.isprintable() or name == ALL:
        permitted = f"must be a text without space around it, and not {ALL}, which stands for all, to be the name of columns"
        raise SpecError(f"{where(key)}: {shown(key)} = {format_number(name)}: {permitted}", key)
    return name


def _value(key: TrainKey, value: Any, written: str | None, where: Where) -> dict[str, Given]:
    written = str(key) if written is None else written
    if key.field != TORQUES and key.field not in TRAIN[key.table]:
        unknown = explain_unknown_key_of_train(f"{key.table}.{key.field}" if not key.name else f"{key.table}.*.{key.field}")
        raise SpecError(f"{where(written)}: {shown(written)}: {unknown}", written)
    return {str(key): Given(_plain(value, key.schema), written)}


def _plain(value: Any, field: FieldSchema) -> Any:
    """Whole numbers as floats where floats are meant, in lists too."""
    if isinstance(value, list):
        return tuple(_plain(each, field) for each in value)
    if isinstance(value, int) and not isinstance(value, bool) and not field.whole:
        return float(value)
    return value + 0.0 if isinstance(value, float) else value


def names_of(keys: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """The names of the parts of each kind, in their order."""
    found: dict[str, dict[str, None]] = {table: {} for table in PARTS}
    for key in filter(None, map(TrainKey.of, keys)):
        if key.table in PARTS and key.name != ALL:
            found[key.table][key.name] = None
    return {table: tuple(names) for table, names in found.items()}


# ---------------------------------------------------------------------- to a spec


def tables_of(values: Mapping[str, Any], where: Where) -> TrainTables:
    """The tables that values under their keys make. Raises SpecError for a value of all parts of a kind that is not there."""
    keys = {key: TrainKey.of(key) for key in values}
    names = names_of(values)
    main: dict[str, Any] = {}
    parts: dict[tuple[str, str], dict[str, Any]] = {(t, name): {"name": name} for t in PARTS for name in names[t]}
    other: dict[str, Any] = {}
    # Those of all parts first: what a part has of its own replaces them.
    for key, found in sorted(keys.items(), key=lambda each: each[1] is not None and each[1].name != ALL):
        assert found is not None  # headings and studies have seen to it
        if found.field == TORQUES:
            main.setdefault(TORQUES, {})[found.name] = values[key]
        elif not found.name:
            owner, *part = found.field.split(".")
            content = main if found.table == MAIN else other
            (content.setdefault(owner, {}) if part else content)[part[0] if part else owner] = _typed(values[key], found.schema)
        else:
            chosen = names[found.table] if found.name == ALL else (found.name,)
            if not chosen:
                raise SpecError(f"{where(key)}: {key}: the train has no {found.table} at all", key)
            for name in chosen:
                parts[found.table, name][found.field] = _typed(values[key], found.schema)
    for table in PARTS:
        main[table] = [part for (home, _), part in parts.items() if home == table]
    owners = {f"{MAIN}.{t}[{number}]": f"{t}.{name}" for t in PARTS for number, name in enumerate(names[t])}
    return TrainTables({MAIN: main, "dynamics": other}, owners)


def _typed(value: Any, field: FieldSchema) -> Any:
    """A cell's value as a spec has it: one number of a list as such, and true and false, which spreadsheets shout."""
    if field.members == (bool,) and isinstance(value, str):
        return _SWITCH.get(value.lower(), value)
    return (value,) if field.several and isinstance(value, float) else value


def missing_keys(given: Iterable[str]) -> Iterator[str]:
    """What the parts among the keys `given` must have, and have not."""
    fields: dict[tuple[str, str], set[str]] = {}
    for key in map(TrainKey.of, given):
        if key is not None and key.table in PARTS:
            fields.setdefault((key.table, key.name), set()).add(key.field)
    for (table, name), own in fields.items():
        there = own | fields.get((table, ALL), set())
        yield from (f"{table}.{name}.{field}" for field, each in TRAIN[table].items() if name != ALL and each.needed(there))


def missing_fault(key: str, where: Where) -> SpecError:
    """That a key of a part is missing."""
    return SpecError(f"{where(key)}: {shown(key)} is missing: must be given", key)
