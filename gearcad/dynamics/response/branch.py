"""Flanks that part: the branch of periodic motions followed over speed, and what a run up or down shows of it.

The branch is followed by its arc length: it turns where vibration jumps, and holds the unstable part between the two jumps.
The damping of a mesh acts also where its flanks have parted (the oil stays). SI units, frequencies circular (1/s).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Bools, Complexes, Floats, Indices
from gearcad.dynamics.excitation.meshes import Excitation
from gearcad.dynamics.response.balance import Balance
from gearcad.dynamics.response.continuation import Arc, follow
from gearcad.dynamics.response.direction import Direction
from gearcad.dynamics.response.flexibility import at_orders, both_sides, told_by
from gearcad.dynamics.response.floquet import UNSTABLE, growth
from gearcad.dynamics.response.linear import checked_frequencies, harmonic_orders, periodic_response
from gearcad.dynamics.response.notices import Unstable, instability
from gearcad.dynamics.response.periodic import PeriodicResponse
from gearcad.dynamics.trains.system import System
from gearcad.errors import ParameterError, SolverError, as_choice
from gearcad.progress import Share, unheard

__all__ = ["Branch", "sweep", "trace"]


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
    arc: Arc
    index: Indices
    run: Indices
    approach: Complexes
    stable: Bools

    def sweep(self, direction: Direction = Direction.UP) -> PeriodicResponse:
        """What is seen while the speed slowly rises or falls: a motion is kept as long as it lasts, then another is taken."""
        chosen, jumps = self.seen(direction)
        return self.response(chosen, jumps)

    def seen(self, direction: Direction) -> tuple[Indices, Floats]:
        """Which motions (s,) a sweep shows, and the frequencies at which it goes over to another run of the branch."""
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
        """The same branch at other rising frequencies (1/s), within its own; at those where a motion is found."""
        return _crossed(self.arc, frequencies)

    def with_motions(self, others: Branch) -> Branch:
        """With those at other frequencies; its own motions come first."""
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
        """(c, q, m) of all orders from 0 on."""
        result = np.zeros((len(self.index), int(self.harmonics[-1]) + 1, self.approach.shape[2]), complex)
        result[:, self.harmonics] = self.approach
        return result

    def response(self, chosen: Indices, jumps: Floats | None = None) -> PeriodicResponse:
        """Some of the motions, in this order."""
        frequencies = self.frequencies[self.index[chosen]]
        balance = Balance(self.system, self.excitation, self.harmonics)
        approach, stable = self.approach[chosen], self.stable[chosen]
        flexible = at_orders(self.system, balance.static, self.excitation.fundamental * frequencies, self.harmonics)
        forces = balance.forces(both_sides(approach), self.excitation.fundamental * frequencies)[0]
        outputs = told_by(self.system, balance.static, flexible, forces[:, len(self.harmonics) - 1 :])
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
    """The run up (or down) through circular tooth frequencies of the first mesh (1/s), flanks parting; see `trace`."""
    return trace(system, excitation, frequencies, harmonics=harmonics).sweep(direction)


def trace(
    system: System, excitation: Excitation, frequencies: ArrayLike, *, harmonics: int = 16, share: Share = unheard
) -> Branch:
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
    omegas = speeds * excitation.fundamental
    arc = follow(balance, both_sides(begin.approach_coefficients)[0], float(omegas[0]), float(omegas[-1]), share)
    branch = _crossed(arc, speeds)
    missing = np.setdiff1d(speeds, branch.frequencies)
    if len(missing):
        raise SolverError(f"no periodic motion found at {missing[0]:g} 1/s")
    return branch


def _crossed(arc: Arc, speeds: Floats) -> Branch:
    """The motions of a branch at frequencies that rise."""
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
