"""Tables of a rating: safeties, factors by what they are of, materials, loads, tolerances."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields
from typing import Any, NamedTuple

from gearcad import symbols
from gearcad.material import Material
from gearcad.per_gear import PerGear, Role
from gearcad.plots.paper import short
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import INFINITE, Part, StrengthRating
from gearcad.report.check.tables import Row
from gearcad.schema import symbols_of
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

_TOLD = {
    "permissible_torque": Symbol("T_1", "N·m", "", "torque on the pinion at the required safety"),
    "life": Symbol("", "h", "", "life at the required safety"),
    "damage": Symbol("D", "", "ISO 6336-6", "damage over the life at the required safety"),
}

_CYCLES = {Part.FLANK: "ISO 6336-2, 11", Part.ROOT: "ISO 6336-3, 12"}
"""Where the standard counts load cycles."""

_LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""

_GROUPS = {
    "Load factors": "K_A K_gamma K_v K_Hbeta K_Fbeta K_Halpha K_Falpha",
    "Contact stress": "Z_H Z_E Z_eps Z_beta Z_B Z_D sigma_H0 sigma_H",
    "What the flanks bear": "sigma_Hlim Z_NT Z_L Z_v Z_R Z_W Z_X sigma_HG sigma_HP",
    "Root stress": "Y_F Y_S Y_beta Y_B Y_DT sigma_F0 sigma_F",
    "What the roots bear": "sigma_Flim Y_ST Y_NT Y_delta_relT Y_RrelT Y_X Y_M sigma_FG sigma_FP",
}


_OF_ONE = {"Z_B": Role.PINION, "Z_D": Role.WHEEL}
"""Whose factor it is, of those that documents have by themselves."""


class Group(NamedTuple):
    """Rows of factors that belong together."""

    title: str
    rows: list[Row]


def safety_rows(rating: StrengthRating, document: Mapping[str, Any]) -> list[Row]:
    """Of flanks and roots: safety beside the required one, cycles, torque, life, damage; then of scuffing."""
    rows = []
    for part in Part:
        safety = symbols.STRENGTH[f"S_{part.index}"]
        rows.append(_row(safety, document["safety"][part.value], rating.names))
        rows.append(
            Row(
                f"required safety of the {part.value}",
                f"{safety.symbol}min",
                (_text(document["required"][part.value]),),
                "",
                "",
            )
        )
        torque = _TOLD["permissible_torque"]._replace(words=f"torque on the {rating.gear_names.pinion} at the required safety")
        for told, key in ((torque, "permissible_torque"), (_TOLD["damage"], "damage")):
            rows.append(_row(told, document[key][part.value], rating.names))
        hours = {name: _hours(value) for name, value in document["life"][part.value].items()}
        rows.append(_row(_TOLD["life"], hours, rating.names))
        cycles = symbols.STRENGTH["N_L"]._replace(source=_CYCLES[part])
        rows.append(_row(cycles, document["load_cycles"][part.value], rating.names))
    for symbol, key in (("S_int", "integral"), ("S_B", "flash")):
        rows.append(_row(symbols.STRENGTH[symbol], document["safety"]["scuffing"][key], rating.names))
    return rows


def factor_groups(rating: StrengthRating, document: Mapping[str, Any]) -> list[Group]:
    """All factors and stresses, each with its clause."""
    values, verify = {**document["factors"], **document["stresses"]}, {each.rpartition(".")[2] for each in rating.verify}
    sources = document["sources"]

    def row(key: str) -> Row:
        symbol = symbols.STRENGTH[key]
        value, words = values[key], symbol.words
        if key in _OF_ONE:
            role = _OF_ONE[key]
            value = _of_one(rating.names, role, value)
            words = words.replace(role.value, rating.gear_names.pick(role))
        symbol = symbol._replace(source=sources.get(key, symbol.source), words=words)
        return _row(symbol, value, rating.names, key in verify)

    found = [Group(title, [row(key) for key in keys.split() if key in values]) for title, keys in _GROUPS.items()]
    written, details = symbols.LOAD_FACTOR_DETAILS, document["load_factors"] or {}
    behind = [_row(written[key], value, rating.names) for key, value in details.items() if key in written]
    found.insert(1, Group("Behind the load factors", behind))
    return [group for group in found if group.rows]


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
        if (value := getattr(options, each.name)) != each.default or each.name in always
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


def _hours(value: float | str | None) -> float | str | None:
    """A life; beyond all machines no digits are told."""
    return f"> {short(_LONGEST_LIFE)}" if isinstance(value, float) and value > _LONGEST_LIFE else value


def _row(symbol: Symbol, value: Any, names: PerGear[str], verify: bool = False) -> Row:
    values = tuple(_text(value[name]) for name in names) if isinstance(value, Mapping) else (_text(value),)
    source = f"{symbol.source} (verify)" if verify else symbol.source
    return Row(symbol.words, symbol.symbol, values, symbol.unit, source)


def _of_one(names: PerGear[str], role: Role, value: float) -> dict[str, float | None]:
    """A value of one gear; the other has none."""
    return {name: value if each is role else None for each, name in names.items()}


def _listed(value: Any) -> str:
    return ", ".join(map(_text, value)) if isinstance(value, Sequence) and not isinstance(value, str) else _text(value)


def _text(value: Any) -> str:
    if value is None:
        return _NONE
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return INFINITE if math.isinf(value) else short(value) if value else "0"
    return str(value)
