"""Candidate: one set of a search, with what it is ranked by, and the train that it makes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gearcad.geometry import Gear
from gearcad.planetary.members import Central, Rim
from gearcad.planetary.mesh import SetType
from gearcad.planetary.search.task import MEMBERS, SearchTask
from gearcad.planetary.train import PlanetaryTrain

__all__ = ["Candidate"]

RIMS = ("planet", "planet_2")


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """One set that was found. Lengths in mm, `deviation` of its ratio in %.

    `teeth`, `profile_shifts` and `tip_alterations` by the names of its gears. `phases` are z mod N of each mesh, 0 where all
    planets are in phase; `common` the greatest common divisors of the teeth that mesh, 1 where each meets every other.
    `error_share` is what is left, while a central floats, of the load that an error of one planet would bring: 0 up to
    three planets, (N - 3)/N with more. `diameter` is the greatest over all teeth.
    """

    task: SearchTask
    kind: SetType
    planets: int
    teeth: dict[str, int]
    centre_distance: float
    profile_shifts: dict[str, float]
    tip_alterations: dict[str, float]
    ratio: float
    deviation: float
    diameter: float
    positions: int
    phases: tuple[int, int]
    common: tuple[int, int]
    efficiency: float

    @property
    def name(self) -> str:
        """Such as A-24-21-66-n3."""
        return f"{self.kind.value}-{'-'.join(str(abs(teeth)) for teeth in self.teeth.values())}-n{self.planets}"

    @property
    def error_share(self) -> float:
        """1 - 3/N, or 0."""
        return max(0.0, 1 - 3 / self.planets)

    @property
    def second_height(self) -> float:
        """Bottom of the second rim above that of the first (mm): a module of room between them."""
        return self.task.width + max(self.task.modules)

    @property
    def helix_angles(self) -> dict[str, float]:
        """Of the gears: both rims of a planet have one hand, opposed to suns and that of rings."""
        planet = -self.task.helix_angle if self.kind is not SetType.D else self.task.helix_angle
        return {name: (-planet if name.startswith("sun") else planet) + 0.0 for name in self.teeth}

    @property
    def modules(self) -> dict[str, float]:
        """Of the gears (mm)."""
        first, second = self.task.modules
        of_second = (MEMBERS[self.kind][1], RIMS[1]) if self.kind is not SetType.A else ()
        return {name: second if name in of_second else first for name in self.teeth}

    def gear(self, name: str) -> Gear:
        """One of its gears. Raises GeometryError."""
        return Gear(
            name=name,
            teeth=self.teeth[name],
            normal_module=self.modules[name],
            face_width=self.task.width,
            helix_angle=self.helix_angles[name],
            profile_shift=self.profile_shifts[name],
            tip_alteration=self.tip_alterations[name],
        )

    def train(self) -> PlanetaryTrain:
        """The train, checked. Raises GeometryError where it cannot be made."""
        roles, stepped = self.task.roles(self.kind), self.kind is not SetType.A
        meshed = (RIMS[0], RIMS[stepped])
        return PlanetaryTrain(
            name=self.name,
            planets=self.planets,
            centrals=tuple(
                Central(name=name, gear=self.gear(name), meshes=rim)
                for name, rim in zip(MEMBERS[self.kind][:2], meshed, strict=True)
            ),
            rims=tuple(
                Rim(name=name, gear=self.gear(name), axial_position=height)
                for name, height in ((RIMS[0], 0.0), (RIMS[1], self.second_height))[: 1 + stepped]
            ),
            centre_distance=self.centre_distance,
            tip_distance=self.task.least_distance,
            **roles._asdict(),
        )

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "name": self.name,
            "type": self.kind.value,
            "planets": self.planets,
            "teeth": self.teeth,
            "ratio": self.ratio,
            "deviation": self.deviation,
            "diameter": self.diameter,
            "centre_distance": self.centre_distance,
            "profile_shifts": self.profile_shifts,
            "tip_alterations": self.tip_alterations,
            "positions": self.positions,
            "phases": list(self.phases),
            "common": list(self.common),
            "efficiency": self.efficiency,
            "error_share": self.error_share,
        }
