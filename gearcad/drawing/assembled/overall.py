"""Sizes over all of a view, for information (in brackets: no one measures them)."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.marks import Side, linear_dimension
from gearcad.drawing.shapes import Box, Figure
from gearcad.drawing.words import Draughting, Size

__all__ = ["overall_height", "overall_width"]


def overall_height(box: Box, value: float, draughting: Draughting, prefix: str = "") -> Iterator[Figure]:
    """The height of outlines within a box on paper, at the right or at the left; the value in mm of the part."""
    size = Size(value=value, prefix=prefix, reference=True)
    for side, edge in ((Side.RIGHT, box.right), (Side.LEFT, box.left)):
        yield from linear_dimension((edge, box.bottom), (edge, box.top), side, size, draughting, clear=edge)


def overall_width(box: Box, value: float, draughting: Draughting) -> Iterator[Figure]:
    """Their width, below or above."""
    size = Size(value=value, reference=True)
    for side, edge in ((Side.BELOW, box.bottom), (Side.ABOVE, box.top)):
        yield from linear_dimension((box.left, edge), (box.right, edge), side, size, draughting, clear=edge)
