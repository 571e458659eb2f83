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

__all__ = ["NodalForces", "Remaining", "remaining"]


class NodalForces(NamedTuple):
    """Forces (n, 3, loads) in N, in turning axes, at `nodes` (n,): none at others."""

    nodes: Wholes
    values: Floats

    @property
    def dofs(self) -> Floats:
        """As dofs (3 n, loads)."""
        return self.values.reshape(-1, self.values.shape[-1])

    def together(self, shares: Floats) -> NodalForces:
        """Of some loads together, by shares (loads, m)."""
        return NodalForces(self.nodes, self.values @ shares)


class Remaining(NamedTuple):
    """Of unit loads: the `forces` that leave a smooth rest, and displacements (n, 3, loads) in mm, in turning axes, at the same
    nodes by the fields that are `taken_off`.
    """

    forces: NodalForces
    taken_off: Floats

    def taken_off_at(self, nodes: Wholes) -> Floats:
        """What is taken off (n, 3, loads) at some nodes: nothing at those that are not near."""
        place = np.searchsorted(self.forces.nodes, nodes) % len(self.forces.nodes)
        result: Floats = np.where((self.forces.nodes[place] == nodes)[:, None, None], self.taken_off[place], 0.0)
        return result


def remaining(
    flank: SolidFlank, mesh: SweptMesh, material: Material, near: Wholes, places: Places, points: int, tell: Share
) -> Remaining:
    """Of 1 N at each place, the fields taken off the hexahedra over the quadrangles `near`; `points` Gauss points each way on
    faces close to a load. `tell` hears how much is done.
    """
    at, inward = flank.points(places), flank.inward(places)
    nodes = np.unique(mesh.over(np.unique(mesh.section.quads[near])))
    faces, field = boundary_faces(mesh, near), TakenOff(flank, material)
    displacements, pressed = np.empty((len(at), len(nodes), 3)), np.empty((len(at), len(faces.used), 3))
    around, here = np.searchsorted(nodes, faces.used), mesh.points[nodes]
    for load, (where, direction) in enumerate(zip(at, inward, strict=True)):
        displacements[load] = field.displacement(here, where, direction)
        pressed[load] = faces.forces(partial(field.traction, at=where, inward=direction), where, points)
        tell((load + 1) / len(at))
    taken_off = mesh.to_turning(np.moveaxis(displacements, 0, -1), nodes)
    forces = np.zeros_like(taken_off)
    forces[around] = -mesh.to_turning(np.moveaxis(pressed, 0, -1), faces.used)
    _add_elastic(forces, mesh, material, near, nodes, taken_off)
    return Remaining(NodalForces(nodes, forces), taken_off)


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
