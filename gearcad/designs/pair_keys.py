"""Keys in the pair of a train's mesh, such as `mesh.stage 1.pair.pinion.teeth`: their values put into the pair's tables."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gearcad.core.errors import SpecError, shown
from gearcad.designs.design import Where, read_tables
from gearcad.geometry.gear_parts import MODULE_OR_PITCH

_ITEM = re.compile(r"(?P<list>\w+)\[(?P<at>\d{1,2})\]")
"""One table of a list, such as `shaft[0]`."""


def with_pair_value(mesh: dict[str, Any], inside: str, value: Any, key: str, where: Where) -> None:
    """Put a value under a key in the pair of a mesh, in place; the pair may stand in tables or in a file.

    `inside` is the key in the pair, `key` the whole one for messages. A module takes the place of a diametral pitch, and the
    other way round. Raises SpecError for a mesh without a pair, and for a table of a list beyond its end.
    """
    tables = _pair_tables(mesh, key, where)
    mesh["pair"] = tables
    *path, field = inside.split(".")
    for each in path:
        tables = _inner(tables, each, key, where)
    if field in MODULE_OR_PITCH:
        for other in MODULE_OR_PITCH:
            tables.pop(other, None)
    tables[field] = value


def _pair_tables(mesh: dict[str, Any], key: str, where: Where) -> dict[str, Any]:
    """Return the tables of the pair of a mesh as [train.mesh.pair] has them, free to be changed."""
    pair = mesh.get("pair")
    if isinstance(pair, Mapping):
        return copy.deepcopy(dict(pair))
    if not isinstance(pair, str) or not pair.strip() or "\0" in pair:
        raise SpecError(f"{where(key)}: {shown(key)}: the mesh has no pair: give pair = FILE or [train.mesh.pair]", key)
    tables, _ = read_tables(Path(pair))
    shared = tables.pop("pair", {})
    return {**shared, **tables} if isinstance(shared, Mapping) else dict(tables)


def _inner(tables: dict[str, Any], name: str, key: str, where: Where) -> dict[str, Any]:
    """Return the table of that name, or the table `name[0]` of a list; a table that is not there is made."""
    item = _ITEM.fullmatch(name)
    if item is None:
        found = tables.setdefault(name, {})
    else:
        listed, at = tables.setdefault(item["list"], []), int(item["at"])
        if not isinstance(listed, list) or at > len(listed):
            raise SpecError(f"{where(key)}: {shown(key)}: the list has {len(listed)} tables before it", key)
        listed += [{}] if at == len(listed) else []
        found = listed[at]
    if not isinstance(found, dict):
        raise SpecError(f"{where(key)}: {shown(key)}: {shown(name)} of the pair must be a table", key)
    return found
