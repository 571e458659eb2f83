"""Keys of shafts in specs and tables: lists of tables, flattened as `pinion.shaft[0].length`, and those beside them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

from gearcad.core.quantities import FieldSchema, Range, Words, schema_of
from gearcad.core.records import Role
from gearcad.designs.keys import OF_SHAFTED_GEARS, OF_SHAFTS, SHAFTS
from gearcad.shafts.arrangement import ShaftOptions
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment

SHAFT_LISTS: dict[str, Any] = dict(zip(OF_SHAFTS, (ShaftSegment, ShaftBearing, ShaftForce), strict=True))
"""Lists of tables that describe a shaft, and the type that each of their tables makes."""

_ITEM = re.compile(
    rf"(?P<owner>(?:{'|'.join(role.value for role in Role)})\.)?(?P<list>{'|'.join(OF_SHAFTS)})\[(?P<at>\d{{1,2}})\]"
)
"""One table of a list of a gear's shaft, or of a shaft by itself; a list of a table has at most 100."""


@dataclass(frozen=True)
class _OfShaftedGears:
    """Keys of a gear that say where its shaft is loaded."""

    mesh_position: Annotated[float, Range("mm", 0, 1e7), Words("middle of the face on the shaft")]
    coupling: Annotated[float, Range("mm", 0, 1e7), Words("position of the coupling")] = 0.0


@cache
def shaft_fields() -> dict[str, FieldSchema]:
    """Return the fields of all keys of shafts, those of lists as `pinion.shaft[].length`."""
    found = {f"{SHAFTS}.{key}": field for key, field in schema_of(ShaftOptions).items()}
    for owner in ("", *(f"{role.value}." for role in Role)):
        for name, kind in SHAFT_LISTS.items():
            found |= {f"{owner}{name}[].{key}": field for key, field in schema_of(kind).items()}
        if owner:
            found |= {f"{owner}{key}": field for key, field in schema_of(_OfShaftedGears).items()}
    return found


def general_shaft_key(key: str) -> str:
    """Return the key that stands for all tables of a list, `shaft[].length` for `shaft[0].length`; other keys unchanged."""
    found = _ITEM.match(key)
    return key if found is None else f"{found['owner'] or ''}{found['list']}[]{key[found.end() :]}"


def shaft_field(key: str) -> FieldSchema | None:
    """Return the field of a full key of shafts, or None for another key."""
    return None if "[]" in key else shaft_fields().get(general_shaft_key(key))


def is_of_list(key: str) -> bool:
    """Return whether a key belongs to a table of a list of shafts, whether this has it or not."""
    return _ITEM.match(key) is not None


def is_of_shaft_alone(key: str) -> bool:
    """Return whether a key belongs to a list of a shaft by itself."""
    found = _ITEM.match(key)
    return found is not None and found["owner"] is None


def explain_unknown_item(key: str) -> str:
    """Return the end of the message about a key that a list of shafts does not have."""
    found = _ITEM.match(key)
    assert found is not None
    return f"unknown key; permitted behind {found[0]}. are {', '.join(schema_of(SHAFT_LISTS[found['list']]))}"


def shaft_values(tables: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield all values of shafts in the tables of a spec, under full keys."""
    for owner in ("", *(f"{role.value}." for role in Role)):
        own = tables if not owner else tables.get(owner[:-1], {})
        if not isinstance(own, Mapping):
            continue
        for name in OF_SHAFTS:
            for number, each in enumerate(listed if isinstance(listed := own.get(name), list) else ()):
                if isinstance(each, Mapping):
                    yield from ((f"{owner}{name}[{number}].{key}", value) for key, value in each.items())
        if owner:
            yield from ((f"{owner}{key}", own[key]) for key in OF_SHAFTED_GEARS if key in own and key not in OF_SHAFTS)
    if isinstance(options := tables.get(SHAFTS), Mapping):
        yield from ((f"{SHAFTS}.{key}", value) for key, value in options.items())


def with_shaft_lists(tables: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """Return tables in which keys such as `shaft[0].length` of a gear, or tables such as `shaft[0]`, are lists of tables."""
    found: dict[str, Any] = {}
    for table, content in tables.items():
        if is_of_shaft_alone(table):
            _put(found, table, content)
            continue
        own: dict[str, Any] = {}
        found[table] = own
        for key, value in content.items():
            if is_of_shaft_alone(key):
                name, _, field = key.partition(".")
                _put(own, name, {field: value})
            else:
                own[key] = value
    return found


def _put(tables: dict[str, Any], item: str, values: Mapping[str, Any]) -> None:
    """Put values into the table of a list that an item such as `shaft[1]` names."""
    found = _ITEM.match(item)
    assert found is not None
    listed = tables.setdefault(found["list"], [])
    listed += [{} for _ in range(int(found["at"]) + 1 - len(listed))]
    listed[int(found["at"])] |= values
