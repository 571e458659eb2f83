"""The tables of results that the manual shows: those of the symbol table, each by its name there."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from gearcad.core import symbols
from gearcad.core.symbols import Symbol

__all__ = ["result_tables"]


@cache
def result_tables() -> Mapping[str, Mapping[str, Symbol]]:
    """Every table of `gearcad.core.symbols`; those of the parts of a train as `TRAIN_PARTS.shaft`."""
    found: dict[str, Mapping[str, Symbol]] = {}
    for name, table in vars(symbols).items():
        if name.isupper() and not name.startswith("_") and isinstance(table, dict):
            inner = {f"{name}.{key}": each for key, each in table.items() if isinstance(each, dict)}
            found |= inner or {name: table}
    return found
