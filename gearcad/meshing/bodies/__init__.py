"""Meshes of bodies with named sides: one tooth, some, or all of them; sections and solids; one gear or a pair."""

from gearcad.meshing.bodies.element_mesh import ElementMesh, Faces
from gearcad.meshing.fem import Element

__all__ = ["Element", "ElementMesh", "Faces"]
