"""Shapes on a sheet: pens (ISO 128-2), lines, arcs, texts, hatches, dimensions and figures.

Lengths in mm of paper, y upwards; angles in degrees counter-clockwise from +x.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache, cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Self

if TYPE_CHECKING:
    from fontTools.ttLib import TTFont


class Box(NamedTuple):
    """A rectangle by its sides."""

    left: float
    bottom: float
    right: float
    top: float

    @classmethod
    def around(cls, points: Iterable[tuple[float, float]]) -> Box:
        """Return the smallest box that holds all points."""
        across, up = zip(*points, strict=True)
        return cls(min(across), min(up), max(across), max(up))

    @classmethod
    def of_all(cls, boxes: Iterable[Box]) -> Box:
        """Return the smallest box that holds all boxes."""
        lefts, bottoms, rights, tops = zip(*boxes, strict=True)
        return cls(min(lefts), min(bottoms), max(rights), max(tops))

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    @property
    def middle(self) -> tuple[float, float]:
        return (self.left + self.right) / 2, (self.bottom + self.top) / 2

    def moved(self, across: float, up: float) -> Box:
        return Box(self.left + across, self.bottom + up, self.right + across, self.top + up)

    def grown(self, by: float) -> Box:
        """Return the box enlarged by `by` (mm) on every side."""
        return Box(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def meets(self, other: Box) -> bool:
        """Return whether two boxes have an area in common."""
        return self.left < other.right and other.left < self.right and self.bottom < other.top and other.bottom < self.top

    def holds(self, other: Box) -> bool:
        """Return whether no part of another box is outside."""
        return self.left <= other.left and self.bottom <= other.bottom and other.right <= self.right and other.top <= self.top


class Stroke(NamedTuple):
    """A line of group 0.5: its width (mm), and the lengths of its dashes and gaps in turn (mm); none for a continuous line."""

    width: float
    dashes: tuple[float, ...] = ()


_LONG_DASH_DOT = (12.0, 3.0, 0.5, 3.0)
_DASHED = (3.0, 0.75)


class Pen(Enum):
    """A pen for shapes; its value is the name of a layer."""

    OUTLINE = "OUTLINE"
    """Visible edges."""

    THIN = "THIN"
    """Root circles outside, directions of flanks, construction."""

    CENTRE = "CENTRE"
    """Axes, and reference circles."""

    HIDDEN = "HIDDEN"
    """Edges behind others."""

    DIMENSION = "DIM"
    HATCH = "HATCH"
    SYMBOL = "SYMBOL"
    """Roughness, tolerance frames, datums, arrows."""

    FRAME = "FRAME"
    GRID = "GRID"
    """Fields at the frame."""

    TABLE = "TABLE"
    """Lines within tables and title block."""

    TEXT = "TEXT"
    """Texts and values."""

    FINE_TEXT = "TEXT_S"
    """Captions, and the text of dimensions."""

    @property
    def stroke(self) -> Stroke:
        """Width and dashes of its lines."""
        return _STROKES[self]


_STROKES = {
    Pen.OUTLINE: Stroke(0.5),
    Pen.THIN: Stroke(0.25),
    Pen.CENTRE: Stroke(0.25, _LONG_DASH_DOT),
    Pen.HIDDEN: Stroke(0.25, _DASHED),
    Pen.DIMENSION: Stroke(0.25),
    Pen.HATCH: Stroke(0.18),
    Pen.SYMBOL: Stroke(0.25),
    Pen.FRAME: Stroke(0.7),
    Pen.GRID: Stroke(0.35),
    Pen.TABLE: Stroke(0.25),
    Pen.TEXT: Stroke(0.35),
    Pen.FINE_TEXT: Stroke(0.25),
}


STRETCH = 0.82
"""Width of the letters over that of the font: ISO 3098 has narrower ones."""

CAPITAL_HEIGHT = 1493 / 2048
"""Height of capital letters over the size of the font."""

_EM = 2048
_ELLIPSIS = "…"


class Reach(NamedTuple):
    """Reach of letters below and above their line, over their height."""

    below: float
    above: float


def font_file() -> Path:
    """Return the path of the font file, DejaVu Sans, which ships with the package."""
    return Path(__file__).with_name("DejaVuSans.ttf")


def has_glyph(letter: str) -> bool:
    """Return whether the font has this letter."""
    return ord(letter) in _glyph_names()


def text_width(text: str, height: float, stretch: float = STRETCH) -> float:
    """Return the length (mm) of a text whose capitals have this height (mm). A letter missing in the font counts as wide as it
    is high.
    """
    return sum(map(_advance, text)) * height / CAPITAL_HEIGHT * stretch


def reach(text: str) -> Reach:
    """Return the reach of a text below and above its line, over the height of its capitals."""
    extents = [_extent(letter) for letter in text if not letter.isspace()] or [(0.0, CAPITAL_HEIGHT)]
    return Reach(
        max(0.0, *(-low for low, _ in extents), 0.0) / CAPITAL_HEIGHT, max(high for _, high in extents) / CAPITAL_HEIGHT
    )


def fitted(text: str, height: float, room: float, stretch: float = STRETCH) -> tuple[str, bool]:
    """Return a text no longer than `room` (mm), shortened with an ellipsis if necessary, and whether it was shortened."""
    if text_width(text, height, stretch) <= room:
        return text, False
    for length in range(len(text) - 1, -1, -1):
        shorter = text[:length].rstrip() + _ELLIPSIS
        if text_width(shorter, height, stretch) <= room:
            return shorter, True
    return "", True


@cache
def _font() -> TTFont:
    from fontTools.ttLib import TTFont

    return TTFont(font_file(), lazy=True)


@cache
def _glyph_names() -> dict[int, str]:
    names: dict[int, str] = _font().getBestCmap()
    return names


@cache
def _advance(letter: str) -> float:
    """Return the width of a letter over the size of the font."""
    name = _glyph_names().get(ord(letter))
    return 1.0 if name is None else float(_font()["hmtx"][name][0] / _EM)


@cache
def _extent(letter: str) -> tuple[float, float]:
    """Return the least and the greatest height of a letter over the size of the font."""
    name = _glyph_names().get(ord(letter))
    if name is None:
        return -0.2, 0.85
    glyph = _font()["glyf"][name]
    return getattr(glyph, "yMin", 0) / _EM, getattr(glyph, "yMax", 0) / _EM


Point = tuple[float, float]
Segment = tuple[Point, Point]

Vertex = tuple[float, float, float]
"""x, y and bulge of the next piece: tan of a quarter of the arc's angle, positive counter-clockwise, 0 for a line."""

_CHORDS = 7.5
"""Degrees between the points of an arc from which its box and its segments are calculated."""


class Shape(ABC):
    """One drawn shape."""

    @abstractmethod
    def moved(self, across: float, up: float) -> Self:
        """Return the shape moved to the right and up (mm)."""

    @property
    @abstractmethod
    def box(self) -> Box:
        """The smallest box that holds the shape."""

    @property
    def segments(self) -> list[Segment]:
        """The lines that no text may cross; chords for an arc."""
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
        """Return a polyline without arcs."""
        return cls(tuple((x, y, 0.0) for x, y in points), pen, closed)

    def moved(self, across: float, up: float) -> Self:
        return replace(self, vertices=tuple((x + across, y + up, bulge) for x, y, bulge in self.vertices))

    @property
    def points(self) -> list[Point]:
        """The points along the polyline, so many on arcs that chords can replace them."""
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
    """An arc from `start` counter-clockwise to `end` (degrees)."""

    centre: Point
    radius: float
    start: float
    end: float
    pen: Pen = Pen.OUTLINE

    def moved(self, across: float, up: float) -> Self:
        return replace(self, centre=_shift(self.centre, across, up))

    @property
    def points(self) -> list[Point]:
        """The points along the arc."""
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
    """The point of a text that is at its place: left, centre or right; on its line, or at half the height of its capitals."""

    LEFT = "LEFT"
    CENTRE = "CENTER"
    RIGHT = "RIGHT"
    MIDDLE_LEFT = "MIDDLE_LEFT"
    MIDDLE = "MIDDLE_CENTER"
    MIDDLE_RIGHT = "MIDDLE_RIGHT"

    @property
    def along(self) -> float:
        """Share of the text's length that is before its place."""
        return {"LEFT": 0.0, "RIGHT": 1.0}.get(self.value.removeprefix("MIDDLE_"), 0.5)

    @property
    def up(self) -> float:
        """Share of the height of capitals that is below its place."""
        return 0.5 if self.value.startswith("MIDDLE") else 0.0


@dataclass(frozen=True)
class Text(Shape):
    """A line of text; `height` is the height of its capitals, `rotation` 0, or 90 to be read from the right."""

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
        """Length of the text (mm)."""
        return text_width(self.words, self.height, self.stretch)

    @property
    def start(self) -> Point:
        """Starting point of the text's line."""
        along, up = -self.anchor.along * self.width, -self.anchor.up * self.height
        return self._turned(along, up)

    @cached_property
    def box(self) -> Box:
        below, above = reach(self.words)
        along, up = -self.anchor.along * self.width, -self.anchor.up * self.height
        corners = ((along, up - below * self.height), (along + self.width, up + above * self.height))
        return Box.around(self._turned(*corner) for corner in corners)

    def _turned(self, along: float, up: float) -> Point:
        cosine, sine = math.cos(math.radians(self.rotation)), math.sin(math.radians(self.rotation))
        return self.at[0] + along * cosine - up * sine, self.at[1] + along * sine + up * cosine


def _round(centre: Point, radius: float, start: float, end: float) -> list[Point]:
    """Return points on an arc from `start` to `end` (degrees), among them those furthest up, down, left and right."""
    low, high = sorted((start, end))
    between = (_CHORDS * step for step in range(math.floor(low / _CHORDS) + 1, math.ceil(high / _CHORDS)))
    angles = sorted((low, *between, high), reverse=end < start)
    turns = map(math.radians, angles)
    return [(centre[0] + radius * math.cos(each), centre[1] + radius * math.sin(each)) for each in turns]


def _along(start: Vertex, end: Vertex) -> list[Point]:
    """Return the points from one vertex to the next, without the first."""
    (x, y, bulge), finish = start, end[:2]
    if not bulge:
        return [finish]
    across, up = finish[0] - x, finish[1] - y
    towards = (1 - bulge**2) / (4 * bulge)  # the centre is so many chords to the left of the chord's middle
    centre = ((x + finish[0]) / 2 - towards * up, (y + finish[1]) / 2 + towards * across)
    radius = math.hypot(x - centre[0], y - centre[1])
    begin = math.degrees(math.atan2(y - centre[1], x - centre[0]))
    return [*_round(centre, radius, begin, begin + math.degrees(4 * math.atan(bulge)))[1:-1], finish]


@dataclass(frozen=True)
class Figure:
    """A group of shapes."""

    shapes: tuple[Shape, ...] = ()

    @classmethod
    def of(cls, *parts: Shape | Figure) -> Figure:
        """Return shapes and figures as one figure."""
        return cls(tuple(shape for part in parts for shape in (part.shapes if isinstance(part, Figure) else (part,))))

    def __add__(self, other: Figure) -> Figure:
        return Figure(self.shapes + other.shapes)

    def moved(self, across: float, up: float) -> Figure:
        """Return the figure moved to the right and up (mm)."""
        return Figure(tuple(shape.moved(across, up) for shape in self.shapes))

    @cached_property
    def box(self) -> Box:
        """The smallest box that holds the figure. Raises ValueError for an empty one."""
        return Box.of_all(shape.box for shape in self.shapes)

    @property
    def segments(self) -> list[Segment]:
        """The lines of the figure that no text may cross."""
        return [segment for shape in self.shapes for segment in shape.segments]

    @property
    def texts(self) -> list[Text]:
        """The texts of the figure, including those of its dimensions."""
        return [text for shape in self.shapes for text in _texts_of(shape)]


def _texts_of(shape: Shape) -> Iterable[Text]:
    """Return a text, or the texts among the parts of a compound shape."""
    if isinstance(shape, Text):
        return (shape,)
    return (each for each in getattr(shape, "parts", ()) if isinstance(each, Text))


class MeasuredDistance(Enum):
    """The distance of two points that a dimension gives."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"


@dataclass(frozen=True)
class Dimension(Shape):
    """A dimension; its `parts` are its visible lines, arrows and texts.

    A CAD program that redraws it uses the measured points `first` and `second`, and a point `line` of the dimension line.
    `words` is the text of a CAD dimension ("%%c40 H7 {\\S+0.025^0;}"); "<>" stands for the measured value. `scale` is mm of
    paper for a mm of the part, None for the scale of the sheet: details have their own.
    """

    measured: MeasuredDistance
    first: Point
    second: Point
    line: Point
    words: str
    parts: tuple[Shape, ...]
    scale: float | None = None

    def moved(self, across: float, up: float) -> Self:
        first, second, line = ((x + across, y + up) for x, y in (self.first, self.second, self.line))
        return replace(self, first=first, second=second, line=line, parts=tuple(each.moved(across, up) for each in self.parts))

    @property
    def box(self) -> Box:
        return Box.of_all(part.box for part in self.parts)

    @property
    def segments(self) -> list[Segment]:
        return [segment for part in self.parts for segment in part.segments]
