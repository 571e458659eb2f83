"""What planetary.json holds of a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcad.dynamics.planetary.result import PlanetaryStudy
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.harmonics import train_harmonics
from gearcad.planetary.poses import TrainPose
from gearcad.verdict import Verdict, strength_verdict

__all__ = ["study_document"]


def study_document(study: PlanetaryStudy) -> dict[str, Any]:
    """Everything but what data.json has of pairs: rpm, N·m, N, µm, Hz; None for what could not be had, `why_not` says why."""
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
        "response": _document(study.response),
        "rating": _document(study.rating),
        **_strength(study),
        "gears": {name: gear.to_dict() for name, gear in train.gears.items()},
        "why_not": _why_not(study),
        "warnings": list(study.warnings),
        "notices": [notice.to_dict() for notice in study.notices],
    }


def _strength(study: PlanetaryStudy) -> dict[str, Any]:
    """Safeties of the gears and the verdict; of a train that has no rating that it was not judged."""
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
    """Why a part is None; of speeds that of a train at rest, too, whose torques are known."""
    if study.speeds is None or study.turning is not None:
        return dict(study.why_not)
    return {"speeds": f"nothing turns: the speed of {study.train.input} stands in [load], others in [planetary.speeds]"} | dict(
        study.why_not
    )


def _document(part: Any) -> dict[str, Any] | None:
    """That of a part, if it is there."""
    found: dict[str, Any] | None = None if part is None else part.to_dict()
    return found


def _documents(parts: Mapping[str, Any] | None) -> dict[str, Any] | None:
    return None if parts is None else {name: part.to_dict() for name, part in parts.items()}


def _items(parts: Mapping[str, Any] | None) -> Any:
    return (parts or {}).items()


def _members(study: PlanetaryStudy) -> dict[str, dict[str, Any]]:
    """Speed (rpm) and torque from outside (N·m) of every member and shaft, and what it is to the train."""
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
