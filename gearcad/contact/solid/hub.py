"""The hub of a solid body whose bore is free: it follows the bore in the mean, and gives back shear that balances the teeth.

As `contact.plane.support` in the plane, with six dofs for three: torque, forces along x, y and z, and moments about x and y
through the middle of the face width.
"""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.solid.faces import boundary_faces
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.swept import SweptMesh

__all__ = ["HUB_PARITIES", "bore_forces", "rigid_motions", "seen_at"]


HUB_PARITIES = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
"""Of the dofs of a hub those that a half turn about the middle of a tooth leaves as they are, and those it makes opposite."""


def rigid_motions(points: Floats, middle: float) -> Floats:
    """Displacements (..., 3, 6) of points (..., 3) in mm by the dofs of the hub as motions of 1 rad or 1 mm.

    `middle` (mm) is the height of the axes of tilting.
    """
    x, y, z = np.moveaxis(points, -1, 0)
    zero, one, up = np.zeros_like(x), np.ones_like(x), z - middle
    motions = [(-y, x, zero), (one, zero, zero), (zero, one, zero), (zero, zero, one), (zero, -up, y), (up, zero, -x)]
    return np.stack([np.stack(motion, -1) for motion in motions], -1)


def bore_forces(mesh: SweptMesh) -> Floats:
    """Nodal forces (3 nodes, 6) in the turning axes, by tractions on the bore like a rigid motion's part along its surface."""
    section = mesh.section
    inner = np.isin(section.quads, mesh.side(Side.HELD))
    faces = boundary_faces(mesh, np.flatnonzero(inner.sum(axis=1) >= _ON_ARC)).among(mesh.over(mesh.side(Side.HELD)))
    middle = (mesh.planes[0] + mesh.planes[-1]) / 2

    def sheared(points: Floats, normals: Floats) -> Floats:
        area = np.linalg.norm(normals, axis=-1)[..., None, None]
        outward = points * [1.0, 1.0, 0.0] / np.hypot(points[..., :1], points[..., 1:2])
        motions = rigid_motions(points, middle)
        along: Floats = motions - outward[..., None] * np.einsum("...c,...cj->...j", outward, motions)[..., None, :]
        along *= area
        return along

    forces = faces.smooth_forces(mesh, sheared)
    turning: Floats = mesh.to_turning(forces).reshape(-1, forces.shape[-1])
    return turning


_ON_ARC = 3
"""Nodes of a quadrangle on the bore if an edge of it is."""


def seen_at(angle: float) -> Floats:
    """Dofs of the hub (6, 6) as a sector turned by an angle (rad) sees them, from those that the loaded one sees."""
    cosine, sine = math.cos(angle), math.sin(angle)
    seen = np.eye(6)
    for first in (1, 4):
        seen[first : first + 2, first : first + 2] = [[cosine, sine], [-sine, cosine]]
    return seen
