"""Gears on their exact outlines: overlap in mesh, area and distance, without the code that is judged."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import quad
from scipy.spatial import cKDTree

from gearcad import Gear
from gearcad.core.records import Floats
from gearcad.geometry import GearPair, ToothProfile

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


def _over_teeth(gear: Gear, weight: Callable[[float], float], *breaks: float) -> float:
    """Integral over the teeth of weight(R) 2 psi(R) R dR from root to tip circle, split where anything has a corner.

    R = R0 + t^2 takes out the square root with which the tooth widens at the root circle.
    """
    root, tip = gear.root_diameter / 2, gear.tip_diameter / 2
    corners = (root, gear.form_diameter / 2, gear.profile.tip_form_diameter / 2, tip, *breaks)
    total = 0.0
    for low, high in pairwise(sorted({min(max(corner, root), tip) for corner in corners})):

        def density(t: float, low: float = low, high: float = high) -> float:
            radius = min(low + t * t, high)
            return float(weight(radius) * 2 * math.radians(gear.profile.half_angle(radius)) * radius * 2 * t)

        total += gear.teeth * quad(density, 0, math.sqrt(high - low), epsabs=1e-14, epsrel=1e-13, limit=400)[0]
    return total


def section_area(gear: Gear) -> float:
    """Area of the transverse section without a bore (mm²), by quadrature of the half tooth angle over the radius."""
    return math.pi * gear.root_diameter**2 / 4 + _over_teeth(gear, lambda radius: 1.0)


def toothed_volume(gear: Gear) -> float:
    """Volume of the toothed part without bore and end chamfers (mm³)."""
    return section_area(gear) * gear.face_width


def chamfered_volume(gear: Gear) -> float:
    """Volume that both end chamfers take away (mm³): twice the integral of the cone's depth over the section."""
    tangent = math.tan(math.radians(gear.body.end_chamfer_angle))
    start, root = gear.tip_diameter / 2 - gear.body.end_chamfer * tangent, gear.root_diameter / 2

    def depth(radius: float) -> float:
        return max(radius - start, 0.0) / tangent

    below = quad(lambda r: depth(r) * 2 * math.pi * r, min(start, root), root, epsabs=1e-14)[0]
    return 2 * (below + _over_teeth(gear, depth, start))


def solid_volume(gear: Gear) -> float:
    """Volume of the whole gear (mm³): teeth, less end chamfers, with hubs, less bore and keyway through everything."""
    body, opening = gear.body, 0.0
    if body.bore:
        radius, half = body.bore / 2, body.keyway_width / 2
        mouth = math.sqrt(radius**2 - half**2)
        segment = radius**2 * math.asin(half / radius) - half * mouth  # of the bore, beyond the mouth of the keyway
        opening = math.pi * radius**2
        if body.keyway_width:
            opening += body.keyway_width * (radius + body.keyway_depth - mouth) - segment
    hubs = sum(body.hub_ends)
    ends = chamfered_volume(gear) if body.end_chamfer else 0.0
    return toothed_volume(gear) - ends + hubs * math.pi * body.hub_diameter**2 / 4 - opening * (gear.face_width + hubs)


def distance_to_section(gear: Gear, points: Floats) -> Floats:
    """Distance (mm) of points (n, 3) on the toothed side from the exact screw surface, measured in the transverse section.

    Points are turned back by the twist and folded to tooth 0; the nearest point of the outline is found by Newton steps
    from a dense sample.
    """
    rate = math.tan(math.radians(gear.helix_angle)) / (abs(gear.reference_diameter) / 2)
    pitch = 2 * math.pi / gear.tooth_count
    radius = np.hypot(points[:, 0], points[:, 1])
    angle = np.arctan2(points[:, 1], points[:, 0]) - rate * points[:, 2]
    angle = np.abs(np.mod(angle + pitch / 2, pitch) - pitch / 2)
    flat = np.stack([radius * np.cos(angle), radius * np.sin(angle)], -1)
    nearest = np.full(len(flat), np.inf)
    for curve in gear.profile.curves:
        s = np.linspace(0, 1, 801)
        s = s[cKDTree(curve.points(s)).query(flat)[1]]
        for _ in range(4):
            here, beside = curve.points(s), np.where(s < 0.5, 1e-6, -1e-6)
            speed = np.hypot(*(curve.points(s + beside) - here).T) / np.abs(beside)
            heading, off = curve.direction(s), flat - here
            along = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
            s = np.clip(s + along / np.maximum(speed, 1e-12), 0, 1)
        nearest = np.minimum(nearest, np.hypot(*(flat - curve.points(s)).T))
    return nearest
