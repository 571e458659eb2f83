"""The sections of a train: the train, then a column for each inertia, shaft and mesh."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from gearcad import symbols
from gearcad.designs.train_keys import MAIN, PARTS, TORQUES, TRAIN
from gearcad.sheet.blocks import ABSENT, Block, Row, Section
from gearcad.symbols import Symbol

__all__ = ["train_sections"]

_TITLES = {"inertia": "Inertias", "shaft": "Shafts", "mesh": "Meshes"}


def train_sections(document: Mapping[str, Any]) -> Iterator[Section]:
    """Those of the document of `data.json`, without what nothing has a value of."""
    known = {key: field.symbol for key, field in TRAIN[MAIN].items()} | symbols.TRAIN
    own = {key: value for key, value in document[MAIN].items() if key != TORQUES}
    yield Section((), (Block("Train", _given(_row(MAIN, key, known[key], [value]) for key, value in own.items())),))
    for table in PARTS:
        if not (parts := document[table]):
            continue
        known = {key: field.symbol for key, field in TRAIN[table].items()} | symbols.TRAIN_PARTS[table]
        rows = (_row(table, key, symbol, [part.get(key) for part in parts.values()]) for key, symbol in known.items())
        yield Section(tuple(parts), (Block(_TITLES[table], _given(rows)),))


def _given(rows: Iterable[Row]) -> tuple[Row, ...]:
    """Those in which something stands."""
    return tuple(row for row in rows if set(row.texts) - {ABSENT, "0"})


def _row(table: str, key: str, symbol: Symbol, values: list[Any]) -> Row:
    return Row(f"{table}.{key}", symbol, tuple(values), tuple(map(_shown, values)))


def _shown(value: Any) -> str:
    if value is None or value == []:
        return ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return " ".join(map(_shown, value)) if len(value) <= 2 else f"{len(value)} values"
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)
