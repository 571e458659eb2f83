"""Cubic splines through values: twice smooth, and at both ends one cubic through the outer three steps (not-a-knot)."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats

__all__ = ["SPLINE_PLACES", "Spline"]

SPLINE_PLACES = 4
"""That a spline needs at least."""


class Spline:
    """Through values (n, ...) at rising places (n,), four or more. Beyond the first and the last place its end pieces go on.

    That of `scipy.interpolate.CubicSpline`, whose import takes longer than the stiffness of a mesh in closed form.
    """

    def __init__(self, places: Floats, values: Floats) -> None:
        if len(places) < SPLINE_PLACES:
            raise ValueError(f"a spline needs {SPLINE_PLACES} places, and has {len(places)}")
        self.places, self.values = np.asarray(places, float), np.asarray(values, float)

    def __call__(self, at: Floats) -> Floats:
        """Values (m, ...) at places (m,)."""
        piece, t = self._found(at)
        a, b, c, d = self._pieces
        result: Floats = a[piece] + t * (b[piece] + t * (c[piece] + t * d[piece]))
        return result

    def integral(self, at: Floats) -> Floats:
        """From the first place to places (m,): (m, ...)."""
        piece, t = self._found(at)
        a, b, c, d = self._pieces
        result: Floats = self._sums[piece] + t * (a[piece] + t * (b[piece] / 2 + t * (c[piece] / 3 + t * d[piece] / 4)))
        return result

    def _found(self, at: Floats) -> tuple[NDArray[np.intp], Floats]:
        """The piece in which places are, and how far past its start, as values are shaped."""
        at = np.asarray(at, float)
        piece = np.clip(np.searchsorted(self.places, at, side="right") - 1, 0, len(self.places) - 2)
        return piece, self._column(at - self.places[piece])

    def _column(self, of: Floats) -> Floats:
        return of.reshape(of.shape + (1,) * (self.values.ndim - 1))

    @cached_property
    def _pieces(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Coefficients (n - 1, ...) of the powers 0 to 3 of the distance from the start of each piece."""
        step = np.diff(self.places)
        h = self._column(step)
        rise = np.diff(self.values, axis=0) / h
        slope = self._slopes(step.tolist(), h, rise)
        bend = (slope[:-1] + slope[1:] - 2 * rise) / h
        return self.values[:-1], slope[:-1], (rise - slope[:-1]) / h - bend, bend / h

    @staticmethod
    def _slopes(step: list[float], h: Floats, rise: Floats) -> Floats:
        """At all places (n, ...): three neighbours in a row are one equation, solved from the first to the last and back."""
        first, last = step[0] + step[1], step[-2] + step[-1]
        before = [0.0, *step[1:], last]
        here = [step[1], *(2 * (one + other) for one, other in pairwise(step)), step[-2]]
        behind = [first, *step[:-1], 0.0]
        slope = np.empty((len(here), *rise.shape[1:]))
        slope[1:-1] = 3 * (h[1:] * rise[:-1] + h[:-1] * rise[1:])
        slope[0] = ((step[0] + 2 * first) * step[1] * rise[0] + step[0] ** 2 * rise[1]) / first
        slope[-1] = ((step[-1] + 2 * last) * step[-2] * rise[-1] + step[-1] ** 2 * rise[-2]) / last
        for row in range(1, len(here)):
            factor = before[row] / here[row - 1]
            here[row] -= factor * behind[row - 1]
            slope[row] -= factor * slope[row - 1]
        slope[-1] /= here[-1]
        for row in range(len(here) - 2, -1, -1):
            slope[row] = (slope[row] - behind[row] * slope[row + 1]) / here[row]
        return slope

    @cached_property
    def _sums(self) -> Floats:
        """Integrals (n - 1, ...) up to the start of each piece."""
        a, b, c, d = self._pieces
        h = self._column(np.diff(self.places))
        whole = h * (a + h * (b / 2 + h * (c / 3 + h * d / 4)))
        result: Floats = np.concatenate([np.zeros_like(whole[:1]), np.cumsum(whole[:-1], axis=0)])
        return result
