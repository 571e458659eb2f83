"""A spec with other values: its own text, line by line, with comments and order kept."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Any

from gearcad.designs.lines import find_lines
from gearcad.errors import SpecError

__all__ = ["edit_spec"]

_VALUE = r"""("[^"\n]*"|'[^'\n]*'|[^#,}\s]+)"""


def edit_spec(text: str, values: Mapping[str, float | str], notes: Mapping[str, str] | None = None) -> str:
    """The text of a spec with values under their dotted keys, such as "pinion.modification.tip_relief".

    A value that is there is replaced; a key that is not comes to the end of its table, with a note behind it if it has one.
    Raises SpecError for a layout that cannot be edited.
    """
    newline = "\r\n" if "\r\n" in text else "\n"
    lines = text.replace("\r\n", "\n").rstrip("\n").split("\n")
    for key, value in values.items():
        comment = f"  # {notes[key]}" if notes and key in notes else ""
        lines = _replaced(lines, key, _written(value)) or _inserted(lines, key, _written(value), comment) or lines
    edited = newline.join([*lines, ""])
    _require_edited(text, edited, values)
    return edited


def _written(value: float | str) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(float(value))


def _replaced(lines: list[str], key: str, value: str) -> list[str] | None:
    """With the value of a key that is there."""
    number = find_lines("\n".join(lines)).get(key)
    if number is None:
        return None
    name = re.escape(key.rpartition(".")[2])
    edited = re.sub(rf"""(\b{name}["']?\s*=\s*){_VALUE}""", lambda found: found[1] + value, lines[number - 1], count=1)
    return [*lines[: number - 1], edited, *lines[number:]]


def _inserted(lines: list[str], key: str, value: str, comment: str) -> list[str] | None:
    """With a new key: in the innermost of the tables around it that is there, or beside its dotted sisters."""
    known = find_lines("\n".join(lines))
    table, rest = key.rpartition(".")[0], key.rpartition(".")[2]
    while table:
        number = known.get(table)
        if number is not None and lines[number - 1].lstrip().startswith("["):
            at = number if rest == "name" else _end(lines, number)
            return [*lines[:at], f"{rest} = {value}{comment}", *lines[at:]]
        if number is not None:
            return [*lines[: number - 1], _in_braces(lines[number - 1], f"{rest} = {value}"), *lines[number:]]
        table, _, last = table.rpartition(".")
        rest = f"{last}.{rest}"
    sisters = [number for name, number in known.items() if name.startswith(key.partition(".")[0] + ".")]
    at = max(sisters, default=0)
    return [*lines[:at], f"{key} = {value}{comment}", *lines[at:]] if sisters else None


def _end(lines: list[str], header: int) -> int:
    """How many lines there are up to the last key of the table whose header is line `header`."""
    end = header
    for number in range(header, len(lines)):
        content = lines[number].strip()
        if content.startswith("["):
            break
        if content and not content.startswith("#"):
            end = number + 1
    return end


def _in_braces(line: str, entry: str) -> str:
    """An inline table with one more entry."""
    before, brace, after = line.rpartition("}")
    joint = "" if before.rstrip().endswith("{") else ", "
    return f"{before.rstrip()}{joint}{entry}{brace}{after}"


def _require_edited(text: str, edited: str, values: Mapping[str, float | str]) -> None:
    """Raise SpecError unless the edited text holds the new values, and else what the old one did."""
    expected = tomllib.loads(text)
    for key, value in values.items():
        inner: dict[str, Any] = expected
        *tables, last = key.split(".")
        for table in tables:
            inner = inner.setdefault(table, {})
        inner[last] = value
    try:
        same = tomllib.loads(edited) == expected
    except tomllib.TOMLDecodeError:
        same = False
    if not same:
        wanted = ", ".join(f"{key} = {_written(value)}" for key, value in values.items())
        raise SpecError(f"the layout of the spec cannot be edited; write by hand: {wanted}")
