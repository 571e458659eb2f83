"""Starter specs and tables: the templates that ship with gearcad, found in an installed package and in a checkout alike."""

from __future__ import annotations

from pathlib import Path

from gearcad.errors import ParameterError
from gearcad.shipped import templates

__all__ = ["NO_DESIGNS", "starter_text", "starters"]

_ALIASES = {
    "gear": "spur",
    "pair": "volvo-13-44",
    "ring": "ring-22-70",
    "planetary": "planetary-24-21-66",
    "uhlir": "uhlir-19-23",
}
"""What a newcomer would ask for."""

NO_DESIGNS = ("drawing_title", "measured")
"""Starters that are no spec and no table of designs."""


_NONE = ("drawing_words", "page_words")
"""Templates that nobody begins with."""


def _files() -> dict[str, Path]:
    return {
        path.stem: path
        for path in sorted(templates().iterdir(), key=lambda path: path.stem)
        if path.suffix in (".toml", ".csv") and path.stem not in _NONE
    }


def starters() -> dict[str, str]:
    """Name of every starter and what it is, from the first line of its file."""
    found = {}
    for name, path in _files().items():
        with path.open(encoding="utf-8") as file:
            found[name] = file.readline().strip("# \n").rstrip(".")
    return found


def starter_text(kind: str) -> tuple[str, str]:
    """Name of the file and text of the starter called `kind` - its name, or the beginning of one. Raises ParameterError."""
    files = _files()
    asked = _ALIASES.get(kind, kind)
    matches = [asked] if asked in files else [name for name in files if name.startswith(asked)]
    if len(matches) != 1:
        raise ParameterError("kind", kind, f"must be one of {', '.join(files)} (or {', '.join(_ALIASES)})")
    path = files[matches[0]]
    return path.name, path.read_text(encoding="utf-8")
