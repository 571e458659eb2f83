"""Errors of gearcad, the checks of single values that raise them, and limits rounded for messages.

Every error has two parents: `GearcadError`, so that one clause catches all of ours, and the builtin that fits.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from dataclasses import fields
from enum import Enum
from functools import cache
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


Choice = TypeVar("Choice", bound=Enum)

_LONGEST_PATH = 300
"""Largest number of characters of a path in a message."""

LONGEST_VALUE = 120
"""Largest number of characters of a wrong value that a message repeats, so that it stays one readable line."""


def printable(text: str) -> str:
    """Return the text in one line, with unprintable characters escaped."""
    return text if text.isprintable() else repr(text)[1:-1]


def shown(text: str, most: int = LONGEST_VALUE) -> str:
    """Return a user's name or key for a message: printable, and cut short."""
    text = printable(text[: most + 1])  # cut before it grows, too
    return text if len(text) <= most else f"{text[: most - 3]}..."


def shortened(text: str, most: int) -> str:
    """Return a text with at most `most` characters, printable: a longer one lacks its middle."""
    if len(text) <= most and text.isprintable():
        return text
    text = printable(text if len(text) <= 2 * most else text[:most] + text[-most:])  # cut before it grows, too
    end = most // 3
    return text if len(text) <= most else f"{text[: most - end - 3]}...{text[-end:]}"


def shown_path(path: object) -> str:
    """Return a path as a message has it: printable, without its middle if it is very long."""
    return shortened(str(path), _LONGEST_PATH)


def format_number(value: object) -> str:
    """Return a number as a user would type it: up to ten significant digits, no trailing zeros; anything else cut short."""
    if isinstance(value, Enum):
        return repr(value.value)
    try:
        if isinstance(value, bool) or not isinstance(value, int | float):
            return shown(repr(value[: 2 * LONGEST_VALUE] if isinstance(value, str | bytes | list | tuple) else value))
        # Adding zero makes -0.0 a plain zero.
        return f"{value + 0.0:.10g}"
    except (OverflowError, ValueError):  # a whole number beyond any float, or with more digits than Python writes
        return f"a number of {_digits(value)} digits" if isinstance(value, int) else f"a {type(value).__name__}"


def _digits(value: int) -> int:
    """Return the number of decimal digits of a large whole number, give or take one."""
    return math.ceil(value.bit_length() * math.log10(2))


_WHOLE = re.compile(r"(Annotated\[)?int\b")
"""Annotations of fields that are whole numbers."""

_MOST_EXACT = 2**53
"""Largest whole number up to which a float holds every one; a larger one is left to the checks."""


class GearcadError(Exception):
    """Any error that gearcad raises on purpose."""


class InputError(GearcadError, ValueError):
    """An input that is not permitted: `parameter`, `value`, `unit` and the sentence `permitted`."""

    def __init__(self, parameter: str, value: Any, permitted: str, unit: str = "") -> None:
        super().__init__(parameter, value, permitted, unit)
        self.parameter = parameter
        self.value = value
        self.permitted = permitted
        self.unit = unit

    def __str__(self) -> str:
        if self.value is None and self.permitted.startswith("must be given"):
            return f"{shown(self.parameter)} is missing: {self.permitted}"
        unit = f" {self.unit}" if self.unit else ""
        return f"{shown(self.parameter)} = {format_number(self.value)}{unit}: {self.permitted}"

    def within(self, owner: str) -> Self:
        """Return the same error seen from the owner of the parameter: `body` turns `bore` into `body.bore`."""
        return type(self)(f"{owner}.{self.parameter}", self.value, self.permitted, self.unit)


class ParameterError(InputError):
    """One value that is not permitted, whatever the others are."""


class GeometryError(InputError):
    """A combination of permitted values that makes no gear; `parameter` is the one to change first."""


class OutputError(ParameterError):
    """A place that cannot be written."""


class SpecError(GearcadError, ValueError):
    """A spec file or table that cannot be used; the text names the file, the line or row, and the key.

    `key` is the dotted key at fault, "" where it is none; an InputError that began it is the `__cause__`.
    """

    def __init__(self, message: str, key: str = "") -> None:
        super().__init__(message)
        self.key = key


class SolverError(GearcadError, RuntimeError):
    """An iteration that did not reach its tolerance."""


def plain_numbers(instance: Any) -> None:
    """Turn the numbers among the fields of a frozen dataclass into Python's own, and whole lengths into floats.

    So numpy's numbers are accepted, and equal inputs print, compare and save as equal.
    """
    for name, whole in _fields_of(instance.__class__):
        value = getattr(instance, name)
        if isinstance(value, _NO_CHANGE) or not isinstance(value, Real) or _is_marked(value):
            continue
        if isinstance(value, Integral) and (whole or abs(int(value)) > _MOST_EXACT):
            object.__setattr__(instance, name, int(value))
        else:
            object.__setattr__(instance, name, float(value))


def _is_marked(value: Any) -> bool:
    """Return whether a number is marked as not given by the user."""
    return getattr(value, "derived", False) or getattr(value, "assumed", False)


_NO_CHANGE = (float, str, bool, tuple, type(None))


@cache
def _fields_of(kind: type[DataclassInstance]) -> tuple[tuple[str, bool], ...]:
    """Return the fields of a dataclass, and whether each is a whole number."""
    return tuple((each.name, _WHOLE.match(str(each.type)) is not None) for each in fields(kind))


def require_number(
    parameter: str,
    value: Any,
    unit: str = "",
    *,
    above: float | None = None,
    below: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
) -> None:
    """Raise ParameterError unless `value` is a finite number inside the stated bounds (in `unit`)."""
    finite = is_finite_number(value)
    inside = (
        finite
        and (above is None or value > above)
        and (at_least is None or value >= at_least)
        and (below is None or value < below)
        and (at_most is None or value <= at_most)
    )
    if inside:
        return
    bounds = [
        f"{words} {format_number(bound)}{' ' if unit else ''}{unit}"
        for words, bound in (("above", above), ("at least", at_least), ("below", below), ("at most", at_most))
        if bound is not None
    ]
    permitted = "must be a number" + (" " + " and ".join(bounds) if bounds else f" in {unit}" if unit else "")
    raise ParameterError(parameter, value, permitted, unit if finite or isinstance(value, float) else "")


def is_finite_number(value: Any) -> bool:
    """Return whether a value is a finite number that a float can hold; True and False are none."""
    try:
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:
        return False


def require_one_of(parameter: str, value: Any, choices: Collection[str]) -> None:
    """Raise ParameterError unless `value` is one of some words."""
    if not isinstance(value, str) or value not in choices:
        *most, last = (f'"{choice}"' for choice in choices)
        raise ParameterError(parameter, value, f"must be {', '.join(most)} or {last}")


def require_name(parameter: str, value: Any) -> None:
    """Raise ParameterError unless `value` is a text that any file format can hold: not blank, no control characters."""
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise ParameterError(parameter, value, "must be a text that is not blank, without control characters")


def require_whole(parameter: str, value: Any, *, at_least: int, at_most: int) -> None:
    """Raise ParameterError unless `value` is a whole number (`int`) in the closed interval."""
    if isinstance(value, bool) or not isinstance(value, int) or not at_least <= value <= at_most:
        inside = isinstance(value, float) and value.is_integer() and at_least <= value <= at_most
        written = f" (write {value:.0f}, not {value!r})" if inside else ""
        raise ParameterError(parameter, value, f"must be a whole number from {at_least} to {at_most}{written}")


def require_switch(parameter: str, value: Any) -> None:
    """Raise ParameterError unless `value` is true or false."""
    if not isinstance(value, bool):
        raise ParameterError(parameter, value, "must be true or false")


def as_path(parameter: str, value: Any) -> Path:
    """Return a path that is given as one or as a text; raises ParameterError."""
    if not isinstance(value, str | Path) or "\0" in str(value):
        raise ParameterError(parameter, value, "must be a path, as a text or a Path")
    return Path(value)


def as_choice(parameter: str, value: Any, kind: type[Choice]) -> Choice:
    """Return the member of an enum, given as a member or as its value; raises ParameterError naming all the values."""
    try:
        return kind(value)
    except ValueError:
        choices = ", ".join(repr(member.value) for member in kind)
        raise ParameterError(parameter, value, f"must be one of {choices}") from None


def out_of_memory(error: MemoryError) -> str:
    """Return a message of one line for a MemoryError, with the requested amount if it is known."""
    reason = " ".join(str(error).split())
    return f"there is not enough memory{f' ({shown(reason)})' if reason else ''}; ask for less, or free some"


def at_most(value: float, digits: int = 6) -> str:
    """`value` rounded down to `digits` significant digits, for "must be at most" and "must be below"."""
    if value == 0:
        return "0"
    step = digits - 1 - math.floor(math.log10(abs(value)))
    rounded = round(value, step)
    if rounded > value:
        rounded = round(rounded - 10.0**-step, step)
    return f"{rounded:.{digits}g}"


def at_least(value: float, digits: int = 6) -> str:
    """`value` rounded up to `digits` significant digits, for "must be at least" and "must be above"."""
    mirrored = at_most(-value, digits)
    return mirrored[1:] if mirrored.startswith("-") else ("0" if value == 0 else f"-{mirrored}")
