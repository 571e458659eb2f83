"""Motion of a System in time under a course of speed and torque: steps, tooth springs, samples, greatest forces. SI units."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, SolverError, require_number, require_whole
from gearcad.core.records import Complexes, Floats, Indices, Wholes, freeze
from gearcad.dynamics.trains.mesh_excitation import Excitation, MeshExcitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import senses, static_state

if TYPE_CHECKING:
    from gearcad.dynamics.time_domain.motion_kernel import CourseTables, MotionModel, Records


@dataclass(frozen=True, kw_only=True, eq=False)
class PiecewiseLine:
    """Straight lines through `value` (k,) at `time` (k,) in s, level beyond its ends; it jumps where a time stands twice."""

    time: Floats
    value: Floats

    def __post_init__(self) -> None:
        time, value = np.atleast_1d(np.array(self.time, float)), np.atleast_1d(np.array(self.value, float))
        if time.ndim != 1 or time.shape != value.shape or not np.isfinite(time).all() or (np.diff(time) < 0).any():
            raise ParameterError("time", f"{time.shape}", "must rise, with one value each", "s")
        if not np.isfinite(value).all():
            raise ParameterError("value", "not finite", "must be finite numbers")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "value", value)

    @classmethod
    def level(cls, value: float) -> PiecewiseLine:
        """Return a line with the same value at all times."""
        return cls(time=np.zeros(1), value=np.array([value]))

    @property
    def sums(self) -> Floats:
        """Integrals (k,) from the first corner to each."""
        return np.concatenate([[0.0], np.cumsum(np.diff(self.time) * (self.value[1:] + self.value[:-1]) / 2)])

    def values(self, time: ArrayLike) -> Floats:
        """Return the values at any times (s); at a jump the value behind it."""
        which, after, slope = self._after(time)
        return np.asarray(self.value[which] + slope * after, float)

    def integrals(self, time: ArrayLike) -> Floats:
        """Return the integrals from the first corner to any times (s)."""
        which, after, slope = self._after(time)
        return np.asarray(self.sums[which] + after * (self.value[which] + slope * after / 2), float)

    def _after(self, time: ArrayLike) -> tuple[Indices, Floats, Floats]:
        """Return the corner before each time, the time since (s), and the slope there."""
        at, steps = np.asarray(time, float), np.diff(self.time)
        slopes = np.append(np.divide(np.diff(self.value), steps, out=np.zeros_like(steps), where=steps > 0), 0.0)
        which = np.maximum(np.searchsorted(self.time, at, side="right") - 1, 0)
        after = at - self.time[which]
        return which, after, np.where(after < 0, 0.0, slopes[which])


@dataclass(frozen=True, kw_only=True, eq=False)
class RunCourse:
    """`frequency` of the common period of all meshes (Hz), negative where they turn back; `torque` a factor of the load.

    `turns` of the common period have passed at the first corner of the frequency.
    """

    frequency: PiecewiseLine
    torque: PiecewiseLine = field(default_factory=lambda: PiecewiseLine.level(1.0))
    turns: float = 0.0

    @classmethod
    def steady(cls, frequency: float) -> RunCourse:
        """Return the course of one speed under the whole load; the frequency is that of the common period (Hz)."""
        return cls(frequency=PiecewiseLine.level(frequency))


PER_TOOTH, PER_WAVE = 256, 80
"""Steps over a tooth of the quickest mesh, and over a vibration on the springs of the teeth: frequencies are then good to
3e-4, as one step takes w h for w h (1 - (w h)²/24)."""

_SHARE = 0.02
"""Share of a mode's energy that the meshes must have for their forces to excite it: modes without are exact by any steps."""

_SETTLED = 7.0
"""Times of decay after which a thousandth is left."""


def step_for(system: System, tooth_frequency: float, longest: float) -> float:
    """Return the length of a step (s) for meshes with the given greatest tooth frequency (Hz); not longer than `longest`."""
    squares, _ = _shaken(system)
    own = math.sqrt(float(squares.max(initial=0.0)))
    steps = [longest]
    steps += [1 / (PER_TOOTH * tooth_frequency)] if tooth_frequency > 0 else []
    steps += [2 * math.pi / (PER_WAVE * own)] if own > 0 else []
    return min(steps)


def settling_time(system: System, *, everywhere: bool = False) -> float:
    """Return the time (s) after which a thousandth is left of vibrations that meshes shake; infinite without damping.

    With `everywhere` of all vibrations, as torques on inertias shake them.
    """
    squares, rates = _shaken(system, -1.0 if everywhere else _SHARE)
    if everywhere:
        squares, rates = (each[squares > _NO_SQUARE * squares.max()] for each in (squares, rates))
    slowest = float(np.minimum(rates, np.sqrt(squares)).min(initial=math.inf))
    return _SETTLED / slowest if slowest > 0 else math.inf


def shaken_frequency(system: System) -> float:
    """Return the highest natural frequency (1/s) of the modes that the meshes shake."""
    return math.sqrt(float(_shaken(system)[0].max(initial=0.0)))


def _shaken(system: System, share: float = _SHARE) -> tuple[Floats, Floats]:
    """Return squares (1/s²) and rates of decay (1/s) of the modes that the meshes shake, with the meshes at their mean.

    These have a `share` of their energy in the meshes at least.
    """
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    energy = ((modes.T @ system.mesh) ** 2 * system.stiffness).sum(axis=1)
    felt = energy > share * np.maximum(squares, 1e-9 * squares.max())
    rates = np.einsum("in,ij,jn->n", modes, system.damping_matrix(), modes) / 2
    return squares[felt], np.maximum(rates[felt], 0.0)


CELLS = 4096
"""Number of cells of even width in a table: of a tooth, or of the way of one tooth through the mesh."""

_PER_TOOTH = 1024
"""Samples of an error over a tooth: between them it runs straight."""

_MOST_SAMPLES = 4_000_000
"""Greatest number of samples of an error that comes again after thousands of teeth only."""

_MOST_TEETH = 10**9

_JUMP = 1e-6
"""Part of the greatest value above which a change at one place is a jump; less is the slope between its two sides."""

_MICRO = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringTable:
    """Stiffness (n,) in N/m and gap (n,) in m of the flanks of one tooth at its `place` (n,), in base pitches.

    Places rise; where one stands twice, the curves jump. Between them both are straight, and beyond the ends there is no
    spring. `opening`: the gap is one of flanks that stand apart on both sides of the tooth, as before its contact begins; else
    it is an error, that moves both flanks and is met by the damper as well. Raises ParameterError.
    """

    place: Floats
    stiffness: Floats
    gap: Floats
    opening: bool

    def __post_init__(self) -> None:
        place, stiffness, gap = (np.array(each, float) for each in (self.place, self.stiffness, self.gap))
        if place.ndim != 1 or len(place) < 2 or not place.shape == stiffness.shape == gap.shape:
            raise ParameterError("place", f"{place.shape}", "must be two or more, each with one stiffness and one gap")
        if not all(np.isfinite(each).all() for each in (place, stiffness, gap)):
            raise ParameterError("place", "not finite", "must be finite numbers, as stiffness and gap")
        if (np.diff(place) < 0).any() or place[-1] == place[0]:
            raise ParameterError("place", float(place[-1]), "must rise, in base pitches")
        if stiffness.min() < 0:
            raise ParameterError("stiffness", float(stiffness.min()), "must be at least 0 at every place", "N/m")
        for name, array in (("place", place), ("stiffness", stiffness), ("gap", gap)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @cached_property
    def cells(self) -> Floats:
        """Integrals, means and slopes (CELLS, 8) of the cells.

        The columns are the integral of the stiffness before each cell, its mean and slope there, the same three of stiffness
        times gap, error and its slope.
        """
        edges = np.linspace(self.place[0], self.place[-1], CELLS + 1)
        width = edges[1] - edges[0]
        found = np.zeros((CELLS, 8))
        for column, sums in zip((0, 3), self._sums(edges), strict=True):
            found[:, column], found[:, column + 1] = sums[:-1], np.diff(sums) / width
        inside = 1e-3 * width
        for column, values in ((2, self._stiffness), (5, lambda at: self._stiffness(at) * self._gap(at))):
            slope = (values(edges[1:] - inside) - values(edges[:-1] + inside)) / (width - 2 * inside)
            found[:, column] = np.where(self._broken(edges), 0.0, slope)
        if not self.opening:
            error = self._gap(edges)
            found[:, 6], found[:, 7] = error[:-1], np.diff(error) / width
        found.flags.writeable = False
        return found

    def _stiffness(self, at: Floats) -> Floats:
        return np.asarray(np.interp(at, self.place, self.stiffness), float)

    def _gap(self, at: Floats) -> Floats:
        return np.asarray(np.interp(at, self.place, self.gap), float)

    def _broken(self, edges: Floats) -> np.ndarray:
        """Return whether each cell has a jump inside or at an edge."""
        off = [np.abs(np.diff(each)) > _JUMP * np.abs(each).max() for each in (self.stiffness, self.gap)]
        jumps = self.place[1:][(np.diff(self.place) == 0) & (off[0] | off[1])]
        return np.asarray(np.searchsorted(jumps, edges[1:], "right") > np.searchsorted(jumps, edges[:-1]))

    def _sums(self, at: Floats) -> tuple[Floats, Floats]:
        """Return the exact integrals of stiffness, and of stiffness times gap, from the first place to those asked for."""
        steps = np.diff(self.place)
        safe = np.where(steps > 0, steps, 1.0)
        k, g = self.stiffness[:-1], self.gap[:-1]
        dk, dg = (np.where(steps > 0, np.diff(each) / safe, 0.0) for each in (self.stiffness, self.gap))

        def within(which: np.ndarray | slice, x: Floats) -> tuple[Floats, Floats]:
            one = x * (k[which] + dk[which] * x / 2)
            two = x * (
                k[which] * g[which] + x * ((k[which] * dg[which] + dk[which] * g[which]) / 2 + x * dk[which] * dg[which] / 3)
            )
            return one, two

        before = [np.concatenate([[0.0], np.cumsum(each)]) for each in within(slice(None), steps)]
        which = np.clip(np.searchsorted(self.place, at, side="right") - 1, 0, len(steps) - 1)
        one, two = within(which, at - self.place[which])
        return before[0][which] + one, before[1][which] + two


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshLaw:
    """One mesh: a spring for each pair of teeth, all by one table, and what is different from tooth to tooth.

    `order` teeth pass in the common period, `lead` base pitches early; tooth i is met at a place of `order` times the turns of
    the common period + `lead` - i. `position` (z,) in m and `slope` (z,) in m per base pitch from `middle` are more gap of the
    teeth, in turn. `error` (k,) in m, even samples over `error_teeth` base pitches, is what all flanks must approach first.
    `backlash` (m) is the clearance at the back: nan where flanks never part, inf where they never meet at the back. All of it
    is positive as the mean load presses the flanks.
    """

    table: SpringTable
    order: int = 1
    lead: float = 0.0
    position: Floats = field(default_factory=lambda: np.zeros(1))
    slope: Floats = field(default_factory=lambda: np.zeros(1))
    middle: float = 0.0
    error: Floats = field(default_factory=lambda: np.zeros(1))
    error_teeth: int = 1
    backlash: float = math.nan

    def __post_init__(self) -> None:
        require_whole("order", self.order, at_least=1, at_most=_MOST_TEETH)
        require_whole("error_teeth", self.error_teeth, at_least=1, at_most=_MOST_TEETH)
        for name in ("position", "slope", "error"):
            array = np.array(getattr(self, name), float)
            if array.ndim != 1 or not len(array) or not np.isfinite(array).all():
                raise ParameterError(name, f"{array.shape}", "must be finite numbers in a row", "m")
            object.__setattr__(self, name, array)
        if self.position.shape != self.slope.shape:
            raise ParameterError(
                "position", f"{self.position.shape}", f"must be one number per tooth, as slope {self.slope.shape}"
            )
        if not math.isnan(self.backlash) and self.backlash < 0:
            raise ParameterError("backlash", self.backlash, "must be at least 0, or nan for flanks that never part", "m")


def lumped_laws(excitation: Excitation, stiffness: Floats, senses: Floats) -> tuple[MeshLaw, ...]:
    """Return every mesh as one spring of varying stiffness, as in the harmonic balance; `stiffness` (m,) are the means in N/m.

    `senses` (m,) say which flanks the mean load presses.
    """
    return tuple(
        _lumped(mesh, order, float(k), float(sense))
        for mesh, order, k, sense in zip(excitation.meshes, excitation.orders, stiffness, senses, strict=True)
    )


def _lumped(mesh: MeshExcitation, order: int, stiffness: float, sense: float) -> MeshLaw:
    """Return the law of one mesh over one base pitch.

    What comes again with every tooth stands in the table, other errors in long rows.
    """
    line = None if mesh.error is None else mesh.error.line
    corners = [np.linspace(0, 2 * np.pi, CELLS + 1), mesh.stiffness.jumps, *([] if line is None else [line.phase, line.jumps])]
    phase = np.unique(np.concatenate([np.mod(each, 2 * np.pi) for each in corners] + [[0.0]]))
    # Both sides of every place: curves may jump there.
    phase = np.append(phase, 2 * np.pi)
    begin, end = phase[:-1], phase[1:]
    inside = 1e-9 * (end - begin)
    place = np.column_stack([begin, end]).ravel() / (2 * np.pi)
    at = np.column_stack([begin + inside, end - inside]).ravel()
    table = SpringTable(
        place=place,
        stiffness=stiffness * mesh.stiffness.values(at),
        gap=np.zeros(len(place)) if line is None else sense * _MICRO * line.values(at),
        opening=False,
    )
    error, teeth = _long_error(mesh, sense)
    backlash = math.nan if mesh.backlash is None else _MICRO * mesh.backlash
    return MeshLaw(table=table, order=order, lead=mesh.lead / (2 * np.pi), error=error, error_teeth=teeth, backlash=backlash)


def _long_error(mesh: MeshExcitation, sense: float) -> tuple[Floats, int]:
    """Return the error (m) that comes again with the gears, and the number of teeth after which it does."""
    if mesh.error is None or not mesh.error.coefficients.any():
        return np.zeros(1), 1
    own, teeth = mesh.error.coefficients, mesh.error.teeth
    count = max(min(_PER_TOOTH * teeth, _MOST_SAMPLES), 2 * len(own))
    spectrum = np.zeros(count // 2 + 1, complex)
    spectrum[: len(own)] = own
    return sense * _MICRO * np.fft.irfft(spectrum, count, norm="forward"), teeth


@dataclass(frozen=True, kw_only=True, eq=False)
class TorqueRipple:
    """Torque on one inertia beside that at rest: Re sum (`amplitude` e^(i 2 pi `order` turns)) of the common period, in N·m.

    `felt` (n,) is what the coordinates of a System feel of 1 N·m; `order` (h,) are whole numbers.
    """

    felt: Floats
    order: Wholes
    amplitude: Complexes

    @property
    def cycles(self) -> int:
        """Number of times that the torque comes again in the common period."""
        return int(np.gcd.reduce(self.order))

    def samples(self, count: int) -> Floats:
        """Return the torque (count,) in N·m at even steps of the part of the common period after which it comes again."""
        spectrum = np.zeros(count // 2 + 1, complex)
        np.add.at(spectrum, self.order // self.cycles, self.amplitude / 2)
        return np.asarray(np.fft.irfft(spectrum, count, norm="forward"), float)


_PER_RIPPLE, _LONGEST_RIPPLE = 2048, 2**20
"""Samples over the quickest wave of a torque - straight lines between them are off by a millionth - and greatest number."""


def ripples_of(system: System, excitation: Excitation) -> tuple[TorqueRipple, ...]:
    """Return the torques of an excitation on the inertias of a System, one for each of these."""
    names, found = system.names[1], []
    for name in dict.fromkeys(each.inertia for each in excitation.torques):
        own = [(q, each) for q, each in zip(excitation.torque_orders, excitation.torques, strict=True) if each.inertia == name]
        if name in names:
            order, amplitude = np.array([q for q, _ in own], np.int64), np.array([2 * each.coefficient for _, each in own])
            found.append(TorqueRipple(felt=system.inertias[:, names.index(name)], order=order, amplitude=amplitude))
    return tuple(found)


def _samples_of(ripples: tuple[TorqueRipple, ...]) -> Floats:
    """Return the samples (e, k) of torques, as many as the quickest wave of all asks for."""
    if not ripples:
        return np.zeros((0, 1))
    quickest = max(int(each.order.max()) // each.cycles for each in ripples)
    count = min(_PER_RIPPLE * 2 ** math.ceil(math.log2(quickest)), _LONGEST_RIPPLE)
    return np.array([each.samples(count) for each in ripples])


_NO_SQUARE = 1e-11
"""Part of the greatest square of a natural frequency below which a square is rounding."""

_CHUNK = 2_000_000
"""Number of steps between two reports of progress, at which a run can be stopped."""

_LONGEST = 1e6
"""Length (s) of a step if nothing turns."""

_FARTHEST, _ROUNDING = 1e12, 1e-9
"""Base pitches: of such a place a ten-thousandth is left; relative, of steps that are one base pitch."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Start:
    """Coordinates of a System (n,) and their rates (n,) at the beginning of a motion, or at its end."""

    coordinates: Floats
    rates: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """A motion by steps of `step` s: `time` (k,) of its samples in s, and what a run writes down at each.

    `approach` (k, m) of the flanks in m, `spring` (k, m) and `force` (k, m) in N, without and with that of the dampers; `turns`
    (k, i) of the inertias in rad and their rates `speeds` (k, i), `shaft_torque` (k, s) in N·m, `travels` (k, t) of axes in m
    and their rates `travel_rates` (k, t) in m/s.

    Of windows of steps that end before `ends` (w,): `crest`, `trough` (w, m), the most and the least that the springs of a mesh
    carry, as the load presses it, `force_crest` (w, m) with that of the damper, `parted` (w, m) the share of its steps in which
    no flanks press, `shaft_most` and `shaft_least` (w, s) in N·m. All steps are looked at, not only those of samples.

    `growth`, where asked for, is that of a small disturbance: its logarithm at the end, and the most by which it grew between
    any two times. `end` is where the motion stands at last.
    """

    step: float
    time: Floats
    approach: Floats
    spring: Floats
    force: Floats
    turns: Floats
    speeds: Floats
    shaft_torque: Floats
    travels: Floats
    travel_rates: Floats
    ends: Wholes
    crest: Floats
    trough: Floats
    force_crest: Floats
    parted: Floats
    shaft_most: Floats
    shaft_least: Floats
    growth: tuple[float, float]
    end: Start

    def __post_init__(self) -> None:
        freeze(self)


@dataclass(frozen=True, kw_only=True, eq=False)
class MovingSystem:
    """A System and the springs of its teeth, ready to be run in time.

    `senses` (m,): which flanks the mean load presses, 1 or -1. `driven` (n,): what its coordinates feel of a rising speed, for
    1/s more of the frequency of the common period in a second. `ripples`: torques beside those at rest. Raises GeometryError
    where the torques do not balance.
    """

    system: System
    laws: tuple[MeshLaw, ...]
    senses: Floats
    driven: Floats
    ripples: tuple[TorqueRipple, ...] = ()

    @classmethod
    def lumped(cls, system: System, excitation: Excitation, *, driven: Floats | None = None) -> MovingSystem:
        """Return the System with every mesh as one spring, as in the harmonic balance."""
        excitation.fits(system)
        pressed = senses(system)
        laws = lumped_laws(excitation, system.stiffness, pressed)
        felt = np.zeros(system.size) if driven is None else driven
        return cls(system=system, laws=laws, senses=pressed, driven=felt, ripples=ripples_of(system, excitation))

    @property
    def rows(self) -> int:
        """Number of turns, torques and travels in a sample."""
        return len(self._rows[0])

    def at_rest(self) -> Start:
        """Return the state at rest under the mean load, with the meshes at their mean stiffness."""
        return Start(coordinates=static_state(self.system).modal, rates=np.zeros(self.system.size))

    def run(
        self,
        course: RunCourse,
        step: float,
        count: int,
        *,
        stride: int = 0,
        ends: Sequence[int] | Wholes = (),
        start: Start | None = None,
        disturbed: bool = False,
        tell: Callable[[float], None] = lambda _part: None,
    ) -> Motion:
        """Return the motion over `count` steps from time 0 on.

        A sample is taken at time 0 and every `stride`-th step (0: none), windows reach up to rising `ends`. `tell` receives the
        part that is done, now and then. Raises ParameterError, and SolverError where forces of the meshes cannot be found or
        the motion grows beyond all numbers.
        """
        from gearcad.dynamics.time_domain.motion_kernel import MotionState, run

        require_number("step", step, "s", above=0, at_most=_LONGEST)
        require_whole("count", count, at_least=1, at_most=10**12)
        self._require_short(course, step, count)
        begin = start or self.at_rest()
        n, m = self.system.mesh.shape
        tables, bounds = self._course(course), np.array(ends, np.int64)
        size = n if disturbed else 0
        state = MotionState(
            np.array(begin.coordinates, float), np.array(begin.rates, float), np.zeros(m), *self._disturbance(size), np.zeros(3)
        )
        records = self._records(stride, count, bounds)
        for first in range(0, count, _CHUNK):
            steps = min(_CHUNK, count - first)
            made = run(self._model, tables, float(step), first, steps, state, _part(records, first))
            if made < steps:
                raise SolverError(
                    f"the forces of the meshes at {step * (first + made + 1):g} s were not found: take shorter steps"
                )
            if not np.isfinite(state.z).all():
                raise SolverError(
                    f"the motion grows without bound before {step * (first + steps):g} s: more damping limits it, or a "
                    "backlash, with which flanks part"
                )
            tell((first + steps) / count)
        return self._motion(step, bounds, count, state.growth, Start(coordinates=state.z, rates=state.v), records)

    def _require_short(self, course: RunCourse, step: float, count: int) -> None:
        """Raise ParameterError where more than a base pitch may pass in a step, or more in all than a place can tell."""
        order, line = max((law.order for law in self.laws), default=1), course.frequency
        fastest = order * float(np.abs(line.value).max())
        if fastest * step > 1 + _ROUNDING:
            permitted = f"must be at most {1 / fastest:.6g} s: one base pitch of the quickest mesh"
            raise ParameterError("step", step, permitted, "s")
        passed = order * abs(course.turns) + fastest * (step * (count + 1) + float(np.abs(line.time).max()))
        if not passed < _FARTHEST:
            permitted = f"must make of the course at most {_FARTHEST:.3g} base pitches of the quickest mesh, not {passed:.3g}"
            raise ParameterError("count", count, permitted)

    @cached_property
    def _scale(self) -> float:
        """A frequency (1/s) of the whole: the root of mesh stiffness over what moves with it."""
        return math.sqrt(float((self.system.mesh**2 @ self.system.stiffness).max()))

    @cached_property
    def _free(self) -> Floats:
        """Modes (n, r) that turn as a whole."""
        squares, modes = np.linalg.eigh(self.system.stiffness_matrix())
        result: Floats = modes[:, squares <= _NO_SQUARE * squares.max()]
        return result

    @cached_property
    def _rows(self) -> Floats:
        return self.system.outputs

    @cached_property
    def _model(self) -> MotionModel:
        from gearcad.dynamics.time_domain.motion_kernel import MotionModel

        of, laws = self.system, self.laws

        def flat(name: str) -> tuple[Floats, Wholes, Wholes]:
            """Return a quantity of all meshes in one row, where each mesh begins in it, and how many values each has."""
            counts = np.array([len(getattr(law, name)) for law in laws], np.int64)
            return np.concatenate([getattr(law, name) for law in laws] or [np.zeros(0)]), np.cumsum(counts) - counts, counts

        positions, starts, teeth = flat("position")
        errors, error_starts, error_counts = flat("error")
        marks = [
            (damping, law.backlash, law.table.opening, law.order, law.lead, law.table.place[0], law.table.place[-1], law.middle)
            for law, damping in zip(laws, of.mesh_damping, strict=True)
        ]
        teeth_of = [law.error_teeth for law in laws]
        return MotionModel(
            squares=_plain(of.squares),
            damping=_plain(of.damping),
            mesh=_plain(of.mesh * self.senses),
            load=_plain(of.load),
            driven=_plain(self.driven),
            marks=_plain(
                np.column_stack([np.array(marks, float).reshape(-1, 8), starts, teeth, error_starts, error_counts, teeth_of])
            ),
            tables=_plain(
                np.array([law.table.cells for law in laws]).reshape(len(laws), -1, 8) if laws else np.zeros((0, 1, 8))
            ),
            teeth=_plain(np.array([positions, flat("slope")[0]])),
            errors=_plain(errors),
            rows=_plain(self._rows),
            free=_plain(self._free),
            ripples=_plain(np.array([each.felt for each in self.ripples]).reshape(-1, of.size).T),
            waves=_plain(_samples_of(self.ripples)),
            cycles=np.array([each.cycles for each in self.ripples], float),
            scale=self._scale,
        )

    def _course(self, course: RunCourse) -> CourseTables:
        from gearcad.dynamics.time_domain.motion_kernel import CourseTables

        speed, torque = course.frequency, course.torque
        turns = np.array([speed.time, speed.value, course.turns + speed.sums])
        return CourseTables(_plain(turns), _plain(np.array([torque.time, torque.value, torque.sums])))

    def _disturbance(self, size: int) -> tuple[Floats, Floats, Floats]:
        """Return a small impulse on all meshes that causes no rotation of the whole."""
        push = (self.system.mesh * self.senses).sum(axis=1)[:size]
        return np.zeros(size), push / max(float(np.linalg.norm(push)), 1e-300), np.zeros(len(self.laws))

    def _records(self, stride: int, count: int, ends: Wholes) -> Records:
        from gearcad.dynamics.time_domain.motion_kernel import Records

        require_whole("stride", stride, at_least=0, at_most=10**12)
        if len(ends) and ((np.diff(ends) <= 0).any() or ends[0] < 1):
            raise ParameterError("ends", f"{len(ends)} values", "must rise, from 1 on")
        samples, meshes, rows = count // stride + 1 if stride else 0, len(self.laws), self._rows.shape[1]
        crests = np.full((len(ends), meshes, 3), -math.inf)
        crests[:, :, 1] = math.inf
        reach = np.full((len(ends), rows if len(ends) else 0, 2), -math.inf)
        reach[:, :, 1] = math.inf
        one, two, three = (np.empty((samples, meshes)) for _ in range(3))
        sums, rates = (np.empty((samples, rows)) for _ in range(2))
        return Records(max(stride, 1), one, two, three, sums, rates, ends, crests, np.zeros((len(ends), meshes)), reach)

    def _motion(
        self, step: float, ends: Wholes, count: int, growth: Floats, end: Start, records: Records
    ) -> Motion:  # fmt: skip
        samples, inertias, lengths = len(records.approach), self.system.inertias.shape[1], np.diff(np.append(0, ends))
        torques = self.system.torque_outputs
        if len(ends):
            # The last window counts the step at its end, and the first that at time 0.
            lengths = np.minimum(ends, count + 1) - np.append(0, ends)[:-1]
        return Motion(
            step=step,
            time=np.arange(samples, dtype=np.float64) * (step * records.stride),
            approach=records.approach * self.senses,
            spring=records.spring * self.senses,
            force=records.total * self.senses,
            turns=records.sums[:, :inertias],
            speeds=records.rates[:, :inertias],
            shaft_torque=records.sums[:, torques],
            travels=records.sums[:, torques.stop :],
            travel_rates=records.rates[:, torques.stop :],
            ends=ends,
            crest=records.crests[:, :, 0],
            trough=records.crests[:, :, 1],
            force_crest=records.crests[:, :, 2],
            parted=records.parted / np.maximum(lengths, 1)[:, None],
            shaft_most=records.reach[:, torques, 0],
            shaft_least=records.reach[:, torques, 1],
            growth=(float(growth[0]), float(growth[2])),
            end=end,
        )


def _plain(array: Floats) -> Floats:
    """Return the array as compiled code needs it: contiguous, of float64."""
    return np.ascontiguousarray(array, dtype=np.float64)


def _part(records: Records, first: int) -> Records:
    """Return the part of the records that is still to be written after `first` steps."""
    taken = first // records.stride + 1 if first else 0
    window = int(np.searchsorted(records.ends, first, side="right"))
    courses = [getattr(records, name)[taken:] for name in ("approach", "spring", "total", "sums", "rates")]
    windows = [getattr(records, name)[window:] for name in ("ends", "crests", "parted", "reach")]
    return records._replace(
        **dict(zip(("approach", "spring", "total", "sums", "rates"), courses, strict=True)),
        **dict(zip(("ends", "crests", "parted", "reach"), windows, strict=True)),
    )
