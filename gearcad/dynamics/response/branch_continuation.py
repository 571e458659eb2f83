"""Continuation of the branch of periodic motions over speed where flanks part, and the jumps of a run up or down.

The branch is followed by its arc length: it turns where vibration jumps, and holds the unstable part between the two jumps. The
damping of a mesh acts also where its flanks have parted (the oil stays). Tooth forces are computed in time and taken back to
orders by FFT, their derivative likewise, so the Jacobian is exact. SI units, frequencies circular (1/s).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, SolverError, as_choice
from gearcad.core.records import Bools, Complexes, Floats, Indices
from gearcad.core.runtime import Share, unheard
from gearcad.dynamics.response.linear_response import UNSTABLE, checked_frequencies, growth, harmonic_orders, periodic_response
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import (
    Direction,
    Driven,
    PeriodicResponse,
    Unstable,
    at_orders,
    both_sides,
    instability,
    outputs_of,
    pressed,
)

_MOST_NEWTON = 30
_BLOCK = 1_000_000
"""Complex numbers that the derivatives of one block of motions may have."""

TOLERANCE = 1e-10
"""Last step of Newton's method, in static deflections."""


@dataclass(frozen=True, eq=False)
class HarmonicBalance(Driven):
    """Equations y - y_static - G (K y - N(y) + c e') = 0 of all orders, N the forces of the teeth. Orders are signed here."""

    orders: Indices

    @cached_property
    def signed(self) -> Indices:
        """Orders (2q - 1,) on both sides of 0."""
        return np.concatenate([-self.orders[:0:-1], self.orders])

    @cached_property
    def count(self) -> int:
        """Number of samples in time, so that products of the highest orders are not mistaken for lower ones."""
        return int(max(256, 2 ** int(np.ceil(np.log2(8 * max(int(self.orders[-1]), 1))))))

    @cached_property
    def stiffness(self) -> Floats:
        """Mesh stiffness (t, m) in N/m, without the orders that the samples cannot resolve."""
        coefficients = self.excitation.ratio_coefficients(self.count // 2 - 1) * self.system.stiffness
        return np.asarray(np.fft.irfft(coefficients * self.count, self.count, axis=0), float)

    @cached_property
    def errors(self) -> Floats:
        """Transmission errors (t, m) in m at the samples."""
        return self.excitation.errors(2 * np.pi * np.arange(self.count) / self.count)

    @cached_property
    def error_rates(self) -> Complexes:
        """Coefficients (q, m) of c de/dtheta."""
        half = self.excitation.error_coefficients(int(self.orders[-1]))[self.orders]
        return np.asarray(both_sides(half[None])[0] * 1j * self.signed[:, None] * self.system.mesh_damping, complex)

    def gaps(self, approach: Complexes) -> Floats:
        """Return y - e (..., t, m) in m."""
        spectrum = np.zeros((*approach.shape[:-2], self.count, approach.shape[-1]), complex)
        spectrum[..., self.signed, :] = approach
        return np.asarray(np.fft.ifft(spectrum, axis=-2).real * self.count - self.errors, float)

    def slopes(self, approach: Complexes) -> Floats:
        """Return k(t) g'(y - e) (..., t, m) in N/m."""
        gap, backlash = self.senses * self.gaps(approach), self.excitation.backlashes
        apart = (gap <= 0) & ~(gap <= -backlash) & ~np.isnan(backlash)
        return np.asarray(np.where(apart, 0.0, self.stiffness), float)

    def forces(self, approach: Complexes, omega: Floats | float) -> tuple[Complexes, Complexes]:
        """Return K y - N(y) + c e' (..., q, m), and its derivative with respect to omega."""
        carried = self.stiffness * pressed(self.gaps(approach), self.excitation.backlashes, self.senses)
        spectrum = np.fft.fft(carried, axis=-2)[..., self.signed, :] / self.count
        rate = self.error_rates
        return approach * self.system.stiffness - spectrum + np.asarray(omega)[..., None, None] * rate, rate

    def equations(self, approach: Complexes, omega: float) -> tuple[Complexes, Complexes, Complexes]:
        """Return the residual (qm,) and its derivatives (qm, qm) with respect to the approach and (qm,) to omega."""
        residual, jacobian, forces, mesh = self._linearised(approach[None], np.array([omega]))
        step = 1e-6 * omega
        beside = both_sides(at_orders(self.system, self.static, omega + np.array([step, -step]), self.orders).mesh)
        bend = (beside[0] - beside[1]) / (2 * step)
        with_omega = -np.einsum("hij,hj->hi", bend, forces[0]) - np.einsum("hij,hj->hi", mesh[0], self.error_rates)
        pushed = self.pushed(omega + np.array([step, -step]), self.orders)
        change = (pushed.approach[0] - pushed.approach[1]) / (2 * step)
        with_omega[len(self.orders) - 1 + pushed.rows] -= change
        with_omega[len(self.orders) - 1 - pushed.rows] -= change.conj()
        return residual[0], jacobian[0], with_omega.ravel()

    def _linearised(self, approach: Complexes, omega: Floats) -> tuple[Complexes, Complexes, Complexes, Complexes]:
        """Return of motions (s, q, m) residuals (s, qm), derivatives (s, qm, qm), forces (s, q, m),
        flexibilities (s, q, m, m).
        """
        mesh = both_sides(at_orders(self.system, self.static, omega, self.orders).mesh)
        forces = self.forces(approach, omega)[0]
        residual = approach - np.einsum("shij,shj->shi", mesh, forces)
        pushed, middle = self.pushed(omega, self.orders), len(self.orders) - 1
        residual[:, middle] -= self.static.approach
        residual[:, middle + pushed.rows] -= pushed.approach
        residual[:, middle - pushed.rows] -= pushed.approach.conj()
        spectrum = np.fft.fft(self.slopes(approach), axis=-2) / self.count
        spectrum[:, 0] -= self.system.stiffness
        coupling = spectrum[:, np.mod(self.signed[:, None] - self.signed, self.count)]
        size = residual[0].size
        jacobian = np.eye(size) + np.einsum("shij,shlj->shilj", mesh, coupling).reshape(-1, size, size)
        return residual.reshape(-1, size), jacobian, forces, mesh

    def solve(self, approach: Complexes, omega: Floats) -> tuple[Complexes, Bools]:
        """Return motions (s, q, m) at frequencies (s,), by Newton's method from near ones, and whether each
        of them converges.
        """
        approach, found = np.array(approach), np.zeros(len(omega), bool)
        block = max(1, _BLOCK // approach[0].size ** 2) if len(omega) else 1
        for i in range(0, len(omega), block):
            self._newton(approach, omega, found, np.arange(i, min(i + block, len(omega))))
        return approach, found

    def _newton(self, approach: Complexes, omega: Floats, found: Bools, rows: Indices) -> None:
        """Apply Newton's steps to some rows of the motions, in place; `found` marks those that converge."""
        for _ in range(_MOST_NEWTON):
            residual, jacobian, *_ = self._linearised(approach[rows], omega[rows])
            change = np.linalg.solve(jacobian, residual[:, :, None]).reshape(len(rows), *approach.shape[1:])
            approach[rows] = real_course(approach[rows] - change)
            largest = np.abs(change).max(axis=(1, 2))
            done = largest <= TOLERANCE * self.scale
            found[rows[done]] = True
            rows = rows[~done & np.isfinite(largest)]
            if not len(rows):
                return


def real_course(approach: Complexes) -> Complexes:
    """Return coefficients (..., q, m) of signed orders without what rounding adds and no real motion has: it would grow."""
    return np.asarray((approach + approach[..., ::-1, :].conj()) / 2, complex)


_MOST_POINTS = 4000
"""Greatest number of points of a branch: some hundred are usual; a branch that runs in circles never ends."""

_SHARP = 1e-9
"""Relative accuracy of the frequency at which a branch turns."""


@dataclass(frozen=True, eq=False)
class BranchArc:
    """Points of a branch one after the other: motions `approach` (q, m) of signed orders at `omega` of the common period."""

    balance: HarmonicBalance
    points: tuple[tuple[Complexes, float], ...]

    @cached_property
    def folds(self) -> Floats:
        """Frequencies (1/s, of the common period) at which the branch turns back."""
        omega = np.array([omega for _, omega in self.points])
        turns = np.diff(omega)[1:] * np.diff(omega)[:-1] < 0
        return omega[1:-1][turns]

    def crossings(self, omegas: Floats) -> tuple[Indices, Indices, Complexes]:
        """Return which of rising omegas (s,) it crosses (c,), after how many turns (c,), and the motions (c, q, m) there."""
        first = int(omegas[0] == self.points[0][1])
        index, runs, guesses, run, rising = [0] * first, [0] * first, [self.points[0][0]] * first, 0, True
        for (start, low), (end, high) in pairwise(self.points):
            if (high > low) != rising:
                run, rising = run + 1, not rising
            inside = np.flatnonzero((omegas > min(low, high)) & (omegas <= max(low, high)))
            for i in inside if rising else inside[::-1]:
                index.append(int(i))
                runs.append(run)
                guesses.append(start + (omegas[i] - low) / (high - low) * (end - start))
        which = np.array(index, np.intp)
        approach, found = self.balance.solve(np.array(guesses).reshape(-1, *self.points[0][0].shape), omegas[which])
        return which[found], np.array(runs, np.intp)[found], approach[found]


def follow(balance: HarmonicBalance, approach: Complexes, low: float, high: float, share: Share = unheard) -> BranchArc:
    """Return the branch from the motion near `approach` (q, m) at `low` to beyond `high`.

    Raises SolverError if the branch ends before.
    """
    (started,), (found,) = balance.solve(approach[None], np.array([low]))
    if not found:
        raise SolverError(f"no periodic motion found at {low / balance.excitation.fundamental:g} 1/s: start at another speed")
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
            raise SolverError(
                f"the branch of periodic motions could not be followed beyond {where:g} 1/s: choose a range that ends there"
            )
        if found is None:
            step /= 2
            continue
        state, needed = found
        direction = _tangent(balance, state, scales, direction)
        points.append(((state * scales)[:-1].reshape(approach.shape), float((state * scales)[-1].real)))
        step = min(longest, step * 1.5) if needed <= 4 else step
        share(max((points[-1][1] - low) / (high - low), len(points) / _MOST_POINTS))
    if points[-1][1] < low:
        raise SolverError("the branch of periodic motions turns back to the lowest speed: start at a lower one")
    return BranchArc(balance, tuple(_with_folds(balance, points, scales)))


def _with_folds(
    balance: HarmonicBalance, points: list[tuple[Complexes, float]], scales: Floats
) -> list[tuple[Complexes, float]]:
    """Return the points, with those between them at which the frequency turns."""
    result = points[:1]
    for before, here, after in zip(points, points[1:], points[2:], strict=False):
        result.append(here)
        if (here[1] - before[1]) * (after[1] - here[1]) < 0:
            fold, place = _fold(balance, [before, here, after], scales)
            if place:
                result.insert(len(result) - (place < 0), fold)
    return [*result, points[-1]]


def _fold(
    balance: HarmonicBalance, three: list[tuple[Complexes, float]], scales: Floats
) -> tuple[tuple[Complexes, float], int]:
    """Return the point where the branch turns near the middle one of three, and its place: before (-1) or behind (1) that."""
    states = [np.append(approach.ravel(), omega) / scales for approach, omega in three]
    along = (states[2] - states[0]) / np.linalg.norm(states[2] - states[0])
    places = [float(np.vdot(along, state - states[1]).real) for state in states]
    for _ in range(8):
        heights = [float(state[-1].real) for state in states]
        (second, first, _), middle = np.polyfit(places, heights, 2), places[1]
        place = float(np.clip(-first / (2 * second), places[0], places[2])) if second else middle
        weights = [np.prod([(place - other) / (own - other) for other in places if other != own]) for own in places]
        found = _correct(balance, np.asarray(sum(w * s for w, s in zip(weights, states, strict=True))), scales, along)
        if found is None or place in places:
            break
        done = abs(float(found[0][-1].real) - heights[1]) < _SHARP * heights[1]
        order = np.argsort([*places, place])
        together = [[*states, found[0]][i] for i in order], [[*places, place][i] for i in order]
        best = int(np.argmax([np.sign(-second) * state[-1].real for state in together[0]]))
        best = min(max(best, 1), 2)
        states, places = together[0][best - 1 : best + 2], together[1][best - 1 : best + 2]
        if done:
            break
    values = states[1] * scales
    motion = np.asarray(values[:-1].reshape(three[0][0].shape), complex)
    return (motion, float(values[-1].real)), int(np.sign(places[1]))


def _bordered(balance: HarmonicBalance, state: Complexes, scales: Floats, direction: Complexes) -> tuple[Complexes, Complexes]:
    """Return the residual, and the scaled Jacobian with the direction as last row."""
    values = state * scales
    residual, jacobian, with_omega = balance.equations(values[:-1].reshape(len(balance.signed), -1), float(values[-1].real))
    whole = np.zeros((len(state), len(state)), complex)
    whole[:-1, :-1] = jacobian
    whole[:-1, -1] = with_omega * scales[-1] / scales[0]
    whole[-1] = direction.conj()
    return residual / scales[0], whole


def _tangent(balance: HarmonicBalance, state: Complexes, scales: Floats, before: Complexes) -> Complexes:
    """Return the unit vector along the branch, onwards."""
    _, whole = _bordered(balance, state, scales, before)
    right = np.zeros(len(state), complex)
    right[-1] = 1
    found = np.linalg.solve(whole, right)
    return np.asarray(found / np.linalg.norm(found), complex)


def _correct(balance: HarmonicBalance, guess: Complexes, scales: Floats, direction: Complexes) -> tuple[Complexes, int] | None:
    """Return the point of the branch square to the direction from a guess, and the number of Newton steps;
    None if not found.
    """
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


@dataclass(frozen=True, kw_only=True, eq=False)
class Branch:
    """All periodic motions at `frequencies` (s,) that hang together, in the order in which the branch runs through them.

    Motion c is at frequency `index[c]`; `run` (c,) counts the turns of the branch before it; `approach` (c, q, m) are Fourier
    coefficients of the orders from 0 on; `stable` (c,) whether it lasts.
    """

    system: System
    excitation: Excitation
    frequencies: Floats
    harmonics: Indices
    arc: BranchArc
    index: Indices
    run: Indices
    approach: Complexes
    stable: Bools

    def sweep(self, direction: Direction = Direction.UP) -> PeriodicResponse:
        """Return the response to a slowly rising or falling speed: a motion is kept while it lasts, then another is taken."""
        chosen, jumps = self.seen(direction)
        return self.response(chosen, jumps)

    def seen(self, direction: Direction) -> tuple[Indices, Floats]:
        """Return which motions (s,) a sweep shows, and the frequencies (1/s) at which it goes to another run of the branch."""
        direction = as_choice("direction", direction, Direction)
        rising = direction is Direction.UP
        order = range(len(self.frequencies)) if rising else range(len(self.frequencies) - 1, -1, -1)
        chosen = np.zeros(len(self.frequencies), int)
        jumps: list[float] = []
        motions = np.split(np.argsort(self.index, kind="stable"), np.cumsum(np.bincount(self.index))[:-1])
        run = int(self.run.min() if rising else self.run.max())
        for i in order:
            here = motions[i]
            lasting = here[self.stable[here]]
            pool = lasting if len(lasting) else here
            chosen[i] = pool[np.argmin(np.abs(self.run[pool] - run))]
            # Two turns that lie between two frequencies leave no trace: only what is left behind makes a jump.
            if self.run[chosen[i]] != run and i != order[0]:
                jumps.append(float(self.frequencies[i]))
            run = int(self.run[chosen[i]])
        return chosen, np.array(jumps)

    @property
    def folds(self) -> Floats:
        """Frequencies (1/s) at which the branch turns back: where a motion that lasts meets one that does not."""
        return np.sort(self.arc.folds) / self.excitation.fundamental

    def at(self, frequencies: Floats) -> Branch:
        """Return the same branch at other rising frequencies (1/s) within its own, at those where a motion is found."""
        return _crossed(self.arc, frequencies)

    def with_motions(self, others: Branch) -> Branch:
        """Return the branch with its own motions first, then those of `others` at other frequencies."""
        frequencies = np.union1d(self.frequencies, others.frequencies)
        index = [np.searchsorted(frequencies, each.frequencies[each.index]) for each in (self, others)]
        return replace(
            self,
            frequencies=frequencies,
            index=np.concatenate(index),
            run=np.concatenate([self.run, others.run]),
            approach=np.concatenate([self.approach, others.approach]),
            stable=np.concatenate([self.stable, others.stable]),
        )

    def coefficients(self) -> Complexes:
        """Return Fourier coefficients (c, q, m) of all orders from 0 on."""
        result = np.zeros((len(self.index), int(self.harmonics[-1]) + 1, self.approach.shape[2]), complex)
        result[:, self.harmonics] = self.approach
        return result

    def response(self, chosen: Indices, jumps: Floats | None = None) -> PeriodicResponse:
        """Return the response of some of the motions, in this order."""
        frequencies = self.frequencies[self.index[chosen]]
        balance = HarmonicBalance(self.system, self.excitation, self.harmonics)
        approach, stable = self.approach[chosen], self.stable[chosen]
        flexible = at_orders(self.system, balance.static, self.excitation.fundamental * frequencies, self.harmonics)
        forces = balance.forces(both_sides(approach), self.excitation.fundamental * frequencies)[0]
        pushed = balance.pushed(self.excitation.fundamental * frequencies, self.harmonics)
        outputs = outputs_of(self.system, balance.static, flexible, forces[:, len(self.harmonics) - 1 :], pushed)
        return PeriodicResponse(
            system=self.system,
            excitation=self.excitation,
            frequencies=frequencies,
            harmonics=self.harmonics,
            approach_coefficients=approach,
            inertia_coefficients=outputs.turns,
            torque_coefficients=outputs.torques,
            travel_coefficients=outputs.travels,
            stable=stable,
            jumps=np.zeros(0) if jumps is None else jumps,
            notices=instability(frequencies, stable, Unstable.PARTING if self.excitation.parting else Unstable.LINEAR),
        )


def sweep(
    system: System,
    excitation: Excitation,
    frequencies: ArrayLike,
    direction: Direction = Direction.UP,
    *,
    harmonics: int = 16,
) -> PeriodicResponse:
    """Return the run up (or down) through circular tooth frequencies of the first mesh (1/s), flanks parting; see `trace`."""
    return trace(system, excitation, frequencies, harmonics=harmonics).sweep(direction)


def trace(
    system: System, excitation: Excitation, frequencies: ArrayLike, *, harmonics: int = 16, share: Share = unheard
) -> Branch:
    """Return the branch of periodic motions over rising frequencies (1/s), from the lowest to the highest.

    Motions of twice the period, and branches not connected to the one at the lowest frequency, are not looked for. Where no
    motion found is stable, the response of a sweep says so. Raises SolverError if the branch ends.
    """
    excitation.fits(system)
    speeds = checked_frequencies(frequencies)
    if len(speeds) < 2 or (np.diff(speeds) <= 0).any():
        raise ParameterError("frequencies", f"{len(speeds)} values", "must be at least two that rise")
    balance = HarmonicBalance(system, excitation, harmonic_orders(excitation, harmonics))
    begin = periodic_response(system, excitation, speeds[:1], harmonics=harmonics, stability=False)
    omegas = speeds * excitation.fundamental
    arc = follow(balance, both_sides(begin.approach_coefficients)[0], float(omegas[0]), float(omegas[-1]), share)
    branch = _crossed(arc, speeds)
    missing = np.setdiff1d(speeds, branch.frequencies)
    if len(missing):
        raise SolverError(f"no periodic motion found at {missing[0]:g} 1/s")
    return branch


def _crossed(arc: BranchArc, speeds: Floats) -> Branch:
    """Return the motions of a branch at frequencies that rise."""
    balance = arc.balance
    fundamental = balance.excitation.fundamental
    index, run, approach = arc.crossings(speeds * fundamental)
    kept, index = np.unique(index, return_inverse=True)
    speeds = speeds[kept]
    slopes = balance.slopes(approach)
    return Branch(
        system=balance.system,
        excitation=balance.excitation,
        frequencies=speeds,
        harmonics=balance.orders,
        arc=arc,
        index=index,
        run=run,
        approach=approach[:, len(balance.orders) - 1 :],
        stable=growth(balance.system, balance.excitation, speeds[index], slopes) <= UNSTABLE,
    )
