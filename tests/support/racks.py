"""Height, section and volume of racks by formulas of their own: the basic rack square to the teeth, stretched along x."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad

from gearcad import Rack

Floats = NDArray[np.float64]


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
