"""Files that specs and tables name: seen from the folder where they are written, and found from here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

from gearcad.errors import ParameterError

__all__ = ["files_only_in", "find_named_files", "names_file", "with_files_found"]

_TEMPLATE = "drawing.template"
"""What changes the title block of drawings."""

_fence: ContextVar[Path | None] = ContextVar("the folder in which files must be", default=None)


@contextmanager
def files_only_in(folder: Path) -> Iterator[None]:
    """What is read meanwhile by this thread names files in `folder` only, wherever links lead. Raises ParameterError."""
    token = _fence.set(folder.resolve())
    try:
        yield
    finally:
        _fence.reset(token)


def names_file(key: str) -> bool:
    """Whether a text under a key is a file: a template, or the pair of a mesh, `mesh.NAME.pair`."""
    table, _, rest = key.partition(".")
    name, _, field = rest.rpartition(".")
    return key == _TEMPLATE or (table == "mesh" and bool(name) and field == "pair")


def with_files_found(values: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The values with files, which are seen from `folder`, as they are found from here."""
    return {key: _found(key, each, folder) if names_file(key) else each for key, each in values.items()}


def find_named_files(tables: Mapping[str, Any], folder: Path) -> None:
    """The same of the tables of a spec in `folder`, in place."""
    train, drawing = tables.get("train"), tables.get("drawing")
    meshes = train.get("mesh") if isinstance(train, Mapping) else None
    named = [(f"train.mesh[{at}]", mesh, "pair") for at, mesh in enumerate(meshes)] if isinstance(meshes, list) else []
    for where, table, key in (*named, ("drawing", drawing, "template")):
        if isinstance(table, dict) and key in table:
            table[key] = _found(f"{where}.{key}", table[key], folder)


def _found(key: str, name: Any, folder: Path) -> Any:
    """A name that no file can have is left as it is written: whoever reads the file refuses it."""
    if not isinstance(name, str) or not name.strip() or "\0" in name:
        return name
    fence, found = _fence.get(), folder / name
    if fence is not None and not _resolved(found).is_relative_to(fence):
        raise ParameterError(key, name, "must be a file in the folder of the page")
    return str(found)


def _resolved(path: Path) -> Path:
    """Where links lead; of a path that leads nowhere, what is outside of everything."""
    try:
        return path.resolve()
    except (OSError, RuntimeError):  # a loop of links
        return Path("/")
