"""Loaded pairs as decks: what plane and solid gears have in common."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle, LoadedPosition, PairContact
from gearcad.decks.calculix import Flanks, LoadedPairDeck
from gearcad.decks.results import displacements, printed_contact
from gearcad.decks.treatable import require_treatable
from gearcad.decks.words import pair_words
from gearcad.geometry import GearPair
from gearcad.meshing.bodies import ElementMesh
from gearcad.meshing.bodies.contact_zone import ContactZone
from gearcad.meshing.bodies.names import BORE, RIM
from gearcad.meshing.bodies.posed import posed, poses
from gearcad.per_gear import PerGear, Role

__all__ = ["PairDeck", "PairDecks", "held_nodes"]


_STIFFNESS = 10.0
"""Pressure by overlap, over modulus by edge: overlaps are then far below an edge, and iterations still end."""


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
    def pair(self) -> GearPair:
        """The pair as mounted."""
        return self.task.pair

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
        """Pairs of teeth, as our solution counts them, that may touch."""

    @abstractmethod
    def zones(self, roll_angle: float, role: Role) -> Mapping[int, ContactZone]:
        """Where the loaded flanks of a gear are fine, tooth by tooth. Raises ParameterError for narrow contacts."""

    @abstractmethod
    def mesh(self, role: Role, zones: Mapping[int, ContactZone]) -> ElementMesh:
        """A gear, or what the check has of it, in coordinates of its own."""

    @abstractmethod
    def root_tension(self, mesh: ElementMesh, moved: Floats, role: Role, tooth: int, turn: float) -> float:
        """Greatest tension (MPa) in the loaded fillet of a tooth of a gear that is turned by `turn` (rad), by displacements."""

    @property
    def width(self) -> float | None:
        """Thickness (mm) of sections: the common face width."""
        return None if self.solid else self.pair.common_width.width

    def tooth(self, role: Role, tooth: int) -> int:
        """The tooth of a gear that has part in our solution's pair of teeth `tooth`, counted counter-clockwise from 0."""
        order = 1 if role is Role.PINION or self.pair.internal else -1
        return order * (1 if self.left else -1) * tooth % self.pair.gears.pick(role).tooth_count

    def side(self, role: Role, tooth: int, part: str) -> str:
        """Name of the loaded "flank" or "fillet" of a tooth in the joined mesh."""
        return f"{role.value}_{self.flank_side}_{part}_{tooth}"

    def flanks(self, tooth: int) -> Flanks:
        """Names of the flanks of our solution's pair of teeth `tooth` in the joined mesh."""
        return Flanks(*(self.side(role, self.tooth(role, tooth), "flank") for role in Role))

    def at(self, roll_angle: float) -> PairDeck:
        """The pair at a roll angle (deg). Raises ParameterError, GeometryError and SolverError."""
        position = self.cycle.solve(roll_angle)
        approach = position.rigid_approach + self.begun * (position.approach - position.rigid_approach)
        zones = PerGear(*(self.zones(roll_angle, role) for role in Role))  # what they refuse is neither gear's own
        meshes = PerGear.each(lambda role: self.mesh(role, zones.pick(role)))
        mesh = posed(self.pair, meshes, roll_angle, approach, left=self.left)
        edge = min(zone.edge for each in zones for zone in each.values())
        deck = LoadedPairDeck(
            mesh=mesh,
            held=PerGear.each(lambda role: held_nodes(mesh, f"{role.value}_")),
            material=self.task.materials.pinion,
            torque=self.task.torque,
            flanks=[self.flanks(tooth) for tooth in self.teeth_near(roll_angle)],
            contact_stiffness=_STIFFNESS * self.task.materials.pinion.youngs_modulus / edge,
            width=self.width,
        )
        made = PairDeck(self, deck, position, approach)
        words = pair_words(made.expected, distance=self.pair.centre_distance, base_radius=self.pair.pinion.base_diameter / 2)
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
        """Figures of our own check to compare with: transmission error in µm, turn in rad, stresses in MPa, force in N.

        There is no contact pressure near the edges of flanks.
        """
        of, pair = self.position, self.decks.pair
        turn = (of.approach - self.approach) / self._base_radius
        return {
            "roll_angle": of.roll_angle,
            "torque": self.deck.torque,
            "body": self.decks.task.body.describe(pair),
            "approach_in_mesh": self.approach * 1000,
            "transmission_error": of.transmission_error,
            "reference_turn": math.copysign(turn, self.deck.torque),
            "normal_force": of.force * pair.common_width.width / math.cos(math.radians(pair.pinion.base_helix_angle)),
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
        }

    def write(self, path: Path) -> None:
        """Write the deck; `ccx` wants a name that ends with .inp."""
        self.deck.write(path)

    def found(self, job: Path) -> dict[str, Any]:
        """The same figures as CalculiX has left them in the files of a job, named without suffix. Raises SolverError."""
        mesh, flanks = self.deck.mesh, {each.pinion: each for each in self.deck.flanks}
        printed = printed_contact(job.with_name(f"{job.name}.dat"), mesh, flanks)
        moved = displacements(job.with_name(f"{job.name}.frd"), len(mesh.points))
        turn = math.copysign(printed.turn, printed.turn * self.deck.torque)
        return {
            "transmission_error": (turn * self._base_radius + self.approach) * 1000,
            "reference_turn": printed.turn,
            "normal_force": math.fsum(printed.forces.values()),
            "pairs": [
                {
                    "pinion": name,
                    "wheel": flanks[name].wheel,
                    "load_share": printed.shares[name],
                    "contact_pressure": printed.pressures[name],
                }
                for name, force in printed.forces.items()
                if force
            ],
            "root_stress": {role.value: self._root_tension(role, moved) for role in Role},
        }

    @property
    def _base_radius(self) -> float:
        return self.decks.pair.pinion.base_diameter / 2

    def _root_tension(self, role: Role, moved: Floats) -> float:
        decks, angle = self.decks, self.position.roll_angle
        turn = math.radians(poses(decks.pair, angle, solid=decks.solid, left=decks.left).pick(role).rotation)
        teeth = (decks.tooth(role, contact.tooth) for contact in self.position.contacts)
        return max(decks.root_tension(self.deck.mesh, moved, role, tooth, turn) for tooth in teeth)


def held_nodes(mesh: ElementMesh, gear: str = "") -> Wholes:
    """Return the nodes (n,) that are held: all of the bore or rim, and the cuts of a body that is not a full ring.

    Names of sides begin with `gear`.
    """
    names = (f"{gear}{side}" for side in (BORE, RIM, "cut_behind", "cut_ahead"))
    return np.unique(np.concatenate([mesh.nodes(name) for name in names if name in mesh.sides]))
