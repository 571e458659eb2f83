"""Ranking of the inputs of specs: the ten that matter most, and the keys under which a spec has each of them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any, NamedTuple

from gearcad.designs.keys import MAIN_TABLES, OF_SETS, DesignKind

__all__ = ["RANKING", "RankedInput", "RankedRow", "gear_tables", "is_given_key", "ranked_rows"]

_GEAR, _MAIN = "{gear}", "{main}"
"""Places in a key for the table of a gear, and for the main table of the kind."""


class RankedInput(NamedTuple):
    """An input that matters: its keys in the table of each gear, and those that all gears share.

    Keys of one tuple stand for each other: the first that a spec has is shown, otherwise the first that the kind knows. An
    input of both sorts is shown for all gears at once, unless a gear has a value of its own.
    """

    of_gears: tuple[str, ...] = ()
    shared: tuple[str, ...] = ()


RANKING = (
    RankedInput(of_gears=("{gear}.teeth", "{gear}.length")),
    RankedInput(
        of_gears=("{gear}.normal_module", "{gear}.normal_diametral_pitch"),
        shared=("{main}.normal_module", "{main}.normal_diametral_pitch"),
    ),
    RankedInput(of_gears=("{gear}.helix_angle",), shared=("{main}.helix_angle",)),
    RankedInput(of_gears=("{gear}.profile_shift",)),
    RankedInput(of_gears=("{gear}.face_width",)),
    RankedInput(shared=("{main}.centre_distance", "{main}.mounting_distance")),
    RankedInput(shared=("load.torque", "load.output_torque", "load.input_torque")),
    RankedInput(shared=("load.speed", "train.speed")),
    RankedInput(of_gears=("material.{gear}", "{gear}.material.name"), shared=("material.name",)),
    RankedInput(of_gears=("{gear}.accuracy_grade",), shared=("rating.accuracy_grade", "{main}.accuracy_grade")),
)
"""Number of teeth, module, helix angle, profile shift, face width, centre distance, torque, speed, material and quality."""


class RankedRow(NamedTuple):
    """The keys of one ranked input: one for each gear ("" where it has none), or a single one that is `shared` by all."""

    keys: tuple[str, ...]
    shared: bool


def gear_tables(kind: DesignKind, tables: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the tables of a spec that describe its gears, in the order in which they are shown."""
    if kind is DesignKind.PLANETARY:
        return tuple(table for table in OF_SETS if isinstance(tables.get(table), Mapping))
    return tuple(table for table in MAIN_TABLES[kind] if table not in ("pair", "train"))


def ranked_rows(kind: DesignKind, tables: Mapping[str, Any], known: Collection[str]) -> tuple[RankedRow, ...]:
    """Return the ranked inputs of a spec with these tables, without those that its kind does not have.

    `known` are all keys that a spec of this kind can have.
    """
    gears, main = gear_tables(kind, tables), MAIN_TABLES[kind][0]
    return tuple(row for ranked in RANKING if (row := _row(ranked, gears, main, tables, known)) is not None)


def _row(
    ranked: RankedInput, gears: tuple[str, ...], main: str, tables: Mapping[str, Any], known: Collection[str]
) -> RankedRow | None:
    """Return the row of one input; None for an input that the kind does not have."""
    shared = _written(ranked.shared, tables, known, gear="", main=main)
    own = [_written(ranked.of_gears, tables, known, gear=gear, main=main) for gear in gears]
    if shared and not (any(is_given_key(tables, key) for key in own) or (main in gears and own[0])):
        return RankedRow((shared,), shared=True)
    return RankedRow(tuple(own), shared=False) if any(own) else None


def _written(templates: tuple[str, ...], tables: Mapping[str, Any], known: Collection[str], *, gear: str, main: str) -> str:
    """Return the key of these templates that the spec has, otherwise the first that is known, or ""."""
    keys = [key for key in _filled(templates, gear, main) if key in known]
    return next((key for key in keys if is_given_key(tables, key)), next(iter(keys), ""))


def _filled(templates: tuple[str, ...], gear: str, main: str) -> Iterator[str]:
    for template in templates:
        yield template.replace(_GEAR, gear).replace(_MAIN, main)


def is_given_key(tables: Mapping[str, Any], key: str) -> bool:
    """Return whether nested tables have a value under a dotted key."""
    inner: Any = tables
    for part in key.split("."):
        if not isinstance(inner, Mapping) or part not in inner:
            return False
        inner = inner[part]
    return bool(key)
