"""The tables of the validation page in Markdown, from the rows that tests have written into `docs/validation.json`."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

__all__ = ["CHAPTERS", "FILE", "Row", "counts_text", "rows", "table_text"]

FILE = Path(__file__).parents[1] / "validation.json"

CHAPTERS = {
    "geometry": ("test_books.py", "test_ring_pairs.py", "test_volvo_pair.py"),
    "rating": ("test_printed_ratings.py", "test_dynamic_factor.py"),
    "elements": ("test_calculix.py",),
    "stiffness": ("test_stiffness_table4.py", "test_stiffness.py"),
    "dynamics": ("test_train_modes.py", "test_pair_dynamics.py", "test_planetary_kinematics.py"),
}
"""Which tests a chapter of the page shows."""


class Row(NamedTuple):
    """A value that is published, and what comes out."""

    source: str
    of: str
    quantity: str
    published: str
    found: str
    within: float
    test: str

    @property
    def deviation(self) -> float:
        return abs(float(self.found) - float(self.published))


def rows(chapter: str | None = None) -> list[Row]:
    """Those of a chapter, or all."""
    every = [Row(*row) for row in json.loads(FILE.read_text(encoding="utf-8"))]
    files = [name for key, names in CHAPTERS.items() if chapter in (None, key) for name in names]
    return sorted(
        (row for row in every if row.test.partition("::")[0] in files), key=lambda row: files.index(row.test.partition("::")[0])
    )


def table_text(chapter: str) -> str:
    """A heading and a table for each source, in Markdown."""
    return "\n".join(_lines(rows(chapter)))


def _lines(of: list[Row]) -> Iterator[str]:
    for source, group in groupby(sorted(of, key=lambda row: row.source), key=lambda row: row.source):
        yield f"\n**{source}**\n"
        yield "| | published | gearcad | permitted |"
        yield "|---|--:|--:|--:|"
        for row in group:
            name = f"{row.of}: {row.quantity}" if row.of else row.quantity
            yield f"| {_plain(name)} | {row.published} | {row.found} | ± {row.within:.2g} |"
    yield "\nHeld by " + ", ".join(f"`{name}`" for name in dict.fromkeys(row.test.partition("::")[0] for row in of)) + ".\n"


def _plain(text: str) -> str:
    return text.replace("_", r"\_").replace("|", r"\|")


def counts_text() -> str:
    """How many there are of what."""
    every = rows()
    exact = sum(row.deviation <= 0.5 * 10.0 ** -len(row.published.partition(".")[2]) * 1.01 for row in every)
    sources, tests = len({row.source for row in every}), len({row.test for row in every})
    return (
        f"{len(every)} values of {sources} sources, held by {tests} tests; {exact} of them come out in every printed digit, the"
        " others within what stands beside them."
    )
