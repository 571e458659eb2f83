"""Run up and run down of a train whose flanks part, integrated in time: the greatest loads over speed.

SI units; frequencies are circular tooth frequencies of the first mesh (1/s).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Floats, Indices
from gearcad.dynamics.response.harmonic_balance import Motions
from gearcad.dynamics.response.kv_chart import Extremes
from gearcad.dynamics.response.linear_response import UNSTABLE, growth
from gearcad.dynamics.response.speed_curves import BoundedExtremes, SpeedCurves
from gearcad.dynamics.time_domain.motion import (
    Motion,
    MovingSystem,
    PiecewiseLine,
    RunCourse,
    Start,
    settling_time,
    shaken_frequency,
)
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.steady_response import Direction, PeriodicResponse

_RUNG = 0.004
"""Relative distance of the speeds through which a run goes: a fifth of a resonance's width at a damping ratio of 0.01."""

_LOWEST = 1 / 30
"""Part of the highest natural frequency of the meshes at which runs begin, so that no first speed of a chart decides their
values.
"""

_PER_TOOTH, _PER_WAVE, _PHASE = 256, 80, 9.1
"""Steps over a tooth, and over a vibration: with the third over the root of the damping ratio a frequency is off by a fiftieth
of the half width of its resonance."""

_TEETH, _LEAST_PERIODS = 32, 4
"""Teeth, and common periods, over which loads are counted after a motion has settled."""

_SETTLES = 0.7
"""Settling times before loads are first counted; as many pass again until they repeat."""

_SAME, _MOST_HOLDS = 2e-4, 12
"""Relative difference of loads in two stretches of a motion that has settled; stretches after which none does repeat."""

_FINER = 4
"""Steps in place of one over which loads are told where a stiffness jumps: a crest at a jump lies between two steps."""

_UNSETTLED_TEETH = 512
"""Teeth over which the loads of a motion are counted that does not repeat."""

_LOOP, _TERM = 40e-9, 13e-9
"""Seconds that a step takes: for itself, and for each mode of each mesh. Measured on one core."""

_ROUNDS, _MOST_SECONDS = 5, 25.0
"""Two runs, each speed settled about twice; seconds beyond which no values are given."""


class _State(NamedTuple):
    """State of a run: `frequency` in 1/s, coordinates, and turns of the common period."""

    frequency: float
    start: Start
    turns: float


class TimeRun(NamedTuple):
    """A run in one direction: loads of the springs `most` (r, m) in N at the rungs, whether (r,) they are of a motion in time,
    and the state at each rung, None where flanks stay in contact."""

    direction: Direction
    most: Floats
    nonlinear: Bools
    states: tuple[_State | None, ...]


class _Stay(NamedTuple):
    """A `motion` at one frequency with `per` steps to a common period, its end, and whether its loads `repeat`."""

    end: _State
    motion: Motion
    per: int
    repeats: bool


@dataclass(frozen=True, eq=False)
class TimeRuns:
    """Runs of a System with parting flanks up to the frequency `last` (1/s). `linear` are its curves with flanks in contact."""

    linear: SpeedCurves
    excitation: Excitation
    last: float

    @cached_property
    def rungs(self) -> Floats:
        """Rising frequencies (r,) at fixed ratios to a natural frequency."""
        natural = shaken_frequency(self.linear.system)
        first, last = math.log(_LOWEST), math.log(max(self.last / natural, 1.01 * _LOWEST))
        places = np.arange(math.floor(first / _RUNG), math.ceil(last / _RUNG) + 1)
        return np.asarray(natural * np.exp(_RUNG * places), float)

    @cached_property
    def contact(self) -> tuple[BoundedExtremes, Bools]:
        """Loads at the rungs with flanks in contact, and whether (r,) these would part, or the motion does not last."""
        told = self.linear.told(self.rungs)[0].rising()
        return told, self.parts(told)

    def parts(self, told: BoundedExtremes) -> Bools:
        """Return whether (s,) flanks would part in linear motions, or these do not last or were not found."""
        found = np.asarray((told.least <= 0).any(axis=1) | ~np.isfinite(told.left_out), bool)
        rest = np.flatnonzero(~found)
        found[rest] = growth(self.linear.system, self.linear.excitation, told.frequencies[rest]) > UNSTABLE
        return found

    @cached_property
    def moving(self) -> MovingSystem:
        """The System, ready to run in time."""
        return MovingSystem.lumped(self.linear.system, self.excitation)

    @cached_property
    def settling(self) -> float:
        """Seconds after which a thousandth is left of a vibration."""
        return settling_time(self.linear.system)

    def reason(self, more: int) -> str:
        """Return why there is no run, "" if there is one; `more` is the number of speeds between the rungs."""
        if not math.isfinite(self.settling):
            return "without damping no motion settles"
        flagged = self.rungs[self.contact[1]]
        if not len(flagged):
            return ""
        each = [sum(self._counts(float(frequency))) for frequency in flagged]
        n, m = self.linear.system.mesh.shape
        seconds = _ROUNDS * (_LOOP + _TERM * n * m) * (sum(each) + more * float(np.mean(each)))
        if seconds <= _MOST_SECONDS:
            return ""
        return f"with so little damping, or so long a common period, the runs in time would take about {seconds:.0f} s"

    @cached_property
    def both(self) -> tuple[TimeRun, TimeRun]:
        """Runs up and down through all rungs. Raises SolverError."""
        return self._run(Direction.UP), self._run(Direction.DOWN)

    def _run(self, direction: Direction) -> TimeRun:
        told, flagged = self.contact
        order = range(len(self.rungs)) if direction is Direction.UP else range(len(self.rungs) - 1, -1, -1)
        most, nonlinear = np.array(told.most), np.zeros(len(self.rungs), bool)
        states: list[_State | None] = [None] * len(self.rungs)
        state, before = None, order[0]
        for k in order:
            if state is None and not flagged[k]:
                before = k
                continue
            begin = state or self._in_contact(float(self.rungs[before]), flagged=bool(flagged[before]))
            state, motion, *_ = self._go(begin, float(self.rungs[k]), sampled=False)
            touching = bool((motion.trough[1] > 0).all())
            if touching and not flagged[k]:
                state = None
            else:
                most[k], nonlinear[k], states[k] = motion.crest[1], True, state
            before = k
        return TimeRun(direction, most, nonlinear, tuple(states))

    def told(self, run: TimeRun, contact: BoundedExtremes, flagged: Bools) -> tuple[BoundedExtremes, Bools, Bools]:
        """Return loads (s,) in contact, or in time where the run has these or at those `flagged`; which are in time; and which
        are of a motion that repeats."""
        rows, parts = np.arange(len(contact.frequencies)), list[BoundedExtremes]()
        in_time, repeats = np.zeros(len(rows), bool), np.ones(len(rows), bool)
        for i, frequency in enumerate(contact.frequencies.tolist()):
            begin = self._before(run, frequency)
            if begin is None and not flagged[i]:
                continue
            begin = begin or self._in_contact(*self._beside(run, frequency))
            stay = self._go(begin, frequency, sampled=True)
            if begin.frequency != frequency and not flagged[i] and (stay.motion.trough[1] > 0).all():
                continue
            parts.append(self._extremes(stay.motion, frequency, stay.per))
            rows[i], in_time[i], repeats[i] = len(contact.frequencies) + len(parts) - 1, True, stay.repeats
        return (BoundedExtremes.joined(contact, *parts).at(rows) if parts else contact), in_time, repeats

    def _place(self, run: TimeRun, frequency: float) -> int:
        """Return the index of the rung that the run passes last before a frequency (1/s), or at it."""
        if run.direction is Direction.UP:
            return max(int(np.searchsorted(self.rungs, frequency, side="right")) - 1, 0)
        return min(int(np.searchsorted(self.rungs, frequency, side="left")), len(self.rungs) - 1)

    def _before(self, run: TimeRun, frequency: float) -> _State | None:
        return run.states[self._place(run, frequency)]

    def _beside(self, run: TimeRun, frequency: float) -> tuple[float, bool]:
        """Return the frequency (1/s) of the rung passed last, and whether flanks would part there."""
        place = self._place(run, frequency)
        return float(self.rungs[place]), bool(self.contact[1][place])

    def _in_contact(self, frequency: float, flagged: bool = False) -> _State:
        """Return the state of the linear motion at a frequency (1/s), or at rest if the frequency is `flagged`."""
        if flagged:
            return _State(frequency, self.moving.at_rest(), 0.0)
        omega = self.linear.excitation.fundamental * frequency
        orders = int(self.linear.orders(np.array([frequency]))[0])
        (motion,) = self.linear.balance(orders).solve(np.array([omega]))
        return _State(frequency, _start(self.linear, motion), 0.0)

    def _counts(self, frequency: float) -> tuple[int, int]:
        """Return the number of steps until a motion has settled, and of those over which loads are counted."""
        per, periods = self._steps(frequency)
        period = 2 * math.pi / (self.excitation.fundamental * frequency)
        return math.ceil(_SETTLES * self.settling / period) * per, periods * per

    def _steps(self, frequency: float) -> tuple[int, int]:
        """Return the number of steps to a common period, and of common periods over which loads are counted."""
        most = max(self.excitation.orders)
        per_wave = max(_PER_WAVE, _PHASE / math.sqrt(max(float(self.linear.modes.ratio.min(initial=1.0)), 1e-6)))
        waves = shaken_frequency(self.linear.system) / (self.excitation.fundamental * frequency)
        per = max(_PER_TOOTH * self.excitation.highest, math.ceil(per_wave * waves))
        return per, max(_LEAST_PERIODS, math.ceil(_TEETH / most))

    def _go(self, begin: _State, frequency: float, *, sampled: bool) -> _Stay:
        """Return the motion at a frequency (1/s) that a run reaches from a state, and whether it has settled.

        If it is `sampled` and does not settle, a longer stretch of it is returned.
        """
        per, _ = self._steps(frequency)
        settle, hold = self._counts(frequency)
        common = [self.excitation.fundamental * each / (2 * math.pi) for each in (begin.frequency, frequency)]
        step = 1 / (common[1] * per)
        course = RunCourse(
            frequency=PiecewiseLine(time=np.array([0.0, settle * step / 3]), value=np.array(common)),
            turns=begin.turns,
        )
        start = self.moving.run(course, step, settle, start=begin.start).end
        turns = (begin.turns + float(course.frequency.integrals(settle * step))) % 1.0
        steady, before = RunCourse(frequency=PiecewiseLine.level(common[1]), turns=turns), None
        repeats = False
        for _ in range(_MOST_HOLDS):
            # Whole periods: each stretch begins at the phase of the one before.
            motion = self.moving.run(steady, step, hold, stride=int(sampled), ends=(1, hold + 1), start=start)
            repeats = before is not None and np.allclose(motion.crest[1], before, rtol=_SAME, atol=0.0)
            if repeats:
                break
            before = motion.crest[1]
            start = self.moving.run(steady, step, -(-settle // per) * per, start=motion.end).end
        if sampled:
            finer = _FINER if len(self.excitation.jumps) else 1
            if not repeats:
                hold = max(hold, math.ceil(_UNSETTLED_TEETH / max(self.excitation.orders)) * per)
            if finer > 1 or not repeats:
                count = finer * hold
                motion = self.moving.run(
                    steady, step / finer, count, stride=finer, ends=(1, count + 1), start=motion.end if repeats else start
                )
        return _Stay(_State(frequency, motion.end, turns), motion, per, repeats)

    def response(self, frequency: float, orders: int) -> PeriodicResponse:
        """Return the motion that the run up shows at one frequency (1/s), by its orders of the common period.

        If the motion does not repeat, the periodic motion next to it is returned, which is not stable.
        """
        run = self.both[0]
        begin = self._before(run, frequency) or self._in_contact(*self._beside(run, frequency))
        end, motion, per, repeats = self._go(begin, frequency, sampled=True)
        periods = (len(motion.approach) - 1) // per
        spectrum = np.fft.rfft(motion.approach[:-1], axis=0, norm="forward")[::periods]
        shift = 2j * math.pi * end.turns * np.arange(len(spectrum))[:, None]
        known = (spectrum * np.exp(-shift))[: orders + 1]
        curves = SpeedCurves(self.linear.system, self.excitation, self.linear.harmonics, self.linear.idle)
        balance, omega = curves.balance(orders), np.array([self.excitation.fundamental * frequency])
        (found,) = balance.solve(omega, known[None])
        response = curves.response(found if found.solved.all() else balance.motions(omega, known[None]))
        return replace(response, stable=np.array([repeats]))

    def _extremes(self, motion: Motion, frequency: float, per: int) -> BoundedExtremes:
        """Return the extremes of the samples of a settled motion."""
        system, senses = self.linear.system, self.moving.senses
        signs = self.linear.references[1]
        torque, count = motion.shaft_torque[1:], len(motion.approach) - 1
        travels, bearing = motion.travels[1:], motion.travels[1:]
        if system.bearings is not None:
            bearing = travels @ system.bearings.stiffness.T + motion.travel_rates[1:] @ system.bearings.damping.T
        spectrum = 2 * np.abs(np.fft.rfft(motion.approach[1:], axis=0)) / count
        rows = self.linear.tracked * (count // per)
        lines = np.zeros((len(rows), spectrum.shape[1]))
        known = rows < len(spectrum)
        lines[known] = spectrum[rows[known]]
        found = Extremes(
            most=motion.crest[1][None],
            least=motion.trough[1][None],
            damped=motion.force_crest[1][None],
            torques=np.where(signs, torque * signs, np.abs(torque)).max(axis=0)[None],
            approaches=_both(senses * motion.approach[1:]),
            turns=_both(motion.turns[1:]),
            travels=_both(travels),
            bearings=_both(bearing),
            resultants=np.hypot(bearing[:, ::2], bearing[:, 1::2]).max(axis=0)[None],
            lines=lines[None],
        )
        return BoundedExtremes.of(found, np.array([frequency]), np.zeros(1))


def _both(course: Floats) -> Floats:
    """Return the greatest and least (1, 2, c) of a course (t, c)."""
    return np.stack([course.max(axis=0), course.min(axis=0)])[None]


def without_values(told: BoundedExtremes, rows: Indices) -> BoundedExtremes:
    """Return the loads with nan in some of the rows (x,)."""
    values = {name: np.array(value) for name, value in vars(told).items()}
    for name, value in values.items():
        if name not in ("frequencies", "left_out"):
            value[rows] = np.nan
        elif name == "left_out":
            value[rows] = 0.0
    return BoundedExtremes(**values)


def _start(curves: SpeedCurves, motion: Motions) -> Start:
    """Return the coordinates and rates (n,) at phase 0 of one linear motion."""
    system, omega = curves.system, float(motion.omega[0])
    forces = motion.forces[0] @ system.mesh.T
    acting, torques = curves.excitation.torque_vectors(system)
    forces[acting[acting < len(forces)]] += torques[acting < len(forces)]
    orders = omega * np.arange(1, len(forces))
    dynamic = (
        system.stiffness_matrix()
        - np.eye(system.size) * orders[:, None, None] ** 2
        + 1j * orders[:, None, None] * system.damping_matrix()
    )
    try:
        waves = np.linalg.solve(dynamic, forces[1:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        raise SolverError(
            "no finite periodic motion was found to start a run: choose another first speed or more damping"
        ) from None
    mean = curves.static.modal + np.linalg.pinv(system.stiffness_matrix(), rcond=1e-11) @ forces[0].real
    return Start(
        coordinates=mean + 2 * waves.real.sum(axis=0),
        rates=2 * (1j * orders[:, None] * waves).real.sum(axis=0),
    )
