"""Sound of a study of dynamics: the forces between the flanks as samples that a loudspeaker plays."""

from __future__ import annotations

import wave
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, JsonObject, freeze
from gearcad.dynamics.pair_result import PairStudy
from gearcad.dynamics.time_domain.transient_result import Transient
from gearcad.dynamics.train_result import ModalStudy, TrainStudy

RATE = 44_100
"""Samples per second of the sound."""

_LOWEST, _HIGHEST = 20.0, 20_000.0
"""Frequencies (Hz) that one hears: what is below, such as the load at rest, or above is left out."""

_SECONDS, _LONGEST = 3.0, 600.0
"""Length (s) of the sound of a steady motion, and the greatest one of a run."""

_FADE = 0.05
"""Seconds over which the sound begins and ends: it does not click, and what a filter makes of the ends is not heard."""

_FULL = 0.9
"""Part of the greatest number of 16 bits that the greatest sample has."""

_PER_WAVE = 256
"""Samples over the quickest wave of a steady motion: straight lines between them are off by a ten-thousandth."""

_ORDER = 4
"""Order of the Butterworth filter that takes the frequencies away that are too low."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Sound:
    """Samples (k,) of 16 bits at `RATE`, what the `signal` is, in words, and its `greatest` value in a `unit`.

    The greatest value is that of 90 % of the numbers of 16 bits.
    """

    samples: NDArray[np.int16]
    signal: str
    greatest: float
    unit: str

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def words(self) -> str:
        """Signal, length, and by what it is normalised, in one line."""
        seconds = len(self.samples) / RATE
        return f"{self.signal}, {seconds:.3g} s; {self.greatest:.5g} {self.unit} are {100 * _FULL:g} % of the 16 bits"

    def to_dict(self) -> JsonObject:
        """Return the entry of the sound in `dynamics.json`."""
        return {
            "signal": self.signal,
            "rate": RATE,
            "samples": len(self.samples),
            "normalised_by": self.greatest,
            "unit": self.unit,
            "full_scale": _FULL,
        }

    def write(self, path: Path) -> None:
        """Write the sound as a WAV file of one channel."""
        with path.open("wb") as file, wave.open(file, "wb") as sound:
            sound.setnchannels(1)
            sound.setsampwidth(2)
            sound.setframerate(RATE)
            sound.writeframes(self.samples.astype("<i2").tobytes())


def sound_of(study: object) -> Sound:
    """Return the sound of a study: of its run in time, or else of the course at one speed.

    Raises ParameterError for a study without either, and for a run that is too long or sampled too coarsely.
    """
    of = study.study if isinstance(study, PairStudy) else study
    if isinstance(of, TrainStudy | ModalStudy) and of.transient is not None:
        return _of_run(of.transient)
    if isinstance(of, TrainStudy):
        return _of_course(of)
    permitted = "needs a run in time ([dynamics.transient]), or a steady motion of teeth of one design and one model"
    raise ParameterError("wav", type(study).__name__, permitted)


def _of_run(run: Transient) -> Sound:
    """Return the sound of a run: the sum of the forces of all meshes, or of the torques of all shafts without a mesh."""
    from scipy.signal import butter, resample, sosfiltfilt

    meshes, _, shafts = run.names
    signal = (run.force if meshes else run.shaft_torque).sum(axis=1)
    seconds = float(run.time[-1] - run.time[0])
    rate = (len(signal) - 1) / seconds
    if seconds > _LONGEST:
        raise ParameterError("dynamics.transient.duration", seconds, f"must be at most {_LONGEST:g} s for a sound", "s")
    if rate < 8 * _LOWEST:
        raise ParameterError("dynamics.transient.sampling", rate, f"must be {8 * _LOWEST:g} Hz at least for a sound", "Hz")
    heard = sosfiltfilt(butter(_ORDER, _LOWEST, "highpass", fs=rate, output="sos"), signal)
    if rate > 2 * _HIGHEST:
        heard = sosfiltfilt(butter(_ORDER, _HIGHEST, "lowpass", fs=rate, output="sos"), heard)
    heard = _faded(heard, rate)
    return _normalised(resample(heard, max(round(len(heard) * RATE / rate), 2)), *_words(meshes, shafts, "run in time"))


def _of_course(study: TrainStudy) -> Sound:
    """Return the sound of the course at one speed: its waves that one hears, for some seconds."""
    course, teeth = study.course, study.train.meshes[0].teeth
    signal = course.force.sum(axis=1)
    frequency = course.speed * teeth / 60 / study.excitation.period
    spectrum = np.fft.rfft(signal, norm="forward")
    waves = frequency * np.arange(len(spectrum))
    spectrum[(waves < _LOWEST) | (waves > _HIGHEST)] = 0.0
    last = int(np.flatnonzero(spectrum)[-1]) if spectrum.any() else 1
    count = 2 ** int(np.ceil(np.log2(_PER_WAVE * last)))
    padded = np.zeros(count // 2 + 1, complex)
    padded[: last + 1] = spectrum[: last + 1]
    period = np.fft.irfft(padded, count, norm="forward")
    turns = np.mod(frequency * np.arange(round(_SECONDS * RATE)) / RATE, 1.0) * count
    heard = np.interp(turns, np.arange(count + 1), np.append(period, period[0]))
    words = _words(study.up.mesh_names, (), f"steady motion at {course.speed:.5g} rpm")
    return _normalised(_faded(heard, RATE), *words)


def _words(meshes: Sequence[str], shafts: Sequence[str], motion: str) -> tuple[str, str]:
    """Return the signal in words, and its unit."""
    what, names, unit = ("forces between the flanks", meshes, "N") if meshes else ("torques of the shafts", shafts, "N·m")
    summed = f"sum of the {what}" if len(names) > 1 else what
    return f"{summed} of {', '.join(names)}, {motion}, from {_LOWEST:g} to {_HIGHEST:g} Hz", unit


def _faded(signal: Floats, rate: float) -> Floats:
    """Return the signal with its beginning and its end faded."""
    count = min(max(round(_FADE * rate), 1), len(signal) // 2)
    ramp = np.sin(np.pi / 2 * np.arange(count) / count) ** 2
    faded = np.array(signal, float)
    faded[:count] *= ramp
    faded[len(faded) - count :] *= ramp[::-1]
    return faded


def _normalised(signal: Floats, words: str, unit: str) -> Sound:
    greatest = float(np.abs(signal).max(initial=0.0))
    scaled = signal * (_FULL * 32767 / greatest) if greatest > 0 else signal
    return Sound(samples=np.rint(scaled).astype(np.int16), signal=words, greatest=greatest, unit=unit)
