"""Design tables written for a test into the current folder, and what is read from them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import openpyxl
import pytest

from gearcad import SpecError
from gearcad.designs import open_table
from gearcad.designs.table import DesignRow

TEMPLATES = Path(__file__).parents[2] / "templates"

GEARS = "name,teeth,normal_module,face_width\n"
GOOD = "good,20,2,10\n"

ERROR = "is an error of the spreadsheet; mend the formula and save again"
"""What a message says of a cell such as #N/A."""


def rows_of(content: str | bytes, name: str = "t.csv") -> list[DesignRow]:
    """The rows of a file with this content."""
    Path(name).write_bytes(content.encode() if isinstance(content, str) else content)
    return list(open_table(name).rows())


def values_of(content: str | bytes) -> list[Any]:
    """The values of the rows, in the order of the columns, without their keys."""
    return [list(row.values.values()) for row in rows_of(content)]


def faults_of(content: str | bytes, name: str = "t.csv") -> list[str]:
    """All faults of all rows."""
    return [fault for row in rows_of(content, name) for fault in row.all_faults()]


def refusal_of(content: str | bytes, name: str = "t.csv") -> str:
    """Why the file is no table."""
    with pytest.raises(SpecError) as caught:
        rows_of(content, name)
    return str(caught.value)


def workbook(rows: list[list[Any]], name: str = "t.xlsx") -> Path:
    """A workbook with these rows in its only sheet."""
    book = openpyxl.Workbook()
    sheet = book.active
    assert sheet is not None
    for row in rows:
        sheet.append(row)
    book.save(name)
    return Path(name)
