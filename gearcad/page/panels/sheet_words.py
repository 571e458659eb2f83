"""What sheets say of a design - what it is, of which gears, yes and no - in the words of the page."""

from __future__ import annotations

import re

from gearcad.page.words import Words

__all__ = ["called", "quantity_in", "title_in", "value_in"]

_TEETH = ("spur", "helical", "double helical")

_KINDS = (
    *(f"{before}{teeth} {kind}" for kind in ("gear", "pair") for before in ("", "internal ") for teeth in _TEETH),
    *(f"{teeth} {kind}" for kind in ("rack", "pinion and rack") for teeth in _TEETH[:2]),
    *("planetary train of type", "train", "inertias"),
)
"""Of which titles of designs are made."""

_VALUES = ("yes", "no", "infinite", "spur only")
"""Values that are words; what specs say, as they say it."""

_QUANTITIES = ("single contact factor", "tip clearance")
"""Quantities of a gear that is called as somebody likes."""

_WORDS = re.compile(r"[a-z][a-z ]+[a-z]")
_OF_A_GEAR = re.compile(rf"({'|'.join(_QUANTITIES)}) of the (.+)")


def title_in(words: Words, title: str) -> str:
    """What a design is: "helical pair, z = 13 / 44"."""
    return _WORDS.sub(lambda found: words[found[0]] if found[0] in _KINDS else found[0], title)


_ASSUMED = " (assumed)"


def value_in(words: Words, text: str) -> str:
    """A value as shown."""
    if text.endswith(_ASSUMED):
        return f"{value_in(words, text.removesuffix(_ASSUMED))} ({words['assumed']})"
    return words[text] if text in _VALUES else text


def called(words: Words, name: str) -> str:
    """What gears, and those that mesh, are called: as the tables of specs, if they are called as these."""
    parts = [words.table.get(part.replace("_", " ").capitalize()) for part in name.split("-")]
    return "-".join(part for part in parts if part) if all(parts) else name


def quantity_in(words: Words, english: str) -> str:
    """The words of a quantity."""
    if english not in words.table and (found := _OF_A_GEAR.fullmatch(english)) and found[1] in words.table:
        return f"{words[found[1]]} ({called(words, found[2])})"
    return words[english]
