"""Decks of CalculiX: the text of a job that ccx runs as it is, its results, and their difference from the check's.

Lengths are in mm, forces in N, stresses in MPa; torques in N mm, in the deck only.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, PerGear, Role, Wholes
from gearcad.material import Material
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.files import element_type, write_elements, write_node_set, write_nodes, write_surface

if TYPE_CHECKING:
    from gearcad.decks.shafts import DeckShaft

REFERENCE = "reference"
"""The node that carries the torque: its first degree of freedom is the angle (rad) by which the pinion turns."""

WHEEL_REFERENCE = "wheel_reference"
"""The node whose first degree of freedom is the angle (rad) by which the wheel turns about its axis, where flanks slide."""

HELD = "{}_held"
"""Nodes of a gear that its hub holds: all of the bore, and the cuts of a body that is no ring."""

_INTERACTION = "flanks"

_MATERIAL = "gears"

_NO_COEFFICIENT = 1e-9
"""mm: a node so near an axis has no term in that equation."""


@dataclass(frozen=True)
class Flanks:
    """Sides of the joined mesh that may touch, as the names of `sides`.

    CalculiX presses along the normals of the master surface. So the flank whose edge touches is the slave: the wheel's where
    `wheel_tip` says that the edge of its tip touches, otherwise the pinion's. `parts` are the sides of which the slave surface
    is made, if the force of each is wanted.
    """

    pinion: str
    wheel: str
    wheel_tip: bool = False
    parts: tuple[str, ...] = ()

    @property
    def slave(self) -> str:
        """Name of the slave surface."""
        return self.wheel if self.wheel_tip else self.pinion

    @property
    def master(self) -> str:
        """Name of the master surface."""
        return self.pinion if self.wheel_tip else self.wheel

    @property
    def slaves(self) -> tuple[str, ...]:
        """Names of the slave surface, or of its parts."""
        return self.parts or (self.slave,)


@dataclass(frozen=True)
class Sliding:
    """Friction of flanks that slide as the gears turn under the torque: the pinion by `turn` (rad), the wheel by `wheel_turn`.

    `coefficient` of friction; `distance` (mm) of the wheel's axis from that of the pinion, along x.
    """

    coefficient: float
    turn: float
    wheel_turn: float
    distance: float


@dataclass(frozen=True, kw_only=True)
class LoadedPairDeck:
    """Gears in mesh, the pinion pressed against the wheel by a torque.

    `mesh` has both gears, posed; `held` are the nodes of each that its hub holds: those of the wheel stand, those of the
    pinion turn about the z axis by the turn of a node of reference, on which the `torque` (N·m) is. `flanks` may touch, with
    pressures of `contact_stiffness` (MPa/mm) times their overlap. `width` (mm) is the thickness of sections, None for solids.
    `words` stand in the deck as comments. Gears with one of the `shafts` are held by it. With `sliding` the gears turn in a
    second step, under the torque.
    """

    mesh: ElementMesh
    held: PerGear[Wholes]
    materials: PerGear[Material]
    torque: float
    flanks: Sequence[Flanks]
    contact_stiffness: float
    words: Sequence[str] = ()
    width: float | None = None
    shafts: Mapping[Role, DeckShaft] = field(default_factory=dict)
    sliding: Sliding | None = None

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
            for shaft in self.shafts.values():
                shaft.write_nodes(file)
            write_elements(file, self.mesh, element_type(self.mesh.element))
            self._write_sets(file)
            element = len(self.mesh.cells) + 1
            for shaft in self.shafts.values():
                element = shaft.write_springs(file, element)
            self._write_materials(file)
            for shaft in self.shafts.values():
                shaft.write_equations(file, self.mesh.points)
            if Role.PINION not in self.shafts:
                write_turned(file, self.held.pinion, self.mesh.points, self.reference)
            if self.sliding is not None:
                file.write(f"*NODE, NSET={WHEEL_REFERENCE}\n{self.reference + 1}, {number(self.sliding.distance)}, 0., 0.\n")
                write_turned(file, self.held.wheel, self.mesh.points, self.reference + 1, self.sliding.distance)
            write_contact(file, self.flanks, self.contact_stiffness, _BEGUN if self.sliding is not None else 0.0)
            self._write_supports(file)
            self._write_step(file)

    @property
    def _solid(self) -> bool:
        return self.mesh.element.shape.dimension == 3

    def _write_sets(self, file: TextIO) -> None:
        for role, nodes in self.held.items():
            write_held(file, role, nodes)
        for name in dict.fromkeys(name for each in self.flanks for name in (*each.slaves, each.master)):
            write_surface(file, name, self.mesh.sides[name])

    def _write_materials(self, file: TextIO) -> None:
        """Write one material of both gears, or where they differ in elasticity that of each."""
        pinion, wheel = ((each.youngs_modulus, each.poisson_ratio) for each in self.materials)
        if pinion == wheel:
            write_material(file, self.materials.pinion, self.mesh.parts, self.width)
            return
        for role, material in self.materials.items():
            parts = [part for part in self.mesh.parts if part.startswith(role.value)]
            write_material(file, material, parts, self.width, f"{_MATERIAL}_{role.value}")

    def _write_supports(self, file: TextIO) -> None:
        file.write("*BOUNDARY\n")
        if self.sliding is not None:
            file.write(f"{WHEEL_REFERENCE}, 1, 3\n")
            file.write(f"{HELD.format(Role.WHEEL.value)}, 3\n" if self._solid else "")
        elif Role.WHEEL not in self.shafts:
            file.write(f"{HELD.format(Role.WHEEL.value)}, 1, {3 if self._solid else 2}\n")
        if self._solid and Role.PINION not in self.shafts:
            file.write(f"{HELD.format(Role.PINION.value)}, 3\n")
        file.write(f"{REFERENCE}, 2, 3\n")

    def _write_step(self, file: TextIO) -> None:
        # CalculiX keeps the normals of a contact from the start of an increment. Those of a flank into which the edge of a tip
        # has dug are uneven beside it: then the normal forces do not add up to the torque. So the load comes in one increment.
        file.write("*STEP, INC=100\n*STATIC\n1., 1., 1.e-5, 1.\n")
        for shaft in self.shafts.values():
            shaft.write_supports(file)
        file.write(f"*CLOAD\n{REFERENCE}, 1, {number(self.torque * 1000)}\n")
        for shaft in self.shafts.values():
            shaft.write_loads(file)
        if self.sliding is not None:
            file.write("*END STEP\n*STEP, INC=200\n*STATIC\n0.02, 1., 1.e-5, 0.1\n")
            file.write(f"*CHANGE FRICTION, INTERACTION={_INTERACTION}\n")
            write_friction(file, self.sliding.coefficient, self.contact_stiffness)
            file.write(f"*BOUNDARY\n{WHEEL_REFERENCE}, 1, 1, {number(self.sliding.wheel_turn)}\n")
        file.write("*NODE FILE, NSET=nodes\nU\n*EL FILE\nS\n*CONTACT FILE\nCDIS, CSTR\n")
        file.write(f"*NODE PRINT, NSET={REFERENCE}\nU\n")
        if self.sliding is None:
            file.write(f"*NODE PRINT, NSET={HELD.format(Role.WHEEL.value)}, TOTALS=ONLY\nRF\n")
        for each in self.flanks:
            file.writelines(f"*CONTACT PRINT, SLAVE={slave}, MASTER={each.master}\nCF\n" for slave in each.slaves)
        file.write("*CONTACT PRINT\nCSTR\n*END STEP\n")


def number(value: float) -> str:
    """Return a number as a deck has it: CalculiX reads 20 characters."""
    return f"{value:.12e}"


def write_heading(file: TextIO, words: Iterable[str]) -> None:
    """Write the heading of the deck, then `words` line by line as comments."""
    file.write("*HEADING\ngearcad: mm, N, MPa\n")
    file.writelines(f"** {line}\n" if line else "**\n" for line in words)


def write_reference(file: TextIO, node: int) -> None:
    """Write the node of reference, on the z axis."""
    file.write(f"*NODE, NSET={REFERENCE}\n{node}, 0., 0., 0.\n")


def write_held(file: TextIO, role: Role, nodes: Wholes) -> None:
    """Write the nodes that the hub of a gear holds, as a node set."""
    write_node_set(file, HELD.format(role.value), np.unique(nodes))


def write_material(
    file: TextIO, material: Material, parts: Iterable[str], width: float | None = None, name: str = _MATERIAL
) -> None:
    """Write the elastic material of parts under a name; `width` (mm) is the thickness of sections."""
    elastic = f"{number(material.youngs_modulus)}, {number(material.poisson_ratio)}"
    file.write(f"*MATERIAL, NAME={name}\n*ELASTIC\n{elastic}\n")
    for part in parts:
        file.write(f"*SOLID SECTION, ELSET={part}, MATERIAL={name}\n")
        if width is not None:
            file.write(f"{number(width)}\n")


def write_turned(file: TextIO, nodes: Wholes, points: Floats, reference: int, distance: float = 0.0) -> None:
    """Write equations that let nodes turn about an axis at x = `distance` (mm) by the angle (rad) of the node of reference.

    The angle is its degree of freedom 1. The equations are u = -y t, v = x t: rigid bodies and couplings of CalculiX 2.20 do
    not take nodes of sections.
    """
    file.write("*EQUATION\n")
    for node in np.unique(nodes).tolist():
        x, y, _ = points[node].tolist()
        for freedom, factor in ((1, y), (2, distance - x)):
            if abs(factor) > _NO_COEFFICIENT:
                file.write(f"2\n{node + 1}, {freedom}, 1., {reference}, 1, {number(factor)}\n")
            else:
                file.write(f"1\n{node + 1}, {freedom}, 1.\n")


def write_contact(file: TextIO, flanks: Iterable[Flanks], stiffness: float, friction: float = 0.0) -> None:
    """Write contact of surface to surface, with a coefficient of friction.

    Each pair of flanks is one of its own, so that its force can be printed.
    """
    file.write(f"*SURFACE INTERACTION, NAME={_INTERACTION}\n")
    file.write(f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{number(stiffness)}\n")
    if friction:
        write_friction(file, friction, stiffness)
    for each in flanks:
        pair = f"*CONTACT PAIR, INTERACTION={_INTERACTION}, TYPE=SURFACE TO SURFACE\n"
        file.writelines(f"{pair}{slave}, {each.master}\n" for slave in each.slaves)


def write_friction(file: TextIO, coefficient: float, stiffness: float) -> None:
    """Write friction, with a stiffness of sticking flanks that goes with that of the contact (MPa/mm)."""
    file.write(f"*FRICTION\n{number(coefficient)}, {number(_STICK * stiffness)}\n")


_STICK, _BEGUN = 0.1, 1e-6
"""Shear by slip where flanks stick, over pressure by overlap; coefficient of friction before the flanks slide."""

_COLUMN = 12
"""Characters of a number in a .frd, from the thirteenth of a line on."""

_SETS = re.compile(r"statistics for slave set (\S+), master set")

_ROWS = re.compile(r"[-+ 0-9.EeNna]+")
"""Pattern of rows of numbers, including NaN where nothing touches."""


@dataclass(frozen=True)
class PrintedContact:
    """Results in the .dat file of a loaded pair: rotation of the pinion (rad), and by the names of the slave surfaces the
    normal force (N, 0 where nothing touches) and the greatest pressure at a point of integration (MPa). `totals` are force (3,)
    in N and moment (3,) in N mm about the origin on each.
    """

    turn: float
    forces: Mapping[str, float]
    pressures: Mapping[str, float]
    totals: Mapping[str, Sequence[float]]

    @property
    def shares(self) -> dict[str, float]:
        """Shares of the load by the names of the slave surfaces."""
        total = math.fsum(self.forces.values())
        return {name: force / total for name, force in self.forces.items()}


def printed_contact(path: Path, mesh: ElementMesh, flanks: Iterable[str]) -> PrintedContact:
    """Read the .dat of a loaded pair; `flanks` are the slave surfaces. Raises SolverError if it is not whole."""
    turn, forces, stresses = math.nan, dict.fromkeys(flanks, 0.0), np.empty((0, 3))
    totals = dict[str, Sequence[float]]()
    sides = {name.upper(): name for name in forces}
    for heading, rows in _blocks(path):
        if heading.startswith("displacements"):
            turn = rows[-1][1]
        elif heading.startswith("contact stress"):
            stresses = np.array([row[:3] for row in rows])
        elif found := _SETS.match(heading):
            force = -rows[-1][1] if len(rows) > 3 else math.nan
            forces[sides[found[1]]] = force if math.isfinite(force) else 0.0
            totals[sides[found[1]]] = rows[0]
    if not math.isfinite(turn) or not len(stresses):
        raise SolverError(f"{path.name} has no loaded pair: check that CalculiX finished")
    owners = {name: np.isin(stresses[:, 0], mesh.sides[name].elements + 1) for name in forces}
    pressures = {name: float(stresses[own, 2].max(initial=0.0)) for name, own in owners.items()}
    return PrintedContact(turn, forces, pressures, totals)


def _blocks(path: Path) -> Iterator[tuple[str, list[list[float]]]]:
    """Yield the headings of a .dat, and the lines of numbers below each;
    words between those of one statistic are passed over.
    """
    heading, rows = "", list[list[float]]()
    with path.open(encoding="latin-1") as lines:
        for text in map(str.strip, lines):
            if text and _ROWS.fullmatch(text):
                rows.append([float(word) for word in text.split()])
            elif " and time " in text or " for set " in text:
                if heading:
                    yield heading, rows
                heading, rows = text, []
    yield heading, rows


def displacements(path: Path, nodes: int) -> Floats:
    """Return the displacements (nodes, 3) in mm of the first nodes, from the last increment in a .frd. Raises SolverError."""
    found, inside = np.full((nodes, 3), np.nan), False
    with path.open(encoding="latin-1") as lines:
        for line in lines:
            if line.startswith(" -4"):
                inside = line[5:9] == "DISP"
            elif inside and line.startswith(" -1") and (node := int(line[3:13])) <= nodes:
                found[node - 1] = [float(line[at : at + _COLUMN]) for at in range(13, 13 + 3 * _COLUMN, _COLUMN)]
    if np.isnan(found).any():
        raise SolverError(f"{path.name} does not have the displacements of all nodes: check that CalculiX finished")
    return found


@dataclass(frozen=True)
class CalculixDeviations:
    """Deviations in % of our own figures; that of the load share in % of the load, for the pair of teeth with the largest
    deviation.

    That of the pressure is the greatest of all pairs of teeth away from edges, None if there are none.
    """

    transmission_error: float
    load_share: float
    root_stress: PerGear[float]
    contact_pressure: float | None


def deviations(expected: dict[str, Any], found: dict[str, Any]) -> CalculixDeviations:
    """Return the deviations of the figures `found` from those `expected`, both as a deck has them."""
    theirs = {pair["pinion"]: pair for pair in found["pairs"]}
    ours = {pair["pinion"]: pair for pair in expected["pairs"]}
    shares = [_value(theirs, name, "load_share") - _value(ours, name, "load_share") for name in theirs | ours]
    pressures = [
        _relative(_value(theirs, name, "contact_pressure"), pair["contact_pressure"])
        for name, pair in ours.items()
        if pair["contact_pressure"]
    ]
    roots = PerGear.each(lambda role: _root(found, expected, role))
    error = _relative(found["transmission_error"], expected["transmission_error"])
    return CalculixDeviations(error, 100 * max(shares, key=abs), roots, max(pressures, key=abs, default=None))


def _value(pairs: dict[str, Any], name: str, figure: str) -> float:
    return float(pairs[name][figure]) if name in pairs else 0.0


def _root(found: dict[str, Any], expected: dict[str, Any], role: Role) -> float:
    return _relative(found["root_stress"][role.value], expected["root_stress"][role.value])


def _relative(value: float, reference: float) -> float:
    return 100 * (value / reference - 1)
