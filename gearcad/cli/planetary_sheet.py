"""What the data sheet shows of a planetary train."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcad import symbols
from gearcad.cli.sheet_lines import NOTHING, WIDTH, Line, block, columns, flattened, pair_lines, value_text
from gearcad.errors import format_number
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim
from gearcad.schema import symbols_of

__all__ = ["planetary_lines"]

_TRAIN_KEYS = (
    "set_type planets input output fixed ratio basic_ratio centre_distance planet_angles positions tip_distance".split()
)
_OF_TRAIN = symbols_of(PlanetaryTrain) | symbols.PLANETARY
_OF_MEMBER = symbols_of(Central) | symbols_of(Rim) | symbols_of(Carrier) | symbols.PLANETARY_MEMBER


def planetary_lines(train: Mapping[str, Any], with_source: bool) -> Iterator[Line]:
    """The blocks of a planetary train: what it is, its members, and a column for each mesh and stage."""
    rows = [(_OF_TRAIN[key], [_shown(train[key])]) for key in _TRAIN_KEYS if train.get(key) is not None]
    yield from block("Planetary train", rows, with_source)
    for name, member in train["members"].items():
        given = {key: value for key, value in member.items() if value not in (None, [], 0) or key == "support_stiffness"}
        rows = [(_OF_MEMBER[key], [_shown(value)]) for key, value in given.items() if value is not None]
        yield from block(name, [row for row in rows if row[0].words], with_source)
    pairs = {name: flattened(pair) for name, pair in (*train["meshes"].items(), *train["stages"].items())}
    width = max(WIDTH, *(len(name) + 2 for name in pairs))
    yield Line(columns(NOTHING, pairs, with_source=False, width=width), "bold")
    yield from pair_lines(pairs, with_source, width)


def _shown(value: Any) -> str:
    return " ".join(map(format_number, value)) if isinstance(value, list) else value_text(value)
