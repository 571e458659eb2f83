"""The section of a ring through its axis: both sides cut, the teeth behind seen as a cylinder (ISO 2203, ISO 128-3).

It is a full one: of a half that is seen from outside one would learn nothing.
"""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.marks import freehand
from gearcad.drawing.ring_views.hand import flank_directions
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.shapes import Box, Figure, Hatching, Line, Pen, Point, Polyline, Shape

__all__ = ["BEYOND_AXIS", "full_section"]

BEYOND_AXIS, _BEYOND_PITCH, _BEYOND_HOLE = 6.0, 3.0, 2.0
"""How far the axis, the reference line and that of a hole reach beyond what they belong to (mm of paper)."""

_HATCH, _FINEST_HATCH, _STROKES = 2.5, 0.7, 4
"""Distance of hatching lines, the least of it, and how many lines a narrow part should have at least."""


def full_section(ring: Meridian) -> Figure:
    """Outlines, with hatching and axis; teeth are not hatched, bolt holes are turned into the plane of the section."""
    width = ring.gear.face_width
    shapes: list[Shape] = []
    for side in (1, -1):
        shapes += [*_hatching(ring, side), *_outline(ring, side), *_lines(ring, side)]
    shapes += [Line(ring.point(height, -radius), ring.point(height, radius)) for height, radius in ring.edges]
    shapes.append(_centre(ring, 0.0, width, 0.0, BEYOND_AXIS))
    return Figure(tuple(shapes)) + flank_directions(ring)


def _outline(ring: Meridian, side: int) -> Iterator[Shape]:
    width = ring.gear.face_width
    points = ring.points([(0.0, ring.rim), *ring.along_teeth(ring.tip), (width, ring.rim)], side)
    yield Polyline.straight(points, closed=not ring.is_open)
    if ring.is_open:
        yield freehand([points[-1], points[0]])


def _lines(ring: Meridian, side: int) -> Iterator[Shape]:
    """Roots, bolt holes, centre lines."""
    width = ring.gear.face_width
    back = float(ring.cone.setback(ring.root))  # a chamfer may be deeper than the teeth
    yield Line(ring.point(back, side * ring.root), ring.point(width - back, side * ring.root))
    yield _centre(ring, 0.0, width, side * ring.reference, _BEYOND_PITCH)
    if ring.holes is not None:
        for radius in ring.holes:
            yield Line(ring.point(0.0, side * radius), ring.point(width, side * radius))
        yield _centre(ring, 0.0, width, side * sum(ring.holes) / 2, _BEYOND_HOLE)


def _centre(ring: Meridian, low: float, high: float, radius: float, beyond: float) -> Line:
    (left, y), (right, _) = sorted((ring.point(low, radius), ring.point(high, radius)))
    return Line((left - beyond, y), (right + beyond, y), Pen.CENTRE)


def _hatching(ring: Meridian, side: int) -> Iterator[Hatching]:
    """The cut faces outside the roots, apart where a hole is between them; lines are closer where they are narrow."""
    width = ring.gear.face_width
    outer = [(0.0, ring.rim), (width, ring.rim)]
    areas = [[*ring.along_teeth(ring.root), *reversed(outer)]]
    if ring.holes is not None:
        below, above = ring.holes
        areas = [
            [*ring.along_teeth(ring.root), (width, below), (0.0, below)],
            [(0.0, above), (width, above), *reversed(outer)],
        ]
    edges = [ring.points(area, side) for area in areas]
    spacing = min(_spacing(edge) for edge in edges)
    for edge in edges:
        yield Hatching((tuple((x, y, 0.0) for x, y in edge),), spacing=spacing)


def _spacing(edge: list[Point]) -> float:
    box = Box.around(edge)
    return min(_HATCH, max(_FINEST_HATCH, min(box.width, box.height) / _STROKES))
