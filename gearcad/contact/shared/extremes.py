"""The greatest values over a base pitch: positions are added to a grid where something higher can stand between them.

Over the mesh a root stress or a pressure is smooth from one event to the next, and its greatest is most often one: where a
pair of teeth comes in or leaves, the curve has a kink; where a contact comes away from the edge of a flank, its pressure
begins with a jump. So what can stand between two positions follows from the curve on both sides of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import itemgetter
from typing import Generic, TypeVar

import numpy as np

from gearcad.arrays import Floats

__all__ = ["Extreme", "Quantity", "RollRange", "add_positions", "extreme"]

P = TypeVar("P")
Seen = TypeVar("Seen", contravariant=True)

_TOLERANCE = 0.0005
"""Part of a value by which it may be exceeded between the positions: well within 0.2 %, as the bound is an estimate."""

_LEAST_GAP = 1e-4
"""Distance of two positions, in base pitches, below which nothing is sought between them."""

_UP, _BEND, _MOST_UP = 1.25, 4.0, 10.0
"""How many times steeper than in the interval beside a curve can rise: more where it has bent already, and at the most."""

_BEYOND = 1.5
"""How many times steeper than beyond the higher position it can have come down to it."""

_ASIDE = 0.25
"""Least part of an interval that a new position takes off it."""

_FEWEST = 4
"""Positions below which nothing is known of what stands between them."""

_MOST = 20
"""Positions that are added for one quantity."""


@dataclass(frozen=True)
class Quantity(Generic[Seen]):
    """What is to be greatest, or `least`: `value` gives it at a position, NaN where it has none there.

    `swing` measures tolerance and error by how far the quantity goes up and down, not by its size.
    """

    name: str
    value: Callable[[Seen], float]
    least: bool = False
    swing: bool = False

    @property
    def sign(self) -> int:
        """1, or -1 for what is to be least."""
        return -1 if self.least else 1


@dataclass(frozen=True)
class Extreme:
    """The greatest (or least) value, its roll angle (deg), and the part of it (or of its swing) by which it may be exceeded.

    The `error` is what the search tolerates at the least, and infinite where nothing is known of what stands beside it.
    """

    value: float
    roll_angle: float
    error: float


@dataclass(frozen=True)
class RollRange:
    """The roll angles (deg) over which a mesh is looked at: a `pitch`, after which it `repeats` itself or not."""

    pitch: float
    repeats: bool = True


def add_positions(
    known: Iterable[tuple[float, P]], span: RollRange, solve: Callable[[float], P], quantities: Sequence[Quantity[P]]
) -> list[P]:
    """Positions `solve`d at roll angles (deg) between those that are known."""
    pool, added = sorted(known, key=itemgetter(0)), []
    for quantity in quantities:
        for _ in range(_MOST):
            place = _Sampled.from_positions(pool, span, quantity).doubtful
            if place is None:
                break
            added.append(solve(place))
            pool = sorted([*pool, (place, added[-1])], key=itemgetter(0))
    return added


def extreme(known: Iterable[tuple[float, P]], span: RollRange, quantity: Quantity[P]) -> Extreme | None:
    """The greatest (or least) of all positions; None where the quantity has no value at any."""
    course = _Sampled.from_positions(sorted(known, key=itemgetter(0)), span, quantity)
    if course.nothing:
        return None
    at = int(np.nanargmax(course.values))
    value = float(course.values[at])
    above = max(float(course.roofs[0].max(initial=value)) - value, 0.0)
    if math.isfinite(above):
        # Where a curve flickers, lines through neighbours tell nothing; how close the greatest few come does.
        above = min(above, value - float(np.sort(course.values[~np.isnan(course.values)])[-_FEWEST:].min()))
    error = 0.0 if not above else above / course.scale if course.scale else math.inf
    return Extreme(quantity.sign * value, float(course.angles[at]), max(error, _TOLERANCE))


@dataclass(frozen=True)
class _Sampled:
    """Values (n,) of a quantity, to be greatest, at rising angles (n,) in deg."""

    angles: Floats
    values: Floats
    span: RollRange
    swing: bool

    @classmethod
    def from_positions(cls, pool: Sequence[tuple[float, P]], span: RollRange, quantity: Quantity[P]) -> _Sampled:
        """That of known positions, in order."""
        angles, positions = zip(*pool, strict=True)
        values = quantity.sign * np.array([quantity.value(each) for each in positions], float)
        return cls(np.array(angles), values, span, quantity.swing)

    @property
    def nothing(self) -> bool:
        """True if there is no value at any position."""
        return bool(np.isnan(self.values).all())

    @property
    def scale(self) -> float:
        """What an error is measured by."""
        least, most = np.nanmin(self.values), np.nanmax(self.values)
        return float(most - least if self.swing else abs(most))

    @property
    def doubtful(self) -> float | None:
        """The angle (deg) at which most can be missed; None where that is within the tolerance."""
        roofs, places = self.roofs
        if self.nothing or not len(roofs):
            return None
        at = int(np.argmax(roofs))
        return float(places[at]) if roofs[at] > np.nanmax(self.values) + _TOLERANCE * self.scale else None

    @cached_property
    def roofs(self) -> tuple[Floats, Floats]:
        """The most that can stand between each position and the next, and where (deg)."""
        x, f = self._around
        wide = np.diff(x)
        slopes = np.diff(f) / wide
        found = [
            _roof(f[i], f[i + 1], slopes[i - 1] * wide[i], slopes[i + 1] * wide[i])
            if wide[i] > _LEAST_GAP * self.span.pitch
            else (float(np.nanmax([f[i], f[i + 1], -math.inf])), 0.5)
            for i in range(1, len(wide) - 1)
        ]
        roofs, parts = np.array(found).reshape(-1, 2).T
        if len(self.angles) < _FEWEST:
            roofs = np.full_like(roofs, math.inf)
        return roofs, x[1:-2] + parts * wide[1:-1]

    @property
    def _around(self) -> tuple[Floats, Floats]:
        """Angles and values with what stands beside them: the next pitch, or the continuation where there is none."""
        count = len(self.angles)
        if self.span.repeats:
            around = np.arange(-1, count + 2)
            return self.angles[around % count] + around // count * self.span.pitch, self.values[around % count]
        if count < 2:
            return np.arange(3.0), np.full(3, self.values[0])  # no interval
        return tuple(np.r_[2 * each[0] - each[1], each, 2 * each[-1] - each[-2]] for each in (self.angles, self.values))


def _roof(first: float, second: float, before: float, after: float) -> tuple[float, float]:
    """The most that can stand between two values, and at which part of the way, from the slopes `before` and `after` (per
    interval). Infinite where only one of them is known, and nothing beside it.
    """
    if math.isnan(first) and math.isnan(second):
        return -math.inf, 0.5
    if math.isnan(second) or first > second:
        most, part = _roof(second, first, -after, -before)
        return most, 1 - part
    if math.isnan(after):
        # Values end with the second; if the first is all there is beside it, nothing can be told.
        beyond = first + before
        return (math.inf if math.isnan(beyond) else max(second, beyond)), 0.5
    if after >= 0:
        return second, 0.5
    # Two lines, of which the lower one holds, meet at the kink; steeper ones are above it.
    reached = first + before > second
    part = min(max((second - first - after) / (before - after), _ASIDE), 1 - _ASIDE) if reached else 0.5
    up, down = before, _BEYOND * after
    if before > 0:
        up *= min(_UP + _BEND * abs((second - first) / before - 1), _MOST_UP)
    if not first + up > second:
        # What leads up to the first does not lead to the second: a jump, anywhere between.
        return second - down, part
    return first + up * (second - first - down) / (up - down), part
