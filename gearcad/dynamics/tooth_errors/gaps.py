"""How far two teeth stand apart, anywhere on their way through the mesh, before and behind it: exactly, by turning the wheel.

Transverse section; lengths in mm, as the line of action has them: of a ring roll lengths and base radius are negative. A gap is
counted as a transmission error is: the turn of the wheel that closes it while the pinion stays, times its base radius.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.per_gear import PerGear

__all__ = ["TurnedFlank", "tooth_gaps"]

_SAMPLES = 401
"""Places on a modified flank among which the nearest is sought: 0.04 mm apart on teeth of module 5, 0.01 µm of the gap."""

_ROUNDING = 1e-11
"""Of a gap (mm): less is none."""

_HALVINGS = 60
"""A double has room for fewer."""


def _unmodified(lengths: Floats) -> Floats:
    return np.zeros_like(lengths)


class TurnedFlank(NamedTuple):
    """An involute about its axis: base radius, first and last roll length, and how far it is taken back at roll lengths."""

    base_radius: float
    first: float
    last: float
    depth: Callable[[Floats], Floats] = _unmodified


def _turned(flanks: PerGear[TurnedFlank], whole: float, contact: Floats, length: Floats) -> tuple[Floats, Floats]:
    """Gap between points of the pinion's involute and the whole involute of the wheel, and where they meet on the wheel's.

    The points are at roll lengths of a flank that, were it long enough, would touch at `contact` on the line of action. Nan
    where a point lies inside the wheel's base circle.
    """
    own, other = flanks.pinion.base_radius, flanks.wheel.base_radius
    turn = (length - contact) / own
    along = length * np.cos(turn) - own * np.sin(turn)
    across = other + own - own * np.cos(turn) - length * np.sin(turn)
    square = (whole - along) ** 2 + across**2 - other**2
    facing = np.copysign(np.sqrt(np.where(square >= 0, square, np.nan)), other)
    # By how much the wheel's flank is turned from where it has its normal on the line of action.
    turned = np.arctan2(facing, other) - np.arctan2(whole - along, across)
    turned = np.mod(turned + np.pi, 2 * np.pi) - np.pi
    return facing - other * turned - (whole - contact), facing


def tooth_gaps(flanks: PerGear[TurnedFlank], whole: float, places: Floats) -> Floats:
    """Least gap (n,) in mm between the flanks of two teeth that would touch at `places` (n,) from T1 on the line of action.

    Infinite where neither flank reaches over to the other. Where exact involutes touch it is 0.
    """
    pinion, wheel = flanks
    contact = places[:, None]
    lengths = np.broadcast_to(np.linspace(pinion.first, pinion.last, _SAMPLES), (len(places), _SAMPLES))
    # Exact flanks touch where both have their normals on the line of action; else at the ends of one of them.
    touching = np.clip(contact, pinion.first, pinion.last)
    ends = [_facing(flanks, whole, contact, end) for end in (wheel.first, wheel.last)]
    points = np.concatenate([lengths, touching, *ends], axis=1)
    apart, facing = _turned(flanks, whole, contact, points)
    slack = 1e-9 * (wheel.last - wheel.first)
    reached = (facing >= wheel.first - slack) & (facing <= wheel.last + slack)
    on_wheel = np.clip(np.nan_to_num(facing, nan=wheel.first), wheel.first, wheel.last)
    taken_back = pinion.depth(points) + wheel.depth(on_wheel)
    gap = np.where(reached, apart + taken_back, np.inf).min(axis=1)
    return np.asarray(np.where(np.abs(gap) < _ROUNDING, 0.0, gap), float)


def _facing(flanks: PerGear[TurnedFlank], whole: float, contact: Floats, end: float) -> Floats:
    """Roll lengths (n, 1) of the pinion's flank at the radius of an end of the wheel's; its own end where it has none."""
    low, high = (np.full_like(contact, each) for each in flanks.pinion[1:3])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        # Further up on the pinion's flank is further down on the wheel's; a point inside its base circle is lowest.
        beyond = np.nan_to_num(_turned(flanks, whole, contact, middle)[1], nan=-np.inf) > end
        low, high = np.where(beyond, middle, low), np.where(beyond, high, middle)
    return np.asarray((low + high) / 2, float)
