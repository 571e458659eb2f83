"""The half section of an external gear: cut above its axis, seen from outside below it (ISO 2203, ISO 128-3)."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.drawing.gear_views.along import Along
from gearcad.drawing.gear_views.hand import flank_directions
from gearcad.drawing.gear_views.meridian import contour, edges, opening_radius, overall, root_lines
from gearcad.drawing.shapes import Figure, Hatching, Line, Pen, Polyline, Shape, Vertex
from gearcad.geometry import Gear
from gearcad.solids.cone import EndCone

__all__ = ["BEYOND_AXIS", "BEYOND_PITCH", "chamfer_pen", "half_section"]

BEYOND_AXIS, BEYOND_PITCH = 6.0, 3.0
"""How far the axis and the reference line reach beyond what they belong to (mm of paper)."""

_THICK_APART, _LEAST_APART = 1.0, 0.4
"""Edges of chamfers nearer to others are thin, so that they do not run into them; or are left out (mm of paper; ISO 128-2)."""

_HATCH, _FINEST_HATCH, _STROKES = 2.5, 0.7, 4
"""Distance of hatching lines, the least of it, and how many lines a narrow part should have at least."""


def half_section(gear: Gear, along: Along) -> Figure:
    """Outlines, with hatching and axis: the silhouette as one closed line, teeth not hatched, no root line outside."""
    tip, low, high = gear.tip_diameter / 2, *overall(gear)
    upper = contour(gear, tip, 0.0)[1:-1]
    silhouette = Polyline.straight(
        [*along.points(upper), *along.points((z, -radius) for z, radius in reversed(upper))], closed=True
    )
    pitch = gear.reference_diameter / 2
    pitch_lines = [((0.0, up), (gear.face_width, up)) for up in (pitch, -pitch)]
    shapes: list[Shape] = [
        hatching(gear, along),
        silhouette,
        *cut_lines(gear, along),
        *_seen_edges(gear, along),
        *(along.line(*ends, Pen.CENTRE, beyond=BEYOND_PITCH) for ends in pitch_lines),
        along.line((low, 0.0), (high, 0.0), Pen.CENTRE, beyond=BEYOND_AXIS),
    ]
    return Figure(tuple(shapes)) + flank_directions(gear, along)


def chamfer_pen(apart: float) -> Pen | None:
    """Return the pen for an edge of a chamfer that is so far (mm of paper) from the next edge; None if it is left out."""
    if apart < _LEAST_APART:
        return None
    return Pen.OUTLINE if apart >= _THICK_APART else Pen.THIN


def _seen_edges(gear: Gear, along: Along) -> Iterator[Line]:
    """Yield the edges of end faces, grooves and chamfers in the half that is seen from outside."""
    tip = gear.tip_diameter / 2
    back = along.scale * float(EndCone.of(gear).setback(tip))
    for z, radius in edges(gear):
        pen = chamfer_pen(back) if back and radius == tip else Pen.OUTLINE
        if pen is not None:
            yield along.line((z, -radius), (z, 0.0), pen)


def cut_lines(gear: Gear, along: Along) -> Iterator[Line]:
    """What one sees of the half that is cut, within its silhouette: roots, bore, keyway."""
    low, high = overall(gear)
    for start, end in root_lines(gear):
        yield along.line((start, gear.root_diameter / 2), (end, gear.root_diameter / 2))
    radii = [opening_radius(gear)] if gear.body.bore else []
    if gear.body.keyway_width:
        radii.append(math.sqrt((gear.body.bore / 2) ** 2 - (gear.body.keyway_width / 2) ** 2))
    for radius in radii:
        yield along.line((low, radius), (high, radius))


def hatching(gear: Gear, along: Along) -> Hatching:
    """The cut face, which ends at the root circle; its lines are closer where it is narrow."""
    corners = contour(gear, gear.root_diameter / 2, opening_radius(gear))
    edge: tuple[Vertex, ...] = tuple((x, y, 0.0) for x, y in along.points(corners))
    box = Polyline(edge, closed=True).box
    spacing = min(_HATCH, max(_FINEST_HATCH, min(box.width, box.height) / _STROKES))
    return Hatching((edge,), spacing=spacing)
