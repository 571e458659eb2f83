"""Spec files: TOML in, a Design out. The keys are the field names of the inputs; README.md and the templates show them.

The main table decides the kind: `[gear]`, `[pair]` with `[pinion]` and `[wheel]`, `[rack]`, which may have a `[pinion]` in its
`[pair]`, `[train]`, or `[planetary]` with its gears. Whatever is not understood is
refused, so nothing is silently ignored.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gearcad.designs.design import Design, DesignKind
from gearcad.designs.files import Where, read_tables
from gearcad.designs.keys import MAIN_TABLES, OF_SETS
from gearcad.designs.kinds import type_of
from gearcad.errors import as_path

__all__ = ["design_from_tables", "design_from_values", "kind_of", "read_spec"]


def read_spec(path: Path | str) -> Design:
    """Read a TOML spec. The name of the design is its own, else the stem of the file.

    Raises SpecError, one line that names the file, the line, the key and what is permitted.
    """
    tables, where = read_tables(as_path("file", path))
    return design_from_tables(tables, where=where, default_name=Path(path).stem)


def design_from_tables(tables: Mapping[str, Any], *, where: Where, default_name: str) -> Design:
    """The design that parsed tables describe: {"gear": {"teeth": 20, "rack": {...}, ...}}, one mapping per TOML table.

    `where` locates a dotted key for messages. Raises SpecError.
    """
    return type_of(kind_of(tables)).read(tables, where, default_name)


def design_from_values(values: Mapping[str, Any], kind: DesignKind, *, where: Where, default_name: str) -> Design:
    """The design that values under the keys of a design table describe. Raises SpecError."""
    if kind is DesignKind.TRAIN:
        from gearcad.designs.kinds.train import TrainDesign
        from gearcad.designs.train_values import tables_of

        tables, names = tables_of(values, where)
        return TrainDesign.read(tables, where, default_name, names)
    return design_from_tables(nested(values, kind), where=where, default_name=default_name)


def nested(values: Mapping[str, Any], kind: DesignKind) -> dict[str, dict[str, Any]]:
    """Values under their full keys as one mapping per table of a spec; the tables of the kind are there even if empty."""
    tables: dict[str, dict[str, Any]] = {owner: {} for owner in MAIN_TABLES[kind]}
    for key, value in values.items():
        owner, _, field = key.partition(".")
        tables.setdefault(owner, {})[field] = value
    return tables


def kind_of(tables: Mapping[str, Any]) -> DesignKind:
    """By the main table; the larger kind says what cannot stand beside its tables, and a pair what nothing lacks."""
    if "rack" in tables and "train" not in tables:
        paired = any(table in tables for table in MAIN_TABLES[DesignKind.PAIR])
        return DesignKind.RACK_PAIR if paired else DesignKind.RACK
    if any(table in tables for table in OF_SETS) and "train" not in tables:
        return DesignKind.PLANETARY
    return next((kind for kind in reversed(DesignKind) if kind.value in tables), DesignKind.PAIR)
