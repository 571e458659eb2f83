"""Scenes: parts in their places, in the format that the name of the file asks for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from gearcad.errors import ParameterError
from gearcad.solids.files.glb import write_glb
from gearcad.solids.files.part import Part
from gearcad.solids.files.three_mf import write_3mf

__all__ = ["write_scene"]


def write_scene(parts: Sequence[Part], path: Path | str) -> None:
    """Write 3MF or GLB, by the suffix of `path` (see `write_3mf`, `write_glb`). Raises ParameterError for another suffix."""
    writers = {".3mf": write_3mf, ".glb": write_glb}
    suffix = Path(path).suffix.lower()
    if suffix not in writers:
        raise ParameterError("path", str(path), "must end in .3mf or .glb")
    writers[suffix](parts, path)
