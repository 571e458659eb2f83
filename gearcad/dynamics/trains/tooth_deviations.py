"""Tooth deviations as excitation (µm), given or random within the tolerances of ISO 1328-1, and polylines over one tooth.

Deviations are smooth along the line of action: every pair of teeth takes over its part of the load gradually, so the error of
the mesh is continuous. Teeth that meet too early (before the line of action) are in `dynamics/tooth_errors`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import ParameterError, plain_numbers, require_number, require_whole
from gearcad.core.records import Complexes, Floats
from gearcad.rating.tolerances import FlankTolerances


@dataclass(frozen=True, kw_only=True, eq=False)
class PeriodicLine:
    """Straight lines over one tooth: `phase` (n,) rises over exactly 2 pi (rad), and repeats a value where `height` (n,) jumps.

    Where both ends differ, the height jumps there too. Raises ParameterError.
    """

    phase: Floats
    height: Floats

    def __post_init__(self) -> None:
        phase, height = (np.array(each, float) for each in (self.phase, self.height))
        if phase.shape != height.shape or len(phase) < 2 or not np.isfinite(phase).all() or (np.diff(phase) < 0).any():
            raise ParameterError("phase", f"{len(phase)} values", "must rise, with one value each")
        if abs(phase[-1] - phase[0] - 2 * np.pi) > 1e-9:
            raise ParameterError("phase", float(phase[-1] - phase[0]), "must rise over exactly 2 pi rad", "rad")
        if not np.isfinite(height).all():
            raise ParameterError("height", "not finite", "must be finite numbers")
        for name, array in (("phase", phase), ("height", height)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def mean(self) -> float:
        """Mean height over the tooth."""
        return float(np.diff(self.phase) @ (self.height[1:] + self.height[:-1]) / (4 * np.pi))

    def values(self, phase: ArrayLike) -> Floats:
        """Return the heights at any phases (rad)."""
        return np.asarray(np.interp(self._within(phase), self.phase, self.height), float)

    def slopes(self, phase: ArrayLike) -> Floats:
        """Return the slopes (1/rad) of the line to the right of any phases (rad), without what jumps would add."""
        steps, rises = np.diff(self.phase), np.diff(self.height)
        slopes = np.divide(rises, steps, out=np.zeros_like(steps), where=steps > 0)
        place = np.searchsorted(self.phase, self._within(phase), side="right") - 1
        return np.asarray(slopes[np.clip(place, 0, len(slopes) - 1)], float)

    def coefficients(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1,), exactly those of the straight lines.

        Integrated by parts twice: i n c_n is the coefficient of the slope, plus what the jumps add.
        """
        order = np.arange(1, count + 1)[:, None]
        # Each order from the one before: thousands of them lose three digits of sixteen, and take a tenth of the time.
        waves = np.cumprod(np.broadcast_to(np.exp(-1j * self.phase), (count, len(self.phase))), axis=0)
        steps, rises = np.diff(self.phase), np.diff(self.height)
        straight = steps > 0
        slopes = rises[straight] / steps[straight]
        by_slopes = (np.diff(waves, axis=1)[:, straight] @ slopes) * 1j / order[:, 0]
        by_jumps = waves[:, :-1][:, ~straight] @ rises[~straight] + waves[:, 0] * (self.height[0] - self.height[-1])
        return np.concatenate([[self.mean + 0j], (by_slopes + by_jumps) / (2j * np.pi * order[:, 0])])

    @property
    def jumps(self) -> Floats:
        """Phases from 0 to 2 pi where the height jumps."""
        found = self.phase[:-1][(np.diff(self.phase) == 0) & (np.diff(self.height) != 0)]
        # What interpolation leaves between two ends that should agree is no jump.
        if abs(self.height[0] - self.height[-1]) > 1e-9 * np.abs(self.height).max():
            found = np.append(found, self.phase[0])
        return np.unique(np.mod(found, 2 * np.pi))

    def _within(self, phase: ArrayLike) -> Floats:
        start = self.phase[0]
        return np.asarray(np.mod(np.asarray(phase, float) - start, 2 * np.pi) + start, float)


_SIGMAS = 3.0
"""Standard deviations of a normal distribution within a tolerance: numbers beyond are drawn again."""


class ErrorDistribution(Enum):
    """Distribution of deviations within their tolerance."""

    UNIFORM = "uniform"
    """All deviations within the tolerance are equally probable."""
    NORMAL = "normal"
    """The tolerance is three standard deviations, beyond which nothing lies."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TransmissionError:
    """e(phase) = sum_n c_n e^(i n phase/teeth) in µm: how far unloaded flanks must approach each other until they touch.

    `coefficients` (n + 1,) are those from 0 on, over a period of `teeth` teeth of the mesh (1: the same for all teeth); what
    comes again with every tooth may be given by straight lines instead, or besides: `line`, in µm. The phase, 2 pi over a
    tooth, is the mesh's own: that of its stiffness.
    """

    coefficients: Complexes = field(default_factory=lambda: np.zeros(1, complex))
    teeth: int = 1
    line: PeriodicLine | None = None

    def __post_init__(self) -> None:
        require_whole("teeth", self.teeth, at_least=1, at_most=1_000_000)
        values = np.array(self.coefficients, complex)
        if values.ndim != 1 or not len(values) or not np.isfinite(values).all() or values[0].imag:
            raise ParameterError("coefficients", f"{values.shape}", "must be finite numbers in a row, the mean a real one")
        values.flags.writeable = False
        object.__setattr__(self, "coefficients", values)

    def values(self, phase: ArrayLike) -> Floats:
        """Return e (µm) at any phases (rad)."""
        steady = 0.0 if self.line is None else self.line.values(phase)
        return np.asarray(self._sum(self.coefficients, phase) + steady, float)

    def slopes(self, phase: ArrayLike) -> Floats:
        """Return de/dphase (µm/rad) at any phases (rad)."""
        steady = 0.0 if self.line is None else self.line.slopes(phase)
        own = self.coefficients * 1j * np.arange(len(self.coefficients)) / self.teeth
        return np.asarray(self._sum(own, phase) + steady, float)

    def orders(self, count: int) -> Complexes:
        """Return the Fourier coefficients (count + 1,) in µm, of n turns of the phase in `teeth` teeth."""
        result = np.zeros(count + 1, complex)
        own = self.coefficients[: count + 1]
        result[: len(own)] = own
        if self.line is not None:
            result[:: self.teeth] += self.line.coefficients(count // self.teeth)
        return result

    def _sum(self, coefficients: Complexes, phase: ArrayLike) -> Floats:
        if not coefficients.any():
            return np.zeros(np.shape(phase))
        turns = np.asarray(phase, float)[..., None] * (np.arange(len(coefficients)) / self.teeth)
        weights = np.where(np.arange(len(coefficients)) == 0, 1, 2) * coefficients
        result: Floats = (np.exp(1j * turns) @ weights).real
        return result


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothDeviations:
    """Deviations (µm) of the flanks that work, one per tooth in the order in which they come into mesh.

    `position` (z,) is how far a flank stands back from its place, along the line of action: positive where metal is missing, so
    minus the cumulative pitch deviation of flanks that lead. `slope` (z,) is how much more is missing where the tooth leaves
    the mesh than where it enters.
    """

    position: Floats
    slope: Floats = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        position = np.array(self.position, float)
        slope = np.array(self.slope, float) if len(self.slope) else np.zeros_like(position)
        if position.ndim != 1 or not len(position) or position.shape != slope.shape:
            raise ParameterError("position", f"{position.shape}", f"must be one number per tooth, as slope {slope.shape}")
        if not (np.isfinite(position).all() and np.isfinite(slope).all()):
            raise ParameterError("position", "not finite", "must be finite numbers in µm")
        for name, array in (("position", position), ("slope", slope)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)


def random_deviations(
    teeth: int,
    tolerances: FlankTolerances,
    seed: int,
    *,
    distribution: ErrorDistribution = ErrorDistribution.UNIFORM,
    gear: tuple[int, ...] = (),
) -> ToothDeviations:
    """Return deviations (µm) of a gear that just keeps its tolerances.

    Single pitches and profile slopes are distributed within them. Single pitch deviations lie within f_pT and sum up to 0
    around the gear; where the sum on the way leaves F_pT, all are made smaller. One seed gives one gear, and others for the
    numbers of another `gear`.
    """
    require_whole("teeth", teeth, at_least=2, at_most=100_000)
    require_whole("seed", seed, at_least=0, at_most=2**63 - 1)
    generator = np.random.default_rng((seed, *gear) if gear else seed)
    pitches = _within_one(generator, teeth, distribution) * tolerances.single_pitch
    pitches -= pitches.mean()
    position = -np.cumsum(pitches)
    position -= position.mean()
    excess = max(np.abs(pitches).max() / tolerances.single_pitch, np.ptp(position) / tolerances.cumulative_pitch, 1.0)
    slope = _within_one(generator, teeth, distribution) * tolerances.profile_slope
    return ToothDeviations(position=position / excess, slope=slope)


def _within_one(generator: np.random.Generator, count: int, distribution: ErrorDistribution) -> Floats:
    """Return random numbers (count,) from -1 to 1."""
    if distribution is ErrorDistribution.UNIFORM:
        return generator.uniform(-1, 1, count)
    drawn = generator.standard_normal(count)
    while (beyond := np.abs(drawn) > _SIGMAS).any():
        drawn[beyond] = generator.standard_normal(int(beyond.sum()))
    return np.asarray(drawn / _SIGMAS, float)


@dataclass(frozen=True, kw_only=True)
class _Share:
    """Part of the load that a pair carries at s base pitches from the middle of its path: those of all pairs sum up to 1.

    A box of one base pitch smeared over the contact ratio less one: a trapezoid that rises where a pair enters.
    """

    contact_ratio: float

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("contact_ratio", self.contact_ratio, above=1, at_most=10)

    def transform(self, frequency: Floats) -> Floats:
        """Return the integral of share(s) e^(-2 pi i f s) ds."""
        return np.asarray(np.sinc(frequency) * np.sinc(frequency * (self.contact_ratio - 1)), float)

    def moment(self, frequency: Floats) -> Complexes:
        """Return the integral of s share(s) e^(-2 pi i f s) ds = i/(2 pi) d(transform)/df."""
        wide = self.contact_ratio - 1
        slope = _sinc_slope(frequency) * np.sinc(frequency * wide) + wide * np.sinc(frequency) * _sinc_slope(frequency * wide)
        return np.asarray(1j / (2 * np.pi) * slope, complex)


def _sinc_slope(x: Floats) -> Floats:
    """Return d/dx of sin(pi x)/(pi x)."""
    safe = np.where(x == 0, 1.0, x)
    return np.where(x == 0, 0.0, (np.cos(np.pi * safe) - np.sinc(safe)) / safe)


def tooth_errors(
    pinion: ToothDeviations, wheel: ToothDeviations | None = None, *, contact_ratio: float, harmonics: int = 6
) -> TransmissionError:
    """Return the transmission error (µm) of the deviations of all teeth, up to `harmonics` of the tooth frequency.

    Pairs in contact are equally stiff, so the error of the mesh is the mean of theirs, each weighted by its share of the load.
    The period is that of the pinion or, with the wheel's deviations, of both: until the same teeth meet again. At phase 0 the
    pair of the first teeth is in the middle of its path; all pairs are taken to stay in contact.
    """
    require_whole("harmonics", harmonics, at_least=1, at_most=100)
    share = _Share(contact_ratio=contact_ratio)
    gears = [pinion] if wheel is None else [pinion, wheel]
    teeth = math.lcm(*(len(gear.position) for gear in gears))
    coefficients = np.zeros(harmonics * teeth + 1, complex)
    for gear in gears:
        count = len(gear.position)
        order = np.arange(harmonics * count + 1)
        frequency = order / count
        position, slope = (np.fft.fft(each)[order % count] / count for each in (gear.position, gear.slope))
        part = position * share.transform(frequency) + slope / contact_ratio * share.moment(frequency)
        coefficients[:: teeth // count] += part
    coefficients[0] = coefficients[0].real
    return TransmissionError(coefficients=coefficients, teeth=teeth)
