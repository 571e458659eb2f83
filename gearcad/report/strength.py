"""Report of a rating, and the section on strength in the report of a check."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.check.comparison import CheckStrength, FoundStrength
from gearcad.core import symbols
from gearcad.core.quantities import symbols_of
from gearcad.core.records import PerGear, Role, is_assumed, is_usual
from gearcad.core.symbols import Symbol
from gearcad.geometry import GearPair
from gearcad.material import Material
from gearcad.plots.gears import plot_sliding
from gearcad.plots.paper import short
from gearcad.plots.ratings import plot_flash, plot_life
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import INFINITE, RatedPart, StrengthRating
from gearcad.report.document import (
    ReportFigure,
    ReportRow,
    gear_rows,
    page_html,
    pair_picture,
    pair_rows,
    picture_address,
    sentences,
    written,
)
from gearcad.sheet.trains import (
    LONGEST_LIFE,
    OF_PLASTIC,
    Quantity,
    factor_quantities,
    plastic_quantities,
    safety_quantities,
)

_NONE = "–"  # an en dash where there is no value


class Group(NamedTuple):
    """Rows of factors that belong together."""

    title: str
    rows: list[ReportRow]


def safety_rows(rating: StrengthRating, document: Mapping[str, Any]) -> list[ReportRow]:
    """Return the rows of the safeties: of flanks and roots, then of scuffing.

    Of flanks and roots they are the safety, the required safety, torque, damage, life and cycles.
    """
    return [_row(each, rating.names) for each in safety_quantities(rating, document)]


def factor_groups(rating: StrengthRating, document: Mapping[str, Any]) -> list[Group]:
    """All factors and stresses, each with its clause."""
    groups = factor_quantities(rating, document)
    groups |= {OF_PLASTIC: found} if (found := plastic_quantities(rating, document)) else {}
    return [Group(title, [_row(each, rating.names) for each in quantities]) for title, quantities in groups.items()]


def option_rows(options: RatingOptions) -> list[ReportRow]:
    """Return the rows of [rating] options that differ from their defaults, and of the standards."""
    written = symbols_of(RatingOptions)
    always = ("standard", "accuracy", "accuracy_grade")
    return [
        ReportRow(
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


def material_rows(materials: PerGear[Material]) -> list[ReportRow]:
    """Return the rows of the known properties of both materials."""
    written = symbols_of(Material)
    found = ((written[each.name], [getattr(of, each.name) for of in materials]) for each in fields(Material))
    return [
        ReportRow(of.words, of.symbol, tuple(map(_listed, values)), of.unit, of.source)
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
                    *case.stresses[RatedPart.FLANK],
                    *case.stresses[RatedPart.ROOT],
                ),
            )
        )
        for case in rating.cases
    ]


def tolerance_rows(document: Mapping[str, Any], names: PerGear[str]) -> list[ReportRow]:
    """Return the rows of flank tolerances by accuracy grade, and of limits of dimensions by tooth thickness allowance."""
    both = names.map(lambda name: document["tolerances"][name] or {})
    thickness = PerGear(*(values.get("thickness_limits", {}) for values in both))
    flanks = {"grade": Symbol("", "", "ISO 1328-1", "accuracy grade")} | symbols.TOLERANCES
    doubtful = {key for values in both for key in values.get("verify", ())}
    return [*_given(flanks, both, doubtful), *_given(_below("thickness_limits", symbols.GEAR), thickness)]


def uncovered_tolerances(rating: StrengthRating, document: Mapping[str, Any]) -> list[str]:
    """Return the reasons why the standard does not cover all tolerances, by gear."""
    found = ((own, document["tolerances"][name] or {}) for name, own in zip(rating.names, rating.gear_names, strict=True))
    return [f"{own}: {why}" for own, values in found for why in values.get("not_covered", ())]


def backlash_rows(document: Mapping[str, Any]) -> list[ReportRow]:
    """Return rows of the least and the greatest backlash, if tolerances define them."""
    return _given(_below("backlash_limits", symbols.PAIR), [document["tolerances"].get("backlash_limits", {})])


def _below(part: str, written: Mapping[str, Symbol]) -> dict[str, Symbol]:
    """Symbols of a part of a document, under its own keys."""
    return {key.removeprefix(f"{part}."): symbol for key, symbol in written.items() if key.startswith(f"{part}.")}


def _given(
    written: Mapping[str, Symbol], columns: Sequence[Mapping[str, Any]], doubtful: Collection[str] = ()
) -> list[ReportRow]:
    """Rows of what some column has, each under its symbol."""
    rows = []
    for key, of in written.items():
        values = [column.get(key) for column in columns]
        if any(value is not None for value in values):
            text = _length if of.unit == "mm" else _text
            source = f"{of.source} (unconfirmed)" if key in doubtful else of.source
            rows.append(ReportRow(of.words, of.symbol, tuple(map(text, values)), of.unit, source))
    return rows


def _length(value: float | None) -> str:
    """Return a length to 0.1 µm: limits differ in digits that short numbers do not have."""
    return _NONE if value is None else f"{value:.4f}"


def _row(of: Quantity, names: PerGear[str]) -> ReportRow:
    text = _hours if of.symbol.unit == "h" else _text
    values = tuple(text(of.value[name]) for name in names) if isinstance(of.value, Mapping) else (text(of.value),)
    source = f"{of.symbol.source} (unconfirmed)" if of.verify else of.symbol.source
    return ReportRow(of.symbol.words, of.symbol.symbol, values, of.symbol.unit, source)


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


def write_rate_report(rating: StrengthRating, design_name: str, path: Path, head: Mapping[str, str] | None = None) -> None:
    """Write the report of the rating of a design's pair to `path`; the same rating gives the same bytes."""
    path.write_text(rate_html(rating, design_name, head), encoding="utf-8", newline="\n")


def rate_html(rating: StrengthRating, design_name: str, head: Mapping[str, str] | None = None) -> str:
    """The report as one HTML document without links."""
    document = rating.to_dict()
    pair = rating.pair if isinstance(rating.pair, GearPair) else None
    return page_html(
        "rate.html",
        design_name,
        head,
        of=rating,
        names=list(rating.gear_names),
        pair_picture=None if pair is None else pair_picture(pair),
        safeties=safety_rows(rating, document),
        groups=factor_groups(rating, document),
        spectrum=spectrum_rows(rating),
        tolerances=tolerance_rows(document, rating.names),
        backlash=backlash_rows(document),
        uncovered=uncovered_tolerances(rating, document),
        options=option_rows(rating.options),
        gear_rows=[] if pair is None else gear_rows(pair),
        pair_rows=[] if pair is None else pair_rows(pair),
        materials=material_rows(rating.materials),
        figures=_figures(rating),
    )


def _figures(rating: StrengthRating) -> list[ReportFigure]:
    """Specific sliding, what flanks and roots bear over load cycles, and temperatures along the path of contact."""
    sliding = picture_address(partial(plot_sliding, rating.pair), "svg")
    found = [
        ReportFigure(
            "Specific sliding along the path of contact", sliding, sentences("captions_rate.txt", "sliding", rating.pair)
        ),
        *_lives(rating),
    ]
    if (scuffing := rating.scuffing) is not None and scuffing.flash is not None:
        address = picture_address(partial(plot_flash, scuffing), "svg")
        found.append(
            ReportFigure("Temperature along the path of contact", address, sentences("captions_rate.txt", "flash", scuffing))
        )
    return found


def _lives(rating: StrengthRating) -> list[ReportFigure]:
    """Return the figures of the strength of flanks and roots over load cycles, where it is known."""
    return [
        ReportFigure(
            f"What the {part.value}s bear",
            picture_address(partial(plot_life, rating, part), "svg"),
            sentences("captions_rate.txt", "life", rating, part),
        )
        for part, both in rating.parts.items()
        if any(each.resistance is not None for each in both)
    ]


_PARTS = {RatedPart.FLANK: "contact", RatedPart.ROOT: "root"}


class StrengthRow(NamedTuple):
    """A flank or root: nominal stress of both, stress with all load factors of both, strength, safeties."""

    words: str
    nominal: str
    found: str
    rated: str
    raised: str
    strength: str
    required: str
    rated_safety: str
    found_safety: str
    style: str
    found_style: str


class StrengthSection(NamedTuple):
    """Rows, reasons why parts were not judged, sentences, the factors of the rating, and what it has assumed.

    The sentences say what is in the model and what is not.
    """

    rows: list[StrengthRow]
    reasons: dict[str, list[str]]
    sentences: list[str]
    groups: list[Group]
    assumed: tuple[str, ...]
    verify: tuple[str, ...]


def strength_section(of: CheckStrength) -> StrengthSection:
    """Return the section on strength of a check."""
    rows = [_strength_row(of, part, role, found) for part, both in of.parts.items() for role, found in both.items()]
    told = [written(sentences("strength_check.txt", macro, of)) for macro in ("applied", "contained", "nonlinear", "contact")]
    groups = factor_groups(of.rating, of.rating.to_dict()) if of.judged else []
    reasons: dict[str, list[str]] = {}
    for part, both in of.parts.items():
        for role, found in both.items():
            if found.reason:
                reasons.setdefault(found.reason, []).append(f"{part.value} of the {of.rating.names.pick(role)}")
    return StrengthSection(rows, reasons, [each for each in told if each], groups, of.rating.assumed, of.rating.verify)


def _strength_row(of: CheckStrength, part: RatedPart, role: Role, found: FoundStrength) -> StrengthRow:
    rated, nominal = found.rated, of.rating.nominal
    stress = nominal.contact_stresses if part is RatedPart.FLANK else nominal.root_stresses
    style = "" if rated.safety is None else "good" if rated.safety >= rated.required else "bad"
    return StrengthRow(
        words=f"{_PARTS[part]}, {of.rating.names.pick(role)}",
        nominal=short(stress.pick(role)),
        found=_strength_text(found.stress),
        rated=_strength_text(found.rated_stress),
        raised=_strength_text(found.raised),
        strength=_strength_text(rated.strength),
        required=short(rated.required),
        rated_safety=_strength_text(rated.safety),
        found_safety=_strength_text(found.safety),
        style=style,
        found_style="" if found.safety is None else "aside" if found.below else "good",
    )


def _strength_text(value: float | None) -> str:
    return _NONE if value is None else short(value)
