"""Compiled loops of solid bodies: fields of point loads, and sums of matrices. Import this module inside functions only.

Loads of `forces` (m,) in N stand at `at` (m, 3), their half-spaces lie along `inward` (m, 3). Places are those of nodes in the
order of the whole, its own first; a node at a negative place is left out. Two nodes may have the same place.
"""

from __future__ import annotations

import math

from gearcad.core.records import Floats, Wholes
from gearcad.core.runtime import compiled, inlined

_AT_LOAD = 1e-9
"""Distance (mm) below which a point is the load's own, where the field has no value."""

_OUTSIDE = 1e-6
"""Least value of 1 + c, which vanishes only straight outside the half-space."""


@inlined
def _displacement(x: float, y: float, z: float, depth: float, poisson_ratio: float) -> tuple[float, float]:
    """Factors f and g (1/mm, 1/mm^2) of the displacement 2 pi E/(1 + nu) u = f n + g a at a = (x, y, z) from 1 N along n.

    Boussinesq's, in the form of `half_space_displacement`; `depth` (mm) is that of a along n.
    """
    rest = 1 - 2 * poisson_ratio
    distance = math.sqrt(x * x + y * y + z * z)
    near = 1 / distance if distance >= _AT_LOAD else 0.0
    c = depth * near
    aside = near * near * (c - rest / max(1 + c, _OUTSIDE))
    return near * (1 + rest + c * c) - aside * depth, aside


@compiled
def add_displacements(points: Floats, at: Floats, inward: Floats, forces: Floats, poisson_ratio: float, result: Floats) -> None:
    """Add 2 pi E/(1 + nu) u at points (n, 3) to a result (n, 3)."""
    for load in range(len(at)):
        nx, ny, nz = inward[load]
        for point in range(len(points)):
            x, y, z = points[point, 0] - at[load, 0], points[point, 1] - at[load, 1], points[point, 2] - at[load, 2]
            along, aside = _displacement(x, y, z, x * nx + y * ny + z * nz, poisson_ratio)
            along, aside = forces[load] * along, forces[load] * aside
            result[point, 0] += along * nx + aside * x
            result[point, 1] += along * ny + aside * y
            result[point, 2] += along * nz + aside * z


@compiled
def add_normal_displacements(
    points: Floats, normals: Floats, at: Floats, inward: Floats, forces: Floats, poisson_ratio: float, result: Floats
) -> None:
    """Add the same along `normals` (n, 3), by groups of loads (m, k, 3), to a result (n, m)."""
    for point in range(len(points)):
        tx, ty, tz = normals[point]
        for group in range(len(at)):
            for load in range(len(forces)):
                x = points[point, 0] - at[group, load, 0]
                y = points[point, 1] - at[group, load, 1]
                z = points[point, 2] - at[group, load, 2]
                nx, ny, nz = inward[group, load]
                along, aside = _displacement(x, y, z, x * nx + y * ny + z * nz, poisson_ratio)
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


@compiled
def add_block(block: Floats, places: Wholes, own: Floats, across: Floats, rest: Floats) -> None:
    """Add a matrix (3 n, 3 n), of which only the lower triangle is read.

    The whole is [[own, across], [across.T, rest]].
    """
    count = own.shape[0] // 3
    for second in range(len(places)):
        column = places[second]
        if column < 0:
            continue
        for first in range(second, len(places)):
            row = places[first]
            if row < 0:
                continue
            i, j = 3 * first, 3 * second
            if row == column:
                # Of one node the lower triangle is there, of two all, and the upper triangle brings the same once more.
                k = 3 * row
                for b in range(3):
                    for a in range(b if first == second else 0, 3):
                        value = block[i + a, j + b]
                        if first != second and a == b:
                            value *= 2
                        low, high = k + max(a, b), k + min(a, b)
                        if row < count:
                            own[low, high] += value
                        else:
                            rest[low - 3 * count, high - 3 * count] += value
            elif row < count and column < count:
                for b in range(3):
                    for a in range(3):
                        if row > column:
                            own[3 * row + a, 3 * column + b] += block[i + a, j + b]
                        else:
                            own[3 * column + b, 3 * row + a] += block[i + a, j + b]
            elif row < count:
                for b in range(3):
                    for a in range(3):
                        across[3 * row + a, 3 * (column - count) + b] += block[i + a, j + b]
            elif column < count:
                for b in range(3):
                    for a in range(3):
                        across[3 * column + b, 3 * (row - count) + a] += block[i + a, j + b]
            else:
                k, m = 3 * (row - count), 3 * (column - count)
                for b in range(3):
                    for a in range(3):
                        if row > column:
                            rest[k + a, m + b] += block[i + a, j + b]
                        else:
                            rest[m + b, k + a] += block[i + a, j + b]


@compiled
def fill_upper(matrix: Floats) -> None:
    """Make a matrix (n, n), of which the lower triangle is given, symmetric."""
    size, step = len(matrix), 64  # blocks that stay in the cache
    for first in range(0, size, step):
        for second in range(0, first + 1, step):
            for column in range(second, min(second + step, size)):
                for row in range(max(first, column + 1), min(first + step, size)):
                    matrix[column, row] = matrix[row, column]


@compiled
def add_hexahedra(blocks: Floats, places: Wholes, own: Floats, across: Floats, rest: Floats) -> None:
    """Add matrices (m, 60, 60) of hexahedra with nodes at places (m, 20)."""
    count = own.shape[0] // 3
    for element in range(len(places)):
        for second in range(20):
            column = places[element, second]
            if column < 0:
                continue
            for first in range(20):
                row = places[element, first]
                if row < column:
                    continue
                for a in range(3):
                    for b in range(a + 1 if row == column else 3):
                        value = blocks[element, 3 * first + a, 3 * second + b]
                        low, high = 3 * row + a, 3 * column + b
                        if low < 3 * count:
                            own[low, high] += value
                        elif high < 3 * count:
                            across[high, low - 3 * count] += value
                        else:
                            rest[low - 3 * count, high - 3 * count] += value
