"""Study of K_v over speed with random tooth errors: many samples of a System, run up through the speeds in time. SI units."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from threading import Event
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.records import Bools, Floats, Notice
from gearcad.core.runtime import cores
from gearcad.dynamics.tooth_errors.error_result import ErrorStudy, ToothLaw
from gearcad.dynamics.tooth_errors.error_sources import (
    ErrorDraw,
    MeshTeeth,
    assumptions,
    repeated_teeth,
    single_pattern,
    smooth_pattern,
    with_short_period,
)
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import StaticState, senses, static_state
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution

if TYPE_CHECKING:
    from gearcad.dynamics.tooth_errors.error_kernel import Pattern, Samples, Steps


_PER_TOOTH, _PER_VIBRATION = 48, 24
"""Steps to a tooth, and to the quickest vibration of the teeth: some thousandths of K_v."""

_MOST_STEPS = 8192
"""Largest number of steps per tooth. At speeds that need more, vibrations of the teeth decay hundreds of times before the next
pair comes.
"""

_DECAYS, _DECAYS_FIRST = 3.5, 7.0
"""Times of decay that pass before a period is compared with the next, coming from the speed before, and from rest."""

_MOST_SETTLING, _MOST_TEETH = 2000, 1500
"""Teeth of the first mesh that pass before, and that are looked at, at the most."""

_SAME = 0.01
"""Largest relative difference of the greatest forces in two periods that follow each other, in a motion that has settled."""

_TOOTH_VIBRATION, _AFFECTED_TEETH = 0.02, 1e-3
"""Shares of a mode's potential energy in the meshes: above the first a vibration is one of the teeth, above the second it
affects the teeth.
"""

_WIDEST, _CHUNK = 128, 2_000_000
"""Samples side by side, and their steps between two looks at whether anybody wants to stop."""

_STEP, _TERM = 40e-9, 4e-9
"""CPU seconds that a step of a sample takes: for itself, and for each mode of each mesh."""

_GLANCE = 0.2
"""Seconds between two looks at how far the samples are."""

_PER_SMOOTH_TOOTH = 64
"""Places on a tooth at which a smooth error is known: five of its twelfth harmonic."""


class StudyRun(NamedTuple):
    """K_v `factors` (s, n, m) at s speeds of n samples, and whether the greatest force repeated, `settled` (s, n)."""

    factors: Floats
    settled: Bools


@dataclass(frozen=True, kw_only=True, eq=False)
class Sampling:
    """A System, the teeth of its meshes, and the law by which they carry. `excitation` is that of nominal teeth."""

    system: System
    excitation: Excitation
    teeth: tuple[MeshTeeth, ...]
    law: ToothLaw

    # ------------------------------------------------------------------ what does not depend on the speed

    @property
    def ratios(self) -> tuple[Fraction, ...]:
        """Tooth frequencies over that of the first mesh."""
        return tuple(mesh.frequency_ratio for mesh in self.excitation.meshes)

    @cached_property
    def static(self) -> StaticState:
        """State at rest. Raises GeometryError and SolverError."""
        return static_state(self.system)

    @cached_property
    def pressed(self) -> Floats:
        """Mesh matrix (n, m) of the System, in the direction in which the mean load presses the flanks."""
        return np.ascontiguousarray(self.system.mesh * senses(self.system))

    @cached_property
    def forces(self) -> Floats:
        """Mesh forces at rest (m,) in N."""
        return np.abs(self.system.stiffness * self.static.approach)

    @cached_property
    def _vibrations(self) -> tuple[Floats, Floats, Floats]:
        """Circular natural frequencies, rates of decay (1/s), and shares of the meshes in the potential energy, (r,) each."""
        squares, shapes = np.linalg.eigh(self.system.stiffness_matrix())
        elastic = squares > 1e-11 * squares.max()
        squares, shapes = squares[elastic], shapes[:, elastic]
        decay = np.einsum("ir,ij,jr->r", shapes, self.system.damping_matrix(), shapes) / 2
        share = ((self.system.mesh.T @ shapes) ** 2 * self.system.stiffness[:, None]).sum(axis=0) / squares
        return np.sqrt(squares), np.asarray(decay, float), np.asarray(share, float)

    @cached_property
    def quickest(self) -> float:
        """Circular frequency (1/s) of the quickest vibration of the teeth."""
        omega, _, share = self._vibrations
        return float(omega[share > _TOOTH_VIBRATION].max(initial=omega[share.argmax()]))

    @cached_property
    def decay(self) -> float:
        """Rate (1/s) of the slowest decay that teeth feel; 0 where something is not damped at all."""
        _, decay, share = self._vibrations
        return float(decay[share > _AFFECTED_TEETH].min())

    @cached_property
    def period(self) -> int:
        """Number of teeth of the first mesh that pass until all errors repeat."""
        return repeated_teeth(self.ratios, [each.period for each in self.teeth])

    @property
    def looked_at(self) -> int:
        """Number of teeth of the first mesh that are evaluated."""
        return min(self.period, _MOST_TEETH)

    @property
    def whole(self) -> bool:
        """Whether the evaluated teeth are the whole period."""
        return self.period <= _MOST_TEETH

    @property
    def hardly_damped(self) -> bool:
        """Whether vibrations outlast the longest settling time at the highest natural frequency of the teeth."""
        return self.decay * _MOST_SETTLING * 2 * math.pi < _DECAYS * self.quickest

    def per_tooth(self, frequency: float) -> int:
        """Return the number of steps to a tooth of the first mesh, at its tooth frequency (Hz)."""
        quickest = _PER_VIBRATION * self.quickest / (2 * math.pi * frequency)
        return math.ceil(max(_PER_TOOTH * float(max(self.ratios)), quickest))

    @property
    def lowest(self) -> float:
        """Lowest tooth frequency of the first mesh (Hz) that is evaluated."""
        return _PER_VIBRATION * self.quickest / (2 * math.pi * _MOST_STEPS)

    # ------------------------------------------------------------------ samples

    def run(self, frequencies: Floats, draws: Sequence[ErrorDraw | None], tell: Callable[[float], None]) -> StudyRun:
        """Run all samples up through rising tooth frequencies (Hz) of the first mesh, and return their K_v.

        A draw of None has no errors at all. Every sample runs up by itself: its result does not depend on the others. `tell` is
        called with the part of the work that is done.
        """
        width = min(_WIDEST, math.ceil(len(draws) / cores()))
        blocks = [draws[i : i + width] for i in range(0, len(draws), width)]
        stop, done = Event(), [0] * len(blocks)
        with ThreadPoolExecutor(min(cores(), len(blocks))) as pool:
            tasks = [pool.submit(self._block, frequencies, block, stop, done, i) for i, block in enumerate(blocks)]
            try:
                while wait(tasks, timeout=_GLANCE).not_done and not _failed(tasks):
                    tell(sum(done) / (len(blocks) * len(frequencies)))
                found = [task.result() for task in tasks]
            finally:
                stop.set()
        return StudyRun(*(np.concatenate(each, axis=1) for each in zip(*found, strict=True)))

    def _block(
        self, frequencies: Floats, draws: Sequence[ErrorDraw | None], stop: Event, done: list[int], place: int
    ) -> StudyRun:
        """Run some samples side by side and return their K_v."""
        samples, factors, settled = self._samples(draws), [], []
        for number, frequency in enumerate(frequencies.tolist()):
            if stop.is_set():
                break
            crest, same = self._speed(samples, frequency, _DECAYS if number else _DECAYS_FIRST, stop)
            factors.append((crest / self.forces[:, None]).T)
            settled.append(same)
            done[place] += 1
        return StudyRun(np.array(factors), np.array(settled))

    def _lengths(self, frequency: float, decays: float) -> tuple[int, int, int]:
        """Return the numbers of steps before loads are counted, of the first part of the period, and of the period."""
        per_tooth = self.per_tooth(frequency)
        period = self.looked_at * per_tooth
        wait_for = min(math.ceil(decays * frequency / max(self.decay, 1e-9)), _MOST_SETTLING) * per_tooth
        return wait_for, max(1, min(period, max(wait_for, 2 * repeated_teeth(self.ratios) * per_tooth))), period

    def seconds(self, frequencies: Floats, samples: int) -> float:
        """Return the CPU seconds that a run of so many samples takes at tooth frequencies (Hz) of the first mesh, about."""
        steps = sum(sum(self._lengths(frequency, _DECAYS)) for frequency in frequencies.tolist())
        return steps * samples * (_STEP + _TERM * self.system.mesh.size)

    def _speed(self, samples: Samples, frequency: float, decays: float, stop: Event) -> tuple[Floats, Bools]:
        """Return the greatest forces (m, n) in N over the period, and whether (n,) those of its first part repeat.

        All count as repeated where the period is not evaluated as a whole.
        """
        per_tooth = self.per_tooth(frequency)
        wait_for, length, period = self._lengths(frequency, decays)
        steps, pattern = self._steps(frequency, per_tooth), self._pattern(per_tooth, frequency)
        turns = np.array([float(ratio) / per_tooth for ratio in self.ratios])
        begin, crests = -wait_for, []
        for end in (0, length, period, period + length):
            crests.append(self._part(steps, pattern, samples, turns, (begin, end), stop))
            begin = end
        _, first, rest, again = crests
        if not self.whole:
            return np.maximum(first, rest), np.ones(first.shape[1], bool)
        same = np.abs(again - first) <= _SAME * np.maximum(again, self.forces[:, None])
        return np.maximum(again, rest), np.asarray(same.all(axis=0), bool)

    def _part(
        self, steps: Steps, pattern: Pattern, samples: Samples, turns: Floats, ends: tuple[int, int], stop: Event
    ) -> Floats:
        """Advance the samples over some steps and return the greatest forces (m, n) in N."""
        from gearcad.dynamics.tooth_errors.error_kernel import advance

        crests = np.full(samples.force.shape, -math.inf)
        chunk = max(1, _CHUNK // samples.force.shape[1])
        for begin in range(*ends, chunk):
            if stop.is_set():
                break
            advance(steps, pattern, samples, turns, begin, min(chunk, ends[1] - begin), crests)
        return crests

    def _steps(self, frequency: float, per_tooth: int) -> Steps:
        from gearcad.dynamics.time_domain.motion_kernel import propagators
        from gearcad.dynamics.tooth_errors.error_kernel import Steps

        time = 1 / (frequency * per_tooth)
        of = self.system
        backlash = self.excitation.backlashes
        if self.law is ToothLaw.SINGLE:
            backlash = np.where(np.isnan(backlash), np.inf, backlash)
        return Steps(
            time, propagators(of.squares, of.damping, time), self.pressed, of.load, np.asarray(of.mesh_damping, float), backlash
        )

    def _pattern(self, per_tooth: int, frequency: float) -> Pattern:
        if self.law is ToothLaw.SINGLE:
            return single_pattern([each.spring for each in self.teeth if each.spring is not None], self.ratios, per_tooth)
        return smooth_pattern(self.excitation.meshes, self.system.stiffness, senses(self.system), per_tooth, frequency)

    def _samples(self, draws: Sequence[ErrorDraw | None]) -> Samples:
        """Return the samples at rest, with their errors drawn."""
        from gearcad.dynamics.tooth_errors.error_kernel import Samples

        n, width, smooth = self.system.size, len(draws), self.law is ToothLaw.SMOOTH
        count = np.array([each.period for each in self.teeth])
        position, slope = (np.zeros((len(self.teeth), int(count.max()), width)) for _ in range(2))
        places = _PER_SMOOTH_TOOTH * int(count.max()) if smooth and any(not each.exact for each in self.teeth) else 0
        shift = np.zeros((len(self.teeth), places, width))
        for j, teeth in enumerate(self.teeth):
            for s, draw in enumerate(draws):
                if draw is None:
                    continue
                if smooth and teeth.exact:
                    continue
                if smooth:
                    shift[j, : _PER_SMOOTH_TOOTH * teeth.period, s] = self._shift(j, draw)
                else:
                    errors = teeth.pair_errors(draw)
                    position[j, : teeth.period, s], slope[j, : teeth.period, s] = errors.position, errors.slope
        z = np.repeat(self.static.modal[:, None], width, axis=1)
        force = np.repeat(self.forces[:, None], width, axis=1)
        push = self.system.load[:, None] - self.pressed @ force
        motion = (z, np.zeros((n, width)), push, force, force.copy(), force.copy())
        return Samples(position, slope, count, shift, _PER_SMOOTH_TOOTH, *motion)

    def _shift(self, j: int, draw: ErrorDraw) -> Floats:
        """Return the smooth error of mesh j (x,) in m, in the direction in which the load presses its flanks."""
        error, count = self.teeth[j].smooth_errors(draw), _PER_SMOOTH_TOOTH * self.teeth[j].period
        spectrum = np.zeros(count // 2 + 1, complex)
        own = error.coefficients * np.exp(
            1j * self.excitation.meshes[j].lead * np.arange(len(error.coefficients)) / error.teeth
        )
        spectrum[: len(own)] = own[: len(spectrum)]
        return np.asarray(1e-6 * senses(self.system)[j] * np.fft.irfft(spectrum, count, norm="forward"), float)


def _failed(tasks: Sequence[Future[StudyRun]]) -> bool:
    return any(task.done() and task.exception() is not None for task in tasks)


@dataclass(frozen=True, kw_only=True)
class ErrorPlan:
    """Plan for random tooth errors: `samples` of a `distribution` by a `seed`, for an accuracy `grade`; None for teeth without
    errors.
    """

    law: ToothLaw
    samples: int
    distribution: ErrorDistribution
    seed: int
    grade: int | None


def study_errors(
    system: System,
    excitation: Excitation,
    teeth: Sequence[MeshTeeth],
    speeds: Floats,
    pinion_teeth: int,
    plan: ErrorPlan,
    tell: Callable[[float], None] = lambda _part: None,
) -> ErrorStudy:
    """Return the study of K_v at rising speeds (s,) in rpm of the first pinion, which has `pinion_teeth` teeth.

    `excitation` is that of nominal teeth. `tell` is called with the part of the work that is done. Raises ParameterError where
    all speeds are too low, GeometryError and SolverError.
    """
    sampling, samples = _sampling(system, excitation, teeth, plan)
    draws: list[ErrorDraw | None] = [ErrorDraw(plan.distribution, plan.seed, number) for number in range(samples)]
    frequencies = speeds * pinion_teeth / 60
    quick = frequencies >= sampling.lowest
    if not quick.any():
        least = sampling.lowest * 60 / pinion_teeth
        permitted = (
            f"must be above {least:.4g} rpm: below, teeth ring out long before the next pair comes, and nothing is drawn"
        )
        raise ParameterError("speed_to", float(speeds[-1]), permitted, "rpm")
    found = sampling.run(frequencies[quick], [None, *draws], tell)
    return _study(sampling, plan, speeds[quick], found, (*_left_out(speeds[quick], speeds), *_assumed(sampling)))


def errors_seconds(
    system: System, excitation: Excitation, teeth: Sequence[MeshTeeth], speeds: Floats, pinion_teeth: int, plan: ErrorPlan
) -> float:
    """Return the CPU seconds that `study_errors` takes, about."""
    sampling, samples = _sampling(system, excitation, teeth, plan)
    frequencies = speeds * pinion_teeth / 60
    return sampling.seconds(frequencies[frequencies >= sampling.lowest], samples + 1)


def _sampling(system: System, excitation: Excitation, teeth: Sequence[MeshTeeth], plan: ErrorPlan) -> tuple[Sampling, int]:
    """Return the sampling and the number of samples: 1 where no teeth have errors, as all would be alike."""
    kept = with_short_period(teeth, [mesh.frequency_ratio for mesh in excitation.meshes])
    sampling = Sampling(system=system, excitation=excitation, teeth=kept, law=plan.law)
    return sampling, plan.samples if any(not each.exact for each in teeth) else 1


def _assumed(sampling: Sampling) -> tuple[Notice, ...]:
    law = assumptions(sampling.teeth, sampling.forces, sampling.excitation.backlashes)
    return (*law, *_hardly_damped(sampling))


def _study(sampling: Sampling, plan: ErrorPlan, speeds: Floats, found: StudyRun, assumed: tuple[Notice, ...]) -> ErrorStudy:
    """Return the study of a run, whose first sample is the one without errors."""
    return ErrorStudy(
        law=plan.law,
        speeds=speeds,
        factors=np.moveaxis(found.factors[:, 1:], 0, 1),
        nominal=found.factors[:, 0],
        settled=found.settled[:, 1:].T,
        nominal_settled=found.settled[:, 0],
        teeth=sampling.looked_at,
        whole=sampling.whole,
        grade=plan.grade,
        distribution=plan.distribution,
        seed=plan.seed,
        mesh_names=sampling.system.names[0],
        assumed=assumed,
    )


def _left_out(kept: Floats, asked: Floats) -> tuple[Notice, ...]:
    if len(kept) == len(asked):
        return ()
    text = (
        f"tooth errors were drawn from {kept[0]:.4g} rpm on: below, the vibration of the teeth would have to be followed"
        " hundreds of times from one pair to the next, and it has died away long before"
    )
    return (Notice("errors-from-speed", text),)


def _hardly_damped(sampling: Sampling) -> tuple[Notice, ...]:
    if not sampling.hardly_damped:
        return ()
    decay = "never" if sampling.decay <= 0 else f"only in {1 / sampling.decay:.3g} s, to a third,"
    text = (
        f"vibrations that the teeth feel die away {decay} longer than was waited for: with tooth errors the start is still seen"
    )
    return (Notice("errors-hardly-damped", text),)
