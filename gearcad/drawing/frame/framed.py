"""Framed: a part of what frames the views of a sheet."""

from __future__ import annotations

from dataclasses import dataclass, field

from gearcad.drawing.shapes import Box, Figure
from gearcad.notice import Notice

__all__ = ["Framed"]


@dataclass(frozen=True)
class Framed:
    """A figure with its place, and what had to be shortened in it."""

    figure: Figure = field(default_factory=Figure)
    notices: tuple[Notice, ...] = ()

    @property
    def empty(self) -> bool:
        """Whether there is nothing to be seen."""
        return not self.figure.shapes

    @property
    def box(self) -> Box:
        """What holds it. Raises ValueError of an empty one."""
        return self.figure.box

    def moved(self, across: float, up: float) -> Framed:
        """The same elsewhere."""
        return Framed(self.figure.moved(across, up), self.notices)

    def __add__(self, other: Framed) -> Framed:
        return Framed(self.figure + other.figure, self.notices + other.notices)
