"""A set whose sun of 40 teeth any of 3 to 6 planets fit, at 22 deg; and mesh stiffnesses as trapezoids."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats
from gearcad.geometry import BasicRack, Gear
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim

SUN_FORCE = 60000.0
"""N: sum of what the planets press the sun with."""


def sun_set(planets: int, *, floating: tuple[str, ...] = (), **changes: Any) -> PlanetaryTrain:
    """Sun 40, planet 20, ring -80 without shifts: working pressure angles are 22 deg. `floating` members have no bearing."""

    def gear(teeth: int) -> Gear:
        return Gear(teeth=teeth, normal_module=2, face_width=20, rack=BasicRack(pressure_angle=22.0))

    def support(name: str) -> float | None:
        return 0.0 if name in floating else None

    carrier = changes.pop("carrier", Carrier())
    given: dict[str, Any] = {
        "planets": planets,
        "centrals": (
            Central(name="sun", gear=gear(40), meshes="planet", support_stiffness=support("sun")),
            Central(name="ring", gear=gear(-80), meshes="planet", support_stiffness=support("ring")),
        ),
        "rims": (Rim(name="planet", gear=gear(20)),),
        "carrier": replace(carrier, support_stiffness=support("carrier")),
        "input": "sun",
        "output": "carrier",
        "fixed": "ring",
    }
    return PlanetaryTrain(**given | changes)


def output_torque(train: PlanetaryTrain, sun_force: float = SUN_FORCE) -> float:
    """Torque (N·m) on the carrier where the planets press the sun with this force."""
    return (1 - train.basic_ratio) * sun_force * train.meshes[0].central_base_radius / 1e3


@dataclass(frozen=True)
class Trapezoid:
    """Stiffness (N/µm) between `least` and `most`, straight over `ramp` base pitches, two pairs from 0 for `duty` of them."""

    least: float
    most: float
    duty: float
    ramp: float = 0.06

    @property
    def mean(self) -> float:
        """Over a base pitch: each ramp counts half."""
        return self.least + (self.most - self.least) * self.duty

    @property
    def jumps(self) -> Floats:
        """None."""
        return np.zeros(0)

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """At places in base pitches."""
        place = np.mod(np.asarray(ahead, float), 1.0)
        rising, falling = np.clip(place / self.ramp, 0, 1), np.clip((place - self.duty) / self.ramp, 0, 1)
        found: Floats = self.least + (self.most - self.least) * np.where(place < self.duty, rising, 1 - falling)
        return found


@dataclass(frozen=True)
class Square:
    """Stiffness (N/µm) of two pairs from 0 for `duty` of a base pitch, of one for the rest."""

    least: float
    most: float
    duty: float

    @property
    def jumps(self) -> Floats:
        """Where the second pair comes and goes."""
        return np.array([0.0, self.duty])

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """At places in base pitches."""
        return np.where(np.mod(np.asarray(ahead, float), 1.0) < self.duty, self.most, self.least)
