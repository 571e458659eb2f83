"""Variants of a spec: its design with other values of some keys, every combination of them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from gearcad.designs.columns import column_symbol
from gearcad.designs.design import Design, DesignKind
from gearcad.designs.keys import Cell
from gearcad.designs.reader import design_from_values
from gearcad.designs.spec_values import SpecValues, read_values
from gearcad.designs.train_keys import ALL, general_key
from gearcad.designs.variations import Choices, read_variations, without_varied
from gearcad.errors import ParameterError, format_number

__all__ = ["MOST_VARIANTS", "Variants", "read_variants"]

MOST_VARIANTS = 12
"""Curves that one chart can bear."""

_MODEL = "train.model"

Value = Cell | tuple[Cell, ...]
"""Of a key that varies; several of models."""


@dataclass(frozen=True)
class Variants:
    """Designs that differ in `what`, in words with units; `labels` say how, one for each: by the values of one `key`, or, where
    it is "", in words."""

    what: str
    labels: tuple[str, ...]
    designs: tuple[Design, ...]
    key: str = ""


def read_variants(spec: Path | str, variations: Sequence[str]) -> Variants:
    """The designs of a spec (TOML) with keys varied as texts such as "shaft.*.damping_ratio=0.01,0.1" say.

    A key with one value is only set. Several models of a train, and nothing else, are those of one design: a list of models.
    Raises SpecError for the spec and for what makes no design, ParameterError for a variation and for more than MOST_VARIANTS.
    """
    base = read_values(spec)
    read = [each for each in read_variations(variations, base.kind, base.values) if isinstance(each, Choices)]
    _require_few(read)
    found = [each.found_from(Path(spec).parent) for each in read]
    several = [each for each in found if len(each.values) > 1]
    if base.kind is DesignKind.TRAIN and [each.key for each in several] == [_MODEL]:
        one = {each.key: each.values if each.key == _MODEL else each.values[0] for each in found}
        return Variants(_words(_MODEL), (several[0].text,), (_design(base, one),))
    points = [
        dict(zip((each.key for each in found), point, strict=True))
        for point in itertools.product(*(each.values for each in found))
    ]
    names = _short([each.key for each in several])
    labels = [_label({names[key]: point[key] for key in names}) for point in points]
    what = ", ".join(_words(key) for key in names)
    key = several[0].key if len(several) == 1 else ""
    return Variants(what, tuple(labels), tuple(_design(base, point) for point in points), key)


def _require_few(read: Sequence[Choices]) -> None:
    count = math.prod(len(each.values) for each in read)
    if count > MOST_VARIANTS:
        permitted = f"make {count} curves, and one chart can bear {MOST_VARIANTS}: take fewer, or a table of `gearcad study`"
        raise ParameterError("vary", ", ".join(each.key for each in read), permitted)


def _design(base: SpecValues, point: Mapping[str, Value]) -> Design:
    """That of the spec with the values of a point put in."""
    values = {key: given.value for key, given in without_varied(base.values, point).items()} | dict(point)
    return design_from_values(values, base.kind, where=_where(base, point), default_name=base.name)


def _where(base: SpecValues, point: Mapping[str, Value]) -> Callable[[str], str]:
    """Says of a key that varies what its value is, and of another where it stands in the spec."""

    def where(key: str) -> str:
        for each in (key, general_key(key)):
            if each in point:
                value = point[each]
                return f"--vary {each}={_text(value) if isinstance(value, int | float | str) else ','.join(map(str, value))}"
        return base.where(base.values[key].key if key in base.values else key)

    return where


def _words(key: str) -> str:
    """What a key is, whose, and in which unit."""
    found = column_symbol(key)
    if found is None or not found[1].words:
        return key
    owner, symbol = ("" if f".{ALL}." in key else found[0]), found[1]
    return f"{symbol.words}{f' of {owner}' if owner else ''}{f' in {symbol.unit}' if symbol.unit else ''}"


def _short(keys: Sequence[str]) -> dict[str, str]:
    """What the keys are called where there are several: by their last words, as long as these differ."""
    last = [key.rpartition(".")[2].replace("_", " ") for key in keys]
    alike = len(set(last)) < len(last)
    return {key: key if alike else words for key, words in zip(keys, last, strict=True)}


def _label(values: Mapping[str, Cell]) -> str:
    if len(values) == 1:
        return _text(*values.values())
    return ", ".join(f"{name} {_text(value)}" for name, value in values.items())


def _text(value: Cell) -> str:
    """A value as a user would type it, to its last digit."""
    if isinstance(value, tuple):
        return " ".join(map(_text, value))
    shown = format_number(value) if isinstance(value, int | float) else value
    return repr(value) if isinstance(value, float) and float(shown) != value else shown
