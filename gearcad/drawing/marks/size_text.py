"""What a dimension says of a size: value, fit, limits; as one sees it, and as a CAD program holds it."""

from __future__ import annotations

from gearcad.drawing.marks.written import Written, boxed, deviations, plain, ringed
from gearcad.drawing.words import Size, Words

__all__ = ["cad_words", "written_size"]

_AIR = 0.35
"""Between the parts of a size, over the height of its text."""

_MOST_DECIMALS = 4
"""Of deviations: half of a standard tolerance may end with half a micrometre (JS7 of 8: 0.0075)."""

_OF_CAD = {"\\": "\\\\", "{": "\\{", "}": "\\}", "⌀": "%%c", "±": "%%p", "°": "%%d"}


def written_size(size: Size, words: Words, height: float = 3.5) -> Written:
    """Value, fit, limit deviations (one above the other, or ± where they are alike), E in a ring; an exact one in a box."""
    opening, closing = ("(", ")") if size.reference else ("", "")
    air = _AIR * height
    whole = plain(opening + _nominal(size, words), height)
    if size.fit:
        whole = whole.then(plain(size.fit, height), air)
    limits = _limits(size, words)
    if limits is not None:
        alike, upper, lower = limits
        whole = whole.then(plain("±" + alike, height) if alike else deviations(upper, lower, height), air)
    if closing:
        whole = whole.then(plain(closing, height))
    if size.envelope:
        whole = whole.then(ringed("E", height), air)
    return boxed(whole) if size.exact else whole


def cad_words(size: Size, words: Words, measured: float) -> str:
    """What the text of a CAD program's dimension holds: "%%c<> H7 {\\S+0.025^0;}".

    "<>" stands for what it measures, where that (mm) is what the size is.
    """
    opening, closing = ("(", ")") if size.reference else ("", "")
    nominal = _nominal(size, words)
    if words.shortest(size.value, size.decimals) == words.shortest(measured, size.decimals):
        nominal = size.prefix + "<>" + size.suffix
    parts = [opening + _escaped(nominal)]
    if size.fit:
        parts.append(_escaped(size.fit))
    limits = _limits(size, words)
    if limits is not None:
        alike, upper, lower = limits
        parts.append("%%p" + alike if alike else f"{{\\H0.7x;\\S{upper}^{lower};}}")
    if size.envelope:
        parts.append("(E)")
    return " ".join(parts) + closing


def _nominal(size: Size, words: Words) -> str:
    return size.prefix + words.shortest(size.value, size.decimals) + size.suffix


def _limits(size: Size, words: Words) -> tuple[str, str, str] | None:
    """Deviation of either sign if both are alike (else ""), the upper one, the lower one; None without deviations."""
    if size.upper is None or size.lower is None:
        return None
    decimals = max(_decimals(size.upper), _decimals(size.lower))
    upper, lower = (_deviation(each, decimals, words) for each in (size.upper, size.lower))
    alike = upper[1:] if upper.startswith("+") and lower == "−" + upper[1:] else ""
    return alike, upper, lower


def _deviation(value: float, decimals: int, words: Words) -> str:
    text = words.number(value, decimals, signed=True)
    return text if text[:1] in "+−" else "0"


def _decimals(value: float) -> int:
    """How many it needs."""
    text = f"{value:.{_MOST_DECIMALS}f}".rstrip("0")
    return len(text) - text.index(".") - 1


def _escaped(text: str) -> str:
    return "".join(_OF_CAD.get(letter, letter) for letter in text)
