"""Floquet multipliers as exactly as they can be had: the witness of the growth that the charts look at. SI units."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Complexes, Floats
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System

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
