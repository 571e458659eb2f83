"""Decks of a check of solid bodies: hexahedra, fine along the lines of contact; root stresses from displacements."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import ClassVar, TextIO, cast

import numpy as np

from gearcad.check.options import Model
from gearcad.check.run import solid_model
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE, LoadedPosition, PairContact, roll_lengths
from gearcad.contact.solid.cycle import SolidCycle, SolidPairContact
from gearcad.contact.solid.flank import Places
from gearcad.contact.solid.pair import teeth_moved
from gearcad.core.errors import ParameterError
from gearcad.core.records import Bools, Floats, JsonObject, Role, Wholes
from gearcad.decks.calculix import Flanks, number, printed_contact
from gearcad.decks.pair import PairDeck, PairDecks, ToothDeck, held_nodes
from gearcad.decks.shafts import DeckShaft, with_bare_section
from gearcad.geometry import GearPair
from gearcad.geometry.gear_data import twist
from gearcad.material import Material
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import mesh_body
from gearcad.meshing.bodies.element_mesh import Faces, joined, rises
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.fem import quadrature, shape_slopes, shape_values
from gearcad.meshing.outline import MeshSizes
from gearcad.meshing.sector import layer_planes


@dataclass(frozen=True)
class FilletFace:
    """A fillet over the whole face of a posed body of hexahedra. The middle of its tooth is at the angle `turn` (rad) about the
    gear's axis where the gear begins, and turns by `rate` (rad/mm). `upward` is 1, or -1 for a ring's tooth, which points
    inwards.
    """

    mesh: ElementMesh
    name: str
    turn: float
    rate: float
    upward: int = 1


def root_tension(fillet: FilletFace, moved: Floats, material: Material) -> float:
    """Return the greatest principal tension (MPa) of a fillet by displacements (n, 3) in mm of the nodes of its mesh.

    Half-way along each edge of the profile, at the Gauss points over the face; from a tangent angle on, as our own check.
    """
    nodes = fillet.mesh.face_cells(fillet.name)
    lowest = float(fillet.mesh.points[nodes, 2].min())
    face, above = fillet.mesh.element.shape.face, quadrature("line3", 3).places
    places = np.concatenate([np.full_like(above, 0.5), above], axis=1)
    heights = np.einsum("qa,na->qn", shape_values(face, places), fillet.mesh.points[nodes, 2]).ravel() - lowest
    by_place = shape_slopes(face, places)
    bases, slopes = (np.einsum("qda,nac->dqnc", by_place, of[nodes]).reshape(2, -1, 3) for of in (fillet.mesh.points, moved))
    at_root = _tangent_angles(fillet, bases[0], heights) >= LEAST_TANGENT_ANGLE
    return float(_greater(bases, slopes, material)[at_root].max())


def _tangent_angles(fillet: FilletFace, along: Floats, z: Floats) -> Floats:
    """Return the angles (n,) in degrees between the profile's tangents (n, 3) at heights (n,) of the gear and the middle of the
    tooth.
    """
    own = (along[:, 0] + 1j * along[:, 1]) * np.exp(-1j * (fillet.turn + fillet.rate * z))
    result: Floats = np.degrees(np.arctan2(fillet.upward * own.imag, np.abs(own.real)))
    return result


def _greater(bases: Floats, slopes: Floats, material: Material) -> Floats:
    """Greater principal stresses (n,) in MPa of a free surface: `slopes` of displacements along `bases`, (2, n, 3) each."""
    length = np.linalg.norm(bases[0], axis=1)
    first = bases[0] / length[:, None]
    lean = (bases[1] * first).sum(1)
    upright = bases[1] - lean[:, None] * first
    height = np.linalg.norm(upright, axis=1)
    second = upright / height[:, None]
    by_first = slopes[0] / length[:, None]
    by_second = (slopes[1] - lean[:, None] * by_first) / height[:, None]
    along, axial = (by_first * first).sum(1), (by_second * second).sum(1)
    shear = (by_first * second).sum(1) + (by_second * first).sum(1)
    e, nu = material.youngs_modulus, material.poisson_ratio
    mean, apart = e / (1 - nu) * (along + axial) / 2, e / (1 + nu) * (along - axial) / 2
    result: Floats = mean + np.hypot(apart, e / (2 * (1 + nu)) * shear)
    return result


SOLID_SIZES = MeshSizes(flank=0.5, corner=0.3, fillet=0.11, outline=0.8, cut=0.7, rim=4.0, growth=0.8)
"""Edges away from the contacts; root stresses are then within 1 % (measured)."""

_LAYER = 0.8
"""Mean thickness of a layer in normal modules."""

_EDGE = 0.6
"""Edge where teeth touch over the half width of the widest contact: the approach is then within 0.5 % (measured)."""

_SHORTEST, _LONGEST = 0.02, 4.0
"""Least edge there in normal modules, greatest over the half width: with longer ones the approach is off by more than 1 %."""

_MOST_EDGES = 10
"""Most edges over the stretch of a flank on which an oblique line of contact lies."""

_REACH = 1.6
"""Half widths on each side of a contact over which edges stay short: another solver's may lie a little aside."""

_FEWEST_TEETH = 7
"""Least number of teeth of a body that replaces a ring. Our own check places every tooth that touches in the middle of such a
body; a deck has tooth 0 there. With 5 teeth that changes the approach by up to 2 % where other teeth share the load (measured).
"""


def solid_task(task: CheckTask) -> CheckTask:
    """Return the task with solid bodies on rigid shafts.

    Where it asks for rings, they have so few teeth that CalculiX has done within minutes.
    """
    teeth = task.options.body_teeth or max(_FEWEST_TEETH, 2 * teeth_moved(task.gear_pair) + 1)
    return replace(task, shafts=None, options=replace(task.options, model=Model.SOLID.value, body_teeth=teeth))


def shaft_task(task: CheckTask) -> CheckTask:
    """Return the task with solid bodies on the shafts of the pair. The bodies are whole rings, as they bend with their shafts.

    Raises ParameterError for a pair without shafts.
    """
    if task.shafts is None:
        raise ParameterError("mesh.deck", "shafts", "must be pair or tooth: a shaft is described of neither gear")
    return replace(task, options=replace(task.options, model=Model.SOLID.value, body_teeth=0))


@dataclass(frozen=True)
class SolidDecks(PairDecks):
    """Bodies of a `solid_task`; `sizes` are those of the elements away from the contacts, `layers` the fewest over the common
    face width.
    """

    sizes: MeshSizes = SOLID_SIZES
    layers: int = 6

    solid: ClassVar[bool] = True
    begun: ClassVar[float] = 0.15

    @property
    def pair(self) -> GearPair:
        """The pair as mounted."""
        return self.task.gear_pair

    @cached_property
    def cycle(self) -> SolidCycle:
        return SolidCycle(solid_model(self.task), self.task.torque)

    def teeth_near(self, roll_angle: float) -> Iterable[int]:
        model = self.cycle.model
        lines = model.responses(roll_angle, model.farthest(self.task.torque)).lines
        return [line.tooth for line in lines if abs(line.tooth) <= self._reach]

    def _contacts(self, roll_angle: float) -> Sequence[SolidPairContact]:
        """Return the contacts that carry. Raises ParameterError if not all of their teeth are on the bodies."""
        contacts = self.cycle.contacts_at(roll_angle)
        farthest = max(abs(contact.tooth) for contact in contacts)
        if farthest > self._reach:
            permitted = f"must be at least {2 * farthest + 1} for a deck: so many teeth carry around tooth 0"
            raise ParameterError("check.body_teeth", self.task.options.body_teeth, permitted)
        return contacts

    @property
    def _reach(self) -> int:
        """Teeth beside tooth 0 that both bodies have."""
        return min((self.task.body.teeth_held(gear) or gear.tooth_count) for gear in self.pair.gears) // 2

    def zones(self, roll_angle: float, role: Role) -> Mapping[int, ContactRefinement]:
        contacts, diameter = self._contacts(roll_angle), abs(self.pair.gears.pick(role).base_diameter)
        squares = [contact.line.places.pick(role)[0][contact.forces > 0] ** 2 for contact in contacts]
        half = max(float(contact.half_widths.max()) for contact in contacts)
        reaches = [float(np.ptp(each)) / diameter / 2 + _REACH * half for each in squares]
        edge = max(_EDGE * half, 2 * max(reaches) / _MOST_EDGES, _SHORTEST * self.pair.pinion.normal_module)
        self._require_wide(half, edge)
        return {
            self.tooth(role, contact.tooth): ContactRefinement(
                length=math.sqrt((float(each.min()) + float(each.max())) / 2), half_width=reach, edge=edge, left=self.left
            )
            for contact, each, reach in zip(contacts, squares, reaches, strict=True)
        }

    def _require_wide(self, half: float, edge: float) -> None:
        """Raise ParameterError where contacts are too narrow for the edges that a deck can have."""
        if half * _LONGEST < edge:
            least = abs(self.task.torque) * (edge / half / _LONGEST) ** 2
            permitted = f"must be at least {least:.2g} N·m in size for a deck: the contact is only {2 * half:.2g} mm wide"
            raise ParameterError("load.torque", self.task.torque, permitted, "N·m")

    def planes(self, role: Role) -> Floats:
        """Return the heights (n,) in mm of the planes between layers of a gear: of the common face width, and of what is beyond
        it.
        """
        low, high = self.cycle.model.common_heights(role)
        gear = self.pair.gears.pick(role)
        thickness = _LAYER * gear.normal_module
        inside = low + layer_planes(high - low, max(self.layers, round((high - low) / thickness)))
        planes: Floats = np.r_[_beyond(0.0, low, thickness)[:-1], inside, _beyond(high, gear.face_width, thickness)[1:]]
        planes[[0, -1]] = 0.0, gear.face_width
        return planes

    def divided(self, mesh: ElementMesh, flanks: list[Flanks]) -> tuple[ElementMesh, list[Flanks]]:
        """Return mesh and flanks; of a pair on its shafts each layer of elements of a slave surface is a part of it."""
        if self.task.on_shafts is None:
            return mesh, flanks
        sides, found = dict(mesh.sides), list[Flanks]()
        for each in flanks:
            names = []
            for layer, inside in enumerate(self._layers_of(mesh, each.slave)):
                name, faces = f"{each.slave}_layer_{layer}", mesh.sides[each.slave]
                sides[name] = Faces(faces.elements[inside], faces.sides[inside])
                names.append(name)
            found.append(replace(each, parts=tuple(names)))
        return replace(mesh, sides=sides), found

    def _layers_of(self, mesh: ElementMesh, side: str) -> list[Bools]:
        """Return which faces (n,) of a flank are in each layer of the common face width, the lowest first."""
        edges = self.station_edges + self.pair.pinion.face_width / 2 + self.pair.common_width.offset
        heights = mesh.points[mesh.face_cells(side)[:, :4], 2].mean(axis=1)
        return [(heights > low) & (heights < high) for low, high in pairwise(edges.tolist())]

    @cached_property
    def station_edges(self) -> Floats:
        """Heights (n,) in mm from the middle of the common face width between which line loads are told."""
        low, high = self.cycle.model.common_heights(Role.PINION)
        planes = self.planes(Role.PINION)
        inside = planes[(planes > low - _SAME) & (planes < high + _SAME)]
        return np.asarray(inside - (low + high) / 2, float)

    def over_face(self, position: LoadedPosition[PairContact]) -> JsonObject:
        if self.task.on_shafts is None:
            return {}
        return {"station_edges": self.station_edges.tolist(), "line_load": self.line_loads(position).tolist()}

    def line_loads(self, position: LoadedPosition[PairContact]) -> Floats:
        """Return our own loads (n,) between the station edges in N/mm: transverse, of all pairs of teeth."""
        width, cells = self.cycle.model.width, self.cycle.model.cells
        total = np.zeros(cells)
        for contact in cast("Sequence[SolidPairContact]", position.contacts):
            np.add.at(total, np.floor(contact.line.across / (width / cells) + cells / 2).astype(int), contact.forces)
        so_far = np.interp(self.station_edges, np.linspace(-width / 2, width / 2, cells + 1), np.r_[0.0, np.cumsum(total)])
        return np.asarray(np.diff(so_far) * math.cos(self.cycle.model.helix) / np.diff(self.station_edges), float)

    def found_line_loads(self, deck: PairDeck, job: Path) -> Floats:
        """Return the same (n,) in N/mm as CalculiX has left it in the files of a job, named without suffix. Raises
        SolverError.
        """
        flanks = deck.deck.flanks
        names = [slave for each in flanks for slave in each.slaves]
        printed = printed_contact(job.with_name(f"{job.name}.dat"), deck.deck.mesh, names)
        forces = np.sum([[printed.forces[slave] for slave in each.slaves] for each in flanks], axis=0)
        return np.asarray(forces * math.cos(self.cycle.model.helix) / np.diff(self.station_edges), float)

    def shafts(self, mesh: ElementMesh) -> dict[Role, DeckShaft]:
        """Return the shafts that hold the gears of a posed mesh."""
        on, found = self.task.on_shafts, dict[Role, DeckShaft]()
        if on is None:
            return found
        first, reference = len(mesh.points) + 2, len(mesh.points) + 1
        middle = self.pair.pinion.face_width / 2 + self.pair.common_width.offset
        radii = self.task.body.inner_radii(self.pair)
        for role in Role:
            shaft = on.shafts.pick(role)
            if shaft is None:
                continue
            held = held_nodes(mesh, f"{role.value}_")
            start = middle - on.positions.pick(role)
            heights = _distinct(mesh.points[held, 2]) - start
            beam = with_bare_section(shaft, float(heights[0]), float(heights[-1]), 2 * radii.pick(role), heights)
            found[role] = DeckShaft(
                name=role.value,
                beam=beam,
                x=self.pair.centre_distance if role is Role.WHEEL else 0.0,
                start=start,
                turn=-math.radians(on.mesh_angle),
                first=first,
                held=held,
                driver=reference if role is Role.PINION else None,
            )
            first += found[role].count
        return found

    def mesh(self, role: Role, zones: Mapping[int, ContactRefinement]) -> ElementMesh:
        body, gear = self.task.body, self.pair.gears.pick(role)
        return mesh_body(
            gear,
            teeth=body.teeth_held(gear),
            held_radius=body.inner_radii(self.pair).pick(role),
            sizes=self.sizes,
            planes=self.planes(role),
            element=Element.HEX20,
            contacts=zones,
        )

    def root_tension(self, mesh: ElementMesh, moved: Floats, role: Role, tooth: int, turn: float) -> float:
        """Return the greatest tension (MPa) of the fillet's surface by strains, as our own check has it."""
        gear = self.pair.gears.pick(role)
        upward, around = -1 if gear.internal else 1, turn + 2 * math.pi * tooth / gear.tooth_count
        fillet = FilletFace(mesh, self.side(role, tooth, "fillet"), around, twist(gear), upward)
        return root_tension(fillet, moved, self.task.materials.pick(role))


_SAME = 1e-6
"""Distance (mm) below which two heights are one."""


def _distinct(heights: Floats) -> Floats:
    """Return heights (n,) in order, each once."""
    ordered = np.sort(heights)
    return np.asarray(ordered[np.r_[True, np.diff(ordered) > _SAME]], float)


def _beyond(low: float, high: float, thickness: float) -> Floats:
    """Return the planes (n,) from one height to another; a single one if they are equal."""
    return np.linspace(low, high, math.ceil((high - low) / thickness - 1e-6) + 1)


_MIRRORED = np.array([1.0, -1.0, 1.0])
"""Mirrors vectors: our solution has every loaded flank on the side y > 0 of its tooth."""


@dataclass(frozen=True)
class SolidToothDeck(ToothDeck):
    """Forces (n, 3) in N on `nodes` (n,) of a body."""

    nodes: Wholes
    forces: Floats

    def write_loads(self, file: TextIO) -> None:
        """Write forces on nodes."""
        file.write("*CLOAD\n")
        for node, force in zip(self.nodes.tolist(), self.forces.tolist(), strict=True):
            file.writelines(f"{node + 1}, {axis}, {number(part)}\n" for axis, part in enumerate(force, 1) if part)


def solid_tooth_deck(decks: SolidDecks, roll_angle: float, role: Role) -> SolidToothDeck:
    """Return a gear at a roll angle (deg), in coordinates of its own. Raises SolverError and GeometryError."""
    position, gear = decks.cycle.solve(roll_angle), decks.pair.gears.pick(role)
    mesh = joined({role.value: decks.mesh(role, {})})
    exact, forces = decks.cycle.model.bodies.pick(role).flank, np.zeros_like(mesh.points)
    for contact in position.contacts:
        tooth, places = decks.tooth(role, contact.tooth), contact.line.places.pick(role)
        pressing = contact.forces[:, None] * exact.inward(places)
        if not rises(gear, decks.flank_side):
            pressing = pressing * _MIRRORED
        turned = _turned(pressing, 2 * math.pi * tooth / gear.tooth_count)
        _lay(forces, mesh, decks.side(role, tooth, "flank"), exact.base_radius, places, turned)
    nodes = np.flatnonzero(forces.any(axis=1))
    return SolidToothDeck(decks, role, mesh, position, nodes, forces[nodes])


def _lay(forces: Floats, mesh: ElementMesh, flank: str, base_radius: float, places: Places, pressing: Floats) -> None:
    """Add forces `pressing` (n, 3) in N at places of a flank to those of the nodes (nodes, 3), as shape functions share them.

    On a face of a swept flank the height goes with one local coordinate, the square of the roll length with the other: nodes
    between vertices are half-way in arc length.
    """
    nodes = mesh.face_cells(flank)
    corners = mesh.points[nodes[:, :4]]
    squares = roll_lengths(np.hypot(corners[..., 0], corners[..., 1]), base_radius) ** 2
    along, up = (places[0] ** 2)[:, None], places[1][:, None]
    across = (along - squares[:, 0]) / (squares[:, 1] - squares[:, 0])
    above = (up - corners[:, 0, 2]) / (corners[:, 3, 2] - corners[:, 0, 2])
    face = np.argmin(np.maximum(np.abs(across - 0.5), np.abs(above - 0.5)), axis=1)
    every = np.arange(len(face))
    local = np.clip(np.stack([across[every, face], above[every, face]], -1), 0, 1)
    shares = shape_values(mesh.element.shape.face, local)
    np.add.at(forces, nodes[face], shares[:, :, None] * pressing[:, None])


def _turned(vectors: Floats, angle: float) -> Floats:
    """Return the vectors (n, 3) turned about the z axis by an angle (rad)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    result: Floats = vectors @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return result
