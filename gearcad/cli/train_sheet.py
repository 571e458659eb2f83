"""The lines of a train on the data sheet: the train, then a column for each inertia, shaft and mesh."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcad import symbols
from gearcad.designs.train_keys import MAIN, PARTS, TORQUES, TRAIN
from gearcad.symbols import Symbol

__all__ = ["train_lines"]

_TITLES = {"inertia": "Inertias", "shaft": "Shafts", "mesh": "Meshes"}

_ABSENT = "-"

_WORDS, _SYMBOL, _UNIT, _VALUE = 50, 6, 9, 12
"""Widths of columns; one of values is as wide as its longest."""

Rows = list[tuple[Symbol, list[str]]]


def train_lines(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Lines and their styles from the document of `data.json`, without what nothing has a value of."""
    yield f"{document['name']}: train, {len(document['inertia'])} inertias", "bold"
    yield "lengths in mm", "dim"
    yield "", ""
    known = {key: field.symbol for key, field in TRAIN[MAIN].items()} | symbols.TRAIN
    own = {key: value for key, value in document[MAIN].items() if key != TORQUES}
    yield from _block("Train", ("",), [(known[key], [_shown(value)]) for key, value in own.items()])
    for table in PARTS:
        parts = document[table]
        known = {key: field.symbol for key, field in TRAIN[table].items()} | symbols.TRAIN_PARTS[table]
        rows = [(symbol, [_shown(part.get(key)) for part in parts.values()]) for key, symbol in known.items()]
        yield from _block(_TITLES[table], tuple(parts), rows)


def _block(title: str, names: tuple[str, ...], rows: Rows) -> Iterator[tuple[str, str]]:
    """A title with the names of the columns, and the rows in which something stands."""
    given = [(symbol, values) for symbol, values in rows if set(values) - {_ABSENT, "0"}]
    if not names:
        return
    widths = [
        max(_VALUE, *(len(each) + 2 for each in column)) for column in zip(names, *(row for _, row in given), strict=True)
    ]
    yield _line(title, Symbol("", "", "", ""), names, widths), "bold cyan"
    for symbol, values in given:
        yield _line(f"  {symbol.words}", symbol, values, widths), ""
    yield "", ""


def _line(words: str, symbol: Symbol, values: tuple[str, ...] | list[str], widths: list[int]) -> str:
    cells = "".join(f"{value:>{width}}" for value, width in zip(values, widths, strict=True))
    return f"{words:<{_WORDS}} {symbol.symbol:<{_SYMBOL}}{symbol.unit:<{_UNIT}}{cells}".rstrip()


def _shown(value: Any) -> str:
    if value is None or value == []:
        return _ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return " ".join(map(_shown, value)) if len(value) <= 2 else f"{len(value)} values"
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)
