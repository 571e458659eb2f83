"""A planetary train as it runs, quasi-statically: shares of the planets and twist of the output over what the meshes roll."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcad.arrays import Complexes, Floats
from gearcad.dynamics.planetary.rolling import LONGEST, Rolling, StiffnessCourse, rolling_of
from gearcad.dynamics.planetary.stage_forces import mesh_force
from gearcad.dynamics.planetary.statics import State, TrainStatics, planar_notices, train_statics
from gearcad.dynamics.planetary.torsion import twist_of
from gearcad.errors import require_whole
from gearcad.notice import Notice, texts
from gearcad.planetary import PlanetaryTrain, TrainLoad

__all__ = ["HARMONICS", "Ripple", "Running", "run_train"]

STEPS = 32
"""Steps in a base pitch of the mesh that rolls fastest."""

HARMONICS = 10
"""Of the mesh that rolls faster, that the ripple of the speed has: where stiffness jumps it would have no bound with all."""

_PER_HARMONIC = 16
"""Steps in a wave of the highest harmonic."""

_MEAN = 720
"""Places in a base pitch over which compliances are averaged."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Ripple:
    """The part of the output's twist that the meshes make alone, nothing else turning, over the `period` that both repeat.

    `amplitude` {mesh: (HARMONICS,)} in degrees at multiples of its frequency. `speed` is the peak-to-peak speed over that of
    the output, of harmonics up to HARMONICS times the faster mesh; None where the output stands.
    """

    period: int
    amplitude: Mapping[str, Floats]
    speed: float | None

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
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
        """(s,) in s; None at rest."""
        return self.rolled / self.rate * 60 if self.rate else None

    @property
    def twist_ripple(self) -> float:
        """Peak to peak (degrees)."""
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
        """What to know before trusting it."""
        span = f"{self.rolled[-1]:.6g} base {'pitch' if self.rolled[-1] == 1 else 'pitches'} of {self.train.meshes[0].name}"
        turn = f"the carrier turns {abs(self.carrier_angle[-1]):.4g} deg"
        found = [Notice("span", f"run over {span}, in which {turn}, at {len(self.rolled)} places; without masses and friction")]
        found.extend(planar_notices(self.train))
        if self.rolled[-1] >= LONGEST:
            found.append(Notice("span-cut", f"it ends there, before all has come round: {', '.join(self.turning)}"))
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

    def to_dict(self) -> dict[str, Any]:
        """Figures as `planetary.json` has them: degrees, and the ripple of the twist in arc seconds and µrad, too."""
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
        """As the .npz file has them."""
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
    """What is run: the train, how it rolls, and how stiff its meshes and stages are over that."""

    statics: TrainStatics
    rolling: Rolling
    courses: Mapping[str, StiffnessCourse]

    @property
    def names(self) -> tuple[str, str]:
        first, second = self.statics.train.meshes
        return first.name, second.name

    def places(self, span: float, steps: int) -> Floats:
        return self.rolling.places(span, steps, self.courses, self.names)

    def state(self, rolled: Floats, *, mean: bool = False) -> State:
        """At places (s,), with the compliances of the meshes there, or their mean."""
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

    def twist(self, state: State, rolled: Floats, *, mean: bool = False) -> Floats:
        """(s,) in degrees, by the virtual work of set, stages and the output's shaft."""
        statics = self.statics
        work = (state.forces * (state.yielding + state.gap)).sum(axis=1) + statics.output_work
        for stage in statics.train.stages:
            if stage.name in self.courses:
                course, pace = self.courses[stage.name], self.rolling.stage_paces[stage.name]
                force = mesh_force(stage, statics.flow.stage_torques[stage.name])
                work = work + force**2 * (_mean_compliance(course) if mean else 1 / course.stiffness_at(pace * rolled))
        return twist_of(work, statics.torque)

    def shares(self, state: State) -> Floats:
        """(N, s)."""
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
    """The run of a train with the stiffness of each mesh and stage by its name; a stage without one is rigid.

    It ends when all that turns has turned once and the meshes have gone through all they can be, at the latest after LONGEST
    base pitches. `steps` are those in a base pitch of what rolls fastest. Raises ParameterError where nothing rolls, and what
    `train_statics` does.
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
    """Of the meshes of the set, over the period after which they repeat themselves."""
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
    """Peak-to-peak slope (deg in a base pitch) of the harmonics 1, 2, ... of a period."""
    orders = np.arange(1, len(coefficients) + 1)
    slopes = np.concatenate([[0], coefficients * 2j * np.pi * orders / period])
    return float(np.ptp(np.fft.irfft(slopes / 2, n=16 * len(slopes)) * 16 * len(slopes)))


def _mean_compliance(course: StiffnessCourse) -> float:
    """Mean of 1/k over a base pitch (µm/N)."""
    return float((1 / course.stiffness_at((np.arange(_MEAN) + 0.5) / _MEAN)).mean())
