"""Pairs that a search for sizes has found: a design table of all, which `batch` then makes, and the spec of one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.designs.auto import AUTO
from gearcad.designs.csv_cells import cell_text, write_found_rows
from gearcad.designs.pair_text import toml_text
from gearcad.geometry import ISO53_A
from gearcad.material import Grade, Material, grade_of
from gearcad.schema import is_usual
from gearcad.sizing import SizedPair, SizeTask, Sizing

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["pair_keys", "write_front", "write_pair", "write_pairs"]

_DIGITS = 12
"""Of numbers of a task, without those that are rounding."""


def pair_keys(sized: SizedPair) -> dict[str, dict[str, Any]]:
    """What a spec has of a pair: values by table and key. The wheel's shift follows from the centre distance."""
    task = sized.task
    one, other = task.materials
    tables: dict[str, dict[str, Any]] = {
        "pair": {
            "name": sized.name,
            "centre_distance": sized.centre_distance,
            "normal_module": sized.normal_module,
            "helix_angle": sized.helix_angle,
            "face_width": sized.face_width,
            **_given("rack.", task.rack, ISO53_A),
        },
        "pinion": {"teeth": sized.teeth.pinion, "profile_shift": sized.pinion_shift},
        "wheel": {"teeth": sized.teeth.wheel, "profile_shift": AUTO},
        "load": _given("", task.load),
        "rating": _given("", task.rating),
    }
    if one == other:
        tables["material"] = _material("", one)
    else:
        tables["pinion"] |= _material("material.", one)
        tables["wheel"] |= _material("material.", other)
    return {table: values for table, values in tables.items() if values}


def _given(prefix: str, instance: DataclassInstance, usual: DataclassInstance | None = None) -> dict[str, Any]:
    """The fields that differ from their defaults, or from those of another instance."""
    found = {}
    for each in fields(instance):
        value, default = getattr(instance, each.name), each.default if usual is None else getattr(usual, each.name)
        if value is not None and (default is MISSING or not is_usual(value, default)):
            found[prefix + each.name] = value
    return found


def _material(prefix: str, material: Material) -> dict[str, Any]:
    """Without group and quality, where the name stands for them."""
    found = _given(prefix, material)
    if grade_of(material.name) is not None:
        found = {key: value for key, value in found.items() if key.removeprefix(prefix) not in Grade._fields}
    return found


def write_pairs(result: Sizing, path: Path) -> None:
    """Write the design table of all that was found, best first."""
    said = f"best by {result.task.criterion.value} first. Next: gearcad batch {path.name}"
    _write_table(result.task, [dict(_cells(sized)) for sized in result.found], said, path)


def write_front(result: Sizing, path: Path) -> None:
    """Write the design table of the front's sample, lightest first; names are numbered, for some differ in width alone."""
    rows = [{**dict(_cells(each)), "name": f"{number:02d}-{each.name}"} for number, each in enumerate(result.front_sample, 1)]
    said = f"{len(rows)} of {len(result.front)} variants on the front of mass and safety / lightest first / not refined"
    _write_table(result.task, rows, f"{said}. Next: gearcad batch {path.name} --do rate", path)


def _write_table(task: SizeTask, rows: list[dict[str, str]], said: str, path: Path) -> None:
    """Write rows under what they are for."""
    wanted = f"{task.load.torque:g} N·m at {task.load.speed:g} rpm / u = {task.ratio:g} within {task.ratio_tolerance:g} %"
    write_found_rows(rows, f"Pairs for {wanted}; {said}", path)


def _cells(sized: SizedPair) -> Iterator[tuple[str, str]]:
    for table, values in pair_keys(sized).items():
        for key, value in values.items():
            plain = float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value
            yield "name" if key == "name" and table == "pair" else f"{table}.{key}", cell_text(_word(plain))


def _word(value: Any) -> Any:
    """A member of an enum as its value."""
    return getattr(value, "value", value)


def write_pair(sized: SizedPair, comments: list[str], path: Path) -> None:
    """Write the spec of one of them, led by `comments`, a line each."""
    path.write_text(toml_text(_tables(sized), comments), encoding="utf-8")


def _tables(sized: SizedPair) -> Mapping[str, Mapping[str, Any]]:
    order = ("pair", "pinion", "wheel", "material", "load", "rating")
    keys = pair_keys(sized)
    return {table: keys[table] for table in order if table in keys}
