"""Texts of specs that come from a browser: they make the same designs as files do, but name no file outside a folder."""

from __future__ import annotations

from pathlib import Path

from gearcad.designs.design import Design
from gearcad.designs.files import tables_of_text
from gearcad.designs.named_files import files_only_in
from gearcad.designs.reader import design_from_tables

__all__ = ["design_of"]


def design_of(text: str, name: str, folder: Path) -> Design:
    """The design of a text, called `name` where it says no other; files that it names are in `folder`. Raises SpecError."""
    with files_only_in(folder):
        tables, where = tables_of_text(text, f"{name}.toml", folder)
        return design_from_tables(tables, where=where, default_name=name)
