"""A system seen from its meshes: how forces of a frequency at the meshes move them, and turn inertias and shafts.

SI units. The lines' modes are uncoupled, so everything is a sum over them; only the meshes at their mean stiffness couple.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Complexes, Floats, Indices
from gearcad.dynamics.trains.system import System
from gearcad.errors import GeometryError, SolverError

__all__ = [
    "Flexibility",
    "Outputs",
    "StaticState",
    "at_orders",
    "both_sides",
    "flexibility",
    "senses",
    "static_state",
    "told_by",
]


_LOSS = 1e-9
"""Least loss factor of a line's mode: keeps the sum finite just at the frequency of an undamped one."""

_MOST_AMPLIFIED = 1e9
"""Deflection over the static one beyond which rounding decides: resonance without damping."""

_BALANCED, _ROUNDING = 1e-8, 1e-15
"""Part of the load that may be left for free turns; relative error of squares of natural frequencies, of the greatest."""

_NO_DAMPING = "no finite periodic motion: a harmonic of one of the frequencies meets a resonance without damping"


@dataclass(frozen=True, eq=False)
class StaticState:
    """At rest under the mean load, meshes at their mean stiffness: `modal` (n,), `approach` (m,), `others` (o,) outputs.

    `unit_mesh` (m, m) and `unit_others` (o, m) are the same per force at the meshes, without the load; the outputs are those of
    the System.
    """

    modal: Floats
    approach: Floats
    others: Floats
    unit_mesh: Floats
    unit_others: Floats


def static_state(system: System) -> StaticState:
    """Raises GeometryError where a train that is free to turn has torques that do not balance, or the mesh pulls it apart."""
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
    """(m,): 1 where the mean load presses the front flanks of a mesh, -1 where it presses those at the back.

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
    """At circular frequencies (...) other than 0 (1/s), with the meshes at their mean stiffness.

    With P = V^T a^-1 V of the lines alone, a = squares - w^2 + i w damping, and meshes K, that of the whole is P (1 + K P)^-1.
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


def _undamped(system: System) -> SolverError:
    """What is to blame: the first mesh without damping, if there is one."""
    name = next((name for name, each in zip(system.names[0], system.mesh_damping, strict=True) if not each), None)
    if name is None:
        return SolverError(_NO_DAMPING)
    return SolverError(
        f"{name}.damping = 0 N·s/m: must be above 0, as damping or damping_ratio, or damp the shafts: {_NO_DAMPING}"
    )


class Outputs(NamedTuple):
    """Coefficients of turns (s, q, i) in rad, of shaft torques (s, q, n) in N·m, and of travels of the axes (s, q, t) in m."""

    turns: Complexes
    torques: Complexes
    travels: Complexes


def told_by(system: System, static: StaticState, flexible: Flexibility, forces: Complexes) -> Outputs:
    """What forces (s, q, m) at the mean system do to it, besides the approach of its flanks."""
    others = np.einsum("shij,shj->shi", flexible.others, forces)
    others[:, 0] += static.others
    torques = system.torque_outputs
    return Outputs(others[..., : torques.start], others[..., torques], others[..., torques.stop :])


def at_orders(system: System, static: StaticState, omega: Floats, orders: Indices) -> Flexibility:
    """Flexibilities (s, q, ...) at the orders from 0 on of fundamental frequencies omega (s,)."""
    moving = flexibility(system, omega[:, None] * orders[1:])
    still = (np.broadcast_to(each, (len(omega), 1, *each.shape)) for each in (static.unit_mesh, static.unit_others))
    mesh, others = (np.concatenate(pair, axis=1) for pair in zip(still, (moving.mesh, moving.others), strict=True))
    return Flexibility(np.asarray(mesh, complex), np.asarray(others, complex))


def both_sides(coefficients: Complexes) -> Complexes:
    """From orders 0 on (s, q, ...) to all of them, -q ... q: those of a real course are conjugate."""
    return np.concatenate([coefficients[:, :0:-1].conj(), coefficients], axis=1)
