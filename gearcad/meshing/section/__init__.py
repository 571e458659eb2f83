"""Finite element meshes of the transverse section, one tooth sector at a time."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.meshing.section.sector import MeshSizes, SectorMesh, mesh_sector

__all__ = ["MeshSizes", "SectorMesh", "mesh_sector"]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(__name__, __all__, ("sector",))
