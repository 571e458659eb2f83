"""The spec of a pair: the text of every value that is not its default, which gives the very same pair when it is read."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import is_dataclass
from enum import Enum
from functools import reduce
from typing import Any

from gearcad.designs.keys import BESIDE, FIELDS
from gearcad.designs.kinds.pair import PairDesign
from gearcad.drawing.options import PartDrawing
from gearcad.geometry import Gear
from gearcad.geometry.derived import is_given
from gearcad.material import Material
from gearcad.per_gear import PerGear
from gearcad.schema import is_usual, schema_of

__all__ = ["pair_text", "toml_text"]

_ALWAYS = ("helix_angle", "profile_shift", "tip_alteration")
"""Of gears: what a spec without them takes from the mate, or as "auto"."""


def pair_text(design: PairDesign, comments: Sequence[str] = ()) -> str:
    """The TOML of a design of a pair, led by `comments`, a line each. "auto" stands nowhere: what it gave does."""
    pair = design.pair
    tables = {
        "pair": dict(_values(pair, ("name", "centre_distance", "centre_distance_tolerance", "axial_offset"), always=("name",))),
        **{role.value: dict(_values(gear, FIELDS[role.value], always=("name", *_ALWAYS))) for role, gear in pair.gears.items()},
        **{table: dict(_values(material, schema_of(Material))) for table, material in _materials(design).items()},
        **{
            table: dict(_values(getattr(design, table), FIELDS[table]))
            for table in BESIDE
            if getattr(design, table) is not None and table != "material"
        },
        **{f"{gear}.drawing": dict(_values(own, schema_of(PartDrawing))) for gear, own in design.drawings.items()},
    }
    return toml_text(tables, comments)


def toml_text(tables: Mapping[str, Mapping[str, Any]], comments: Sequence[str] = ()) -> str:
    """The TOML of tables with flattened keys, led by `comments`, a line each."""
    blocks = ["\n".join(f"# {line}".rstrip() for line in comments)] if comments else []
    for table, values in tables.items():
        blocks.append("\n".join([f"[{table}]", *(f"{key} = {_toml(value)}" for key, value in values.items())]))
    return "\n\n".join(blocks) + "\n"


def _materials(design: PairDesign) -> dict[str, Material]:
    """By the tables that hold them."""
    if isinstance(design.material, PerGear):
        return {f"{role.value}.material": material for role, material in design.material.items()}
    return {} if design.material is None else {"material": design.material}


def _values(instance: Any, keys: Any, always: Sequence[str] = ()) -> Iterator[tuple[str, Any]]:
    """The fields under flattened keys, without those that are derived, or that say no more than their default."""
    for key in keys:
        *parts, name = key.split(".")
        owner = reduce(lambda of, part: getattr(of, part, None), parts, instance)
        if owner is None:  # a part that is not given
            continue
        value = getattr(owner, name)
        if is_dataclass(value) or value is None or not (isinstance(value, str | Enum | tuple) or is_given(value)):
            continue
        opposed = key == "double_helix.offset" and isinstance(instance, Gear) and instance.double_helix.present
        if key in always or opposed or not is_usual(value, _default(owner, name)):
            yield key, value


def _default(owner: Any, name: str) -> Any:
    return type(owner).__dataclass_fields__[name].default


def _toml(value: Any) -> str:
    if isinstance(value, Enum):
        value = value.value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)  # texts of JSON are texts of TOML
    # Python's own numbers are written with the fewest digits that give them back.
    return repr(float(value) if isinstance(value, float) else int(value))
