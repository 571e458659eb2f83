"""Amplitude spectra of sampled motions, and their peaks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.dynamics.maxima import apart
from gearcad.errors import ParameterError, require_number, require_whole

__all__ = ["SpectralPeak", "Spectrum", "amplitude_spectrum"]


class SpectralPeak(NamedTuple):
    """A local maximum of a spectrum: frequency in Hz, amplitude in the unit of the signal."""

    frequency: float
    amplitude: float


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Amplitudes (m,) at frequencies (m,) in Hz; the first is the mean, a sine shows its amplitude."""

    frequency: Floats
    amplitude: Floats

    def peaks(self, count: int = 6, *, distance: float = 20.0, above: float = 5.0) -> tuple[SpectralPeak, ...]:
        """The highest local maxima, highest first, at least `distance` Hz apart and above a frequency (Hz)."""
        require_whole("count", count, at_least=1, at_most=1000)
        bins = max(1, round(distance / float(self.frequency[1])))
        places = [place for place in apart(self.amplitude, bins).tolist() if self.frequency[place] > above]
        highest = sorted(places, key=lambda place: (-self.amplitude[place], place))[:count]
        return tuple(SpectralPeak(float(self.frequency[place]), float(self.amplitude[place])) for place in highest)


def amplitude_spectrum(signal: ArrayLike, sampling: float, highest: float | None = None) -> Spectrum:
    """Spectrum of a signal (n,) sampled so many times a second (Hz), up to a frequency `highest` (Hz; None: half of that).

    |X| 2/n, and |X|/n at 0 and at half the sampling, without a window: a sine of whole periods shows its amplitude.
    Raises ParameterError for fewer than two finite numbers, or frequencies not above 0.
    """
    import scipy.fft

    values = np.asarray(signal, float)
    if values.ndim != 1 or len(values) < 2 or not np.isfinite(values).all():
        raise ParameterError("signal", f"array of shape {values.shape}", "must be at least two finite numbers in a row")
    require_number("sampling", sampling, "Hz", above=0)
    n = len(values)
    kept = n // 2 + 1
    if highest is not None:
        require_number("highest", highest, "Hz", above=0)
        kept = min(kept, int(highest * n / sampling * (1 + 1e-12)) + 1)
    # The mean apart: a great one would hide small amplitudes in its rounding.
    mean = values.mean()
    amplitude = np.empty(kept)
    np.abs(scipy.fft.rfft(values - mean)[:kept], out=amplitude)
    amplitude *= 2 / n
    amplitude[0] = abs(mean)
    if n % 2 == 0 and kept == n // 2 + 1:
        amplitude[-1] /= 2
    return Spectrum(np.arange(kept, dtype=np.float64) * (sampling / n), amplitude)
