"""Shapes: lines, circles, texts and filled areas on paper. Lengths in mm, angles in degrees counter-clockwise from +x."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise
from typing import Self

from gearcad.drawing.shapes.box import Box
from gearcad.drawing.shapes.font import STRETCH, reach, text_width
from gearcad.drawing.shapes.pens import Pen

__all__ = ["Anchor", "Arc", "Circle", "Filled", "Hatching", "Line", "Point", "Polyline", "Segment", "Shape", "Text", "Vertex"]

Point = tuple[float, float]
Segment = tuple[Point, Point]

Vertex = tuple[float, float, float]
"""x, y and the bulge of what follows: tan of a quarter of the arc's angle, positive counter-clockwise, 0 for a line."""

_CHORDS = 7.5
"""Degrees of an arc between the points by which its box and its segments are found."""


class Shape(ABC):
    """One thing that is drawn."""

    @abstractmethod
    def moved(self, across: float, up: float) -> Self:
        """The same elsewhere."""

    @property
    @abstractmethod
    def box(self) -> Box:
        """What holds it."""

    @property
    def segments(self) -> list[Segment]:
        """The lines that no text may cross; of an arc its chords."""
        return []


def _shift(point: Point, across: float, up: float) -> Point:
    return point[0] + across, point[1] + up


@dataclass(frozen=True)
class Line(Shape):
    """A straight line."""

    start: Point
    end: Point
    pen: Pen = Pen.OUTLINE

    def moved(self, across: float, up: float) -> Self:
        return replace(self, start=_shift(self.start, across, up), end=_shift(self.end, across, up))

    @property
    def box(self) -> Box:
        return Box.around((self.start, self.end))

    @property
    def segments(self) -> list[Segment]:
        return [(self.start, self.end)]


@dataclass(frozen=True)
class Polyline(Shape):
    """Straight lines and arcs in a row."""

    vertices: tuple[Vertex, ...]
    pen: Pen = Pen.OUTLINE
    closed: bool = False

    @classmethod
    def straight(cls, points: list[Point] | tuple[Point, ...], pen: Pen = Pen.OUTLINE, *, closed: bool = False) -> Self:
        """One without arcs."""
        return cls(tuple((x, y, 0.0) for x, y in points), pen, closed)

    def moved(self, across: float, up: float) -> Self:
        return replace(self, vertices=tuple((x + across, y + up, bulge) for x, y, bulge in self.vertices))

    @property
    def points(self) -> list[Point]:
        """Points along it, of arcs so many that chords stand for them."""
        row = [*self.vertices, self.vertices[0]] if self.closed else list(self.vertices)
        found = [row[0][:2]]
        for start, end in pairwise(row):
            found += _along(start, end)
        return found

    @property
    def box(self) -> Box:
        return Box.around(self.points)

    @property
    def segments(self) -> list[Segment]:
        return list(pairwise(self.points))


@dataclass(frozen=True)
class Circle(Shape):
    """A whole circle."""

    centre: Point
    radius: float
    pen: Pen = Pen.OUTLINE

    def moved(self, across: float, up: float) -> Self:
        return replace(self, centre=_shift(self.centre, across, up))

    @property
    def box(self) -> Box:
        return Box(*self.centre, *self.centre).grown(self.radius)

    @property
    def segments(self) -> list[Segment]:
        return list(pairwise(_round(self.centre, self.radius, 0.0, 360.0)))


@dataclass(frozen=True)
class Arc(Shape):
    """From `start` counter-clockwise to `end`."""

    centre: Point
    radius: float
    start: float
    end: float
    pen: Pen = Pen.OUTLINE

    def moved(self, across: float, up: float) -> Self:
        return replace(self, centre=_shift(self.centre, across, up))

    @property
    def points(self) -> list[Point]:
        """Points along it."""
        return _round(self.centre, self.radius, self.start, self.start + (self.end - self.start) % 360.0)

    @property
    def box(self) -> Box:
        return Box.around(self.points)

    @property
    def segments(self) -> list[Segment]:
        return list(pairwise(self.points))


@dataclass(frozen=True)
class Filled(Shape):
    """A filled polygon of three or four points."""

    points: tuple[Point, ...]
    pen: Pen = Pen.SYMBOL

    def moved(self, across: float, up: float) -> Self:
        return replace(self, points=tuple(_shift(each, across, up) for each in self.points))

    @property
    def box(self) -> Box:
        return Box.around(self.points)

    @property
    def segments(self) -> list[Segment]:
        return list(pairwise((*self.points, self.points[0])))


@dataclass(frozen=True)
class Hatching(Shape):
    """Thin lines at 45 degrees (or at `angle`) within closed polylines; one within another is left out."""

    edges: tuple[tuple[Vertex, ...], ...]
    angle: float = 45.0
    spacing: float = 2.5
    pen: Pen = Pen.HATCH

    def moved(self, across: float, up: float) -> Self:
        return replace(self, edges=tuple(tuple((x + across, y + up, b) for x, y, b in edge) for edge in self.edges))

    @property
    def box(self) -> Box:
        return Box.of_all(Polyline(edge, self.pen, closed=True).box for edge in self.edges)


class Anchor(Enum):
    """Which point of a text stands at its place: its left, centre or right; the line, or the middle of its capitals."""

    LEFT = "LEFT"
    CENTRE = "CENTER"
    RIGHT = "RIGHT"
    MIDDLE_LEFT = "MIDDLE_LEFT"
    MIDDLE = "MIDDLE_CENTER"
    MIDDLE_RIGHT = "MIDDLE_RIGHT"

    @property
    def along(self) -> float:
        """How much of the text is before its place."""
        return {"LEFT": 0.0, "RIGHT": 1.0}.get(self.value.removeprefix("MIDDLE_"), 0.5)

    @property
    def up(self) -> float:
        """How much of the height of capitals is below its place."""
        return 0.5 if self.value.startswith("MIDDLE") else 0.0


@dataclass(frozen=True)
class Text(Shape):
    """A line of text; `height` that of its capitals, `rotation` 0, or 90 to be read from the right."""

    words: str
    at: Point
    height: float = 3.5
    anchor: Anchor = Anchor.LEFT
    rotation: float = 0.0
    pen: Pen = Pen.FINE_TEXT
    stretch: float = STRETCH

    def moved(self, across: float, up: float) -> Self:
        return replace(self, at=_shift(self.at, across, up))

    @property
    def width(self) -> float:
        """Its length."""
        return text_width(self.words, self.height, self.stretch)

    @property
    def start(self) -> Point:
        """Where its line begins."""
        along, up = -self.anchor.along * self.width, -self.anchor.up * self.height
        return self._turned(along, up)

    @property
    def box(self) -> Box:
        below, above = reach(self.words)
        along, up = -self.anchor.along * self.width, -self.anchor.up * self.height
        corners = ((along, up - below * self.height), (along + self.width, up + above * self.height))
        return Box.around(self._turned(*corner) for corner in corners)

    def _turned(self, along: float, up: float) -> Point:
        cosine, sine = math.cos(math.radians(self.rotation)), math.sin(math.radians(self.rotation))
        return self.at[0] + along * cosine - up * sine, self.at[1] + along * sine + up * cosine


def _round(centre: Point, radius: float, start: float, end: float) -> list[Point]:
    """Points on an arc of degrees, among them those furthest up, down, left and right."""
    low, high = sorted((start, end))
    between = (_CHORDS * step for step in range(math.floor(low / _CHORDS) + 1, math.ceil(high / _CHORDS)))
    angles = sorted((low, *between, high), reverse=end < start)
    turns = map(math.radians, angles)
    return [(centre[0] + radius * math.cos(each), centre[1] + radius * math.sin(each)) for each in turns]


def _along(start: Vertex, end: Vertex) -> list[Point]:
    """Points from one vertex to the next, without the first."""
    (x, y, bulge), finish = start, end[:2]
    if not bulge:
        return [finish]
    across, up = finish[0] - x, finish[1] - y
    towards = (1 - bulge**2) / (4 * bulge)  # the centre is so many chords to the left of the chord's middle
    centre = ((x + finish[0]) / 2 - towards * up, (y + finish[1]) / 2 + towards * across)
    radius = math.hypot(x - centre[0], y - centre[1])
    begin = math.degrees(math.atan2(y - centre[1], x - centre[0]))
    return [*_round(centre, radius, begin, begin + math.degrees(4 * math.atan(bulge)))[1:-1], finish]
