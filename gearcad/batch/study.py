"""Parameter studies: a design table of one spec with some of its keys varied, which `batch` then runs.

Without a sample every combination of the values is a row, the last key changing fastest; with one, so many rows are drawn.
"""

from __future__ import annotations

import csv
import itertools
import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from gearcad.core.errors import ParameterError, require_whole
from gearcad.core.output import staged_files
from gearcad.designs.cells import guarded_text, list_text
from gearcad.designs.design import LONGEST_NAME, LONGEST_NAME_IN_BYTES, is_inline, names_file
from gearcad.designs.keys import Cell, DesignKind
from gearcad.designs.table import open_table
from gearcad.designs.variations import MOST_ROWS, Choices, KeyRange, read_variations, spec_values, without_varied
from gearcad.geometry.tool_shelf import ToolName

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Method", "Sample", "Study", "TableCheck", "check_table", "plan_study", "write_study"]

_BLOCK = 4096
"""Rows that are turned from an array into values at a time."""


class Method(Enum):
    """Method of drawing a sample; the value is that of `--sample`."""

    LATIN_HYPERCUBE = "lhs"
    SOBOL = "sobol"


_METHOD_WORDS = {Method.LATIN_HYPERCUBE: "a Latin hypercube", Method.SOBOL: "a scrambled Sobol sequence"}


@dataclass(frozen=True, kw_only=True)
class Sample:
    """A number of rows drawn by a method; the same seed draws the same rows. Raises ParameterError."""

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


@dataclass(frozen=True, kw_only=True)
class Study:
    """Study: values under their keys, and the keys that vary; `sample` None means every combination."""

    source: str
    kind: DesignKind
    name: str
    base: dict[str, Cell]
    variations: tuple[Choices | KeyRange, ...]
    sample: Sample | None = None

    @property
    def rows(self) -> int:
        """Number of designs."""
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

    def lines(self, folder: Path = Path()) -> Iterator[list[str]]:
        """The cells of every row, its name first; files as they are found from the `folder` of the table."""
        width = len(str(self.rows))
        stem = self.name.encode()[: LONGEST_NAME_IN_BYTES - width - 1].decode(errors="ignore")[: LONGEST_NAME - width - 1]
        cells = {key: _cell_text(_seen(self.base[key], folder)) if key in self.base else "" for key in self.keys}
        varied, files = [variation.key for variation in self.variations], [key for key in self.keys if names_file(key)]
        for number, point in enumerate(self.points(), 1):
            cells.update((key, _cell_text(_seen(each, folder))) for key, each in zip(varied, point, strict=True))
            seen = {
                key: _cell_text(os.path.relpath(cells[key], folder))
                for key in files
                if cells[key] and not is_inline(cells[key])
            }
            yield [_cell_text(f"{stem}-{number:0{width}}"), *(cells | seen).values()]

    def comments(self, table: str) -> Iterator[str]:
        """Yield the comment lines at the head of the table."""
        yield f"# A study of {self.name} ({self.source}): {self.rows} rows."
        if self.sample is None:
            yield "# Every combination of these values; the last key changes fastest:"
        else:
            yield f"# Drawn as {_METHOD_WORDS[self.sample.method]} (seed {self.sample.seed}) from:"
        for variation in self.variations:
            yield f"#   {variation.key} = {variation.text}"
        yield f"# Next: {self.next_command(table)}"

    def next_command(self, table: Path | str) -> str:
        """Return the command that runs the rows of the table; a train gets `--do dynamics`, since nothing is built of it."""
        return f"gearcad batch {table}{' --do dynamics' if self.kind is DesignKind.TRAIN else ''}"


def plan_study(spec: Path | str, variations: Sequence[str], sample: Sample | None = None) -> Study:
    """The study of a spec (TOML) with keys varied as texts such as "helix_angle=10,20,28" or "pinion.teeth=12:20:9" say.

    A key without a table is one of [pair], [gear] or [train]; shaft.*.KEY varies that of all shafts of a train.
    FIRST:LAST:COUNT gives evenly spaced values; a sample takes FIRST:LAST without a count. Raises SpecError for the spec,
    ParameterError for a variation.
    """
    kind, name, base = spec_values(spec)
    if name.startswith("#"):
        raise ParameterError("name", name, "must not begin with #, which makes a comment of a row; give the spec another name")
    if not variations:
        raise ParameterError("vary", "", "must be given, such as helix_angle=10,20,28 or pinion.profile_shift=-0.2:0.6:9")
    read = read_variations(variations, kind, base, sampled=sample is not None)
    read = tuple(variation.found_from(Path(spec).parent) for variation in read)
    base = without_varied(base, [variation.key for variation in read])
    study = Study(source=Path(spec).name, kind=kind, name=name, base=base, variations=read, sample=sample)
    if study.rows > MOST_ROWS:
        raise ParameterError("rows", study.rows, f"must be at most {MOST_ROWS}; take fewer values, or a sample")
    return study


def write_study(study: Study, path: Path) -> None:
    """Write the design table of a study: complete or not at all. Raises ParameterError for a place that cannot be written."""
    with staged_files(path.parent) as staging, (staging / path.name).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([comment] for comment in study.comments(path.name))
        writer.writerow(["name", *study.keys])
        writer.writerows(study.lines(path.parent))


class TableCheck(NamedTuple):
    """Number of a table's rows that make no gear, and the fault of the first ("" if all make one)."""

    faulty: int
    first_fault: str


def check_table(path: Path) -> TableCheck:
    """Try every row of a design table; that takes about 1 ms for each."""
    faults = [found[0] for row in open_table(path).rows() if (found := row.all_faults())]
    return TableCheck(len(faults), faults[0] if faults else "")


def _seen(value: Cell, folder: Path) -> Cell:
    """Return a value for a table in a folder: the name of a tool with the way to the table that has it."""
    return value.seen_from(folder) if isinstance(value, ToolName) else value


def _cell_text(value: Cell) -> str:
    """A cell of the table."""
    if isinstance(value, tuple):
        return list_text(value)
    return guarded_text(value) if isinstance(value, str) else repr(value)
