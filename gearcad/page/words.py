"""The words of the page, in the language of who reads it: English stands in the code, the others in a template."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from fractions import Fraction
from functools import cache
from typing import Any

from gearcad.core.messages import catalogue
from gearcad.core.runtime import templates
from gearcad.core.units import ShownUnit, UnitSystem, measures_in, shown_unit

__all__ = ["PageLanguage", "PageWords", "language_of"]

_FILE = "page_words.toml"

_PARTS = "parts"
"""Table of the template that has, by languages, parts of words."""

_LONG = 11
"""Letters of a word that may have to go on in the next line."""

_LONG_WORD = re.compile(rf"\w{{{_LONG},}}")
_NUMBER = r"[-+±−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_NUMBERS = re.compile(rf"{_NUMBER}(?:(?: | … ){_NUMBER})*(?: (?:mm|deg|GB))?")
_SOFT_HYPHEN = "\u00ad"


class PageLanguage(StrEnum):
    """A language that the page speaks, by its code."""

    ENGLISH = "en"
    GERMAN = "de"

    @property
    def endonym(self) -> str:
        """Name of the language in that language."""
        return {"en": "English", "de": "Deutsch"}[self.value]


@dataclass(frozen=True)
class PageWords:
    """`words["find a key"]` is what stands for these words in the language of the page.

    Fields and derived quantities are found by the words that the schema and `symbols` have for them. What has no other words
    stays English. `words.message(...)` translates what is made of a template and values: notices, reasons, errors. `units` are
    those in which numbers are shown and typed.
    """

    language: PageLanguage
    table: Mapping[str, str] = field(repr=False)
    parts: tuple[str, ...] = field(default=(), repr=False)
    units: UnitSystem = UnitSystem.METRIC

    @classmethod
    def of(cls, language: PageLanguage, units: UnitSystem = UnitSystem.METRIC) -> PageWords:
        """Return the words of a language from the shipped template."""
        tables = _tables()
        code = language.value
        return cls(
            language,
            tables.get(code, {}),
            tuple(tables[_PARTS].get(code, "").split()),
            units,
        )

    def __getitem__(self, english: str) -> str:
        return self.table.get(english, english)

    def number(self, text: str) -> str:
        """Return the text of one or several numbers with the decimal sign of the language; other text as it is."""
        return text.replace(".", ",") if self.language is PageLanguage.GERMAN and _NUMBERS.fullmatch(text) else text

    def unit(self, unit: str, key: str = "") -> ShownUnit:
        """Return the unit in which the page shows numbers that documents have in `unit`; `key` is that of the quantity."""
        shown = shown_unit(self.units, unit, key) or ShownUnit(unit, Fraction(1))
        return shown._replace(name=self.unit_name(shown.name))

    def unit_name(self, unit: str) -> str:
        """Return the name of a unit in the language of the page."""
        return "°" if unit == "deg" else self[unit]

    def measure(self, value: float, decimals: int, unit: str) -> str:
        """Return a number of the documents with its unit, as the page shows it; `decimals` are those in the documents."""
        shown = self.unit(unit)
        return f"{self.number(shown.text(value, decimals))} {shown.name}"

    def divided(self, text: str) -> str:
        """A text whose long words may go on in the next line, before any of the `parts` of which they are made."""
        if not self.parts:
            return text
        joint = re.compile(rf"(?<=\w\w\w)(?={'|'.join(self.parts)})")
        return _LONG_WORD.sub(lambda long: joint.sub(_SOFT_HYPHEN, long[0]), text)

    def message(self, english: str) -> str:
        """Return a notice, reason, verdict or error in the language and the units of the page."""
        known = catalogue(self.language.value)
        text = english if known is None else known.text(english)
        return measures_in(self.units, text, comma=self.language is PageLanguage.GERMAN)


@cache
def _tables() -> Mapping[str, Any]:
    """The words of each language by the English ones, and beside them further tables by languages."""
    return tomllib.loads((templates() / _FILE).read_text(encoding="utf-8"))


def language_of(asked: str | None, accepted: str) -> PageLanguage:
    """The language that the address asks for, else the first of ours that the browser would take (its Accept-Language)."""
    ours = {each.value: each for each in PageLanguage}
    if asked in ours:
        return ours[asked]
    ranked = sorted(accepted.split(","), key=_rank, reverse=True)
    codes = (each.partition(";")[0].strip().lower()[:2] for each in ranked)
    return next((ours[code] for code in codes if code in ours), PageLanguage.ENGLISH)


def _rank(accepted: str) -> float:
    """Return the quality (0 ... 1) that a browser gives one of its languages, such as `de-AT;q=0.8`; 1 if none is given."""
    quality = accepted.partition("q=")[2].strip()
    try:
        return float(quality) if quality else 1.0
    except ValueError:
        return 0.0
