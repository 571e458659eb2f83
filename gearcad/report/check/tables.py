"""Inputs and rating as rows of tables: words, symbol, values, unit, source."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad import symbols
from gearcad.geometry import Gear, GearPair
from gearcad.load import Load
from gearcad.material import Material, Materials, by_gear
from gearcad.mounting import Mounting
from gearcad.schema import is_assumed, symbols_of
from gearcad.symbols import Symbol

if TYPE_CHECKING:
    from gearcad.check.result import CheckResult

__all__ = ["Row", "gear_rows", "load_rows", "pair_rows", "rating_rows"]

_GEAR = (
    "teeth normal_module helix_angle profile_shift tip_alteration tooth_thinning face_width rack.pressure_angle rack.addendum"
    " rack.dedendum rack.root_radius reference_diameter base_diameter tip_diameter root_diameter form_diameter body.bore"
)
_PAIR = (
    "centre_distance working_transverse_pressure_angle profile_shift_sum transverse_contact_ratio common_width.width"
    " circumferential_backlash"
)

_ROUNDING = 1e-9
"""Below this a length or number is rounding."""


class Row(NamedTuple):
    """One line of a table; `values` are those of pinion and wheel, or one for both."""

    words: str
    symbol: str
    values: tuple[str, ...]
    unit: str
    source: str


def gear_rows(pair: GearPair, keys: str = _GEAR) -> list[Row]:
    """What describes the gears: their fields `keys`, and the modifications of their flanks."""
    gears = (pair.pinion, pair.wheel)
    values = [_flat(gear.to_dict() | {"modification": gear.flank_form.in_use}) for gear in gears]
    written = symbols_of(Gear) | symbols.GEAR
    present = [key for key in written if key.startswith("modification.") and any(key in gear for gear in values)]
    return [_row(written[key], *(gear.get(key) for gear in values)) for key in (*keys.split(), *present)]


def pair_rows(pair: GearPair) -> list[Row]:
    """What describes the pair."""
    values = _flat(pair.to_dict())
    written = symbols_of(GearPair) | symbols.PAIR
    return [_row(written[key], values[key]) for key in _PAIR.split()]


def load_rows(material: Materials, load: Load, mounting: Mounting) -> list[Row]:
    """Material and load, and the mounting where it is not that of the drawing."""
    words = symbols_of(Material)
    rows: list[tuple[Symbol, Any]] = [
        (words[key]._replace(words=f"{words[key].words}{f', {gear}' if gear else ''}"), value)
        for gear, each in by_gear(material).items()
        for key, value in vars(each).items()
    ]
    rows += [(symbols_of(Load)[key], value) for key, value in vars(load).items()]
    rows += [(symbols_of(Mounting)[key], value) for key, value in vars(mounting).items() if value]
    return [_row(symbol, value) for symbol, value in rows if value is not None]


def rating_rows(result: CheckResult) -> list[Row]:
    """The rating by symbols: values of the pair, then those of each gear, then what the formulas say of a ring."""
    values = result.rating.to_dict()
    rows = [_row(symbol, values[key]) for key, symbol in symbols.RATING.items()]
    gears = (values["pinion"], values["wheel"])
    rows += [_row(symbol, *(gear[key] for gear in gears)) for key, symbol in symbols.GEAR_RATING.items()]
    if formula := values["wheel"].get("formula"):
        rows += [_row(symbol, None, formula[key]) for key, symbol in symbols.RING_FORMULA.items()]
    return rows


def _row(symbol: symbols.Symbol, *values: Any) -> Row:
    unit = {"deg": "°"}.get(symbol.unit, symbol.unit)
    return Row(symbol.words, symbol.symbol, tuple(_text(value) for value in values), unit, symbol.source)


def _text(value: Any) -> str:
    if isinstance(value, tuple | list):
        return " to ".join(_text(each) for each in value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        text = "-" if value is None else str(value)
    else:
        text = f"{value:.6g}" if abs(value) > _ROUNDING else "0"
    return f"{text} (assumed)" if is_assumed(value) else text


def _flat(document: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in document.items():
        found |= _flat(value, f"{prefix}{key}.") if isinstance(value, Mapping) else {prefix + key: value}
    return found
