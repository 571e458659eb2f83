"""What the page has of the inputs of a spec: a field for every key its tables may have, as the schema of the inputs says it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import Enum
from typing import Any

from gearcad.designs.cells import list_text, nested_text, texts_cell
from gearcad.designs.design import Design, DesignKind
from gearcad.designs.keys import BESIDE, FIELDS, MAIN_TABLES, OF_SETS, Fields
from gearcad.errors import GearcadError
from gearcad.ranges import Choice, Member, Range, Whole
from gearcad.schema import FieldSchema

__all__ = ["fields_of", "given_texts", "used_texts"]

_TITLES = {
    "": "",
    "rack": "Basic rack",
    "cutter": "Shaper cutter",
    "double_helix": "Double helix",
    "modification": "Flank modifications",
}
_LATER = ("mesh", "dynamics", "drawing", "check")
"""Tables of jobs that one asks for: the page has them folded."""


def fields_of(design: Design) -> list[dict[str, Any]]:
    """The tables of a kind's specs in order, each with its groups of fields: what the browser makes inputs of.

    A train's parts are lists of tables, which stand in its text only.
    """
    if design.kind is DesignKind.TRAIN:
        return []
    return [
        {"table": table, "folded": table in _LATER, "groups": list(_groups(table, fields))}
        for table, fields in _tables(design).items()
    ]


def _tables(design: Design) -> Fields:
    if design.kind is DesignKind.PLANETARY:
        from gearcad.designs.planetary_keys import PLANETARY

        return {table: PLANETARY[table] for table in PLANETARY if table not in OF_SETS or table in design.gears}
    beside = [table for table in BESIDE if hasattr(design, table)]
    return {table: FIELDS[table] for table in (*MAIN_TABLES[design.kind], *beside)}


def _groups(table: str, fields: Mapping[str, FieldSchema]) -> Iterator[dict[str, Any]]:
    """The fields of a table, those of its parts together, each with its part's name."""
    groups: dict[str, list[dict[str, Any]]] = {"": []}
    for key, field in fields.items():
        groups.setdefault(key.rpartition(".")[0], []).append(_field(f"{table}.{key}", field))
    for part, of_part in groups.items():
        yield {
            "part": part,
            "title": _TITLES.get(part, part.replace("_", " ").replace(".", ": ").capitalize()),
            "fields": of_part,
        }


def _field(key: str, field: FieldSchema) -> dict[str, Any]:
    """What the browser needs of one field; numbers are typed as text, so that what is half typed is not lost."""
    symbol = field.symbol
    least, most = _bounds(field)
    return {
        "key": key,
        "words": symbol.words or key.rpartition(".")[2].replace("_", " "),
        "symbol": symbol.symbol,
        "unit": symbol.unit,
        "source": symbol.source,
        "choices": _choices(field),
        "special": list(field.words),
        "whole": field.whole,
        "required": field.required,
        "several": field.several,
        "least": least,
        "most": most,
    }


def _bounds(field: FieldSchema) -> tuple[float | None, float | None]:
    """What a number can be, as far as one range says it."""
    permitted = field.permitted
    if isinstance(permitted, Range):
        return (None if permitted.most is None else -permitted.most) if permitted.signed else permitted.least, permitted.most
    if isinstance(permitted, Whole):
        return (-permitted.most if permitted.negative else permitted.least), permitted.most
    return None, None


def _choices(field: FieldSchema) -> list[str]:
    """The words that it can be; none of what can be anything else."""
    if field.switch:
        return ["true", "false"]
    if isinstance(field.permitted, Choice):
        return list(field.permitted.words)
    kind = field.choices or (field.permitted.choices if isinstance(field.permitted, Member) else None)
    return [str(member.value) for member in kind] if kind is not None else []


def given_texts(tables: Mapping[str, Any]) -> dict[str, str]:
    """What a spec says, as one types it, under dotted keys; what no field can hold is left to the text."""
    return {key: text for key, value in _flat(tables) if (text := _typed(key, value)) is not None}


def used_texts(design: Design) -> dict[str, str]:
    """What a design uses - given, shared, derived or by default - under the same keys: it stands in empty fields."""
    return {key: text for key, value in _flat(design.to_dict()) if (text := _typed(key, value)) is not None}


def _flat(content: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in content.items():
        key = f"{before}{name}"
        if isinstance(value, Mapping):
            yield from _flat(value, f"{key}.")
        else:
            yield key, value


def _typed(key: str, value: Any) -> str | None:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, str | int):
        return str(value)
    if isinstance(value, float):
        return repr(round(value, 9) + 0.0).removesuffix(".0")
    if isinstance(value, list | tuple) and value:
        try:
            if all(isinstance(each, int | float) for each in value):
                return list_text(value)
            if all(isinstance(each, list | tuple) for each in value) and not isinstance(value[0][0], str):
                return nested_text(value)
            return texts_cell(value, key)
        except (GearcadError, IndexError, TypeError):
            return None
    return None
