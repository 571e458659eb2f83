"""Excitation of a train or pair: mesh stiffness over the teeth, transmission errors, backlash, and torques on inertias.

Inputs are in µm and degrees; solvers take SI units over the phase theta of the common period (rad). The phase of a mesh is in
radians, 2 pi over a tooth. Coefficients are those of sum_n c_n e^(i n phase), n from -count to count; those from 0 on are
given.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, ParameterError, plain_numbers, require_number
from gearcad.core.records import Complexes, Floats, Indices, PerGear
from gearcad.dynamics.trains.members import Inertia, StiffnessWave, ToothMesh, line_backlash, turning_pieces
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.tooth_deviations import (
    ErrorDistribution,
    PeriodicLine,
    ToothDeviations,
    TransmissionError,
    random_deviations,
    tooth_errors,
)
from gearcad.dynamics.trains.train import EngagedMesh, Train, TrainModel, require_known
from gearcad.geometry import GearPair, RackPair
from gearcad.mesh_cycle import MeshCycle
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances import flank_tolerances


class StiffnessShape(ABC):
    """Mesh stiffness over its mean, positive everywhere."""

    @abstractmethod
    def values(self, phase: ArrayLike) -> Floats:
        """Return the stiffness over its mean, at any phases (rad)."""

    @abstractmethod
    def coefficients(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1,)."""

    @property
    def jumps(self) -> Floats:
        """Phases from 0 to 2 pi where the stiffness jumps."""
        return np.zeros(0)


@dataclass(frozen=True, kw_only=True)
class CosineStiffness(StiffnessShape):
    """1 - variation cos(phase): the variation p of (2.8) of J. Osinski's paper."""

    variation: float

    def __post_init__(self) -> None:
        plain_numbers(self)
        # From 1 on the teeth would pull at some phase.
        require_number("variation", self.variation, at_least=0, below=1)

    def values(self, phase: ArrayLike) -> Floats:
        """Return the stiffness over its mean, at any phases (rad)."""
        return np.asarray(1 - self.variation * np.cos(phase), float)

    def coefficients(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1,)."""
        result = np.zeros(count + 1, complex)
        result[0] = 1
        result[1:2] = -self.variation / 2
        return result


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveStiffness(StiffnessShape):
    """Straight lines between corners, as in a PeriodicLine, of `stiffness` (n,) in any unit: it is divided by its mean."""

    phase: Floats
    stiffness: Floats

    def __post_init__(self) -> None:
        line = PeriodicLine(phase=self.phase, height=self.stiffness)
        if line.height.min() <= 0:
            raise ParameterError("stiffness", float(line.height.min()), "must be above 0 at every phase of the mesh")
        line = PeriodicLine(phase=line.phase, height=line.height / line.mean)
        object.__setattr__(self, "phase", line.phase)
        object.__setattr__(self, "stiffness", line.height)

    @cached_property
    def line(self) -> PeriodicLine:
        """Curve of the stiffness over its mean."""
        return PeriodicLine(phase=self.phase, height=self.stiffness)

    def values(self, phase: ArrayLike) -> Floats:
        """Return the stiffness over its mean, at any phases (rad)."""
        return self.line.values(phase)

    def coefficients(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1,), exactly those of the straight lines."""
        return self.line.coefficients(count)

    @property
    def jumps(self) -> Floats:
        """Phases from 0 to 2 pi where the stiffness jumps."""
        return self.line.jumps


def square_stiffness(contact_ratio: float, pair_ratio: float = 1.0) -> CurveStiffness:
    """Return the square wave of a contact ratio: from phase 0 on n + 1 pairs of teeth, for the rest of the tooth n pairs.

    n is the contact ratio rounded down, and the rest of the ratio is the part of a tooth with n + 1 pairs. `pair_ratio` is the
    stiffness of the pair that comes last over that of each of the others: 1 where all are alike.
    """
    require_number("contact_ratio", contact_ratio, at_least=1, at_most=10)
    require_number("pair_ratio", pair_ratio, above=0)
    fewer = int(contact_ratio)
    end = 2 * np.pi * (contact_ratio - fewer)
    more = fewer + (pair_ratio if end else 0.0)
    phase = np.array([0, end, end, 2 * np.pi])
    return CurveStiffness(phase=phase, stiffness=np.array([more, more, fewer, fewer], float))


def cycle_stiffness(cycle: MeshCycle, *, tangent: bool = True) -> CurveStiffness:
    """Return the stiffness curve of a MeshCycle; phase 0 is roll angle 0.

    Tangent stiffness is that of small vibrations about the load.
    """
    return CurveStiffness(phase=cycle_phase(cycle), stiffness=cycle.tangent_stiffness if tangent else cycle.mesh_stiffness)


def cycle_phase(cycle: MeshCycle) -> Floats:
    """Return the phases (n,) in rad of the roll angles of a MeshCycle, over exactly 2 pi."""
    phase = cycle.roll_angle * (2 * np.pi / cycle.pitch_angle)
    phase[-1] = phase[0] + 2 * np.pi
    return phase


_MICRO = 1e-6


@dataclass(frozen=True, kw_only=True)
class MeshExcitation:
    """Excitation of one mesh: shape of its stiffness, phase (deg, 360 a tooth), transmission error and backlash.

    `frequency_ratio` is its tooth frequency over that of the first mesh: z3/z2 for the second stage of a train. `backlash` (µm)
    is the clearance along the line of action between the flanks at the back: `None` where flanks never part (a linear mesh),
    `math.inf` where they part but never meet at the back.
    """

    stiffness: StiffnessShape
    phase: float = 0.0
    frequency_ratio: Fraction = Fraction(1)
    error: TransmissionError | None = None
    backlash: float | None = None

    def __post_init__(self) -> None:
        ratio = self.frequency_ratio
        if not isinstance(ratio, Fraction | int) or ratio <= 0:
            raise ParameterError("frequency_ratio", str(ratio), "must be a Fraction of tooth numbers above 0")
        plain_numbers(self)
        # A Fraction is exact: not one of the numbers that become floats.
        object.__setattr__(self, "frequency_ratio", Fraction(ratio))
        require_number("phase", self.phase, "deg")
        if self.backlash is not None and self.backlash != math.inf:
            require_number("backlash", self.backlash, "µm", at_least=0)

    @property
    def lead(self) -> float:
        """Phase of the mesh (rad)."""
        return math.radians(self.phase)


def cycle_excitation(
    cycle: MeshCycle, *, phase: float = 0.0, backlash: float | None = None, tangent: bool = True
) -> MeshExcitation:
    """Return the excitation of a MeshCycle; the mean stiffness of the mesh is its `tangent_mean` (or `mean`).

    The error is the loaded transmission error less F/k. So at rest under the torque of the cycle the flanks approach each other
    by just the cycle's transmission error, with modifications and nonlinear contact. Phase 0 is roll angle 0.
    """
    shape = cycle_stiffness(cycle, tangent=tangent)
    mean = cycle.tangent_mean if tangent else cycle.mean
    # Steps of the stiffness come again in it and take each other off where nothing vibrates: it must be as sharp as these.
    free = cycle.transmission_error - cycle.force / (mean * shape.stiffness)
    error = TransmissionError(line=PeriodicLine(phase=cycle_phase(cycle), height=free))
    return MeshExcitation(stiffness=shape, phase=phase, error=error, backlash=backlash)


@dataclass(frozen=True, kw_only=True)
class TorqueWave:
    """A harmonic torque on the inertia `inertia`: its coefficient (N·m) of e^(i phase), half the amplitude.

    `frequency_ratio` is its frequency over the tooth frequency of the first mesh, or over the frequency at which the first
    inertia turns where there is no mesh.
    """

    inertia: str
    frequency_ratio: Fraction
    coefficient: complex


@dataclass(frozen=True, kw_only=True)
class Excitation:
    """Excitation of all meshes of a system, in its order, and the `torques` that act on its inertias beside those at rest.

    `orders` says how many teeth of each mesh pass in the common period, after which torques come again too.
    """

    meshes: tuple[MeshExcitation, ...]
    torques: tuple[TorqueWave, ...] = ()

    def __post_init__(self) -> None:
        if not (self.meshes or self.torques):
            raise ParameterError("meshes", 0, "must be at least one mesh")
        # More teeth than this before everything comes again: the ratio is as good as irrational for a periodic solution.
        if max(self.orders, default=0) > 20_000:
            raise GeometryError(
                "frequency_ratio", max(self.orders), "must let all meshes come again within 20000 teeth", "teeth"
            )

    @cached_property
    def orders(self) -> tuple[int, ...]:
        """Tooth frequency of each mesh over the frequency of the common period."""
        return tuple(int(self._period * mesh.frequency_ratio) for mesh in self.meshes)

    @cached_property
    def torque_orders(self) -> tuple[int, ...]:
        """Frequency of each torque over the frequency of the common period."""
        return tuple(int(self._period * each.frequency_ratio) for each in self.torques)

    @property
    def highest(self) -> int:
        """Greatest order of the common period at which teeth come or a torque turns: steps in time must resolve it."""
        return max((*self.orders, *self.torque_orders))

    @cached_property
    def _period(self) -> Fraction:
        """Common period in teeth of the first mesh, or in turns of the first inertia where there is no mesh."""
        periods = [(mesh.error.teeth if mesh.error else 1) / mesh.frequency_ratio for mesh in self.meshes]
        periods += [1 / each.frequency_ratio for each in self.torques]
        return Fraction(math.lcm(*(each.numerator for each in periods)), math.gcd(*(each.denominator for each in periods)))

    @property
    def period(self) -> float:
        """Teeth of the first mesh that pass in the common period, or turns of the first inertia where there is no mesh."""
        return float(self.orders[0] if self.orders else self._period)

    @property
    def fundamental(self) -> float:
        """Frequency of the common period over the tooth frequency of the first mesh, or over that of a turn without a mesh."""
        return 1 / self.period

    def torque_vectors(self, system: System) -> tuple[Indices, Complexes]:
        """Return the orders (t,) of the common period, rising, at which torques act, and what the coordinates feel (t, n).

        Torques on inertias that the System does not have are left out.
        """
        names, felt = system.names[1], dict[int, Complexes]()
        for each, order in zip(self.torques, self.torque_orders, strict=True):
            if each.inertia in names:
                column: Complexes = np.asarray(each.coefficient * system.inertias[:, names.index(each.inertia)], complex)
                felt[order] = felt[order] + column if order in felt else column
        orders = sorted(felt)
        return np.array(orders, np.intp), np.array([felt[order] for order in orders], complex).reshape(-1, system.size)

    @property
    def parting(self) -> bool:
        """Whether flanks of any mesh may part."""
        return any(mesh.backlash is not None for mesh in self.meshes)

    @property
    def shakes(self) -> bool:
        """Whether a stiffness varies over the mesh cycle, or teeth have errors."""
        phases = 2 * np.pi * np.arange(1024) / 1024
        teeth = any(mesh.error is not None or np.ptp(mesh.stiffness.values(phases)) > 0 for mesh in self.meshes)
        return teeth or bool(self.torques)

    @property
    def bonded(self) -> Excitation:
        """Same excitation with flanks that never part."""
        return replace(self, meshes=tuple(replace(mesh, backlash=None) for mesh in self.meshes))

    def fits(self, system: System) -> None:
        """Raise ParameterError unless there is one mesh for each of the system's, of positive mean stiffness."""
        if len(self.meshes) != len(system.stiffness):
            raise ParameterError("meshes", len(self.meshes), f"must be as many as the system has: {len(system.stiffness)}")
        if not np.isfinite(system.stiffness).all() or system.stiffness.min(initial=np.inf) <= 0:
            raise ParameterError("mesh_stiffness", float(system.stiffness.min() * _MICRO), "must be above 0 N/µm", "N/µm")

    # ------------------------------------------------------------------ over the common period

    def ratios(self, theta: Floats) -> Floats:
        """Return the stiffness of each mesh over its mean (..., m) at phases of the common period (...)."""
        return np.stack([mesh.stiffness.values(q * theta + mesh.lead) for mesh, q in self._each()], axis=-1)

    def ratio_coefficients(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1, m) of the stiffness ratios over the common period."""
        result = np.zeros((count + 1, len(self.meshes)), complex)
        for j, (mesh, q) in enumerate(self._each()):
            own = mesh.stiffness.coefficients(count // q)
            result[: q * len(own) : q, j] = own * np.exp(1j * mesh.lead * np.arange(len(own)))
        return result

    def errors(self, theta: Floats) -> Floats:
        """Return the transmission error of each mesh (..., m) in m, at phases of the common period (...)."""
        return self._errors(theta, slopes=False)

    def error_course(self, count: int) -> Floats:
        """Return the transmission errors (count, m) in m at even steps over the common period.

        Much quicker than `errors` for errors of many teeth.
        """
        return self._course(count, slopes=False)

    def error_slope_course(self, count: int) -> Floats:
        """Return the derivatives of `error_course` with respect to theta (count, m), in m/rad."""
        return self._course(count, slopes=True)

    def _course(self, count: int, *, slopes: bool) -> Floats:
        theta = 2 * np.pi * np.arange(count) / count
        columns = np.zeros((count, len(self.meshes)))
        for j, (mesh, q) in enumerate(self._each()):
            if mesh.error is None:
                continue
            line, step = mesh.error.line, q // mesh.error.teeth
            # Orders that the steps cannot tell are left away.
            orders = np.arange(min(len(mesh.error.coefficients), (count // 2 - 1) // step + 1))
            waves = mesh.error.coefficients[: len(orders)] * np.exp(1j * mesh.lead * orders / mesh.error.teeth)
            spectrum = np.zeros(count // 2 + 1, complex)
            spectrum[step * orders] = waves * (1j * step * orders if slopes else 1.0)
            columns[:, j] = np.fft.irfft(spectrum, count, norm="forward")
            if line is not None:
                phase = q * theta + mesh.lead
                columns[:, j] += q * line.slopes(phase) if slopes else line.values(phase)
        return _MICRO * columns

    def error_slopes(self, theta: Floats) -> Floats:
        """Return the derivative of each transmission error with respect to theta (..., m), in m/rad."""
        return self._errors(theta, slopes=True)

    def error_coefficients(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1, m) of the transmission errors over the common period, in m."""
        result = np.zeros((count + 1, len(self.meshes)), complex)
        for j, (mesh, q) in enumerate(self._each()):
            if mesh.error is None:
                continue
            step = q // mesh.error.teeth
            own = mesh.error.orders(count // step)
            result[: step * len(own) : step, j] = _MICRO * own * np.exp(1j * mesh.lead * np.arange(len(own)) / mesh.error.teeth)
        return result

    @cached_property
    def backlashes(self) -> Floats:
        """Clearance at the back (m,) in m; nan for meshes whose flanks never part."""
        return np.array([math.nan if mesh.backlash is None else mesh.backlash * _MICRO for mesh in self.meshes])

    @cached_property
    def jumps(self) -> Floats:
        """Phases of the common period, from 0 to 2 pi, where the stiffness of any mesh jumps."""
        found = [
            np.mod((jump - mesh.lead + 2 * np.pi * np.arange(q)) / q, 2 * np.pi)
            for mesh, q in self._each()
            for jump in mesh.stiffness.jumps
        ]
        return np.unique(np.concatenate(found)) if found else np.zeros(0)

    def _each(self) -> list[tuple[MeshExcitation, int]]:
        return list(zip(self.meshes, self.orders, strict=True))

    def _errors(self, theta: Floats, *, slopes: bool) -> Floats:
        columns = []
        for mesh, q in self._each():
            if mesh.error is None:
                columns.append(np.zeros(np.shape(theta)))
                continue
            phase = q * theta + mesh.lead
            columns.append(_MICRO * (q * mesh.error.slopes(phase) if slopes else mesh.error.values(phase)))
        return np.stack(columns, axis=-1)


_PRESSURE_ANGLE = 20.0
"""Pressure angle (deg) of gears for which a train has only base radii and numbers of teeth."""

CONTACT_RATIO = 1.6
"""Contact ratio of such gears, where no square wave gives it."""

_HARMONICS = 12
"""Harmonics of the tooth frequency in the errors of teeth: they fall with the square, to thousandths of a step of one tooth."""


def train_excitation(
    train: Train,
    *,
    grade: int | None = None,
    seed: int = 0,
    distribution: ErrorDistribution = ErrorDistribution.UNIFORM,
) -> Excitation:
    """Return the excitation of a train: stiffness waves, backlashes and pitch deviations of its meshes.

    The deviations are random ones of an ISO 1328 `grade`, if it is given. A mesh of a pair has the course of its teeth, and
    their rating's grade in place of `grade`. The deviations are those of the pinions' teeth, drawn with `seed` where a mesh has
    none given. With the wheels' deviations the period would be that of both.
    """
    ratios = _tooth_ratios(train)
    meshes = []
    for number, (mesh, ratio) in enumerate(zip(train.meshes, ratios, strict=True)):
        require_known(mesh)
        if isinstance(mesh, EngagedMesh):
            errors = _errors_of_pair(mesh, seed + number, distribution) if mesh.pitch_deviations or grade is not None else None
            meshes.append(replace(_course_of_pair(mesh, errors), frequency_ratio=ratio))
            continue
        error = _mesh_errors(mesh, grade, seed + number, distribution) if mesh.pitch_deviations or grade is not None else None
        meshes.append(
            MeshExcitation(
                stiffness=_wave(mesh), phase=-360 * mesh.phase, frequency_ratio=ratio, error=error, backlash=mesh.backlash
            )
        )
    return Excitation(meshes=tuple(meshes), torques=train_torques(train))


def train_torques(train: Train) -> tuple[TorqueWave, ...]:
    """Return the torques that act on the inertias of a train beside those at rest."""
    if not train.excitations:
        return ()
    speeds, most = _exact_speeds(train)
    teeth = train.meshes[0].teeth if train.meshes else 1
    return tuple(
        TorqueWave(
            inertia=each.inertia,
            frequency_ratio=Fraction(abs(speeds[each.inertia])).limit_denominator(most) * harmonic.order / teeth,
            coefficient=harmonic.amplitude / 2,
        )
        for each in train.excitations
        for harmonic in each.harmonics
    )


def _course_of_pair(mesh: EngagedMesh, errors: TransmissionError | None) -> MeshExcitation:
    """Return the excitation of the pair's cycle, in the order of time, with the errors of its teeth."""
    found = cycle_excitation(mesh.course.in_time, phase=-360 * mesh.phase, backlash=mesh.backlash)
    assert found.error is not None and found.error.line is not None  # a cycle has one
    line = replace(found.error.line, height=found.error.line.height - mesh.course.offset)
    return replace(found, error=replace(errors or TransmissionError(), line=line))


def _errors_of_pair(mesh: EngagedMesh, seed: int, distribution: ErrorDistribution) -> TransmissionError:
    """Return the transmission error (µm) of the pinion's teeth: as given, or random by the pair's accuracy grade."""
    pair = mesh.teeth_of.mounted
    if mesh.pitch_deviations:
        return _given_errors(mesh.pitch_deviations, max(pair.transverse_contact_ratio, 1.001))
    return pair_errors(pair, mesh.teeth_of.rating, seed, distribution)


def _given_errors(deviations: tuple[float, ...], contact_ratio: float) -> TransmissionError:
    """Return the transmission error (µm) of pitch deviations (µm)."""
    return tooth_errors(given_deviations(deviations), contact_ratio=contact_ratio, harmonics=_HARMONICS)


def _wave(mesh: ToothMesh) -> StiffnessShape:
    if mesh.shape is StiffnessWave.COSINE:
        return CosineStiffness(variation=mesh.variation)
    assert mesh.contact_ratio is not None  # a square wave has one
    return square_stiffness(mesh.contact_ratio)


def _mesh_errors(mesh: ToothMesh, grade: int | None, seed: int, distribution: ErrorDistribution) -> TransmissionError:
    """Return the transmission error (µm) of the pinion's teeth: as given, or random by the accuracy `grade`.

    For random errors the gear is taken to have a pressure angle of 20 degrees.
    """
    if mesh.pitch_deviations:
        return _given_errors(mesh.pitch_deviations, mesh.contact_ratio or CONTACT_RATIO)
    assert grade is not None  # one of the two is there
    diameter = 2 * mesh.base_radii.pinion / math.cos(math.radians(_PRESSURE_ANGLE))
    tolerances = flank_tolerances(grade, diameter, diameter / mesh.teeth)
    ratio = mesh.contact_ratio or CONTACT_RATIO
    drawn = random_deviations(mesh.teeth, tolerances, seed, distribution=distribution)
    return tooth_errors(drawn, contact_ratio=ratio, harmonics=_HARMONICS)


def given_deviations(pitch_deviations: Sequence[float]) -> ToothDeviations:
    """Return the tooth deviations of pitch deviations f_pt (µm).

    Their mean is taken off: a rest after a full turn is not a pitch deviation.
    """
    pitches = np.array(pitch_deviations)
    return ToothDeviations(position=-np.cumsum(pitches - pitches.mean()))


def _tooth_ratios(train: Train) -> list[Fraction]:
    """Return the tooth frequency of every mesh over that of the first, by whole numbers of teeth: z3/z2 for a second stage."""
    speeds, most = _exact_speeds(train)
    return [
        Fraction(abs(speeds[mesh.pinion])).limit_denominator(most) * Fraction(mesh.teeth, train.meshes[0].teeth)
        for mesh in train.meshes
    ]


def _exact_speeds(train: Train) -> tuple[dict[str, float], int]:
    """Return speeds of inertias over that of the first pinion by whole numbers of teeth, and their greatest denominator."""
    whole = [wheel_teeth(mesh) for mesh in train.meshes]
    exact = [
        ToothMesh(
            name=mesh.name,
            pinion=mesh.pinion,
            wheel=mesh.wheel,
            base_radii=PerGear(float(mesh.teeth), float(wheel)),
            stiffness=float(mesh.stiffness),
            teeth=int(mesh.teeth),
            internal=mesh.internal,
        )
        for mesh, wheel in zip(train.meshes, whole, strict=True)
    ]
    (speeds,) = turning_pieces([inertia.name for inertia in train.inertias], train.shafts, exact)
    most = math.prod(mesh.teeth * wheel for mesh, wheel in zip(train.meshes, whole, strict=True))
    first = speeds[train.reference]
    return {name: speed / first for name, speed in speeds.items()}, most


def wheel_teeth(mesh: ToothMesh) -> int:
    """Return the wheel's number of teeth z_2 = z_1 r_b2/r_b1.

    Raises GeometryError where that is far from a whole number.
    """
    teeth = mesh.teeth * mesh.base_radii.wheel / mesh.base_radii.pinion
    if abs(teeth - round(teeth)) > 0.2 or round(teeth) < 1:
        permitted = f"must be in the ratio of whole numbers of teeth: with {mesh.teeth} of the pinion the wheel has {teeth:.3f}"
        raise GeometryError(f"{mesh.name}.base_radii", mesh.base_radii.wheel, permitted, "mm")
    return round(teeth)


def base_radii(pair: GearPair | RackPair) -> PerGear[float]:
    """Return the base radii (mm) of both gears; a rack counts as a wheel with that of its pinion."""
    if isinstance(pair, RackPair):
        return PerGear(pair.pinion.base_diameter / 2, pair.pinion.base_diameter / 2)
    return pair.gears.map(lambda gear: gear.base_diameter / 2)


def pair_train(
    pair: GearPair | RackPair, cycle: MeshCycle, inertias: PerGear[float], *, torque: float, speed: float, damping_ratio: float
) -> Train:
    """Return a pair by itself as a train with `inertias` (kg·m²), a `torque` (N·m) on it and a `speed` (rpm).

    The mesh has the mean tangent stiffness of the cycle and the backlash of the pair. A ring turns with its pinion, so the
    torque on it is negative. The inertia of a rack of the mass m is m r², at the pinion's reference circle: so it counts as a
    wheel with the pinion's base circle.
    """
    radii = base_radii(pair)
    return Train(
        name=pair.name,
        model=TrainModel.ISOLATED,
        inertias=tuple(Inertia(name=role.value, inertia=each) for role, each in inertias.items()),
        meshes=(
            ToothMesh(
                name="mesh",
                pinion="pinion",
                wheel="wheel",
                base_radii=radii.map(abs),
                stiffness=cycle.tangent_mean,
                teeth=pair.pinion.teeth,
                damping_ratio=damping_ratio,
                backlash=line_backlash(pair),
                internal=isinstance(pair, GearPair) and pair.internal,
            ),
        ),
        torques={"pinion": abs(torque), "wheel": abs(torque) * radii.wheel / radii.pinion},
        speed=abs(speed),
    )


def pair_excitation(train: Train, cycle: MeshCycle, errors: TransmissionError | None = None) -> Excitation:
    """Return the excitation of a pair: stiffness and transmission error of its cycle, with the errors of its teeth."""
    mesh = cycle_excitation(cycle, backlash=train.meshes[0].backlash)
    if errors is not None:
        assert mesh.error is not None  # a cycle has one
        mesh = replace(mesh, error=replace(errors, line=mesh.error.line))
    return Excitation(meshes=(mesh,))


def pair_errors(
    pair: GearPair | RackPair, rating: RatingOptions, seed: int, distribution: ErrorDistribution = ErrorDistribution.UNIFORM
) -> TransmissionError:
    """Return the transmission error (µm) of random deviations of the pinion's teeth, drawn with `seed`.

    The deviations are within the tolerances of the rating's accuracy grade.
    """
    gear = pair.pinion
    tolerances = flank_tolerances(rating.grade_of(gear), gear.reference_diameter, gear.normal_module, rating.accuracy)
    deviations = random_deviations(gear.teeth, tolerances, seed, distribution=distribution)
    return tooth_errors(deviations, contact_ratio=max(pair.transverse_contact_ratio, 1.001), harmonics=_HARMONICS)
