"""Decks of CalculiX: a loaded pair, sections or solids, as the text of one job that `ccx` runs as it is.

Lengths are in mm, forces in N, stresses in MPa; torques in N mm, in the deck only.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.material import Material
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.files.inp import element_type, write_elements, write_node_set, write_nodes, write_surface
from gearcad.per_gear import PerGear, Role

__all__ = [
    "REFERENCE",
    "Flanks",
    "LoadedPairDeck",
    "number",
    "write_contact",
    "write_heading",
    "write_held",
    "write_material",
    "write_reference",
    "write_turned",
]


REFERENCE = "reference"
"""The node that carries the torque: its first degree of freedom is the angle (rad) by which the pinion turns."""

HELD = "{}_held"
"""Nodes of a gear that its hub holds: all of the bore, and the cuts of a body that is no ring."""

_INTERACTION = "flanks"

_MATERIAL = "gears"

_NO_COEFFICIENT = 1e-9
"""mm: a node so near an axis has no term in that equation."""


@dataclass(frozen=True)
class Flanks:
    """Sides of the joined mesh that may touch, as the names of `sides`."""

    pinion: str
    wheel: str


@dataclass(frozen=True, kw_only=True)
class LoadedPairDeck:
    """Gears in mesh, the pinion pressed against the wheel by a torque.

    `mesh` has both gears, posed; `held` are the nodes of each that its hub holds: those of the wheel stand, those of the
    pinion turn about the z axis by the turn of a node of reference, on which the `torque` (N·m) is. `flanks` may touch, with
    pressures of `contact_stiffness` (MPa/mm) times their overlap. `width` (mm) is the thickness of sections, None for solids.
    `words` stand in the deck as comments.
    """

    mesh: ElementMesh
    held: PerGear[Wholes]
    material: Material
    torque: float
    flanks: Sequence[Flanks]
    contact_stiffness: float
    words: Sequence[str] = ()
    width: float | None = None

    @property
    def reference(self) -> int:
        """Number (from 1) of the node of reference."""
        return len(self.mesh.points) + 1

    def write(self, path: Path) -> None:
        """Write the deck; `ccx` wants a name that ends with .inp."""
        with path.open("w", encoding="ascii", newline="\n") as file:
            write_heading(file, self.words)
            write_nodes(file, self.mesh.points)
            write_reference(file, self.reference)
            write_elements(file, self.mesh, element_type(self.mesh.element))
            self._write_sets(file)
            write_material(file, self.material, self.mesh.parts, self.width)
            write_turned(file, self.held.pinion, self.mesh.points, self.reference)
            write_contact(file, self.flanks, self.contact_stiffness)
            self._write_supports(file)
            self._write_step(file)

    @property
    def _solid(self) -> bool:
        return self.mesh.element.shape.dimension == 3

    def _write_sets(self, file: TextIO) -> None:
        for role, nodes in self.held.items():
            write_held(file, role, nodes)
        for name in dict.fromkeys(name for each in self.flanks for name in (each.pinion, each.wheel)):
            write_surface(file, name, self.mesh.sides[name])

    def _write_supports(self, file: TextIO) -> None:
        file.write(f"*BOUNDARY\n{HELD.format(Role.WHEEL.value)}, 1, {3 if self._solid else 2}\n")
        if self._solid:
            file.write(f"{HELD.format(Role.PINION.value)}, 3\n")
        file.write(f"{REFERENCE}, 2, 3\n")

    def _write_step(self, file: TextIO) -> None:
        file.write("*STEP, INC=100\n*STATIC\n1., 1., 1.e-5, 1.\n")
        file.write(f"*CLOAD\n{REFERENCE}, 1, {number(self.torque * 1000)}\n")
        file.write("*NODE FILE, NSET=nodes\nU\n*EL FILE\nS\n*CONTACT FILE\nCDIS, CSTR\n")
        file.write(f"*NODE PRINT, NSET={REFERENCE}\nU\n")
        file.write(f"*NODE PRINT, NSET={HELD.format(Role.WHEEL.value)}, TOTALS=ONLY\nRF\n")
        for each in self.flanks:
            file.write(f"*CONTACT PRINT, SLAVE={each.pinion}, MASTER={each.wheel}\nCF\n")
        file.write("*CONTACT PRINT\nCSTR\n*END STEP\n")


def number(value: float) -> str:
    """A number as a deck has it: CalculiX reads 20 characters."""
    return f"{value:.12e}"


def write_heading(file: TextIO, words: Iterable[str]) -> None:
    """What the deck is, line by line, as comments."""
    file.write("*HEADING\ngearcad: mm, N, MPa\n")
    file.writelines(f"** {line}\n" if line else "**\n" for line in words)


def write_reference(file: TextIO, node: int) -> None:
    """The node of reference, on the z axis."""
    file.write(f"*NODE, NSET={REFERENCE}\n{node}, 0., 0., 0.\n")


def write_held(file: TextIO, role: Role, nodes: Wholes) -> None:
    """The nodes that the hub of a gear holds, as a node set."""
    write_node_set(file, HELD.format(role.value), np.unique(nodes))


def write_material(file: TextIO, material: Material, parts: Iterable[str], width: float | None = None) -> None:
    """The elastic material of all parts; `width` (mm) is the thickness of sections."""
    elastic = f"{number(material.youngs_modulus)}, {number(material.poisson_ratio)}"
    file.write(f"*MATERIAL, NAME={_MATERIAL}\n*ELASTIC\n{elastic}\n")
    for part in parts:
        file.write(f"*SOLID SECTION, ELSET={part}, MATERIAL={_MATERIAL}\n")
        if width is not None:
            file.write(f"{number(width)}\n")


def write_turned(file: TextIO, nodes: Wholes, points: Floats, reference: int) -> None:
    """Let nodes turn about the z axis by the angle (rad) that is degree of freedom 1 of the node of reference.

    u = -y t, v = x t, as equations: rigid bodies and couplings of CalculiX 2.20 do not take nodes of sections.
    """
    file.write("*EQUATION\n")
    for node in np.unique(nodes).tolist():
        x, y, _ = points[node].tolist()
        for freedom, factor in ((1, y), (2, -x)):
            if abs(factor) > _NO_COEFFICIENT:
                file.write(f"2\n{node + 1}, {freedom}, 1., {reference}, 1, {number(factor)}\n")
            else:
                file.write(f"1\n{node + 1}, {freedom}, 1.\n")


def write_contact(file: TextIO, flanks: Iterable[Flanks], stiffness: float) -> None:
    """Frictionless contact of surface to surface; each pair of flanks is one of its own, so that its force can be printed."""
    file.write(f"*SURFACE INTERACTION, NAME={_INTERACTION}\n")
    file.write(f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{number(stiffness)}\n")
    for each in flanks:
        file.write(f"*CONTACT PAIR, INTERACTION={_INTERACTION}, TYPE=SURFACE TO SURFACE\n{each.pinion}, {each.wheel}\n")
