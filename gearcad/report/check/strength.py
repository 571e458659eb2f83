"""The section of a check on strength: stresses of finite elements and of the rating, and the safeties of both."""

from __future__ import annotations

from typing import NamedTuple

from gearcad.check.strength import CheckStrength, FoundStrength
from gearcad.per_gear import Role
from gearcad.plots.paper import short
from gearcad.rating.strength import Part
from gearcad.report.sentences import sentences
from gearcad.report.strength.tables import Group, factor_groups
from gearcad.report.written import written

__all__ = ["StrengthRow", "StrengthSection", "strength_section"]

_NONE = "–"  # an en dash where there is no value

_PARTS = {Part.FLANK: "contact", Part.ROOT: "root"}


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
    """Of a check."""
    rows = [_row(of, part, role, found) for part, both in of.parts.items() for role, found in both.items()]
    told = [written(sentences("strength_check.txt", macro, of)) for macro in ("applied", "contained", "nonlinear", "contact")]
    groups = factor_groups(of.rating, of.rating.to_dict()) if of.judged else []
    reasons: dict[str, list[str]] = {}
    for part, both in of.parts.items():
        for role, found in both.items():
            if found.reason:
                reasons.setdefault(found.reason, []).append(f"{part.value} of the {role.value}")
    return StrengthSection(rows, reasons, [each for each in told if each], groups, of.rating.assumed, of.rating.verify)


def _row(of: CheckStrength, part: Part, role: Role, found: FoundStrength) -> StrengthRow:
    rated, nominal = found.rated, of.rating.nominal
    stress = nominal.contact_stresses if part is Part.FLANK else nominal.root_stresses
    style = "" if rated.safety is None else "good" if rated.safety >= rated.required else "bad"
    return StrengthRow(
        words=f"{_PARTS[part]}, {role.value}",
        nominal=short(stress.pick(role)),
        found=_text(found.stress),
        rated=_text(found.rated_stress),
        raised=_text(found.raised),
        strength=_text(rated.strength),
        required=short(rated.required),
        rated_safety=_text(rated.safety),
        found_safety=_text(found.safety),
        style=style,
        found_style="" if found.safety is None else "aside" if found.below else "good",
    )


def _text(value: float | None) -> str:
    return _NONE if value is None else short(value)
