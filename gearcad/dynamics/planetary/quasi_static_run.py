"""Quasi-static run of a planetary train: shares of the planets and twist of the output over the roll of its meshes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, require_whole
from gearcad.core.records import Complexes, Floats, JsonObject, Notice, texts
from gearcad.dynamics.planetary.planar_model import mesh_force
from gearcad.dynamics.planetary.planetary_statics import SpringState, TrainStatics, planar_notices, train_statics, twist_of
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import PairStage, PlanetaryTrain, TrainLoad
from gearcad.planetary.poses import Drive, mesh_phases
from gearcad.planetary.train_data import speeds

LONGEST = 2000.0
"""Base pitches of the first mesh after which a run ends."""

_BESIDE = 1e-9
"""Base pitches from a jump to the places on both its sides that are computed."""

_STILL = 1e-9
"""Turns in a base pitch below which a part stands still."""


class StiffnessCourse(Protocol):
    """Stiffness of a mesh (N/µm) over the distance of contact past the pitch point.

    The distance is in base pitches in the direction in which contact moves.
    """

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """Return the stiffness (N/µm) at any places (base pitches)."""

    @property
    def jumps(self) -> Floats:
        """Places where the stiffness jumps, from 0 to 1."""


@dataclass(frozen=True, kw_only=True)
class CycleCourse:
    """Stiffness course of a MeshCycle whose pinion drives; with `reverse` its wheel does."""

    cycle: MeshCycle
    reverse: bool = False

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """Return the stiffness (N/µm) at any places (base pitches)."""
        roll = np.asarray(ahead, float) * self.cycle.pitch_angle
        return self.cycle.stiffness_at(-roll if self.reverse else roll)

    @property
    def jumps(self) -> Floats:
        """Places where the stiffness jumps, from 0 to 1."""
        twice = np.flatnonzero(np.diff(self.cycle.roll_angle) == 0)
        places = self.cycle.roll_angle[twice] / self.cycle.pitch_angle
        return np.mod(-places if self.reverse else places, 1.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Rolling:
    """Motion of all parts of a train as the first mesh rolls, from the pose in which the carrier stands at 0.

    `ahead` (2, N) are base pitches of each planet there. `paces` (2,) are base pitches that both meshes roll in one of the
    first; `stage_paces` likewise. `carrier` and `output` are their turns in one base pitch, `turning` (t,) those of what turns
    against the carrier. `period` is the number of base pitches after which both meshes stand as before; `rate` base pitches in
    a minute, 0 at rest.
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
        """Base pitches in which all that turns has turned once and both meshes have passed one period.

        It is at most LONGEST.
        """
        moving = np.abs(self.turning[np.abs(self.turning) > _STILL])
        return float(min(max([self.period, *(1 / moving)]), LONGEST))

    def places(self, span: float, steps: int, courses: Mapping[str, StiffnessCourse], names: tuple[str, str]) -> Floats:
        """Return the places (s,) from 0 to `span` in base pitches of the first mesh.

        They are equal steps with both ends, and both sides of every jump.
        """
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
    """Return the motion of a train at its load; for a train at rest, as with a positive speed of the input.

    Raises ParameterError where the set turns as one, and for missing speeds of a differential.
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
    """Return the base pitches of a stage in a minute."""
    return abs(members[stage.pinion]) * stage.pair.pinion.tooth_count


STEPS = 32
"""Steps in a base pitch of the mesh that rolls fastest."""

HARMONICS = 10
"""Harmonics of the faster mesh in the ripple of the speed: with all it would have no bound where stiffness jumps."""

_PER_HARMONIC = 16
"""Steps in a wave of the highest harmonic."""

_MEAN = 720
"""Places in a base pitch over which compliances are averaged."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Ripple:
    """Part of the output's twist from the meshes alone, nothing else turning, over the `period` that both repeat.

    `amplitude` {mesh: (HARMONICS,)} in degrees at multiples of its frequency. `speed` is the peak-to-peak speed over that of
    the output, of harmonics up to HARMONICS times the faster mesh; None where the output stands.
    """

    period: int
    amplitude: Mapping[str, Floats]
    speed: float | None

    def to_dict(self) -> JsonObject:
        """Return plain values for JSON."""
        return {
            "period": self.period,
            "amplitude": {name: values.tolist() for name, values in self.amplitude.items()},
            "speed_ripple": self.speed,
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class Running:
    """A train as it runs, over `rolled` (s,) base pitches of its first mesh; the carrier is at `carrier_angle` (s,) in degrees.

    `shares` (N, s) of the planets are 1 where all carry the same, `forces` {mesh: (N, s)} in N along the lines of action, and
    `twist` (s,) in degrees is how far the output gives way to its torque with the input held in its place. `slow_shares` and
    `slow_twist` are the same with the mean compliance of each mesh: what is left by all that turns, such as forces of stages
    and run-out, which begin on +x. `rate` (base pitches in a minute) is 0 for a train at rest.
    """

    train: PlanetaryTrain
    rolled: Floats
    carrier_angle: Floats
    forces: Mapping[str, Floats]
    shares: Floats
    twist: Floats
    slow_shares: Floats
    slow_twist: Floats
    ripple: Ripple
    rate: float
    turning: tuple[str, ...]
    rigid: tuple[str, ...]

    @property
    def time(self) -> Floats | None:
        """Time (s,) in s; None at rest."""
        return self.rolled / self.rate * 60 if self.rate else None

    @property
    def twist_ripple(self) -> float:
        """Peak-to-peak twist (degrees)."""
        return float(np.ptp(self.twist))

    @cached_property
    def mesh_ripple(self) -> float:
        """Peak-to-peak twist (degrees) of the meshes: without the slow part."""
        return float(np.ptp(self.twist - self.slow_twist))

    @property
    def slow_ripple(self) -> float:
        """Peak-to-peak twist (degrees) of all that turns."""
        return float(np.ptp(self.slow_twist))

    @property
    def mesh_share_ripple(self) -> float:
        """Greatest peak-to-peak share of a planet that the meshes make."""
        return float(np.ptp(self.shares - self.slow_shares, axis=1).max())

    @property
    def mesh_load_factor(self) -> float:
        """K_gamma, the greatest share of a planet in this run."""
        return float(self.shares.max())

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before the run is used."""
        span = f"{self.rolled[-1]:.6g} base {'pitch' if self.rolled[-1] == 1 else 'pitches'} of {self.train.meshes[0].name}"
        turn = f"the carrier turns {abs(self.carrier_angle[-1]):.4g} deg"
        found = [Notice("span", f"run over {span}, in which {turn}, at {len(self.rolled)} places; without masses and friction")]
        found.extend(planar_notices(self.train))
        if self.rolled[-1] >= LONGEST:
            found.append(
                Notice(
                    "span-cut",
                    f"the run ends there, before these parts have returned to their start: {', '.join(self.turning)}",
                )
            )
        if (self.shares <= 0).any():
            planets = ", ".join(str(n + 1) for n in np.flatnonzero((self.shares <= 0).any(axis=1)))
            found.append(Notice("planet-unloaded", f"planets that lose contact: {planets}"))
        if self.rigid:
            found.append(Notice("taken-for-rigid", f"taken for rigid, without a stiffness: {', '.join(self.rigid)}"))
        return tuple(notice.within("running") for notice in found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the figures of `planetary.json`: degrees, and the ripple of the twist in arc seconds and µrad, too."""
        return {
            "span": float(self.rolled[-1]),
            "places": len(self.rolled),
            "carrier_turn": float(self.carrier_angle[-1]),
            "mesh_load_factor": self.mesh_load_factor,
            "least_share": float(self.shares.min()),
            "mesh_share_ripple": self.mesh_share_ripple,
            "mean_twist": float(np.trapezoid(self.twist, self.rolled) / self.rolled[-1]),
            "twist_ripple": self.twist_ripple,
            "mesh_ripple": self.mesh_ripple,
            "slow_ripple": self.slow_ripple,
            "mesh_ripple_arcsec": 3600 * self.mesh_ripple,
            "mesh_ripple_urad": 1e6 * float(np.radians(self.mesh_ripple)),
            "ripple": self.ripple.to_dict(),
            "turning": list(self.turning),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by their names."""
        return {
            "rolled": self.rolled,
            "carrier_angle": self.carrier_angle,
            "shares": self.shares,
            "slow_shares": self.slow_shares,
            "twist": self.twist,
            "slow_twist": self.slow_twist,
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class _Run:
    """Inputs of a run: the train, its motion, and the stiffness of its meshes and stages over that motion."""

    statics: TrainStatics
    rolling: Rolling
    courses: Mapping[str, StiffnessCourse]

    @property
    def names(self) -> tuple[str, str]:
        first, second = self.statics.train.meshes
        return first.name, second.name

    def places(self, span: float, steps: int) -> Floats:
        return self.rolling.places(span, steps, self.courses, self.names)

    def state(self, rolled: Floats, *, mean: bool = False) -> SpringState:
        """Return the state at places (s,), with the compliances of the meshes there, or their mean."""
        compliance = np.tile(self.statics.compliance, (len(rolled), 1))
        for name, springs, pace, ahead in zip(
            self.names, self.statics.meshes, self.rolling.paces, self.rolling.ahead, strict=True
        ):
            course = self.courses[name]
            compliance[:, springs] = (
                _mean_compliance(course) if mean else 1 / course.stiffness_at(ahead + pace * rolled[:, None])
            )
        angles = 2 * np.pi * rolled[:, None] * self.rolling.turning
        return self.statics.state(angles, compliance)

    def twist(self, state: SpringState, rolled: Floats, *, mean: bool = False) -> Floats:
        """Return the twist (s,) in degrees, by the virtual work of set, stages and the output's shaft."""
        statics = self.statics
        work = (state.forces * (state.yielding + state.gap)).sum(axis=1) + statics.output_work
        for stage in statics.train.stages:
            if stage.name in self.courses:
                course, pace = self.courses[stage.name], self.rolling.stage_paces[stage.name]
                force = mesh_force(stage, statics.flow.stage_torques[stage.name])
                work = work + force**2 * (_mean_compliance(course) if mean else 1 / course.stiffness_at(pace * rolled))
        return twist_of(work, statics.torque)

    def shares(self, state: SpringState) -> Floats:
        """Return the shares of the planets (N, s)."""
        forces = state.forces[:, self.statics.meshes[0]]
        found: Floats = (forces / forces.mean(axis=1, keepdims=True)).T
        return found


def run_train(
    train: PlanetaryTrain,
    load: TrainLoad,
    courses: Mapping[str, StiffnessCourse],
    *,
    steps: int = STEPS,
    given_speeds: Mapping[str, float] | None = None,
) -> Running:
    """Return the run of a train with the stiffness of each mesh and stage by its name; a stage without one is rigid.

    It ends when all that turns has turned once and the meshes have passed one period, at the latest after LONGEST base pitches.
    `steps` are those in a base pitch of the fastest mesh or stage. Raises ParameterError where nothing rolls, and the errors of
    `train_statics`.
    """
    require_whole("steps", steps, at_least=4, at_most=1000)
    statics = train_statics(train, load, {mesh.name: 1.0 for mesh in train.meshes}, given_speeds)
    run = _Run(statics=statics, rolling=rolling_of(statics, given_speeds), courses=courses)
    rolled = run.places(run.rolling.span, steps)
    state, slow = run.state(rolled), run.state(rolled, mean=True)
    return Running(
        train=train,
        rolled=rolled,
        carrier_angle=360 * run.rolling.carrier * rolled,
        forces={name: state.forces[:, springs].T for name, springs in zip(run.names, statics.meshes, strict=True)},
        shares=run.shares(state),
        twist=run.twist(state, rolled),
        slow_shares=run.shares(slow),
        slow_twist=run.twist(slow, rolled, mean=True),
        ripple=_ripple(run),
        rate=run.rolling.rate,
        turning=tuple(each.name for each in statics.turning),
        rigid=tuple(stage.name for stage in train.stages if stage.name not in courses),
    )


def _ripple(run: _Run) -> Ripple:
    """Return the ripple of the meshes of the set, over the period after which they repeat themselves."""
    still = replace(run, statics=replace(run.statics, turning=()), courses={name: run.courses[name] for name in run.names})
    period, faster = run.rolling.period, float(run.rolling.paces.max())
    rolled = still.places(period, _PER_HARMONIC * HARMONICS)
    twist = still.twist(still.state(rolled), rolled)
    every = range(1, round(HARMONICS * faster * period) + 1)
    waves = (np.exp((-2j * np.pi * order / period) * rolled) for order in every)
    coefficients = np.fromiter((2 / period * np.trapezoid(wave * twist, rolled) for wave in waves), complex)
    orders = {
        name: np.arange(1, HARMONICS + 1) * round(period * pace) - 1
        for name, pace in zip(run.names, run.rolling.paces, strict=True)
    }
    amplitude = {name: np.abs(coefficients[each]) for name, each in orders.items()}
    output = 360 * abs(run.rolling.output)
    return Ripple(period=period, amplitude=amplitude, speed=_speed_ripple(coefficients, period) / output if output else None)


def _speed_ripple(coefficients: Complexes, period: int) -> float:
    """Return the peak-to-peak slope (deg in a base pitch) of the harmonics 1, 2, ... of a period."""
    orders = np.arange(1, len(coefficients) + 1)
    slopes = np.concatenate([[0], coefficients * 2j * np.pi * orders / period])
    return float(np.ptp(np.fft.irfft(slopes / 2, n=16 * len(slopes)) * 16 * len(slopes)))


def _mean_compliance(course: StiffnessCourse) -> float:
    """Return the mean of 1/k over a base pitch (µm/N)."""
    return float((1 / course.stiffness_at((np.arange(_MEAN) + 0.5) / _MEAN)).mean())
