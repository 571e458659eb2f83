"""Campbell studies of pairs and trains: their motion at each speed, on all cores."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, SolverError, require_number
from gearcad.core.records import Floats
from gearcad.core.runtime import on_all_cores
from gearcad.dynamics.time_domain.contact_model import ContactModel
from gearcad.dynamics.time_domain.motion import Motion, MovingSystem, RunCourse, settling_time, step_for
from gearcad.dynamics.time_domain.spectra import MeshCampbell, SpeedRow, amplitude_spectrum
from gearcad.dynamics.time_domain.time_history import (
    CHAOTIC_DIGITS,
    SETTLED,
    CampbellStudy,
    PairStart,
    checked_samples,
    time_history,
)
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.train import Train

HIGHEST_FREQUENCY = 15000.0
"""Default end of the spectra (Hz): twice the tooth frequency of the thesis's fastest speed, and more."""


def campbell(
    model: ContactModel,
    speeds: ArrayLike,
    *,
    duration: float = 1.0,
    sampling: float = 200000.0,
    highest_frequency: float = HIGHEST_FREQUENCY,
    start: PairStart | None = None,
    counted: Callable[[int, int], None] = lambda _done, _count: None,
) -> CampbellStudy:
    """Return the Campbell study of a model: the motion at each speed (rpm, rising, not negative) from the same start.

    Each speed runs by itself, on all cores. `counted` receives how many speeds are done, and of how many.
    """
    checked = _checked_speeds(np.atleast_1d(np.asarray(speeds, float)).tolist())
    checked_samples(duration, sampling)
    require_number("highest_frequency", highest_frequency, "Hz", above=0)

    def row(speed: float) -> SpeedRow:
        motion = time_history(model, speed, duration=duration, sampling=sampling, start=start)
        settled = motion.settled
        return SpeedRow(
            motion.spectrum(highest_frequency).amplitude,
            motion.approach_spectrum(highest_frequency).amplitude,
            float(settled.mean()),
            float(settled.max()),
            float(motion.approach.max()),
            motion.out_of_contact,
            motion.growth,
            motion.digits_lost,
            motion.chaotic,
        )

    # Integration and FFT leave the interpreter to other threads: no motion is held longer than its row takes.
    rows = on_all_cores(row, checked, counted)
    columns = {name: np.array(values) for name, values in zip(SpeedRow._fields, zip(*rows, strict=True), strict=True)}
    frequency = np.arange(columns["approach"].shape[1]) * (sampling / checked_samples(duration, sampling))
    arrays = {"speeds": np.array(checked), "frequency": frequency, **columns}
    for array in arrays.values():
        array.flags.writeable = False
    return CampbellStudy(model=model, duration=float(duration), sampling=float(sampling), **arrays)


def _checked_speeds(speeds: Sequence[float]) -> Sequence[float]:
    if len(speeds) == 0:
        raise ParameterError("speeds", speeds, "must be at least one speed", "rpm")
    for number, speed in enumerate(speeds):
        require_number(f"speeds[{number}]", speed, "rpm", at_least=0)
        if number and speed <= speeds[number - 1]:
            raise ParameterError(f"speeds[{number}]", speed, f"must be above {speeds[number - 1]:g} rpm: speeds rise", "rpm")
    return speeds


_HIGHEST = 2.2
"""Spectra go up to so many times the highest tooth frequency, or natural frequency."""

_MOST_NUMBERS = 40_000_000
"""Greatest count of numbers of the courses at one speed."""

_MOST_STEPS = 4_000_000_000
"""Greatest number of steps at all speeds: some quarter of an hour on two cores."""

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
    """Return the spectra at speeds (s,) of the first pinion (rpm, rising) over a `duration` (s) after settling.

    Motions are sampled at `sampling` (Hz). `modes` are natural frequencies (Hz) to be drawn in, by name; `counted` receives how
    many speeds are done. Raises ParameterError for what takes too long or too much memory, with what would do, and SolverError
    where the motion is unbounded at all speeds.
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
            start = moving.run(RunCourse.steady(frequency), step, settling).end if settling else None
            course = RunCourse(frequency=RunCourse.steady(frequency).frequency, turns=frequency * settling * step)
            ends = (round(SETTLED * count), count)
            motion = moving.run(course, step, count - 1, stride=stride, ends=ends, start=start, disturbed=True)
        except SolverError:
            return None
        return _row(motion, speed, pinion, sampling, highest, excitation.parting)

    rows = on_all_cores(row, speeds.tolist(), counted)
    kept = np.array([each is not None for each in rows])
    if not kept.any():
        raise SolverError("the motion grows without bound at every speed of the Campbell diagram")
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
    """Return the plan of the steps for the greatest frequency (Hz) of the common period."""
    step, stride = _step(moving, excitation, sampling, greatest)
    settling = math.ceil(min(settling_time(moving.system), _SETTLES * duration) / step)
    return _Plan(step, stride, round(duration * sampling) * stride, settling)


def _step(moving: MovingSystem, excitation: Excitation, sampling: float, greatest: float) -> tuple[float, int]:
    """Return the length of a step (s), and the number of steps from sample to sample."""
    longest = step_for(moving.system, greatest * excitation.highest, 1 / sampling)
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
    """Return the results of a motion at one speed in the units of a Campbell study (rad/s, µm, 1/s)."""
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
