"""Exact area and distance of a gear's section, obtained without the code that builds solids."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.spatial import cKDTree

from gearcad import Gear

Floats = NDArray[np.float64]


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
