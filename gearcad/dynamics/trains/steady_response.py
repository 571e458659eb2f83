"""Periodic response of a System to forces at its meshes, as Fourier coefficients over the common period. SI units.

The modes of the shaft lines are uncoupled, so a flexibility is a sum over them; only the meshes at their mean stiffness couple
them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, SolverError
from gearcad.core.records import Bools, Complexes, Floats, Indices, Notice
from gearcad.dynamics.trains.shaft_lines import System

if TYPE_CHECKING:
    from gearcad.dynamics.trains.mesh_excitation import Excitation


class Direction(Enum):
    """Direction of the speed in a sweep."""

    UP = "up"
    DOWN = "down"


def runs(speeds: Floats, marked: Bools) -> list[Floats]:
    """Return the neighbouring speeds (s,) that are marked, one array for each run."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return [speeds[start:end] for start, end in edges.reshape(-1, 2)]


def frequency_ranges(frequencies: Floats, marked: Bools) -> str:
    """Return the ranges in which rising frequencies (s,) are marked, in words."""
    return ", ".join(f"{part[0]:g} to {part[-1]:g}" for part in runs(frequencies, marked))


class Unstable(Enum):
    """Kind of evidence that a motion is unstable; the values are the texts of the notice."""

    LINEAR = "parametric instability: vibrations grow without bound {where}; the periodic motion that is given does not last"
    PARTING = (
        "the periodic motion does not last {where}: what comes instead is not computed, and can be greater than what is given"
    )
    IN_TIME = (
        "the motion in time does not repeat {where}: what is given there is the greatest load of a long stretch, "
        "and a longer one can show a greater load"
    )


def instability(frequencies: Floats, stable: Bools, unstable: Unstable = Unstable.LINEAR) -> tuple[Notice, ...]:
    """Return a notice that motions do not last at some of the tooth frequencies (s,) in 1/s."""
    if stable.all():
        return ()
    ranges = [f"{part[0]:g}" if len(part) == 1 else f"{part[0]:g} to {part[-1]:g}" for part in runs(frequencies, ~stable)]
    return (Notice("unstable", unstable.value.format(where=f"at tooth frequencies (1/s) {', '.join(ranges)}")),)


def parting(frequencies: Floats, apart: Bools) -> Notice:
    """Return a notice that flanks pull at some of the tooth frequencies (s,) in 1/s, in a motion that lets them."""
    text = (
        f"flanks would part at tooth frequencies (1/s) {frequency_ranges(frequencies, apart)}: "
        "a sweep with backlash shows what happens there"
    )
    return Notice("flanks-would-part", text)


_LOSS = 1e-9
"""Least loss factor of a line's mode. It keeps the sum finite at the frequency of an undamped mode."""

_MOST_AMPLIFIED = 1e9
"""Deflection over the static one beyond which rounding decides: resonance without damping."""

_BALANCED, _ROUNDING = 1e-8, 1e-15
"""Part of the load that may be left for free turns; relative error of squares of natural frequencies, of the greatest."""

_NO_DAMPING = "no finite periodic motion: a harmonic of one of the frequencies meets a resonance without damping"


@dataclass(frozen=True, eq=False)
class StaticState:
    """State at rest under the mean load, with meshes at their mean stiffness.

    `modal` (n,) are the coordinates, `approach` (m,) those of the flanks, and `others` (o,) the outputs of the System.
    `unit_mesh` (m, m) and `unit_others` (o, m) are approaches and outputs per force at the meshes, without the load.
    """

    modal: Floats
    approach: Floats
    others: Floats
    unit_mesh: Floats
    unit_others: Floats


def static_state(system: System) -> StaticState:
    """Return the state at rest under the mean load.

    Raises GeometryError where a train that is free to turn has torques that do not balance, and SolverError where a negative
    stiffness leaves no stable state.
    """
    matrix = system.stiffness_matrix()
    values, vectors = np.linalg.eigh(matrix)
    limit = 1e-11 * max(values.max(), float(np.abs(matrix).max()))
    if values.min() < -limit:
        raise SolverError("the system has no stable state at rest: some stiffness is negative")
    free = values <= limit
    rest = vectors[:, free].T @ system.load
    # Free turns are known as well as they stand out from the softest elastic mode, beside stiff ones that rounding refers to.
    known = max(_BALANCED, _ROUNDING * values.max() / values[~free].min(initial=np.inf))
    if np.abs(rest).max(initial=0.0) > known * np.linalg.norm(system.load):
        part = float(np.linalg.norm(rest) / np.linalg.norm(system.load))
        raise GeometryError(
            "load", part, "is the part of the torques that would speed up a train which is free to turn: they must balance"
        )
    inverse = (vectors[:, ~free] / values[~free]) @ vectors[:, ~free].T
    rows = system.outputs
    modal, unit = inverse @ system.load, inverse @ system.mesh
    return StaticState(modal, system.mesh.T @ modal, rows.T @ modal, system.mesh.T @ unit, rows.T @ unit)


def senses(system: System) -> Floats:
    """Return (m,) 1 where the mean load presses the front flanks of a mesh, -1 where it presses those at the back.

    Backlash and separation are counted from the flanks that carry the load.
    """
    modal = np.linalg.lstsq(system.stiffness_matrix(), system.load, rcond=1e-11)[0]
    return np.where(system.mesh.T @ modal < 0, -1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Flexibility:
    """Per force along the line of action: `mesh` (..., m, m) approaches, `others` (..., o, m) outputs of the System."""

    mesh: Complexes
    others: Complexes


def flexibility(system: System, frequencies: Floats) -> Flexibility:
    """Return the flexibility at circular frequencies (...) other than 0 (1/s), with the meshes at their mean stiffness.

    With P = V^T a^-1 V of the lines alone, a = squares - w^2 + i w damping, and meshes K, that of the whole is P (1 + K P)^-1.
    Raises SolverError at a resonance without damping.
    """
    rows = system.outputs
    count, others = system.mesh.shape[1], rows.shape[1]
    w = frequencies[..., None]
    modes = system.squares - w**2 + 1j * w * system.damping
    least = _LOSS * (system.squares + w**2)
    modes = np.where(np.abs(modes) < least, modes + 1j * least, modes)
    products = np.hstack([system.mesh, rows])[:, :, None] * system.mesh[:, None, :]
    sums = ((1 / modes) @ products.reshape(system.size, -1)).reshape(*frequencies.shape, count + others, count)
    lines, rest = sums[..., :count, :], sums[..., count:, :]
    mesh = system.stiffness + 1j * w * system.mesh_damping
    try:
        inverse = np.linalg.inv(np.eye(count) + mesh[..., None] * lines)
        result = Flexibility(lines @ inverse, rest @ inverse)
    except np.linalg.LinAlgError:
        raise _undamped(system) from None
    if not np.abs(result.mesh).max(initial=0.0) * system.stiffness.max() < _MOST_AMPLIFIED:
        raise _undamped(system)
    return result


class UndampedError(SolverError):
    """A steady motion without a finite value: a resonance has no damping."""


def require_damping(system: System, excitation: Excitation) -> None:
    """Raise UndampedError if teeth shake a System without any damping."""
    if not (system.damping.any() or system.mesh_damping.any()) and excitation.shakes:
        raise _undamped(system)


def _undamped(system: System) -> UndampedError:
    """Return the error for a resonance without damping.

    It names the first mesh without damping, if there is one.
    """
    name = next((name for name, each in zip(system.names[0], system.mesh_damping, strict=True) if not each), None)
    if name is None:
        return UndampedError(_NO_DAMPING)
    return UndampedError(
        f"{name}.damping = 0 N·s/m: must be above 0, as damping or damping_ratio, or damp the shafts: {_NO_DAMPING}"
    )


class Outputs(NamedTuple):
    """Coefficients of turns (s, q, i) in rad, of shaft torques (s, q, n) in N·m, and of travels of the axes (s, q, t) in m."""

    turns: Complexes
    torques: Complexes
    travels: Complexes


class TorqueMotion(NamedTuple):
    """Motion of the mean system under the torques of an excitation, at those `rows` (t,) of the orders at which they act.

    Coefficients `approach` (s, t, m) of the flanks (m), and `others` (s, t, o) of the outputs of the System.
    """

    rows: Indices
    approach: Complexes
    others: Complexes


def torque_motion(system: System, excitation: Excitation, omega: Floats, orders: Indices) -> TorqueMotion:
    """Return the motion under the excitation's torques at fundamental frequencies omega (s,).

    `orders` (q,) rise from 0 on.
    With A = squares - w² + i w damping of the lines, V the meshes and K their complex stiffness it is
    z = A^-1 (B - V K y) with (1 + V^T A^-1 V K) y = V^T A^-1 B. Torques of other orders are left out. Raises UndampedError.
    """
    acting, vectors = excitation.torque_vectors(system)
    known = np.isin(acting, orders)
    rows, vectors = np.searchsorted(orders, acting[known]), vectors[known]
    meshes, others = system.mesh.shape[1], system.outputs.shape[1]
    if not len(rows):
        return TorqueMotion(rows, np.zeros((len(omega), 0, meshes), complex), np.zeros((len(omega), 0, others), complex))
    w = (omega[:, None] * acting[known])[..., None]
    modes = system.squares - w**2 + 1j * w * system.damping
    least = _LOSS * (system.squares + w**2)
    modes = np.where(np.abs(modes) < least, modes + 1j * least, modes)
    stiffness = system.stiffness + 1j * w * system.mesh_damping
    lines = np.einsum("nj,shn,nk->shjk", system.mesh, 1 / modes, system.mesh)
    try:
        free = ((vectors / modes) @ system.mesh)[..., None]
        approach = np.linalg.solve(np.eye(meshes) + lines * stiffness[..., None, :], free)[..., 0]
    except np.linalg.LinAlgError:
        raise _undamped(system) from None
    coordinates = (vectors - (stiffness * approach) @ system.mesh.T) / modes
    return TorqueMotion(rows, np.asarray(approach, complex), np.asarray(coordinates @ system.outputs, complex))


def outputs_of(system: System, static: StaticState, flexible: Flexibility, forces: Complexes, pushed: TorqueMotion) -> Outputs:
    """Return the outputs under forces (s, q, m) in N on the mean system, with the static ones in order 0.

    `pushed` is the motion under the torques of the excitation. The approach of the flanks is not among the outputs.
    """
    others = np.einsum("shij,shj->shi", flexible.others, forces)
    others[:, 0] += static.others
    others[:, pushed.rows] += pushed.others
    torques = system.torque_outputs
    return Outputs(others[..., : torques.start], others[..., torques], others[..., torques.stop :])


def at_orders(system: System, static: StaticState, omega: Floats, orders: Indices) -> Flexibility:
    """Return the flexibilities (s, q, ...) at the orders from 0 on of fundamental frequencies omega (s,)."""
    moving = flexibility(system, omega[:, None] * orders[1:])
    still = (np.broadcast_to(each, (len(omega), 1, *each.shape)) for each in (static.unit_mesh, static.unit_others))
    mesh, others = (np.concatenate(pair, axis=1) for pair in zip(still, (moving.mesh, moving.others), strict=True))
    return Flexibility(np.asarray(mesh, complex), np.asarray(others, complex))


def both_sides(coefficients: Complexes) -> Complexes:
    """Return the coefficients of all orders, -q ... q, from those of the orders from 0 on (s, q, ...).

    Those of a real course are conjugate.
    """
    return np.concatenate([coefficients[:, :0:-1].conj(), coefficients], axis=1)


@dataclass(frozen=True, eq=False)
class Driven:
    """A System under an Excitation of its meshes."""

    system: System
    excitation: Excitation

    @cached_property
    def static(self) -> StaticState:
        """State at rest under the mean load. Raises GeometryError and SolverError."""
        return static_state(self.system)

    def pushed(self, omega: Floats, orders: Indices) -> TorqueMotion:
        """Return the motion of the mean system under the excitation's torques; see `torque_motion`."""
        return torque_motion(self.system, self.excitation, omega, orders)

    @cached_property
    def senses(self) -> Floats:
        """Flanks (m,) that the mean load presses: 1 for those in front, -1 for those at the back."""
        return senses(self.system)

    @cached_property
    def scale(self) -> float:
        """Static deflection (m), the greatest of all meshes."""
        return float(np.abs(self.static.approach).max())


def pressed(gap: Floats, backlashes: Floats, senses: Floats) -> Floats:
    """Return the deflection g(y - e) in m of the flanks that carry the load (`senses`), or of those behind them.

    It is 0 where flanks part. A backlash of nan is that of flanks that never part.
    """
    back = np.minimum(senses * gap + np.where(np.isnan(backlashes), 0.0, backlashes), 0.0)
    return np.where(np.isnan(backlashes), gap, senses * (np.maximum(senses * gap, 0.0) + back))


@dataclass(frozen=True, kw_only=True, eq=False)
class PeriodicResponse(Driven):
    """Steady vibration at `frequencies` (s,): circular tooth frequencies of the first mesh in 1/s. All in SI units.

    Coefficients over the common period belong to the orders `harmonics` (q,), from 0 on: `approach_coefficients` (s, q, m) of
    the approach y of the flanks (m), `inertia_coefficients` (s, q, i) of turns (rad), `torque_coefficients` (s, q, n) of shaft
    torques (N·m), `travel_coefficients` (s, q, t) of axes on bearings (m). `stable` (s,): whether a small disturbance dies
    away. `jumps`: frequencies at which a sweep went over to another branch. `notices` say what to know before trusting it.
    """

    frequencies: Floats
    harmonics: Indices
    approach_coefficients: Complexes
    inertia_coefficients: Complexes
    torque_coefficients: Complexes
    travel_coefficients: Complexes
    stable: Bools
    jumps: Floats = field(default_factory=lambda: np.zeros(0))
    notices: tuple[Notice, ...] = ()

    @property
    def samples(self) -> int:
        """Number of samples over the common period that show the highest harmonic at least 16 times a wave."""
        return int(max(256, 2 ** int(np.ceil(np.log2(16 * max(int(self.harmonics[-1]), 1))))))

    def phases(self, count: int | None = None) -> Floats:
        """Return the phases of the common period (t,), in rad, at which the courses below are given."""
        return 2 * np.pi * np.arange(count or self.samples) / (count or self.samples)

    def approach(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the approaches y of the flanks (s, t, m) in m."""
        return self._course(self.approach_coefficients[which], count)

    def turns(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the turns of the inertias (s, t, i) in rad."""
        return self._course(self.inertia_coefficients[which], count)

    def shaft_torques(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the torques in the shafts (s, t, n) in N·m."""
        return self._course(self.torque_coefficients[which], count)

    def travels(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the travels of the axes (s, t, 2g) in m: of each, along the line of action and across it."""
        return self._course(self.travel_coefficients[which], count)

    def bearing_forces(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the forces of the axes on their bearings (s, t, 2g) in N, damping of the bearings included."""
        travels, bearings = self.travel_coefficients[which], self.system.bearings
        if bearings is None:
            return self._course(travels, count)
        speed = self.excitation.fundamental * self.frequencies[which]
        rates = travels * 1j * speed[:, None, None] * self.harmonics[:, None]
        return self._course(travels @ bearings.stiffness.T + rates @ bearings.damping.T, count)

    def spring_forces(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the forces k(t) g(y - e) (s, t, m) in N that the teeth carry, without damping."""
        return self.carried(self.approach(which, count))

    def carried(self, approach: Floats) -> Floats:
        """Return the spring forces (s, t, m) in N of approaches (s, t, m) in m over the common period."""
        theta = self.phases(approach.shape[1])
        gap = approach - self.excitation.error_course(len(theta))
        return self.excitation.ratios(theta) * self.system.stiffness * pressed(gap, self.excitation.backlashes, self.senses)

    def damping_forces(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Return the damping forces c (y' - e') (s, t, m) in N."""
        speed = self.excitation.fundamental * self.frequencies[which]
        slopes = self.approach_coefficients[which] * 1j * self.harmonics[:, None]
        rates = self._course(slopes, count) - self.excitation.error_slope_course(count or self.samples)
        return np.asarray(self.system.mesh_damping * speed[:, None, None] * rates, float)

    def _course(self, coefficients: Complexes, count: int | None) -> Floats:
        count = count or self.samples
        spectrum = np.zeros((coefficients.shape[0], count // 2 + 1, coefficients.shape[2]), complex)
        spectrum[:, self.harmonics] = coefficients
        return np.asarray(np.fft.irfft(spectrum * count, count, axis=1), float)
