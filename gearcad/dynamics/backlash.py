"""Flanks that part: the branch of periodic motions followed over speed, and what a run up or down shows of it.

The branch is followed by its arc length: it turns where vibration jumps, and holds the unstable part between the two jumps.
The damping of a mesh acts also where its flanks have parted (the oil stays). SI units, frequencies circular (1/s).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.dynamics.balance import TOLERANCE, Balance, real_course
from gearcad.dynamics.excitation import Excitation
from gearcad.dynamics.floquet import growth
from gearcad.dynamics.periodic import (
    UNSTABLE,
    at_orders,
    both_sides,
    checked_frequencies,
    harmonic_orders,
    instability_warnings,
    periodic_response,
    turns_and_torques,
)
from gearcad.dynamics.response import PeriodicResponse
from gearcad.dynamics.system import System
from gearcad.errors import ParameterError, SolverError, as_choice

__all__ = ["Branch", "Direction", "sweep", "trace"]

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]
Wholes = NDArray[np.intp]

_MOST_POINTS = 4000
"""Of a branch: some hundred are usual; one that runs in circles never ends."""


class Direction(Enum):
    """How the speed changes in a sweep."""

    UP = "up"
    DOWN = "down"


@dataclass(frozen=True, kw_only=True, eq=False)
class Branch:
    """All periodic motions at `frequencies` (s,) that hang together, in the order in which the branch runs through them.

    Motion c is at frequency `index[c]`; `run` (c,) counts the turns of the branch before it; `approach` (c, q, m) are Fourier
    coefficients of the orders from 0 on; `stable` (c,) whether it lasts.
    """

    system: System
    excitation: Excitation
    frequencies: Floats
    harmonics: Wholes
    index: Wholes
    run: Wholes
    approach: Complexes
    stable: Bools

    def sweep(self, direction: Direction = Direction.UP) -> PeriodicResponse:
        """What is seen while the speed slowly rises or falls: a motion is kept as long as it lasts, then another is taken."""
        direction = as_choice("direction", direction, Direction)
        rising = direction is Direction.UP
        order = range(len(self.frequencies)) if rising else range(len(self.frequencies) - 1, -1, -1)
        chosen = np.zeros(len(self.frequencies), int)
        jumps: list[float] = []
        run = int(self.run.min() if rising else self.run.max())
        for i in order:
            here = np.flatnonzero(self.index == i)
            lasting = here[self.stable[here]]
            pool = lasting if len(lasting) else here
            chosen[i] = pool[np.argmin(np.abs(self.run[pool] - run))]
            # Two turns that lie between two frequencies leave no trace: only what is left behind makes a jump.
            if self.run[chosen[i]] != run and i != order[0]:
                jumps.append(float(self.frequencies[i]))
            run = int(self.run[chosen[i]])
        return self._response(chosen, np.array(jumps))

    def _response(self, chosen: Wholes, jumps: Floats) -> PeriodicResponse:
        balance = Balance(self.system, self.excitation, self.harmonics)
        approach, stable = self.approach[chosen], self.stable[chosen]
        flexible = at_orders(self.system, balance.static, self.excitation.fundamental * self.frequencies, self.harmonics)
        forces = balance.forces(both_sides(approach), self.excitation.fundamental * self.frequencies)[0]
        turns, torques = turns_and_torques(self.system, balance.static, flexible, forces[:, len(self.harmonics) - 1 :])
        return PeriodicResponse(
            system=self.system,
            excitation=self.excitation,
            frequencies=self.frequencies,
            harmonics=self.harmonics,
            approach_coefficients=approach,
            inertia_coefficients=turns,
            torque_coefficients=torques,
            stable=stable,
            jumps=jumps,
            warnings=instability_warnings(self.frequencies, stable),
        )


def sweep(
    system: System,
    excitation: Excitation,
    frequencies: ArrayLike,
    direction: Direction = Direction.UP,
    *,
    harmonics: int = 16,
) -> PeriodicResponse:
    """The run up (or down) through circular tooth frequencies of the first mesh (1/s), flanks parting; see `trace`."""
    return trace(system, excitation, frequencies, harmonics=harmonics).sweep(direction)


def trace(system: System, excitation: Excitation, frequencies: ArrayLike, *, harmonics: int = 16) -> Branch:
    """The branch of periodic motions over rising frequencies (1/s), from the lowest to the highest.

    Motions of twice the period, and branches that do not hang together with the one at the lowest frequency, are not looked
    for; where none of those found is stable, the response of a sweep says so. Raises SolverError where the branch ends.
    """
    excitation.fits(system)
    speeds = checked_frequencies(frequencies)
    if len(speeds) < 2 or (np.diff(speeds) <= 0).any():
        raise ParameterError("frequencies", f"{len(speeds)} values", "must be at least two that rise")
    balance = Balance(system, excitation, harmonic_orders(excitation, harmonics))
    begin = periodic_response(system, excitation, speeds[:1], harmonics=harmonics, stability=False)
    points = _follow(balance, both_sides(begin.approach_coefficients)[0], speeds * excitation.fundamental)
    index, run, approach = _at_frequencies(balance, points, speeds * excitation.fundamental)
    slopes = balance.slopes(approach)
    return Branch(
        system=system,
        excitation=excitation,
        frequencies=speeds,
        harmonics=balance.orders,
        index=index,
        run=run,
        approach=approach[:, len(balance.orders) - 1 :],
        stable=growth(system, excitation, speeds[index], slopes) <= UNSTABLE,
    )


def _follow(balance: Balance, approach: Complexes, omegas: Floats) -> list[tuple[Complexes, float]]:
    """Points (approach, omega) of the branch from the first of the frequencies to beyond the last."""
    low, high = float(omegas[0]), float(omegas[-1])
    started = balance.solve(approach, low)
    if started is None:
        raise SolverError(f"no periodic motion found at {low / balance.excitation.fundamental:g} 1/s: begin at another speed")
    scales = np.append(np.full(approach.size, balance.scale), 0.2 * (low + high))
    state = np.append(started.ravel(), low) / scales
    direction = np.zeros(len(state), complex)
    direction[-1] = 1
    direction = _tangent(balance, state, scales, direction)
    points = [(started, low)]
    step, longest = 0.01, 0.1
    while low <= points[-1][1] <= high:
        found = _correct(balance, state + step * direction, scales, direction)
        if step < 1e-7 or len(points) > _MOST_POINTS:
            where = points[-1][1] / balance.excitation.fundamental
            raise SolverError(f"the branch of periodic motions could not be followed beyond {where:g} 1/s")
        if found is None:
            step /= 2
            continue
        state, needed = found
        direction = _tangent(balance, state, scales, direction)
        points.append(((state * scales)[:-1].reshape(approach.shape), float((state * scales)[-1].real)))
        step = min(longest, step * 1.5) if needed <= 4 else step
    if points[-1][1] < low:
        raise SolverError("the branch of periodic motions turns back to the lowest speed: begin lower")
    return points


def _bordered(balance: Balance, state: Complexes, scales: Floats, direction: Complexes) -> tuple[Complexes, Complexes]:
    """Residual, and the scaled Jacobian with the direction as last row."""
    values = state * scales
    residual, jacobian, with_omega = balance.equations(values[:-1].reshape(len(balance.signed), -1), float(values[-1].real))
    whole = np.zeros((len(state), len(state)), complex)
    whole[:-1, :-1] = jacobian
    whole[:-1, -1] = with_omega * scales[-1] / scales[0]
    whole[-1] = direction.conj()
    return residual / scales[0], whole


def _tangent(balance: Balance, state: Complexes, scales: Floats, before: Complexes) -> Complexes:
    """Unit vector along the branch, onwards."""
    _, whole = _bordered(balance, state, scales, before)
    right = np.zeros(len(state), complex)
    right[-1] = 1
    found = np.linalg.solve(whole, right)
    return np.asarray(found / np.linalg.norm(found), complex)


def _correct(balance: Balance, guess: Complexes, scales: Floats, direction: Complexes) -> tuple[Complexes, int] | None:
    """The point of the branch square to the direction from a guess, and the Newton steps it took."""
    state = guess
    for count in range(1, 11):
        if state[-1].real <= 0:
            return None
        residual, whole = _bordered(balance, state, scales, direction)
        try:
            change = np.linalg.solve(whole, np.append(residual, np.vdot(direction, state - guess)))
        except np.linalg.LinAlgError:
            return None
        state = np.append(real_course((state - change)[:-1].reshape(len(balance.signed), -1)), (state - change)[-1].real)
        if not np.isfinite(state).all():
            return None
        if np.abs(change).max() <= TOLERANCE:
            return state, count
    return None


def _at_frequencies(
    balance: Balance, points: list[tuple[Complexes, float]], omegas: Floats
) -> tuple[Wholes, Wholes, Complexes]:
    """Where the branch crosses each frequency: which (c,), after how many turns (c,), and the motion there (c, q, m)."""
    index: list[int] = [0]
    runs: list[int] = [0]
    motions = [points[0][0]]
    run, rising = 0, True
    for (start, first), (end, second) in pairwise(points):
        if (second > first) != rising:
            run, rising = run + 1, not rising
        inside = np.flatnonzero((omegas > min(first, second)) & (omegas <= max(first, second)))
        for i in inside if rising else inside[::-1]:
            part = (omegas[i] - first) / (second - first)
            found = balance.solve(start + part * (end - start), float(omegas[i]))
            if found is not None:
                index.append(int(i))
                runs.append(run)
                motions.append(found)
    missing = np.setdiff1d(np.arange(len(omegas)), index)
    if len(missing):
        where = omegas[missing[0]] / balance.excitation.fundamental
        raise SolverError(f"no periodic motion found at {where:g} 1/s")
    return np.array(index), np.array(runs), np.array(motions)
