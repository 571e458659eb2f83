"""Floquet multipliers: whether a small disturbance of a periodic motion dies away. SI units."""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.trains.system import System

__all__ = ["UNSTABLE", "growth"]


UNSTABLE = 1 + 1e-5
"""Floquet multipliers beyond this are growth; 1 itself belongs to a train that is free to turn."""

_STEPS, _MOST_STEPS = 128, 4096
"""Fewest and most steps over the period of the stiffness where only growth matters."""

_MOST_AGAIN = 65_536
"""Steps at most of what seems to grow in fewer steps than it asks for: too long ones grow by themselves."""

_LONGEST_STEP = 0.5
"""Greatest turn (rad) of the fastest mode in such a step: longer ones would meet resonances of their own."""

_BEYOND = 1e100
"""What grows so much in a period is unstable; more would overflow."""

_SERIES, _ORDERS = 0.5, 13
"""Size of A t in Taylor's series of exp(A t), and its orders: good to rounding."""

_BLOCK = 4_000_000
"""Numbers that one block of speeds may need at a time."""


def growth(system: System, excitation: Excitation, frequencies: Floats, slopes: Floats | None = None) -> Floats:
    """Largest multiplier (s,) over one period at many frequencies: by splitting each step, of second order.

    `slopes` (s, t, m) are stiffnesses (N/m) over the common period where they are not those of the excitation: those of flanks
    that part. Between two half steps of the mean system, solved exactly, what differs from the mean gives a push. Only modes
    are looked at that have at least a thousandth of their energy in the meshes: no other can be driven there.
    """
    order = int(np.gcd.reduce(excitation.orders)) if slopes is None else 1
    periods = 2 * np.pi / (excitation.fundamental * frequencies * order)
    squares, damping, mesh = _driven_modes(system)
    wanted = np.sqrt(squares.max()) * periods / _LONGEST_STEP
    result, least = np.zeros(len(frequencies)), _STEPS if slopes is None else slopes.shape[1]
    block, which = max(1, _BLOCK // (2 * len(squares)) ** 2), np.arange(len(frequencies))
    for most in (_MOST_STEPS, _MOST_AGAIN):
        steps = 2 ** np.ceil(np.log2(np.clip(wanted, least, most))).astype(int)
        for count in np.unique(steps[which]):
            alike = which[steps[which] == count]
            for of in np.array_split(alike, -(-len(alike) // block)):
                if slopes is None:
                    theta = 2 * np.pi / order * (np.arange(count) + 0.5) / count
                    course = (system.stiffness * excitation.ratios(theta))[None]
                else:
                    course = np.repeat(slopes[of], max(1, count // slopes.shape[1]), axis=1)
                result[of] = _growth(squares, damping, mesh, course - system.stiffness, periods[of])
        which = np.flatnonzero((result > UNSTABLE) & (wanted > most))
    return result


def _driven_modes(system: System) -> tuple[Floats, Floats, Floats]:
    """Squares (r,), damping (r, r) and approaches (r, m) of the mean system's modes that move the meshes."""
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    mesh = modes.T @ system.mesh
    energy = (mesh**2 * system.stiffness).sum(axis=1)
    # One at the least: the strongest of weakly driven ones.
    driven = energy >= min(1e-3, energy.max() / squares.max()) * np.maximum(squares, 1e-9 * squares.max())
    modes = modes[:, driven]
    return squares[driven], modes.T @ system.damping_matrix() @ modes, mesh[driven]


def _growth(squares: Floats, damping: Floats, mesh: Floats, excess: Floats, periods: Floats) -> Floats:
    n, steps = len(squares), excess.shape[1]
    h = periods[:, None, None] / steps
    half = _propagators(squares, damping, h[:, 0, 0] / 2)
    whole, total = half @ half, half
    for k in range(steps):
        total = np.clip(total, -_BEYOND, _BEYOND)
        push = (mesh * (h * excess[:, k, None, :])) @ (mesh.T @ total[:, :n])
        total = np.concatenate([total[:, :n], total[:, n:] - push], axis=1)
        total = (whole if k + 1 < steps else half) @ total
    return np.asarray(np.abs(np.linalg.eigvals(np.clip(total, -_BEYOND, _BEYOND))).max(axis=1), float)


def _propagators(squares: Floats, damping: Floats, times: Floats) -> Floats:
    """(s, 2n, 2n): exp(A t) of the mean system at all times (s,) at once, by Taylor's series of halved times, squared again."""
    n, rate = len(squares), float(np.sqrt(squares.max())) or 1.0
    # Rates over the quickest frequency: both halves of a state are then alike in size.
    generator = np.block([[np.zeros((n, n)), rate * np.eye(n)], [-np.diag(squares) / rate, -damping]])
    size = float(np.abs(generator).sum(axis=1).max() * times.max())
    halvings = max(0, math.ceil(math.log2(size / _SERIES)))
    step = generator * (times / 2**halvings)[:, None, None]
    result = unit = np.broadcast_to(np.eye(2 * n), step.shape)
    for order in range(_ORDERS, 0, -1):
        result = unit + step @ result / order
    for _ in range(halvings):
        result = result @ result
    scale = np.repeat([1.0, rate], n)
    return np.asarray(result * scale[:, None] / scale, float)
