"""Words of a sheet in three languages, numbers as each language writes them, and sizes with limits (mm)."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from typing import Any, Self

from gearcad.core.errors import ParameterError
from gearcad.core.runtime import templates
from gearcad.geometry import Gear, Rack
from gearcad.geometry.fits import LARGEST_SIZE, limit_deviations
from gearcad.geometry.spline_part import SplineTeeth


class Language(StrEnum):
    """A language of the sheets; the value is its code of ISO 639-1."""

    ENGLISH = "en"
    GERMAN = "de"
    SWEDISH = "sv"

    @property
    def decimal_mark(self) -> str:
        """The mark between the whole part of a number and its fraction."""
        return "." if self is Language.ENGLISH else ","


_FILE = "drawing_words.toml"


@cache
def _shipped() -> dict[str, Any]:
    """Return the content of the shipped template, which is not to be changed."""
    return tomllib.loads((templates() / _FILE).read_text(encoding="utf-8"))


@dataclass(frozen=True)
class SheetWords:
    """The words of one language. A key is the heading of a part of the template and a name in it: "data.normal_module"."""

    language: Language
    labels: Mapping[str, str] = field(repr=False)

    @classmethod
    def of(cls, language: Language) -> Self:
        """Return the words of a language from the shipped template."""
        entries = ((f"{part}.{name}", in_each) for part, named in _shipped().items() for name, in_each in named.items())
        return cls(language, {key: in_each[language.value] for key, in_each in entries})

    def __getitem__(self, key: str) -> str:
        return self.labels[key]

    def within_text(self, label: str) -> str:
        """Return a label as written in the middle of a sentence: without its capital, except in German, where nouns have
        one.
        """
        return label if self.language is Language.GERMAN else label[:1].lower() + label[1:]

    def number(self, value: float, decimals: int, *, signed: bool = False) -> str:
        """Return a number as a text with this many decimals, a true minus sign and the decimal mark of the language. Zero has
        no sign.
        """
        text = f"{value:{'+' if signed else ''}.{decimals}f}"
        if not text.strip("+-0."):
            text = text.lstrip("+-")
        return text.replace("-", "−").replace(".", self.language.decimal_mark)

    def shortest(self, value: float, decimals: int = 3) -> str:
        """Return a number as a text with at most this many decimals, without zeros at the end."""
        text = self.number(value, decimals)
        mark = self.language.decimal_mark
        return text.rstrip("0").rstrip(mark) if mark in text else text


@dataclass(frozen=True)
class Draughting:
    """The words and the scale of a drawing. `scale` is mm of paper for a mm of the part: 0.5 for 1:2."""

    words: SheetWords
    scale: float = 1.0

    def paper(self, length: float) -> float:
        """Return the length on paper (mm) of a length of the part (mm)."""
        return length * self.scale


@dataclass(frozen=True, kw_only=True)
class Size:
    """A nominal size, the code of its fit ("H7") and its limit deviations; without deviations general tolerances hold.

    `prefix` stands before it ("⌀", "R"), `suffix` behind ("×45°"). `envelope` is the E in a ring of ISO 14405-1, `reference`
    puts it in brackets: it is for information. `exact` puts it in a
    box: what is there has a geometrical tolerance instead (ISO 1101).
    """

    value: float
    prefix: str = ""
    suffix: str = ""
    fit: str = ""
    upper: float | None = None
    lower: float | None = None
    decimals: int = 3
    envelope: bool = False
    reference: bool = False
    exact: bool = False


def toleranced(value: float, fit: str, **of_size: Any) -> Size:
    """Return a size (mm) with the limits of its fit by ISO 286. Without a fit, general tolerances hold.

    General tolerances also hold beyond 3150 mm, where ISO 286 ends. Where a class has no limits here (beyond 500 mm, except h,
    H, js and JS), the size has the class without limits.
    """
    if not fit or value > LARGEST_SIZE:
        return Size(value=value, **of_size)
    try:
        limits = limit_deviations(fit, value)
    except ParameterError:
        return Size(value=value, fit=fit, **of_size)
    return Size(value=value, fit=fit, upper=limits.upper / 1000, lower=limits.lower / 1000, **of_size)


def diameter(value: float, fit: str = "", **of_size: Any) -> Size:
    """Return the diameter of a circle (mm) as a size with the limits of its fit, as `toleranced` does."""
    return toleranced(value, fit, prefix="⌀", **of_size)


def half_tolerance(size: Size) -> float | None:
    """Return half of the tolerance of a size, in whole µm and at least 1 µm; None without limits."""
    if size.upper is None or size.lower is None:
        return None
    return max(float(round((size.upper - size.lower) * 1000) // 2), 1.0)


def as_hole(fit: str) -> str:
    """Return the tolerance class of a hole that has the letter of a shaft's class."""
    return fit.upper()


_NAMED_KINDS = ("pinion", "sun", "planet")
"""Roles that are kinds of gears too."""

_UNNAMED = (*_NAMED_KINDS, "gear", "wheel", "rack", "ring", "carrier")
"""Names of parts that say no more than the words for them."""


def kind_of(role: str, gear: Gear | Rack) -> str:
    """Return the kind of a gear, as assemblies name it: its role if that is a kind too, else its form."""
    if isinstance(gear, Rack):
        return "rack"
    if isinstance(gear, SplineTeeth):
        return "hub" if gear.internal else "shaft"
    if role in _NAMED_KINDS:
        return role
    return "ring" if gear.internal else "wheel"


def titled(words: SheetWords, kind: str, *names: str) -> str:
    """Return the word for a kind, followed by the first of the names that is not itself only such a word."""
    word, name = words[f"assembly.{kind}"], next((name for name in names if name not in _UNNAMED), "")
    return f"{word} {name}" if name else word
