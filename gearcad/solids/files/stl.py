"""STL: the bare facets of one gear. Equal input gives equal bytes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gearcad.arrays import Floats
from gearcad.solids.facets.tessellation import Facets

__all__ = ["write_stl"]

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
_HEADER = 80

_NO_AREA = 1e-13
"""Twice the area (mm²) of a triangle that has no normal."""


def write_stl(facets: Facets, path: Path | str) -> None:
    """Write binary STL, in mm (the format states no unit) and single precision."""
    corners = facets.vertices[facets.faces]
    triangles = np.zeros(len(corners), _TRIANGLE)
    triangles["normal"], triangles["corners"] = _normals(corners), corners
    with Path(path).open("wb") as file:
        file.write(bytes(_HEADER) + np.uint32(len(triangles)).astype("<u4").tobytes())
        file.write(triangles.data)


def _normals(corners: Floats) -> Floats:
    """Unit normals (n, 3) of triangles (n, 3, 3), outwards; 0 where there is no area."""
    sides = corners[:, 1:] - corners[:, :2]
    normals = np.cross(sides[:, 0], sides[:, 1])
    sizes = np.sqrt((normals * normals) @ np.ones(3))
    flat = sizes <= _NO_AREA
    normals[flat], sizes[flat] = 0.0, 1.0
    return normals * (1.0 / sizes)[:, None]
