"""A section under the contact pressures that our own check has found, as a deck."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TextIO

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.cycle import PlanePairContact
from gearcad.contact.shared.engaged import LoadedFlank
from gearcad.decks.calculix import number
from gearcad.decks.plane import PlaneDecks
from gearcad.decks.tooth import ToothDeck
from gearcad.meshing.bodies import ElementMesh, Faces
from gearcad.meshing.bodies.mesh import joined
from gearcad.per_gear import Role

__all__ = ["PlaneToothDeck", "plane_tooth_deck"]


@dataclass(frozen=True)
class PlaneToothDeck(ToothDeck):
    """Pressures (n,) in MPa on sides of elements of a section."""

    faces: Faces
    pressures: Floats

    def write_loads(self, file: TextIO) -> None:
        """Pressures on edges."""
        file.write("*DLOAD\n")
        for element, side, pressure in zip(self.faces.elements, self.faces.sides, self.pressures, strict=True):
            file.write(f"{element + 1}, P{side + 1}, {number(pressure)}\n")


def plane_tooth_deck(decks: PlaneDecks, roll_angle: float, role: Role) -> PlaneToothDeck:
    """A gear of the pair at a roll angle (deg). Raises ParameterError, GeometryError and SolverError."""
    position = decks.cycle.solve(roll_angle)
    mesh = joined({role.value: decks.mesh(role, decks.zones(roll_angle, role))})
    flank = decks.cycle.model.bodies.pick(role).flank
    loaded, pressures = list[Faces](), list[Floats]()
    for contact in position.contacts:
        name = decks.side(role, decks.tooth(role, contact.tooth), "flank")
        laid = _laid(mesh, name, contact, role, flank)
        loaded.append(Faces(mesh.sides[name].elements[laid > 0], mesh.sides[name].sides[laid > 0]))
        pressures.append(laid[laid > 0])
    faces = Faces(np.concatenate([each.elements for each in loaded]), np.concatenate([each.sides for each in loaded]))
    return PlaneToothDeck(decks, role, mesh, position, faces, np.concatenate(pressures))


def _laid(mesh: ElementMesh, flank: str, contact: PlanePairContact, role: Role, exact: LoadedFlank) -> Floats:
    """Pressures (n,) in MPa on the edges of a flank: the forces of the cells of contact on each, over its chord."""
    cells = contact.pair.cells
    lengths = cells.lengths.pick(role)
    ends = np.interp(cells.place[0] - cells.width / 2 + cells.width * np.arange(len(lengths) + 1), cells.place, lengths)
    ends[[0, -1]] += lengths[[0, -1]] - ends[[1, -2]]
    passed = np.r_[0.0, np.cumsum(contact.pressures)] * cells.width
    order = np.argsort(ends)
    points = mesh.points[mesh.face_cells(flank)[:, :2], :2]
    at = exact.roll_lengths(np.hypot(points[..., 0], points[..., 1]))
    force = np.abs(np.diff(np.interp(at, ends[order], passed[order]), axis=1)[:, 0])
    result: Floats = force / np.hypot(*(points[:, 1] - points[:, 0]).T)
    return result
