"""How our types show themselves: in a Python session one line, with only what was given, in a notebook a small picture;
which values were given; and how large counts are written.
"""

from __future__ import annotations

from dataclasses import MISSING, fields
from enum import Enum
from importlib import import_module
from typing import Any

__all__ = ["Pictured", "concise", "grouped", "is_assumed", "is_usual"]


class Pictured:
    """A result that a notebook shows as its first picture, which `plots` draws when it is asked for."""

    def _repr_html_(self) -> str:
        html: str = import_module("gearcad.plots.first").shown_in_notebook(self)
        return html


def is_assumed(value: Any) -> bool:
    """Return whether a value of a field is its default, which nobody gave (see `AssumedNumber`).

    >>> from gearcad.schema import AssumedCount
    >>> is_assumed(AssumedCount(6)), is_assumed(6)
    (True, False)
    """
    return bool(getattr(value, "assumed", False))


def is_usual(value: Any, default: Any) -> bool:
    """Return whether a value of a field says no more than its default: equal to it, and not given where that is assumed.

    >>> from gearcad.schema import AssumedCount
    >>> is_usual(AssumedCount(6), AssumedCount(6)), is_usual(6, AssumedCount(6)), is_usual(0.0, 0.0)
    (True, False, True)
    """
    return bool(value == default) and (is_assumed(value) or not is_assumed(default))


def concise(self: Any) -> str:
    """The `__repr__` of a dataclass: the fields that differ from their defaults, as one would type them.

    Values that say they are `derived` are left out, so that the text evaluates to an equal object.
    """
    given = []
    for each in fields(self):
        value, default = getattr(self, each.name), each.default
        if each.default_factory is not MISSING:
            default = each.default_factory()
        if not getattr(value, "derived", False) and (default is MISSING or not is_usual(value, default)):
            given.append(f"{each.name}={(value.value if isinstance(value, Enum) else value)!r}")
    return f"{type(self).__name__}({', '.join(given)})"


def grouped(number: int) -> str:
    """A whole number, its thousands apart."""
    return f"{number:,}".replace(",", "\u202f")
