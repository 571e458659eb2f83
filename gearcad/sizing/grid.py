"""Every variant of a task, some at a time: what one gives of pairs, before it is known whether they can be.

The place of a variant in the whole is its key: tuples of a task are in order, so it does not depend on how they were given.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats, Indices, Wholes
from gearcad.per_gear import PerGear
from gearcad.sizing.geometry import ManyPairs, distance_for, shift_sum_at
from gearcad.sizing.task import SizeTask

__all__ = ["CHUNK", "Grid", "distances_within", "rounded_distance", "rounded_width"]

CHUNK = 1 << 14
"""Pairs at a time: few enough for the cache of a core, enough for numpy's overhead not to count."""

_STEPS = np.array([factor * 10.0**power for power in range(-4, 3) for factor in (1, 2, 5)])
"""Of centre distances that are not given (mm)."""

_COARSENESS = 0.25
"""The most of a module that such a step is."""


@dataclass(frozen=True)
class Grid:
    """The product of all that a task lets vary but the widths; `len` is how many pairs that makes."""

    task: SizeTask

    @cached_property
    def _teeth(self) -> tuple[Floats, Floats]:
        pairs = np.array(self.task.teeth_pairs, float).reshape(-1, 2)
        return pairs[:, 0], pairs[:, 1]

    @property
    def _shape(self) -> tuple[int, ...]:
        task = self.task
        sums = 1 if task.centre_distance is not None else len(task.shift_sums)
        return len(self._teeth[0]), len(task.modules), len(task.helix_angles), sums, len(task.shifts)

    def __len__(self) -> int:
        return math.prod(self._shape)

    @property
    def variants_of_a_group(self) -> int:
        """How many keys in a row have the same teeth, module and helix angle."""
        return math.prod(self._shape[3:])

    def chunks(self) -> Iterator[ManyPairs]:
        """All of them. Where no centre distance meshes without backlash it is nan."""
        for start in range(0, len(self), CHUNK):
            yield self._pairs(np.arange(start, min(start + CHUNK, len(self))))

    def _pairs(self, key: Wholes) -> ManyPairs:
        task = self.task
        teeth, module, helix, total, shift = np.unravel_index(key, self._shape)
        z_1, z_2 = (each[teeth] for each in self._teeth)
        m_n, beta = np.array(task.modules)[module], np.array(task.helix_angles)[helix]
        angle = task.rack.pressure_angle
        if task.centre_distance is None:
            distance = rounded_distance(distance_for(np.array(task.shift_sums)[total], z_1 + z_2, m_n, beta, angle), m_n)
        else:
            distance = np.full(len(key), task.centre_distance)
        x_1 = np.array(task.shifts)[shift]
        return ManyPairs(
            key=key,
            teeth=PerGear(z_1, z_2),
            normal_module=m_n,
            helix_angle=beta,
            centre_distance=distance,
            shifts=PerGear(x_1, shift_sum_at(distance, z_1 + z_2, m_n, beta, angle) - x_1),
            rack=task.rack,
        )


def rounded_distance(distance: Floats, module: Floats) -> Floats:
    """To steps of 1, 2 or 5, tenths and so on, as coarse as the module lets the shifts take up: 0.5 mm from 2 to 3.99 mm."""
    step = _distance_step(module)
    result: Floats = np.round(np.round(distance / step) * step, 6)
    return result


def _distance_step(module: Floats) -> Floats:
    result: Floats = _STEPS[np.searchsorted(_STEPS, _COARSENESS * module * (1 + 1e-9), side="right") - 1]
    return result


def distances_within(
    sums: tuple[float, float], teeth: Floats, module: Floats, helix_angle: Floats, pressure_angle: float
) -> tuple[Indices, Floats]:
    """All round centre distances (mm) at which x_1 + x_2 of pairs is from the first to the second sum.

    Those of each pair after each other, with the places of the pairs; `teeth` are z_1 + z_2.
    """
    ends = [distance_for(np.array(each), teeth, module, helix_angle, pressure_angle) for each in sums]
    step = _distance_step(module)
    least, most = np.ceil(ends[0] / step - 1e-6), np.floor(ends[1] / step + 1e-6)
    count = np.nan_to_num(np.maximum(most - least + 1, 0)).astype(int)
    place = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(place)) - np.repeat(np.cumsum(count) - count, count)
    return place, np.round((least[place] + number) * step[place], 6)


def rounded_width(width: Floats) -> Floats:
    """To whole mm; to tenths below 10 mm."""
    return np.where(width < 10, np.maximum(np.round(width, 1), 0.1), np.round(width))
