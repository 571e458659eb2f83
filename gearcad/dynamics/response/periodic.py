"""PeriodicResponse: what a train does at each of many speeds, as Fourier coefficients over the common period."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from gearcad.arrays import Bools, Complexes, Floats, Indices
from gearcad.dynamics.response.driven import Driven, pressed
from gearcad.notice import Notice

__all__ = ["PeriodicResponse"]


@dataclass(frozen=True, kw_only=True, eq=False)
class PeriodicResponse(Driven):
    """Steady vibration at `frequencies` (s,): circular tooth frequencies of the first mesh in 1/s. All in SI units.

    Coefficients over the common period belong to the orders `harmonics` (q,), from 0 on: `approach_coefficients` (s, q, m) of
    the approach y of the flanks (m), `inertia_coefficients` (s, q, i) of turns (rad), `torque_coefficients` (s, q, n) of shaft
    torques (N·m), `travel_coefficients` (s, q, t) of axes on bearings (m). `stable` (s,): whether a small disturbance dies
    away. `jumps`: frequencies at which a sweep went over to another branch. `notices` say what to know before trusting it.
    """

    frequencies: Floats
    harmonics: Indices
    approach_coefficients: Complexes
    inertia_coefficients: Complexes
    torque_coefficients: Complexes
    travel_coefficients: Complexes
    stable: Bools
    jumps: Floats = field(default_factory=lambda: np.zeros(0))
    notices: tuple[Notice, ...] = ()

    @property
    def samples(self) -> int:
        """Samples over the common period that show the highest harmonic at least 16 times a wave."""
        return int(max(256, 2 ** int(np.ceil(np.log2(16 * max(int(self.harmonics[-1]), 1))))))

    def phases(self, count: int | None = None) -> Floats:
        """Phases of the common period (t,), in rad, at which the courses below are given."""
        return 2 * np.pi * np.arange(count or self.samples) / (count or self.samples)

    def approach(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Approaches y of the flanks (s, t, m) in m."""
        return self._course(self.approach_coefficients[which], count)

    def turns(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Turns of the inertias (s, t, i) in rad."""
        return self._course(self.inertia_coefficients[which], count)

    def shaft_torques(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Torques in the shafts (s, t, n) in N·m."""
        return self._course(self.torque_coefficients[which], count)

    def travels(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """Travels of the axes (s, t, 2g) in m: of each, along the line of action and across it."""
        return self._course(self.travel_coefficients[which], count)

    def bearing_forces(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """What the axes press their bearings with (s, t, 2g) in N, the bearings' damping with it."""
        travels, bearings = self.travel_coefficients[which], self.system.bearings
        if bearings is None:
            return self._course(travels, count)
        speed = self.excitation.fundamental * self.frequencies[which]
        rates = travels * 1j * speed[:, None, None] * self.harmonics[:, None]
        return self._course(travels @ bearings.stiffness.T + rates @ bearings.damping.T, count)

    def spring_forces(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """k(t) g(y - e) (s, t, m) in N: what the teeth carry, without damping."""
        return self.carried(self.approach(which, count))

    def carried(self, approach: Floats) -> Floats:
        """The same of approaches (s, t, m) over the common period."""
        theta = self.phases(approach.shape[1])
        gap = approach - self.excitation.error_course(len(theta))
        return self.excitation.ratios(theta) * self.system.stiffness * pressed(gap, self.excitation.backlashes, self.senses)

    def damping_forces(self, which: slice = slice(None), count: int | None = None) -> Floats:
        """c (y' - e') (s, t, m) in N."""
        speed = self.excitation.fundamental * self.frequencies[which]
        slopes = self.approach_coefficients[which] * 1j * self.harmonics[:, None]
        rates = self._course(slopes, count) - self.excitation.error_slope_course(count or self.samples)
        return np.asarray(self.system.mesh_damping * speed[:, None, None] * rates, float)

    def _course(self, coefficients: Complexes, count: int | None) -> Floats:
        count = count or self.samples
        spectrum = np.zeros((coefficients.shape[0], count // 2 + 1, coefficients.shape[2]), complex)
        spectrum[:, self.harmonics] = coefficients
        return np.asarray(np.fft.irfft(spectrum * count, count, axis=1), float)
