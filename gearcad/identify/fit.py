"""The unknowns that readings and prior make most probable under a hypothesis, and how probable that makes the hypothesis.

With normal distributions that is least squares: the readings in units of their uncertainties, and the unknowns in units of the
spreads of a way to make the gear. Gauss-Newton's steps are taken in the space of the readings, for all ways at once, so that an
unknown may have no spread at all. The sum of squares at the least is a chi-square with as many degrees of freedom as readings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.identify.gauges import sensitivity
from gearcad.identify.measured import Measured
from gearcad.identify.prior import Hypothesis, Ways, ways
from gearcad.identify.unknowns import Unknown

__all__ = ["Fit", "fitted"]

_MOST_STEPS = 12
_SETTLED = 4
"""Steps after which the way to have made the gear stays: two that are as probable would take turns for ever."""

_UNUSUAL = 2.0
"""Spreads from what is usual."""

_CLOSE = 1e-3
"""Of a spread: the step that ends the search."""

_LEAST_HELIX, _MOST_HELIX = 1.0, 55.0
_MOST_RETREATS, _THICKER = 5, 0.25
_LONGEST = np.array([np.inf, 5.0, 8.0, 1.0, 1.0, 1.0, 2.0, 1.0])
"""Step that is taken of each unknown."""


@dataclass(frozen=True)
class Fit:
    """A hypothesis fitted: its `best` way and the `unknowns` by that, the logarithm of the probability of readings and
    hypothesis by each way (w,), the sum of squares, and means (w, u) and covariances (w, u, u) of the unknowns by each way.
    """

    hypothesis: Hypothesis
    ways: Ways
    best: int
    unknowns: Floats
    log_evidences: Floats
    chi_square: float
    means: Floats
    covariances: Floats

    @property
    def log_evidence(self) -> float:
        """Over all ways."""
        return float(np.logaddexp.reduce(self.log_evidences)) + self.hypothesis.log_weight

    @property
    def shares(self) -> Floats:
        """How much each way counts in uncertainties (w,): by the root of how probable it is, for the weights are judgement."""
        doubted = self.log_evidences / 2
        found: Floats = np.exp(doubted - np.logaddexp.reduce(doubted))
        return found

    @property
    def unusual(self) -> tuple[Unknown, ...]:
        """The unknowns that are two spreads of the best way or more from what is usual there, or the farthest of them."""
        spreads = np.sqrt(np.einsum("ij,ij->i", self.ways.roots[self.best], self.ways.roots[self.best]))
        off = np.abs(self.unknowns - self.ways.means[self.best])
        far = np.divide(off, spreads, out=np.zeros_like(off), where=spreads > 0)
        return tuple(each for each in Unknown if far[each] >= min(_UNUSUAL, far.max()))

    def uncertainty(self, unknown: Unknown) -> float:
        """Standard uncertainty of an unknown about its value here, other ways considered."""
        off = self.means[:, unknown] - self.unknowns[unknown]
        return float(np.sqrt(self.shares @ (self.covariances[:, unknown, unknown] + off**2)))

    @property
    def covariance(self) -> Floats:
        """Of the unknowns about their values here, other ways considered (u, u)."""
        off = self.means - self.unknowns
        spread: Floats = np.einsum("w,wij->ij", self.shares, self.covariances + off[:, :, None] * off[:, None, :])
        return spread


def fitted(measured: Measured, hypothesis: Hypothesis, start: Floats, steps: int = _MOST_STEPS) -> Fit | None:
    """The fit of a hypothesis from first values of the unknowns (u,); None where no such gear has these readings."""
    made = ways(hypothesis, measured.mate_teeth is not None)
    read = np.array([abs(each.value) for each in measured.readings])
    noise = np.diag([each.uncertainty**2 for each in measured.readings])
    spreads = np.sqrt(np.einsum("wij,wij->wi", made.roots, made.roots).max(axis=0))
    unknowns, before, taken = start, None, 0
    found: Fit | None = None
    for _ in range(steps + _MOST_RETREATS):
        here, slopes = sensitivity(measured, measured.readings, unknowns, made.varied)
        if not (np.all(np.isfinite(here)) and np.all(np.isfinite(slopes))):
            unknowns = _retreat(measured, unknowns, before)
            continue
        try:
            way = found.best if found is not None and taken >= _SETTLED else None
            found = _step(hypothesis, made, unknowns, read - here, slopes, noise, way)
        except np.linalg.LinAlgError:  # readings that differ by nothing but rounding
            return None
        step = np.clip(found.unknowns - unknowns, -_LONGEST, _LONGEST)
        before, unknowns = unknowns, unknowns + step
        if hypothesis.helical:
            unknowns[Unknown.HELIX_ANGLE] = np.clip(unknowns[Unknown.HELIX_ANGLE], _LEAST_HELIX, _MOST_HELIX)
        taken += 1
        if taken == steps or np.all(np.abs(step) <= _CLOSE * spreads):
            return found
    return None


def _retreat(measured: Measured, unknowns: Floats, before: Floats | None) -> Floats:
    """From where a ball falls to the base circle: half way back, or at first to thicker teeth, of a ring thinner ones."""
    if before is not None:
        return (unknowns + before) / 2
    thicker = unknowns.copy()
    thicker[Unknown.SHIFT] += -_THICKER if measured.ring else _THICKER
    return thicker


def _step(
    hypothesis: Hypothesis, made: Ways, unknowns: Floats, off: Floats, slopes: Floats, noise: Floats, way: int | None
) -> Fit:
    """The least of the sum of squares for readings that are linear in the unknowns, by every way; the best if none is set."""
    bent = slopes @ made.roots
    variance = noise + bent @ bent.transpose(0, 2, 1)
    miss = off - (made.means - unknowns) @ slopes.T
    weighed = np.linalg.solve(variance, miss[:, :, None])[:, :, 0]
    squares = np.einsum("wn,wn->w", miss, weighed)
    log_evidences = made.log_weights - (squares + np.linalg.slogdet(variance)[1]) / 2
    gain = made.roots @ bent.transpose(0, 2, 1)
    means = made.means + np.einsum("wun,wn->wu", gain, weighed)
    covariances = made.roots @ made.roots.transpose(0, 2, 1) - gain @ np.linalg.solve(variance, gain.transpose(0, 2, 1))
    best = int(np.argmax(log_evidences)) if way is None else way
    return Fit(hypothesis, made, best, means[best], log_evidences, float(squares[best]), means, covariances)
