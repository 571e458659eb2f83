"""Two gears in mesh: where they touch at a roll angle and what a torque presses them with, rigid or flexible."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Generic, Self, TypeVar

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.line_of_action import LineOfAction
from gearcad.errors import ParameterError
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.involute import involute_at_roll
from gearcad.per_gear import PerGear
from gearcad.rating.hertz import half_width, reduced_radius

__all__ = ["TOOTH_ORDER", "EngagedPair", "FlankCompliance", "FlexiblePair", "LoadedFlank", "roll_lengths"]

TOOTH_ORDER = PerGear(1, -1)
"""Seen from the wheel the teeth follow each other the other way round; a ring's too, as rings are seen mirrored."""


def roll_lengths(radii: Floats, base_radius: float) -> Floats:
    """Roll lengths (mm) of an involute at radii (n,) in mm: from the base tangent point, 0 inside the base circle."""
    result: Floats = np.sqrt(np.maximum((radii - base_radius) * (radii + base_radius), 0))
    return result


@dataclass(frozen=True)
class LoadedFlank:
    """The exact flank of tooth 0 that loads press on, that with y > 0; places on it are roll lengths (mm).

    Those of a ring are negative, and rise from root to tip as others do: so the formulas of all flanks are the same.
    """

    gear: Gear

    @property
    def base_radius(self) -> float:
        """r_b (mm), above 0 of a ring too."""
        return self.gear.profile.base_diameter / 2

    @property
    def upward(self) -> int:
        """Whether its tip lies outwards (1) or, of a ring, inwards (-1)."""
        return -1 if self.gear.internal else 1

    def roll_lengths(self, radii: Floats) -> Floats:
        """Roll lengths (mm) at radii (n,) in mm."""
        return self.upward * roll_lengths(radii, self.base_radius)

    def polar(self, lengths: Floats) -> tuple[Floats, Floats]:
        """Radii (mm) and angles (rad) of places in the transverse section."""
        roll = lengths / self.base_radius
        angle: Floats = math.radians(self.gear.profile.base_half_angle) - involute_at_roll(roll)
        return np.hypot(self.base_radius, lengths), angle

    def heading(self, lengths: Floats) -> Floats:
        """Angles (rad) of the tangents of the base circle that places lie on, to the middle of the tooth."""
        return math.radians(self.gear.profile.base_half_angle) - np.asarray(lengths) / self.base_radius


class FlankCompliance(ABC):
    """A gear body's responses to unit loads normal to its flank: what every model tells of a body."""

    flank: LoadedFlank
    torques: Floats
    """On the hub, by each unit load."""

    @property
    @abstractmethod
    def neighbours(self) -> int:
        """Teeth on each side of the loaded one whose responses are known."""

    @property
    @abstractmethod
    def hub_radius(self) -> float:
        """Where the body is held (mm)."""

    @property
    @abstractmethod
    def nodes(self) -> int:
        """Of the mesh of one tooth sector."""

    @property
    def unit_loads(self) -> int:
        """Places of the flank that were loaded."""
        return len(self.torques)

    @property
    @abstractmethod
    def mesh_document(self) -> dict[str, Any]:
        """Size and quality of the mesh of one tooth sector, as documents have it."""


@dataclass(frozen=True)
class EngagedPair:
    """A pair as it rolls: where it touches at a roll angle, and the force of a torque."""

    pair: GearPair

    @property
    def repeats(self) -> bool:
        """True if one base pitch is like the next: no tooth differs from the others."""
        return True

    @property
    def width(self) -> float:
        """Common face width (mm), on which all of the load is."""
        return self.pair.common_width.width

    @property
    def base_radius(self) -> float:
        """r_b of the pinion (mm)."""
        return self.pair.pinion.base_diameter / 2

    def force(self, torque: float) -> float:
        """Normal force in the transverse section (N per mm of common width) at a torque on the pinion (N·m)."""
        return abs(torque) * 1000 / self.base_radius / self.width

    def require_narrow_contact(self, torque: float, modulus: float) -> None:
        """Raise ParameterError where the contact at the pitch point would be wider than teeth are deep: no small deformation.

        `modulus` is E* (MPa); half width by Hertz.
        """
        at_pitch_point = self.pair.path_of_contact.C
        radii = (at_pitch_point, self.pair.base_tangent.length - at_pitch_point)
        half = float(half_width(self.force(torque), reduced_radius(radii), modulus))
        depth = min((gear.tip_diameter - gear.root_diameter) / 2 for gear in self.pair.gears)
        if half > depth:
            most = abs(torque) * (depth / half) ** 2  # the half width goes with the root of the load
            permitted = f"must be at most {most:.4g} N·m in size for these teeth and this modulus of elasticity"
            why = f"the contact would be {2 * half:.4g} mm wide on teeth {depth:.4g} mm deep"
            raise ParameterError("torque", torque, f"{permitted}: {why}", "N·m")

    def roll_length(self, roll_angle: float) -> float:
        """Where the middle pair touches in the middle of the common width (mm from T1) at a roll angle of the pinion (deg)."""
        return self.pair.path_of_contact.C + math.radians(roll_angle) * self.base_radius

    def roll_angle(self, length: Floats) -> Floats:
        """Roll angles (deg) of the pinion at which the middle pair touches at places (n,) in mm from T1."""
        result: Floats = np.degrees((length - self.pair.path_of_contact.C) / self.base_radius)
        return result

    def roll_angles(self, count: int) -> Floats:
        """Roll angles (deg) over one base pitch, as many before the pitch point as after it.

        Those that fewer positions have in common with more are the same to the last digit.
        """
        pitch = 360 / self.pair.pinion.teeth
        return (2 * np.arange(count) + 1 - count) / (2 * count) * pitch


Body = TypeVar("Body", bound=FlankCompliance, covariant=True)


@dataclass(frozen=True)
class FlexiblePair(EngagedPair, ABC, Generic[Body]):
    """A pair whose bodies are factorised and solved for loads on their flanks; any position and torque is quick."""

    line: LineOfAction
    bodies: PerGear[Body]

    @property
    def pinion(self) -> Body:
        """The pinion's body."""
        return self.bodies.pinion

    @property
    def wheel(self) -> Body:
        """The wheel's body."""
        return self.bodies.wheel

    @abstractmethod
    def with_flanks(self, pair: GearPair) -> Self:
        """Return the same bodies with other modifications of an otherwise equal pair, as it is mounted."""

    @property
    @abstractmethod
    def modulus(self) -> float:
        """Reduced modulus of the contact (MPa)."""

    @abstractmethod
    def single_stiffness(self, torque: float) -> float:
        """Greatest stiffness (N/(mm·µm)) of one pair of teeth alone, over its path of contact, at a torque (N·m)."""
