"""How a planetary train rolls: how fast each mesh and all that turns, in base pitches of the first mesh; where to look."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.statics import TrainStatics
from gearcad.errors import ParameterError
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import PairStage, PlanetaryTrain
from gearcad.planetary.phases import Drive, mesh_phases
from gearcad.planetary.speeds import speeds

__all__ = ["LONGEST", "CycleCourse", "Rolling", "StiffnessCourse", "rolling_of"]

LONGEST = 2000.0
"""Base pitches of the first mesh after which a run ends."""

_BESIDE = 1e-9
"""Base pitches by which both sides of a jump are looked at."""

_STILL = 1e-9
"""Turns in a base pitch below which something stands still."""


class StiffnessCourse(Protocol):
    """Stiffness of a mesh (N/µm) over how far contact is past the pitch point, in base pitches in the direction it moves."""

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """At any places."""

    @property
    def jumps(self) -> Floats:
        """Places where it jumps, from 0 to 1."""


@dataclass(frozen=True, kw_only=True)
class CycleCourse:
    """That of a MeshCycle whose pinion drives; with `reverse` its wheel does."""

    cycle: MeshCycle
    reverse: bool = False

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """At any places."""
        roll = np.asarray(ahead, float) * self.cycle.pitch_angle
        return self.cycle.stiffness_at(-roll if self.reverse else roll)

    @property
    def jumps(self) -> Floats:
        """Places where it jumps."""
        twice = np.flatnonzero(np.diff(self.cycle.roll_angle) == 0)
        places = self.cycle.roll_angle[twice] / self.cycle.pitch_angle
        return np.mod(-places if self.reverse else places, 1.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Rolling:
    """Everything as the first mesh rolls, from the pose in which the carrier stands at 0.

    `ahead` (2, N) base pitches of each planet there, and what both meshes roll, `paces` (2,), in one base pitch of the first;
    `stage_paces` likewise. `carrier` and `output` turn so far (turns), `turning` (t,) is what turns against the carrier.
    `period` base pitches after which both meshes stand as before; `rate` base pitches in a minute, 0 at rest.
    """

    ahead: Floats
    paces: Floats
    stage_paces: Mapping[str, float]
    carrier: float
    output: float
    turning: Floats
    period: int
    rate: float

    @property
    def span(self) -> float:
        """Base pitches in which all that turns has turned once, and both meshes have gone through all they can be."""
        moving = np.abs(self.turning[np.abs(self.turning) > _STILL])
        return float(min(max([self.period, *(1 / moving)]), LONGEST))

    def places(self, span: float, steps: int, courses: Mapping[str, StiffnessCourse], names: tuple[str, str]) -> Floats:
        """Base pitches (s,) of the first mesh from 0 to `span`: equal steps, both ends too, and both sides of every jump."""
        stages = [pace for name, pace in self.stage_paces.items() if name in courses]
        count = math.ceil(steps * span * max([*self.paces, *stages]))
        return np.unique(np.concatenate([np.linspace(0, span, count + 1), *self._jumps(span, courses, names)]))

    def _jumps(self, span: float, courses: Mapping[str, StiffnessCourse], names: tuple[str, str]) -> Iterator[Floats]:
        starts = [(names[i], float(pace), lead) for i, pace in enumerate(self.paces) for lead in self.ahead[i]]
        starts += [(name, pace, 0.0) for name, pace in self.stage_paces.items() if name in courses]
        for name, pace, lead in starts:
            for jump in courses[name].jumps:
                first = (jump - lead) % 1.0
                at = (first + np.arange(math.floor(span * pace - first) + 1)) / pace
                yield from (at[at > _BESIDE] - _BESIDE, at[at < span - _BESIDE] + _BESIDE)


def rolling_of(statics: TrainStatics, given_speeds: Mapping[str, float] | None = None) -> Rolling:
    """How a train rolls at its load; at rest, as a positive speed of the input would have it.

    Raises ParameterError where the set turns as one, and speeds of a differential that are missing.
    """
    train, load = statics.train, statics.flow.load
    found = speeds(train, {train.input: load.speed or 1.0, **(given_speeds or {})})
    members, first = found.members, train.centrals[0]
    against = members[first.name] - members[train.carrier.name]
    pitches = abs(against) * first.gear.tooth_count
    if pitches <= _STILL * max(map(abs, members.values())):
        raise ParameterError("speed", load.speed, "must roll the meshes: at these speeds the set turns as one", "rpm")
    drive = Drive(1 if statics.flow.set_torques[first.name] > 0 else -1, 1 if against > 0 else -1)
    phases = mesh_phases(train, drive)
    teeth = [mesh.rim.gear.teeth for mesh in train.meshes]
    turns = [members[each.follows] if each.follows else 0.0 for each in statics.turning]
    return Rolling(
        ahead=np.array([phases[mesh.name].ahead for mesh in train.meshes]),
        paces=np.array([1.0, teeth[1] / teeth[0]]),
        stage_paces={stage.name: _pace(train, stage, members) / pitches for stage in train.stages},
        carrier=members[train.carrier.name] / pitches,
        output=members[train.output] / pitches,
        turning=(np.array(turns) - members[train.carrier.name]) / pitches,
        period=teeth[0] // math.gcd(*teeth),
        rate=pitches if load.speed else 0.0,
    )


def _pace(train: PlanetaryTrain, stage: PairStage, members: Mapping[str, float]) -> float:
    """Base pitches of a stage in a minute."""
    return abs(members[stage.pinion]) * stage.pair.pinion.tooth_count
