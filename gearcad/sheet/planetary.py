"""The blocks of a planetary train: what it is, its members, and a column for each mesh and stage."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcad import symbols
from gearcad.errors import format_number
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim
from gearcad.schema import symbols_of
from gearcad.sheet.blocks import Block, Row, Section, block, flattened, value_text
from gearcad.sheet.pairs import pair_section
from gearcad.symbols import Symbol

__all__ = ["planetary_sections"]

_TRAIN_KEYS = (
    "set_type planets input output fixed ratio basic_ratio centre_distance planet_angles positions"
    " free_tip_distance tip_distance"
).split()
_OF_TRAIN = symbols_of(PlanetaryTrain) | symbols.PLANETARY
_OF_MEMBER = symbols_of(Central) | symbols_of(Rim) | symbols_of(Carrier) | symbols.PLANETARY_MEMBER


def planetary_sections(train: Mapping[str, Any]) -> tuple[Section, ...]:
    """Those of the document of a train."""
    pairs = {name: flattened(pair) for name, pair in (*train["meshes"].items(), *train["stages"].items())}
    return Section((), tuple(_blocks(train))), pair_section(pairs)


def _blocks(train: Mapping[str, Any]) -> Iterator[Block]:
    rows = (_row("planetary", key, _OF_TRAIN[key], train[key]) for key in _TRAIN_KEYS if train.get(key) is not None)
    yield from block("Planetary train", rows)
    for name, member in train["members"].items():
        given = {key: value for key, value in member.items() if value not in (None, [], 0) or key == "support_stiffness"}
        rows = (_row(name, key, _OF_MEMBER[key], value) for key, value in given.items() if value is not None)
        yield from block(name, (row for row in rows if row.symbol.words))


def _row(of: str, key: str, symbol: Symbol, value: Any) -> Row:
    text = " ".join(map(format_number, value)) if isinstance(value, list) else value_text(value)
    return Row(f"{of}.{key}", symbol, (value,), (text,))
