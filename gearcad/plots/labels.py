"""How the quantities of a picture are written."""

from __future__ import annotations

import re
import textwrap

from gearcad.designs.columns import column_symbol

__all__ = ["axis_label", "mathtext", "plain", "wrapped"]


def axis_label(key: str) -> str:
    """Words, symbol (as mathtext) and unit of a column: "pinion: tip diameter $d_{\\mathrm{a}}$ in mm"."""
    found = column_symbol(key)
    if found is None:
        return plain(key)
    owner, symbol = found
    unit = {"deg": "°"}.get(symbol.unit, symbol.unit)
    parts = (owner and f"{plain(owner)}:", symbol.words, mathtext(symbol.symbol), unit and f"in {unit}")
    return " ".join(part for part in parts if part)


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
