"""Two gears as free bodies in a plane: Newton's equations from forces and moments as vectors, integrated by scipy. SI units.

Nothing of this knows the equations of the package: how far flanks approach each other is found from the material points at the
pitch point, what turns a gear from the moment of the force there about its axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp

from gearcad.core.records import Floats
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings


@dataclass(frozen=True)
class Period:
    """One tooth period: forces (t,) of the spring and of spring and damper, approach (t,), turns (2, t), forces on the bearings
    of both gears (2, 2, t) in x and y."""

    spring: Floats
    force: Floats
    approach: Floats
    turns: Floats
    bearings: Floats


@dataclass(frozen=True)
class FreeBodies:
    """The pair at a circular tooth frequency (1/s), its stiffness k (1 - variation cos); a backlash (m) lets flanks part."""

    pair: PairOnBearings
    frequency: float
    variation: float
    backlash: float | None = None

    @cached_property
    def push(self) -> Floats:
        """Where the flank of the pinion, which turns counter-clockwise, presses: up, and away from its own axis."""
        angle = math.radians(self.pair.working_transverse_pressure_angle)
        return np.array([math.sin(angle), math.cos(angle)])

    @cached_property
    def arms(self) -> list[Floats]:
        """From the axis of each gear to the pitch point: a wheel stands beyond it, a ring has it on the same side."""
        across = math.cos(math.radians(self.pair.working_transverse_pressure_angle))
        first, second = (radius / 1000 / across for radius in self.pair.base_radii)
        return [np.array([first, 0.0]), np.array([-second, 0.0])]

    def contact(self, time: Floats, state: Floats) -> tuple[Floats, Floats, Floats]:
        """Approach, force of the spring and of spring and damper, at states (12, ...)."""
        first, second = self.arms
        place, speed = (
            self.push @ _point(half[:3], first) - self.push @ _point(half[3:], second) for half in (state[:6], state[6:])
        )
        pressed = place if self.backlash is None else np.maximum(place, 0) + np.minimum(place + self.backlash, 0)
        spring = 1e6 * self.pair.mesh_stiffness * (1 - self.variation * np.cos(self.frequency * time)) * pressed
        return place, spring, spring + self.pair.mesh_damping * speed

    def bearing_forces(self, state: Floats) -> list[Floats]:
        """On the bearings of both gears (2, ...)."""
        return [
            (1e6 * np.array(stiffness) * state[at : at + 2].T + self.pair.bearing_damping * state[at + 6 : at + 8].T).T
            for at, stiffness in zip((0, 3), self.pair.bearing_stiffness, strict=True)
        ]

    def rates(self, time: float, state: Floats) -> Floats:
        """Of states (12, n): places of the first gear, of the second, and their speeds."""
        force = np.multiply.outer(self.push, self.contact(np.asarray(time), state)[2])
        at_rest = -self.pair.torque / _moment(self.arms[0], -self.push)
        moments = [self.pair.torque, -at_rest * _moment(self.arms[1], self.push)]
        result = [state[6:]]
        for gear, (sign, at_bearing) in enumerate(zip((-1, 1), self.bearing_forces(state), strict=True)):
            result.append((sign * force - at_bearing) / self.pair.masses[gear])
            turning = moments[gear] + _moment(self.arms[gear], sign * force)
            result.append(turning[None] / self.pair.inertias[gear])
        return np.concatenate(result)

    def integrated(self, start: Floats, periods: int, samples: int = 0, tolerance: float = 1e-10) -> Floats:
        """(12, n, t) from states (12, n): the end, or so many samples up to it."""
        end = periods * 2 * np.pi / self.frequency
        times = [end] if not samples else np.linspace(0, end, samples + 1)
        found = solve_ivp(
            lambda time, state: self.rates(time, state.reshape(start.shape)).ravel(),
            (0, end),
            start.ravel(),
            "DOP853",
            times,
            rtol=tolerance,
            atol=1e-4 * tolerance,
            max_step=end / periods / 16,
        )
        return np.asarray(found.y.reshape(*start.shape, -1), float)

    def periodic(self) -> Period:
        """Of flanks that stay in contact: the start that comes again, the equations being linear."""
        radius = self.pair.base_radii[0] / 1000
        sizes = np.array([1, 1, 1 / radius] * 2 + [self.frequency, self.frequency, self.frequency / radius] * 2) * 1e-6
        end = self.integrated(np.hstack([np.zeros((12, 1)), np.diag(sizes)]), 1)[:, :, -1] / sizes[:, None]
        # What turns freely comes again from anywhere.
        start = np.linalg.lstsq(end[:, 1:] - end[:, :1] - np.eye(12), -end[:, 0], rcond=1e-8)[0]
        return self._told(sizes * start)

    def settled(self, periods: int) -> Period:
        """After so many periods from rest."""
        nearly = self.integrated(self._rest()[:, None], periods, tolerance=1e-6)[:, :, -1]
        return self._told(self.integrated(nearly, 2)[:, 0, -1])

    def _rest(self) -> Floats:
        """Bearings bent by the force of the torque, flanks just touching."""
        force, start = self.pair.torque / (self.pair.base_radii[0] / 1000), np.zeros(12)
        for at, sign, stiffness in zip((0, 3), (-1, 1), self.pair.bearing_stiffness, strict=True):
            start[at : at + 2] = sign * force * self.push / (1e6 * np.array(stiffness))
        start[2] = -self.contact(np.zeros(1), start[:, None])[0][0] / (self.pair.base_radii[0] / 1000)
        return start

    def _told(self, start: Floats) -> Period:
        samples = 1000
        state = self.integrated(start[:, None], 1, samples)[:, 0]
        time = 2 * np.pi / self.frequency * np.arange(samples + 1) / samples
        place, spring, force = self.contact(time, state)
        return Period(spring, force, place, state[[2, 5]], np.array(self.bearing_forces(state)))


def _point(gear: Floats, arm: Floats) -> Floats:
    """How a material point at the end of `arm` moves (2, ...) with a gear (3, ...) that travels and turns a little."""
    return np.array([gear[0] - gear[2] * arm[1], gear[1] + gear[2] * arm[0]])


def _moment(arm: Floats, force: Floats) -> Floats:
    return np.asarray(arm[0] * force[1] - arm[1] * force[0], float)
