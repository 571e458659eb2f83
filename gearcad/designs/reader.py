"""Spec files: TOML in, a Design out. The keys are the field names of the inputs; README.md and the templates show them.

The main table decides the kind: `[gear]`, `[pair]` with `[pinion]` and `[wheel]`, `[rack]`, which may have a `[pinion]` in its
`[pair]`, `[train]`, or `[planetary]` with its gears. Whatever is not understood is
refused, so nothing is silently ignored.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gearcad.designs.design import Design, DesignKind, not_accepted
from gearcad.designs.files import Where, read_tables
from gearcad.designs.keys import LISTS, MAIN_TABLES, OF_SETS, Cell
from gearcad.designs.kinds import type_of
from gearcad.designs.kinds.gear import GearDesign
from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.errors import SpecError, format_number

__all__ = ["design_from_tables", "read_spec", "spec_values"]


def read_spec(path: Path | str) -> Design:
    """Read a TOML spec. The name of the design is its own, else the stem of the file.

    Raises SpecError, one line that names the file, the line, the key and what is permitted.
    """
    tables, where = read_tables(path)
    return design_from_tables(tables, where=where, default_name=Path(path).stem)


def design_from_tables(tables: Mapping[str, Any], *, where: Where, default_name: str) -> Design:
    """The design that parsed tables describe: {"gear": {"teeth": 20, "rack": {...}, ...}}, one mapping per TOML table.

    `where` locates a dotted key for messages. Raises SpecError.
    """
    return type_of(_kind(tables)).read(tables, where, default_name)


def spec_values(path: Path | str) -> tuple[DesignKind, str, dict[str, Cell]]:
    """Kind and name of a spec, and its other values under their dotted keys as a design table holds them: "auto" is a text.

    The values need not make a gear. Raises SpecError, for a value that no cell can hold too, and ParameterError for a kind that
    no table holds.
    """
    tables, where = read_tables(path)
    made = type_of(_kind(tables))
    if not issubclass(made, ToothedDesign):
        raise not_accepted(made, (GearDesign, PairDesign), "no table holds another")
    spec, main = made.spec(tables, where), MAIN_TABLES[made.kind][0]
    name = spec.name(main, Path(path).stem)
    values = {key: given.value for key, given in spec.values.items() if key != f"{main}.name"}
    if listed := next((key for key in values if "[" in key), None):
        raise SpecError(f"{where(listed)}: {listed}: no table holds lists of tables", listed)
    for key, value in values.items():
        if key in LISTS and isinstance(value, list | tuple) and all(type(item) in (int, float) for item in value):
            values[key] = tuple(float(item) for item in value)
        elif isinstance(value, bool) or not isinstance(value, int | float | str):
            raise SpecError(f"{where(key)}: {key} = {format_number(value)}: must be a number or a text")
    return made.kind, name, values


def _kind(tables: Mapping[str, Any]) -> DesignKind:
    """By the main table; the larger kind says what cannot stand beside its tables, and a pair what nothing lacks."""
    if "rack" in tables and "train" not in tables:
        paired = any(table in tables for table in MAIN_TABLES[DesignKind.PAIR])
        return DesignKind.RACK_PAIR if paired else DesignKind.RACK
    if any(table in tables for table in OF_SETS) and "train" not in tables:
        return DesignKind.PLANETARY
    return next((kind for kind in reversed(DesignKind) if kind.value in tables), DesignKind.PAIR)
