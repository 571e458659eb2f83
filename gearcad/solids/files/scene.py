"""Scenes: named, coloured bodies in their places, each made of facets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import ParameterError
from gearcad.solids.facets.tessellation import Facets

__all__ = ["Part", "write_scene"]


@dataclass(frozen=True, kw_only=True)
class Part:
    """One body of a scene: turned by `rotation` (degrees, about its own z axis), then moved by `offset` (mm).

    `colour` is red, green and blue as seen on a screen (sRGB), 0 ... 1.
    """

    name: str
    facets: Facets
    colour: tuple[float, float, float] = (0.62, 0.66, 0.72)
    rotation: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def pose(self) -> Floats:
        """Homogeneous matrix (4, 4) of the part's place."""
        matrix = np.eye(4)
        cosine, sine = math.cos(math.radians(self.rotation)), math.sin(math.radians(self.rotation))
        matrix[:2, :2] = [[cosine, -sine], [sine, cosine]]
        matrix[:3, 3] = self.offset
        return matrix


def write_scene(parts: Sequence[Part], path: Path | str) -> None:
    """Write 3MF or GLB, by the suffix of `path` (see `write_3mf`, `write_glb`). Raises ParameterError for another suffix."""
    from gearcad.solids.files.glb import write_glb
    from gearcad.solids.files.three_mf import write_3mf

    writers = {".3mf": write_3mf, ".glb": write_glb}
    suffix = Path(path).suffix.lower()
    if suffix not in writers:
        raise ParameterError("path", str(path), "must end in .3mf or .glb")
    writers[suffix](parts, path)
