"""Do two gears overlap in mesh? Judged on their exact outlines, without any formula for backlash or contact.

Points of one outline are carried into the frame of the other gear, where its exact half tooth angle tells the angle by
which they clear its flank; then the other way round, since either gear's corner may be what touches. The least clearance
is found on a grid along each curve and refined around its minimum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry import GearPair, ToothProfile

Floats = NDArray[np.float64]

GRID = 65
FINE = 17
REFINEMENTS = 5
"""Each narrows the search to two cells of the last grid: (2/64) (2/16)^4, 1e-5 of a curve's length at the end."""

NEIGHBOURS = 4
"""Teeth on each side of the line of centres that are looked at."""

ROUNDING = 1e-12
"""Angle (rad) at which the search for the touching turn stops."""


@dataclass(frozen=True)
class Placed:
    """A gear's outline, turned by `turn` (rad), with its axis at `x` (mm)."""

    profile: ToothProfile
    turn: float
    x: float

    @property
    def pitch(self) -> float:
        return 2 * math.pi / self.profile.teeth


def _gaps(points: Floats, turns: Floats, x: float, mate: Placed, side: int) -> Floats:
    """Angle (rad) by which points (..., 2), turned by `turns` about an axis at `x`, clear the mate's flanks on `side`.

    It is the angle by which the mate may turn towards them. Infinite beyond the mate's tip circle.
    """
    across = np.cos(turns) * points[..., 0] - np.sin(turns) * points[..., 1] + (x - mate.x)
    along = np.sin(turns) * points[..., 0] + np.cos(turns) * points[..., 1]
    radius = np.hypot(across, along)
    tip, root = mate.profile.tip_diameter / 2, mate.profile.root_diameter / 2
    gaps = np.full(radius.shape, math.inf)
    near = radius <= tip
    ahead = np.mod(side * (np.arctan2(along[near], across[near]) - mate.turn), mate.pitch)
    gaps[near] = ahead - np.radians(mate.profile.half_angle(np.maximum(radius[near], root)))
    gaps[radius < root * (1 - ROUNDING)] = -math.inf
    return gaps


def _least_gap(gear: Placed, mate: Placed, side: int) -> float:
    """Least of `_gaps` over the flanks on `side` of the teeth that face the mate."""
    middle = round(((0.0 if mate.x > gear.x else math.pi) - gear.turn) / gear.pitch)
    count = min(NEIGHBOURS, (gear.profile.teeth - 1) // 2)
    turns = gear.turn + gear.pitch * (middle + np.arange(-count, count + 1))[:, None]

    def search(curve, turns: Floats, low: Floats, high: Floats, steps: int):  # type: ignore[no-untyped-def]
        s = low + (high - low) * np.linspace(0, 1, steps)
        gaps = _gaps(curve.points(s) * [1, side], turns, gear.x, mate, side)
        best = np.argmin(gaps, axis=1)[:, None]
        ends = [np.take_along_axis(s, np.clip(best + step, 0, steps - 1), 1) for step in (-1, 1)]
        return np.take_along_axis(gaps, best, 1), *ends

    zero, one = np.zeros(turns.shape), np.ones(turns.shape)
    coarse = [(curve, *search(curve, turns, zero, one, GRID)) for curve in gear.profile.curves]
    least = min(float(found.min()) for _, found, _, _ in coarse)
    for curve, found, low, high in coarse:
        close = found[:, 0] <= least + 0.05 * mate.pitch  # only these can turn out least on a finer grid
        rest, low, high = turns[close], low[close], high[close]
        for _ in range(REFINEMENTS if close.any() and math.isfinite(least) else 0):
            found, low, high = search(curve, rest, low, high, FINE)
            least = min(least, float(found.min()))
    return least


def turn_to_touch(pair: GearPair, pinion_rotation: float, side: int) -> float:
    """Angle (rad) that the wheel turns from its place in mesh until it touches the pinion; negative if they overlap.

    `side` +1 turns it counter-clockwise, -1 clockwise. Minus infinity where a tip is below the other gear's root.
    """
    pose = pair.wheel_pose(pinion_rotation)
    # The plane is that of the wheel's own z = 0, where the pinion's section has turned by its helix.
    twist = 360 * pose.z / math.copysign(pair.pinion.lead, pair.pinion.helix_angle)
    pinion = Placed(pair.pinion.profile, math.radians(pinion_rotation + twist), 0.0)

    def wheel(turn: float) -> Placed:
        return Placed(pair.wheel.profile, math.radians(pose.rotation) + side * turn, pose.x)

    most = turn = _least_gap(pinion, wheel(0.0), side)
    if not math.isfinite(most):
        return most
    for _ in range(60):
        left = _least_gap(wheel(turn), pinion, side)  # what the pinion could still turn towards the wheel's points
        if turn == most and left >= 0:
            break
        step = left / pair.gear_ratio
        turn = min(most, turn + step)
        if abs(step) < ROUNDING:
            break
    return turn
