"""Parameter studies: a design table of one spec with some of its keys varied, which `batch` then runs.

Without a sample every combination of the values is a row, the last key changing fastest; with one, so many rows are drawn.
"""

from __future__ import annotations

import csv
import itertools
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from gearcad.designs.cells import CellReader, Layout, guarded_text, list_text
from gearcad.designs.design import LONGEST_NAME, LONGEST_NAME_IN_BYTES, DesignKind
from gearcad.designs.keys import KEYS, Cell, explain_unknown_column
from gearcad.designs.reader import spec_values
from gearcad.designs.table import open_table
from gearcad.errors import ParameterError, format_number, require_whole
from gearcad.output import staged_files

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Method", "Sample", "Study", "TableCheck", "check_table", "plan_study", "write_study"]

MOST_ROWS = 1_000_000
"""Rows of the largest study: beyond it a number was mistyped, or one table is not the way."""

_MOST_SHOWN = 6
"""Values of a wrong list that a message repeats."""

_BLOCK = 4096
"""Rows that are turned from an array into values at a time."""


class Method(Enum):
    """How a sample is drawn; the value is that of `--sample`."""

    LATIN_HYPERCUBE = "lhs"
    SOBOL = "sobol"


_METHOD_WORDS = {Method.LATIN_HYPERCUBE: "a Latin hypercube", Method.SOBOL: "a scrambled Sobol sequence"}


@dataclass(frozen=True, kw_only=True)
class Sample:
    """So many rows drawn by a method; the same seed draws the same rows. Raises ParameterError."""

    method: Method
    rows: int
    seed: int = 0

    def __post_init__(self) -> None:
        require_whole("n", self.rows, at_least=1, at_most=MOST_ROWS)
        require_whole("seed", self.seed, at_least=0, at_most=2**32 - 1)

    def points(self, dimensions: int) -> NDArray[np.float64]:
        """Points in the unit cube, one a row of the array."""
        import numpy as np
        from scipy.stats import qmc

        generator = np.random.default_rng(self.seed)
        if self.method is Method.LATIN_HYPERCUBE:
            points: NDArray[np.float64] = qmc.LatinHypercube(dimensions, seed=generator).random(self.rows)
        else:
            # The next power of 2, cut: the same points, and no warning that another number is less even.
            points = qmc.Sobol(dimensions, seed=generator).random_base2((self.rows - 1).bit_length())[: self.rows]
        return points


@dataclass(frozen=True)
class Choices:
    """A key that takes one of several values; `text` says them as the user did."""

    key: str
    text: str
    values: tuple[Cell, ...]

    def at(self, fractions: NDArray[np.float64]) -> list[Cell]:
        """The values at fractions 0 ... 1 of the list."""
        return [self.values[int(fraction * len(self.values))] for fraction in fractions]


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


@dataclass(frozen=True, kw_only=True)
class Study:
    """A base of values under their keys, and what varies; `sample` None stands for every combination."""

    source: str
    name: str
    base: dict[str, Cell]
    variations: tuple[Choices | Span, ...]
    sample: Sample | None = None

    @property
    def rows(self) -> int:
        """How many designs there are."""
        if self.sample is not None:
            return self.sample.rows
        return math.prod(len(variation.values) for variation in self.variations if isinstance(variation, Choices))

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of the table's columns after the name: those of the base, then what varies and was not among them."""
        return tuple(dict.fromkeys((*self.base, *(variation.key for variation in self.variations))))

    def points(self) -> Iterator[Sequence[Cell]]:
        """The values of the varied keys, row by row."""
        if self.sample is None:
            return itertools.product(*(variation.values for variation in self.variations if isinstance(variation, Choices)))
        return self._drawn(self.sample.points(len(self.variations)))

    def _drawn(self, points: NDArray[np.float64]) -> Iterator[Sequence[Cell]]:
        for start in range(0, len(points), _BLOCK):
            block = points[start : start + _BLOCK].T
            yield from zip(
                *(variation.at(column) for variation, column in zip(self.variations, block, strict=True)), strict=True
            )

    def lines(self) -> Iterator[list[str]]:
        """The cells of every row, its name first."""
        width = len(str(self.rows))
        stem = self.name.encode()[: LONGEST_NAME_IN_BYTES - width - 1].decode(errors="ignore")[: LONGEST_NAME - width - 1]
        cells = {key: _cell_text(self.base[key]) if key in self.base else "" for key in self.keys}
        varied = [variation.key for variation in self.variations]
        for number, point in enumerate(self.points(), 1):
            cells.update(zip(varied, map(_cell_text, point), strict=True))
            yield [_cell_text(f"{stem}-{number:0{width}}"), *cells.values()]

    def comments(self, table: str) -> Iterator[str]:
        """What the head of the table says about it."""
        yield f"# A study of {self.name} ({self.source}): {self.rows} rows."
        if self.sample is None:
            yield "# Every combination of these values; the last key changes fastest:"
        else:
            yield f"# Drawn as {_METHOD_WORDS[self.sample.method]} (seed {self.sample.seed}) from:"
        for variation in self.variations:
            yield f"#   {variation.key} = {variation.text}"
        yield f"# Next: gearcad batch {table}"


def plan_study(spec: Path | str, variations: Sequence[str], sample: Sample | None = None) -> Study:
    """The study of a spec (TOML) with keys varied as texts such as "helix_angle=10,20,28" or "pinion.teeth=12:20:9" say.

    A key without a table is one of [pair] or [gear]. FIRST:LAST:COUNT gives evenly spaced values; a sample takes FIRST:LAST
    without a count. Raises SpecError for the spec, ParameterError for a variation.
    """
    kind, name, base = spec_values(spec)
    if name.startswith("#"):
        raise ParameterError("name", name, "must not begin with #, which makes a comment of a row; give the spec another name")
    if not variations:
        raise ParameterError("vary", "", "must be given, such as helix_angle=10,20,28 or pinion.profile_shift=-0.2:0.6:9")
    read = tuple(_variation(text, kind, sampled=sample is not None) for text in variations)
    keys = [variation.key for variation in read]
    for text, key in zip(variations, keys, strict=True):
        if keys.count(key) > 1:
            raise ParameterError("vary", text, f"{key} is varied more than once; put all its values in one --vary")
    study = Study(source=Path(spec).name, name=name, base=base, variations=read, sample=sample)
    if study.rows > MOST_ROWS:
        raise ParameterError("rows", study.rows, f"must be at most {MOST_ROWS}; take fewer values, or a sample")
    return study


def write_study(study: Study, path: Path) -> None:
    """Write the design table of a study: complete or not at all. Raises ParameterError for a place that cannot be written."""
    with staged_files(path.parent) as staging, (staging / path.name).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([comment] for comment in study.comments(path.name))
        writer.writerow(["name", *study.keys])
        writer.writerows(study.lines())


class TableCheck(NamedTuple):
    """How many rows of a table make no gear, and why the first does not ("" if all do)."""

    faulty: int
    first_fault: str


def check_table(path: Path) -> TableCheck:
    """Try every row of a design table; that takes about 1 ms for each."""
    faults = [found[0] for row in open_table(path).rows() if (found := row.all_faults())]
    return TableCheck(len(faults), faults[0] if faults else "")


def _cell_text(value: Cell) -> str:
    """A cell of the table."""
    if isinstance(value, tuple):
        return list_text(value)
    return guarded_text(value) if isinstance(value, str) else repr(value)


def _variation(text: str, kind: DesignKind, *, sampled: bool) -> Choices | Span:
    """What one `KEY=VALUES` says."""
    name, _, values = (part.strip() for part in text.partition("="))
    if not name or not values:
        raise ParameterError("vary", text, "must be KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE ...")
    key = _full_key(text, name, kind)
    if ":" not in values or "," in values or _kind_of(key) is str:
        return _choices(text, key, values, _listed(text, key, values))
    first, last, count = _ends(text, key, values, counted=not sampled)
    if not sampled:
        return _choices(text, key, values, _spaced(text, first, last, count))
    _require_whole(text, key, (first, last))
    return Span(key, values, first, last, whole=_kind_of(key) is int)


def _full_key(text: str, name: str, kind: DesignKind) -> str:
    """The key with its table; one without belongs to [pair] or [gear]."""
    main = kind.value
    table, _, field = (main, "", name) if name in KEYS[main] else name.partition(".")
    if field not in KEYS.get(table, ()):
        raise ParameterError("vary", text, explain_unknown_column(name, main))
    permitted = [owner for owner in KEYS if owner in ("material", "load") or (owner == "gear") == (kind is DesignKind.GEAR)]
    if table not in permitted:
        tables = ", ".join(f"[{owner}]" for owner in permitted)
        raise ParameterError("vary", text, f"the spec makes a {main}; permitted are keys of {tables}")
    if (table, field) == (main, "name"):
        raise ParameterError("vary", text, "the study numbers the names itself; vary another key")
    return f"{table}.{field}"


def _value(key: str, text: str) -> Cell:
    """What a cell with this text would be; the sum makes -0.0 a plain zero."""
    value = CellReader(Layout.COMMA).value(key, text, 0)
    return "" if value is None else value + 0.0 if isinstance(value, float) else value


def _kind_of(key: str) -> type[Cell]:
    """Whether the key takes whole numbers (int), numbers (float) or texts (str)."""
    return type(_value(key, "1"))


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
    if _kind_of(key) is int and not all(isinstance(value, int) for value in values):
        shown = ", ".join(map(format_number, values[:_MOST_SHOWN])) + (" ..." if len(values) > _MOST_SHOWN else "")
        raise ParameterError("vary", text, f"must make whole numbers of {key}, not {shown}")
