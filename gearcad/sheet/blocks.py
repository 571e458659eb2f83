"""What a sheet is made of, and how values are written on it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from gearcad.notice import Notice
from gearcad.symbols import Symbol

__all__ = ["ABSENT", "Block", "Row", "Section", "Sheet", "block", "flattened", "value_text"]

ABSENT = "-"
"""What stands where there is no value."""


class Row(NamedTuple):
    """One quantity: its key, how it is written, and in each column its value with all digits and as shown.

    Keys are those of `data.json` behind what the columns are of: `gear.tip_diameter`, `pair.path_of_contact.A`.
    """

    key: str
    symbol: Symbol
    values: tuple[Any, ...]
    texts: tuple[str, ...]


class Block(NamedTuple):
    """Rows that belong together."""

    title: str
    rows: tuple[Row, ...]


class Section(NamedTuple):
    """Blocks with the same columns, by the names above them; none above a single column that needs no name.

    `name` says of what they are, where others are alike: a mesh of a train.
    """

    columns: tuple[str, ...]
    blocks: tuple[Block, ...]
    name: str = ""


class Sheet(NamedTuple):
    """All that is shown of a design: a line that says what it is, its sections, and what to know before making it.

    `units` says what holds where a row has no unit of its own, `clauses` whose the sources are.
    """

    name: str
    title: str
    units: str
    clauses: str
    sections: tuple[Section, ...]
    notices: tuple[Notice, ...]


def block(title: str, rows: Iterable[Row]) -> tuple[Block, ...]:
    """A block of rows, if there are any."""
    found = tuple(rows)
    return (Block(title, found),) if found else ()


def flattened(document: Mapping[str, Any]) -> dict[str, Any]:
    """Nested keys joined by a dot."""
    flat: dict[str, Any] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            flat |= {f"{key}.{inner}": item for inner, item in value.items()}
        else:
            flat[key] = value
    return flat


def value_text(value: Any) -> str:
    """Four digits after the point: 0.1 µm, and enough of a ratio or an angle."""
    if value is None:
        return ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    # Adding zero turns a rounded -0.0 into a plain one.
    return f"{round(value, 4) + 0.0:.4f}" if isinstance(value, float) else str(value)
