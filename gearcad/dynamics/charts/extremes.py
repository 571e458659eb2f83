"""The greatest and the least of all that moves over a period, at many speeds. SI units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Self

import numpy as np

from gearcad.arrays import Floats, Indices
from gearcad.dynamics.response.periodic import PeriodicResponse

__all__ = ["Extremes", "extremes"]


_BLOCK = 2_000_000
"""Samples that one block of speeds may have at a time."""


@dataclass(frozen=True, eq=False)
class Extremes:
    """At each speed (s,): `most` and `least` (s, m) are forces (N) between the flanks that carry, of their springs, and
    `damped` (s, m) the greatest with those of the dampers; `torques` (s, n) the greatest in the sense of the static ones (N·m).

    Greatest and least are `approaches` (s, 2, m) of the flanks that carry (m), `turns` (s, 2, i) of the inertias (rad),
    `travels` (s, 2, t) of the axes (m) and `bearings` (s, 2, t) of the forces on their bearings (N); `resultants` (s, g) are
    the greatest of these. `lines` (s, k, m) are amplitudes (m) of the approach at some orders.
    """

    most: Floats
    least: Floats
    damped: Floats
    torques: Floats
    approaches: Floats
    turns: Floats
    travels: Floats
    bearings: Floats
    resultants: Floats
    lines: Floats

    @classmethod
    def joined(cls, *parts: Self) -> Self:
        """All parts, one after the other."""
        return cls(**{each.name: np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(cls)})

    def at(self, rows: Indices) -> Self:
        """Some of them, in this order."""
        return type(self)(**{each.name: getattr(self, each.name)[rows] for each in fields(self)})


def extremes(response: PeriodicResponse, signs: Floats, orders: Indices, samples: int | None = None) -> Extremes:
    """Of a response, block by block of speeds: torques in the sense of `signs` (n,), lines at `orders` (k,) from 1 on."""
    count = samples or response.samples
    wide = count * max(response.approach_coefficients.shape[2], response.torque_coefficients.shape[2])
    block = max(1, _BLOCK // wide)
    return Extremes.joined(*_blocks(response, signs, orders, count, block))


def _blocks(response: PeriodicResponse, signs: Floats, orders: Indices, count: int, block: int) -> Iterator[Extremes]:
    for i in range(0, len(response.frequencies), block):
        which = slice(i, i + block)
        approach, torque = response.approach(which, count), response.shaft_torques(which, count)
        spring = response.carried(approach)
        force, bearing = response.senses * spring, response.bearing_forces(which, count)
        yield Extremes(
            most=force.max(axis=1),
            least=force.min(axis=1),
            damped=(response.senses * (spring + response.damping_forces(which, count))).max(axis=1),
            torques=np.where(signs, torque * signs, np.abs(torque)).max(axis=1),
            approaches=_both(response.senses * approach),
            turns=_both(response.turns(which, count)),
            travels=_both(response.travels(which, count)),
            bearings=_both(bearing),
            resultants=np.hypot(bearing[..., ::2], bearing[..., 1::2]).max(axis=1),
            lines=_lines(response, which, orders),
        )


def _both(course: Floats) -> Floats:
    """(s, 2, c): greatest and least of courses (s, t, c)."""
    return np.stack([course.max(axis=1), course.min(axis=1)], axis=1)


def _lines(response: PeriodicResponse, which: slice, orders: Indices) -> Floats:
    """(s, k, m): 0 where the response has no such order."""
    result = np.zeros((len(response.frequencies[which]), len(orders), response.approach_coefficients.shape[2]))
    _, own, wanted = np.intersect1d(response.harmonics, orders, assume_unique=True, return_indices=True)
    result[:, wanted] = 2 * np.abs(response.approach_coefficients[which, own])
    return result
