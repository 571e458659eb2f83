"""Meshes of bodies with named sides: one tooth, some, or all of them; sections and solids; one gear or a pair."""

from gearcad.meshing.bodies.element_mesh import Element, ElementMesh, Faces

__all__ = ["Element", "ElementMesh", "Faces"]
