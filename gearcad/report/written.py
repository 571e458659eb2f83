"""Symbols as pages write them: Greek letters in place of their names, indices lowered, keys of specs as code."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from gearcad import symbols

if TYPE_CHECKING:
    from markupsafe import Markup

__all__ = ["indexed", "listed", "written"]

_KNOWN = {
    key.rpartition(".")[2]: of.symbol
    for table in (symbols.SCUFFING, symbols.GEAR_RATING, symbols.RATING, symbols.STRENGTH)
    for key, of in table.items()
    if "_" in key and of.symbol
} | {"K_Bgamma": "K_Bγ", "F_beta_y": "F_βy", "q_prime": "q'"}
"""By the names that documents have."""

_NAME = re.compile(r"(?<!\w)[A-Za-z]+(?:_[A-Za-z0-9]+)+(?!\w)")

_KEY_OR_INDEX = re.compile(r"(?<![\w.])((?:[a-z]+\.)*[a-z]{2,}[a-z0-9]*(?:_[a-z0-9]+)+)(?!\w)|_([^\s*/,;)]*[^\s*/,;).:])")


def written(text: str) -> str:
    """A text in which symbols stand under the names of documents, such as sigma_Hlim, with their letters: σ_Hlim."""
    return _NAME.sub(lambda name: _KNOWN.get(name[0], name[0]), text)


def indexed(text: str) -> Markup:
    """Symbols with their indices lowered: Y_F, F_t K_A/b; names of more than one letter before "_" are keys, set as code."""
    from markupsafe import Markup, escape

    def set_off(found: re.Match[str]) -> str:
        return f"<code>{found[1]}</code>" if found[1] else f"<sub>{found[2]}</sub>"

    return Markup(_KEY_OR_INDEX.sub(set_off, str(escape(text))))


def listed(names: Iterable[str]) -> str:
    """Symbols that documents list, those of one gear under its name: planet.Y_M, ring.formula."""
    return ", ".join(map(_of_gear, dict.fromkeys(names)))


def _of_gear(name: str) -> str:
    gear, dot, symbol = name.rpartition(".")
    words = "the formulas of the root" if symbol == "formula" else written(symbol)
    return f"{words} of the {gear}" if dot else words
