"""Names in a column beside a drawing, each as near to its part as the others let it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

__all__ = ["LINE", "lines_of", "spread"]

LINE = 0.145
"""Height of a line of text (inches)."""

_CHARACTERS, _LINES = 21, 3
"""Most characters in a line, and lines of a name."""


def lines_of(*texts: str) -> list[str]:
    """Texts in short lines; of one that is too long, the beginning."""
    found = []
    for text in texts:
        lines = textwrap.wrap(text, _CHARACTERS)
        if len(lines) > _LINES:
            lines = [*lines[: _LINES - 1], f"{lines[_LINES - 1][: _CHARACTERS - 1]}…"]
        found += lines
    return found


def spread(wanted: Sequence[float], heights: Sequence[float], gap: float = 0.08) -> list[float]:
    """Middles of blocks of these heights, as near as can be to where they are wanted, without overlap (least squares)."""
    order = sorted(range(len(wanted)), key=lambda each: wanted[each])
    groups: list[list[float]] = []
    offsets, offset = [], 0.0
    for before, each in zip([None, *order], order, strict=False):
        offset += 0.0 if before is None else (heights[before] + heights[each]) / 2 + gap
        offsets.append(offset)
        # Pooled adjacent violators: blocks that would overlap move together, about the mean of their wishes.
        groups.append([wanted[each] - offset, 1.0])
        while len(groups) > 1 and groups[-2][0] > groups[-1][0]:
            (mean, count), (former, others) = groups.pop(), groups.pop()
            groups.append([(mean * count + former * others) / (count + others), count + others])
    starts = [mean for mean, count in groups for _ in range(int(count))]
    placed = [0.0] * len(wanted)
    for each, start, shift in zip(order, starts, offsets, strict=True):
        placed[each] = start + shift
    return placed
