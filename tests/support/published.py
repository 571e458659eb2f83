"""Values that somebody has published: a test judges what is found by them, and the manual shows both side by side.

The page has its rows from `docs/validation.json`, which `python docs/validate.py` writes from these very tests. A test whose
row is missing there, or says something else than what comes out, fails.
"""

from __future__ import annotations

import json
import math
import os
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

FILE = Path(__file__).parents[2] / "docs" / "validation.json"

PROPERTY = "published"
"""What the rows are called in the report of a test."""

_DIGITS = 7
"""Of what is found, at most: more are of nobody's concern, and differ from machine to machine."""

_ALIKE = 0.1
"""How far what comes out may be from what is shown, in parts of what is permitted: another version of a mesher does that."""


class Row(NamedTuple):
    """A quantity of something that a source prints, the text there, what is found, and how far apart they may be."""

    source: str
    of: str
    quantity: str
    published: str
    found: str
    within: float
    test: str

    @property
    def key(self) -> tuple[str, ...]:
        return self.test, self.source, self.of, self.quantity

    def same(self, other: Row) -> bool:
        """Whether both say the same, but for the last digit of what is found, or a part of what is permitted."""
        last = 10.0 ** -len(self.found.partition(".")[2])
        apart = abs(float(self.found) - float(other.found))
        return self._replace(found="") == other._replace(found="") and apart < max(1.5 * last, _ALIKE * self.within)


@cache
def _shown_rows() -> dict[tuple[str, ...], Row]:
    rows = (Row(*row) for row in json.loads(FILE.read_text(encoding="utf-8"))) if FILE.exists() else ()
    return {row.key: row for row in rows}


def found_text(found: float, printed: str, within: float) -> str:
    """Two digits more than are printed, as long as these are known, and none below a thousandth of what is permitted."""
    places, whole = len(printed.partition(".")[2]), len(str(int(abs(found))))
    telling = math.ceil(3 - math.log10(within))
    return f"{found:.{max(places, min(places + 2, _DIGITS - whole, telling))}f}"


class Published:
    """`published(quantity, found, printed, within, source, of)`: asserts, and tells the manual."""

    def __init__(self, node: pytest.Item) -> None:
        self._node = node

    def __call__(self, quantity: str, found: float, printed: str | float, within: float, source: str, of: str = "") -> None:
        """`printed` as the source has it, and most distance `within`, both in the unit of `found`."""
        text = printed if isinstance(printed, str) else f"{printed:.12g}"
        assert found == pytest.approx(float(text), abs=within, rel=1e-12), f"{quantity}: {source}"
        test = f"{self._node.path.name}::{self._node.name.partition('[')[0]}"
        row = Row(source, of, quantity, text, found_text(found, text, within), float(f"{within:.3g}"), test)
        self._node.user_properties.append((PROPERTY, list(row)))
        if os.environ.get("GEARCAD_VALIDATION") != "write":
            shown = _shown_rows().get(row.key)
            assert shown is not None and row.same(shown), f"the manual shows {shown}: python docs/validate.py"


@pytest.fixture
def published(request: pytest.FixtureRequest) -> Published:
    """Judges what is found by what is published, and tells the manual of both."""
    return Published(request.node)
