"""Row: a line of the gear data table, and how rows are written in a language."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from gearcad.drawing.words import Words

__all__ = ["Row", "RowWriter"]


@dataclass(frozen=True, kw_only=True)
class Row:
    """A quantity by its words, its symbol ("d_b" has an index) and its value as a text; lengths are in mm.

    `limits` are the greatest and the least value (or allowance), one above the other behind the text, which may be empty.
    `numbers` are the values that stand in words, text and limits, exactly, under their keys: those of data.json, "pair."
    before those of a pair and "tolerances." before those of the tolerances; of a ring they are negative as there.
    """

    key: str
    words: str
    symbol: str = ""
    text: str = ""
    limits: tuple[str, str] | None = None
    numbers: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class RowWriter:
    """Makes rows in the words of a language, lengths with so many `decimals`; the words of a row are those of its key."""

    words: Words
    decimals: int = 3

    def word(self, key: str) -> str:
        """The words of a key."""
        return self.words[f"data.{key}"]

    def text(self, key: str, text: str, symbol: str = "", numbers: Mapping[str, float] | None = None, **named: str) -> Row:
        """One with a text, in whose words the `named` values stand."""
        return Row(key=key, words=self.word(key).format(**named), symbol=symbol, text=text, numbers=numbers or {})

    def length(self, key: str, value: float, symbol: str = "", name: str = "") -> Row:
        """A length, a ring's without its sign, under its name in data.json (else the key)."""
        return self.text(key, self.words.number(abs(value), self.decimals), symbol, {name or key: value})

    def plain(self, key: str, value: float, symbol: str = "", unit: str = "", name: str = "") -> Row:
        """A number with no more digits than it has, six after the point at the most."""
        return self.text(key, f"{self.words.shortest(value, 6)}{unit}", symbol, {name or key: value})

    def between(self, key: str, symbol: str, limits: Mapping[str, float], **named: str) -> Row:
        """The greatest and the least length, each under its name."""
        greatest, least = (self.words.number(value, self.decimals) for value in limits.values())
        words = self.word(key).format(**named)
        return Row(key=key, words=words, symbol=symbol, limits=(greatest, least), numbers=limits)
