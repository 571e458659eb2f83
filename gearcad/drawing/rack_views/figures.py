"""Front view, end section and view from above of a rack (ISO 2203). Lengths in mm of paper, of the part where it is said."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.drawing.marks import centre_line, view_label, zigzag
from gearcad.drawing.rack_views.span import Span
from gearcad.drawing.rack_views.teeth import teeth_between
from gearcad.drawing.shapes import Figure, Hatching, Line, Pen, Point, Polyline, Shape, Vertex
from gearcad.geometry import Rack

__all__ = ["SECTION", "end_figure", "front_figure", "plan_figure", "tooth_middles"]

_BEYOND_PITCH, _BEYOND_BREAK = 3.0, 2.0
"""How far the reference line, and lines where a view is broken, reach beyond the outline."""

SECTION = "B"
"""The letter of the end section: A is the datum."""

_LABEL = 6.0
"""From the outline to the name of the section."""

_HATCH, _FINEST_HATCH, _STROKES = 2.5, 0.7, 4
"""Distance of hatching lines, the least of it, and how many lines a narrow part should have at least."""

_SPACING, _LONGEST, _SHARE = 3.0, 24.0, 0.7
"""Of the lines for the direction of the teeth: their distance, greatest length, and the most of the face width they take."""


# ---------------------------------------------------------------------- front


def front_figure(span: Span) -> Figure:
    """Teeth at both ends, between them the line of the tips, and a thin one of the roots; the reference line at height 0."""
    rack, scale = span.rack, span.scale
    tip, root, back = scale * rack.tip_height, -scale * rack.root_depth, -scale * rack.height
    middles = [(x, 0.0) for x in tooth_middles(span)]
    pitch = centre_line((-span.right - _BEYOND_PITCH, 0.0), *middles, (span.right + _BEYOND_PITCH, 0.0))
    shapes: list[Shape] = [*pitch.shapes]
    for low, high in span.toothed:
        outline = teeth_between(rack, low, high, span.first_middle)
        shapes.append(_placed(span, outline, back))
    for start, end in _between(span):
        shapes += [Line((start, tip), (end, tip)), Line((start, root), (end, root), Pen.THIN)]
    for low, high in span.parts:
        shapes.append(Line((span.across(low), back), (span.across(high), back)))
    shapes += _breaks(span, back, tip)
    for x, _ in middles:
        shapes += centre_line((x, root - _BEYOND_BREAK), (x, 0.0), (x, tip + _BEYOND_BREAK)).shapes
    return Figure(tuple(shapes))


def tooth_middles(span: Span) -> list[float]:
    """Of the first two whole teeth, on paper."""
    pitch = span.rack.transverse_pitch
    return [span.across(span.first_middle + number * pitch) for number in range(min(span.whole_teeth, 2))]


def _placed(span: Span, outline: tuple[Vertex, ...], back: float) -> Polyline:
    """On paper, with the end face where it begins or ends at one."""
    place = span.across(outline[0][0]) - span.scale * outline[0][0]
    row: list[Vertex] = [(span.scale * x + place, span.scale * y, bulge) for x, y, bulge in outline]
    if outline[0][0] <= 0.0:
        row.insert(0, (row[0][0], back, 0.0))
    if outline[-1][0] >= span.rack.length:
        row.append((row[-1][0], back, 0.0))
    return Polyline(tuple(row))


def _between(span: Span) -> Iterator[tuple[float, float]]:
    """From where to where on paper no teeth are drawn, of each part that is shown."""
    if len(span.toothed) == 1:
        return
    (_, low), (high, _) = span.toothed
    for start, end in span.parts:
        yield span.across(max(start, low)), span.across(min(end, high))


def _breaks(span: Span, low: float, high: float) -> Iterator[Shape]:
    """Lines with zigzags where the rack is broken."""
    if span.kept is not None:
        for place in (span.kept, span.rack.length - span.kept):
            x = span.across(place)
            yield zigzag((x, low - _BEYOND_BREAK), (x, high + _BEYOND_BREAK))


# ---------------------------------------------------------------------- end


def end_figure(rack: Rack, scale: float) -> Figure:
    """The section square to the length, as one looks along +x; teeth are not hatched, their root is a thick line."""
    half, tip, root, back = (scale * each for each in (rack.face_width / 2, rack.tip_height, -rack.root_depth, -rack.height))
    body: list[Point] = [(-half, back), (half, back), (half, root), (-half, root)]
    spacing = min(_HATCH, max(_FINEST_HATCH, min(2 * half, root - back) / _STROKES))
    shapes: tuple[Shape, ...] = (
        Hatching((tuple((x, y, 0.0) for x, y in body),), spacing=spacing),
        Polyline.straight([(-half, back), (half, back), (half, tip), (-half, tip)], closed=True),
        Line((-half, root), (half, root)),
        Line((-half - _BEYOND_PITCH, 0.0), (half + _BEYOND_PITCH, 0.0), Pen.CENTRE),
    )
    return Figure(shapes) + view_label(f"{SECTION}–{SECTION}", (0.0, tip + _LABEL))


# ---------------------------------------------------------------------- from above


def plan_figure(span: Span) -> Figure:
    """The rectangle of length and face width, z downwards, and three thin lines for the direction of helical teeth."""
    half = span.scale * span.rack.face_width / 2
    shapes: list[Shape] = []
    for low, high in span.parts:
        left, right = span.across(low), span.across(high)
        sides = [*([left] if low <= 0.0 else []), *([right] if high >= span.rack.length else [])]
        shapes += [Line((left, side * half), (right, side * half)) for side in (1, -1)]
        shapes += [Line((x, -half), (x, half)) for x in sides]
    shapes += _breaks(span, -half, half)
    shapes += _tooth_directions(span)
    return Figure(tuple(shapes))


def _tooth_directions(span: Span) -> Iterator[Shape]:
    """In the middle of the first part; a tooth moves by `drift` along +x where z, downwards, grows by 1."""
    rack = span.rack
    if not rack.helix_angle:
        return
    low, high = span.parts[0]
    room = span.scale * (high - low)
    middle, spacing = span.across((low + high) / 2), min(_SPACING, room / 8)
    steep = abs(math.cos(math.radians(rack.helix_angle)))
    length = min(_LONGEST * steep, _SHARE * span.scale * rack.face_width, room / 2 / max(abs(rack.drift), 1e-9))
    for step in (-1, 0, 1):
        x = middle + step * spacing / steep
        aside = rack.drift * length / 2
        yield Line((x - aside, length / 2), (x + aside, -length / 2), Pen.THIN)
