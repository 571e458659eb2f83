"""Racks by formulas of the tests' own, and whether a pinion and a rack overlap in mesh."""

import math
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import quad

from gearcad import Rack, RackPair
from gearcad.core.records import Floats

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


def _corners(rack: Rack) -> list[float]:
    """Distances from the middle of a tooth, square to the teeth, between which the outline is smooth, and half a pitch."""
    angle, rho = math.radians(rack.rack.pressure_angle), rack.root_radius * rack.normal_module
    half, tangent = rack.normal_tooth_thickness / 2, math.tan(angle)
    chamfer = rack.tip_chamfer * math.cos(math.radians(rack.helix_angle))
    end = half - (rack.tip_height - rack.tip_chamfer) * tangent
    form = half + (rack.root_depth - rho * (1 - math.sin(angle))) * tangent
    return [0.0, end - chamfer, end, form, min(form + rho * math.cos(angle), rack.normal_pitch / 2), rack.normal_pitch / 2]


def rack_height(rack: Rack, c: Floats) -> Floats:
    """Height over the reference line at x = c (mm, any shape) of the section at z = 0."""
    cosine, pitch = math.cos(math.radians(rack.helix_angle)), rack.normal_pitch
    across = np.abs(np.mod(np.asarray(c, float) * cosine, pitch) - pitch / 2)
    _, tip, end, form, foot, _ = _corners(rack)
    rho, tangent = rack.root_radius * rack.normal_module, math.tan(math.radians(rack.rack.pressure_angle))
    fillet = -rack.root_depth + rho - np.sqrt(np.maximum(rho**2 - np.maximum(foot - across, 0) ** 2, 0))
    flank = (rack.normal_tooth_thickness / 2 - across) / tangent
    chamfer = rack.tip_height - (across - tip) / cosine
    pieces = [across <= tip, across <= end, across <= form, across <= foot]
    height: Floats = np.select(pieces, [np.full_like(across, rack.tip_height), chamfer, flank, fillet], -rack.root_depth)
    return height


def rack_volume(rack: Rack) -> float:
    """Volume (mm³): height over the back, times how long the line of constant c is inside the rectangle, over c."""
    length, width, drift = rack.length, rack.face_width, -math.tan(math.radians(rack.helix_angle))

    def inside(c: float) -> float:
        if drift == 0:
            return width
        first, last = sorted((-c / drift, (length - c) / drift))
        return max(0.0, min(last, width) - max(first, 0.0))

    return _over(rack, min(0.0, -drift * width), max(length, length - drift * width), inside, [length, -drift * width])


def section_area(rack: Rack) -> float:
    """Area (mm²) of the section at z = 0."""
    return _over(rack, 0.0, rack.length, lambda c: 1.0, [])


def _over(rack: Rack, low: float, high: float, weight, breaks: list[float]) -> float:  # type: ignore[no-untyped-def]
    pitch, cosine = rack.transverse_pitch, math.cos(math.radians(rack.helix_angle))
    middles = (np.arange(math.floor(low / pitch) - 1, math.ceil(high / pitch) + 1) + 0.5) * pitch
    corners = {middle + side * corner / cosine for middle in middles for corner in _corners(rack) for side in (1, -1)}
    corners |= {low, high, 0.0, *breaks, *(each + rack.length for each in breaks)}
    total = 0.0
    for start, end in pairwise(sorted(corner for corner in corners if low <= corner <= high)):

        def density(c: float) -> float:
            return (float(rack_height(rack, np.array(c))) + rack.height) * weight(c)

        total += quad(density, start, end, epsabs=1e-13, epsrel=1e-12)[0]
    return total
