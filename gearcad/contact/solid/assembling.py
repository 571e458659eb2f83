"""Matrices of parts added to that of the whole, three dofs a node: only its lower triangle, in its three blocks.

Compiled by numba: import this room inside functions only. Places are those of nodes in the order of the whole, its own first; a
node at a negative place is left out. Two nodes may have the same place.
"""

from __future__ import annotations

from gearcad.arrays import Floats, Wholes
from gearcad.compiled import compiled

__all__ = ["add_block", "add_hexahedra", "fill_upper"]


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
