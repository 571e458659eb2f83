"""Harmonic balance of a train whose flanks stay in contact: linear, with coefficients periodic in time.

Every mesh presses with k_j(t) (y_j - e_j) + c_j (y_j' - e_j'). What differs from the mean stiffness is moved to the right-hand
side, so only the approaches of the meshes are unknown: y_h + G_h (kappa y)_h = y_static + G_h (k e + c e')_h for every order h,
G the dynamic flexibility with the meshes at their mean. SI units, frequencies circular (1/s).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Complexes, Floats, Indices
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.response.flexibility import Outputs, StaticState, at_orders, both_sides, static_state, told_by
from gearcad.dynamics.response.floquet import UNSTABLE, growth
from gearcad.dynamics.response.notices import instability, parting
from gearcad.dynamics.response.periodic import PeriodicResponse
from gearcad.dynamics.trains.system import System
from gearcad.errors import ParameterError, SolverError, require_whole

__all__ = ["checked_frequencies", "harmonic_orders", "periodic_response"]


_BLOCK = 4_000_000
"""Complex numbers that one block of speeds may need at a time."""


def checked_frequencies(frequencies: ArrayLike) -> Floats:
    """Frequencies (s,) as floats; raises ParameterError unless all are above 0."""
    values = np.atleast_1d(np.array(frequencies, float))
    if values.ndim != 1 or not values.size or not np.isfinite(values).all() or values.min() <= 0:
        raise ParameterError("frequencies", f"{values.size} values", "must be finite numbers above 0 1/s")
    return values


def harmonic_orders(excitation: Excitation, harmonics: int) -> Indices:
    """Orders (q,) of the common period, from 0 on, that the excitation drives up to `harmonics` of each tooth frequency.

    Those of several tooth frequencies combine; transmission errors of a longer period bring all orders with them.
    Raises ParameterError for more of them than can be solved.
    """
    require_whole("harmonics", harmonics, at_least=1, at_most=200)
    orders = sorted(set(excitation.orders))
    highest = harmonics * orders[-1]
    found = np.zeros(1, int)
    for _ in range(harmonics if len(orders) > 1 else 0):
        found = np.unique(np.concatenate([found + sign * q for q in orders for sign in (-1, 0, 1)]))
    if len(orders) == 1:
        found = orders[0] * np.arange(harmonics + 1)
    found = found[(found >= 0) & (found <= highest)]
    lines = np.flatnonzero(np.abs(excitation.error_coefficients(highest)).max(axis=1))
    if not np.isin(lines, found).all():
        found = np.arange(highest + 1)
    if len(found) > 20_000:
        raise ParameterError("harmonics", harmonics, f"must be fewer: the common period would have {len(found)} orders")
    return np.asarray(found, np.intp)


def periodic_response(
    system: System, excitation: Excitation, frequencies: ArrayLike, *, harmonics: int = 6, stability: bool = True
) -> PeriodicResponse:
    """Steady vibration at circular tooth frequencies of the first mesh (1/s), flanks always in contact.

    With `stability` the Floquet multipliers at every frequency are found too, and growth is told in the notices. Raises
    GeometryError for torques that do not balance, SolverError where no finite response exists.
    """
    excitation.fits(system)
    speeds = checked_frequencies(frequencies)
    orders = harmonic_orders(excitation, harmonics)
    static = static_state(system)
    meshes, rows = len(system.stiffness), system.inertias.shape[1] + system.shaft_torques.shape[1]
    per_class = 1 + 2 * len(orders) // int(np.gcd.reduce(excitation.orders))
    block = max(1, _BLOCK // (len(orders) * meshes * (system.size + 2 * meshes + rows) + 2 * (per_class * meshes) ** 2))
    parts = [_solve(system, excitation, static, speeds[i : i + block], orders) for i in range(0, len(speeds), block)]
    approach = np.concatenate([part[0] for part in parts])
    outputs = Outputs(*(np.concatenate(each) for each in zip(*(part[1] for part in parts), strict=True)))
    stable = growth(system, excitation, speeds) <= UNSTABLE if stability else np.ones(len(speeds), bool)
    result = PeriodicResponse(
        system=system,
        excitation=excitation,
        frequencies=speeds,
        harmonics=orders,
        approach_coefficients=approach,
        inertia_coefficients=outputs.turns,
        torque_coefficients=outputs.torques,
        travel_coefficients=outputs.travels,
        stable=stable,
        notices=instability(speeds, stable),
    )
    return _with_parting(result)


def _solve(
    system: System, excitation: Excitation, static: StaticState, speeds: Floats, orders: Indices
) -> tuple[Complexes, Outputs]:
    """Coefficients (s, q, ...) of approaches, and of all else."""
    omega = excitation.fundamental * speeds
    flexible = at_orders(system, static, omega, orders)
    signed = np.concatenate([-orders[:0:-1], orders])
    driving = _driving(system, excitation, omega, signed)
    try:
        approach, forces = _approaches(system, excitation, static, both_sides(flexible.mesh), driving, signed)
    except np.linalg.LinAlgError:
        approach = np.full(1, np.nan)
    if not np.isfinite(approach).all():
        raise SolverError("no finite periodic motion at one of the frequencies: it is at the limit of parametric instability")
    half = slice(len(orders) - 1, None)
    return approach[:, half], told_by(system, static, flexible, forces[:, half])


def _driving(system: System, excitation: Excitation, omega: Floats, signed: Indices) -> Complexes:
    """(s, q, m): coefficients of k e + c e'."""
    highest = int(signed[-1])
    errors = excitation.error_coefficients(highest)
    result = np.zeros((len(omega), len(signed), errors.shape[1]), complex)
    if errors.any():
        # So many samples that no order of the product is mistaken for one that is wanted.
        count = 4 * highest + 2
        ratios = excitation.ratio_coefficients(2 * highest) * system.stiffness
        product = np.fft.irfft(ratios * count, count, axis=0) * np.fft.irfft(errors * count, count, axis=0)
        spring = np.fft.fft(product, axis=0)[signed] / count
        rate = np.concatenate([errors[:0:-1].conj(), errors])[signed + highest] * system.mesh_damping * signed[:, None]
        result += spring + 1j * omega[:, None, None] * rate
    return result


def _approaches(
    system: System, excitation: Excitation, static: StaticState, mesh: Complexes, driving: Complexes, signed: Indices
) -> tuple[Complexes, Complexes]:
    """Approaches and forces (s, q, m). Orders that differ by no multiple of those of the stiffness know nothing of each other:
    each class of them is solved alone."""
    reach = int(signed[-1] - signed[0])
    half = excitation.ratio_coefficients(reach) * system.stiffness
    half[0] = 0
    varying = np.concatenate([half[:0:-1].conj(), half])
    right = np.einsum("shij,shj->shi", mesh, driving)
    right[:, np.flatnonzero(signed == 0)[0]] += static.approach
    approach, forces = np.zeros_like(right), driving.copy()
    remainders = np.mod(signed, np.gcd.reduce(excitation.orders))
    for remainder in np.unique(remainders):
        of = np.flatnonzero(remainders == remainder)
        size = len(of) * right.shape[2]
        block = varying[signed[of, None] - signed[of] + reach]
        coupling = np.einsum("shij,hlj->shilj", mesh[:, of], block).reshape(len(mesh), size, size)
        solved = np.linalg.solve(np.eye(size) + coupling, right[:, of].reshape(len(mesh), size, 1))
        approach[:, of] = solved.reshape(len(mesh), len(of), -1)
        forces[:, of] -= np.einsum("hlj,slj->shj", block, approach[:, of])
    return approach, forces


def _with_parting(result: PeriodicResponse) -> PeriodicResponse:
    """With a notice where the linear response has flanks that pull."""
    per = max(1, _BLOCK // (result.samples * result.approach_coefficients.shape[2]))
    starts = range(0, len(result.frequencies), per)
    linear = replace(result, excitation=result.excitation.bonded)
    least = np.concatenate([(linear.senses * linear.spring_forces(slice(i, i + per))).min(axis=(1, 2)) for i in starts])
    if (least >= 0).all():
        return result
    return replace(linear, notices=(*result.notices, parting(result.frequencies, least < 0)))
