"""Transient run of a train: motion in time with changing speed or torque. SI units inside."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, Notice, Wholes
from gearcad.dynamics.time_domain.motion import Motion, MovingSystem, PiecewiseLine, RunCourse, Start, settling_time, step_for
from gearcad.dynamics.time_domain.order_tracks import no_tracks, order_tracks
from gearcad.dynamics.time_domain.transient_result import Transient, TransientOptions
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.speed_orders import speed_orders
from gearcad.dynamics.trains.steady_response import static_state
from gearcad.dynamics.trains.train import Train, parts_of

_NOTHING = 1e-9
"""Part of the greatest power below which a power is rounding."""


class Acceleration(NamedTuple):
    """Effect `felt` (n,) on the coordinates of a System of 1 rad/s² of the first pinion.

    `why` gives the reason if there is no effect, else "".
    """

    felt: Floats
    why: str


def acceleration(train: Train, system: System, *, backwards: bool = False) -> Acceleration:
    """Return the effect of speeding up all inertias at the ratios of the teeth by the one on which the torque drives.

    If the train runs `backwards`, it is the one that is driven.
    """
    nothing = np.zeros(system.size)
    if train.held:
        return Acceleration(nothing, "the ends of its shafts are held")
    parts, first = parts_of(train), train.reference
    if parts.free.shape[1] != 1:
        return Acceleration(nothing, "its parts turn by themselves")
    ratios = np.array([train.speed_ratios[inertia.name] for inertia in parts.inertias])
    power = parts.torque * ratios * (-1.0 if backwards else 1.0)
    least = _NOTHING * float(np.abs(power).max())
    driving = [inertia.name for inertia, each in zip(parts.inertias, power, strict=True) if each > least]
    if len(driving) != 1:
        return Acceleration(nothing, f"{len(driving) or 'no'} torques drive it")
    names = system.names[1]
    free = np.linalg.eigh(system.stiffness_matrix())[1][:, 0]
    turn = free / (system.inertias[:, names.index(first)] @ free)
    drive = system.inertias[:, names.index(driving[0])]
    return Acceleration(drive * float(turn @ turn) / float(drive @ turn) - turn, "")


def per_common_period(teeth: int, order: float) -> float:
    """Return the speed of a pinion (rad/s) where the common period of `order` of its teeth has a frequency of 1/s."""
    return 2 * math.pi * order / teeth


_MOST_STEPS = 400_000_000
"""Greatest number of steps: some minutes."""

_MOST_NUMBERS = 60_000_000
"""Greatest count of numbers of all courses together: half a gigabyte."""

_SAMPLES, _MOST_SAMPLES = 16, 200_000
"""Number of samples of a tooth, and greatest number of samples of a course without `sampling`."""

_WINDOWS, _MOST_WINDOWS = 100, 20_000
"""Stretches that a run is cut into at least, and at most: several teeth are one then."""

_NO_LOAD = 1e-9
"""Part of the greatest torque at rest below which a shaft carries no torque."""

_SETTLING_TEETH = 60
"""Tooth periods for which a run settles at the most, beyond its own duration."""


def run_transient(
    train: Train,
    system: System,
    excitation: Excitation,
    options: TransientOptions,
    *,
    references: Floats | None = None,
    otherwise: float,
    tell: Callable[[float], None] = lambda _part: None,
) -> Transient:
    """Return the run that the options ask for, of a train whose System and Excitation are given.

    `references` (s,) are the torques (N·m) with which those of shafts are compared, nan for none; those at rest if not given.
    `otherwise` is the speed (rpm) where the options have none; `tell` receives the part that is done. Raises ParameterError for
    what would take too long or too much memory, with what would do, and SolverError.
    """
    teeth, order = (train.meshes[0].teeth, excitation.orders[0]) if train.meshes else (1, excitation.period)
    speeds = options.speeds(otherwise)
    begin, end = (speed * teeth / 60 / order for speed in speeds)
    speedup = acceleration(train, system, backwards=begin + end < 0)
    moving = MovingSystem.lumped(system, excitation, driven=speedup.felt * per_common_period(teeth, order))
    quickest = max(abs(begin), abs(end)) * excitation.highest
    first = max(abs(max(speeds, key=abs)) * teeth / 60, max(abs(begin), abs(end)) * max(excitation.torque_orders, default=0))
    step, stride, count = _steps(moving, options, quickest, first)
    start, notices = _settled(moving, options, begin, abs(begin) * excitation.highest)
    course = RunCourse(
        frequency=PiecewiseLine(time=np.array([0.0, options.duration]), value=np.array([begin, end])), torque=_torque(options)
    )
    ends = _window_ends(course.frequency, order, step, count)
    motion = moving.run(course, step, count, stride=stride, ends=ends, start=start, tell=tell)
    if speedup.why and begin != end:
        text = f"the torque that speeds up the train's own inertias is left out: {speedup.why}"
        notices = (*notices, Notice("no-acceleration-torque", text))
    rpm = PiecewiseLine(time=course.frequency.time, value=np.array(speeds))
    found = _result(moving, excitation, options, motion, rpm, course.torque, references, notices)
    return _tracked(train, excitation, found) if options.tracked else found


def _tracked(train: Train, excitation: Excitation, run: Transient) -> Transient:
    """Return the run with the amplitudes of its orders along the speed, or with a notice why there are none."""
    orders = speed_orders(train, excitation, run.options.orders)
    period = excitation.period / (train.meshes[0].teeth if train.meshes else 1)
    why = no_tracks(run.time, run.speed, period)
    if why:
        return replace(run, notices=(*run.notices, Notice("no-order-tracks", why, "transient")))
    tracks = order_tracks(run.time, run.speed, run.force, run.shaft_torque, names=run.names, orders=orders, period=period)
    return replace(run, tracks=tracks)


def _steps(moving: MovingSystem, options: TransientOptions, quickest: float, first: float) -> tuple[float, int, int]:
    """Return the length of a step (s), steps from sample to sample, and all steps.

    `quickest` and `first` are tooth frequencies (Hz).
    """
    duration = options.duration
    longest = step_for(moving.system, quickest, duration / 200)
    wanted = options.sampling
    if wanted is None:
        wanted = min(max(_SAMPLES * first, 200 / duration), _MOST_SAMPLES / duration)
    wanted = max(wanted, 1 / duration)
    stride = max(1, math.ceil(1 / (wanted * longest) * (1 - 1e-9)))
    count = max(1, math.ceil(duration * wanted * (1 - 1e-9))) * stride
    step = duration / count
    rows = 3 * len(moving.laws) + 2 * (moving.system.inertias.shape[1] + moving.system.shaft_torques.shape[1])
    numbers = rows * (count // stride + 1)
    if numbers > _MOST_NUMBERS:
        highest = _down(wanted * _MOST_NUMBERS / numbers)
        text = f"must be at most {highest} Hz for {duration:g} s: the courses would have {numbers:.2g} numbers"
        raise ParameterError("dynamics.transient.sampling", wanted, text, "Hz")
    if count > _MOST_STEPS:
        most = duration * _MOST_STEPS / count
        text = f"must be at most {_down(most)} s: {count:.2g} steps of {step:.2g} s are more than {_MOST_STEPS:.2g}"
        raise ParameterError("dynamics.transient.duration", duration, text, "s")
    return step, stride, count


def _down(value: float) -> str:
    """Return the value with two digits, rounded down."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return f"{math.floor(value / unit * (1 + 1e-12)) * unit:.6g}"


def _torque(options: TransientOptions) -> PiecewiseLine:
    at, over = options.changes_at, options.torque_over
    if options.torque_to is None:
        return PiecewiseLine.level(options.torque_from)
    return PiecewiseLine(time=np.array([at, at + over]), value=np.array([options.torque_from, options.torque_to]))


def _settled(
    moving: MovingSystem, options: TransientOptions, frequency: float, quickest: float
) -> tuple[Start, tuple[Notice, ...]]:
    """Return the state that lasts at the first speed under the first torque, with a notice if time was too short for it."""
    rest = moving.at_rest()
    still = Start(coordinates=options.torque_from * rest.coordinates, rates=rest.rates)
    wanted = settling_time(moving.system, everywhere=bool(moving.ripples))
    longest = max(options.duration, _SETTLING_TEETH / quickest if quickest else 0.0)
    step = step_for(moving.system, quickest, longest / 200)
    lasts = min(wanted, longest, step * _MOST_STEPS / 4)
    count = max(math.ceil(lasts / step), 1)
    course = RunCourse(
        frequency=PiecewiseLine.level(frequency),
        torque=PiecewiseLine.level(options.torque_from),
        turns=-frequency * count * step,
    )
    start = moving.run(course, step, count, start=still).end
    if lasts >= wanted:
        return start, ()
    when = f"{wanted:.3g} s" if math.isfinite(wanted) else "for ever"
    text = f"had {lasts:.3g} s to settle before it began; without a push its vibrations would last {when}"
    return start, (Notice("not-settled", text),)


def _window_ends(frequency: PiecewiseLine, order: float, step: float, count: int) -> Wholes:
    """Return the steps (w,) before which windows end: a tooth of the first mesh, several, or a hundredth of all.

    Without a mesh a turn of the first inertia stands for a tooth.
    """
    size = 1 if count < 1_000_000 else count // 1_000_000
    at = np.arange(0, count + size, size).clip(max=count)
    teeth = np.abs(np.diff(order * frequency.integrals(step * at)))
    passed = np.concatenate([[0.0], np.cumsum(teeth)])
    per = max(1, math.ceil(passed[-1] / _MOST_WINDOWS))
    marks = np.searchsorted(passed, np.arange(per, passed[-1] + 1e-9, per))
    longest = max(1, math.ceil(count / _WINDOWS))
    edges = np.unique(np.concatenate([[0], at[marks.clip(max=len(at) - 1)], [count]]))
    parts = [np.linspace(a, b, -(-(b - a) // longest) + 1)[1:] for a, b in pairwise(edges.tolist())]
    ends = np.unique(np.round(np.concatenate(parts)).astype(np.int64))
    ends[-1] = count + 1
    return np.asarray(ends[ends > 0], np.int64)


def _result(
    moving: MovingSystem,
    excitation: Excitation,
    options: TransientOptions,
    motion: Motion,
    speed: PiecewiseLine,
    torque: PiecewiseLine,
    references: Floats | None,
    notices: tuple[Notice, ...],
) -> Transient:
    """Return the result in the units of the package (µm, degrees, rpm)."""
    system, static = moving.system, static_state(moving.system)
    forces = np.abs(system.stiffness * static.approach)
    torques = np.abs(static.others[system.torque_outputs]) if references is None else references
    windows = motion.step * np.minimum(np.append(0, motion.ends), motion.ends[-1] - 1)
    return Transient(
        options=options,
        names=system.names,
        static_forces=forces,
        shaft_references=torques,
        time=np.array(motion.time),
        speed=speed.values(motion.time),
        torque=torque.values(motion.time),
        approach=1e6 * motion.approach,
        force=np.array(motion.force),
        turn=np.degrees(motion.turns),
        shaft_torque=np.array(motion.shaft_torque),
        windows=windows,
        window_speed=speed.values((windows[1:] + windows[:-1]) / 2),
        factor=np.maximum(motion.crest, -motion.trough) / forces,
        parted=np.array(motion.parted) if excitation.parting else np.zeros_like(motion.parted),
        shaft_factor=_shaft_factors(motion, torques),
        step=motion.step,
        parting=excitation.parting,
        notices=tuple(each.within("transient") for each in notices),
    )


def _shaft_factors(motion: Motion, torques: Floats) -> Floats:
    """Return the greatest torques (w, s) in either sense, over their references; nan where there are none."""
    carried = np.nan_to_num(torques) > _NO_LOAD * np.nan_to_num(torques).max(initial=0.0)
    most = np.maximum(motion.shaft_most, -motion.shaft_least)
    return np.where(carried, most / np.where(carried, torques, 1.0), math.nan)
