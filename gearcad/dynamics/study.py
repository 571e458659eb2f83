"""The dynamics of a train in one go: its modes, the overload of meshes and shafts over speed, and the course at one speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.dynamics.backlash import Direction, trace
from gearcad.dynamics.driving import train_excitation
from gearcad.dynamics.excitation import Excitation
from gearcad.dynamics.kv import KvChart, kv_chart
from gearcad.dynamics.lines import system
from gearcad.dynamics.modes import NaturalModes, natural_modes
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.periodic import harmonic_orders, periodic_response
from gearcad.dynamics.response import PeriodicResponse
from gearcad.dynamics.system import System
from gearcad.dynamics.train import Train, TrainModel
from gearcad.errors import SolverError
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.options import RatingOptions

__all__ = ["Course", "TrainStudy", "study_train"]

Floats = NDArray[np.float64]

_BEYOND = 1.5
"""How far beyond the last resonance a chart goes on."""

_SHARE = 0.02
"""Of a mode's potential energy that a mesh must hold for the mode to be a resonance of it."""

_SWEEP_HARMONICS = 12
"""Fewest harmonics of motions in which flanks part."""

_MOST_UNKNOWNS = 80
"""Most harmonics, of all meshes together, of motions that are followed: the errors of 18 teeth would take minutes."""

_STUCK = "flanks are taken to stick to each other"


@dataclass(frozen=True, kw_only=True, eq=False)
class Course:
    """One speed (rpm of the first pinion) over the common period: `turn` (t,) in tooth periods of the first mesh.

    `approach` (t, m) of the flanks in µm, `force` (t, m) in N with that of the dampers, `shaft_torque` (t, n) in N·m.
    """

    speed: float
    turn: Floats
    approach: Floats
    force: Floats
    shaft_torque: Floats

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {name: value if isinstance(value, float) else value.tolist() for name, value in vars(self).items()}


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
    notes: tuple[str, ...]
    method_b: DynamicFactor | None

    @property
    def speeds(self) -> Floats:
        """Of the charts (s,): rpm of the first mesh's pinion."""
        return self.rpm(self.up.frequencies)

    def rpm(self, frequencies: ArrayLike) -> Floats:
        """Speed of the first mesh's pinion at circular tooth frequencies of that mesh (1/s)."""
        result: Floats = np.asarray(frequencies, float) * 30 / (math.pi * self.train.meshes[0].teeth)
        return result

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know before trusting it."""
        down = self.down.warnings if self.down is not None else ()
        found = list(dict.fromkeys((*self.notes, *self.up.warnings, *down)))
        if self.modes.missed and self.train.model is not TrainModel.MODES:
            found.append(
                f"natural frequencies below the highest listed that this model does not have: {self.modes.missed}; "
                'the model "exact" has them all'
            )
        return tuple(found)

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
        }

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        found = {
            "speed": self.speeds,
            "kv": self.up.factors,
            "shaft_overload": self.up.shaft_factors,
            "mode_frequency": self.modes.frequency,
            "mode_shape": self.modes.shape,
            "shaft_places": self.modes.places,
            "shaft_shape": self.modes.shaft_shape,
            **{f"course_{name}": np.asarray(value) for name, value in vars(self.course).items()},
        }
        if self.down is not None:
            found["kv_down"] = self.down.factors
        if self.up.standard is not None:
            found["kv_iso6336"] = self.up.standard
        return found


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
    options = (options or DynamicsOptions()).graded(RatingOptions())
    tell("modes")
    modes = natural_modes(train, count=options.frequencies)
    of = of or system(train)
    if excitation is None:
        grade = options.accuracy_grade if options.errors else None
        excitation = train_excitation(train, grade=grade, seed=options.seed, harmonics=options.harmonics)
    speeds = _speeds(train, options, modes) * math.pi * train.meshes[0].teeth / 30
    tell("chart")
    up, down, notes = _responses(of, excitation, speeds, options.harmonics)
    charts = [kv_chart(each, method_b=method_b) for each in (up, down) if each is not None]
    tell("course")
    return TrainStudy(
        train=train,
        options=options,
        system=of,
        excitation=excitation,
        modes=modes,
        up=charts[0],
        down=charts[1] if down is not None else None,
        jumps=(up.jumps, down.jumps if down is not None else np.zeros(0)),
        course=_course(train, up, charts[0]),
        notes=notes,
        method_b=method_b,
    )


def _speeds(train: Train, options: DynamicsOptions, modes: NaturalModes) -> Floats:
    """Of the chart (rpm of the first pinion)."""
    last = options.speed_to
    if last is None:
        felt = (modes.potential_meshes > _SHARE).any(axis=1)
        last = _BEYOND * float(modes.rpm[felt].max()) if felt.any() else _BEYOND * float(modes.rpm.max())
    first = options.speed_from if options.speed_from else last / options.chart_speeds
    return np.linspace(first, last, options.chart_speeds)


def _responses(
    of: System, excitation: Excitation, speeds: Floats, harmonics: int
) -> tuple[PeriodicResponse, PeriodicResponse | None, tuple[str, ...]]:
    """Linear where flanks cannot part or never do; else what is seen running up, and running down. And what went wrong."""
    linear = periodic_response(of, excitation, speeds, harmonics=harmonics)
    if not excitation.parting or (linear.stable.all() and kv_chart(linear).least.min() > 0):
        return linear, None, ()
    harmonics = max(harmonics, _SWEEP_HARMONICS)
    unknowns = len(of.stiffness) * len(harmonic_orders(excitation, harmonics))
    if unknowns > _MOST_UNKNOWNS:
        note = f"{_STUCK}: motions in which they part would have {unknowns} harmonics here; leave tooth errors out to see them"
        return linear, None, (note,)
    try:
        branch = trace(of, excitation, speeds, harmonics=harmonics)
    except SolverError as error:
        return linear, None, (f"{_STUCK}, for want of a motion in which they part: {error}",)
    return branch.sweep(Direction.UP), branch.sweep(Direction.DOWN), ()


def _course(train: Train, response: PeriodicResponse, chart: KvChart) -> Course:
    """At the train's speed, or where the first mesh's K_v is greatest."""
    asked = train.speed * math.pi * train.meshes[0].teeth / 30
    row = int(np.abs(response.frequencies - asked).argmin()) if asked else int(chart.factors[:, 0].argmax())
    which = slice(row, row + 1)
    force = response.spring_forces(which) + response.damping_forces(which)
    phases = response.phases() / (2 * np.pi) * response.excitation.orders[0]
    return Course(
        speed=float(response.frequencies[row] * 30 / (math.pi * train.meshes[0].teeth)),
        turn=phases,
        approach=1e6 * response.approach(which)[0],
        force=force[0],
        shaft_torque=response.shaft_torques(which)[0],
    )
