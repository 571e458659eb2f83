"""SpeedSpectra: spectra of a pair's motion over a range of speeds, and which speeds are chaotic."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.dynamics.tooth_springs.spectra import SpectralPeak, Spectrum
from gearcad.errors import ParameterError
from gearcad.notice import Notice, texts

__all__ = ["SpeedRow", "SpeedSpectra"]


class SpeedRow(NamedTuple):
    """What a study keeps of one speed."""

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
        """Of the pinion."""

    @property
    @abstractmethod
    def natural_frequencies(self) -> dict[str, float]:
        """Lines of the diagram (Hz), by what they are."""

    def spectrum(self, speed: float) -> Spectrum:
        """Of the pinion's speed at one of the speeds (rpm)."""
        return Spectrum(self.frequency, self.pinion_speed[self._index(speed)])

    def peaks(self, speed: float, count: int = 6) -> tuple[SpectralPeak, ...]:
        """Highest peaks of the pinion's speed (Hz, rad/s) at one of the speeds (rpm)."""
        return self.spectrum(speed).peaks(count)

    def tooth_frequencies(self, harmonic: int = 1) -> Floats:
        """i z_1 n/60 (s,) in Hz at every speed, of a harmonic i."""
        return harmonic * self.teeth * 1.0 / 60 * self.speeds

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it."""
        if not self.chaotic.any():
            return ()
        listed = ", ".join(f"{speed:g}" for speed in self.speeds[self.chaotic])
        text = f"chaotic at {listed} rpm: spectra there change with the last digit of any input, statistics do not"
        return (Notice("chaotic", text),)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """A row per speed, for JSON; the spectra themselves are arrays."""
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
