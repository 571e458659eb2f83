"""Finite element meshes of the transverse section, one tooth sector at a time."""

from gearcad.meshing.section.sector import MeshSizes, SectorMesh, mesh_sector

__all__ = ["MeshSizes", "SectorMesh", "mesh_sector"]
