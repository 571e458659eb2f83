"""Harmonic balance of a train whose flanks stay in contact, and its stability by Floquet multipliers.

Every mesh presses with k_j(t) (y_j - e_j) + c_j (y_j' - e_j'). What differs from the mean stiffness is moved to the right-hand
side, so only the approaches of the meshes are unknown: y_h + G_h (kappa y)_h = y_static + G_h (k e + c e')_h for every order h,
G the dynamic flexibility with the meshes at their mean. SI units, frequencies circular (1/s).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, SolverError, require_whole
from gearcad.core.records import Complexes, Floats, Indices
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import (
    Outputs,
    PeriodicResponse,
    StaticState,
    TorqueMotion,
    at_orders,
    both_sides,
    instability,
    outputs_of,
    parting,
    static_state,
    torque_motion,
)

UNSTABLE = 1 + 1e-5
"""Floquet multipliers beyond this are growth; 1 itself belongs to a train that is free to turn."""

_STEPS, _MOST_STEPS = 128, 4096
"""Fewest and most steps over the period of the stiffness where only growth matters."""

_MOST_AGAIN = 65_536
"""Steps at most of what seems to grow in fewer steps than it asks for: too long ones grow by themselves."""

_LONGEST_STEP = 0.5
"""Greatest turn (rad) of the fastest mode in such a step: longer ones would meet resonances of their own."""

_BEYOND = 1e100
"""Growth in a period beyond which a motion is unstable; more would overflow."""

_SERIES, _ORDERS = 0.5, 13
"""Size of A t in Taylor's series of exp(A t), and its orders: good to rounding."""

_BLOCK = 4_000_000
"""Numbers that one block of speeds may need at a time."""


def growth(system: System, excitation: Excitation, frequencies: Floats, slopes: Floats | None = None) -> Floats:
    """Return the largest multiplier (s,) over one period at many frequencies, by splitting each step, of second order.

    `slopes` (s, t, m) are stiffnesses (N/m) over the common period where they are not those of the excitation: those of flanks
    that part. Between two half steps of the mean system, solved exactly, the difference from the mean gives a push. Only modes
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
    """Return squares (r,), damping (r, r) and approaches (r, m) of the mean system's modes that move the meshes."""
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
    """Return exp(A t) (s, 2n, 2n) of the mean system at all times (s,) at once.

    It is found by Taylor's series of halved times, squared again.
    """
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


def checked_frequencies(frequencies: ArrayLike) -> Floats:
    """Return frequencies (s,) as floats. Raises ParameterError unless all are above 0."""
    values = np.atleast_1d(np.array(frequencies, float))
    if values.ndim != 1 or not values.size or not np.isfinite(values).all() or values.min() <= 0:
        raise ParameterError("frequencies", f"{values.size} values", "must be finite numbers above 0 1/s")
    return values


def harmonic_orders(excitation: Excitation, harmonics: int) -> Indices:
    """Return orders (q,) of the common period, from 0 on, that the excitation drives up to `harmonics` of each tooth frequency.

    Those of several tooth frequencies combine; transmission errors of a longer period bring all orders with them. Raises
    ParameterError for more of them than can be solved.
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
    if excitation.torques:
        found = _with_torques(found, excitation.torque_orders)
    lines = np.flatnonzero(np.abs(excitation.error_coefficients(highest)).max(axis=1))
    if not np.isin(lines, found).all():
        found = np.arange(highest + 1)
    if len(found) > 20_000:
        raise ParameterError("harmonics", harmonics, f"must be fewer: the common period would have {len(found)} orders")
    return np.asarray(found, np.intp)


def _with_torques(orders: Indices, torques: Sequence[int]) -> Indices:
    """Return the orders with those of torques, and with what the teeth make of them on both sides."""
    sides = [np.abs(order + sign * orders) for order in sorted(set(torques)) for sign in (-1, 1)]
    found = np.unique(np.concatenate([orders, *sides]))
    return np.asarray(found[found <= max(int(orders[-1]), *torques)], np.intp)


def periodic_response(
    system: System, excitation: Excitation, frequencies: ArrayLike, *, harmonics: int = 6, stability: bool = True
) -> PeriodicResponse:
    """Return the steady vibration at circular tooth frequencies of the first mesh (1/s), flanks always in contact.

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
    """Return coefficients (s, q, ...) of the approaches, and those of all other outputs."""
    omega = excitation.fundamental * speeds
    flexible = at_orders(system, static, omega, orders)
    signed = np.concatenate([-orders[:0:-1], orders])
    driving = _driving(system, excitation, omega, signed)
    try:
        pushed = torque_motion(system, excitation, omega, orders)
        approach, forces = _approaches(system, excitation, static, both_sides(flexible.mesh), driving, signed, pushed)
    except np.linalg.LinAlgError:
        approach = np.full(1, np.nan)
    if not np.isfinite(approach).all():
        raise SolverError(
            "no finite periodic motion at one of the frequencies: it is at the limit of parametric instability; "
            "more damping moves the limit"
        )
    half = slice(len(orders) - 1, None)
    return approach[:, half], outputs_of(system, static, flexible, forces[:, half], pushed)


def _driving(system: System, excitation: Excitation, omega: Floats, signed: Indices) -> Complexes:
    """Return coefficients (s, q, m) of k e + c e'."""
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
    system: System,
    excitation: Excitation,
    static: StaticState,
    mesh: Complexes,
    driving: Complexes,
    signed: Indices,
    pushed: TorqueMotion,
) -> tuple[Complexes, Complexes]:
    """Return approaches and forces (s, q, m).

    Orders whose difference is no multiple of the orders of the stiffness do not interact: each class of them is solved alone.
    """
    reach = int(signed[-1] - signed[0])
    half = excitation.ratio_coefficients(reach) * system.stiffness
    half[0] = 0
    varying = np.concatenate([half[:0:-1].conj(), half])
    right = np.einsum("shij,shj->shi", mesh, driving)
    middle = int(np.flatnonzero(signed == 0)[0])
    right[:, middle] += static.approach
    right[:, middle + pushed.rows] += pushed.approach
    right[:, middle - pushed.rows] += pushed.approach.conj()
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
    """Return the response, or the same with bonded flanks and a notice where its flanks would pull."""
    per = max(1, _BLOCK // (result.samples * result.approach_coefficients.shape[2]))
    starts = range(0, len(result.frequencies), per)
    linear = replace(result, excitation=result.excitation.bonded)
    least = np.concatenate([(linear.senses * linear.spring_forces(slice(i, i + per))).min(axis=(1, 2)) for i in starts])
    if (least >= 0).all():
        return result
    return replace(linear, notices=(*result.notices, parting(result.frequencies, least < 0)))
