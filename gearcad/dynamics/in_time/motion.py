"""The motion of a System in time, by steps of one length: samples of it, greatest forces in windows of time. SI units."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats, Wholes, freeze
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.in_time.laws import MeshLaw, lumped_laws
from gearcad.dynamics.in_time.speed_course import Course
from gearcad.dynamics.response.flexibility import senses, static_state
from gearcad.dynamics.trains.system import System
from gearcad.errors import ParameterError, SolverError, require_number, require_whole

if TYPE_CHECKING:
    from gearcad.dynamics.in_time.kernel import CourseTables, Model, Records

__all__ = ["Motion", "MovingSystem", "Start"]

_NO_SQUARE = 1e-11
"""Of the greatest square of a natural frequency: rounding."""

_CHUNK = 2_000_000
"""Steps between two looks at whether anybody wants to stop."""

_LONGEST = 1e6
"""Seconds of a step, where nothing turns."""

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
    1/s more of the frequency of the common period in a second. Raises GeometryError where the torques do not balance.
    """

    system: System
    laws: tuple[MeshLaw, ...]
    senses: Floats
    driven: Floats

    @classmethod
    def lumped(cls, system: System, excitation: Excitation, *, driven: Floats | None = None) -> MovingSystem:
        """Every mesh as one spring, as in the harmonic balance."""
        excitation.fits(system)
        pressed = senses(system)
        laws = lumped_laws(excitation, system.stiffness, pressed)
        return cls(system=system, laws=laws, senses=pressed, driven=np.zeros(system.size) if driven is None else driven)

    @property
    def rows(self) -> int:
        """How many turns and torques a sample has."""
        return len(self._rows[0])

    def at_rest(self) -> Start:
        """Under the mean load, with the meshes at their mean stiffness."""
        return Start(coordinates=static_state(self.system).modal, rates=np.zeros(self.system.size))

    def run(
        self,
        course: Course,
        step: float,
        count: int,
        *,
        stride: int = 0,
        ends: Sequence[int] | Wholes = (),
        start: Start | None = None,
        disturbed: bool = False,
        tell: Callable[[float], None] = lambda _part: None,
    ) -> Motion:
        """`count` steps from time 0 on, a sample at every `stride`-th (0: none) and at time 0, windows up to rising `ends`.

        `tell` hears of the part that is done, now and then. Raises ParameterError, and SolverError where forces of the meshes
        cannot be found or the motion grows beyond all numbers.
        """
        from gearcad.dynamics.in_time.kernel import State, run

        require_number("step", step, "s", above=0, at_most=_LONGEST)
        require_whole("count", count, at_least=1, at_most=10**12)
        self._require_short(course, step, count)
        begin = start or self.at_rest()
        n, m = self.system.mesh.shape
        tables, bounds = self._course(course), np.array(ends, np.int64)
        size = n if disturbed else 0
        state = State(
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
                raise SolverError(f"the motion grows beyond all numbers before {step * (first + steps):g} s")
            tell((first + steps) / count)
        return self._motion(step, bounds, count, state.growth, Start(coordinates=state.z, rates=state.v), records)

    def _require_short(self, course: Course, step: float, count: int) -> None:
        """Raise ParameterError where more than a base pitch may pass in a step, or more in all than a place can tell."""
        order, line = max(law.order for law in self.laws), course.frequency
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
        """(n, r): what turns as a whole."""
        squares, modes = np.linalg.eigh(self.system.stiffness_matrix())
        result: Floats = modes[:, squares <= _NO_SQUARE * squares.max()]
        return result

    @cached_property
    def _rows(self) -> Floats:
        return self.system.outputs

    @cached_property
    def _model(self) -> Model:
        from gearcad.dynamics.in_time.kernel import Model

        of, laws = self.system, self.laws

        def flat(name: str) -> tuple[Floats, Wholes, Wholes]:
            """What all meshes have of it, where each begins, and how many it has."""
            counts = np.array([len(getattr(law, name)) for law in laws], np.int64)
            return np.concatenate([getattr(law, name) for law in laws]), np.cumsum(counts) - counts, counts

        positions, starts, teeth = flat("position")
        errors, error_starts, error_counts = flat("error")
        marks = [
            (damping, law.backlash, law.table.opening, law.order, law.lead, law.table.place[0], law.table.place[-1], law.middle)
            for law, damping in zip(laws, of.mesh_damping, strict=True)
        ]
        teeth_of = [law.error_teeth for law in laws]
        return Model(
            squares=_plain(of.squares),
            damping=_plain(of.damping),
            mesh=_plain(of.mesh * self.senses),
            load=_plain(of.load),
            driven=_plain(self.driven),
            marks=_plain(np.column_stack([np.array(marks, float), starts, teeth, error_starts, error_counts, teeth_of])),
            tables=_plain(np.array([law.table.cells for law in laws])),
            teeth=_plain(np.array([positions, flat("slope")[0]])),
            errors=_plain(errors),
            rows=_plain(self._rows),
            free=_plain(self._free),
            scale=self._scale,
        )

    def _course(self, course: Course) -> CourseTables:
        from gearcad.dynamics.in_time.kernel import CourseTables

        speed, torque = course.frequency, course.torque
        turns = np.array([speed.time, speed.value, course.turns + speed.sums])
        return CourseTables(_plain(turns), _plain(np.array([torque.time, torque.value, torque.sums])))

    def _disturbance(self, size: int) -> tuple[Floats, Floats, Floats]:
        """A push on all meshes: it turns nothing as a whole."""
        push = (self.system.mesh * self.senses).sum(axis=1)[:size]
        return np.zeros(size), push / max(float(np.linalg.norm(push)), 1e-300), np.zeros(len(self.laws))

    def _records(self, stride: int, count: int, ends: Wholes) -> Records:
        from gearcad.dynamics.in_time.kernel import Records

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
    """As the compiled code knows it."""
    return np.ascontiguousarray(array, dtype=np.float64)


def _part(records: Records, first: int) -> Records:
    """What is still to be written down after so many steps."""
    taken = first // records.stride + 1 if first else 0
    window = int(np.searchsorted(records.ends, first, side="right"))
    courses = [getattr(records, name)[taken:] for name in ("approach", "spring", "total", "sums", "rates")]
    windows = [getattr(records, name)[window:] for name in ("ends", "crests", "parted", "reach")]
    return records._replace(
        **dict(zip(("approach", "spring", "total", "sums", "rates"), courses, strict=True)),
        **dict(zip(("ends", "crests", "parted", "reach"), windows, strict=True)),
    )
