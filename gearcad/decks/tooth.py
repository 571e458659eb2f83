"""One gear under the contact pressures that our own check has found, as a deck: any solver can repeat the root stress."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.contact.plane.cycle import PlanePairContact, PlanePosition
from gearcad.decks.calculix import HELD, number, write_heading, write_held, write_material
from gearcad.decks.pair import held_nodes
from gearcad.decks.plane import PlaneDecks
from gearcad.decks.results import displacements
from gearcad.decks.words import tooth_words
from gearcad.meshing.bodies import ElementMesh, Faces
from gearcad.meshing.bodies.mesh import joined
from gearcad.meshing.files.inp import element_type, write_elements, write_nodes
from gearcad.per_gear import Role

__all__ = ["ToothDeck", "tooth_deck"]


@dataclass(frozen=True)
class ToothDeck:
    """A deck: pressures (n,) in MPa on sides of elements of one gear, and what our own check finds of it.

    The gear stands in coordinates of its own; its sides have its name before theirs, as those of a pair.
    """

    decks: PlaneDecks
    role: Role
    mesh: ElementMesh
    position: PlanePosition
    faces: Faces
    pressures: Floats

    @property
    def expected(self) -> dict[str, Any]:
        """Figures of our own check to compare with: the greatest tension along the fillets (MPa), and forces (N) on flanks."""
        width = self.decks.pair.common_width.width
        return {
            "gear": self.role.value,
            "roll_angle": self.position.roll_angle,
            "torque": self.decks.task.torque,
            "forces": {self._flank(contact): contact.force * width for contact in self.position.contacts},
            "root_stress": self.position.tension.pick(self.role).stress,
        }

    def found(self, job: Path) -> dict[str, Any]:
        """The same root stress as CalculiX has left it in the files of a job, named without suffix. Raises SolverError."""
        moved = displacements(job.with_name(f"{job.name}.frd"), len(self.mesh.points))
        teeth = [self.decks.tooth(self.role, contact.tooth) for contact in self.position.contacts]
        return {"root_stress": max(self.decks.root_tension(self.mesh, moved, self.role, tooth, 0.0) for tooth in teeth)}

    def write(self, path: Path) -> None:
        """Write the deck; `ccx` wants a name that ends with .inp."""
        with path.open("w", encoding="ascii", newline="\n") as file:
            write_heading(file, tooth_words(self.expected))
            write_nodes(file, self.mesh.points)
            write_elements(file, self.mesh, element_type(self.mesh.element))
            write_held(file, self.role, self._held)
            write_material(file, self.decks.task.material, self.mesh.parts, self.decks.width)
            file.write(f"*BOUNDARY\n{HELD.format(self.role.value)}, 1, 2\n")
            self._write_step(file)

    @property
    def _held(self) -> Wholes:
        return held_nodes(self.mesh, f"{self.role.value}_")

    def _flank(self, contact: PlanePairContact) -> str:
        return self.decks.side(self.role, self.decks.tooth(self.role, contact.tooth), "flank")

    def _write_step(self, file: TextIO) -> None:
        file.write("*STEP\n*STATIC\n*DLOAD\n")
        for element, side, pressure in zip(self.faces.elements, self.faces.sides, self.pressures, strict=True):
            file.write(f"{element + 1}, P{side + 1}, {number(pressure)}\n")
        file.write("*NODE FILE, NSET=nodes\nU\n*EL FILE\nS\n")
        file.write(f"*NODE PRINT, NSET={HELD.format(self.role.value)}, TOTALS=ONLY\nRF\n*END STEP\n")


def tooth_deck(decks: PlaneDecks, roll_angle: float, role: Role) -> ToothDeck:
    """A gear of the pair at a roll angle (deg). Raises ParameterError, GeometryError and SolverError."""
    position = decks.cycle.solve(roll_angle)
    mesh = joined({role.value: decks.mesh(role, decks.zones(roll_angle, role))})
    base_radius = decks.pair.gears.pick(role).base_diameter / 2
    loaded, pressures = list[Faces](), list[Floats]()
    for contact in position.contacts:
        name = decks.side(role, decks.tooth(role, contact.tooth), "flank")
        laid = _laid(mesh, name, contact, role, base_radius)
        loaded.append(Faces(mesh.sides[name].elements[laid > 0], mesh.sides[name].sides[laid > 0]))
        pressures.append(laid[laid > 0])
    faces = Faces(np.concatenate([each.elements for each in loaded]), np.concatenate([each.sides for each in loaded]))
    return ToothDeck(decks, role, mesh, position, faces, np.concatenate(pressures))


def _laid(mesh: ElementMesh, flank: str, contact: PlanePairContact, role: Role, base_radius: float) -> Floats:
    """Pressures (n,) in MPa on the edges of a flank: the forces of the cells of contact on each, over its chord."""
    cells = contact.pair.cells
    lengths = cells.lengths.pick(role)
    ends = np.interp(cells.place[0] - cells.width / 2 + cells.width * np.arange(len(lengths) + 1), cells.place, lengths)
    ends[[0, -1]] += lengths[[0, -1]] - ends[[1, -2]]
    passed = np.r_[0.0, np.cumsum(contact.pressures)] * cells.width
    order = np.argsort(ends)
    points = mesh.points[mesh.face_cells(flank)[:, :2], :2]
    at = np.sqrt(np.maximum((points**2).sum(-1) - base_radius**2, 0.0))
    force = np.abs(np.diff(np.interp(at, ends[order], passed[order]), axis=1)[:, 0])
    result: Floats = force / np.hypot(*(points[:, 1] - points[:, 0]).T)
    return result
