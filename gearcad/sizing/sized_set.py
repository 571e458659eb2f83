"""SizedSet: planetary sets that a search for sizes has made, with what they bear."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from gearcad.dynamics.planetary.strength import TrainStrength
from gearcad.material import Material
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.search import Candidate
from gearcad.rating.strength import Part
from gearcad.sizing.set_task import SetSizeTask
from gearcad.sizing.sized import unjudged_scuffing
from gearcad.verdict import Verdict

__all__ = ["SizedSet", "SizedSets"]


@dataclass(frozen=True, kw_only=True)
class SizedSet:
    """A set with its module and face width, made: the `train`, its `load`, and what it bears."""

    candidate: Candidate
    train: PlanetaryTrain
    load: TrainLoad
    materials: dict[str, Material]
    strength: TrainStrength
    mass: float

    @property
    def name(self) -> str:
        """Such as A-24-21-66-n3-m2-b30."""
        return self.train.name

    @cached_property
    def margins(self) -> dict[Part, float]:
        """The least safety of flanks and of roots over what is required."""
        options = self.strength.options
        required = {Part.FLANK: options.required_safety_flank, Part.ROOT: options.required_safety_root}
        return {part: least / required[part] for part, least in self.least.items()}

    @cached_property
    def least(self) -> dict[Part, float]:
        """The least safety of all flanks, and of all roots."""
        found = {}
        for part in Part:
            known = [gear.least(part) for gear in self.strength.members.values()]
            found[part] = min((each.safety for each in known if each is not None), default=0.0)
        return found

    @property
    def bears(self) -> float:
        """By how much more torque it could be loaded, about: flank stress grows with its root."""
        return min(self.margins[Part.FLANK] ** 2, self.margins[Part.ROOT])

    @property
    def holds(self) -> bool:
        """Whether all was judged and has the safety that is required."""
        return self.strength.strength is Verdict.PASSED

    def to_dict(self) -> dict[str, Any]:
        """For JSON: mm, kg."""
        return {
            **self.candidate.to_dict(),
            "name": self.name,
            "module": self.candidate.task.module,
            "face_width": self.candidate.task.width,
            "mass": self.mass,
            "safety": {part.value: value for part, value in self.least.items()},
            "members": {name: gear.to_dict() for name, gear in self.strength.members.items()},
            "K_gamma": self.load.mesh_load_factor,
            "notices": [notice.to_dict() for notice in self.strength.notices],
        }


@dataclass(frozen=True, kw_only=True)
class SizedSets:
    """The lightest sets that hold, lightest first; `considered` are tooth numbers that were sized roughly, `refused` those that
    none of the modules lets hold, or that cannot be made."""

    task: SetSizeTask
    found: tuple[SizedSet, ...]
    considered: int
    refined: int
    refused: dict[str, str]

    @property
    def assumed(self) -> tuple[str, ...]:
        """What was not given and goes into the rating of what was found, in words."""
        return tuple(dict.fromkeys(text for each in self.found for text in each.strength.assumed))

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "kind": "planetary sizes",
            "ratio": self.task.sets.ratio,
            "torque": self.task.given_torque[1],
            "torque_of": self.task.given_torque[0].removesuffix("_torque"),
            "speed": self.task.speed,
            "found": [each.to_dict() for each in self.found],
            "assumed": list(self.assumed),
            "not_judged": {} if (why := unjudged_scuffing(self.task.rating)) is None else {"scuffing": why},
            "considered": self.considered,
            "refined": self.refined,
            "refused": dict(self.refused),
        }
