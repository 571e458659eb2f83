"""How short the steps of a motion in time must be, and how long it takes to settle. SI units."""

from __future__ import annotations

import math

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.trains.system import System

__all__ = ["settling_time", "shaken_frequency", "step_for"]

PER_TOOTH, PER_WAVE = 256, 80
"""Steps over a tooth of the quickest mesh, and over a vibration on the springs of the teeth: frequencies are then good to
3e-4, as one step takes w h for w h (1 - (w h)²/24)."""

_SHARE = 0.02
"""Of a mode's energy that the meshes must have for their forces to shake it: modes without are exact by any steps."""

_SETTLED = 7.0
"""Times of decay after which a thousandth is left."""


def step_for(system: System, tooth_frequency: float, longest: float) -> float:
    """Seconds, for meshes whose greatest tooth frequency is given (Hz); not longer than `longest`."""
    squares, _ = _shaken(system)
    own = math.sqrt(float(squares.max(initial=0.0)))
    steps = [longest]
    steps += [1 / (PER_TOOTH * tooth_frequency)] if tooth_frequency > 0 else []
    steps += [2 * math.pi / (PER_WAVE * own)] if own > 0 else []
    return min(steps)


def settling_time(system: System) -> float:
    """After which a thousandth is left of vibrations that meshes shake (s); infinite without damping."""
    squares, rates = _shaken(system)
    slowest = float(np.minimum(rates, np.sqrt(squares)).min(initial=math.inf))
    return _SETTLED / slowest if slowest > 0 else math.inf


def shaken_frequency(system: System) -> float:
    """Return the highest natural frequency (1/s) of the modes that the meshes shake."""
    return math.sqrt(float(_shaken(system)[0].max(initial=0.0)))


def _shaken(system: System) -> tuple[Floats, Floats]:
    """Squares (1/s²) and rates of decay (1/s) of the modes that the meshes shake, with the meshes at their mean."""
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    energy = ((modes.T @ system.mesh) ** 2 * system.stiffness).sum(axis=1)
    felt = energy > _SHARE * np.maximum(squares, 1e-9 * squares.max())
    rates = np.einsum("in,ij,jn->n", modes, system.damping_matrix(), modes) / 2
    return squares[felt], np.maximum(rates[felt], 0.0)
