"""Vibration in time, the witness of the harmonic balance: any excitation, run-ups, flanks that part and meet again.

SI units, frequencies circular (1/s).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, SolverError, require_number
from gearcad.core.records import Floats, Indices
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import Driven, pressed, static_state

_MOST_PIECES = 1_000_000


@dataclass(frozen=True, kw_only=True, eq=False)
class Transient(Driven):
    """The motion at `time` (t,) in s: `modal` (t, n) and `modal_speed` (t, n) are z and z' of the system.

    `phase` (t,) is that of the common period (rad), `frequency` (t,) the circular tooth frequency of the first mesh (1/s);
    `events` (e,) the times (s) at which flanks parted or met.
    """

    time: Floats
    phase: Floats
    frequency: Floats
    modal: Floats
    modal_speed: Floats
    events: Floats

    @property
    def approach(self) -> Floats:
        """y (t, m) in m."""
        return self.modal @ self.system.mesh

    @property
    def turns(self) -> Floats:
        """Turns of the inertias (t, i) in rad."""
        return self.modal @ self.system.inertias

    @property
    def shaft_torques(self) -> Floats:
        """(t, s) in N·m."""
        return self.modal @ self.system.shaft_torques

    @property
    def spring_forces(self) -> Floats:
        """k(t) g(y - e) (t, m) in N: what the teeth carry, without damping."""
        gap = self.approach - self.excitation.errors(self.phase)
        return (
            self.excitation.ratios(self.phase) * self.system.stiffness * pressed(gap, self.excitation.backlashes, self.senses)
        )

    @property
    def damping_forces(self) -> Floats:
        """c (y' - e') (t, m) in N."""
        rate = self.excitation.error_slopes(self.phase) * (self.excitation.fundamental * self.frequency)[:, None]
        return self.system.mesh_damping * (self.modal_speed @ self.system.mesh - rate)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Motion(Driven):
    """The equations on a stretch without jumps, each mesh in one state: 1 in contact, 0 apart, -1 in contact at the back."""

    start: float
    acceleration: float

    def phase(self, time: ArrayLike) -> Floats:
        """Of the common period, while the speed rises evenly."""
        t = np.asarray(time, float)
        return np.asarray(self.excitation.fundamental * (self.start * t + self.acceleration / 2 * t**2), float)

    def frequency(self, time: ArrayLike) -> Floats:
        """Circular tooth frequency of the first mesh."""
        return np.asarray(self.start + self.acceleration * np.asarray(time, float), float)

    def gaps(self, time: float, state: Floats) -> Floats:
        """y - e (m,), counted from the flanks that carry the load."""
        gaps = self.system.mesh.T @ state[: self.system.size] - self.excitation.errors(self.phase(time))
        return np.asarray(self.senses * gaps, float)

    def contact(self, gap: Floats) -> Indices:
        """State of each mesh at these gaps (m,)."""
        backlash = self.excitation.backlashes
        return np.where(np.isnan(backlash) | (gap > 0), 1, np.where(gap < -np.nan_to_num(backlash, posinf=np.inf), -1, 0))

    def rates(self, contact: Indices, inside: float) -> Callable[[float, Floats], Floats]:
        """d/dt of the state. `inside` is a time within the stretch, which says on which side of a jump its ends lie."""
        system, excitation, n = self.system, self.excitation, self.system.size
        back = np.where(contact < 0, self.senses * np.nan_to_num(excitation.backlashes, posinf=0.0), 0.0)
        touching = contact != 0
        still = all(mesh.error is None for mesh in excitation.meshes)

        def derivative(time: float, state: Floats) -> Floats:
            # A breath inside the stretch: at its ends the stiffness has the value of the stretch.
            phase = self.phase(time + 1e-9 * (inside - time))
            y, rate = system.mesh.T @ state[:n], system.mesh.T @ state[n:]
            if not still:
                y = y - excitation.errors(phase)
                rate = rate - excitation.error_slopes(phase) * excitation.fundamental * self.frequency(time)
            force = excitation.ratios(phase) * system.stiffness * touching * (y + back) + system.mesh_damping * rate
            speed = state[n:]
            return np.concatenate(
                [speed, system.load - system.squares * state[:n] - system.damping * speed - system.mesh @ force]
            )

        return derivative

    def partings(self, contact: Indices) -> list[Callable[[float, Floats], float]]:
        """Events that end a stretch: a gap leaves the range of its state."""
        events: list[Any] = []
        for j, (state, backlash) in enumerate(zip(contact, self.excitation.backlashes, strict=True)):
            if np.isnan(backlash):
                continue
            # Where the range ends, and whether the gap falls (-1) or rises (1) through it.
            ends = {1: [(0.0, -1)], 0: [(0.0, 1), (-backlash, -1)], -1: [(-backlash, 1)]}[int(state)]
            for level, way in ends:
                if np.isfinite(level):
                    events.append(_crossing(self, j, level, way))
        return events


def _crossing(motion: _Motion, mesh: int, level: float, way: int) -> Callable[[float, Floats], float]:
    def event(time: float, state: Floats) -> float:
        return float(motion.gaps(time, state)[mesh] - level)

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = way  # type: ignore[attr-defined]
    event.change = (mesh, {(0.0, -1): 0, (0.0, 1): 1}.get((level, way), -1 if way < 0 else 0))  # type: ignore[attr-defined]
    return event


def integrate(
    system: System,
    excitation: Excitation,
    frequency: float | tuple[float, float],
    duration: float,
    *,
    times: ArrayLike,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    tolerance: float = 1e-9,
) -> Transient:
    """Integrate over `duration` (s) from z and z' of `start` (at rest under the mean load, if not given) by DOP853.

    `frequency` is the circular tooth frequency of the first mesh (1/s), or those at the beginning and at the end of an even
    run-up; `times` (t,) in s are those of the result. The steps end where flanks part or meet and where the stiffness jumps,
    so no step goes over a kink. `tolerance` is relative, and absolute for deflections a thousandth of the static one.
    """
    excitation.fits(system)
    first, last = (frequency, frequency) if isinstance(frequency, int | float) else frequency
    for each in (first, last):
        require_number("frequency", each, "1/s", above=0)
    require_number("duration", duration, "s", above=0)
    require_number("tolerance", tolerance, above=1e-14, below=1e-2)
    wanted = np.array(times, float)
    if wanted.ndim != 1 or not wanted.size or (np.diff(wanted) <= 0).any() or wanted[0] < 0 or wanted[-1] > duration:
        raise ParameterError("times", f"{wanted.size} values", f"must rise, within 0 to {duration:g} s")
    motion = _Motion(system=system, excitation=excitation, start=first, acceleration=(last - first) / duration)
    if start is None:
        state = np.concatenate([static_state(system).modal, np.zeros(system.size)])
    else:
        state = np.concatenate([np.asarray(each, float) for each in start])
    if state.shape != (2 * system.size,) or not np.isfinite(state).all():
        raise ParameterError("start", f"{state.shape}", f"must be {system.size} deflections and {system.size} speeds")
    modal, events = _pieces(motion, state, duration, wanted, tolerance)
    return Transient(
        system=system,
        excitation=excitation,
        time=wanted,
        phase=motion.phase(wanted),
        frequency=motion.frequency(wanted),
        modal=modal[:, : system.size],
        modal_speed=modal[:, system.size :],
        events=events,
    )


def _pieces(motion: _Motion, state: Floats, duration: float, wanted: Floats, tolerance: float) -> tuple[Floats, Floats]:
    """States (t, 2n) at the wanted times, from stretch to stretch; and the times of the events."""
    from scipy.integrate import solve_ivp

    absolute = tolerance * _sizes(motion.system)
    stops = _jump_times(motion, duration)
    contact = motion.contact(motion.gaps(0.0, state))
    result, events, time = np.zeros((len(wanted), len(state))), [], 0.0
    for _ in range(_MOST_PIECES):
        end = stops[np.searchsorted(stops, time, side="right")]
        partings = motion.partings(contact)
        rates = motion.rates(contact, (time + end) / 2)
        solved = solve_ivp(
            rates, (time, end), state, "DOP853", rtol=tolerance, atol=absolute, events=partings, dense_output=True
        )
        if not solved.success or not np.isfinite(solved.y).all():
            raise SolverError(f"the time integration stopped at {solved.t[-1]:g} s: {solved.message}")
        reached = float(solved.t[-1])
        inside = (wanted >= time) & (wanted <= reached)
        if inside.any():
            result[inside] = solved.sol(wanted[inside]).T
        time, state = reached, solved.y[:, -1]
        for event, hits in zip(partings, solved.t_events or (), strict=True):
            if len(hits):
                mesh, contact[mesh] = event.change[0], event.change[1]  # type: ignore[attr-defined]
                events.append(reached)
        if time >= duration:
            return result, np.array(events)
    raise SolverError(f"flanks parted and met more than {_MOST_PIECES} times within {time:g} s")


def _sizes(system: System) -> Floats:
    """Deflections and speeds (2n,) a thousandth of those that the load makes at rest and would make in a vibration."""
    modal = np.abs(np.linalg.lstsq(system.stiffness_matrix(), system.load, rcond=1e-11)[0]).max()
    size = 1e-3 * (float(modal) or 1.0)
    return np.repeat([size, size * np.sqrt(np.diag(system.stiffness_matrix()).max())], system.size)


def _jump_times(motion: _Motion, duration: float) -> Floats:
    """Times (rising, the duration last) at which the stiffness of any mesh jumps."""
    turns = int(motion.phase(duration) / (2 * np.pi)) + 1
    phases = (motion.excitation.jumps + 2 * np.pi * np.arange(turns)[:, None]).ravel() / motion.excitation.fundamental
    root = np.sqrt(np.maximum(motion.start**2 + 2 * motion.acceleration * phases, 0.0))
    times = 2 * phases / (motion.start + root)
    return np.append(times[(times > 0) & (times < duration * (1 - 1e-12))], duration)
