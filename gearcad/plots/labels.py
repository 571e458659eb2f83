"""How the quantities of a picture are written."""

from __future__ import annotations

import re
import textwrap

from gearcad import symbols

__all__ = ["axis_label", "mathtext", "plain", "wrapped"]

_OTHER_LABELS = {
    "seconds": "time to make the row in s",
}
"""Columns that are no quantity of the data sheet."""


def axis_label(key: str) -> str:
    """Words, symbol (as mathtext) and unit of a column: "pinion: tip diameter $d_{\\mathrm{a}}$ in mm"."""
    found = _find_symbol(key)
    if key in _OTHER_LABELS or found is None:
        return _OTHER_LABELS.get(key, plain(key))
    owner, symbol = found
    unit = {"deg": "°"}.get(symbol.unit, symbol.unit)
    parts = (owner and f"{owner}:", symbol.words, mathtext(symbol.symbol), unit and f"in {unit}")
    return " ".join(part for part in parts if part)


def _find_symbol(key: str) -> tuple[str, symbols.Symbol] | None:
    """Whose the quantity of a column is ("" where that goes without saying), and how it is written."""
    table, _, field = key.partition(".")
    tables = {
        "gear": symbols.GEAR,
        "pinion": symbols.GEAR,
        "wheel": symbols.GEAR,
        "pair": symbols.GEAR | symbols.PAIR,
        "material": symbols.MATERIAL,
        "load": symbols.LOAD,
        "mounting": symbols.MOUNTING,
        "rating": symbols.RATING_OPTIONS,
    }
    known = tables.get(table, {})
    if field in known:
        return (table if table in ("pinion", "wheel") else ""), known[field]
    field, _, owner = field.rpartition(".")
    return (owner, known[field]) if field in known and owner in ("pinion", "wheel") else None


def mathtext(symbol: str) -> str:
    """The symbol with its index upright: h_aP* becomes $h_{\\mathrm{aP}}^{*}$, and T1A $T_1A$."""
    if not symbol:
        return ""
    body, _, index = symbol.rstrip("*").partition("_")
    body = re.sub(r"(?<=[A-Z])(\d)", r"_\1", body)
    return f"${body}" + (f"_{{\\mathrm{{{index}}}}}" if index else "") + ("^{*}$" if symbol.endswith("*") else "$")


def plain(text: str) -> str:
    """A text of the user's, not to be taken for mathtext."""
    return text.replace("$", r"\$")


def wrapped(text: str, width: int) -> str:
    return "\n".join(textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False))
