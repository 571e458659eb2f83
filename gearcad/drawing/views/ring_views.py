"""Views of a ring gear, with dimensions, run-outs and roughness (ISO 2203). Lengths of the part and of paper in mm.

The section is a full one: a half seen from outside would show nothing more.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.drawing.dimensions import (
    Characteristic,
    Side,
    circle_dimension,
    frame_leader,
    leader,
    linear_dimension,
    tolerance_frame,
    with_frame,
)
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.drawing_symbols import centre_circle, centre_star, freehand, roughness, roughness_symbol
from gearcad.drawing.layout import View
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Box, Circle, Figure, Hatching, Line, Pen, Point, Polyline, Shape, Text
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import Gear
from gearcad.geometry.gear_data import outer_diameter, section_turn
from gearcad.solids.body_plan import EndCone

Corner = tuple[float, float]
"""Height z and radius (mm of the part)."""


@dataclass(frozen=True)
class Meridian:
    """A ring with a horizontal axis at height 0 of the paper, mid face width at the origin. All radii are magnitudes (mm).

    `direction` is 1 where z goes to the right, -1 to the left. A bolt hole, on +x, is above the axis.
    """

    gear: Gear
    scale: float
    direction: int = 1

    def point(self, height: float, radius: float) -> Point:
        """Return the point on paper above the axis; below it if `radius` is negative."""
        return self.direction * self.scale * (height - self.gear.face_width / 2), self.scale * radius

    def points(self, corners: Iterable[Corner], side: int = 1) -> list[Point]:
        """Return corners as points on paper above the axis, or (`side` -1) their mirror images."""
        return [self.point(height, side * radius) for height, radius in corners]

    # ------------------------------------------------------------------ radii

    @property
    def tip(self) -> float:
        return self.gear.profile.tip_diameter / 2

    @property
    def root(self) -> float:
        return self.gear.profile.root_diameter / 2

    @property
    def reference(self) -> float:
        return self.gear.profile.reference_diameter / 2

    @cached_property
    def cone(self) -> EndCone:
        """Cone of the end chamfers."""
        return EndCone.of(self.gear)

    @property
    def corner(self) -> float:
        """Inner radius of the teeth's end faces (mm): at the tips, or outside a chamfer."""
        return self.cone.face_radius if self.cone.present else self.tip

    @property
    def is_open(self) -> bool:
        """Whether the ring has no given outside diameter."""
        return self.gear.body.rim_diameter is None

    @property
    def rim(self) -> float:
        """Outer radius (mm) of the ring. Without a given one the view ends where teeth and bolt holes have enough material."""
        holes = self.gear.body.bolt_circle + 2 * self.gear.body.bolt_diameter
        return max(outer_diameter(self.gear), holes if self.is_open else 0.0) / 2

    @property
    def holes(self) -> tuple[float, float] | None:
        """Least and greatest radius of bolt holes; None without any."""
        body = self.gear.body
        if not body.bolt_holes:
            return None
        return (body.bolt_circle - body.bolt_diameter) / 2, (body.bolt_circle + body.bolt_diameter) / 2

    # ------------------------------------------------------------------ outlines

    def along_teeth(self, radius: float) -> list[Corner]:
        """Return the corners from z = 0 along the teeth at a radius, with their end chamfers."""
        width, back = self.gear.face_width, float(self.cone.setback(radius))
        flat = [(back, radius), (width - back, radius)]
        return [(0.0, self.corner), *flat, (width, self.corner)] if back else flat

    @property
    def edges(self) -> list[Corner]:
        """Visible circles of the teeth behind the section: their ends."""
        return list(dict.fromkeys(self.along_teeth(self.tip)))


_SPACING = 3.0
_LONGEST = 24.0
"""Distance between the lines, and length of one, mm of paper; less where there is no room."""

_SHARE = 0.7
"""Largest share of the lines in the face width."""

_MIDDLE, _ROOM = -0.5, 0.7
"""Height of the lines, and the greatest height that they take, over the tip radius."""


def flank_directions(ring: Meridian) -> Figure:
    """Return the lines of a helical ring's tooth direction; empty for a spur ring.

    The view is of the far side. The rise of a tooth on paper is the turn of its section about the axis, times the radius. It
    has the opposite sign of the rise on the near side of an external gear.
    """
    gear = ring.gear
    if not gear.helix_angle:
        return Figure()
    room = _ROOM * ring.tip * ring.scale
    spacing = min(_SPACING, room / 6)
    tangent = abs(math.tan(math.radians(gear.helix_angle)))
    longest = min(_LONGEST * math.cos(math.atan(tangent)), (room - 2 * spacing) / tangent) / ring.scale
    middle = _MIDDLE * ring.tip * ring.scale
    row = _row(ring, min(longest, _SHARE * gear.face_width))
    return Figure(tuple(Polyline.straight([(x, y + middle + step * spacing) for x, y in row], Pen.THIN) for step in (-1, 0, 1)))


def _row(ring: Meridian, length: float) -> list[Point]:
    """Return a line on paper about mid face width, `length` (mm of the part) along the axis."""
    middle = ring.gear.face_width / 2
    heights = np.array([middle - length / 2, middle + length / 2])
    turned = section_turn(ring.gear, heights) * ring.reference
    rise = ring.direction * ring.scale * (turned - turned.mean())  # +x is up, and the far side is on -y where one is on +y
    return [(ring.point(z, 0.0)[0], float(y)) for z, y in zip(heights, rise, strict=True)]


BEYOND_AXIS, _BEYOND_PITCH, _BEYOND_HOLE = 6.0, 3.0, 2.0
"""Length of the axis, the reference line and a hole's centre line beyond their outlines (mm of paper)."""

_HATCH, _FINEST_HATCH, _STROKES = 2.5, 0.7, 4
"""Distance of hatching lines, the least of it, and how many lines a narrow part should have at least."""


def full_section(ring: Meridian) -> Figure:
    """Return outlines with hatching and axis. Teeth are not hatched, bolt holes are turned into the plane of the section."""
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
    """Yield roots, bolt holes and centre lines on one side."""
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
    """Yield the cut faces outside the roots, two if a hole is between them; lines are closer where they are narrow."""
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


_FACE_BEYOND_HOLE = 2.0
"""Length of a hole's centre line beyond the hole (mm of paper)."""

_SIDES = 90
"""Corners of the polygon along which an open rim is drawn by hand."""


def end_face(ring: Meridian) -> Figure:
    """Return outlines and centre lines of the end face, the axis at the origin."""
    seen = [ring.tip, *([ring.corner] if ring.cone.present else [])]
    shapes: list[Shape] = [
        *(Circle((0.0, 0.0), ring.scale * radius) for radius in seen),
        Circle((0.0, 0.0), ring.scale * ring.reference, Pen.CENTRE),
        _rim(ring),
        *(Circle(place, ring.scale * ring.gear.body.bolt_diameter / 2) for place in hole_places(ring)),
        *_centre_lines(ring).shapes,
    ]
    return Figure(tuple(shapes))


def hole_places(ring: Meridian) -> list[Point]:
    """Return the centres of the bolt holes on paper (mm), the first one above the axis."""
    radius, count = ring.scale * ring.gear.body.bolt_circle / 2, ring.gear.body.bolt_holes
    angles = [math.pi / 2 + 2 * math.pi * number / count for number in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def _rim(ring: Meridian) -> Shape:
    radius = ring.scale * ring.rim
    if not ring.is_open:
        return Circle((0.0, 0.0), radius)
    sides = max(8, min(_SIDES, round(2 * math.pi * radius / 4.0)))
    turns = [2 * math.pi * number / sides for number in range(sides)]
    return freehand([(radius * math.cos(turn), radius * math.sin(turn)) for turn in turns], closed=True)


def _centre_lines(ring: Meridian) -> Figure:
    """Return the centre lines of the ring and its bolt holes, with the bolt circle."""
    reach, body = ring.scale * ring.rim + BEYOND_AXIS, ring.gear.body
    places = hole_places(ring)
    star = centre_star(Box(-reach, -reach, reach, reach), places, ring.scale * body.bolt_diameter / 2 + _FACE_BEYOND_HOLE)
    return star + centre_circle(ring.scale * body.bolt_circle / 2, places) if places else star


_ALONG = (0.5, 0.3, 0.7, 0.15, 0.85)
"""Positions of a leader's end along an edge, over its length."""

_EXTENSIONS = (5.0, 12.0, 20.0, 28.0, 38.0)
"""Distances of a mark on an extended line from the outline (mm of paper)."""


@dataclass(frozen=True)
class SectionMarks:
    """Marks of a ring in its section."""

    ring: Meridian
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """Sources of all marks, those nearest to the outline first."""
        sizes = self.face_width, self.tip, self.rim, self.end_chamfer
        demands = self.face_runout, self.cylindricity, self.flank_roughness, self.tip_runout
        return *sizes, *demands, self.rim_roughness, self.face_roughness, self.open_rim

    @property
    def _right(self) -> float:
        """Right end of the outline (mm of paper); the left end is as far to the left."""
        return self.ring.scale * self.ring.gear.face_width / 2

    @property
    def _top(self) -> float:
        return self.ring.scale * self.ring.rim

    # ------------------------------------------------------------------ sizes

    def face_width(self) -> Iterator[Figure]:
        for side in (Side.BELOW, Side.ABOVE):
            out = side.outwards * self._top
            left, right = (-self._right, out), (self._right, out)
            yield from linear_dimension(left, right, side, self.requirements.face_width, self.draughting, clear=out)

    def tip(self) -> Iterable[Figure]:
        chamfer = self.ring.scale * self.ring.gear.body.end_chamfer
        return self._diameter(self.ring.tip, self._right - chamfer, self.requirements.tip)

    def rim(self) -> Iterable[Figure]:
        """Return dimensions of the outside diameter, with datum A, which is its axis."""
        letter = "A" if self.requirements.drawn.spline is None else ""  # no tolerance of a spline refers to it
        return self._diameter(self.ring.rim, self._right, self.requirements.rim, datum_letter=letter)

    def _diameter(self, radius: float, out: float, size: Size | None, datum_letter: str = "") -> Iterator[Figure]:
        """Yield dimensions of a diameter; `radius` is in mm of the part, `out` is the edges' distance from mid face width (mm
        of paper).
        """
        if size is None:
            return
        up = self.ring.scale * radius
        for side in (Side.LEFT, Side.RIGHT):
            low, high = (side.outwards * out, -up), (side.outwards * out, up)
            clear = side.outwards * self._right
            yield from linear_dimension(low, high, side, size, self.draughting, clear=clear, datum_letter=datum_letter)

    def end_chamfer(self) -> Iterator[Figure]:
        """Yield leaders to one of the chamfers, from the opening."""
        size = self.requirements.end_chamfer
        if size is None:
            return
        radius, back = (self.ring.tip + self.ring.corner) / 2, self.ring.gear.body.end_chamfer / 2
        for up in (1, -1):
            for across in (1, -1):
                at = across * (self._right - self.ring.scale * back), up * self.ring.scale * radius
                ways = (-30.0, -45.0, -60.0, -15.0) if up > 0 else (30.0, 45.0, 60.0, 15.0)
                yield from leader(at, size, self.draughting, ways if across > 0 else tuple(180.0 - way for way in ways))

    def open_rim(self) -> Iterator[Figure]:
        """Yield notes that the outside diameter of the ring is not given."""
        if self.ring.is_open:
            words = self.draughting.words["rings.open_rim"]
            for up in (1, -1):
                yield from leader((self._right / 2, up * self._top), words, self.draughting, (up * 45.0, up * 30.0, up * 135.0))

    # ------------------------------------------------------------------ demands

    def cylindricity(self) -> Iterator[Figure]:
        """Yield frames of the cylindricity of the rim, which is the datum."""
        for tip, side in self._on_rim():
            yield from self._frame(Characteristic.CYLINDRICITY, self.requirements.cylindricity, tip, side)

    def tip_runout(self) -> Iterator[Figure]:
        """Yield frames of the run-out of the tip cylinder, on its line extended beyond the outline; from the opening."""
        tip = self.ring.scale * self.ring.tip
        for out in _EXTENSIONS:
            for along in (Side.RIGHT, Side.LEFT):
                for up, side in ((tip, Side.BELOW), (-tip, Side.ABOVE)):
                    start, end = along.outwards * self._right, along.outwards * (self._right + out)
                    line = Line((start, up), (end + along.outwards * 2.0, up), Pen.DIMENSION)
                    yield from (
                        Figure.of(line) + frame
                        for frame in self._frame(
                            Characteristic.CIRCULAR_RUNOUT, self.requirements.tip_runout, (end, up), side, "A"
                        )
                    )

    def face_runout(self) -> Iterator[Figure]:
        """Yield frames of the run-out of both end faces."""
        low, high = self.ring.scale * max(self.ring.root, self.ring.corner), self._top
        for side in (Side.RIGHT, Side.LEFT):
            for up in (1, -1):
                for part in _ALONG:
                    at = side.outwards * self._right, up * (low + part * (high - low))
                    yield from self._frame(
                        Characteristic.CIRCULAR_RUNOUT, self.requirements.face_runout, at, side, "A", count="2×"
                    )

    def _frame(
        self, kind: Characteristic, deviation: float | None, tip: Point, side: Side, datums: str = "", count: str = ""
    ) -> Iterator[Figure]:
        if deviation is None:
            return
        frame = tolerance_frame(kind, self.draughting.words.shortest(deviation / 1000, 4), datums)
        if count:
            frame += Figure((Text(count, (0.5, frame.box.top + 1.0)),))
        yield from frame_leader(tip, side, frame)

    def _on_rim(self) -> Iterator[tuple[Point, Side]]:
        for side in (Side.ABOVE, Side.BELOW):
            for part in _ALONG:
                yield ((2 * part - 1) * self._right, side.outwards * self._top), side

    def flank_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of the flanks on the extended reference line (ISO 1302)."""
        flanks = self.requirements.flanks
        symbol = roughness_symbol(flanks.text(self.draughting.words.shortest(flanks.value)))
        pitch, box = self.ring.scale * self.ring.reference, symbol.box
        for up in (-pitch, pitch):
            for out in _EXTENSIONS:
                for start, left in ((self._right, self._right + out), (-self._right, -self._right - out - box.width)):
                    end = left + box.width if start > 0 else left
                    yield Figure.of(Line((start, up), (end, up), Pen.DIMENSION), symbol.moved(left - box.left, up))

    def rim_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of the rim, if it is a datum and its roughness is not the general one."""
        if self.requirements.rim is None:
            return
        for side in (Side.ABOVE, Side.BELOW):
            up = side.outwards * self._top
            yield from self._roughness(self.requirements.bore_roughness, (-self._right, up), (self._right, up), side)

    def face_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of both end faces, if it is not the general one."""
        low, high = self.ring.scale * max(self.ring.root, self.ring.corner), self._top
        for side in (Side.LEFT, Side.RIGHT):
            for up in (1, -1):
                out = side.outwards * self._right
                yield from self._roughness(self.requirements.face_roughness, (out, up * low), (out, up * high), side, "2×")

    def _roughness(self, value: float, start: Point, end: Point, side: Side, count: str = "") -> Iterator[Figure]:
        if value != self.requirements.rest_roughness:
            text = f"Ra {self.draughting.words.shortest(value)}"
            yield from roughness(start, end, side, text, self.draughting, count=count)


_BEYOND = (6.0, 12.0, 20.0, 30.0)
"""Distances of a text from the rim (mm of paper)."""

_OFF_AXIS = 0.15
"""Least sine and cosine of a leader's direction, so that it is not along a centre line."""


@dataclass(frozen=True)
class RingFaceMarks:
    """Marks of a ring in its face view."""

    ring: Meridian
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """Sources of all marks."""
        return self.bolt_circle, self.bolts

    def bolts(self) -> Iterator[Figure]:
        """Yield leaders from outside the rim to one of the holes: number, diameter and position tolerance."""
        size = self.requirements.bolts
        if size is None:
            return
        radius, rim = self.ring.scale * self.ring.gear.body.bolt_diameter / 2, self.ring.scale * self.ring.rim
        holes = [place for place in hole_places(self.ring) if min(map(abs, place)) > _OFF_AXIS * math.hypot(*place)]
        for x, y in sorted(holes or hole_places(self.ring), key=lambda place: (-place[0], -place[1]))[:12]:
            middle = math.degrees(math.atan2(y, x))
            for way in (middle + 12.0, middle - 12.0, middle + 25.0, middle - 25.0):
                tip = x + radius * math.cos(math.radians(way)), y + radius * math.sin(math.radians(way))
                if abs(math.cos(math.radians(way))) < _OFF_AXIS:
                    continue
                lengths = [rim - math.hypot(x, y) + out for out in _BEYOND]
                for led in leader(tip, size, self.draughting, (way,), lengths=lengths):
                    yield led if self._position is None else with_frame(led, self._position)

    @property
    def _position(self) -> Figure | None:
        """Frame of the holes' position tolerance to the datum axis A; None without one."""
        deviation = self.requirements.bolt_position
        if deviation is None:
            return None
        value = self.draughting.words.shortest(deviation / 1000, 4)
        return tolerance_frame(Characteristic.POSITION, f"⌀{value}", "A")

    def bolt_circle(self) -> Iterator[Figure]:
        """Yield dimensions of the bolt circle, preferably between holes, the text outside the rim."""
        size = self.requirements.bolt_circle
        if size is None:
            return
        radius = self.ring.scale * self.ring.gear.body.bolt_circle / 2
        step = 360.0 / self.ring.gear.body.bolt_holes
        ways = [90.0 + step * (number + 0.5) for number in range(self.ring.gear.body.bolt_holes)]
        free = [way for way in ways if abs(math.cos(math.radians(way))) > _OFF_AXIS]
        free.sort(key=lambda way: -math.sin(math.radians(way)))
        others = (45.0, 135.0, -45.0, -135.0, 30.0, 150.0, 60.0, 120.0)
        yield from circle_dimension(
            (0.0, 0.0), radius, size, self.draughting, (*free[:8], *others), beyond=self.ring.scale * self.ring.rim - radius
        )


def section_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """Return the full section, through a bolt hole; the end shown by `face_view` is at its left."""
    ring = _meridian(drawn, draughting)
    return View("section", full_section(ring), SectionMarks(ring, requirements, draughting).sources)


def face_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """Return the view from the left of the section, a bolt hole up."""
    ring = _meridian(drawn, draughting)
    return View("face", end_face(ring), RingFaceMarks(ring, requirements, draughting).sources)


def _meridian(drawn: DrawnGear, draughting: Draughting) -> Meridian:
    assert isinstance(drawn.gear, Gear) and drawn.gear.internal
    return Meridian(drawn.gear, draughting.scale)
