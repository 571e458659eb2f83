"""The values of a spec, which need not make a design: for studies, and as a design table holds them."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date
from pathlib import Path
from typing import NamedTuple

from gearcad.designs.cells import nested_text, texts_cell
from gearcad.designs.column_keys import LISTS, NESTED, SWITCHES, TEXT_LISTS
from gearcad.designs.design import DesignKind
from gearcad.designs.files import Where, read_tables
from gearcad.designs.keys import MAIN_TABLES, Cell
from gearcad.designs.kinds import type_of
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.designs.named_files import names_file
from gearcad.designs.reader import kind_of
from gearcad.designs.spec import Given, Spec
from gearcad.designs.train_keys import general_key
from gearcad.designs.train_values import values_of
from gearcad.errors import ParameterError, SpecError, format_number

__all__ = ["SpecValues", "read_values", "spec_values"]


class SpecValues(NamedTuple):
    """What a spec says: its kind and name, and its other values under their keys, each with the key that the user wrote."""

    kind: DesignKind
    name: str
    values: dict[str, Given]
    where: Where


def read_values(path: Path | str) -> SpecValues:
    """The values of a spec, which need not make a design. Raises SpecError."""
    tables, where = read_tables(path)
    kind = kind_of(tables)
    made, main = type_of(kind), MAIN_TABLES[kind][0]
    spec = made.spec(tables, where) if issubclass(made, ToothedDesign) else Spec(values_of(tables, where), where)
    name = spec.name(main, Path(path).stem)
    return SpecValues(kind, name, {key: given for key, given in spec.values.items() if key != f"{main}.name"}, where)


def spec_values(path: Path | str) -> tuple[DesignKind, str, dict[str, Cell]]:
    """Kind and name of a spec, and its other values under their dotted keys as a design table holds them: "auto" is a text.

    The values need not make a gear. Raises SpecError, for a value that no cell can hold too.
    """
    kind, name, values, where = read_values(path)
    listed = next((key for key in values if "[" in key), None) if kind is DesignKind.PLANETARY else None
    if listed is not None:
        raise SpecError(f"{where(listed)}: {listed}: no table holds lists of tables", listed)
    return kind, name, {key: _cell(key, given, where) for key, given in values.items()}


def _cell(key: str, given: Given, where: Where) -> Cell:
    """A value as a cell can hold it."""
    value = given.value
    if general_key(key) in LISTS and isinstance(value, list | tuple) and all(type(item) in (int, float) for item in value):
        return tuple(float(item) for item in value)
    if key == "train.model" and isinstance(value, tuple):
        raise SpecError(
            f"{where(key)}: {key} = {format_number(value)}: no cell of a table holds several models: give one word", key
        )
    if isinstance(value, Mapping) and names_file(key):
        raise SpecError(f"{where(given.key)}: {given.key}: no table holds a pair: write it to a file, and its name here", key)
    if general_key(key) in NESTED and isinstance(value, list | tuple):
        return nested_text(value) if all(isinstance(each, list | tuple) for each in value) else format_number(value)
    if key in TEXT_LISTS and isinstance(value, list | tuple):
        try:
            return texts_cell(value, key)
        except ParameterError as error:
            raise SpecError(f"{where(given.key)}: {error}", key) from error
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, bool) and general_key(key) in SWITCHES:
        return "true" if value else "false"
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise SpecError(f"{where(given.key)}: {given.key} = {format_number(value)}: must be a number or a text")
    return value
