"""A drive of two pairs by the equations of motion written out by hand: J phi'' = T - r F of every gear, integrated in time.

Nothing of the dynamics is used here: only the pairs' own mesh cycles under their torques, and numbers of the drive. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from gearcad import GearPair, Load
from gearcad.core.records import Floats
from gearcad.mesh_cycle import MeshCycle
from gearcad.stiffness.methods import METHODS


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Two pairs in a row on four inertias (kg·m²), a spring (N·m/rad) with a damper (N·m·s/rad) between their shafts.

    `mesh_dampers` in N·s/m, `torque` on the first pinion in N·m, `phases` in teeth, `clearances` in µm.
    """

    pairs: tuple[GearPair, GearPair]
    inertias: tuple[float, ...]
    spring: float
    damper: float
    mesh_dampers: tuple[float, float]
    torque: float
    phases: tuple[float, float]
    clearances: tuple[float, float]
    method: str = "potential-energy"

    @cached_property
    def ratios(self) -> tuple[float, float]:
        """Turns of each pinion per turn of its wheel."""
        first, second = (each.wheel.teeth / each.pinion.teeth for each in self.pairs)
        return first, second

    @cached_property
    def torques(self) -> tuple[float, float]:
        """On both pinions, by the lever."""
        return self.torque, self.torque * self.ratios[0]

    @cached_property
    def cycles(self) -> list[MeshCycle]:
        """Of both pairs under these."""
        return [METHODS[self.method](pair=of)(Load(torque=each)) for of, each in zip(self.pairs, self.torques, strict=True)]

    @cached_property
    def forces(self) -> Floats:
        """At rest in both meshes (N)."""
        return np.array([2000 * each / of.pinion.base_diameter for of, each in zip(self.pairs, self.torques, strict=True)])


class _Course:
    """Stiffness and free error of a cycle over time counted in teeth, with straight lines between its points."""

    def __init__(self, cycle: MeshCycle, phase: float) -> None:
        self.start = cycle.roll_angle[0] / cycle.pitch_angle + phase
        self.places = (cycle.roll_angle - cycle.roll_angle[0]) / cycle.pitch_angle
        self.stiffness = 1e6 * cycle.tangent_stiffness
        self.error = 1e-6 * (cycle.transmission_error - cycle.force / cycle.tangent_stiffness)
        self.jumps = np.unique(np.mod(self.places[np.flatnonzero(np.diff(self.places) == 0)] + self.start, 1.0))

    def at(self, teeth: float) -> tuple[float, float, float]:
        """Stiffness (N/m), error (m) and its slope (m per tooth)."""
        place = (teeth - self.start) % 1.0
        right = min(max(int(np.searchsorted(self.places, place, side="right")), 1), len(self.places) - 1)
        step = self.places[right] - self.places[right - 1]
        part = (place - self.places[right - 1]) / step
        rise = self.error[right] - self.error[right - 1]
        stiffness = self.stiffness[right - 1] + part * (self.stiffness[right] - self.stiffness[right - 1])
        return stiffness, self.error[right - 1] + part * rise, rise / step


@dataclass(frozen=True)
class ByHand:
    """The four equations of a drive at a speed (rpm).

    Angles count the way each gear turns, beside its mean turn: a pinion's closes the flanks, a wheel's opens them.
    """

    drive: Drive
    speed: float

    @cached_property
    def teeth_per_second(self) -> tuple[float, float]:
        first, second = self.drive.pairs
        return first.pinion.teeth * self.speed / 60, second.pinion.teeth * self.speed / 60 / self.drive.ratios[0]

    @cached_property
    def courses(self) -> list[_Course]:
        return [_Course(*each) for each in zip(self.drive.cycles, self.drive.phases, strict=True)]

    @cached_property
    def radii(self) -> list[tuple[float, float]]:
        """Base radii of the pinions and wheels (m)."""
        return [(of.pinion.base_diameter / 2000, of.wheel.base_diameter / 2000) for of in self.drive.pairs]

    def forces(self, time: float, phi: Floats, rate: Floats) -> list[tuple[float, float]]:
        """Of spring and damper of each mesh (N)."""
        found = []
        for stage, ((pinion, wheel), clearance) in enumerate(zip(self.radii, self.drive.clearances, strict=True)):
            frequency = self.teeth_per_second[stage]
            stiffness, error, slope = self.courses[stage].at(time * frequency)
            gap = pinion * phi[2 * stage] - wheel * phi[2 * stage + 1] - error
            closing = pinion * rate[2 * stage] - wheel * rate[2 * stage + 1] - slope * frequency
            spring = stiffness * (max(gap, 0.0) + min(gap + 1e-6 * clearance, 0.0))
            found.append((spring, self.drive.mesh_dampers[stage] * closing))
        return found

    def derivative(self, time: float, state: Floats) -> Floats:
        phi, rate, drive = state[:4], state[4:], self.drive
        torque = np.array([drive.torque, 0.0, 0.0, -drive.torques[1] * drive.ratios[1]])
        for stage, force in enumerate(map(sum, self.forces(time, phi, rate))):
            torque[2 * stage] -= self.radii[stage][0] * force
            torque[2 * stage + 1] += self.radii[stage][1] * force
        shaft = drive.spring * (phi[1] - phi[2]) + drive.damper * (rate[1] - rate[2])
        torque[1] -= shaft
        torque[2] += shaft
        return np.concatenate([rate, torque / drive.inertias])

    def run(self, state: Floats, times: Floats) -> Floats:
        """States (t, 8) at rising times (t,) from 0 on, from jump to jump of the stiffness."""
        end = float(times[-1])
        cuts = {0.0, end}
        for of, frequency in zip(self.courses, self.teeth_per_second, strict=True):
            every = (np.arange(-2, math.ceil(end * frequency) + 2)[:, None] + of.jumps).ravel() / frequency
            cuts |= {float(each) for each in every if 1e-9 * end < each < end * (1 - 1e-9)}
        rows: list[Floats] = []
        for begin, stop in pairwise(sorted(cuts)):
            inside = times[(times >= begin) & (times < stop)]
            edge = 1e-9 * (stop - begin)

            def rates(time: float, x: Floats, a: float = begin + edge, b: float = stop - edge) -> Floats:
                return self.derivative(min(max(time, a), b), x)

            told = np.append(inside, stop)
            found = solve_ivp(rates, (begin, stop), state, "DOP853", told, rtol=1e-8, atol=1e-12, max_step=(stop - begin) / 2)
            assert found.success
            rows.extend(found.y.T[:-1])
            state = found.y[:, -1]
        return np.array([*rows, state])
