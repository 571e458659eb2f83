"""Files that specs and tables name: seen from the folder where they are written, and found from here."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

__all__ = ["find_named_files", "names_file", "with_files_found"]

_TEMPLATE = "drawing.template"
"""What changes the title block of drawings."""


def names_file(key: str) -> bool:
    """Whether a text under a key is a file: a template, or the pair of a mesh, `mesh.NAME.pair`."""
    table, _, rest = key.partition(".")
    name, _, field = rest.rpartition(".")
    return key == _TEMPLATE or (table == "mesh" and bool(name) and field == "pair")


def with_files_found(values: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The values with files, which are seen from `folder`, as they are found from here."""
    return {key: _found(each, folder) if names_file(key) else each for key, each in values.items()}


def find_named_files(tables: Mapping[str, Any], folder: Path) -> None:
    """The same of the tables of a spec in `folder`, in place."""
    train, drawing = tables.get("train"), tables.get("drawing")
    meshes = train.get("mesh") if isinstance(train, Mapping) else None
    named = [(mesh, "pair") for mesh in meshes] if isinstance(meshes, list) else []
    for table, key in (*named, (drawing, "template")):
        if isinstance(table, dict) and key in table:
            table[key] = _found(table[key], folder)


def _found(name: Any, folder: Path) -> Any:
    """A name that no file can have is left as it is written: whoever reads the file refuses it."""
    return str(folder / name) if isinstance(name, str) and name.strip() and "\0" not in name else name
