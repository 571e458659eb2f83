"""The starters that are designs, file by file."""

from __future__ import annotations

from pathlib import Path

from gearcad.core.runtime import templates
from gearcad.designs.reader import NO_DESIGNS, starters


def starter_specs() -> list[Path]:
    """All that ship with gearcad, by name."""
    files = (templates() / f"{name}.toml" for name in sorted(starters()) if name not in NO_DESIGNS)
    return sorted(path for path in files if path.is_file())
