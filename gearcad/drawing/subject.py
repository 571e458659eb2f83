"""DrawnGear, DrawnPair, DrawnTrain: what the sheet of one gear, and those of assemblies, are made from. Lengths in mm."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.body import HubSide
from gearcad.material import Material
from gearcad.planetary import PlanetaryTrain
from gearcad.rating.tolerances import Accuracy

__all__ = ["DrawnGear", "DrawnPair", "DrawnTrain", "Mate"]


@dataclass(frozen=True, kw_only=True)
class Mate:
    """A gear that engages with another: its name, its number ("" if it has none), and the pair that they make."""

    name: str
    number: str = ""
    gear: Gear | Rack
    pair: GearPair | RackPair


@dataclass(frozen=True, kw_only=True)
class DrawnGear:
    """A gear by its role among others ("pinion", "sun", "gear"), what it is made of, and how accurate its flanks are.

    `grade` is its accuracy grade, None where nobody gave one; it is then assumed, and the sheet says so.
    """

    role: str
    gear: Gear | Rack
    material: Material | None = None
    accuracy: Accuracy = Accuracy.ISO_1995
    grade: int | None = None
    mates: tuple[Mate, ...] = ()

    @property
    def direction(self) -> int:
        """1 where z goes to the right in the section on its sheet, -1 to the left: the end of an external gear that has a hub
        is at the left, and that at z = face width unless a hub is at z = 0 alone."""
        part = self.gear
        if isinstance(part, Rack) or part.internal or (part.body.hub_length and part.body.hub_side is HubSide.BACK):
            return 1
        return -1


@dataclass(frozen=True, kw_only=True)
class DrawnPair:
    """A pair by its name, and its two parts: the pinion, then what it meshes with (wheel, ring or rack)."""

    name: str
    pair: GearPair | RackPair
    parts: tuple[DrawnGear, DrawnGear]


@dataclass(frozen=True, kw_only=True)
class DrawnTrain:
    """A planetary train by its name, and those of its gears of which more is known than the train says.

    The `role` of each part is the name of its member, rim, or gear of a stage.
    """

    name: str
    train: PlanetaryTrain
    parts: tuple[DrawnGear, ...] = ()
