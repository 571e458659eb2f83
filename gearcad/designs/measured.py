"""What was measured of a gear, as a file or the command line says it: [measured] in TOML, and readings with "+-"."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gearcad.designs.files import Where, read_tables
from gearcad.designs.keys import nearest_key, permitted_words
from gearcad.errors import InputError, ParameterError, SpecError, shown
from gearcad.identify.measured import Gauge
from gearcad.identify.measurements import Measurements
from gearcad.schema import schema_of

__all__ = ["read_measurements", "reading_of", "size_of"]

_TABLE = "measured"
_UNCERTAIN = re.compile(r"\s*(?:\+-|\+/-|±)\s*")
_SIZED = {gauge.value: gauge for gauge in Gauge if gauge.sized}


def read_measurements(path: Path | str, others: Mapping[str, Any] = MappingProxyType({})) -> Measurements:
    """Read the [measured] of a TOML file; `others`, under the same keys, count before what it says.

    Raises SpecError, one line that names the file, the line, the key and what is permitted, and ParameterError for `others`.
    """
    tables, where = read_tables(path)
    for table in tables:
        if table != _TABLE:
            raise SpecError(f"{where(table)}: [{shown(table)}]: unknown table; what was measured stands in [{_TABLE}]", table)
    if not isinstance(found := tables.get(_TABLE, {}), Mapping):
        raise SpecError(f"{where(_TABLE)}: {_TABLE}: must be a table, [{_TABLE}]", _TABLE)
    values = dict(_values(found, where))
    given = values | {key: {**(values.get(key) or {}), **value} if key in _SIZED else value for key, value in others.items()}
    if "teeth" not in given:
        raise SpecError(f"{where(_TABLE)}: {_TABLE}.teeth is missing: must be given, as counted", f"{_TABLE}.teeth")
    try:
        return Measurements(**given)
    except InputError as error:
        key = error.parameter.partition(".")[0]
        key = "span" if key == "span_teeth" else key
        if key in others or key not in values:
            raise
        full = f"{_TABLE}.{key}{_size(values[key], error.value) if key in _SIZED else ''}"
        raise SpecError(f"{where(full)}: {_TABLE}.{error}", full) from error


def _size(readings: Mapping[float, Any], wrong: Any) -> str:
    """The end of the key of a reading that is wrong, or whose size is."""
    found = (size for size, value in readings.items() if wrong in (size, value) or (isinstance(value, list) and wrong in value))
    return "".join(f".{size:g}" for size in list(found)[:1])


def _values(table: Mapping[str, Any], where: Where) -> Iterator[tuple[str, Any]]:
    fields = schema_of(Measurements)
    for key, value in table.items():
        full = f"{_TABLE}.{key}"
        if key not in fields:
            near = nearest_key(key, fields)
            hint = f"did you mean {near}?" if near else permitted_words(key, tuple(fields))
            raise SpecError(f"{where(full)}: {shown(full)}: unknown key; {hint}", full)
        try:
            yield key, _by_size(_SIZED[key], value) if key in _SIZED else _reading(key, value)
        except ParameterError as error:
            raise SpecError(f"{where(f'{full}.{error.value}')}: {_TABLE}.{error}", full) from error


def _by_size(gauge: Gauge, given: Any) -> dict[float, Any]:
    """{3: 15.40}; `over_pins.3.5 = 52.9`, which TOML takes for {3: {5: 52.9}}, is meant as one reads it."""
    name = gauge.value
    if not isinstance(given, Mapping):
        example = "span.3 = 15.40" if gauge is Gauge.SPAN else f"{name}.3.5 = 52.95"
        raise ParameterError(name, given, f"must have the {gauge.size_in_words} before the reading: {example}")
    found: dict[float, Any] = {}
    for text, value in given.items():
        inner = {f"{text}.{part}": each for part, each in value.items()} if isinstance(value, Mapping) else {text: value}
        for size, reading in inner.items():
            found[size_of(gauge, size)] = _reading(name, reading)
    return found


def size_of(gauge: Gauge, text: str) -> float:
    """The number of teeth spanned, or the diameter of pins or balls, that a text stands for. Raises ParameterError."""
    try:
        return int(text) if gauge is Gauge.SPAN else float(text)
    except ValueError:
        raise ParameterError(gauge.value, text, f"must have a number for the {gauge.size_in_words}") from None


def _reading(name: str, value: Any) -> Any:
    return reading_of(name, value) if isinstance(value, str) else value


def reading_of(name: str, text: str) -> float | tuple[float, float]:
    """A reading, with its own uncertainty if there is one: "52.3+-0.1". Raises ParameterError."""
    try:
        numbers = tuple(map(float, _UNCERTAIN.split(text.strip())))
    except ValueError:
        raise ParameterError(name, text, "must be a number, or a number and its uncertainty: 52.3 or 52.3+-0.1") from None
    if len(numbers) > 2:
        raise ParameterError(name, text, "must have one uncertainty: 52.3+-0.1")
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])
