"""Equilibrium of springs that are statically overdetermined, some of which can only press: the force method.

Forces in balance with the load are F = F_0 + Z y, and of all these the true ones make F C F/2 + e F least. A spring may be
rigid, C = 0, and the unknowns are as few as there are more springs than the balance needs: none at all where a set shares its
load by balance alone. What can only press has a compliance above 0 and the rest of the springs is not overdetermined, so there
is one least; Lawson and Hanson's least distance programming finds it in a finite number of steps, or that there is none.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.errors import SolverError

__all__ = ["Equilibrium"]

_RANK = 1e-10
"""Singular values below this part of the greatest are none."""

_BALANCE = 1e-9
"""Part of a load that may be left unbalanced by rounding."""

_PULL = 1e-12
"""Part of the greatest force by which rounding may let a spring pull."""

_NONE = 1e-10
"""Distance from a solution of the dual problem, of at most 1, below which there are no forces that only press."""


class _Balance(NamedTuple):
    """What of the springs is geometry: `inverse` (n, m) of V, self-stresses `redundant` (m, r), motions `free` (n, f)."""

    inverse: Floats
    redundant: Floats
    free: Floats


class _Measure(NamedTuple):
    """What energy makes of self-stresses: `moved` (m, r), of which each adds the same, and the compliance of the softest."""

    moved: Floats
    softest: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Equilibrium:
    """m springs of elongations V q - e between n coordinates: `vectors` V (m, n); those that can only `press` (m,) have F >= 0.

    Everywhere a row a case: compliances (s, m), gaps e (s, m) and loads (s, n), each for all cases or (1, ...) for every one,
    in any units that fit each other.
    """

    vectors: Floats
    press: Bools

    @cached_property
    def _balance(self) -> _Balance:
        left, values, right = np.linalg.svd(self.vectors)
        rank = int((values > _RANK * values[0]).sum())
        inverse = (right[:rank].T / values[:rank]) @ left[:, :rank].T
        return _Balance(inverse, left[:, rank:], right[rank:].T)

    @property
    def redundancy(self) -> int:
        """How many springs more there are than the balance needs: forces depend on stiffnesses and errors only if there are."""
        return int(self._balance.redundant.shape[1])

    @property
    def free(self) -> Floats:
        """Motions (n, f) that stretch no spring."""
        return self._balance.free

    def unbalanced(self, load: Floats) -> Floats:
        """The part (s, n) of a load that no spring can carry, 0 but for rounding where all of it is carried."""
        found: Floats = load @ self.free @ self.free.T
        found[np.abs(found).max(axis=1) <= _BALANCE * np.abs(load).max(axis=1)] = 0.0
        return found

    def forces(self, compliance: Floats, gap: Floats, load: Floats) -> tuple[Floats, Floats]:
        """Forces (s, m), and how far springs that can only press are open (s, m).

        Raises SolverError where something would have to pull.
        """
        forces = self.two_sided(compliance, gap, load)
        opening = np.zeros_like(forces)
        pulling = forces[:, self.press] < -_PULL * np.abs(forces).max(axis=1, keepdims=True)
        measure = None
        for case in np.flatnonzero(pulling.any(axis=1)):
            if measure is None or len(compliance) > 1:
                measure = self._measured(compliance[case if len(compliance) > 1 else 0])
            forces[case], opening[case] = self._pressed(measure, forces[case])
        forces[:, self.press] = np.maximum(forces[:, self.press], 0.0)
        return forces, opening

    def two_sided(self, compliance: Floats, gap: Floats, load: Floats) -> Floats:
        """Forces (s, m) as if all springs could pull, too."""
        inverse, redundant, _ = self._balance
        cases = max(map(len, (compliance, gap, load)))
        balanced = np.broadcast_to(load @ inverse, (cases, len(redundant)))
        if not self.redundancy:
            return balanced.copy()
        products = np.einsum("mi,mj->mij", redundant, redundant).reshape(len(redundant), -1)
        matrix = (compliance @ products).reshape(-1, self.redundancy, self.redundancy)
        needed = (compliance * balanced + gap) @ redundant
        found: Floats = balanced - np.linalg.solve(matrix, needed[..., None])[..., 0] @ redundant.T
        return found

    def displacement(self, elongation: Floats) -> Floats:
        """q (s, n) of elongations V q (s, m), which are C F + e less what is open; of what no spring holds, the least."""
        found: Floats = elongation @ self._balance.inverse.T
        return found

    def _measured(self, compliance: Floats) -> _Measure:
        """Of compliances (m,): L L' = Z' C Z over the softest spring."""
        redundant, softest = self._balance.redundant, compliance.max()
        root = np.linalg.cholesky((redundant.T * (compliance / softest)) @ redundant)
        return _Measure(np.asarray(np.linalg.solve(root, redundant.T).T, float), float(softest))

    def _pressed(self, measure: _Measure, forces: Floats) -> tuple[Floats, Floats]:
        """From the forces (m,) of a case as if springs could pull: forces (m,) where they cannot, and openings (m,).

        Of L' (y - y_0) the least is sought that keeps all F >= 0 (Lawson and Hanson, chapter 23).
        """
        from scipy.optimize import nnls

        scale = np.abs(forces).max()
        rows = np.vstack([measure.moved[self.press].T, -forces[self.press] / scale])
        target = np.r_[np.zeros(self.redundancy), 1.0]
        weights, rest = nnls(rows, target)
        if rest < _NONE:
            raise SolverError("no forces that only press are in balance with the load")
        left = rows @ weights - target
        opening = np.zeros_like(forces)
        opening[self.press] = -weights / left[-1] * scale * measure.softest
        found: Floats = forces - scale * (measure.moved @ left[:-1]) / left[-1]
        return found, opening
