"""Words: labels of one language by their keys, and numbers as it writes them."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Self

from gearcad.drawing.words.language import Language
from gearcad.shipped import templates

__all__ = ["Words"]

_FILE = "drawing_words.toml"


@dataclass(frozen=True)
class Words:
    """Those of a language. A key is the heading of a part of the template, and a name in it: "data.normal_module"."""

    language: Language
    labels: Mapping[str, str] = field(repr=False)

    @classmethod
    def of(cls, language: Language) -> Self:
        """Those of the shipped template."""
        content = tomllib.loads((templates() / _FILE).read_text(encoding="utf-8"))
        labels = {
            f"{part}.{name}": in_each[language.value] for part, entries in content.items() for name, in_each in entries.items()
        }
        return cls(language, labels)

    def __getitem__(self, key: str) -> str:
        return self.labels[key]

    def within_text(self, label: str) -> str:
        """A label in the middle of a sentence: without its capital, but in German, where nouns have one."""
        return label if self.language is Language.GERMAN else label[:1].lower() + label[1:]

    def number(self, value: float, decimals: int, *, signed: bool = False) -> str:
        """With so many decimals, a true minus sign, and the mark of the language; zero has no sign."""
        text = f"{value:{'+' if signed else ''}.{decimals}f}"
        if not text.strip("+-0."):
            text = text.lstrip("+-")
        return text.replace("-", "−").replace(".", self.language.decimal_mark)

    def shortest(self, value: float, decimals: int = 3) -> str:
        """With at most so many decimals, and none that are zero at its end."""
        text = self.number(value, decimals)
        mark = self.language.decimal_mark
        return text.rstrip("0").rstrip(mark) if mark in text else text
