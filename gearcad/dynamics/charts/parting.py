"""Loads over speed where flanks part: the branch of motions through all speeds at which they do, up and down.

SI units, frequencies are circular tooth frequencies of the first mesh (1/s).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gearcad.arrays import Bools, Floats, Indices
from gearcad.dynamics.charts.extremes import extremes
from gearcad.dynamics.charts.refine import speeds_between
from gearcad.dynamics.charts.speed_curves import SpeedCurves, Told
from gearcad.dynamics.response.branch import Branch, trace
from gearcad.dynamics.response.direction import Direction
from gearcad.dynamics.response.linear import harmonic_orders
from gearcad.errors import SolverError
from gearcad.progress import Share, part, unheard

__all__ = ["MOST_ROUNDS", "Parted", "parted"]


MOST_ROUNDS = 12
"""Of speeds between: each quarters the intervals about a maximum."""

_LEAST_HARMONICS = 12
"""Of motions that are followed."""

_MOST_UNKNOWNS = 80
"""Most harmonics, of all meshes together, of motions that are followed: the errors of 18 teeth would take minutes."""

_MARGIN = 0.9
"""A branch begins at so much of the lowest frequency at which flanks part, where they do not yet."""

_LOWER = 0.75
"""Where that does not do, or flanks are still parted at its end, so much of the frequency is tried; the end, over as much."""

_TRACED, _TOLD = 0.4, 0.8
"""Shares of the work: until the branch is followed, and until the loads of its motions are known. No more than a guess."""

_BESIDE = 1e-6
"""Relative: how near to a fold the motions on both sides of a jump are shown."""


@dataclass(frozen=True, eq=False)
class Parted:
    """A branch, the loads `told` of each of its motions, and which of them (s,) are seen running up, and running down."""

    branch: Branch
    told: Told
    curves: SpeedCurves

    def seen(self, direction: Direction) -> tuple[Told, Bools, Floats]:
        """Loads (s,) over the branch's frequencies, whether they last, and the frequencies of jumps."""
        chosen, jumps = self._chosen(direction)
        return self.told.at(chosen), self.branch.stable[chosen], jumps

    def refined(self, share: Share) -> Parted:
        """With speeds between, until both directions show every maximum."""
        of = self._with(_beside(self.branch))
        for number in range(MOST_ROUNDS):
            share(1 - 0.5**number)
            curves = [of.curves.curves(of.seen(direction)[0]) for direction in Direction]
            more = speeds_between(of.branch.frequencies, np.hstack(curves), 4 * _BESIDE)
            if not len(more):
                break
            of = of._with(more)
        return of

    def _with(self, frequencies: Floats) -> Parted:
        more = np.setdiff1d(frequencies, self.branch.frequencies)
        if not len(more):
            return self
        others = self.branch.at(more)
        if not len(others.frequencies):
            return self
        joined = Told.joined(self.told, loads(others, self.curves))
        return Parted(self.branch.with_motions(others), joined, self.curves)

    def at_least(self, frequencies: Floats) -> Parted:
        """Return the branch with motions at those of the frequencies (x,) in 1/s that it goes through."""
        return self._with(np.array([each for each in frequencies.tolist() if self.holds(each)]))

    def holds(self, frequency: float) -> bool:
        """Whether the branch goes through a frequency."""
        return bool(self.branch.frequencies[0] <= frequency <= self.branch.frequencies[-1])

    def running_up(self, frequency: float) -> tuple[Branch, Indices]:
        """A branch and which (1,) of its motions is seen running up to a frequency."""
        of = self._with(np.array([frequency]))
        chosen = of._chosen(Direction.UP)[0]
        return of.branch, chosen[of.branch.frequencies == frequency]

    def _chosen(self, direction: Direction) -> tuple[Indices, Floats]:
        """Which motions (s,) are seen, and the frequencies of jumps."""
        # Near a fold more harmonics may find no motion where fewer did: the fold is a little before.
        found = np.isfinite(self.told.left_out)
        return replace(self.branch, stable=self.branch.stable & found).seen(direction)


def parted(curves: SpeedCurves, frequencies: Floats, apart: Floats, *, share: Share = unheard) -> Parted:
    """Over rising frequencies (s,), through all at which flanks are `apart` (x,) in the linear motion, or that does not last.

    Raises SolverError where there is no such branch.
    """
    ends = np.array([_MARGIN * apart[0], apart[-1] / _MARGIN])
    places = np.searchsorted(frequencies, ends) + np.array([-1, 0])
    low, high = (int(place) for place in np.clip(places, 0, len(frequencies) - 1))
    high = max(high, min(low + 1, len(frequencies) - 1))
    while True:
        along, harmonics = frequencies[low : high + 1], _harmonics(curves, float(frequencies[low]))
        try:
            branch = trace(curves.system, curves.excitation, along, harmonics=harmonics, share=part(share, 0.0, _TRACED))
        except SolverError:
            if low == 0:
                raise
            low = max(0, int(np.searchsorted(frequencies, _LOWER * frequencies[low])) - 1)
            continue
        found = Parted(branch, loads(branch, curves, part(share, _TRACED, _TOLD)), curves)
        if high == len(frequencies) - 1 or found.seen(Direction.UP)[0].least[-1].min() > 0:
            return found.refined(part(share, _TOLD, 1.0))
        high = min(int(np.searchsorted(frequencies, frequencies[high] / _LOWER)), len(frequencies) - 1)


def _harmonics(curves: SpeedCurves, frequency: float) -> int:
    """Of the tooth frequencies; raises SolverError where these are too many unknowns."""
    meshes = len(curves.system.stiffness)
    wanted = float(curves.felt_orders(np.array([frequency]))[0]) / max(curves.excitation.orders)
    wanted = min(wanted, _MOST_UNKNOWNS)
    for count in range(max(int(np.ceil(wanted)), _LEAST_HARMONICS), _LEAST_HARMONICS - 1, -1):
        unknowns = meshes * len(harmonic_orders(curves.excitation, count))
        if unknowns <= _MOST_UNKNOWNS:
            return count
    errors = any(mesh.error is not None and mesh.error.teeth > 1 for mesh in curves.excitation.meshes)
    fewer = "leave tooth errors out" if errors else "give tooth numbers with which all comes again sooner"
    raise SolverError(f"motions in which they part would have {unknowns} harmonics here; {fewer} to see them")


def loads(branch: Branch, curves: SpeedCurves, share: Share = unheard) -> Told:
    """Of every motion of a branch, with as many harmonics as it needs; with its own where these lead astray."""
    start, frequencies = branch.coefficients(), branch.frequencies[branch.index]
    told = curves.told(frequencies, start, share)[0]
    astray = np.flatnonzero(np.isinf(told.left_out))
    if not len(astray):
        return told
    own = extremes(branch.response(astray), curves.references[1], curves.tracked)
    instead = Told.of(own, frequencies[astray], np.full(len(astray), np.inf))
    rows = np.arange(len(frequencies))
    rows[astray] = len(frequencies) + np.arange(len(astray))
    return Told.joined(told, instead).at(rows)


def _beside(branch: Branch) -> Floats:
    """Frequencies close to both sides of the folds."""
    near = np.concatenate([branch.folds * (1 - _BESIDE), branch.folds * (1 + _BESIDE)])
    return np.unique(near[(near > branch.frequencies[0]) & (near < branch.frequencies[-1])])
