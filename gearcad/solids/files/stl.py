"""STL: the bare facets of one gear. Equal input gives equal bytes."""

from __future__ import annotations

from pathlib import Path

from gearcad.solids.facets.tessellation import Facets

__all__ = ["write_stl"]


def write_stl(facets: Facets, path: Path | str) -> None:
    """Write binary STL, in mm (the format states no unit) and single precision."""
    import trimesh

    mesh = trimesh.Trimesh(facets.vertices, facets.faces, process=False, validate=False)
    Path(path).write_bytes(mesh.export(file_type="stl"))
