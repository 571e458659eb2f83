"""TimeHistory: one pair at one speed, sampled over time, with its spectra."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.tooth_springs.contact_model import ContactModel
from gearcad.dynamics.tooth_springs.spectra import Spectrum, amplitude_spectrum
from gearcad.errors import plain_numbers, require_number

__all__ = ["CHAOTIC_DIGITS", "SETTLED", "Start", "TimeHistory"]


CHAOTIC_DIGITS = 6.0
"""Digits that a motion may lose before it is called chaotic. In the thesis's study four lose 14 to 130, all others up to 3."""

SETTLED = 0.5
"""Part of the time after which a motion is looked at for its means: the first half holds the start."""


@dataclass(frozen=True, kw_only=True)
class Start:
    """`place` of the contact of one pair (mm from T1), `approach` of the flanks (µm) and its rate (mm/s) at time 0."""

    place: float = 0.0
    approach: float = 0.0
    approach_rate: float = 0.0

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("start.place", self.place, "mm")
        require_number("start.approach", self.approach, "µm")
        require_number("start.approach_rate", self.approach_rate, "mm/s")


@dataclass(frozen=True, kw_only=True, eq=False)
class TimeHistory:
    """Samples (n,) of a motion: `approach` of the flanks in µm, `approach_rate` in mm/s, at `time` (s).

    `out_of_contact` is the share of the second half of the time in which the flanks had parted; `growth` the mean logarithmic
    growth of a small disturbance in that half (1/s), the largest Lyapunov exponent: -b/(2 m) where the motion settles, above 0
    where it stays chaotic. `digits_lost` is the power of ten by which a disturbance grows at most between any two times.
    `events` counts pairs coming and going and contacts lost and found; `held` is the time (s) for which a pair of teeth stood
    on an end of the zone of contact, which only happens at rest or nearly so.
    """

    model: ContactModel
    speed: float
    sampling: float
    start: Start
    approach: Floats
    approach_rate: Floats
    out_of_contact: float
    growth: float
    digits_lost: float
    events: int
    held: float

    @property
    def chaotic(self) -> bool:
        """Whether some stretch of the motion is so sensitive that only its statistics mean anything."""
        return self.digits_lost > CHAOTIC_DIGITS

    @property
    def duration(self) -> float:
        """How long the motion was looked at (s)."""
        return len(self.approach) / self.sampling

    @property
    def time(self) -> Floats:
        """Times (n,) of the samples in s."""
        return np.arange(len(self.approach)) / self.sampling

    @property
    def pinion_speed(self) -> Floats:
        """(n,) omega_1 in rad/s: the uniform rotation and the pinion's share of the approach."""
        share = self.model.pinion_share
        return self.speed * math.pi / 30 + share * self.approach_rate / self.model.base_radii.pinion

    @property
    def wheel_speed(self) -> Floats:
        """(n,) omega_2 in rad/s, counter-clockwise as well: negative."""
        share, (pinion, wheel) = 1 - self.model.pinion_share, self.model.base_radii
        return -self.speed * math.pi / 30 * pinion / wheel + share * self.approach_rate / wheel

    @property
    def pinion_angle(self) -> Floats:
        """(n,) turn of the pinion since time 0 in degrees."""
        angle: Floats = 6 * self.speed * self.time + self.pinion_deviation
        return angle

    @property
    def wheel_angle(self) -> Floats:
        """(n,) turn of the wheel since time 0 in degrees."""
        pinion, wheel = self.model.base_radii
        angle: Floats = -6 * self.speed * self.time * pinion / wheel + self.wheel_deviation
        return angle

    @property
    def pinion_deviation(self) -> Floats:
        """(n,) turn of the pinion since time 0 beyond the uniform one, in degrees: its share of the approach."""
        moved = self.model.pinion_share * 1e-3 * (self.approach - self.approach[0])
        angle: Floats = np.degrees(moved / self.model.base_radii.pinion)
        return angle

    @property
    def wheel_deviation(self) -> Floats:
        """(n,) the same of the wheel."""
        moved = (1 - self.model.pinion_share) * 1e-3 * (self.approach - self.approach[0])
        angle: Floats = np.degrees(moved / self.model.base_radii.wheel)
        return angle

    @property
    def settled(self) -> Floats:
        """The approach in the second half of the time (µm)."""
        return self.approach[round(SETTLED * len(self.approach)) :]

    def spectrum(self, highest: float | None = None) -> Spectrum:
        """Of the pinion's speed (rad/s), over the whole time, as the thesis has it."""
        return amplitude_spectrum(self.pinion_speed, self.sampling, highest)

    def approach_spectrum(self, highest: float | None = None) -> Spectrum:
        """Of the approach (µm), over the whole time."""
        return amplitude_spectrum(self.approach, self.sampling, highest)
