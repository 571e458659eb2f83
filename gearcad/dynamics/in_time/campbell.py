"""The Campbell diagram of a train or pair, its meshes as stiff as real teeth: its motion at each speed, on all cores."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.in_time.mesh_campbell import MeshCampbell
from gearcad.dynamics.in_time.motion import Motion, MovingSystem
from gearcad.dynamics.in_time.speed_course import Course
from gearcad.dynamics.in_time.steps import settling_time, step_for
from gearcad.dynamics.tooth_springs.history import CHAOTIC_DIGITS, SETTLED
from gearcad.dynamics.tooth_springs.spectra import amplitude_spectrum
from gearcad.dynamics.tooth_springs.speed_spectra import SpeedRow
from gearcad.dynamics.trains.system import System
from gearcad.dynamics.trains.train import Train
from gearcad.errors import ParameterError, SolverError
from gearcad.threads import on_all_cores

__all__ = ["campbell_seconds", "mesh_campbell"]

_HIGHEST = 2.2
"""Spectra go up to so many times the highest tooth frequency, or natural frequency."""

_MOST_NUMBERS = 40_000_000
"""Of the courses at one speed."""

_MOST_STEPS = 4_000_000_000
"""At all speeds: some quarter of an hour on two cores."""

_STEP, _TERM, _DISTURBED = 40e-9, 11e-9, 1.6
"""CPU seconds of a step: for itself and for each mode of each mesh; factor for one whose small disturbance is followed too."""

_SETTLES = 2.0
"""Durations of a speed for which its motion settles at the most."""


class _Plan(NamedTuple):
    """Length of a step (s), steps from sample to sample, and at each speed steps of its samples and those before them."""

    step: float
    stride: int
    shown: int
    settling: int


def mesh_campbell(
    train: Train,
    system: System,
    excitation: Excitation,
    speeds: Floats,
    modes: Mapping[str, float],
    *,
    duration: float,
    sampling: float,
    counted: Callable[[int, int], None] = lambda _done, _count: None,
) -> MeshCampbell:
    """Spectra at speeds (s,) of the first pinion (rpm, rising) over a duration (s) after settling, `sampling` a second (Hz).

    `modes` are natural frequencies (Hz) to be drawn in, by name; `counted` hears how many speeds are done. Raises
    ParameterError for what takes too long or too much memory, with what would do, and SolverError where the motion is
    unbounded at all speeds.
    """
    moving, first = MovingSystem.lumped(system, excitation), train.meshes[0]
    per_rpm = first.teeth / 60 / excitation.orders[0]
    highest = min(_HIGHEST * max(float(speeds[-1]) * first.teeth / 60, *modes.values()), sampling / 2)
    step, stride, count, settling = _plan(moving, excitation, duration, sampling, float(speeds[-1]) * per_rpm)
    _require_room(moving, count // stride, (count + settling) * len(speeds), duration, sampling)
    pinion = system.names[1].index(first.pinion)

    def row(speed: float) -> SpeedRow | None:
        frequency = speed * per_rpm
        try:
            start = moving.run(Course.steady(frequency), step, settling).end if settling else None
            course = Course(frequency=Course.steady(frequency).frequency, turns=frequency * settling * step)
            ends = (round(SETTLED * count), count)
            motion = moving.run(course, step, count - 1, stride=stride, ends=ends, start=start, disturbed=True)
        except SolverError:
            return None
        return _row(motion, speed, pinion, sampling, highest, excitation.parting)

    rows = on_all_cores(row, speeds.tolist(), counted)
    kept = np.array([each is not None for each in rows])
    if not kept.any():
        raise SolverError("the motion grows beyond all numbers at every speed of the Campbell diagram")
    found = [each for each in rows if each is not None]
    columns = {name: np.array(values) for name, values in zip(SpeedRow._fields, zip(*found, strict=True), strict=True)}
    arrays = {
        "speeds": np.array(speeds[kept]),
        "frequency": np.arange(columns["approach"].shape[1]) * (sampling * stride / count),
        **columns,
    }
    for array in arrays.values():
        array.flags.writeable = False
    return MeshCampbell(
        mesh=first.name,
        pinion_teeth=first.teeth,
        modes=dict(modes),
        duration=duration,
        sampling=sampling,
        settled=settling * step,
        unbounded=tuple(speeds[~kept].tolist()),
        **arrays,
    )


def campbell_seconds(
    train: Train, system: System, excitation: Excitation, speeds: Floats, *, duration: float, sampling: float
) -> float:
    """Return the CPU seconds that `mesh_campbell` takes at speeds (s,) of the first pinion (rpm), about."""
    moving = MovingSystem.lumped(system, excitation)
    plan = _plan(moving, excitation, duration, sampling, float(speeds[-1]) * train.meshes[0].teeth / 60 / excitation.orders[0])
    n, m = system.mesh.shape
    steps = len(speeds) * (_DISTURBED * plan.shown + plan.settling)
    return float(steps * (_STEP + _TERM * n * m))


def _plan(moving: MovingSystem, excitation: Excitation, duration: float, sampling: float, greatest: float) -> _Plan:
    """At the greatest frequency (Hz) of the common period."""
    step, stride = _step(moving, excitation, sampling, greatest)
    settling = math.ceil(min(settling_time(moving.system), _SETTLES * duration) / step)
    return _Plan(step, stride, round(duration * sampling) * stride, settling)


def _step(moving: MovingSystem, excitation: Excitation, sampling: float, greatest: float) -> tuple[float, int]:
    """Length of a step, and how many there are from sample to sample."""
    longest = step_for(moving.system, greatest * max(excitation.orders), 1 / sampling)
    stride = max(1, math.ceil(1 / (sampling * longest) * (1 - 1e-9)))
    return 1 / (sampling * stride), stride


def _require_room(moving: MovingSystem, samples: int, steps: int, duration: float, sampling: float) -> None:
    """Raise ParameterError for what cannot be held, or would take hours, or has too few samples for a spectrum."""
    numbers = samples * (3 * len(moving.laws) + 2 * moving.rows)
    if samples < 4:
        raise ParameterError(
            "duration", duration, f"must be at least {4 / sampling:g} s for a spectrum at {sampling:g} Hz", "s"
        )
    part = min(_MOST_NUMBERS / numbers, _MOST_STEPS / steps)
    if part < 1:
        permitted = (
            f"must be at most {0.99 * part * duration:.2g} s for a Campbell diagram of so many speeds at {sampling:g} Hz"
        )
        raise ParameterError("dynamics.duration", duration, permitted, "s")


def _row(motion: Motion, speed: float, pinion: int, sampling: float, highest: float, parting: bool) -> SpeedRow:
    """In the units of the house."""
    approach = 1e6 * motion.approach[:, 0]
    later = approach[round(SETTLED * len(approach)) :]
    turning = speed * math.pi / 30 + motion.speeds[:, pinion]
    total, gain = motion.growth
    digits = gain / math.log(10)
    return SpeedRow(
        amplitude_spectrum(turning, sampling, highest).amplitude,
        amplitude_spectrum(approach, sampling, highest).amplitude,
        float(later.mean()),
        float(later.max()),
        float(approach.max()),
        float(motion.parted[-1, 0]) if parting else 0.0,
        total / (motion.step * motion.ends[-1]),
        digits,
        digits > CHAOTIC_DIGITS,
    )
