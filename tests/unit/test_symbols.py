"""The table of symbols covers what the objects hold, no more and no less."""

from dataclasses import asdict, fields
from typing import Any

import pytest

from gearcad import Gear, GearPair, Load, Material, Mounting, symbols
from gearcad.rating import RatingOptions


def _keys(document: dict[str, Any]) -> set[str]:
    """Dotted keys of a document, without the warnings, which are sentences."""
    found = set()
    for key, value in document.items():
        found |= {f"{key}.{inner}" for inner in value} if isinstance(value, dict) else {key}
    return found - {"warnings"}


def test_every_field_of_a_gear_has_a_symbol_and_every_symbol_a_field() -> None:
    gear = Gear(teeth=20, normal_module=2.0, face_width=10.0)
    assert _keys(gear.to_dict()) == set(symbols.GEAR)


def test_every_field_of_a_pair_has_a_symbol_and_every_symbol_a_field() -> None:
    gear = Gear(teeth=20, normal_module=2.0, face_width=10.0)
    assert _keys(GearPair(pinion=gear, wheel=gear).to_dict()) == set(symbols.PAIR)


INPUTS = (
    (Material(), symbols.MATERIAL),
    (Load(torque=1.0), symbols.LOAD),
    (Mounting(), symbols.MOUNTING),
    (RatingOptions(), symbols.RATING_OPTIONS),
)


@pytest.mark.parametrize(("made", "table"), INPUTS)
def test_inputs_of_later_stages_have_symbols(made: Any, table: dict[str, symbols.Symbol]) -> None:
    assert set(asdict(made)) == {field.name for field in fields(made)} == set(table)


@pytest.mark.parametrize("table", [symbols.GEAR, symbols.PAIR, *(table for _, table in INPUTS)])
def test_words_tell_the_rows_of_a_sheet_apart(table: dict[str, symbols.Symbol]) -> None:
    words = [symbol.words for symbol in table.values()]
    assert len(set(words)) == len(words)
    assert all(words)
