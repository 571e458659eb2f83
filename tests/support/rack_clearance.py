"""Do a pinion and a rack overlap in mesh? Judged on their exact outlines, without any formula for backlash or contact.

As `support.clearance` does for gears: points of one outline are carried into the frame of the other, the least clearance is
found on a grid along each curve and refined around its minimum; here at several positions at once. The rack is endless.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad import RackPair

Floats = NDArray[np.float64]

GRID = 49
FINE = 13
REFINEMENTS = 6
"""Each narrows the search to two cells of the last grid: (2/48) (2/12)^5, 5e-6 of a curve's length at the end."""

ROUNDING = 1e-12


class _Meshed:
    """Pinion and rack at rotations (degrees) of the pinion, at the rack's own z = 0; the rack may move by `side` along y."""

    def __init__(self, pair: RackPair, rotations: ArrayLike, side: int) -> None:
        self.pinion, self.rack, self.side = pair.pinion.profile, pair.rack.profile, side
        rotations = np.asarray(rotations, float)
        poses = [pair.rack_pose(rotation) for rotation in rotations.tolist()]
        lead = math.copysign(pair.pinion.lead, pair.pinion.helix_angle)
        self.turn = np.radians(rotations + 360 * poses[0].z / lead)[:, None, None]
        self.x, self.y = poses[0].x, np.array([pose.y for pose in poses])[:, None, None]
        self.pitch, self.angle = self.rack.pitch, 2 * math.pi / self.pinion.teeth
        # As many teeth on each side of the line of centres as have their tips beyond the line of the other's.
        tip, line = self.pinion.tip_diameter / 2, self.x - self.rack.tip_height
        self.count = math.ceil(math.sqrt(max(tip**2 - line**2, 0.0)) / self.pitch) + 1

    def from_pinion(self) -> Floats:
        """How far (mm) the rack may move towards points of the pinion."""
        count = min(self.count, (int(self.pinion.teeth) - 1) // 2)
        near = np.arange(-count, count + 1)[:, None] + np.round(-self.turn / self.angle)
        turns = self.turn + self.angle * near

        def gaps(points: Floats, turns: Floats) -> Floats:
            y = -self.side * points[..., 1]
            across = np.cos(turns) * points[..., 0] - np.sin(turns) * y
            along = np.sin(turns) * points[..., 0] + np.cos(turns) * y
            height = self.x - across
            ahead = np.mod(self.side * (along - self.y - self.pitch / 2), self.pitch)
            tip, root = self.rack.tip_height, self.rack.root_depth
            found = ahead - self.rack.half_thickness(np.clip(height, -root, tip))
            return np.where(height > tip, math.inf, np.where(height < -root * (1 + ROUNDING), -math.inf, found))

        return _least(self.pinion.curves, turns, gaps)

    def from_rack(self, moved: Floats) -> Floats:
        """By what angle (rad) the pinion may turn towards points of the rack that has moved."""
        near = np.arange(-self.count, self.count + 1)[:, None] + np.round(-self.y / self.pitch - 0.5)
        centres = self.y + self.side * moved[:, None, None] + self.pitch * (near + 0.5)

        def gaps(points: Floats, centres: Floats) -> Floats:
            across, along = self.x - points[..., 1], centres - self.side * points[..., 0]
            radius = np.hypot(across, along)
            tip, root = self.pinion.tip_diameter / 2, self.pinion.root_diameter / 2
            ahead = np.mod(-self.side * (np.arctan2(along, across) - self.turn), self.angle)
            found = ahead - np.radians(self.pinion.half_angle(np.clip(radius, root, tip)))
            return np.where(radius > tip, math.inf, np.where(radius < root * (1 - ROUNDING), -math.inf, found))

        return _least(self.rack.curves, centres, gaps)


def _least(curves: Iterable[Any], teeth: Floats, gaps: Callable[[Floats, Floats], Floats]) -> Floats:
    """Least gap over the curves of all teeth (positions, teeth, 1), for every position."""
    found = []
    for curve in curves:
        low, high = np.zeros(teeth.shape), np.ones(teeth.shape)
        for steps in (GRID, *[FINE] * REFINEMENTS):
            s = low + (high - low) * np.linspace(0, 1, steps)
            values = gaps(curve.points(s), teeth)
            best = np.argmin(values, axis=-1)[..., None]
            found.append(np.take_along_axis(values, best, -1).min(axis=(1, 2)))
            low, high = (np.take_along_axis(s, np.clip(best + step, 0, steps - 1), -1) for step in (-1, 1))
    least: Floats = np.min(found, axis=0)
    return least


def travel_to_touch(pair: RackPair, rotations: ArrayLike, side: int) -> Floats:
    """How far (mm) the rack moves along +y (`side` 1) or -y (-1) from its place in mesh until it touches the pinion.

    (n,) at rotations (n,) of the pinion in degrees. Negative where they overlap; minus infinity where a tip is below the
    other's root.
    """
    meshed = _Meshed(pair, rotations, side)
    most = meshed.from_pinion()
    travel = np.where(np.isfinite(most), most, 0.0)
    for _ in range(60):
        step = meshed.from_rack(travel) * pair.pitch_radius
        done = ((travel == most) & (step >= 0)) | (np.abs(step) < ROUNDING * pair.pitch_radius) | ~np.isfinite(most)
        if np.all(done):
            break
        travel = np.where(done, travel, np.minimum(most, travel + step))
    return np.where(np.isfinite(most), travel, most)
