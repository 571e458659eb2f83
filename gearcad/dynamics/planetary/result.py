"""PlanetaryStudy: all that was found out of a planetary train, and why a part was not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from gearcad.dynamics.planetary.campbell import PlanetaryCampbell
from gearcad.dynamics.planetary.masses import TrainMasses
from gearcad.dynamics.planetary.mesh_rating import TrainRating
from gearcad.dynamics.planetary.mesh_stiffness import MeshStiffness
from gearcad.dynamics.planetary.modes import PlanetaryModes
from gearcad.dynamics.planetary.response import PlanetaryResponse
from gearcad.dynamics.planetary.running import Running
from gearcad.dynamics.planetary.sharing import LoadSharing
from gearcad.dynamics.planetary.torsion import TorsionalStiffness
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.notice import Notice, texts
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.forces import TrainForces
from gearcad.planetary.mesh_loads import MeshLoad
from gearcad.planetary.phases import MeshPhases
from gearcad.planetary.poses import TrainPose
from gearcad.planetary.power import PowerFlow
from gearcad.planetary.speeds import Speeds
from gearcad.reprs import Pictured

__all__ = ["PARTS", "PlanetaryStudy"]

PARTS = {
    "speeds": "speeds",
    "power": "torques and efficiency",
    "forces": "forces",
    "loads": "loads of the meshes",
    "stiffness": "stiffness of the meshes",
    "sharing": "load sharing",
    "torsion": "torsional stiffness",
    "running": "running",
    "modes": "natural frequencies",
    "campbell": "Campbell diagram",
    "response": "response over speed",
    "rating": "rating",
}
"""The parts of a study that may be missing, and what they are called."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanetaryStudy(Pictured):
    """A planetary train at its load: geometry in mesh, speeds, torques, forces, sharing, stiffness, natural modes, rating.

    A part is None where something that it needs is not given or cannot be had; `why_not` {part: reason} says which.
    The `response` takes long and is there where it was asked for. `stiffness` is of both meshes by their names, `stage_cycles`
    of the stages that carry something. `asks_strength`: whether materials or required safeties ask for a verdict on strength.
    """

    train: PlanetaryTrain
    load: TrainLoad | None
    given_speeds: Mapping[str, float]
    pose: TrainPose
    phases: Mapping[str, MeshPhases]
    speeds: Speeds | None
    flow: PowerFlow | None
    forces: TrainForces | None
    loads: Mapping[str, MeshLoad] | None
    stage_loads: Mapping[str, Load]
    stiffness: Mapping[str, MeshStiffness] | None
    stage_cycles: Mapping[str, MeshCycle]
    sharing: LoadSharing | None
    torsion: TorsionalStiffness | None
    running: Running | None
    masses: TrainMasses
    modes: PlanetaryModes | None
    campbell: PlanetaryCampbell | None
    response: PlanetaryResponse | None
    rating: TrainRating | None
    asks_strength: bool = False
    why_not: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<PlanetaryStudy of {self.name!r}>"

    @property
    def name(self) -> str:
        """That of the train."""
        return self.train.name

    @property
    def turning(self) -> Speeds | None:
        """The speeds, where there is one: None of a train that has only a torque, or is at rest."""
        return self.speeds if self.speeds is not None and any(self.speeds.members.values()) else None

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it: of the meshes, of its parts, and what could not be had."""
        found = [*self.train.notices, *(self.load.notices if self.load is not None else ())]
        for mesh in (self.stiffness or {}).values():
            found += mesh.notices
        for part in (self.sharing, self.torsion, self.running, self.modes, self.campbell, self.response, self.rating):
            found += part.notices if part is not None else ()
        if self.flow is not None and self.flow.self_locking:
            found.append(Notice("self-locking", f"{self.train.output} cannot drive {self.train.input}: the train locks itself"))
        return tuple(dict.fromkeys((*found, *self._missing())))

    def _missing(self) -> Iterator[Notice]:
        """The parts that could not be had, together where the reason is the same."""
        for why in dict.fromkeys(self.why_not.values()):
            parts = [PARTS[part] for part, reason in self.why_not.items() if reason == why]
            yield Notice("not-computed", why, where=f"no {', '.join(parts)}")
