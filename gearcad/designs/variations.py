"""What varies in a study: `KEY=VALUES` as a command has it, and the values that it stands for."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from gearcad.designs.cells import CellReader, Layout
from gearcad.designs.column_keys import COUNTS, TEXTS, explain_unknown_column
from gearcad.designs.design import DesignKind
from gearcad.designs.keys import KEYS, MAIN_TABLES, SPEEDS, Cell
from gearcad.designs.named_files import with_files_found
from gearcad.designs.planetary_keys import PLANETARY
from gearcad.designs.train_keys import ALL, MAIN, PARTS, TORQUES, TrainKey, explain_unknown_key_of_train, general_key
from gearcad.designs.train_values import names_of
from gearcad.errors import ParameterError, format_number
from gearcad.geometry.diametral import MODULE_OR_PITCH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["MOST_ROWS", "Choices", "Span", "read_variation", "read_variations", "without_varied"]

MOST_ROWS = 1_000_000
"""Rows of the largest study: beyond it a number was mistyped, or one table is not the way."""

_BESIDE = {
    DesignKind.GEAR: ("material", "load", "drawing"),
    DesignKind.RACK: ("material", "drawing"),
    DesignKind.RACK_PAIR: ("material", "load", "rating", "drawing"),
}
"""Tables beside those of the teeth whose keys may vary; a pair has all others."""

_SIZES_OF_RACKS = ("teeth", "length")
"""One of them is given."""

_INSTEAD = {
    ("mesh", "damping"): ("damping_ratio",),
    ("mesh", "damping_ratio"): ("damping",),
    ("mesh", "pair"): ("base_radii", "teeth", "internal", "stiffness", "variation", "shape", "contact_ratio"),
    ("shaft", "torsional_stiffness"): ("length", "diameter", "inner_diameter"),
}
"""What a part of a train gives up when another key of it varies."""

_MOST_SHOWN = 6
"""Values of a wrong list that a message repeats."""


Value = TypeVar("Value")


@dataclass(frozen=True)
class Choices:
    """A key that takes one of several values; `text` says them as the user did."""

    key: str
    text: str
    values: tuple[Cell, ...]

    def at(self, fractions: NDArray[np.float64]) -> list[Cell]:
        """The values at fractions 0 ... 1 of the list."""
        return [self.values[int(fraction * len(self.values))] for fraction in fractions]

    def found_from(self, folder: Path) -> Choices:
        """With files, which are seen from the `folder` of the spec, as they are found from here."""
        return replace(self, values=tuple(with_files_found({self.key: each}, folder)[self.key] for each in self.values))


@dataclass(frozen=True)
class Span:
    """A key that takes any value between two ends, or any whole one."""

    key: str
    text: str
    first: float
    last: float
    whole: bool

    def at(self, fractions: NDArray[np.float64]) -> list[Cell]:
        """The values at fractions 0 ... 1 of the way from the first to the last; as likely the one as the other."""
        low, high = sorted((self.first, self.last))
        if self.whole:
            return [int(low) + int(fraction * (high - low + 1)) for fraction in fractions]
        return [float(low + fraction * (high - low)) for fraction in fractions]

    def found_from(self, _folder: Path) -> Span:
        """Numbers are no files."""
        return self


def read_variations(
    texts: Sequence[str], kind: DesignKind, base: Collection[str], *, sampled: bool = False
) -> tuple[Choices | Span, ...]:
    """What several `KEY=VALUES` say of a design whose spec has the keys `base`. Raises ParameterError, also for a key twice."""
    read = tuple(read_variation(text, kind, base, sampled=sampled) for text in texts)
    keys = [variation.key for variation in read]
    for text, key in zip(texts, keys, strict=True):
        if keys.count(key) > 1:
            raise ParameterError("vary", text, f"{key} is varied more than once; put all its values in one --vary")
    return read


def read_variation(text: str, kind: DesignKind, base: Collection[str] = (), *, sampled: bool) -> Choices | Span:
    """What one `KEY=VALUES` says; the keys `base` of its spec say which parts a train has."""
    name, _, values = (part.strip() for part in _parted(text, kind, base))
    if not name or not values:
        raise ParameterError("vary", text, "must be KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE ...")
    key = _key_of_train(text, name, base) if kind is DesignKind.TRAIN else _full_key(text, name, kind)
    if ":" not in values or "," in values or general_key(key) in TEXTS:
        return _choices(text, key, values, _listed(text, key, values))
    first, last, count = _ends(text, key, values, counted=not sampled)
    if not sampled:
        return _choices(text, key, values, _spaced(text, first, last, count))
    _require_whole(text, key, (first, last))
    return Span(key, values, first, last, whole=general_key(key) in COUNTS)


def _parted(text: str, kind: DesignKind, base: Collection[str]) -> tuple[str, str, str]:
    """Key and values; the names of a train's parts may have = in them."""
    if kind is DesignKind.TRAIN:
        for place in (place for place, sign in enumerate(text) if sign == "="):
            key = _known_to_train(text[:place].strip(), base)
            if key is not None:
                return key, "=", text[place + 1 :]
    return text.partition("=")


def _known_to_train(name: str, base: Collection[str]) -> str | None:
    """The full key of a train with these keys; None for what it does not have."""
    names = names_of(base)
    for key in (name, f"{MAIN}.{name}"):
        found = TrainKey.of(key)
        if found is None:
            continue
        if found.table in PARTS and (not names[found.table] if found.name == ALL else found.name not in names[found.table]):
            continue
        if found.field != TORQUES or found.name in names["inertia"]:
            return key
    return None


def _key_of_train(text: str, name: str, base: Collection[str]) -> str:
    """The key of a train; one without a table belongs to [train]."""
    key = _known_to_train(name, base)
    if key is not None:
        return key
    if name in ("name", f"{MAIN}.name"):
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    raise ParameterError("vary", text, explain_unknown_key_of_train(name, names_of(base)))


def _full_key(text: str, name: str, kind: DesignKind) -> str:
    """The key with its table; one without belongs to [pair] or [gear]."""
    main = MAIN_TABLES[kind][0]
    if kind is DesignKind.PLANETARY:
        return _key_of_planetary(text, name)
    table, _, field = (main, "", name) if name in KEYS[main] else name.partition(".")
    if field not in KEYS.get(table, ()):
        raise ParameterError("vary", text, explain_unknown_column(name, main))
    beside = _BESIDE.get(kind, tuple(owner for owner in KEYS if owner not in ("gear", "rack")))
    permitted = [owner for owner in KEYS if owner in (*MAIN_TABLES[kind], *beside)]
    if table not in permitted:
        tables = ", ".join(f"[{owner}]" for owner in permitted)
        raise ParameterError("vary", text, f"the spec makes a {main}; permitted are keys of {tables}")
    if (table, field) == (main, "name"):
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    return f"{table}.{field}"


def _key_of_planetary(text: str, name: str) -> str:
    """The key of a planetary train; one without a table belongs to [planetary]."""
    main = DesignKind.PLANETARY.value
    key = name if name.partition(".")[0] in PLANETARY else f"{main}.{name}"
    table, _, field = key.partition(".")
    if field not in PLANETARY[table] and not (table == main and field.startswith(f"{SPEEDS}.")):
        raise ParameterError("vary", text, explain_unknown_column(name, main))
    if key == f"{main}.name":
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    return key


def _value(key: str, text: str) -> Cell:
    """What a cell with this text would be; the sum makes -0.0 a plain zero."""
    value = CellReader(Layout.COMMA).value(key, text, 0)
    return "" if value is None else value + 0.0 if isinstance(value, float) else value


def _ends(text: str, key: str, values: str, *, counted: bool) -> tuple[float, float, str]:
    """The two ends of a span, and the text of the count ("" where there must be none)."""
    parts = [part.strip() for part in values.split(":")]
    ends = [value for part in parts[:2] if isinstance(value := _value(key, part), int | float)]
    if len(ends) < 2 or len(parts) != (3 if counted else 2):
        permitted = (
            "must be FIRST:LAST:COUNT in numbers" if counted else "must be FIRST:LAST in numbers; --n says how many rows"
        )
        raise ParameterError("vary", text, permitted)
    if ends[0] == ends[1]:
        raise ParameterError("vary", text, f"must not have the same number at both ends; for one value write {parts[0]}")
    return ends[0], ends[1], parts[2] if counted else ""


def _spaced(text: str, first: float, last: float, count: str) -> list[Cell]:
    """Evenly spaced values, each the nearest to the true one: 0.1 and not 0.09999999999999998."""
    number = int(count) if re.fullmatch("[0-9]{1,7}", count) else 0
    if not 2 <= number <= MOST_ROWS:
        raise ParameterError("vary", text, f"must have a whole number from 2 to {MOST_ROWS} as its count")
    start, end = Fraction(repr(first)), Fraction(repr(last))
    exact = (start + (end - start) * step / (number - 1) for step in range(number))
    return [int(value) if isinstance(first, int) and value.denominator == 1 else float(value) for value in exact]


def _listed(text: str, key: str, values: str) -> list[Cell]:
    items = [item.strip() for item in values.split(",")]
    if "" in items:
        raise ParameterError("vary", text, "must have a value on both sides of a comma")
    return [_value(key, item) for item in items]


def _choices(text: str, key: str, words: str, values: list[Cell]) -> Choices:
    _require_whole(text, key, values)
    value, times = Counter(values).most_common(1)[0]
    if times > 1:
        raise ParameterError("vary", text, f"must have each value once; {format_number(value)} is there {times} times")
    return Choices(key, words, tuple(values))


def _require_whole(text: str, key: str, values: Sequence[Cell]) -> None:
    if general_key(key) in COUNTS and not all(isinstance(value, int) for value in values):
        shown = ", ".join(map(format_number, values[:_MOST_SHOWN])) + (" ..." if len(values) > _MOST_SHOWN else "")
        raise ParameterError("vary", text, f"must make whole numbers of {key}, not {shown}")


# ---------------------------------------------------------------------- what gives way


def without_varied(base: Mapping[str, Value], varied: Collection[str]) -> dict[str, Value]:
    """The values of a spec that stand beside keys that vary: not those in whose place these are."""
    return {key: value for key, value in base.items() if not _replaced(key, varied)}


def _replaced(key: str, varied: Collection[str]) -> bool:
    """Whether a module gives way to a diametral pitch of its table that varies, or that to it; so a rack's teeth and length.

    What a part of a train has of its own gives way to what varies for all parts.
    """
    table, _, field = key.partition(".")
    if table == "rack" and field in _SIZES_OF_RACKS:
        return any(f"rack.{other}" in varied for other in _SIZES_OF_RACKS)
    if field in MODULE_OR_PITCH:
        return any(f"{table}.{other}" in varied for other in MODULE_OR_PITCH)
    part = TrainKey.of(key) if table in PARTS else None
    if part is None or not part.name:
        return False
    instead = [part._replace(field=other) for (home, other), gone in _INSTEAD.items() if home == table and part.field in gone]
    return part.general in varied or any(each.general in varied or str(each) in varied for each in instead)
