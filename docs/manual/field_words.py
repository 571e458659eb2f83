"""What a key can be and what it is by default, in words, as the schema of the inputs says it."""

from __future__ import annotations

from dataclasses import is_dataclass
from enum import Enum
from typing import Any

from gearcad.core.quantities import ELSEWHERE, Choice, FieldSchema, Member, Range, Whole
from gearcad.designs.keys import OF_SPECS
from gearcad.designs.spec import AUTO, CLEAR
from gearcad.geometry.gear_parts import NAMED_RACKS

__all__ = ["clause", "default", "fields_default", "fields_permitted", "permitted"]

_IN_PAIRS = {"profile_shift": (AUTO,), "tip_alteration": (AUTO, CLEAR)}
"""Words that gears of pairs take at these keys, beside numbers."""

_NAMED = {"gear": "that of the file, or of its table", "pair": "that of the file", "rack": "that of the file, or `rack`"}
"""What the names of these are where they are not given."""


def permitted(key: str, field: FieldSchema) -> str:
    """What may stand at a key."""
    words = tuple(f"`{word}`" for word in field.words)
    words += tuple(f"`{word}` (pairs)" for word in _IN_PAIRS.get(key, ()))
    return ", or ".join(filter(None, (_kind(field), ", ".join(words))))


def fields_permitted(key: str, field: FieldSchema) -> str:
    """The same of a field in Python, whose parts are objects."""
    objects = [f"`{each.__name__}`" for each in field.members if isinstance(each, type) and is_dataclass(each)]
    return ", ".join(objects) if objects else permitted("", field)


def fields_default(field: FieldSchema) -> str:
    """The default of a field in Python."""
    if is_dataclass(field.default) and not isinstance(field.default, type):
        made = field.default == type(field.default)()
        return f"`{type(field.default).__name__}()`" if made else f"`{field.default!r}`"
    return default("", field.name, field)


def _kind(field: FieldSchema) -> str:
    if ELSEWHERE in field.marks:
        return "name of a file"
    if field.switch:
        return "`true`, `false`"
    if isinstance(field.permitted, Choice):
        return _listed(field.permitted.words)
    choices = field.choices or (field.permitted.choices if isinstance(field.permitted, Member) else None)
    if choices is not None:
        return _listed(member.value for member in choices)
    if field.symbol == OF_SPECS["rack"].symbol:
        return _listed(NAMED_RACKS)
    if field.texts:
        return "list of texts"
    if field.text:
        return "text"
    of_one = _number(field)
    if field.nested:
        return f"list of lists of numbers{of_one and f', {of_one}'}"
    if field.several:
        return f"{of_one or 'number'}; a list{' too' if float in field.members else ''}"
    return of_one


def _listed(words: Any) -> str:
    return ", ".join(f"`{word}`" for word in words)


def _number(field: FieldSchema) -> str:
    permitted = field.permitted
    if isinstance(permitted, Range):
        return _range(permitted)
    if isinstance(permitted, Whole):
        least = f"0 or {permitted.least}" if permitted.may_vanish else str(permitted.least)
        found = f"whole, {least} to {permitted.most}"
        if permitted.negative is not None:
            highest, meaning = permitted.negative
            found += f", or −{permitted.most} to −{-highest}: {meaning}"
        return found
    return "whole number" if field.whole else "number"


def _range(permitted: Range) -> str:
    least, most = permitted.least, permitted.most
    if permitted.signed:
        return f"0, or {_said(least or 0)} to {_said(most)} with either sign"
    if least is None and most is None:
        return "any number"
    above = "above " if permitted.ends[0] == "(" else ""
    if most is None:
        said = f"{above or 'from '}{_said(least)}"
    else:
        said = f"{above}{_said(least)} to {'below ' if permitted.ends[1] == ')' else ''}{_said(most)}"
    return f"0, or {said}" if permitted.may_vanish else said


def _said(number: float | None) -> str:
    """A number with as many digits as it has, and the true minus."""
    if number is None:
        return "∞"
    text = f"{number:g}" if abs(number) < 1e6 else f"{number:g}".replace("e+0", "e").replace("e+", "e")
    return text.replace("e-0", "e-").replace("-", "−")


def default(table: str, key: str, field: FieldSchema) -> str:
    """What a key of a table is where it is not given."""
    if key == "name" and table in _NAMED:
        return _NAMED[table]
    if field.required:
        return "must be given"
    if field.stand_in is not None:
        return f"must be given, or `{field.stand_in.other}`"
    value = field.default
    if getattr(value, "derived", False):
        return "derived"
    if value is None or value in ((), "", {}):
        return "none"
    return _value(value)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "`true`" if value else "`false`"
    if isinstance(value, Enum):
        return _value(value.value)
    if isinstance(value, str):
        return f"`{value}`"
    if isinstance(value, int | float):
        return _said(value)
    if isinstance(value, tuple | list):
        return ", ".join(map(_value, value))
    raise TypeError(f"a default of {type(value).__name__}")


def clause(source: str) -> str:
    """Where a quantity stands: of ISO 21771 where no other standard is named."""
    return f"ISO 21771, {source}" if source[:1].isdigit() or source.startswith("Annex") else source
