"""A branch of periodic motions followed by its arc length, round the folds where it turns back. SI units."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from gearcad.arrays import Complexes, Floats, Indices
from gearcad.dynamics.response.balance import TOLERANCE, Balance, real_course
from gearcad.errors import SolverError
from gearcad.progress import Share, unheard

__all__ = ["Arc", "follow"]


_MOST_POINTS = 4000
"""Of a branch: some hundred are usual; one that runs in circles never ends."""

_SHARP = 1e-9
"""Relative, of the frequency at which a branch turns."""


@dataclass(frozen=True, eq=False)
class Arc:
    """Points of a branch one after the other: motions `approach` (q, m) of signed orders at `omega` of the common period."""

    balance: Balance
    points: tuple[tuple[Complexes, float], ...]

    @cached_property
    def folds(self) -> Floats:
        """Where (1/s, of the common period) the branch turns back."""
        omega = np.array([omega for _, omega in self.points])
        turns = np.diff(omega)[1:] * np.diff(omega)[:-1] < 0
        return omega[1:-1][turns]

    def crossings(self, omegas: Floats) -> tuple[Indices, Indices, Complexes]:
        """Which of rising omegas (s,) it crosses (c,), after how many turns (c,), and the motions (c, q, m) there."""
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


def follow(balance: Balance, approach: Complexes, low: float, high: float, share: Share = unheard) -> Arc:
    """The branch from the motion near `approach` (q, m) at `low` to beyond `high`. Raises SolverError where it ends before."""
    (started,), (found,) = balance.solve(approach[None], np.array([low]))
    if not found:
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
        share(max((points[-1][1] - low) / (high - low), len(points) / _MOST_POINTS))
    if points[-1][1] < low:
        raise SolverError("the branch of periodic motions turns back to the lowest speed: begin lower")
    return Arc(balance, tuple(_with_folds(balance, points, scales)))


def _with_folds(balance: Balance, points: list[tuple[Complexes, float]], scales: Floats) -> list[tuple[Complexes, float]]:
    """The points, and between them those where the frequency turns."""
    result = points[:1]
    for before, here, after in zip(points, points[1:], points[2:], strict=False):
        result.append(here)
        if (here[1] - before[1]) * (after[1] - here[1]) < 0:
            fold, place = _fold(balance, [before, here, after], scales)
            if place:
                result.insert(len(result) - (place < 0), fold)
    return [*result, points[-1]]


def _fold(balance: Balance, three: list[tuple[Complexes, float]], scales: Floats) -> tuple[tuple[Complexes, float], int]:
    """Where the branch turns near the middle one of three points, and whether that is before (-1) or behind (1) it."""
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
