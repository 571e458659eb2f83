"""Figure: shapes that belong together, and stay so when they are moved. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from gearcad.drawing.shapes.box import Box
from gearcad.drawing.shapes.shapes import Segment, Shape, Text

__all__ = ["Figure"]


@dataclass(frozen=True)
class Figure:
    """Some shapes."""

    shapes: tuple[Shape, ...] = ()

    @classmethod
    def of(cls, *parts: Shape | Figure) -> Figure:
        """Shapes and figures as one."""
        return cls(tuple(shape for part in parts for shape in (part.shapes if isinstance(part, Figure) else (part,))))

    def __add__(self, other: Figure) -> Figure:
        return Figure(self.shapes + other.shapes)

    def moved(self, across: float, up: float) -> Figure:
        """The same elsewhere."""
        return Figure(tuple(shape.moved(across, up) for shape in self.shapes))

    @property
    def box(self) -> Box:
        """What holds all of it. Raises ValueError of an empty one."""
        return Box.of_all(shape.box for shape in self.shapes)

    @property
    def segments(self) -> list[Segment]:
        """Its lines that no text may cross."""
        return [segment for shape in self.shapes for segment in shape.segments]

    @property
    def texts(self) -> list[Text]:
        """Its texts, those of its dimensions too."""
        return [text for shape in self.shapes for text in _texts_of(shape)]


def _texts_of(shape: Shape) -> Iterable[Text]:
    """A compound shape has parts."""
    if isinstance(shape, Text):
        return (shape,)
    return (each for each in getattr(shape, "parts", ()) if isinstance(each, Text))
