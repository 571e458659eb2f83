"""The dynamics of a train in one go: its modes, the overload of meshes and shafts over speed, and the course at one speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.dynamics.charts.kv import KvChart
from gearcad.dynamics.charts.over_speed import OverSpeed, over_speed
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.excitation.sources import train_excitation
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.response.periodic import PeriodicResponse
from gearcad.dynamics.trains.lines import system
from gearcad.dynamics.trains.modes import NaturalModes, natural_modes
from gearcad.dynamics.trains.system import System
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.errors import GeometryError
from gearcad.notice import Notice, texts
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.options import RatingOptions

__all__ = ["Course", "ModalStudy", "TrainStudy", "study_modes", "study_train"]


_BEYOND = 1.5
"""How far beyond the last resonance a chart goes on."""

_SHARE = 0.02
"""Of a mode's potential energy that a mesh must hold for the mode to be a resonance of it."""

_DRAWN, _DRAWN_OF_MANY = 1024, 256
"""Samples of a course over a tooth, at least, and over each of many; 8 of the quickest vibration that could be felt."""

_LOWER, _RUN_UP = 3.0, 60
"""Where flanks part at a speed beyond the chart, the run up to it begins at the speed over the first, and has so many steps."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Course:
    """One speed (rpm of the first pinion) over the common period: `turn` (t,) in tooth periods of the first mesh.

    `approach` (t, m) of the flanks in µm, `force` (t, m) in N with that of the dampers, `shaft_torque` (t, n) in N·m; `kv` (m,)
    is K_v of each mesh there.
    """

    speed: float
    kv: Floats
    turn: Floats
    approach: Floats
    force: Floats
    shaft_torque: Floats

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {name: value if isinstance(value, float) else value.tolist() for name, value in vars(self).items()}


@dataclass(frozen=True, kw_only=True, eq=False)
class ModalStudy:
    """A train without meshes: nothing shakes it, but it has its natural modes."""

    train: Train
    options: DynamicsOptions
    modes: NaturalModes

    @property
    def name(self) -> str:
        """Of the train."""
        return self.train.name

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it."""
        return _missed(self.train, self.modes)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it: no chart, no course."""
        return {
            "model": self.train.model.value,
            "modes": self.modes.to_dict(),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        return _mode_arrays(self.modes)


def _missed(train: Train, modes: NaturalModes) -> tuple[Notice, ...]:
    """That the model has fewer natural frequencies than the train."""
    if not modes.missed or train.model is TrainModel.MODES:
        return ()
    text = (
        f"natural frequencies below the highest listed that this model does not have: {modes.missed}; "
        'the model "exact" has them all'
    )
    return (Notice("missed-frequencies", text),)


def _mode_arrays(modes: NaturalModes) -> dict[str, Floats]:
    return {
        "mode_frequency": modes.frequency,
        "mode_shape": modes.shape,
        "shaft_places": modes.places,
        "shaft_shape": modes.shaft_shape,
    }


@dataclass(frozen=True, kw_only=True, eq=False)
class TrainStudy:
    """What was found out about a train: `up` and, where flanks may part, `down` are charts over the same rising speeds."""

    train: Train
    options: DynamicsOptions
    system: System
    excitation: Excitation
    modes: NaturalModes
    up: KvChart
    down: KvChart | None
    jumps: tuple[Floats, Floats]
    course: Course
    found: tuple[Notice, ...]
    """What its own calculation has to say; `notices` are those of the charts and modes too."""
    method_b: DynamicFactor | None

    def __repr__(self) -> str:
        return f"<TrainStudy of {self.train.name!r}: {len(self.speeds)} speeds up to {self.speeds.max():.6g} rpm>"

    @property
    def speeds(self) -> Floats:
        """Of the charts (s,): rpm of the first mesh's pinion."""
        return self.rpm(self.up.frequencies)

    def rpm(self, frequencies: ArrayLike) -> Floats:
        """Speed of the first mesh's pinion at circular tooth frequencies of that mesh (1/s)."""
        result: Floats = np.asarray(frequencies, float) * 30 / (math.pi * self.train.meshes[0].teeth)
        return result

    @property
    def name(self) -> str:
        """Of the train."""
        return self.train.name

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it."""
        down = self.down.notices if self.down is not None else ()
        return tuple(dict.fromkeys((*self.found, *self.up.notices, *down, *_missed(self.train, self.modes))))

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it; frequencies in Hz and 1/s, speeds in rpm."""
        return {
            "model": self.train.model.value,
            "modes": self.modes.to_dict(),
            "speed": self.speeds.tolist(),
            "chart": self.up.to_dict(),
            "chart_down": None if self.down is None else self.down.to_dict(),
            "jumps_up": self.rpm(self.jumps[0]).tolist(),
            "jumps_down": self.rpm(self.jumps[1]).tolist(),
            "resonance_speed_iso6336": None if self.method_b is None else self.method_b.resonance_speed,
            "course": self.course.to_dict(),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        found = {
            "speed": self.speeds,
            "kv": self.up.factors,
            "shaft_overload": self.up.shaft_factors,
            **_mode_arrays(self.modes),
            **{f"course_{name}": np.asarray(value) for name, value in vars(self.course).items()},
        }
        if self.down is not None:
            found["kv_down"] = self.down.factors
        if self.up.standard is not None:
            found["kv_iso6336"] = self.up.standard
        return found


def study_modes(train: Train, options: DynamicsOptions | None = None) -> ModalStudy:
    """The natural modes alone, of any train. Raises ParameterError."""
    options = options or DynamicsOptions()
    return ModalStudy(train=train, options=options, modes=natural_modes(train, count=options.frequencies))


def study_train(
    train: Train,
    options: DynamicsOptions | None = None,
    *,
    excitation: Excitation | None = None,
    method_b: DynamicFactor | None = None,
    of: System | None = None,
    tell: Callable[[str], None] = lambda _step: None,
) -> TrainStudy:
    """Modes, charts and the course at the train's speed (or at its highest resonance).

    `excitation` is that of the train's own meshes unless given; `method_b` is K_v by ISO 6336-1 of the first mesh.
    `of` stands in for the train's system in the charts, with the same meshes.
    Raises ParameterError, GeometryError and SolverError.
    """
    if not train.meshes:
        raise GeometryError(
            "meshes", 0, "must be one at least: without teeth nothing shakes a train; study_modes has its modes"
        )
    options = (options or DynamicsOptions()).graded(RatingOptions())
    tell("modes")
    modes = natural_modes(train, count=options.frequencies)
    of = of or system(train)
    if excitation is None:
        grade = options.accuracy_grade if options.errors else None
        excitation = train_excitation(train, grade=grade, seed=options.seed)
    frequency = math.pi * train.meshes[0].teeth / 30
    speeds, asked = _speeds(train, options, modes) * frequency, abs(train.speed) * frequency
    if speeds[0] <= asked <= speeds[-1]:
        speeds = np.union1d(speeds, asked)
    tell("chart")
    over = over_speed(of, excitation, speeds, harmonics=options.harmonics, method_b=method_b)
    tell("course")
    course, more = _course(train, over, asked)
    return TrainStudy(
        train=train,
        options=options,
        system=of,
        excitation=excitation,
        modes=modes,
        up=over.up,
        down=over.down,
        jumps=over.jumps,
        course=course,
        found=(*over.notices, *more),
        method_b=method_b,
    )


def _speeds(train: Train, options: DynamicsOptions, modes: NaturalModes) -> Floats:
    """Of the chart (rpm of the first pinion)."""
    last = options.speed_to
    if last is None:
        felt = (modes.potential_meshes > _SHARE).any(axis=1)
        last = _BEYOND * float(modes.rpm[felt].max()) if felt.any() else _BEYOND * float(modes.rpm.max())
    first = options.speed_from if options.speed_from else last * options.slowest
    return np.linspace(first, last, options.chart_speeds)


def _course(train: Train, over: OverSpeed, asked: float) -> tuple[Course, tuple[Notice, ...]]:
    """At the frequency of the train's speed, or where the first mesh's K_v is greatest; and what to know about it."""
    frequency = asked or float(over.up.frequencies[over.up.factors[:, 0].argmax()])
    response, notices = over.response(frequency), tuple[Notice, ...]()
    within = over.up.frequencies[0] <= frequency <= over.up.frequencies[-1]
    if not within and over.excitation.parting and _pull(response):
        run_up = np.geomspace(frequency / _LOWER, frequency, _RUN_UP)
        beyond = over_speed(over.curves.system, over.excitation, run_up, harmonics=over.curves.harmonics)
        response, notices = beyond.response(frequency), beyond.notices
    samples = max(_DRAWN, _DRAWN_OF_MANY * max(over.excitation.orders))
    if over.curves.resolvable:
        felt, most = float(over.curves.felt_orders(np.array([frequency]))[0]), over.curves.most_orders
        samples = max(samples, 8 * int(min(felt, most)))
        if felt > most:
            notices = (*notices, _unresolved(most))
    return _drawn(train, response, samples), notices


def _unresolved(most: int) -> Notice:
    text = (
        f"at the speed asked for, harmonics beyond the {most} orders that are solved meet natural frequencies that can be felt:"
        " K_v and the course there are not those of the whole motion"
    )
    return Notice("course-unresolved", text)


def _pull(response: PeriodicResponse) -> bool:
    """Whether flanks pull in a linear motion."""
    return bool((response.senses * response.spring_forces()).min() <= 0)


def _drawn(train: Train, response: PeriodicResponse, samples: int) -> Course:
    """With about so many samples; K_v is that of more."""
    step = max(1, 8 * int(response.harmonics[-1]) // samples)
    count = max(samples, 8 * int(response.harmonics[-1]) // step * step)
    spring = response.spring_forces(count=count)
    phases = response.phases(count) / (2 * np.pi) * response.excitation.orders[0]
    crests = (response.senses * spring).max(axis=(0, 1))
    return Course(
        speed=float(response.frequencies[0] * 30 / (math.pi * train.meshes[0].teeth)),
        kv=crests / np.abs(response.system.stiffness * response.static.approach),
        turn=phases[::step],
        approach=1e6 * response.approach(count=count)[0, ::step],
        force=(spring + response.damping_forces(count=count))[0, ::step],
        shaft_torque=response.shaft_torques(count=count)[0, ::step],
    )
