"""One gear under the loads that our own check has found on its flanks, as a deck: any solver can repeat the root stress."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from gearcad.contact.shared.loaded import LoadedPosition, PairContact
from gearcad.decks.calculix import HELD, write_heading, write_held, write_material
from gearcad.decks.pair import PairDecks, held_nodes
from gearcad.decks.results import displacements
from gearcad.decks.words import tooth_words
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.files.inp import element_type, write_elements, write_nodes
from gearcad.per_gear import Role

__all__ = ["ToothDeck"]


@dataclass(frozen=True)
class ToothDeck(ABC):
    """A deck of one gear, and what our own check finds of it.

    The gear stands in coordinates of its own; its sides have its name before theirs, as those of a pair.
    """

    decks: PairDecks
    role: Role
    mesh: ElementMesh
    position: LoadedPosition[PairContact]

    @abstractmethod
    def write_loads(self, file: TextIO) -> None:
        """The loads, as cards of the step."""

    @property
    def expected(self) -> dict[str, Any]:
        """Figures of our own check to compare with: the greatest tension along the fillets (MPa), and forces (N) on flanks."""
        width = self.decks.width or 1.0
        return {
            "gear": self.role.value,
            "roll_angle": self.position.roll_angle,
            "torque": self.decks.task.torque,
            "body": self.decks.task.body.describe(self.decks.pair)[self.role.value],
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
        held = HELD.format(self.role.value)
        with path.open("w", encoding="ascii", newline="\n") as file:
            write_heading(file, tooth_words(self.expected, solid=self.decks.solid))
            write_nodes(file, self.mesh.points)
            write_elements(file, self.mesh, element_type(self.mesh.element))
            write_held(file, self.role, held_nodes(self.mesh, f"{self.role.value}_"))
            write_material(file, self.decks.task.materials.pick(self.role), self.mesh.parts, self.decks.width)
            file.write(f"*BOUNDARY\n{held}, 1, {self.mesh.element.shape.dimension}\n*STEP\n*STATIC\n")
            self.write_loads(file)
            file.write("*NODE FILE, NSET=nodes\nU\n*EL FILE\nS\n")
            file.write(f"*NODE PRINT, NSET={held}, TOTALS=ONLY\nRF\n*END STEP\n")

    def _flank(self, contact: PairContact) -> str:
        return self.decks.side(self.role, self.decks.tooth(self.role, contact.tooth), "flank")
