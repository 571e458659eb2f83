"""View: what one sees of a part from one side, and what is to be said of it there. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from gearcad.drawing.shapes import Figure

__all__ = ["Candidates", "View"]

Candidates = Callable[[], Iterable[Figure]]
"""One mark in all places where it may stand, best first."""


@dataclass(frozen=True)
class View:
    """`figure` is its outline at the scale of the paper, the origin on the axis that it shares with views beside it.

    `annotations` are its marks in order of importance, each by its possible places.
    """

    name: str
    figure: Figure
    annotations: tuple[Candidates, ...] = ()
