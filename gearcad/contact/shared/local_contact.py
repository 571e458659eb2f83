"""Local contact of two flanks: wide contacts, and the start of a relief.

In a ring with few more teeth than its pinion flanks are nearly alike, one hollow, one round, and the contact can be as wide as
their radii.

In the half-plane p = E*/2 sum a_k sin(k f) presses bodies with the slope h' = sum a_k cos(k f) of their gap on [c - b, c + b],
u = c + b cos f, where a_0 = 0 and the load q = pi E* b a_1/4 (Johnson, Contact Mechanics, 2.7, by Chebyshev's polynomials).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from gearcad.contact.shared.line_of_action import LineOfAction, TransverseFlank
from gearcad.core.records import Bools, Floats, Notice, Role
from gearcad.rating.contact_stress import half_width

_WIDE = 0.04
"""Half width over the pinion's radius of curvature up to which Hertz's pressure is within 1 % of that in a ring, for as few as
ten teeth of difference; contact between external gears is that good up to 0.1.
"""


class HollowContact(NamedTuple):
    """A contact in the hollow flank of a ring: Hertz's half width and the pinion's radius of curvature (mm)."""

    half_width: float
    radius: float

    @property
    def conformal(self) -> bool:
        """Whether the contact is too wide to be treated as that of two cylinders."""
        return self.half_width > _WIDE * self.radius


def conformal_notices(contacts: Iterable[HollowContact]) -> Iterator[Notice]:
    """Yield a notice of the widest contact, measured by the pinion's radius, if it is too wide for two cylinders."""
    worst = max(contacts, key=lambda contact: contact.half_width / contact.radius, default=None)
    if worst is not None and worst.conformal:
        text = (
            f"the contact is up to {2 * worst.half_width:.3g} mm wide in the ring's hollow flank, where the pinion has a "
            f"radius of {worst.radius:.3g} mm: that is no contact of two cylinders, and Hertz can be more than 1 % off"
        )
        yield Notice("conformal-contact", text)


Size = TypeVar("Size", float, Floats)

_OF_TRANSITION, _OF_WIDTH, _MOST_NODES = 8, 48, 4096
"""Places of a contact: so many over a transition, at least so many over the width, and no more than the most."""

_ROUNDS, _SETTLED = 60, 1e-10
"""Newton steps for middle and half width of a contact, and the last one: over the half width where that is above 1 mm, else in
mm. Over half widths of some µm rounding leaves more.
"""

_STEPS, _LEAST_TRANSITION, _MOST_STEPS = 6, 0.01, 24
"""Steps over a transition (mm of roll, taken as no shorter) at which contacts are looked at, and the most of an onset."""

_PLACES, _POSITIONS, _HALVINGS = 401, 201, 60
"""Places in a contact, positions of the kink in it, and halvings of its width in the closed form."""

_WIDENINGS = 16
"""Times that the range of places at most grows by its width, until the least gap lies in it."""


# ---------------------------------------------------------------------- which places are beside a start


class Onset(NamedTuple, Generic[Size]):
    """The start of a linear relief on a flank: `roll` (mm), `length` t_s of its transition and `slope` D along the tangent.

    The slope is in mm per mm; `sense` is 1 where the relief is on the side of the tip, -1 on that of the root.
    """

    roll: Size
    length: Size
    slope: Size
    sense: int


def onsets(flank: TransverseFlank) -> tuple[Onset[float], ...]:
    """Return the starts of the linear reliefs of a flank."""
    found = []
    for name, of in flank.form.transitions.items():
        # Along the tangent, roll grows by r_b/rho for each mm.
        stretch = abs(flank.base_radius / of.onset)
        found.append(Onset(of.onset, of.length / stretch, of.slope * stretch, 1 if name == "tip_relief" else -1))
    return tuple(found)


def start_distance(base_radius: float, onset: Onset[Any], lengths: Floats, radii: Any) -> Any:
    """Return how far (mm along the tangent) contacts are from the transition of an onset, below 0 where they may be on it.

    A contact that exact involutes have at roll `lengths`, of reduced `radii` (mm), stays at the kink until R D behind it.
    All of `onset` and `radii` may be arrays that broadcast.
    """
    past = onset.sense * (lengths**2 - onset.roll**2) / (2 * base_radius)
    return np.maximum(-past, past - radii * onset.slope) - onset.length / 2


def start_lengths(line: LineOfAction) -> Floats:
    """Return where contacts touch (n,) in mm from T1 as they pass the starts of linear reliefs, from onsets to R D/2 behind.

    There the kink is in the middle of the contact. Steps are a sixth of the transition at the most.
    """
    found = [np.zeros(0)]
    for role, flank in line.flanks.items():
        for onset in onsets(flank):
            stretch = abs(flank.base_radius / onset.roll)
            radius = line.radius(onset.roll)
            shift = onset.sense * radius * onset.slope / 2 * stretch
            steps = min(_STEPS * abs(shift) / max(onset.length * stretch, _LEAST_TRANSITION), _MOST_STEPS)
            rolls = onset.roll + np.linspace(0.0, shift, math.ceil(steps) + 1)
            found.append(rolls if role is Role.PINION else line.whole - rolls)
    return np.concatenate(found)


# ---------------------------------------------------------------------- closed form: a cylinder with a rounded kink


def rounded_kink_pressure(load: float, radius: float, slope: float, length: float, modulus: float) -> float:
    """Return the greatest pressure (MPa) as a contact rolls over a kink that is rounded by a parabola.

    `load` q in N/mm, reduced `radius` R in mm, `slope` D in mm per mm, `length` t_s of the rounding in mm, `modulus` E* in MPa.
    With the kink at b cos f0: p = E* b sin f/(2R) + E* D/(2 pi t_s) (G(s2) - G(s1)), where G(s) = (s - u) L(u, s) -
    sqrt(b^2 - u^2) arccos(s/b) and L = ln|sin((f + f0)/2)/sin((f - f0)/2)| is a sharp kink's.
    """
    reach = float(half_width(load, radius, modulus)) + length
    kinks = np.linspace(-reach, reach, _POSITIONS)[:, None]
    low, high = np.zeros_like(kinks), np.full_like(kinks, reach)
    for _ in range(_HALVINGS):
        b = (low + high) / 2
        more = _load(b, kinks, radius, slope, length, modulus) > load
        low, high = np.where(more, low, b), np.where(more, b, high)
    u = b * np.cos(np.linspace(0.0, math.pi, _PLACES + 2)[1:-1])
    first, last = (np.clip(kinks + side * length / 2, -b, b) for side in (-1, 1))
    bent = (_summed(last, u, b) - _summed(first, u, b)) * slope / (2 * math.pi * length)
    return float((modulus * (np.sqrt(b**2 - u**2) / (2 * radius) + bent)).max())


def _load(b: Floats, kink: Floats, radius: float, slope: float, length: float, modulus: float) -> Floats:
    """Return q = pi E* b^2/(4R) + E* D/(2 t_s) times the integral of sqrt(b^2 - s^2) over the rounding."""
    first, last = (np.clip(kink + side * length / 2, -b, b) for side in (-1, 1))
    of_last, of_first = ((s * np.sqrt(b**2 - s**2) + b**2 * np.arcsin(s / b)) / 2 for s in (last, first))
    result: Floats = modulus * (math.pi * b**2 / (4 * radius) + slope / (2 * length) * (of_last - of_first))
    return result


def _summed(s: Floats, u: Floats, b: Floats) -> Floats:
    """Return G at s for places u in a contact of half width b."""
    f, f0 = np.arccos(u / b), np.arccos(s / b)
    ratio = np.abs(np.sin((f + f0) / 2)) / np.maximum(np.abs(np.sin((f - f0) / 2)), np.finfo(float).tiny)
    result: Floats = (s - u) * np.log(np.maximum(ratio, np.finfo(float).tiny)) - np.sqrt(b**2 - u**2) * f0
    return result


# ---------------------------------------------------------------------- any convex gap


class GapCurve(NamedTuple):
    """A gap (n, m) in mm at places along the tangent, its slope and its curvature (1/mm)."""

    gap: Floats
    slope: Floats
    curvature: Floats


@dataclass(frozen=True)
class Pressed:
    """Contacts (n,) of half-planes: `middle` and `half_widths` in mm, greatest pressures `peaks` in MPa.

    `own` (mm) is the distance at which a line load q moves a half-plane as far as the contact gives way beyond its least gap,
    `least` (mm): exp(-(d - least) pi E*/(2q)). `settled` is False where no contact was found, `resolved` also where
    a transition is too short for the places.
    """

    middle: Floats
    half_widths: Floats
    peaks: Floats
    own: Floats
    least: Floats
    settled: Bools
    resolved: Bools


def press(
    curve: Callable[[Floats], GapCurve], loads: Floats, modulus: float, start: tuple[Floats, Floats], shortest: float
) -> Pressed:
    """Press half-planes together whose gaps at places (n, m) are those of `curve`, with line loads (n,) in N/mm.

    `start` are middles and half widths (n,) near which the least gap is sought, where Newton's steps begin: from elsewhere
    they miss the contacts of small loads. `shortest` is the length (mm) of the shortest transition.
    """
    from scipy.fft import dct, dst

    middle, half = (np.array(each, float) for each in start)
    middle = _place_of_least(curve, *_around_least(curve, middle, half))
    wanted = max(_OF_WIDTH, math.ceil(_OF_TRANSITION * math.pi * float(half.max()) / shortest))
    count = 1 << math.ceil(math.log2(min(wanted, _MOST_NODES)))
    cosine = np.cos((np.arange(count) + 0.5) * math.pi / count)
    settled = np.zeros(len(half), bool)
    for _ in range(_ROUNDS):
        of = curve(middle[:, None] + half[:, None] * cosine)
        even, leaning = of.slope.mean(axis=1), (of.slope * cosine).mean(axis=1)
        bend, bent, across = ((of.curvature * weight).mean(axis=1) for weight in (1.0, cosine, cosine**2))
        # The mean slope must vanish, and pi E* b/2 times the mean of h' cos f be the load.
        short = 2 * loads / (math.pi * modulus) - half * leaning
        by_middle, by_half = half * bent, leaning + half * across
        determinant = bend * by_half - bent * by_middle
        to_middle = (-even * by_half - bent * short) / determinant
        to_half = (bend * short + even * by_middle) / determinant
        middle = middle + np.clip(to_middle, -half, half)
        step = np.clip(to_half, -half / 2, half)
        half = half + step
        settled = np.maximum(np.abs(to_middle), np.abs(to_half)) < _SETTLED * np.maximum(half, 1.0)
        if settled.all():
            break
    of = curve(middle[:, None] + half[:, None] * cosine)
    terms = dct(of.slope, type=2, axis=1) / count
    pressures = modulus / 4 * dst(np.c_[terms[:, 1:], np.zeros(len(terms))], type=3, axis=1)
    approach = of.gap.mean(axis=1) - 2 * loads / (math.pi * modulus) * np.log(half / 2)
    least = curve(_place_of_least(curve, middle - half, middle + half)[:, None]).gap[:, 0]
    own = np.exp(-(approach - least) * math.pi * modulus / (2 * loads))
    resolved = settled & (_OF_TRANSITION * math.pi * half <= 2 * count * shortest)
    return Pressed(middle, half, _tops(pressures), own, least, settled, resolved)


def _around_least(curve: Callable[[Floats], GapCurve], middle: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Return two places (n,), on both sides of the least of a convex gap, by widening middle and half widths (n,)."""
    low, high = middle - half, middle + half
    for _ in range(_WIDENINGS):
        slopes = curve(np.stack([low, high], axis=1)).slope
        if (slopes[:, 0] <= 0).all() and (slopes[:, 1] >= 0).all():
            break
        wide = high - low
        low, high = np.where(slopes[:, 0] > 0, low - wide, low), np.where(slopes[:, 1] < 0, high + wide, high)
    return low, high


def _place_of_least(curve: Callable[[Floats], GapCurve], low: Floats, high: Floats) -> Floats:
    """Return the places (n,) of the least gaps between two places: where a convex gap has no slope, or at an end."""
    place = (low + high) / 2
    for _ in range(_HALVINGS):
        of = curve(place[:, None])
        slope, bend = of.slope[:, 0], of.curvature[:, 0]
        low, high = np.where(slope < 0, place, low), np.where(slope > 0, place, high)
        newton = place - slope / np.maximum(bend, np.finfo(float).tiny)
        place, before = np.where((newton > low) & (newton < high), newton, (low + high) / 2), place
        if float(np.abs(place - before).max()) < _SETTLED:
            break
    return place


def _tops(values: Floats) -> Floats:
    """Return the greatest (n,) of values (n, m), by a parabola through the greatest and those beside it."""
    at = np.clip(values.argmax(axis=1), 1, values.shape[1] - 2)
    before, here, after = (np.take_along_axis(values, (at + step)[:, None], 1)[:, 0] for step in (-1, 0, 1))
    bend = before - 2 * here + after
    rise = (before - after) ** 2 / np.where(bend < 0, -8 * bend, np.inf)
    result: Floats = here + rise
    return result
