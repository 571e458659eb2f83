"""Fields of point loads on half-spaces at many points, added up: the formulas of `boussinesq`, compiled by numba.

Import this room inside functions only. Loads of `forces` (m,) in N stand at `at` (m, 3), their half-spaces lie along `inward`
(m, 3).
"""

from __future__ import annotations

import math

from gearcad.arrays import Floats
from gearcad.compiled import compiled

__all__ = ["add_displacements", "add_normal_displacements", "add_tractions"]


_AT_LOAD = 1e-9
"""Distance (mm) below which a point is the load's own, where the field has no value."""

_OUTSIDE = 1e-6
"""Least 1 + c: it only vanishes straight outside the half-space."""


@compiled
def add_displacements(points: Floats, at: Floats, inward: Floats, forces: Floats, poisson_ratio: float, result: Floats) -> None:
    """Add 2 pi E/(1 + nu) u at points (n, 3) to a result (n, 3)."""
    rest = 1 - 2 * poisson_ratio
    for load in range(len(at)):
        nx, ny, nz = inward[load]
        for point in range(len(points)):
            x, y, z = points[point, 0] - at[load, 0], points[point, 1] - at[load, 1], points[point, 2] - at[load, 2]
            depth, distance = x * nx + y * ny + z * nz, math.sqrt(x * x + y * y + z * z)
            near = 1 / distance if distance >= _AT_LOAD else 0.0
            c = depth * near
            aside = near * near * (c - rest / max(1 + c, _OUTSIDE))
            along = forces[load] * (near * (1 + rest + c * c) - aside * depth)
            aside *= forces[load]
            result[point, 0] += along * nx + aside * x
            result[point, 1] += along * ny + aside * y
            result[point, 2] += along * nz + aside * z


@compiled
def add_normal_displacements(
    points: Floats, normals: Floats, at: Floats, inward: Floats, forces: Floats, poisson_ratio: float, result: Floats
) -> None:
    """Add the same along `normals` (n, 3), by groups of loads (m, k, 3), to a result (n, m)."""
    rest = 1 - 2 * poisson_ratio
    for point in range(len(points)):
        tx, ty, tz = normals[point]
        for group in range(len(at)):
            for load in range(len(forces)):
                x = points[point, 0] - at[group, load, 0]
                y = points[point, 1] - at[group, load, 1]
                z = points[point, 2] - at[group, load, 2]
                nx, ny, nz = inward[group, load]
                depth, distance = x * nx + y * ny + z * nz, math.sqrt(x * x + y * y + z * z)
                near = 1 / distance if distance >= _AT_LOAD else 0.0
                c = depth * near
                aside = near * near * (c - rest / max(1 + c, _OUTSIDE))
                along = near * (1 + rest + c * c) - aside * depth
                moved = along * (nx * tx + ny * ty + nz * tz) + aside * (x * tx + y * ty + z * tz)
                result[point, group] += forces[load] * moved


@compiled
def add_tractions(
    points: Floats, normals: Floats, at: Floats, inward: Floats, forces: Floats, poisson_ratio: float, result: Floats
) -> None:
    """Add 2 pi times the traction on elements of surface with `normals` (n, 3) at points (n, 3) to a result (n, 3)."""
    rest = 1 - 2 * poisson_ratio
    for load in range(len(at)):
        nx, ny, nz = inward[load]
        for point in range(len(points)):
            x, y, z = points[point, 0] - at[load, 0], points[point, 1] - at[load, 1], points[point, 2] - at[load, 2]
            tx, ty, tz = normals[point]
            depth, distance = x * nx + y * ny + z * nz, math.sqrt(x * x + y * y + z * z)
            near = 1 / distance if distance >= _AT_LOAD else 0.0
            c = depth * near
            above = max(1 + c, _OUTSIDE)
            on_axis, on_away = tx * nx + ty * ny + tz * nz, tx * x + ty * y + tz * z
            square = near * near
            around = rest * square * (c - 1 / above)
            pressed = 3 * c * near * square * on_away
            aside = square * square * (rest * (2 + c) / (above * above) * (on_away - depth * on_axis)) - near * pressed
            along = -c * pressed - around * on_axis - aside * depth
            along, aside, around = forces[load] * along, forces[load] * aside, forces[load] * around
            result[point, 0] += along * nx + aside * x + around * tx
            result[point, 1] += along * ny + aside * y + around * ty
            result[point, 2] += along * nz + aside * z + around * tz
