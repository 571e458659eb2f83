"""Where a train may resonate: how far a force of any frequency at the meshes could shake it there, and how narrowly.

SI units. The modes are those at the mean stiffness of the meshes; damping couples them little, where resonances are narrow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Bools, Complexes, Floats
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.response.flexibility import StaticState
from gearcad.dynamics.trains.system import System

__all__ = ["FELT", "LEAST_RATIO", "Resonances", "quasi_static_forces", "quasi_static_spectrum", "resonances", "settled"]


LEAST_RATIO = 5e-4
"""Damping ratios below this are taken for this: narrower resonances are not looked for."""

FELT = 0.002
"""Of the load at rest: vibrations below that are not looked for."""

_SAMPLES = 4096
"""Over a tooth, of the quasi-static forces."""


@dataclass(frozen=True, eq=False)
class Resonances:
    """Of each elastic mode its natural frequency `omega` (r,) in 1/s, damping ratio `ratio` (r,), and the shares `mesh` (r, m)
    that forces at the meshes (N) have in it; `told` (r,) is the greatest part of its load at rest by which a mesh or a shaft
    is loaded when the mode's coordinate is 1."""

    omega: Floats
    ratio: Floats
    mesh: Floats
    told: Floats
    sharp: Bools
    """Which of them (r,) are damped so little that they are taken to have more."""


def resonances(system: System, static: StaticState, references: Floats) -> Resonances:
    """`references` (s,) in N·m are the torques that shafts are held against, nan where there is none."""
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    kept = squares > 1e-9 * squares.max()
    squares, modes = squares[kept], modes[:, kept]
    damping = np.einsum("nr,nk,kr->r", modes, system.damping_matrix(), modes)
    mesh = modes.T @ system.mesh
    own = mesh * system.stiffness / np.maximum(np.abs(system.stiffness * static.approach), 1e-300)
    shafts = (modes.T @ system.shaft_torques) / references
    told = np.nan_to_num(np.abs(np.hstack([own, shafts])), nan=0.0).max(axis=1)
    omega = np.sqrt(squares)
    ratio = damping / (2 * omega)
    return Resonances(omega, np.maximum(ratio, LEAST_RATIO), mesh, told, ratio < LEAST_RATIO)


def settled(system: System, static: StaticState, stiffness: Floats, errors: Floats) -> Floats:
    """Approaches (t, m) at rest, in contact, with stiffnesses (t, m) in N/m and errors (t, m), both in m."""
    matrix = np.eye(stiffness.shape[1]) + static.unit_mesh * (stiffness - system.stiffness)[:, None, :]
    right = static.approach + (stiffness * errors) @ static.unit_mesh.T
    return np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], float)


def quasi_static_spectrum(system: System, excitation: Excitation, static: StaticState) -> Complexes:
    """(q, m) in N: amplitudes of what drives vibrations of each order of the common period at the least speeds."""
    count = _SAMPLES * max(excitation.orders)
    stiffness, errors = (
        excitation.ratios(2 * np.pi * np.arange(count) / count) * system.stiffness,
        excitation.error_course(count),
    )
    approach = settled(system, static, stiffness, errors)
    forces = system.stiffness * approach - stiffness * (approach - errors)
    spectrum = 2 * np.fft.rfft(forces, axis=0, norm="forward")
    spectrum[0] = 0.0
    return np.asarray(spectrum, complex)


def quasi_static_forces(system: System, excitation: Excitation, static: StaticState) -> Floats:
    """(q, m) in N: what drives vibrations of each order of the common period, or any higher one, at the least speeds."""
    spectrum = np.abs(quasi_static_spectrum(system, excitation, static))
    return np.asarray(np.maximum.accumulate(spectrum[::-1], axis=0)[::-1], float)
