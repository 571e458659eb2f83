"""Result of a planetary study, and its document (planetary.json)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from gearcad.core.records import JsonObject, Notice, Pictured, Verdict, strength_verdict, texts
from gearcad.dynamics.planetary.gyroscopic_modes import GyroscopicModes
from gearcad.dynamics.planetary.load_sharing import LoadSharing
from gearcad.dynamics.planetary.planar_model import TrainMasses
from gearcad.dynamics.planetary.planetary_modes import PlanetaryCampbell, PlanetaryModes
from gearcad.dynamics.planetary.planetary_statics import TorsionalStiffness
from gearcad.dynamics.planetary.planetary_strength import TrainRating
from gearcad.dynamics.planetary.quasi_static_run import Running
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.poses import MeshPhases, TrainPose, train_harmonics
from gearcad.planetary.power import MeshLoad, PowerFlow, TrainForces
from gearcad.planetary.train_data import Speeds

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.planetary_excitation import PlanetMeshStiffness
    from gearcad.dynamics.planetary.planetary_response import PlanetaryResponse

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
"""Parts of a study that may be missing, and their words."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanetaryStudy(Pictured):
    """A planetary train at its load: geometry in mesh, speeds, torques, forces, sharing, stiffness, natural modes, rating.

    A part is None where an input that it needs is not given or the part cannot be computed; `why_not` {part: reason} says
    which. `gyroscopic` are the natural frequencies with the carrier turning; they are there where the Campbell diagram is. The
    `response` takes long and is there where it was asked for. `stiffness` is of both meshes by their names,
    `stage_cycles` of the stages that carry something. `asks_strength`: whether materials or required safeties ask for a verdict
    on strength.
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
    stiffness: Mapping[str, PlanetMeshStiffness] | None
    stage_cycles: Mapping[str, MeshCycle]
    sharing: LoadSharing | None
    torsion: TorsionalStiffness | None
    running: Running | None
    masses: TrainMasses
    modes: PlanetaryModes | None
    campbell: PlanetaryCampbell | None
    gyroscopic: GyroscopicModes | None
    response: PlanetaryResponse | None
    rating: TrainRating | None
    asks_strength: bool = False
    why_not: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<PlanetaryStudy of {self.name!r}>"

    @property
    def name(self) -> str:
        """Name of the train."""
        return self.train.name

    @property
    def turning(self) -> Speeds | None:
        """Speeds of a train that turns; None for a train that has only a torque, or is at rest."""
        return self.speeds if self.speeds is not None and any(self.speeds.members.values()) else None

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before the study is used: of the meshes, of its parts, and of parts that are missing."""
        found = [*self.train.notices, *(self.load.notices if self.load is not None else ())]
        for mesh in (self.stiffness or {}).values():
            found += mesh.notices
        vibrating = self.modes, self.campbell, self.gyroscopic, self.response
        for part in (self.sharing, self.torsion, self.running, *vibrating, self.rating):
            found += part.notices if part is not None else ()
        if self.flow is not None and self.flow.self_locking:
            found.append(Notice("self-locking", f"{self.train.output} cannot drive {self.train.input}: the train locks itself"))
        return tuple(dict.fromkeys((*found, *self._missing())))

    def _missing(self) -> Iterator[Notice]:
        """Yield a notice for the parts that are missing, together where the reason is the same."""
        for why in dict.fromkeys(self.why_not.values()):
            parts = [PARTS[part] for part, reason in self.why_not.items() if reason == why]
            yield Notice("not-computed", why, where=f"no {', '.join(parts)}")


def study_document(study: PlanetaryStudy) -> JsonObject:
    """Return the document of a study, without what data.json has of pairs: rpm, N·m, N, µm, Hz.

    A part that is missing is None; `why_not` says why.
    """
    train, flow = study.train, study.flow
    harmonics = train_harmonics(train, dict(study.phases))
    return {
        "set_type": train.set_type.value,
        "ratio": train.ratio,
        "basic_ratio": train.basic_ratio,
        "efficiency": None if flow is None else flow.efficiency,
        "efficiency_back": None if flow is None else flow.efficiency_back,
        "members": _members(study),
        "planet_speed": None if study.turning is None else study.turning.planet,
        "planet_speed_relative": None if study.turning is None else study.turning.planet_relative,
        "power": _document(flow),
        "planet_angles": list(train.angles),
        "pose": _pose(study.pose),
        "phases": {name: phases.to_dict() for name, phases in study.phases.items()},
        "harmonics": {name: [each._asdict() for each in sums] for name, sums in harmonics.items()},
        "forces": _document(study.forces),
        "loads": _documents(study.loads),
        "mesh_stiffness": {
            name: {"mean": mesh.mean, "tangent_mean": mesh.tangent_mean} for name, mesh in _items(study.stiffness)
        },
        "stage_stiffness": {name: cycle.mean for name, cycle in study.stage_cycles.items()},
        "load_sharing": _document(study.sharing),
        "torsional_stiffness": _document(study.torsion),
        "running": _document(study.running),
        "masses": study.masses.to_dict(),
        "frequencies": None if study.modes is None else [family.to_dict() for family in study.modes.families],
        "modes": _document(study.modes),
        "campbell": _document(study.campbell),
        "modes_over_speed": _document(study.gyroscopic),
        "response": _document(study.response),
        "rating": _document(study.rating),
        **_strength(study),
        "gears": {name: gear.to_dict() for name, gear in train.gears.items()},
        "why_not": _why_not(study),
        "warnings": list(study.warnings),
        "notices": [notice.to_dict() for notice in study.notices],
    }


def _strength(study: PlanetaryStudy) -> dict[str, Any]:
    """Return safeties of the gears and the verdict; for a train without a rating, that it was not judged."""
    if study.rating is not None:
        return study.rating.strength.summary()
    why = study.why_not["rating"]
    unknown = dict.fromkeys(("safety", "required", "life"))
    return {
        **unknown,
        "strength": strength_verdict(study.asks_strength, [Verdict.NOT_JUDGED]).value,
        "passed": None,
        "not_judged": {"train": why},
    }


def _why_not(study: PlanetaryStudy) -> dict[str, str]:
    """Return the reasons why parts are None.

    For a train at rest whose torques are known there is a reason for speeds, too.
    """
    if study.speeds is None or study.turning is not None:
        return dict(study.why_not)
    return {"speeds": f"nothing turns: the speed of {study.train.input} stands in [load], others in [planetary.speeds]"} | dict(
        study.why_not
    )


def _document(part: Any) -> dict[str, Any] | None:
    """Return the document of a part, None if the part is missing."""
    found: dict[str, Any] | None = None if part is None else part.to_dict()
    return found


def _documents(parts: Mapping[str, Any] | None) -> dict[str, Any] | None:
    return None if parts is None else {name: part.to_dict() for name, part in parts.items()}


def _items(parts: Mapping[str, Any] | None) -> Any:
    return (parts or {}).items()


def _members(study: PlanetaryStudy) -> dict[str, dict[str, Any]]:
    """Return speed (rpm), torque from outside (N·m) and role in the train of every member and shaft."""
    speeds = {} if study.speeds is None else study.speeds.members
    torques = {} if study.flow is None else study.flow.torques
    known = {} if study.turning is None else study.turning.members
    names = dict.fromkeys((*study.train.members, *speeds, *torques))
    return {name: {"speed": known.get(name), "torque": torques.get(name), "role": _role(study.train, name)} for name in names}


def _role(train: PlanetaryTrain, name: str) -> str:
    roles = {train.input: "input", train.output: "output", train.fixed: "fixed"}
    return roles.get(name, "")


def _pose(pose: TrainPose) -> dict[str, Any]:
    return {
        "carrier_angle": pose.carrier_angle,
        "rotations": dict(pose.rotations),
        "planets": [
            {"angle": each.angle, "x": each.x, "y": each.y, "rotations": dict(each.rotations)} for each in pose.planets
        ],
        "heights": dict(pose.heights),
        "stages": {stage.name: {role.value: place._asdict() for role, place in stage.gears.items()} for stage in pose.stages},
    }
