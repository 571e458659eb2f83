"""Places in a TOML text: on which line a key stands, which tomllib does not say, and where the syntax breaks."""

from __future__ import annotations

import re
import tomllib
from collections import Counter

__all__ = ["explain_syntax", "find_lines", "nearest_line"]

_PART = r"""(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')"""
_DOTTED = rf"{_PART}(?:\s*\.\s*{_PART})*"
_HEADER = re.compile(rf"\s*\[\[?\s*({_DOTTED})\s*\]\]?")
_ASSIGNMENT = re.compile(rf"\s*({_DOTTED})\s*=\s*(.*)")
_INLINE = re.compile(rf"[{{,]\s*({_DOTTED})\s*=")
_MULTILINE_QUOTES = ('"""', "'''")


def _plain(dotted: str) -> str:
    """`a . "b"` as `a.b`."""
    return ".".join(part.strip("\"'") for part in re.findall(_PART, dotted))


def find_lines(text: str) -> dict[str, int]:
    """Line number (from 1) of every table header and key, under its full dotted name.

    Follows headers, dotted keys and inline tables on one line, counts tables in lists from 0 (`mesh[0].teeth`); skips texts
    over several lines. The first mention wins.
    The text is taken to be valid TOML: what a stranger layout hides has no line, which only costs the message its number.
    """
    lines: dict[str, int] = {}
    lists: Counter[str] = Counter()
    table, closing = "", ""
    for number, line in enumerate(text.split("\n"), start=1):
        if closing:
            closing = "" if closing in line else closing
            continue
        if header := _HEADER.match(line):
            table = _inside(_plain(header[1]), lists)
            lines.setdefault(table, number)
            if line.lstrip().startswith("[["):
                lists[table] += 1
                table = f"{table}[{lists[table] - 1}]"
                lines.setdefault(table, number)
        elif assignment := _ASSIGNMENT.match(line):
            key = ".".join(filter(None, (table, _plain(assignment[1]))))
            lines.setdefault(key, number)
            value = assignment[2]
            if value.startswith("{"):
                for inner in _INLINE.finditer(value):
                    lines.setdefault(f"{key}.{_plain(inner[1])}", number)
            closing = next((quotes for quotes in _MULTILINE_QUOTES if value.count(quotes) == 1), "")
    return lines


def _inside(table: str, lists: Counter[str]) -> str:
    """A table's name, with the number of the table in a list that it stands in: `mesh[0].pair` below [[mesh]]."""
    for name in sorted(lists, key=len, reverse=True):
        if table.startswith(f"{name}."):
            return f"{name}[{lists[name] - 1}]{table.removeprefix(name)}"
    return table


def nearest_line(lines: dict[str, int], key: str) -> int | None:
    """Line of `key`, else of the innermost table around it that has one."""
    while key not in lines and "." in key:
        key = key.rpartition(".")[0]
    return lines.get(key)


def explain_syntax(error: tomllib.TOMLDecodeError, text: str) -> str:
    """The end of the message about broken TOML: place and reason, and the commonest mistake by its name."""
    place = re.search(r" \(at line (\d+), column (\d+)\)$", str(error))
    if place is None:
        return f": is not valid TOML: {error}"
    hint = ""
    if comma := re.search(r"=\s*([-+]?\d+),(\d+)", text.split("\n")[int(place[1]) - 1]):
        hint = f"; write {comma[1]}.{comma[2]} with a point"
    return f" line {place[1]}, column {place[2]}: is not valid TOML: {str(error)[: place.start()]}{hint}"
