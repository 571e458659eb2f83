"""Half section and front view of an external gear, without dimensions (ISO 2203, ISO 128-3). Lengths in mm.

ISO 2203 shows a gear as a solid body without teeth, up to the tip circle, or to the root circle where it is cut. Heights z are
along the axis.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from gearcad.drawing.drawing_symbols import centre_cross
from gearcad.drawing.shapes import Circle, Figure, Hatching, Line, Pen, Point, Polyline, Shape, Vertex
from gearcad.geometry import Gear
from gearcad.geometry.bore_teeth import bore_teeth, free_bore
from gearcad.geometry.gear_data import section_turn
from gearcad.solids.body_plan import EndCone, keyway_half_angle

Corner = tuple[float, float]
"""Height z (mm) and radius (mm) of a corner of the section."""


def overall(gear: Gear) -> tuple[float, float]:
    """Return the heights (mm) of the outermost end faces, those of hubs if there are any."""
    back, front = gear.body.hub_ends
    return -back, gear.face_width + front


def strips(gear: Gear) -> tuple[tuple[float, float], ...]:
    """Return the ranges of height (mm) that have teeth: one, also with an apex. A gap between the halves of a double helical
    gear gives two.
    """
    width, half = gear.face_width, gear.half_width
    return ((0.0, half), (width - half, width)) if gear.double_helix.gap_width else ((0.0, width),)


def opening_radius(gear: Gear) -> float:
    """Return the radius (mm) to which bore and keyway open the half plane of the keyway; 0 without a bore."""
    return gear.body.bore / 2 + (gear.body.keyway_depth if gear.body.keyway_width else 0.0)


def contour(gear: Gear, top: float, inner: float) -> list[Corner]:
    """Return corners from radius `inner` up the lower end face, along the teeth at radius `top`, and down the upper end face
    to `inner`.
    """
    low, high = overall(gear)
    hub, width = gear.body.hub_diameter / 2, gear.face_width
    back = [(low, inner), (low, hub), (0.0, hub)] if low < 0 else [(0.0, inner)]
    front = [(width, hub), (high, hub), (high, inner)] if high > width else [(width, inner)]
    return [*back, *_along_teeth(gear, top), *front]


def _along_teeth(gear: Gear, top: float) -> Iterator[Corner]:
    """Yield the corners along the teeth, and along the groove between two strips of them."""
    floor, before = gear.gap_diameter / 2, None
    for low, high in strips(gear):
        if before is not None:
            yield from ((before, floor), (low, floor))
        yield from along_strip(gear, low, high, top)
        before = high


def along_strip(gear: Gear, low: float, high: float, top: float) -> list[Corner]:
    """Return the corners along the teeth at radius `top` from `low` to `high`, one of their `strips`, with end chamfers."""
    cone = EndCone.of(gear)
    back = float(cone.setback(top))
    flat = [(low + back, top), (high - back, top)]
    return [(low, cone.face_radius), *flat, (high, cone.face_radius)] if back else flat


def root_lines(gear: Gear) -> list[tuple[float, float]]:
    """Return the ranges of height (mm) in which a section shows the roots of teeth. A chamfer deeper than the teeth shortens
    them.
    """
    back = float(EndCone.of(gear).setback(gear.root_diameter / 2))
    return [(low + back, high - back) for low, high in strips(gear)]


def edges(gear: Gear) -> list[Corner]:
    """Return the edges round the axis between the outermost end faces, as seen from outside: height, and largest radius
    there.
    """
    corners = contour(gear, gear.tip_diameter / 2, 0.0)
    largest = {z: max(radius for each, radius in corners if each == z) for z in sorted({z for z, _ in corners})}
    return list(largest.items())[1:-1]


@dataclass(frozen=True)
class Along:
    """A horizontal axis at height 0 of the paper; the height `middle` of the gear is at the origin.

    `direction` is 1 where the gear's z goes to the right, -1 to the left. The keyway, on the gear's +x, is above the axis: the
    view is from +y where z goes to the right, else from -y.
    """

    scale: float
    middle: float
    direction: int = 1

    @classmethod
    def of(cls, gear: Gear, scale: float, direction: int = 1) -> Self:
        """Return the axis with the middle between the outermost end faces at the origin."""
        return cls(scale, sum(overall(gear)) / 2, direction)

    def across(self, height: float) -> float:
        """Return the position on paper (mm), to the right of the origin, of a height along the axis."""
        return self.direction * self.scale * (height - self.middle)

    def point(self, height: float, radius: float) -> Point:
        """Return the point on paper above the axis; below it if `radius` is negative."""
        return self.across(height), self.scale * radius

    def points(self, corners: Iterable[Corner]) -> list[Point]:
        return [self.point(*corner) for corner in corners]

    def line(self, start: Corner, end: Corner, pen: Pen = Pen.OUTLINE, *, beyond: float = 0.0) -> Line:
        """Return a line between two corners, extended by `beyond` (mm of paper) at both ends, along the axis."""
        (x, y), (right, top) = sorted((self.point(*start), self.point(*end)))
        return Line((x - beyond, y), (right + beyond, top), pen)


@dataclass(frozen=True)
class Silhouette:
    """The outline of a gear, placed by `along`."""

    gear: Gear
    along: Along

    @property
    def tip(self) -> float:
        """Radius of the tips (mm of the part)."""
        return self.gear.tip_diameter / 2

    @property
    def corner(self) -> float:
        """Radius of the outermost corner of the teeth's end faces (mm of the part): less than that of the tips by a chamfer."""
        return min(self.tip, EndCone.of(self.gear).face_radius)

    @property
    def ends(self) -> tuple[float, float]:
        """Heights of the outermost end faces at the left and at the right (mm of the part)."""
        low, high = overall(self.gear)
        return (low, high) if self.along.direction > 0 else (high, low)

    @property
    def tooth_ends(self) -> tuple[float, float]:
        """Heights of the teeth's end faces at the left and at the right (mm of the part)."""
        width = self.gear.face_width
        return (0.0, width) if self.along.direction > 0 else (width, 0.0)

    @property
    def left(self) -> float:
        return self.along.across(self.ends[0])

    @property
    def right(self) -> float:
        return self.along.across(self.ends[1])

    @property
    def top(self) -> float:
        """Height of the highest point above the axis (mm of paper); the lowest is as far below it."""
        return self.along.scale * self.tip

    def end_face(self, height: float) -> tuple[Point, Point]:
        """Return the ends of the body's flat face at one of the `ends`, above the axis, from the opening outwards."""
        body = self.gear.body
        on_hub = not 0.0 <= height <= self.gear.face_width
        outer = body.hub_diameter / 2 if on_hub else min(self.corner, self.gear.root_diameter / 2)
        return self.along.point(height, opening_radius(self.gear)), self.along.point(height, outer)


_SPACING = 3.0
_LONGEST = 24.0
"""Distance between the lines, and length of one, mm of paper; less where there is no room."""

_NEAREST, _FURTHEST = 0.1, 0.9
"""Range of the lines below the axis, over the reference radius."""

_SHARE = 0.7
"""Largest share of the lines in the width of the teeth of one hand."""


def flank_directions(gear: Gear, along: Along) -> Figure:
    """Return the lines of a helical gear's tooth direction, three V for a double helical gear; empty for a spur gear.

    A tooth on the visible side passes the height of the axis at mid face width. Its rise there on paper is the turn of its
    section about the axis, times the radius.
    """
    if not gear.helix_angle:
        return Figure()
    radius = gear.reference_diameter / 2
    room = (_FURTHEST - _NEAREST) * radius * along.scale
    tangent, cosine = (function(math.radians(abs(gear.helix_angle))) for function in (math.tan, math.cos))
    spacing = min(_SPACING / cosine, room / 5)
    longest = min(_LONGEST * cosine, (room - 2 * spacing) / tangent) / along.scale
    middle = -(_FURTHEST + _NEAREST) / 2 * radius * along.scale
    rows = [_row(gear, along, heights) for heights in _heights(gear, min(longest, _SHARE * gear.half_width))]
    ups = [middle + step * spacing for step in (-1, 0, 1)]
    return Figure(tuple(Polyline.straight([(x, y + up) for x, y in row], Pen.THIN) for row in rows for up in ups))


def _heights(gear: Gear, length: float) -> list[tuple[float, ...]]:
    """Return the heights along the axis (mm) of the points of each line, which takes `length` (mm) for each hand."""
    middle, half = gear.face_width / 2, gear.half_width
    if not gear.double_helix.present:
        return [(middle - length / 2, middle + length / 2)]
    if not gear.double_helix.gap_width:
        return [(middle - length, middle, middle + length)]
    return [(centre - length / 2, centre + length / 2) for centre in (half / 2, gear.face_width - half / 2)]


def _row(gear: Gear, along: Along, heights: tuple[float, ...]) -> list[Point]:
    """Return a line on paper, its middle at the height of the axis."""
    turned = section_turn(gear, np.array(heights)) * gear.reference_diameter / 2
    turned -= (turned.min() + turned.max()) / 2
    rise = -along.direction * along.scale * turned  # the keyway side, +x, is up, and one looks from +y or from -y
    return [(along.across(z), float(y)) for z, y in zip(heights, rise, strict=True)]


BEYOND_AXIS, BEYOND_PITCH = 6.0, 3.0
"""Length of the axis and the reference line beyond their outlines (mm of paper)."""

_THICK_APART, _LEAST_APART = 1.0, 0.4
"""Edges of chamfers nearer to others are thin, so that they do not run into them; or are left out (mm of paper; ISO 128-2)."""

_HATCH, _FINEST_HATCH, _STROKES = 2.5, 0.7, 4
"""Distance of hatching lines, the least of it, and how many lines a narrow part should have at least."""


def half_section(gear: Gear, along: Along) -> Figure:
    """Return outlines, hatching and axis: the silhouette as one closed line, teeth not hatched, no root line outside."""
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
    """Return the pen for an edge of a chamfer at this distance (mm of paper) from the next edge; None if it is left out."""
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
    """Yield the visible lines of the cut half within its silhouette: roots, bore, keyway."""
    low, high = overall(gear)
    for start, end in root_lines(gear):
        yield along.line((start, gear.root_diameter / 2), (end, gear.root_diameter / 2))
    radii = [opening_radius(gear)] if gear.body.bore else []
    if gear.body.bore_spline:
        radii.append(free_bore(gear) / 2)
    if gear.body.keyway_width:
        radii.append(math.sqrt((gear.body.bore / 2) ** 2 - (gear.body.keyway_width / 2) ** 2))
    for radius in radii:
        yield along.line((low, radius), (high, radius))


def hatching(gear: Gear, along: Along) -> Hatching:
    """Return the hatched cut face, which ends at the root circle; its lines are closer where it is narrow."""
    corners = contour(gear, gear.root_diameter / 2, opening_radius(gear))
    edge: tuple[Vertex, ...] = tuple((x, y, 0.0) for x, y in along.points(corners))
    box = Polyline(edge, closed=True).box
    spacing = min(_HATCH, max(_FINEST_HATCH, min(box.width, box.height) / _STROKES))
    return Hatching((edge,), spacing=spacing)


def end_face(gear: Gear, scale: float, *, front: bool = True) -> Figure:
    """Return the outlines and centre lines of the end at z = face width (`front`) or z = 0, the axis at the origin."""
    body, reach = gear.body, scale * gear.tip_diameter / 2 + BEYOND_AXIS
    hub = body.hub_ends[front]
    tip, chamfered = gear.tip_diameter / 2, EndCone.of(gear).face_radius
    pen = chamfer_pen(scale * (tip - chamfered))  # the radius is infinite where there is no chamfer
    seen = [tip, *([body.hub_diameter / 2] if hub else [])]
    shapes: list[Shape] = [
        *(Circle((0.0, 0.0), scale * chamfered, each) for each in (pen,) if each is not None),
        *(Circle((0.0, 0.0), scale * radius) for radius in seen),
        Circle((0.0, 0.0), scale * gear.reference_diameter / 2, Pen.CENTRE),
        *opening(gear, scale),
        *centre_cross((0.0, 0.0), reach).shapes,
    ]
    return Figure(tuple(shapes))


_LEAST_DEPTH = 2.0
"""Least depth of the teeth of a spline (mm of paper) at which their reference circle is drawn."""


def opening(gear: Gear, scale: float) -> Iterator[Shape]:
    """Yield the bore as a circle, or with its keyway as one closed line; of a spline tips, roots and reference (ISO 6413)."""
    body = gear.body
    if (teeth := bore_teeth(gear)) is not None:
        for diameter, pen in ((teeth.tip_diameter, Pen.OUTLINE), (teeth.root_diameter, Pen.THIN)):
            yield Circle((0.0, 0.0), scale * abs(diameter) / 2, pen)
        if scale * abs(teeth.root_diameter - teeth.tip_diameter) / 2 >= _LEAST_DEPTH:
            yield Circle((0.0, 0.0), scale * abs(teeth.reference_diameter) / 2, Pen.CENTRE)
        return
    if not body.keyway_width:
        if body.bore:
            yield Circle((0.0, 0.0), scale * body.bore / 2)
        return
    half, floor = scale * body.keyway_width / 2, scale * (body.bore / 2 + body.keyway_depth)
    angle = keyway_half_angle(body)
    wall = scale * body.bore / 2 * math.cos(angle)
    around = math.tan((2 * math.pi - 2 * angle) / 4)
    corners = ((-half, wall, around), (half, wall, 0.0), (half, floor, 0.0), (-half, floor, 0.0))
    yield Polyline(corners, closed=True)
