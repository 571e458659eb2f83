"""What a file of inputs is by its name: the spec of one design, or a design table."""

from __future__ import annotations

from pathlib import Path

__all__ = ["UNREADABLE", "WORKBOOKS", "is_spec_name", "is_table_name"]

WORKBOOKS = (".xlsx", ".xlsm")
UNREADABLE = (".xls", ".xlsb", ".ods", ".numbers")
"""Tables that have to be saved as something else."""

_TEXTS = (".csv", ".tsv")
"""Names of tables that are texts; a text under any other name than a spec's is read as one too."""


def is_table_name(path: Path) -> bool:
    """True for a file that is named like a design table."""
    return path.suffix.lower() in (*WORKBOOKS, *UNREADABLE, *_TEXTS)


def is_spec_name(path: Path) -> bool:
    """True for a file that is named like a spec."""
    return path.suffix.lower() == ".toml"
