"""Planetary sets that a search for sizes has found: a design table of all, which `batch` then makes, and the spec of one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.designs.csv_cells import cell_text, write_found_rows
from gearcad.designs.found_sets import set_keys
from gearcad.designs.pair_text import toml_text
from gearcad.schema import is_usual
from gearcad.sizing.sized_set import SizedSet, SizedSets

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["sized_keys", "write_sized_set", "write_sized_sets"]


def sized_keys(sized: SizedSet) -> dict[str, dict[str, Any]]:
    """What a spec has of a set: values by table and key."""
    tables: dict[str, dict[str, Any]] = {"planetary": {"name": sized.name}}
    for key, value in set_keys(sized.candidate).items():
        table, _, name = key.partition(".")
        tables.setdefault(table, {})[name] = value
    del tables["planetary"]["tooth_thinning"]
    for central in sized.train.centrals:
        if central.gear.internal:
            tables[central.name]["body.rim_diameter"] = central.gear.body.rim_diameter
    tables["load"] = _given(sized.load)
    tables["rating"] = _given(sized.strength.options)
    common = next(iter(sized.materials.values()))
    tables["material"] = _given(common)
    for name, material in sized.materials.items():
        if material != common:
            tables[name] |= {f"material.{key}": value for key, value in _given(material).items()}
    return {table: values for table, values in tables.items() if values}


def _given(instance: DataclassInstance) -> dict[str, Any]:
    """The fields that differ from their defaults."""
    values = ((each, getattr(instance, each.name)) for each in fields(instance))
    return {
        each.name: value
        for each, value in values
        if value is not None and (each.default is MISSING or not is_usual(value, each.default))
    }


def write_sized_sets(result: SizedSets, path: Path) -> None:
    """Write the design table of all that was found, lightest first."""
    rows = [dict(_cells(each)) for each in result.found]
    task = result.task
    wanted = f"{task.torque_words} at {task.speed:g} rpm / i = {task.sets.ratio:g}"
    write_found_rows(rows, f"Planetary sets for {wanted}; lightest first. Next: gearcad batch {path.name}", path)


def _cells(sized: SizedSet) -> Iterator[tuple[str, str]]:
    for table, values in sized_keys(sized).items():
        for key, value in values.items():
            named = key == "name" and table == "planetary"
            yield "name" if named else f"{table}.{key}", cell_text(getattr(value, "value", value))


def write_sized_set(sized: SizedSet, comments: list[str], path: Path) -> None:
    """Write the spec of one of them, led by `comments`, a line each."""
    path.write_text(toml_text(sized_keys(sized), comments), encoding="utf-8")
