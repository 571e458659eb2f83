"""Systems of few degrees of freedom, their Floquet multipliers, and two gears as free bodies by Newton's equations."""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from gearcad.core.errors import SolverError
from gearcad.core.records import Complexes, Floats
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.dynamics.trains.shaft_lines import System

MOMENT, RADIUS = 2256.0, 0.0507
STATIC_FORCE = MOMENT / RADIUS
STIFFNESS, MESH_DAMPING, VARIATION = 7.05e8, 14660.0, 0.206
"""Of the train of J. Osinski's paper (2.1), (2.9), (2.10)."""


def oscillator(damping_ratio: float, stiffness: float = 1.0, load: float = 1.0) -> System:
    """y'' + 2 zeta y' + k y = load."""
    return System(
        squares=np.zeros(1),
        damping=np.zeros(1),
        mesh=np.ones((1, 1)),
        inertias=np.zeros((1, 0)),
        shaft_torques=np.zeros((1, 0)),
        load=np.full(1, load),
        stiffness=np.full(1, stiffness),
        mesh_damping=np.array([2 * damping_ratio]),
        names=(("mesh",), (), ()),
    )


def preloaded(frequencies: list[float], mesh: list[float], loss: float = 0.0) -> System:
    """Modes of the lines, with a damping ratio of each; opposite moments press the mesh and leave the shafts unloaded."""
    squares, shape = np.square(frequencies), np.array(mesh)
    return System(
        squares=squares,
        damping=2 * loss * np.array(frequencies),
        mesh=shape[:, None],
        inertias=np.zeros((len(mesh), 0)),
        shaft_torques=np.zeros((len(mesh), 0)),
        load=shape * STATIC_FORCE,
        stiffness=np.array([STIFFNESS]),
        mesh_damping=np.array([MESH_DAMPING]),
        names=(("mesh",), (), ()),
    )


def isolated() -> System:
    """The paper's pair without shafts, along the line of action."""
    return preloaded([0.0], [float(np.sqrt(RADIUS**2 / 0.0058 + 0.1353**2 / 0.2228))])


def two_stages(shaft_damping: float = 1.0) -> System:
    """The paper's two-stage train (3.1)-(3.5) with k3 = 1e7 N·m/rad, k = 7.5e8 N/m; moments +M on gear 1, -M on gear 4."""
    radius, inertia, k_1, k_3, k_5, half = 0.0902, 0.0446, 1e5, 1e7, 921.0, 2**-0.5
    gears = np.array([[1, 0, 0, 0], [0, half, half, 0], [0, half, -half, 0], [0, 0, 0, 1]]).T / np.sqrt(inertia)
    return System(
        squares=np.array([k_1, 0, 2 * k_3, k_5]) / inertia,
        damping=shaft_damping * np.array([1, 0, 2, 1]) / inertia,
        mesh=radius * np.stack([gears[:, 0] + gears[:, 1], gears[:, 2] + gears[:, 3]], axis=1),
        inertias=gears,
        shaft_torques=np.stack([k_1 * gears[:, 0], k_3 * (gears[:, 1] - gears[:, 2]), k_5 * gears[:, 3]], axis=1),
        load=MOMENT * (gears[:, 0] - gears[:, 3]),
        stiffness=np.full(2, 7.5e8),
        mesh_damping=np.full(2, MESH_DAMPING),
        names=(("first", "second"), ("1", "2", "3", "4"), ("input", "middle", "output")),
    )


def cosine(variation: float, *, phase: float = 0.0, backlash: float | None = None) -> Excitation:
    """Of a single mesh."""
    shape = CosineStiffness(variation=variation)
    return Excitation(meshes=(MeshExcitation(stiffness=shape, phase=phase, backlash=backlash),))


_COARSE = 16
"""Steps over the period of the stiffness that the extrapolation begins with."""


def _generator(system: System, stiffness: Floats) -> Floats:
    """(..., 2n, 2n): d/dt of (z, z') is this times it, with mesh stiffnesses (..., m)."""
    n = system.size
    result = np.zeros((*stiffness.shape[:-1], 2 * n, 2 * n))
    result[..., :n, n:] = np.eye(n)
    result[..., n:, :n] = -np.diag(system.squares) - (system.mesh * stiffness[..., None, :]) @ system.mesh.T
    result[..., n:, n:] = -system.damping_matrix()
    return result


def monodromy(system: System, excitation: Excitation, frequency: float, *, tolerance: float = 1e-11) -> Floats:
    """(2n, 2n): what one period of the stiffness makes of (z, z'), by Magnus' expansion of fourth order.

    `frequency` is the circular tooth frequency of the first mesh (1/s). Steps end where the stiffness jumps, so a piecewise
    constant one is exact; they are halved, and the limit extrapolated, until the result changes by less than the tolerance.
    """
    omega = excitation.fundamental * frequency * np.gcd.reduce(excitation.orders)
    cuts = _cuts(excitation)
    # In coordinates in which deflections and speeds are alike in size.
    scale = np.repeat([np.sqrt(np.diag(system.stiffness_matrix()).max()), 1.0], system.size)
    before: list[Floats] = []
    for halvings in range(9):
        rows = [scale[:, None] * _magnus(system, excitation, omega, cuts, 2**halvings) / scale]
        # The error has powers 4, 6, 8 ... of the step.
        for level, previous in enumerate(before):
            rows.append(rows[-1] + (rows[-1] - previous) / (2 ** (4 + 2 * level) - 1))
        if before and np.abs(rows[-1] - before[-1]).max() <= tolerance * np.abs(rows[-1]).max():
            return np.asarray(rows[-1] * scale / scale[:, None], float)
        before = rows
    raise SolverError(f"Floquet multipliers at {frequency:g} 1/s did not settle: {np.abs(rows[-1] - before[-1]).max():.2g}")


def _cuts(excitation: Excitation) -> Floats:
    """Phases of the stiffness' own period, in those of the common one, from 0 to its end, jumps between them."""
    end = 2 * np.pi / np.gcd.reduce(excitation.orders)
    inner = excitation.jumps[excitation.jumps < end * (1 - 1e-12)]
    found = np.concatenate([[0.0], inner, [end]])
    return np.asarray(found[np.concatenate([[True], np.diff(found) > 1e-12])], float)


def _magnus(system: System, excitation: Excitation, omega: float, cuts: Floats, halved: int) -> Floats:
    from scipy.linalg import expm

    duration = np.gcd.reduce(excitation.orders) / omega
    total = np.eye(2 * system.size)
    for start, end in pairwise(cuts):
        count = halved * int(np.ceil(_COARSE * (end - start) / (cuts[-1] - cuts[0])))
        wide = (end - start) / count
        middles = start + wide * (np.arange(count) + 0.5)
        gauss = wide * np.sqrt(3) / 6
        first, second = (_generator(system, system.stiffness * excitation.ratios(middles + shift)) for shift in (-gauss, gauss))
        h = wide * duration
        turned = np.sqrt(3) / 12 * h**2 * (second @ first - first @ second)
        for step in expm(h / 2 * (first + second) + turned):
            total = step @ total
    return total


def floquet_multipliers(system: System, excitation: Excitation, frequency: float) -> Complexes:
    """Multipliers (2n,) over one period of the stiffness, flanks in contact; the largest first."""
    found = np.linalg.eigvals(monodromy(system, excitation, frequency))
    return np.asarray(found[np.argsort(-np.abs(found))], complex)


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
