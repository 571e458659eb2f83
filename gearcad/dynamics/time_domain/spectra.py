"""Amplitude spectra of sampled motions at one speed and over speeds, and the maxima of sampled curves.

The maxima are those of `scipy.signal.find_peaks`, whose package takes 0.6 s to import: it brings statistics and images.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad.core.errors import ParameterError, require_number, require_whole
from gearcad.core.records import Floats, JsonObject, Notice, texts

Places = NDArray[np.intp]


def outstanding(values: Floats, prominence: float) -> Places:
    """Return the places of maxima that are at least `prominence` above the higher of the lowest values to both sides.

    Each side reaches up to where the curve is higher again.
    """
    found = _summits(values)
    return found[[_prominence(values, place) >= prominence for place in found.tolist()]]


def apart(values: Floats, distance: int) -> Places:
    """Return the places of maxima at least `distance` apart: a lower one gives way, of two that are alike the one before."""
    found = _summits(values)
    kept = np.ones(len(found), bool)
    first, last = (np.searchsorted(found, found + reach) for reach in (1 - distance, distance))
    for peak in np.argsort(values[found], kind="stable")[::-1].tolist():
        if kept[peak]:
            kept[first[peak] : last[peak]] = False
            kept[peak] = True
    return found[kept]


def _prominence(values: Floats, place: int) -> float:
    before, behind = values[: place + 1][::-1], values[place:]
    return float(values[place] - max(_lowest(before), _lowest(behind)))


def _lowest(values: Floats) -> float:
    """Return the lowest of values (n,) from a maximum on, up to where one is higher."""
    higher = np.flatnonzero(values > values[0])
    return float(values[: higher[0] if len(higher) else None].min())


def _summits(values: Floats) -> Places:
    """Return the places where values (n,) rise before and fall behind; of a level top the middle, the lower of two."""
    starts = np.flatnonzero(np.r_[True, np.diff(values) != 0])
    ends, level = np.r_[starts[1:], len(values)] - 1, values[starts]
    top = np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])) + 1
    middles: Places = (starts[top] + ends[top]) // 2
    return middles


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
        """Return the highest local maxima, highest first, at least `distance` Hz apart and above a frequency (Hz)."""
        require_whole("count", count, at_least=1, at_most=1000)
        bins = max(1, round(distance / float(self.frequency[1])))
        places = [place for place in apart(self.amplitude, bins).tolist() if self.frequency[place] > above]
        highest = sorted(places, key=lambda place: (-self.amplitude[place], place))[:count]
        return tuple(SpectralPeak(float(self.frequency[place]), float(self.amplitude[place])) for place in highest)


def amplitude_spectrum(signal: ArrayLike, sampling: float, highest: float | None = None) -> Spectrum:
    """Return the spectrum of a signal (n,) sampled at `sampling` (Hz), up to a frequency `highest` (Hz; None: half of that).

    |X| 2/n, and |X|/n at 0 and at half the sampling, without a window: a sine of whole periods shows its amplitude. Raises
    ParameterError for fewer than two finite numbers, or frequencies not above 0.
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


class SpeedRow(NamedTuple):
    """Results of a study at one speed."""

    pinion_speed: Floats
    approach: Floats
    mean_approach: float
    greatest_approach: float
    deepest: float
    out_of_contact: float
    growth: float
    digits_lost: float
    chaotic: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class SpeedSpectra(ABC):
    """Amplitudes (s, m) over speeds (s,) of the pinion in rpm and frequencies (m,) in Hz; `duration` in s, `sampling` in Hz.

    `pinion_speed` is in rad/s, `approach` of the flanks in µm; both spectra cover the whole time, the first column is the mean.
    `mean_approach` and `greatest_approach` (s,) in µm, `out_of_contact` (share of the time) and `growth` of a disturbance (1/s)
    are those of the second half; `deepest` (s,) is the greatest approach in the whole time.
    `chaotic` (s,) are the speeds at which a disturbance loses more than 6 digits (`digits_lost`): only statistics count there.
    """

    speeds: Floats
    duration: float
    sampling: float
    frequency: Floats
    pinion_speed: Floats
    approach: Floats
    mean_approach: Floats
    greatest_approach: Floats
    deepest: Floats
    out_of_contact: Floats
    growth: Floats
    digits_lost: Floats
    chaotic: NDArray[np.bool_]

    @property
    @abstractmethod
    def teeth(self) -> int:
        """Number of teeth of the pinion."""

    @property
    @abstractmethod
    def natural_frequencies(self) -> dict[str, float]:
        """Natural frequencies (Hz) drawn as lines of the diagram, by name."""

    def spectrum(self, speed: float) -> Spectrum:
        """Return the spectrum of the pinion's speed (rad/s) at one of the speeds (rpm)."""
        return Spectrum(self.frequency, self.pinion_speed[self._index(speed)])

    def peaks(self, speed: float, count: int = 6) -> tuple[SpectralPeak, ...]:
        """Return the highest peaks of the pinion's speed (Hz, rad/s) at one of the speeds (rpm)."""
        return self.spectrum(speed).peaks(count)

    def tooth_frequencies(self, harmonic: int = 1) -> Floats:
        """Return i z_1 n/60 (s,) in Hz at every speed, of a harmonic i."""
        return harmonic * self.teeth * 1.0 / 60 * self.speeds

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results."""
        if not self.chaotic.any():
            return ()
        listed = ", ".join(f"{speed:g}" for speed in self.speeds[self.chaotic])
        text = f"chaotic at {listed} rpm: spectra there change with the last digit of any input, statistics do not"
        return (Notice("chaotic", text),)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return a row per speed, for JSON; the spectra themselves are arrays."""
        names = ("mean_approach", "greatest_approach", "deepest", "out_of_contact", "growth", "digits_lost", "chaotic")
        return {
            "duration": self.duration,
            "sampling": self.sampling,
            "natural_frequencies": self.natural_frequencies,
            "speeds": self.speeds.tolist(),
            **{name: getattr(self, name).tolist() for name in names},
            "peaks": [[list(peak) for peak in self.peaks(speed)] for speed in self.speeds],
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def _index(self, speed: float) -> int:
        found = np.flatnonzero(np.isclose(self.speeds, speed, rtol=1e-12, atol=1e-9))
        if len(found) == 0:
            raise ParameterError("speed", speed, "must be one of the study's speeds", "rpm")
        return int(found[0])


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshCampbell(SpeedSpectra):
    """Spectra of settled motions over speed: of the speed of the first mesh's pinion, and of the approach of its flanks.

    `modes` are natural frequencies (Hz) that bend the teeth, by name; `settled` is for how long (s) each motion had run before.
    Speeds at which the motion grows beyond all numbers are `unbounded` (rpm), and are left out.
    """

    mesh: str
    pinion_teeth: int
    modes: dict[str, float] = field(default_factory=dict)
    settled: float
    unbounded: tuple[float, ...] = ()

    @property
    def teeth(self) -> int:
        return self.pinion_teeth

    @property
    def natural_frequencies(self) -> dict[str, float]:
        return self.modes

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to read before using the results."""
        found = super().notices
        if self.unbounded:
            listed = ", ".join(f"{speed:g}" for speed in self.unbounded)
            text = f"no spectrum at {listed} rpm: flanks that never part vibrate more and more there"
            found = (*found, Notice("unbounded", text))
        return tuple(each.within("campbell") for each in found)

    def to_dict(self) -> JsonObject:
        """Return a row per speed, for JSON."""
        return {"mesh": self.mesh, "settled": self.settled, "unbounded": list(self.unbounded), **super().to_dict()}

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        names = {"speed": "speeds", "frequency": "frequency", "pinion_speed": "pinion_speed", "approach": "approach"}
        return {f"campbell_{key}": getattr(self, name) for key, name in names.items()}
