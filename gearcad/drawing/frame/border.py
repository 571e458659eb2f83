"""The border of a sheet by ISO 5457: frame, centring marks, and the strip that tells its fields. Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from gearcad.drawing.frame.sizes import FrameSizes
from gearcad.drawing.options import SheetSize
from gearcad.drawing.shapes import Anchor, Box, Figure, Line, Pen, Point, Polyline, Shape, Text

__all__ = ["border", "free_area", "inside_frame"]

_AIR = 6.0
"""Least distance of views from the frame, where centring marks reach."""

_LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""I and O are no fields: they look like numbers."""

_LEAST_FIELD = 15.0
"""A shorter rest at the corners is added to the field beside it."""


def inside_frame(size: SheetSize, sizes: FrameSizes) -> Box:
    """What the frame encloses; the paper's lower left corner is (0, 0)."""
    width, height = size.size
    return Box(sizes.binding_margin, sizes.margin, width - sizes.margin, height - sizes.margin)


def free_area(size: SheetSize, sizes: FrameSizes) -> Box:
    """Where views may stand: inside the frame, and off its centring marks; on A4 as close to these as can be."""
    return inside_frame(size, sizes).grown(-sizes.centring if size is SheetSize.A4 else -_AIR)


def border(size: SheetSize, sizes: FrameSizes, taken: Iterable[Box] = ()) -> Figure:
    """Edge of the paper, frame, centring marks, and fields: letters down the sides, numbers along top and bottom.

    Marks do not reach into areas that are `taken`. A4 has its fields at the top and at the right only.
    """
    paper, frame = Box(0.0, 0.0, *size.size), inside_frame(size, sizes)
    strip = frame.grown(sizes.grid_width)
    shapes: list[Shape] = [_rectangle(paper, Pen.TABLE), _rectangle(frame, Pen.FRAME)]
    shapes += _centring(paper, frame, strip, sizes.centring, tuple(taken))
    if sizes.grid_width:
        shapes.append(_rectangle(strip, Pen.GRID))
        shapes += _fields(paper, frame, strip, sizes, every_side=size is not SheetSize.A4)
    return Figure(tuple(shapes))


def _rectangle(box: Box, pen: Pen) -> Polyline:
    corners = [(box.left, box.bottom), (box.right, box.bottom), (box.right, box.top), (box.left, box.top)]
    return Polyline.straight(corners, pen, closed=True)


def _centring(paper: Box, frame: Box, strip: Box, into: float, taken: tuple[Box, ...]) -> Iterator[Line]:
    """From the outer edge of the strip over the frame, and into it where nothing stands."""
    across, up = paper.middle
    ends: tuple[tuple[Point, Point, Point], ...] = (
        ((across, strip.bottom), (across, frame.bottom), (across, frame.bottom + into)),
        ((across, strip.top), (across, frame.top), (across, frame.top - into)),
        ((strip.left, up), (frame.left, up), (frame.left + into, up)),
        ((strip.right, up), (frame.right, up), (frame.right - into, up)),
    )
    for outer, edge, inner in ends:
        free = not any(Box.around((edge, inner)).grown(0.1).meets(each) for each in taken)
        yield Line(outer, inner if free else edge, Pen.FRAME)


def _fields(paper: Box, frame: Box, strip: Box, sizes: FrameSizes, *, every_side: bool) -> Iterator[Shape]:
    """Lines between fields, and their names, on two opposite sides each; the middle of the sheet is between fields."""
    middle = paper.middle
    for along in (0, 1):
        places = _divisions(frame[along], frame[along + 2], middle[along], sizes.grid_pitch)
        other = 1 - along
        names = _names(len(places) - 1, letters=along == 1)
        for near, far in ((frame[other], strip[other]), (frame[other + 2], strip[other + 2])):
            if not every_side and near == frame[other]:
                continue
            for place in places[1:-1]:
                if abs(place - middle[along]) > sizes.grid_pitch / 2:
                    yield Line(_point(along, place, near), _point(along, place, far), Pen.GRID)
            for name, (low, high) in zip(names, pairwise(places), strict=True):
                at = _point(along, (low + high) / 2, (near + far) / 2)
                yield Text(name, at, sizes.grid_text, Anchor.MIDDLE, pen=Pen.FINE_TEXT)


def _point(along: int, place: float, across: float) -> Point:
    return (place, across) if along == 0 else (across, place)


def _divisions(low: float, high: float, middle: float, pitch: float) -> list[float]:
    """The ends of fields of one pitch from the middle on; those at the corners have what is left."""
    below, above = int((middle - low) / pitch), int((high - middle) / pitch)
    inner = [middle + step * pitch for step in range(-below, above + 1)]
    if inner[0] - low < _LEAST_FIELD and len(inner) > 1:
        inner = inner[1:]
    if high - inner[-1] < _LEAST_FIELD and len(inner) > 1:
        inner = inner[:-1]
    return [low, *inner, high]


def _names(count: int, *, letters: bool) -> list[str]:
    """Of fields from left to right, or from the bottom up; letters begin at the top, with AA behind Z."""
    if not letters:
        return [str(number + 1) for number in range(count)]
    full = len(_LETTERS)
    return [_LETTERS[number % full] * (1 + number // full) for number in reversed(range(count))]
