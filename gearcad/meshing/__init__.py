"""Finite element meshes: of sections, tooth by tooth, of bodies with their named sides, and as files."""

from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.section import MeshSizes, SectorMesh, mesh_sector

__all__ = ["Element", "ElementMesh", "Faces", "MeshSizes", "SectorMesh", "mesh_sector"]
