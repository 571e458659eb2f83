"""Occupied: what is on a sheet already, and whether something else would clash with it. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from gearcad.arrays import Floats
from gearcad.drawing.shapes.box import Box
from gearcad.drawing.shapes.figure import Figure
from gearcad.drawing.shapes.shapes import Segment

__all__ = ["Occupied"]

_AIR = 0.6
"""Least distance of a text from other texts and lines."""


class Occupied:
    """Texts and lines that stand: no text may meet another or a line, lines may cross lines."""

    def __init__(self, *figures: Figure, taken: Iterable[Box] = (), within: Box | None = None) -> None:
        """`taken` are areas where nothing may be, `within` the one that nothing may leave."""
        self._texts: list[Box] = []
        self._segments = np.empty((0, 4))
        self._taken, self._within = list(taken), within
        for figure in figures:
            self.add(figure)

    def add(self, figure: Figure) -> None:
        """What stands from now on."""
        self._texts += _text_boxes(figure)
        self._segments = np.concatenate([self._segments, _as_rows(figure.segments)])

    def clashes(self, figure: Figure) -> bool:
        """Whether a figure would meet what stands, or leave what it must stay within."""
        box = figure.box
        if self._within is not None and not self._within.holds(box):
            return True
        if any(box.meets(each) for each in self._taken):
            return True
        texts, rows = [each.grown(_AIR) for each in _text_boxes(figure)], _as_rows(figure.segments)
        return (
            any(one.meets(other) for one in texts for other in self._texts)
            or any(_crossed(each, self._segments) for each in texts)
            or any(_crossed(each.grown(_AIR), rows) for each in self._texts)
        )


def _text_boxes(figure: Figure) -> list[Box]:
    return [text.box for text in figure.texts]


def _as_rows(segments: list[Segment]) -> Floats:
    return np.array([(*start, *end) for start, end in segments], dtype=float).reshape(-1, 4)


def _crossed(box: Box, segments: Floats) -> bool:
    """Whether any segment has a point within a box (Liang and Barsky)."""
    if not len(segments):
        return False
    start, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    low, high = np.array(box[:2]), np.array(box[2:])
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (low - start) / way, (high - start) / way
    still = way == 0
    outside = (still & ((start <= low) | (start >= high))).any(axis=1)
    enter = np.where(still, -np.inf, np.minimum(near, far)).max(axis=1)
    leave = np.where(still, np.inf, np.maximum(near, far)).min(axis=1)
    return bool((~outside & (np.maximum(enter, 0) < np.minimum(leave, 1))).any())
