"""Tables of a rating: safeties, factors by what they are of, materials, loads, tolerances."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields
from typing import Any, NamedTuple

from gearcad import symbols
from gearcad.material import Material
from gearcad.per_gear import PerGear
from gearcad.plots.paper import short
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import INFINITE, Part, StrengthRating
from gearcad.report.check.tables import Row
from gearcad.schema import is_assumed, is_usual, symbols_of
from gearcad.sheet.strength import LONGEST_LIFE, Quantity, factor_quantities, safety_quantities
from gearcad.symbols import Symbol

__all__ = [
    "Group",
    "backlash_rows",
    "factor_groups",
    "material_rows",
    "option_rows",
    "safety_rows",
    "spectrum_rows",
    "tolerance_rows",
    "uncovered_tolerances",
]

_NONE = "–"  # an en dash where there is no value


class Group(NamedTuple):
    """Rows of factors that belong together."""

    title: str
    rows: list[Row]


def safety_rows(rating: StrengthRating, document: Mapping[str, Any]) -> list[Row]:
    """Of flanks and roots: safety beside the required one, torque, damage, life, cycles; then of scuffing."""
    return [_row(each, rating.names) for each in safety_quantities(rating, document)]


def factor_groups(rating: StrengthRating, document: Mapping[str, Any]) -> list[Group]:
    """All factors and stresses, each with its clause."""
    groups = factor_quantities(rating, document)
    return [Group(title, [_row(each, rating.names) for each in quantities]) for title, quantities in groups.items()]


def option_rows(options: RatingOptions) -> list[Row]:
    """What [rating] says that is not left as it would be without it, and the standards."""
    written = symbols_of(RatingOptions)
    always = ("standard", "accuracy", "accuracy_grade")
    return [
        Row(
            written[each.name].words,
            written[each.name].symbol,
            (_listed(value),),
            written[each.name].unit,
            written[each.name].source,
        )
        for each in fields(options)
        if not is_usual(value := getattr(options, each.name), each.default) or each.name in always
        if each.name != "spectrum"
    ]


def material_rows(materials: PerGear[Material]) -> list[Row]:
    """What is known of both materials."""
    written = symbols_of(Material)
    found = ((written[each.name], [getattr(of, each.name) for of in materials]) for each in fields(Material))
    return [
        Row(of.words, of.symbol, tuple(map(_listed, values)), of.unit, of.source)
        for of, values in found
        if any(value is not None for value in values)
    ]


def spectrum_rows(rating: StrengthRating) -> list[tuple[str, ...]]:
    """Each load of a spectrum: its share of the life, torque, speed, K_v, K_Hbeta, stresses of both gears."""
    if not rating.options.bins:
        return []
    return [
        tuple(
            map(
                _text,
                (
                    100 * case.life_share,
                    case.load.torque,
                    case.load.speed,
                    case.factors.dynamic,
                    case.factors.face_flank,
                    *case.stresses[Part.FLANK],
                    *case.stresses[Part.ROOT],
                ),
            )
        )
        for case in rating.cases
    ]


def tolerance_rows(document: Mapping[str, Any], names: PerGear[str]) -> list[Row]:
    """What the accuracy grade permits the flanks, and the dimensions that an allowance of the tooth thickness leaves."""
    both = names.map(lambda name: document["tolerances"][name] or {})
    thickness = PerGear(*(values.get("thickness_limits", {}) for values in both))
    flanks = {"grade": Symbol("", "", "ISO 1328-1", "accuracy grade")} | symbols.TOLERANCES
    doubtful = {key for values in both for key in values.get("verify", ())}
    return [*_given(flanks, both, doubtful), *_given(_below("thickness_limits", symbols.GEAR), thickness)]


def uncovered_tolerances(rating: StrengthRating, document: Mapping[str, Any]) -> list[str]:
    """Why the standard has not all of them."""
    found = ((own, document["tolerances"][name] or {}) for name, own in zip(rating.names, rating.gear_names, strict=True))
    return [f"{own}: {why}" for own, values in found for why in values.get("not_covered", ())]


def backlash_rows(document: Mapping[str, Any]) -> list[Row]:
    """Between what the backlash is, where tolerances say."""
    return _given(_below("backlash_limits", symbols.PAIR), [document["tolerances"].get("backlash_limits", {})])


def _below(part: str, written: Mapping[str, Symbol]) -> dict[str, Symbol]:
    """Symbols of a part of a document, under its own keys."""
    return {key.removeprefix(f"{part}."): symbol for key, symbol in written.items() if key.startswith(f"{part}.")}


def _given(written: Mapping[str, Symbol], columns: Sequence[Mapping[str, Any]], doubtful: Collection[str] = ()) -> list[Row]:
    """Rows of what some column has, each under its symbol."""
    rows = []
    for key, of in written.items():
        values = [column.get(key) for column in columns]
        if any(value is not None for value in values):
            text = _length if of.unit == "mm" else _text
            source = f"{of.source} (verify)" if key in doubtful else of.source
            rows.append(Row(of.words, of.symbol, tuple(map(text, values)), of.unit, source))
    return rows


def _length(value: float | None) -> str:
    """To 0.1 µm: limits differ in digits that short numbers do not have."""
    return _NONE if value is None else f"{value:.4f}"


def _row(of: Quantity, names: PerGear[str]) -> Row:
    text = _hours if of.symbol.unit == "h" else _text
    values = tuple(text(of.value[name]) for name in names) if isinstance(of.value, Mapping) else (text(of.value),)
    source = f"{of.symbol.source} (verify)" if of.verify else of.symbol.source
    return Row(of.symbol.words, of.symbol.symbol, values, of.symbol.unit, source)


def _hours(value: float | str | None) -> str:
    """A life; beyond all machines no digits are told."""
    return f"> {short(LONGEST_LIFE)}" if isinstance(value, float) and value > LONGEST_LIFE else _text(value)


def _listed(value: Any) -> str:
    return ", ".join(map(_text, value)) if isinstance(value, Sequence) and not isinstance(value, str) else _text(value)


def _text(value: Any) -> str:
    if value is None:
        return _NONE
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        text = INFINITE if math.isinf(value) else short(value) if value else "0"
    else:
        text = str(value)
    return f"{text} (assumed)" if is_assumed(value) else text
