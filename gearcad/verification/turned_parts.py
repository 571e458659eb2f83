"""Exact figures of a stepped shaft: surface, volume, inertia and area in closed form, from its segments."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from operator import itemgetter

import numpy as np

from gearcad.core.records import Floats, Wholes
from gearcad.shafts.beam import SteppedShaft
from gearcad.solids.exact.inertia import Moments
from gearcad.verification.exact_parts import ExactPart


@dataclass(frozen=True)
class TurnedSurface:
    """Surface of a shaft whose axis is z and whose left end is at z = 0; it has no teeth."""

    shaft: SteppedShaft

    def tooth_distances(self, points: Floats) -> Floats:
        """Return infinite distances (n,): no point is on a tooth."""
        return np.full(len(points), np.inf)

    def distances(self, points: Floats) -> Floats:
        """Return the distances (k, n) in mm of points (n, 3) from each cylinder, and each plane ring as a full disc."""
        radius, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        walls = [np.hypot(radius - size, z - np.clip(z, low, high)) for size, low, high in self._walls()]
        rings = [np.hypot(z - height, np.maximum(radius - high, 0.0)) for height, _, high in self._rings()]
        return np.stack(walls + rings)

    def teeth(self, points: Floats) -> Wholes:
        """Return 0 for each of the points (n, 3)."""
        return np.zeros(len(points), int)

    @property
    def flanks(self) -> list[int]:
        """Numbers of the surfaces that are flanks: none."""
        return []

    def _walls(self) -> Iterator[tuple[float, float, float]]:
        """Yield radius and ends (mm) of the cylinders; neighbours of one diameter are one surface."""
        sizes = [(each.outer_diameter, each.inner_diameter) for each in self.shaft.segments]
        for row in zip(*sizes, strict=True):
            stretches = zip(row, pairwise(self.shaft.ends), strict=True)
            for diameter, group in groupby(stretches, key=itemgetter(0)):
                ends = [end for _, stretch in group for end in stretch]
                if diameter:
                    yield diameter / 2, ends[0], ends[-1]

    def _rings(self) -> Iterator[tuple[float, float, float]]:
        """Yield the height, and the radii (mm) between which the section changes there."""
        sections = [(each.inner_diameter / 2, each.outer_diameter / 2) for each in self.shaft.segments]
        for end, (inner, outer) in ((0.0, sections[0]), (self.shaft.ends[-1], sections[-1])):
            yield end, inner, outer
        for height, pair in zip(self.shaft.ends[1:-1], pairwise(sections), strict=True):
            for one, other in zip(*pair, strict=True):
                if one != other:
                    yield height, min(one, other), max(one, other)


class ExactShaft(ExactPart):
    """A stepped shaft, and what files of it are held against."""

    def __init__(self, shaft: SteppedShaft) -> None:
        self.shaft = shaft
        self._distances: dict[bytes, Floats] = {}

    @property
    def gear(self) -> None:
        """None: a shaft has no teeth."""
        return

    @property
    def teeth(self) -> int:
        """0: a shaft has no teeth."""
        return 0

    @cached_property
    def surface(self) -> TurnedSurface:
        """The exact surface."""
        return TurnedSurface(self.shaft)

    @cached_property
    def bore(self) -> None:
        """None: a shaft has no splined bore."""
        return

    @cached_property
    def moments(self) -> Moments:
        """Volume (mm³) and polar moment (mm⁵): sums over the segments."""
        parts = self.shaft.segments
        volume = math.fsum(each.area * each.length for each in parts)
        return Moments(volume, math.fsum(2 * each.second_moment * each.length for each in parts))

    @cached_property
    def area(self) -> float:
        """Area (mm²) of walls and rings."""
        walls = math.fsum(2 * math.pi * radius * (high - low) for radius, low, high in self.surface._walls())
        return walls + math.fsum(math.pi * (high**2 - low**2) for _, low, high in self.surface._rings())

    @property
    def euler_number(self) -> int:
        """Euler number of the surface: 0 of a shaft with a bore from end to end, else 2."""
        return 0 if all(each.inner_diameter for each in self.shaft.segments) else 2
