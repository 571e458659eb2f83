"""Labels one above the other: each as near to its place as the others let it."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["spread"]


def spread(wanted: Sequence[float], gap: float) -> list[float]:
    """Places at least `gap` apart, with the least sum of squares of their distances from the rising places that are wanted.

    Those that would be too near each other make a block around their mean (pool adjacent violators).

    >>> spread([0.0, 1.0, 10.0], 3.0)
    [-1.0, 2.0, 10.0]
    """
    blocks: list[tuple[float, int]] = []
    for i, place in enumerate(wanted):
        total, count = place - i * gap, 1
        while blocks and blocks[-1][0] / blocks[-1][1] > total / count:
            before, more = blocks.pop()
            total, count = total + before, count + more
        blocks.append((total, count))
    firsts = [total / count for total, count in blocks for _ in range(count)]
    return [first + i * gap for i, first in enumerate(firsts)]
