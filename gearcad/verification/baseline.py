"""Baseline: the figures of a verification beside those of an earlier one, and what has moved."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.core.errors import ParameterError
from gearcad.verification.claims import TOLERANCE

DOCUMENT = "verify.json"
RESULTS = "results.csv"

_NO_FIGURES = ("seconds", "gearcad", "files", "judges", "counts")
"""Entries of documents that may differ between two runs of one design; ends of columns of results."""

_OWN_OPTIONS = ("verify.level", "verify.tolerance")
"""Columns with the options of a verification, which are no figures."""

_DEVIATION = re.compile(r"verify\.(?!strength: )[^:]+: .+: ")
"""Columns with a deviation of two figures; it is mostly rounding, whose relative change means nothing."""

Figures = Mapping[str, float | str | bool | None]
"""Figures by their paths in a document, or by the column of a table."""


@dataclass(frozen=True)
class MovedFigure:
    """A figure of a design that is not what it was: its values, and the relative change (infinite where there is none)."""

    design: str
    figure: str
    before: float | str | bool | None
    now: float | str | bool | None

    @property
    def change(self) -> float:
        """Relative change of a number, infinite for all else."""
        try:
            one, two = float(self.before or 0.0), float(self.now or 0.0)
        except ValueError:
            return math.inf
        known = not any(value is None or isinstance(value, bool) for value in (self.before, self.now))
        return (two - one) / abs(one) if one and known else math.inf

    def to_dict(self) -> dict[str, Any]:
        """Return the figure as an entry of a document."""
        change = self.change if math.isfinite(self.change) else None
        return {"design": self.design, "figure": self.figure, "before": self.before, "now": self.now, "change": change}

    def __str__(self) -> str:
        change = f"{100 * self.change:+.3g} %" if math.isfinite(self.change) else "changed"
        return f"{self.design}: {self.figure}: {_shown(self.before)} -> {_shown(self.now)} ({change})"


def _shown(value: float | str | bool | None) -> str:
    return "nothing" if value is None else f"{value:.9g}" if isinstance(value, float) else str(value)


def figures_of(document: Mapping[str, Any]) -> dict[str, float | str | bool | None]:
    """Return the figures of a verify.json by their paths: inputs, derived values, and what the claims say and measure."""
    found = dict(_leaves("spec", {key: value for key, value in document.get("spec", {}).items() if key != "verify"}))
    found |= {name: document.get(name) for name in ("passed", "strength")}
    for claim in document.get("claims", ()):
        path = ": ".join((claim["claim"], claim["where"], claim["quantity"]))
        found[f"{path}: computed"], found[f"{path}: passed"] = claim["computed"], claim["passed"]
        if claim["level"] != "files":
            found[f"{path}: reference"] = claim["reference"]
    return found


def _leaves(path: str, value: Any) -> Iterator[tuple[str, float | str | bool | None]]:
    """The numbers and texts of a document by their paths."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            if key not in _NO_FIGURES:
                yield from _leaves(f"{path}.{key}", inner)
    elif isinstance(value, list | tuple):
        for number, inner in enumerate(value):
            yield from _leaves(f"{path}[{number}]", inner)
    else:
        yield path, value


def read_figures(source: Path) -> Mapping[str, Figures]:
    """Return the figures of an earlier run by design: of a folder with verify.json, one for each row, or of a results.csv.

    Raises ParameterError where there is neither.
    """
    if source.is_file():
        return dict(_of_table(source))
    documents = sorted([*source.glob(DOCUMENT), *source.glob(f"*/{DOCUMENT}")])
    if not documents:
        raise ParameterError("baseline", str(source), f"must be a folder with {DOCUMENT} of an earlier run, or its {RESULTS}")
    found: dict[str, Figures] = {}
    for path in documents:
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            found[str(document["name"])] = figures_of(document)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise ParameterError("baseline", str(path), "must be written by gearcad verify: it cannot be read") from error
    return found


@dataclass(frozen=True)
class VerifiedRows:
    """Documents (verify.json) of the rows of a table that were verified; each is read when its turn comes: they are long."""

    folder: Path
    names: Sequence[str]

    @classmethod
    def of(cls, folder: Path) -> VerifiedRows:
        """Return those of the rows that the table of results in a folder calls "ok", by their names."""
        with (folder / RESULTS).open(encoding="utf-8-sig", newline="") as file:
            return cls(folder, sorted(row["name"] for row in csv.DictReader(file) if row["status"] == "ok"))

    def __iter__(self) -> Iterator[dict[str, Any]]:
        for name in self.names:
            document: dict[str, Any] = json.loads((self.folder / name / DOCUMENT).read_text(encoding="utf-8"))
            yield document


def _of_table(path: Path) -> Iterator[tuple[str, Figures]]:
    """The rows of a table of results by their names, without times and paths of files."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ParameterError("baseline", str(path), "cannot be read") from error
    dialect = ";" if ";" in text.partition("\n")[0] else ","
    for row in csv.DictReader(text.splitlines(), delimiter=dialect):
        if "name" not in row:
            raise ParameterError("baseline", str(path), "must have a column name, as a table of results has")
        kept = {
            key: value
            for key, value in row.items()
            if key and key not in _OWN_OPTIONS and key.rpartition(".")[2] not in _NO_FIGURES
        }
        cells = {key: _cell(value, dialect) for key, value in kept.items() if not key.startswith("files.")}
        yield str(row["name"]), cells


def _cell(text: str | None, dialect: str) -> float | str | bool | None:
    if not text:
        return None
    if text in ("true", "false", "True", "False"):
        return text.lower() == "true"
    try:
        return float(text.replace(",", ".") if dialect == ";" else text)
    except ValueError:
        return text


def tolerance_of(document: Mapping[str, Any]) -> float:
    """Return the relative change that is no change by [verify] of the design of a verify.json."""
    own = document.get("spec", {}).get("verify") or {}
    return float(own.get("tolerance", TOLERANCE))


def _rounding(moved: MovedFigure, tolerance: float) -> bool:
    """Return whether a figure is a deviation that has changed by no more than the tolerance, as a share or in its unit."""
    both = (moved.before, moved.now)
    if not _DEVIATION.match(moved.figure) or any(isinstance(value, bool | str | None) for value in both):
        return False
    one, two = (float(value or 0.0) for value in both)
    return abs(two - one) <= tolerance


def compare(
    before: Mapping[str, Figures], now: Mapping[str, Figures], tolerances: Mapping[str, float], given: float | None = None
) -> list[MovedFigure]:
    """Return what has moved by more than a relative tolerance, the greatest change first.

    It is the one that is `given` for all, else that of the design in `tolerances`. Designs and figures that only one of both
    has have moved too.
    """
    moved = []
    for design in dict.fromkeys([*before, *now]):
        if design not in now or design not in before:
            moved.append(MovedFigure(design, "design", design if design in before else None, design if design in now else None))
            continue
        old, new = before[design], now[design]
        tolerance = tolerances.get(design, TOLERANCE) if given is None else given
        for figure in dict.fromkeys([*old, *new]):
            each = MovedFigure(design, figure, old.get(figure), new.get(figure))
            if each.before != each.now and not abs(each.change) <= tolerance and not _rounding(each, tolerance):
                moved.append(each)
    return sorted(moved, key=lambda each: -abs(each.change))
