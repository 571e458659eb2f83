"""Finite element meshes: of sections, tooth by tooth, of bodies with their named sides, and as files."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.meshing.bodies import Element, ElementMesh, Faces
    from gearcad.meshing.options import MeshOptions
    from gearcad.meshing.section import MeshSizes, SectorMesh, mesh_sector

__all__ = ["Element", "ElementMesh", "Faces", "MeshOptions", "MeshSizes", "SectorMesh", "mesh_sector"]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "bodies",
            "section",
            "options",
        ),
    )
