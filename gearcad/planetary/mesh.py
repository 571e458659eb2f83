"""SetMesh: a central and the rim it meshes with, as a pair; and the four types of sets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from gearcad.errors import InputError
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.geometry.pair_data import PairData
from gearcad.per_gear import Role
from gearcad.planetary.members import Central, Rim

__all__ = ["SetMesh", "SetType", "base_radius", "mates_of"]


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
        """The mesh at a centre distance (mm, a magnitude; NaN: the one without backlash).

        Raises InputError, whose parameter begins with the mesh's name.
        """
        mates, signed = mates_of(central, rim), -centre_distance if central.gear.internal else centre_distance
        distance = NOT_GIVEN if math.isnan(signed) else signed
        try:
            pair = GearPair(pinion=mates.pinion, wheel=mates.wheel, name=mates.name, centre_distance=distance)
        except InputError as error:
            raise error.within(mates.name) from None
        return cls(central=central, rim=rim, pair=pair)


def mates_of(central: Central, rim: Rim) -> PairData:
    """A central and the rim it meshes with, not asked whether they fit: the smaller external gear is the pinion."""
    first = not central.gear.internal and central.gear.teeth <= rim.gear.teeth
    pinion, wheel = (central.gear, rim.gear) if first else (rim.gear, central.gear)
    return PairData(pinion=pinion, wheel=wheel, name=central.mesh_name)


def base_radius(gear: Gear) -> float:
    """r_b of a gear (mm), a magnitude."""
    return abs(gear.base_diameter) / 2
