"""The hub of a plane body: what it does to the mesh of a sector, by what holds the bore.

A bore that is not held rests on a hub that follows its motion in the mean: what the hub gives back is a traction shaped like
a rigid motion - its part along the bore, for a bore may slide and lift but not shear - that balances the teeth. The mean
motion of the bore, weighted like that traction, is nought, so the body stays where its hub is, and responses are symmetric.
"""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.elasticity import element_forces, element_mass
from gearcad.contact.shared.holding import Hold, Support
from gearcad.meshing.section import SectorMesh
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.shaft import with_shaft
from gearcad.meshing.section.shapes import edge_shapes, edge_slopes, edges_of

__all__ = ["held_nodes", "hub_seen_by", "hub_tractions", "key_load", "rigid_motions", "with_support"]


_GAUSS = 4
"""Points on a part of an edge for the tractions on the bore."""

_PARTS = 16
"""Parts of an edge, so that a keyway may end inside it."""


def with_support(mesh: SectorMesh, support: Support) -> SectorMesh:
    """The sector with what of the shaft belongs to it."""
    return with_shaft(mesh, support.shaft_bore) if support.hold is Hold.SHAFT else mesh


def held_nodes(mesh: SectorMesh, support: Support) -> Wholes:
    """Nodes that belong to the hub; of a ring on bolts those of a sector that has one, but for its cuts, which all share."""
    if support.floats:
        return np.empty(0, int)
    if support.hold is not Hold.BOLTS:
        return mesh.sides[Side.HELD]
    outside = np.hypot(*mesh.points.T) > support.bolt_circle / 2
    outside[mesh.sides[Side.HELD]] = True
    outside[mesh.ahead] = outside[mesh.behind] = False
    return np.flatnonzero(outside)


def hub_seen_by(tooth: int, support: Support) -> Floats:
    """Dofs of the hub as the sector of a tooth, counted from the loaded one, sees them, from those that that one sees.

    Those of a hub that floats are the torque and two forces; the other has its turn.
    """
    if not support.floats:
        return np.eye(1)
    cosine, sine = math.cos(tooth * 2 * math.pi / support.teeth), math.sin(tooth * 2 * math.pi / support.teeth)
    return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])


def hub_tractions(mesh: SectorMesh, whole: SectorMesh, support: Support) -> Floats:
    """Nodal forces (2 n, 3) on the `whole` of a sector by torque and forces of unit shape, of a hub that floats."""
    if support.hold is Hold.SHAFT:
        shaft = np.arange(len(mesh.triangles), len(whole.triangles))
        return element_forces(whole.triangles[shaft], element_mass(whole, shaft), rigid_motions(whole.points).reshape(-1, 3))
    return _on_bore(mesh, math.pi)


def key_load(mesh: SectorMesh, support: Support) -> Floats:
    """Nodal forces (2 n, 1) by which a key under the middle of the sector gives a torque of 1 (N mm per mm).

    The shear over a bore as wide as the keyway, or as the sector if that is narrower.
    """
    forces = _on_bore(mesh, support.key)[:, :1]
    return forces / (forces[:, 0] @ rigid_motions(mesh.points)[..., 0].ravel())


def rigid_motions(points: Floats) -> Floats:
    """Displacements (n, 2, 3) of points by a turn of 1 rad and by shifts along x and y of 1."""
    x, y = points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    return np.stack([np.stack([-y, x], -1), np.stack([one, zero], -1), np.stack([zero, one], -1)], -1)


def _on_bore(mesh: SectorMesh, half: float) -> Floats:
    """Nodal forces (2 n, 3) by rigid motions' parts along the bore, as tractions up to `half` (rad) from its middle."""
    edges = edges_of(mesh.sides[Side.HELD])
    s, weight = np.polynomial.legendre.leggauss(_GAUSS)
    s = (np.arange(_PARTS)[:, None] + (s + 1) / 2).ravel() * 2 / _PARTS - 1
    weight = np.tile(weight / _PARTS, _PARTS)
    shape, slope = edge_shapes(s), edge_slopes(s)
    points = np.einsum("qa,eac->eqc", shape, mesh.points[edges])
    length = np.hypot(*np.moveaxis(np.einsum("qa,eac->eqc", slope, mesh.points[edges]), -1, 0)) * weight
    angle = np.arctan2(points[..., 1], points[..., 0])
    length = np.where(np.abs(angle) <= half, length, 0.0)
    along = np.stack([-np.sin(angle), np.cos(angle)], -1)
    motions = rigid_motions(points.reshape(-1, 2)).reshape(*points.shape, 3)
    sheared = np.einsum("eqc,eqd,eqdj->eqcj", along, along, motions)
    forces = np.zeros((len(mesh.points), 2, 3))
    np.add.at(forces, edges, np.einsum("qa,eq,eqcj->eacj", shape, length, sheared))
    return forces.reshape(-1, 3)
