"""SetMesh: a central and the rim it meshes with, as a pair; and the four types of sets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from gearcad.geometry import Gear, GearPair
from gearcad.per_gear import Role
from gearcad.planetary.members import Central, Rim

__all__ = ["SetMesh", "SetType"]


class SetType(Enum):
    """Sets with one carrier, told apart by which centrals are rings and whether the planets are stepped."""

    A = "A"
    """Sun, planet, ring."""

    B = "B"
    """Sun, stepped planet, ring."""

    C = "C"
    """Sun, stepped planet, sun."""

    D = "D"
    """Ring, stepped planet, ring."""


@dataclass(frozen=True, kw_only=True)
class SetMesh:
    """The mesh of a central with the rim of a planet: `pair` holds both, the smaller external gear as its pinion."""

    central: Central
    rim: Rim
    pair: GearPair

    @property
    def name(self) -> str:
        """Such as "sun-planet"."""
        return self.central.mesh_name

    @property
    def external(self) -> bool:
        """Whether the central is a sun."""
        return not self.central.gear.internal

    @property
    def central_role(self) -> Role:
        """Which gear of the pair the central is."""
        return Role.PINION if self.pair.pinion is self.central.gear else Role.WHEEL

    @property
    def rim_role(self) -> Role:
        """Which gear of the pair the planet's is."""
        return self.central_role.mate

    @property
    def working_pressure_angle(self) -> float:
        """alpha_wt in radians."""
        return math.radians(self.pair.working_transverse_pressure_angle)

    @property
    def central_base_radius(self) -> float:
        """r_b of the central (mm), a magnitude."""
        return base_radius(self.central.gear)

    @property
    def rim_base_radius(self) -> float:
        """r_b of the rim (mm)."""
        return base_radius(self.rim.gear)

    @classmethod
    def of(cls, central: Central, rim: Rim, centre_distance: float) -> SetMesh:
        """The mesh at a centre distance (mm, a magnitude; NaN: the one without backlash). Raises GeometryError."""
        ring = central.gear.internal
        first = not ring and central.gear.teeth <= rim.gear.teeth
        pinion, wheel = (central.gear, rim.gear) if first else (rim.gear, central.gear)
        given = {} if math.isnan(centre_distance) else {"centre_distance": -centre_distance if ring else centre_distance}
        return cls(central=central, rim=rim, pair=GearPair(pinion=pinion, wheel=wheel, name=central.mesh_name, **given))


def base_radius(gear: Gear) -> float:
    """r_b of a gear (mm), a magnitude."""
    return abs(gear.base_diameter) / 2
