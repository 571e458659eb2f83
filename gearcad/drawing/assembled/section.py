"""Sections of assemblies: bodies cut by one plane, each hatched its own way, and what hides what (ISO 128-3, ISO 2203)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

from gearcad.drawing.assembled.cut import Cut
from gearcad.drawing.assembled.hiding import Polygon, Segment, Where, pieces, visible
from gearcad.drawing.marks import freehand
from gearcad.drawing.shapes import Box, Figure, Hatching, Line, Pen, Point, Polyline, Shape

__all__ = ["Across", "Sectioned", "section_figure"]

_FINEST, _STROKES = 0.9, 4
"""Least distance of hatching lines (mm of paper), and how many a narrow area should have at least."""

BEYOND_PITCH = 3.0
"""How far pitch lines reach beyond the teeth (mm of paper)."""


@dataclass(frozen=True)
class Across:
    """From the plane of a section (mm: z along the axes, height across them) to paper, `middle` and height 0 at the origin.

    `direction` is 1 where z goes to the right, -1 to the left.
    """

    scale: float
    middle: float = 0.0
    direction: int = 1

    def point(self, point: Point) -> Point:
        return self.direction * self.scale * (point[0] - self.middle), self.scale * point[1]

    def points(self, points: Iterable[Point]) -> list[Point]:
        return [self.point(each) for each in points]


@dataclass(frozen=True)
class Sectioned:
    """A body as a section shows it: what is cut of it, hatched at an angle (degrees; None leaves a pin or a shaft blank).

    `pitch` are lines (z to z at a height) where pitch surfaces are cut. Hatching lines are `spacing` (mm of paper) apart.
    """

    cut: Cut
    angle: float | None = 45.0
    pitch: tuple[Segment, ...] = ()
    spacing: float = 2.5


def pitch_lines(low: float, high: float, height: float, radius: float) -> tuple[Segment, ...]:
    """Where a pitch cylinder about an axis at a height is cut, from one z to another."""
    return tuple(((low, height + side * radius), (high, height + side * radius)) for side in (1, -1))


def section_figure(bodies: Sequence[Sectioned], across: Across) -> Figure:
    """Bodies in order: the teeth of one are in front of those of all that follow, whose hidden parts are dashed."""
    shapes: list[Shape] = []
    for number, body in enumerate(bodies):
        shapes += (shape for area in body.cut.areas for shape in _outlined(area, body.cut.broken, across))
        if body.angle is not None:
            shapes += (_hatched(area, body.angle, body.spacing, across) for area in body.cut.areas)
        others = [cover for other in bodies if other is not body for cover in other.cut.covers]
        before = [tooth for other in bodies[:number] for tooth in other.cut.teeth]
        shapes += _teeth(body.cut, before, across)
        shapes += (_line(each, across) for each in visible(body.cut.edges, others))
        shapes += (_line(each, across, Pen.CENTRE, BEYOND_PITCH) for each in body.cut.axes)
    shapes += (_line(each, across, Pen.CENTRE, BEYOND_PITCH) for each in _joined(chain.from_iterable(b.pitch for b in bodies)))
    return Figure(tuple(shapes))


def _outlined(area: Polygon, broken: Sequence[Segment], across: Across) -> Iterator[Polyline]:
    """One closed line; where a part is broken off the line is open, and a freehand one closes it."""
    points, broken_off = across.points(area), {frozenset(each) for each in broken}
    row = [number for number, end in enumerate(area) if frozenset((area[number - 1], end)) in broken_off]
    if not row:
        yield Polyline.straight(points, closed=True)
        return
    around = points[row[0] :] + points[: row[0]]
    yield Polyline.straight(around)
    yield freehand([around[-1], around[0]])


def _hatched(area: Polygon, angle: float, spacing: float, across: Across) -> Hatching:
    """Its lines are closer where it is narrow."""
    points = across.points(area)
    box = Box.around(points)
    closer = min(spacing, max(_FINEST, min(box.width, box.height) / _STROKES))
    return Hatching((tuple((x, y, 0.0) for x, y in points),), angle, closer)


def _line(segment: Segment, across: Across, pen: Pen = Pen.OUTLINE, beyond: float = 0.0) -> Line:
    (x, y), (right, top) = sorted(across.points(segment))
    return Line((x - beyond, y), (right + beyond, top), pen)


def _teeth(cut: Cut, before: Sequence[Polygon], across: Across) -> Iterator[Shape]:
    """Outlines of teeth but for the root lines, which the areas have; dashed where other teeth are before them."""
    for tooth in cut.teeth:
        shown: list[Segment] = []
        for segment in pairwise(tooth):
            for piece, where in pieces(segment, before):
                if where is Where.OUTSIDE:
                    shown.append(piece)
                elif where is Where.INSIDE:
                    yield _line(piece, across, Pen.HIDDEN)
        yield from (Polyline.straight(across.points(chained)) for chained in _chained(shown))


def _chained(segments: Iterable[Segment]) -> list[list[Point]]:
    """Segments that follow each other as rows of points."""
    rows: list[list[Point]] = []
    for start, end in segments:
        if rows and rows[-1][-1] == start:
            rows[-1].append(end)
        else:
            rows.append([start, end])
    return rows


_SAME = 1e-6
"""Heights (mm) that are one line: the pitch lines of gears in mesh touch."""


def _joined(lines: Iterable[Segment]) -> list[Segment]:
    """Level lines at one height that meet, as one."""
    found: list[Segment] = []
    for line in lines:
        (low, height), (high, _) = sorted(line)
        for other in [each for each in found if abs(each[0][1] - height) <= _SAME]:
            (from_z, _), (to_z, _) = other
            if from_z <= high and low <= to_z:
                low, high = min(low, from_z), max(high, to_z)
                found.remove(other)
        found.append(((low, height), (high, height)))
    return found
