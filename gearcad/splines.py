"""Piecewise cubics through values at places: what plane bodies, courses and flanks are read from between their places.

Formulas of SciPy's `CubicSpline` (not-a-knot ends) and `PchipInterpolator`; the import of `scipy.interpolate` takes longer than
all that a plane check asks of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Indices

__all__ = ["PiecewiseCubic", "cubic_spline", "monotone_spline"]


@dataclass(frozen=True)
class PiecewiseCubic:
    """Cubics between `places` (n,), which rise: `powers` (4, n - 1, ...) of the distance from the place before, cubic first.

    Beyond its ends the first and the last one go on.
    """

    places: Floats
    powers: Floats

    def __call__(self, at: Floats | float) -> Floats:
        """Values (..., of each place) at places (...)."""
        cubic, square, slope, value, past = self._around(np.asarray(at, float))
        result: Floats = ((cubic * past + square) * past + slope) * past + value
        return result

    def integral(self, at: Floats | float) -> Floats:
        """Integrals from the first place to places (...)."""
        at = np.asarray(at, float)
        cubic, square, slope, value, past = self._around(at)
        within = (((cubic / 4 * past + square / 3) * past + slope / 2) * past + value) * past
        result: Floats = self._before[self._piece(at)] + within
        return result

    def _piece(self, at: Floats) -> Indices:
        return self.places[1:-1].searchsorted(at, "right")

    def _around(self, at: Floats) -> tuple[Floats, ...]:
        """The powers of the pieces at places, and how far past the beginning of a piece these are."""
        piece = self._piece(at)
        past = at - self.places[piece]
        return *(power.take(piece, axis=0) for power in self.powers), past.reshape(past.shape + (1,) * (self.powers.ndim - 2))

    @cached_property
    def _before(self) -> Floats:
        """Integrals (n - 1, ...) from the first place to the beginning of each piece."""
        width = np.diff(self.places).reshape(-1, *(1,) * (self.powers.ndim - 2))
        cubic, square, slope, value = self.powers
        each = (((cubic / 4 * width + square / 3) * width + slope / 2) * width + value) * width
        return np.concatenate([np.zeros_like(each[:1]), np.cumsum(each[:-1], axis=0)])


def cubic_spline(places: Floats, values: Floats) -> PiecewiseCubic:
    """The spline through `values` (n, ...) at `places` (n,), n at least 2; its first two cubics are one, and its last two."""
    count, width = len(places), np.diff(places)
    across = width.reshape(-1, *(1,) * (values.ndim - 1))
    chord = np.diff(values, axis=0) / across
    if count == 2:
        return _by_slopes(places, values, np.concatenate([chord, chord]))
    matrix, right = np.zeros((count, count)), np.zeros(values.shape)
    inner = np.arange(1, count - 1)
    matrix[inner, inner - 1], matrix[inner, inner + 1] = width[1:], width[:-1]
    matrix[inner, inner] = 2 * (width[:-1] + width[1:])
    right[1:-1] = 3 * (across[1:] * chord[:-1] + across[:-1] * chord[1:])
    if count == 3:  # one parabola
        matrix[0, :2] = matrix[2, 1:] = 1.0
        right[0], right[2] = 2 * chord
    else:
        for end, beside, next_to, step in ((0, 0, 1, 1), (-1, -1, -2, -1)):
            both = width[beside] + width[next_to]
            matrix[end, end], matrix[end, end + step] = width[next_to], both
            right[end] = (width[beside] + 2 * both) * width[next_to] * chord[beside] + width[beside] ** 2 * chord[next_to]
            right[end] /= both
    slopes: Floats = np.asarray(np.linalg.solve(matrix, right.reshape(count, -1)), float).reshape(values.shape)
    return _by_slopes(places, values, slopes)


def monotone_spline(places: Floats, values: Floats) -> PiecewiseCubic:
    """Cubics through `values` (n, ...) at `places` (n,), n at least 3, that turn where the values do (Fritsch and Butland)."""
    width = np.diff(places).reshape(-1, *(1,) * (values.ndim - 1))
    chord = np.diff(values, axis=0) / width
    before, after = width[:-1] + 2 * width[1:], 2 * width[:-1] + width[1:]
    turns = chord[:-1] * chord[1:] <= 0
    safe_before, safe_after = np.where(turns, 1.0, chord[:-1]), np.where(turns, 1.0, chord[1:])
    inner = np.where(turns, 0.0, (before + after) / (before / safe_before + after / safe_after))
    first = _end_slope(width[0], width[1], chord[0], chord[1])
    last = _end_slope(width[-1], width[-2], chord[-1], chord[-2])
    return _by_slopes(places, values, np.concatenate([first[None], inner, last[None]]))


def _end_slope(width: Floats, further: Floats, chord: Floats, next_chord: Floats) -> Floats:
    """By three points, without another turn in the last piece."""
    slope = ((2 * width + further) * chord - width * next_chord) / (width + further)
    steep = (np.sign(chord) != np.sign(next_chord)) & (np.abs(slope) > 3 * np.abs(chord))
    result: Floats = np.where(np.sign(slope) != np.sign(chord), 0.0, np.where(steep, 3 * chord, slope))
    return result


def _by_slopes(places: Floats, values: Floats, slopes: Floats) -> PiecewiseCubic:
    width = np.diff(places).reshape(-1, *(1,) * (values.ndim - 1))
    chord = np.diff(values, axis=0) / width
    bend = (slopes[:-1] + slopes[1:] - 2 * chord) / width
    powers = np.stack([bend / width, (chord - slopes[:-1]) / width - bend, slopes[:-1], values[:-1]])
    return PiecewiseCubic(places, powers)
