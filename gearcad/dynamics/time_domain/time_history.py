"""Time history of a pair by the contact model at one speed, its spectra, and the result of its Campbell study."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gearcad.core.errors import ParameterError, plain_numbers, require_number
from gearcad.core.records import Floats, Notice
from gearcad.dynamics.time_domain.contact_model import ContactModel, EngagedPairs
from gearcad.dynamics.time_domain.spectra import Spectrum, SpeedSpectra, amplitude_spectrum

if TYPE_CHECKING:
    from gearcad.dynamics.time_domain.event_kernel import PairMotion


CHAOTIC_DIGITS = 6.0
"""Number of digits that a motion may lose before it is called chaotic. Four examples in the thesis lose 14 to 130, all others
up to 3.
"""

SETTLED = 0.5
"""Part of the time after which a motion is looked at for its means: the first half holds the start."""


@dataclass(frozen=True, kw_only=True)
class PairStart:
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
    start: PairStart
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
        """Duration of the motion (s)."""
        return len(self.approach) / self.sampling

    @property
    def time(self) -> Floats:
        """Times (n,) of the samples in s."""
        return np.arange(len(self.approach)) / self.sampling

    @property
    def pinion_speed(self) -> Floats:
        """Speed omega_1 (n,) in rad/s: the uniform rotation and the pinion's share of the approach."""
        share = self.model.pinion_share
        return self.speed * math.pi / 30 + share * self.approach_rate / self.model.base_radii.pinion

    @property
    def wheel_speed(self) -> Floats:
        """Speed omega_2 (n,) in rad/s, counter-clockwise as well: negative."""
        share, (pinion, wheel) = 1 - self.model.pinion_share, self.model.base_radii
        return -self.speed * math.pi / 30 * pinion / wheel + share * self.approach_rate / wheel

    @property
    def pinion_angle(self) -> Floats:
        """Turn (n,) of the pinion since time 0 in degrees."""
        angle: Floats = 6 * self.speed * self.time + self.pinion_deviation
        return angle

    @property
    def wheel_angle(self) -> Floats:
        """Turn (n,) of the wheel since time 0 in degrees."""
        pinion, wheel = self.model.base_radii
        angle: Floats = -6 * self.speed * self.time * pinion / wheel + self.wheel_deviation
        return angle

    @property
    def pinion_deviation(self) -> Floats:
        """Turn (n,) of the pinion since time 0 beyond the uniform one, in degrees: its share of the approach."""
        moved = self.model.pinion_share * 1e-3 * (self.approach - self.approach[0])
        angle: Floats = np.degrees(moved / self.model.base_radii.pinion)
        return angle

    @property
    def wheel_deviation(self) -> Floats:
        """Turn (n,) of the wheel since time 0 beyond the uniform one, in degrees: its share of the approach."""
        moved = (1 - self.model.pinion_share) * 1e-3 * (self.approach - self.approach[0])
        angle: Floats = np.degrees(moved / self.model.base_radii.wheel)
        return angle

    @property
    def settled(self) -> Floats:
        """Approach in the second half of the time (µm)."""
        return self.approach[round(SETTLED * len(self.approach)) :]

    def spectrum(self, highest: float | None = None) -> Spectrum:
        """Return the spectrum of the pinion's speed (rad/s) over the whole time, as in the thesis, up to `highest` (Hz)."""
        return amplitude_spectrum(self.pinion_speed, self.sampling, highest)

    def approach_spectrum(self, highest: float | None = None) -> Spectrum:
        """Return the spectrum of the approach (µm) over the whole time, up to `highest` (Hz)."""
        return amplitude_spectrum(self.approach, self.sampling, highest)


MOST_SAMPLES = 10**8

_EVEN = 1e9
"""A base pitch (m) so long that no second pair ever comes."""


def time_history(
    model: ContactModel, speed: float, *, duration: float = 1.0, sampling: float = 200000.0, start: PairStart | None = None
) -> TimeHistory:
    """Return the motion at a mean speed of the pinion in rpm (not negative) over a duration (s), sampled at `sampling` (Hz).

    Without a start the flanks just touch, without relative speed, and a flank of the pinion begins at T1.
    """
    from gearcad.dynamics.time_domain.event_kernel import run

    samples = checked_samples(duration, sampling)
    require_number("speed", speed, "rpm", at_least=0)
    begin = start or PairStart()
    y, drift = 1e-6 * begin.approach, speed * math.pi / 30 * 1e-3 * model.base_radii.pinion
    travel = 1e-3 * begin.place - model.pinion_share * y
    state = (travel, y, 1e-3 * begin.approach_rate)
    approach, rate = np.empty(samples), np.empty(samples)
    outcome = run(_motion(model), float(drift), state, 1 / sampling, SETTLED * samples / sampling, approach, rate)
    approach *= 1e6
    rate *= 1e3
    for array in (approach, rate):
        array.flags.writeable = False
    return TimeHistory(
        model=model,
        speed=float(speed),
        sampling=float(sampling),
        start=begin,
        approach=approach,
        approach_rate=rate,
        out_of_contact=outcome.free / ((1 - SETTLED) * samples / sampling),
        growth=outcome.growth,
        digits_lost=outcome.gain / math.log(10),
        events=outcome.events,
        held=outcome.held,
    )


def checked_samples(duration: float, sampling: float) -> int:
    """Return the number of samples; raise ParameterError unless they are at least 2 and can be held."""
    require_number("duration", duration, "s", above=0)
    require_number("sampling", sampling, "Hz", above=0)
    samples = round(duration * sampling)
    if not 2 <= samples <= MOST_SAMPLES:
        permitted = f"must give between 2 and {MOST_SAMPLES} samples at {sampling:g} Hz"
        raise ParameterError("duration", duration, permitted, "s")
    return samples


def _motion(model: ContactModel) -> PairMotion:
    """Return the model in SI units, reduced to the approach."""
    from gearcad.dynamics.time_domain.event_kernel import PairMotion, Zone

    mass, share = model.reduced_mass, model.pinion_share
    pitch, first, last = (1e-3 * x for x in (model.base_pitch, model.first_contact, model.last_contact))
    wheel_share = share - 1 if model.zone is EngagedPairs.PENETRATING_TIPS else share
    gap = math.inf if model.backlash is None else 1e-3 * model.backlash
    front = Zone(first, last, wheel_share, share)
    back = front
    if model.back_place is not None:
        mirror = 1e-3 * model.back_place
        # On the back flanks the penetration is -(y + backlash): it moves the wheel's end by the backlash.
        moved = gap if model.zone is EngagedPairs.PENETRATING_TIPS else 0.0
        back = Zone(mirror - last, mirror - first + moved, share, wheel_share)
    if model.zone is EngagedPairs.ONE_PAIR:
        pitch, front = _EVEN, Zone(-_EVEN / 2, _EVEN / 2, share, share)
        back = front
    stiffness = 1e6 * model.pair_stiffness
    return PairMotion(stiffness / mass, model.damping / (2 * mass), model.force / mass, pitch, gap, front, back)


@dataclass(frozen=True, kw_only=True, eq=False)
class CampbellStudy(SpeedSpectra):
    """Campbell study of a contact model, each speed from the same start: `deepest` includes the start from y = 0."""

    model: ContactModel

    @property
    def teeth(self) -> int:
        return self.model.teeth.pinion

    @property
    def natural_frequencies(self) -> dict[str, float]:
        """Natural frequencies (Hz) with one pair, and with the mean number of pairs, which is met at high speed."""
        found = {"one pair": self.model.natural_frequency()}
        if self.model.contact_ratio != 1.0:
            found["mean stiffness"] = self.model.natural_frequency(self.model.contact_ratio)
        return found

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of the model and of the motion."""
        found = list(self.model.notices)
        worst = int(np.argmax(self.deepest))
        if 1e-3 * self.deepest[worst] > self.model.normal_module:
            text = (
                f"the flanks penetrate by up to {1e-3 * self.deepest[worst]:.4g} mm (at {self.speeds[worst]:g} rpm), more than"
                f" the module of {self.model.normal_module:g} mm: no teeth do that"
            )
            found.append(Notice("deep-penetration", text))
        return (*found, *super().notices)
