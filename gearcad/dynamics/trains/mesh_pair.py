"""The pair of gears behind a mesh of a train: what one gives of it, and what it does under what the train gives it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from gearcad.contact.shared.bodies import BodyModel
from gearcad.geometry import GearPair
from gearcad.geometry.halves import refuse_halves
from gearcad.load import Load
from gearcad.material import Material, Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.per_gear import Role
from gearcad.rating.options import RatingOptions
from gearcad.reprs import concise

__all__ = ["MeshCourse", "MeshPair", "line_backlash"]


@dataclass(frozen=True, kw_only=True)
class MeshPair:
    """A pair whose teeth are a mesh of a train, of a `material`, in a `mounting`, its bodies held as `body` says.

    `rating` has the accuracy grade of its teeth. `load` is its own, if it has one: the train gives it another torque and speed.
    Raises GeometryError for double helical gears.
    """

    pair: GearPair
    material: Materials = field(default_factory=Material)
    mounting: Mounting = field(default_factory=Mounting)
    body: BodyModel = field(default_factory=BodyModel)
    rating: RatingOptions = field(default_factory=RatingOptions)
    load: Load | None = None

    __repr__ = concise

    def __post_init__(self) -> None:
        refuse_halves(self.pair.pinion, "dynamics")

    @property
    def mounted(self) -> GearPair:
        """The pair at the centre distance of its mounting. Raises GeometryError."""
        return self.mounting.mounted(self.pair)

    @property
    def backlash(self) -> float:
        """Between the flanks along the line of action, as mounted (µm)."""
        return line_backlash(self.mounted)


def line_backlash(pair: GearPair) -> float:
    """Backlash of a pair along the line of action, at its centre distance (µm)."""
    across = math.cos(math.radians(pair.working_transverse_pressure_angle))
    return max(1000 * pair.circumferential_backlash * across, 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshCourse:
    """What the pair of a mesh does under the train's static load.

    `torque` (N·m) is that on its pinion, counter-clockwise positive, which with `driver` says which flanks carry: if the wheel
    drives, it is against the pinion's turn. `cycle` is that under this torque by the method whose words are `title`, found in
    so many `rounds` of stiffness and static force. `offset` (µm) is taken from its transmission error: where the force depends
    on the stiffness, at rest the train and the cycle must agree how far the flanks have approached.
    """

    cycle: MeshCycle
    title: str
    torque: float
    driver: Role
    rounds: int = 1
    offset: float = 0.0

    @property
    def in_time(self) -> MeshCycle:
        """The cycle in the order in which contact moves: from root to tip of the gear that drives."""
        return self.cycle if self.driver is Role.PINION else self.cycle.backwards
