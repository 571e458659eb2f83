"""What gears are called on sheets, by their kind; a name that somebody gave stands behind the word."""

from __future__ import annotations

from gearcad.drawing.words import Words
from gearcad.geometry import Gear, Rack

__all__ = ["kind_of", "titled"]

_NAMED_KINDS = ("pinion", "sun", "planet")
"""Roles that are kinds of gears too."""

_UNNAMED = (*_NAMED_KINDS, "gear", "wheel", "rack", "ring", "carrier")
"""Names of parts that say no more than the words for them."""


def kind_of(role: str, gear: Gear | Rack) -> str:
    """The word for a gear among those of assemblies: of its role, else of its form."""
    if isinstance(gear, Rack):
        return "rack"
    if role in _NAMED_KINDS:
        return role
    return "ring" if gear.internal else "wheel"


def titled(words: Words, kind: str, *names: str) -> str:
    """The word for a kind, and the first of its names that says more."""
    word, name = words[f"assembly.{kind}"], next((name for name in names if name not in _UNNAMED), "")
    return f"{word} {name}" if name else word
