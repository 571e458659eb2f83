"""Loaded pairs, and single loaded gears, as decks: what plane and solid gears have in common."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, TextIO

import numpy as np

from gearcad.check.task import CheckTask
from gearcad.contact.shared.bodies import Cuts, Hold
from gearcad.contact.shared.loaded import FAIR, Cycle, LoadedPosition, PairContact
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats, JsonObject, PerGear, Role, Wholes
from gearcad.decks.calculix import (
    HELD,
    Flanks,
    LoadedPairDeck,
    Sliding,
    displacements,
    printed_contact,
    write_heading,
    write_held,
    write_material,
)
from gearcad.decks.shafts import DeckShaft
from gearcad.geometry import GearPair, RackPair
from gearcad.geometry.tooth_friction import sliding_levers
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.body_mesh import posed, poses
from gearcad.meshing.bodies.element_mesh import BACK, BORE, RIM
from gearcad.meshing.bodies.sectors import ContactRefinement
from gearcad.meshing.files import element_type, write_elements, write_nodes

_PAIR = """\
A pair of gears in mesh at the roll angle {roll_angle:.6g} deg, the pinion pressed against the wheel by {torque:.6g} N m.
CalculiX runs this deck as it is:  ccx NAME  for NAME.inp

The pinion turns about the z axis; the wheel's axis is at x = {distance:.10g} mm. All of each bore, or of an internal gear's
rim, is held, and the cuts of bodies of fewer teeth: the wheel's stand, the pinion's turn with the node "reference", whose
first degree of freedom is the angle in rad. The flanks of pairs of teeth that may touch are surfaces; pressure is a stiffness
times overlap.

The pinion stands turned by {approach_in_mesh:.6g} um along the line of action already, so that there is contact in the first
iteration. The transmission error is that and the angle times the base radius, {base_radius:.10g} mm.

gearcad's own check of the same gears: transmission error {transmission_error:.5g} um, angle {reference_turn:.6e} rad,
greatest tension along the fillets, pinion {root_pinion:.5g} MPa, wheel {root_wheel:.5g} MPa."""

_ON_SHAFTS = """\

Gears on shafts are not held: the nodes of a bore move with the section of the shaft at their height. The sets NAME_shaft have
two nodes for each station of a shaft, the first with its displacement, the second with its turn (rad) in three degrees of
freedom; beams and bearings are springs between them and to the ground. The node "reference" turns with the coupling of the
pinion's shaft, the coupling of the wheel's is held. Each layer of elements of a flank is a surface with its own force."""

_TOOTH = """\
The {gear} under the loads that gearcad's own check has found on its flanks at the roll angle {roll_angle:.6g} deg,
with {torque:.6g} N m on the pinion. CalculiX runs this deck as it is:  ccx NAME  for NAME.inp

Tooth 0 is on the x axis; all of the bore, or of an internal gear's rim, is held, and the cuts of a body of fewer teeth. {laid}

Greatest tension along the fillets by gearcad's own check: {root_stress:.6g} MPa."""


_LAID_ON_EDGES = """\
The force on each tooth
is laid on the edges of its flank as uniform pressures, which add up to it."""

_LAID_ON_NODES = """\
The loads along the
lines of contact are forces on nodes of the flanks, shared as the shape functions of their faces do."""


def pair_words(expected: Mapping[str, Any], *, distance: float, base_radius: float) -> list[str]:
    """Return the words of a pair, line by line; centre distance and base radius in mm."""
    roots = {f"root_{gear}": stress for gear, stress in expected["root_stress"].items()}
    return _PAIR.format(**expected, **roots, distance=distance, base_radius=base_radius).splitlines()


def tooth_words(expected: Mapping[str, Any], *, solid: bool) -> list[str]:
    """Return the words of a deck of one gear, line by line."""
    return _TOOTH.format(**expected, laid=_LAID_ON_NODES if solid else _LAID_ON_EDGES).splitlines()


_UNTILTED = ("misalignment", "misalignment_across")
_PITCH_ERRORS = ("pinion_pitch_error", "wheel_pitch_error")


def require_treatable(task: CheckTask) -> None:
    """Raise ParameterError or GeometryError for supports, cuts and mountings that decks do not have."""
    _require_rigid_hubs(task)
    for name in (*_UNTILTED, *_PITCH_ERRORS):
        if value := getattr(task.mounting, name):
            raise ParameterError(f"mounting.{name}", value, "must be 0 for a deck: it has the gears as they are drawn", "µm")


def _require_rigid_hubs(task: CheckTask) -> None:
    body = task.body
    for role, support in body.supports(task.pair).items():
        gear = task.gears.get(role)
        if gear is None:  # a rack is held along its back
            continue
        if support.hold is not Hold.RIGID:
            held = "rim" if gear.internal else "bore"
            permitted = f'must be "{Hold.RIGID.value}" for a deck, which holds the {held} all round'
            raise ParameterError(f"check.{role.value}_support", support.hold.value, permitted)
        if body.teeth_held(gear) is not None and body.cuts is not Cuts.FIXED:
            raise ParameterError("check.cuts", body.cuts.value, f'must be "{Cuts.FIXED.value}" for a deck')


def require_same_flanks(task: CheckTask) -> None:
    """Raise GeometryError where flanks are modified along the face, and gears do not meet in the middle of theirs.

    A plane deck is of the sections in the middle of both gears, our own check of those in the middle of the common width.
    """
    if isinstance(task.pair, RackPair):  # middles of both faces are in one plane
        return
    pair = task.pair
    middle = pair.common_width.offset
    for offset, gear in zip((middle, middle - pair.axial_offset), pair.gears, strict=True):
        if gear.modification.along_face and offset:
            permitted = "must be 0 for a plane deck of flanks that are modified along the face width"
            raise GeometryError("pair.axial_offset", pair.axial_offset, permitted, "mm")


_WITH_FRICTION = """\

Flanks have friction, which needs a sense. After the torque the wheel turns in a second step, and the pinion by {:.4g} deg with
it: the flanks slide, and stand at the roll angle in the end. The set wheel_reference has the torque on the wheel."""

_SLIDING, _MOST_TURN = 2.0, 5e-3
"""Distance by which flanks slide, in coefficients of friction and approaches of the gears, so that none sticks; and the most by
which the pinion turns for it (rad), as beside the pitch point.
"""

_STIFFNESS = 10.0
"""Pressure by overlap, over the lower modulus by edge: overlaps are then far below an edge, and iterations still end."""


@dataclass(frozen=True)
class PairDecks(ABC):
    """A check whose positions are wanted as decks: bodies are solved once. Raises ParameterError and GeometryError.

    Under a negative torque right flanks carry. Our own solution then has them in a mirror: its tooth 1 is tooth -1.
    """

    task: CheckTask

    solid: ClassVar[bool]

    begun: ClassVar[float]
    """Share of the elastic approach that is put into the mesh: with it contact is about as wide as Hertz's from the start."""

    def __post_init__(self) -> None:
        require_treatable(self.task)

    @property
    def pair(self) -> GearPair | RackPair:
        """The pair as mounted."""
        return self.task.pair

    def posed(self, meshes: PerGear[ElementMesh], roll_angle: float, approach: float) -> ElementMesh:
        """Return the meshes of both gears in one, at a roll angle (deg), the pinion turned by an approach (mm)."""
        return posed(self.task.gear_pair, meshes, roll_angle, approach, left=self.left)

    def turn(self, role: Role, roll_angle: float) -> float:
        """Return the angle (rad) by which a gear is turned in the joined mesh at a roll angle (deg), without an approach."""
        return math.radians(poses(self.task.gear_pair, roll_angle, solid=self.solid, left=self.left).pick(role).rotation)

    def words(self, expected: Mapping[str, Any]) -> list[str]:
        """Return what stands in the deck as comments, by our own figures."""
        pair = self.task.gear_pair
        return pair_words(expected, distance=pair.centre_distance, base_radius=pair.pinion.base_diameter / 2)

    @property
    def left(self) -> bool:
        """True if left flanks carry."""
        return self.task.torque > 0

    @property
    def flank_side(self) -> str:
        """Return "left" or "right": the flanks of both gears that carry."""
        return "left" if self.left else "right"

    @property
    @abstractmethod
    def cycle(self) -> Cycle:
        """Our own model of the pair under its torque."""

    @abstractmethod
    def teeth_near(self, roll_angle: float) -> Iterable[int]:
        """Return the pairs of teeth, as our solution counts them, that may touch."""

    @abstractmethod
    def zones(self, roll_angle: float, role: Role) -> Mapping[int, ContactRefinement]:
        """Return the zones where the loaded flanks of a gear are fine, tooth by tooth. Raises ParameterError for narrow
        contacts.
        """

    @abstractmethod
    def mesh(self, role: Role, zones: Mapping[int, ContactRefinement]) -> ElementMesh:
        """Return the mesh of a gear, or the part of it that the check uses, in its own coordinates."""

    @abstractmethod
    def root_tension(self, mesh: ElementMesh, moved: Floats, role: Role, tooth: int, turn: float) -> float:
        """Return the greatest tension (MPa) in the loaded fillet of a tooth of a gear that is turned by `turn` (rad), by
        displacements.
        """

    @property
    def width(self) -> float | None:
        """Thickness (mm) of sections: the common face width."""
        return None if self.solid else self.task.width

    def tooth(self, role: Role, tooth: int) -> int:
        """Return the tooth of a gear that has part in our solution's pair of teeth `tooth`,
        counted counter-clockwise from 0.
        """
        pair = self.task.gear_pair
        order = 1 if role is Role.PINION or pair.internal else -1
        return order * (1 if self.left else -1) * tooth % pair.gears.pick(role).tooth_count

    def side(self, role: Role, tooth: int, part: str) -> str:
        """Name of the loaded "flank" or "fillet" of a tooth in the joined mesh."""
        return f"{role.value}_{self.flank_side}_{part}_{tooth}"

    def flanks(self, tooth: int, *, wheel_tip: bool = False) -> Flanks:
        """Return the flanks of our solution's pair of teeth `tooth` in the joined mesh."""
        pinion, wheel = (self.side(role, self.tooth(role, tooth), "flank") for role in Role)
        return Flanks(pinion, wheel, wheel_tip)

    def divided(self, mesh: ElementMesh, flanks: list[Flanks]) -> tuple[ElementMesh, list[Flanks]]:
        """Return mesh and flanks with the parts of which the slave surfaces are made, where forces are wanted part by part."""
        return mesh, flanks

    def over_face(self, _position: LoadedPosition[PairContact]) -> JsonObject:
        """Return our own figures of the load over the face, where a deck tells it part by part."""
        return {}

    def shafts(self, _mesh: ElementMesh) -> dict[Role, DeckShaft]:
        """Return the shafts that hold the gears of a posed mesh; gears without one are held rigidly."""
        return {}

    def _sliding(self, position: LoadedPosition[PairContact]) -> Sliding | None:
        """Return the friction of the flanks, with the turns (rad) by which they slide; None without friction."""
        friction = self.task.friction
        if friction is None or not (coefficient := friction.coefficient(self.cycle.model.force(self.task.torque))):
            return None
        way = (1 if friction.driver is Role.PINION else -1) * (1 if self.left else -1)
        levers = [
            float(sliding_levers(self.task.gear_pair, contact.place)) for contact in position.contacts if contact.share > FAIR
        ]
        turn = way * min(_SLIDING * coefficient * position.approach / max(min(levers), 1e-6), _MOST_TURN)
        pair = self.task.gear_pair
        return Sliding(coefficient, turn, -turn / pair.gear_ratio, pair.centre_distance)

    def at(self, roll_angle: float) -> PairDeck:
        """Return the pair at a roll angle (deg). Raises ParameterError, GeometryError and SolverError."""
        position = self.cycle.solve(roll_angle)
        elastic = position.approach - position.rigid_approach - position.support_approach
        approach = position.rigid_approach + self.begun * elastic
        zones = PerGear(*(self.zones(roll_angle, role) for role in Role))  # what they refuse is neither gear's own
        meshes = PerGear.each(lambda role: self.mesh(role, zones.pick(role)))
        sliding = self._sliding(position)
        start = roll_angle if sliding is None else roll_angle - math.degrees(sliding.turn) * (1 if self.left else -1)
        mesh = self.posed(meshes, start, approach)
        edge = min(zone.edge for each in zones for zone in each.values())
        tips = {contact.tooth for contact in position.contacts if contact.arms.wheel != 1}
        flanks = [self.flanks(tooth, wheel_tip=tooth in tips) for tooth in self.teeth_near(roll_angle)]
        mesh, flanks = self.divided(mesh, flanks)
        deck = LoadedPairDeck(
            mesh=mesh,
            held=PerGear.each(lambda role: held_nodes(mesh, f"{role.value}_")),
            materials=self.task.materials,
            torque=self.task.torque,
            flanks=flanks,
            contact_stiffness=_STIFFNESS * min(each.youngs_modulus for each in self.task.materials) / edge,
            width=self.width,
            shafts=self.shafts(mesh),
            sliding=sliding,
        )
        made = PairDeck(self, deck, position, approach)
        words = self.words(made.expected)
        words += _ON_SHAFTS.splitlines() if deck.shafts else []
        words += [] if sliding is None else _WITH_FRICTION.format(math.degrees(abs(sliding.turn))).splitlines()
        return replace(made, deck=replace(deck, words=words))


@dataclass(frozen=True)
class PairDeck:
    """A deck, and what our own check finds of the same gears at the same roll angle.

    `approach` (mm) is what the pinion is turned by in the mesh, along the line of action: the deck's transmission error is
    that and what the turn of its node of reference adds.
    """

    decks: PairDecks
    deck: LoadedPairDeck
    position: LoadedPosition[PairContact]
    approach: float

    @property
    def expected(self) -> dict[str, Any]:
        """Figures of our own check to compare with.

        These are the transmission error in µm, the turn in rad, stresses in MPa and forces in N. There is no contact pressure
        near the edges of flanks.
        """
        of, pair = self.position, self.decks.pair
        turn = (of.approach - self.approach) / self._base_radius + second_turn(self.deck)
        sliding = {}
        if self.deck.sliding is not None:
            force = math.fsum(contact.force for contact in of.contacts) * (self.decks.width or 1.0)
            sliding = {"normal_force": force, "wheel_torque": self._wheel_torque}
        return {
            "roll_angle": of.roll_angle,
            "torque": self.deck.torque,
            "body": self.decks.task.body.describe(pair),
            "approach_in_mesh": self.approach * 1000,
            "transmission_error": of.approach * 1000,
            "reference_turn": math.copysign(turn, self.deck.torque),
            "normal_force": of.force * self.decks.task.width / math.cos(math.radians(pair.pinion.base_helix_angle)),
            "pairs": [
                {
                    "pinion": flanks.pinion,
                    "wheel": flanks.wheel,
                    "load_share": contact.share,
                    "contact_pressure": contact.interior_pressure,
                }
                for contact, flanks in ((each, self.decks.flanks(each.tooth)) for each in of.contacts)
            ],
            "root_stress": {role.value: root.stress for role, root in of.tension.items()},
            **sliding,
            **self.decks.over_face(of),
        }

    def write(self, path: Path) -> None:
        """Write the deck; `ccx` wants a name that ends with .inp."""
        self.deck.write(path)

    def found(self, job: Path) -> dict[str, Any]:
        """Return the figures to compare as CalculiX has left them in the files of a job, named without suffix. Raises
        SolverError.
        """
        mesh, every = self.deck.mesh, self.deck.flanks
        printed = printed_contact(job.with_name(f"{job.name}.dat"), mesh, [slave for each in every for slave in each.slaves])
        forces = [math.fsum(printed.forces[slave] for slave in each.slaves) for each in every]
        total = math.fsum(forces)
        moved = displacements(job.with_name(f"{job.name}.frd"), len(mesh.points))
        turn = math.copysign(printed.turn, printed.turn * self.deck.torque)
        return {
            "transmission_error": ((turn - second_turn(self.deck)) * self._base_radius + self.approach) * 1000,
            "reference_turn": printed.turn,
            "normal_force": total,
            "pairs": [
                {
                    "pinion": each.pinion,
                    "wheel": each.wheel,
                    "load_share": force / total,
                    "contact_pressure": max(printed.pressures[slave] for slave in each.slaves),
                }
                for each, force in zip(every, forces, strict=True)
                if force
            ],
            "root_stress": {role.value: self._root_tension(role, moved) for role in Role},
            **({} if self.deck.sliding is None else {"wheel_torque": self._torque_on_wheel(printed.totals)}),
        }

    @property
    def _wheel_torque(self) -> float:
        """Torque on the wheel (N·m) by our own check."""
        ratio = self.position.torque_ratios.wheel * abs(self.decks.task.gear_pair.gear_ratio)
        return abs(self.deck.torque) * ratio

    def _torque_on_wheel(self, totals: Mapping[str, Sequence[float]]) -> float:
        """Return the torque (N·m) on the wheel by forces and moments on the slave surfaces that carry."""
        torque = 0.0
        for each in self.deck.flanks:
            for total in (totals[slave] for slave in each.slaves if slave in totals and math.isfinite(totals[slave][0])):
                own = total[5] - self.decks.task.gear_pair.centre_distance * total[1]
                torque += own if each.wheel_tip else -own
        return abs(torque) / 1000

    @property
    def _base_radius(self) -> float:
        return self.decks.pair.pinion.base_diameter / 2

    def _root_tension(self, role: Role, moved: Floats) -> float:
        decks, angle = self.decks, self.position.roll_angle
        turn = decks.turn(role, angle)
        teeth = (decks.tooth(role, contact.tooth) for contact in self.position.contacts)
        return max(decks.root_tension(self.deck.mesh, moved, role, tooth, turn) for tooth in teeth)


def second_turn(deck: LoadedPairDeck) -> float:
    """Return the turn (rad) of the pinion in the second step of a deck, positive in the sense of its torque."""
    return 0.0 if deck.sliding is None else math.copysign(deck.sliding.turn, deck.sliding.turn * deck.torque)


def held_nodes(mesh: ElementMesh, gear: str = "") -> Wholes:
    """Return the nodes (n,) that are held: all of the bore, rim or back, and the cuts of a body that is not a full ring.

    Names of sides begin with `gear`.
    """
    names = (f"{gear}{side}" for side in (BORE, RIM, BACK, "cut_behind", "cut_ahead"))
    return np.unique(np.concatenate([mesh.nodes(name) for name in names if name in mesh.sides]))


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
        """Write the loads as cards of the step."""

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
        """Return the root stress as CalculiX has left it in the files of a job, named without suffix. Raises SolverError."""
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
