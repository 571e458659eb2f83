"""What elements carry once the fields of point loads are taken off a tooth: nodal forces that leave a smooth rest."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.solid.faces import boundary_faces, summing
from gearcad.contact.solid.hexahedra import layer_matrices
from gearcad.contact.solid.images import TakenOff
from gearcad.contact.solid.places import Places, SolidFlank
from gearcad.material import Material
from gearcad.meshing.section.swept import SweptMesh
from gearcad.progress import Share

__all__ = ["Remaining", "remaining"]


class Remaining(NamedTuple):
    """Of unit loads: displacements (n, 3, loads) in mm at `nodes` (n,) by the fields that are taken off, and nodal forces
    (n, 3, loads) in N that leave the rest; both in turning axes. Nothing of them is at other nodes.
    """

    nodes: Wholes
    taken_off: Floats
    forces: Floats

    def everywhere(self, values: Floats, count: int) -> Floats:
        """Values (n, 3, loads) as dofs (3 count, loads) of all nodes, 0 at the others."""
        result = np.zeros((count, *values.shape[1:]))
        result[self.nodes] = values
        return result.reshape(3 * count, -1)


def remaining(
    flank: SolidFlank, mesh: SweptMesh, material: Material, near: Wholes, places: Places, points: int, tell: Share
) -> Remaining:
    """Of 1 N at each place, the fields taken off the hexahedra over the quadrangles `near`; `points` Gauss points each way on
    faces close to a load. `tell` hears how much is done.
    """
    at, inward = flank.points(places), flank.inward(places)
    nodes = np.unique(mesh.over(np.unique(mesh.section.quads[near])))
    faces, field = boundary_faces(mesh, near), TakenOff(flank, material)
    taken_off = np.empty((len(nodes), 3, len(at)))
    forces = np.zeros_like(taken_off)
    around = np.searchsorted(nodes, faces.used)
    for column, (where, direction) in enumerate(zip(at, inward, strict=True)):
        taken_off[:, :, column] = field.displacement(mesh.points[nodes], where, direction)
        forces[around, :, column] = -faces.forces(partial(field.traction, at=where, inward=direction), where, points)
        tell((column + 1) / len(at))
    taken_off, forces = (mesh.to_turning(each, nodes) for each in (taken_off, forces))
    _add_elastic(forces, mesh, material, near, nodes, taken_off)
    return Remaining(nodes, taken_off, forces)


def _add_elastic(
    forces: Floats, mesh: SweptMesh, material: Material, near: Wholes, nodes: Wholes, displacements: Floats
) -> None:
    """Add to nodal forces (n, 3, m) those by which the hexahedra over some quadrangles resist displacements (n, 3, m)."""
    quads, count = mesh.section.quads[near], displacements.shape[-1]
    known: dict[float, Floats] = {}
    for layer, thickness in enumerate(np.diff(mesh.planes).round(_ROUNDED).tolist()):
        if thickness not in known:
            known[thickness] = layer_matrices(mesh, quads, layer, material)
        here = np.searchsorted(nodes, mesh.elements(quads, layer))
        resisting = known[thickness] @ displacements[here].reshape(len(quads), 60, count)
        used, sums = summing(here)
        forces[used] += (sums @ resisting.reshape(-1, 3 * count)).reshape(-1, 3, count)


_ROUNDED = 9
"""Decimals (mm) of thicknesses that count as one."""
