"""Starter specs: the templates that ship with gearcad, found in an installed package and in a source checkout alike."""

from __future__ import annotations

from pathlib import Path

from gearcad.errors import ParameterError

__all__ = ["starter_text", "starters"]

_ALIASES = {"gear": "spur", "pair": "volvo-13-44"}
"""What a newcomer would ask for."""


def _folder() -> Path:
    """The wheel carries the templates inside the package; a checkout has them beside it."""
    package = Path(__file__).parent.parent
    installed = package / "templates"
    return installed if installed.is_dir() else package.parent / "templates"


def starters() -> dict[str, str]:
    """Name of every starter and what it is, from the first line of its file."""
    found = {}
    for path in sorted(_folder().glob("*.toml")):
        with path.open(encoding="utf-8") as file:
            found[path.stem] = file.readline().strip("# \n").rstrip(".")
    return found


def starter_text(kind: str) -> tuple[str, str]:
    """Full name and text of the starter called `kind` - its name, or the beginning of one. Raises ParameterError."""
    names = starters()
    matches = [kind] if kind in names else [name for name in names if name.startswith(_ALIASES.get(kind, kind))]
    if len(matches) != 1:
        raise ParameterError("kind", kind, f"must be one of {', '.join(names)} (or gear, pair)")
    return matches[0], (_folder() / f"{matches[0]}.toml").read_text(encoding="utf-8")
