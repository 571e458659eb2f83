"""Views of an external gear with dimensions, run-outs and roughness (ISO 2203). Each mark has several places, best first."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain

from gearcad.drawing.dimensions import (
    FRAME_HEIGHT,
    Characteristic,
    Side,
    circle_dimension,
    datum,
    frame_leader,
    landing_of,
    leader,
    linear_dimension,
    tolerance_frame,
)
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.drawing_symbols import roughness, roughness_symbol
from gearcad.drawing.layout import View
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Box, Circle, Figure, Line, Pen, Point, Text
from gearcad.drawing.views.gear_figures import BEYOND_AXIS, Along, Corner, Silhouette, end_face, half_section, overall, strips
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import Gear
from gearcad.geometry.bore_teeth import free_bore
from gearcad.geometry.gear_parts import HubSide
from gearcad.solids.body_plan import EndCone, keyway_half_angle

_ABOVE_FIRST, _BELOW_FIRST = (Side.ABOVE, Side.BELOW), (Side.BELOW, Side.ABOVE)

_LONG_EXTENSION = 40.0
"""Length of extension lines beyond which the other side is preferred (mm of paper)."""

_BEYOND = (8.0, 16.0, 26.0, 40.0)
"""Distances beyond the outline at which a leader from within may end (mm of paper)."""


_BELOW_TEETH = (7.0, 12.0, 18.0)
"""Distances below the teeth at which a leader may end (mm of paper)."""


@dataclass(frozen=True)
class SectionSizes:
    """Marks of the sizes of an external gear in its section."""

    outline: Silhouette
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """Sources of all marks, those nearest to the outline first."""
        lengths = (self.gap_width, self.half_width, self.hub_length, self.face_width, self.hub_width)
        return *lengths, self.hub_diameter, self.tip, self.gap_diameter, self.end_chamfer

    def face_width(self) -> Iterator[Figure]:
        corner, ends = self.outline.corner, (0.0, self.outline.gear.face_width)
        return self._length((ends[0], corner), (ends[1], corner), self._overall, self.requirements.face_width)

    @property
    def _overall(self) -> tuple[Side, ...]:
        """Sides for overall lengths, best first: beyond the lengths of the halves if a gap parts them, as the gap's leader
        comes from below.
        """
        return _ABOVE_FIRST if self.requirements.gap_width else _BELOW_FIRST

    def hub_width(self) -> Iterator[Figure]:
        """Return dimensions of the overall width, where hubs stand out."""
        (low, high), width = overall(self.outline.gear), self.outline.gear.face_width
        hub, corner = self.outline.gear.body.hub_diameter / 2, self.outline.corner
        ends = (low, hub if low < 0 else corner), (high, hub if high > width else corner)
        return self._length(*ends, self._overall, self.requirements.hub_width)

    def hub_length(self) -> Iterator[Figure]:
        """Return dimensions of the length of one of two hubs. A single hub has none: it follows from face width and overall
        width.
        """
        body = self.outline.gear.body
        size = Size(value=body.hub_length) if body.hub_length and body.hub_side is HubSide.BOTH else None
        start = self.outline.tooth_ends[0]
        return self._length((self.outline.ends[0], body.hub_diameter / 2), (start, self.outline.corner), _ABOVE_FIRST, size)

    def gap_width(self) -> Iterator[Figure]:
        between = self.outline.gear.half_width, self.outline.gear.face_width - self.outline.gear.half_width
        start, end = ((height, self.outline.corner) for height in between)
        return self._length(start, end, _ABOVE_FIRST, self.requirements.gap_width)

    def half_width(self) -> Iterator[Figure]:
        """Yield dimensions of the width of one half, if there is a gap."""
        gear, corner = self.outline.gear, self.outline.corner
        size = Size(value=gear.half_width) if self.requirements.gap_width else None
        lower, upper = (0.0, gear.half_width), (gear.face_width - gear.half_width, gear.face_width)
        for side in _ABOVE_FIRST:
            for start, end in (lower, upper):
                yield from self._length((start, corner), (end, corner), (side,), size)

    def _length(self, start: Corner, end: Corner, sides: tuple[Side, ...], size: Size | None) -> Iterator[Figure]:
        """Yield dimensions along the axis, above or below the outline."""
        if size is None:
            return
        for side in sides:
            first, second = (self.outline.along.point(height, side.outwards * radius) for height, radius in (start, end))
            yield from linear_dimension(first, second, side, size, self.draughting, clear=self.outline.top * side.outwards)

    def hub_diameter(self) -> Iterable[Figure]:
        """Return dimensions of the hub diameter, on the side where the hub stands out."""
        left, right = self.outline.ends
        at_left = left != self.outline.tooth_ends[0]
        radius = self.outline.gear.body.hub_diameter / 2
        side = Side.LEFT if at_left else Side.RIGHT
        return self._diameter(left if at_left else right, radius, side, self.requirements.hub_diameter)

    def tip(self) -> Iterable[Figure]:
        back = float(EndCone.of(self.outline.gear).setback(self.outline.tip))
        inwards = back * self.outline.along.direction
        left, right = self.outline.tooth_ends
        places = [(Side.LEFT, left + inwards), (Side.RIGHT, right - inwards)]
        across_hub = self.outline.along.scale * abs(left - self.outline.ends[0])
        ordered = places if across_hub < _LONG_EXTENSION else reversed(places)
        return chain.from_iterable(self._diameter(z, self.outline.tip, side, self.requirements.tip) for side, z in ordered)

    def _diameter(self, height: float, radius: float, side: Side, size: Size | None) -> Iterable[Figure]:
        """Return dimensions of a diameter whose edges are at a height along the axis, at the left or at the right."""
        if size is None:
            return ()
        clear = self.outline.left if side is Side.LEFT else self.outline.right
        low, high = (self.outline.along.point(height, up) for up in (-radius, radius))
        return linear_dimension(low, high, side, size, self.draughting, clear=clear)

    def gap_diameter(self) -> Iterator[Figure]:
        """Yield leaders to the visible floor of the groove: out of the groove, then across the teeth."""
        size = self.requirements.gap_diameter
        if size is None:
            return
        floor = self.outline.along.point(self.outline.gear.face_width / 2, -self.outline.gear.gap_diameter / 2)
        depth = self.outline.top + floor[1]
        for below in _BELOW_TEETH:
            for way in (-60.0, -120.0, -75.0, -105.0, -45.0, -135.0):
                down = -math.sin(math.radians(way))
                yield from leader(floor, size, self.draughting, (way,), lengths=((depth + below) / down,))
        for beyond in _BEYOND:
            for way in (-35.0, -25.0, -50.0, -15.0, -65.0):
                across = math.cos(math.radians(way))
                yield from leader(
                    floor, size, self.draughting, (way,), lengths=((self.outline.right - floor[0] + beyond) / across,)
                )
                yield from leader(
                    floor, size, self.draughting, (-180.0 - way,), lengths=((floor[0] - self.outline.left + beyond) / across,)
                )

    def end_chamfer(self) -> Iterator[Figure]:
        """Yield leaders to one of the chamfers, from outside."""
        size = self.requirements.end_chamfer
        if size is None:
            return
        left, right = self.outline.tooth_ends
        inwards = self.outline.gear.body.end_chamfer / 2 * self.outline.along.direction
        radius = (self.outline.tip + self.outline.corner) / 2
        for height, upwards, ways in (
            (right - inwards, 1, (45.0, 30.0, 60.0)),
            (left + inwards, 1, (135.0, 150.0, 120.0)),
            (right - inwards, -1, (-45.0, -30.0, -60.0)),
            (left + inwards, -1, (-135.0, -150.0, -120.0)),
        ):
            yield from leader(self.outline.along.point(height, upwards * radius), size, self.draughting, ways)


_ALONG_TIP = (0.5, 0.3, 0.7, 0.15, 0.85)
_ALONG_FACE = (0.75, 0.9, 0.25, 0.5)
"""Positions of a leader's end along an edge, over its length."""

_STANDING = 18.0
"""Least length (mm of paper) of the left face for a symbol on it; below, the right face is tried first."""

_EXTENSIONS = (3.0, 12.0, 20.0, 28.0)
"""Distances of a symbol on the reference line from the outline (mm of paper)."""


@dataclass(frozen=True)
class SectionDemands:
    """Marks of run-outs and roughness of an external gear in its section."""

    outline: Silhouette
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """Sources of all marks."""
        return self.face_runout, self.flank_roughness, self.tip_runout, self.face_roughness

    def tip_runout(self) -> Iterator[Figure]:
        """Yield frames of the run-out of the tip cylinder to the datum axis A."""
        low, high = strips(self.outline.gear)[-1]
        for side in (Side.ABOVE, Side.BELOW):
            for part in _ALONG_TIP:
                tip = self.outline.along.point(low + part * (high - low), side.outwards * self.outline.tip)
                yield from self._frame(self.requirements.tip_runout, tip, side, self.outline.top * side.outwards)

    def face_runout(self) -> Iterator[Figure]:
        """Yield frames of the run-out of both outermost faces to the datum axis A."""
        outline, deviation = self.outline, self.requirements.face_runout
        faces = ((Side.RIGHT, outline.ends[1], outline.right), (Side.LEFT, outline.ends[0], outline.left))
        for side, height, clear in faces:
            (x, low), (_, high) = outline.end_face(height)
            for upwards in (1, -1):
                for part in _ALONG_FACE:
                    yield from self._frame(deviation, (x, upwards * (low + part * (high - low))), side, clear, "2×")

    def _frame(self, deviation: float | None, tip: Point, side: Side, clear: float, count: str = "") -> Iterable[Figure]:
        if deviation is None:
            return ()
        value = self.draughting.words.shortest(deviation / 1000, 4)
        frame = tolerance_frame(Characteristic.CIRCULAR_RUNOUT, value, "A")
        if count:
            frame += Figure((Text(count, (0.5, frame.box.top + 1.0)),))
        return frame_leader(tip, side, frame, clear=clear)

    def flank_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of the flanks on the extended reference line (ISO 1302)."""
        flanks = self.requirements.flanks
        symbol = roughness_symbol(flanks.text(self.draughting.words.shortest(flanks.value)))
        pitch = self.outline.along.scale * self.outline.gear.reference_diameter / 2
        left, right = (self.outline.along.across(height) for height in self.outline.tooth_ends)
        for up in (pitch, -pitch):
            for air in _EXTENSIONS:
                at_right = symbol.moved(self.outline.right + air - symbol.box.left, up)
                at_left = symbol.moved(self.outline.left - air - symbol.box.right, up)
                yield Figure.of(Line((right, up), (at_right.box.right, up), Pen.DIMENSION), at_right)
                yield Figure.of(Line((at_left.box.left, up), (left, up), Pen.DIMENSION), at_left)

    def face_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of both outermost faces, if it is not the general one."""
        if self.requirements.face_roughness == self.requirements.rest_roughness:
            return
        value = f"Ra {self.draughting.words.shortest(self.requirements.face_roughness)}"
        faces = [(side, *self.outline.end_face(z)) for z, side in zip(self.outline.ends, (Side.LEFT, Side.RIGHT), strict=True)]
        (_, (_, low), (_, high)), _ = faces
        for side, (x, inner), (_, outer) in faces if high - low >= _STANDING else reversed(faces):
            for upwards in (1, -1):
                ends = (x, upwards * inner), (x, upwards * outer)
                yield from roughness(*ends, side, value, self.draughting, count="2×")


_AIR = 1.0
_OFF_KEYWAY = 4.0
"""Degrees from a corner of the keyway to an arrow at the bore."""

_WAYS = (45.0, 135.0, -45.0, -135.0, 30.0, 150.0, -30.0, -150.0, 60.0, 120.0, -60.0, -120.0, 75.0, 105.0, -75.0, -105.0)


@dataclass(frozen=True)
class FaceMarks:
    """Marks of the face view of an external gear, whose outline is `figure`."""

    gear: Gear
    figure: Figure
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """Sources of all marks, the smallest first."""
        return self.keyway_width, self.keyway_depth, self.bore

    def keyway_width(self) -> Iterable[Figure]:
        """Return dimensions of the keyway width, with its symmetry to the datum axis A."""
        body = self.gear.body
        half, floor = body.keyway_width / 2, body.bore / 2 + body.keyway_depth
        frame = None
        if (deviation := self.requirements.keyway_symmetry) is not None:
            value = self.draughting.words.shortest(deviation / 1000, 4)
            frame = tolerance_frame(Characteristic.SYMMETRY, value, "A")
        return self._between((-half, floor), (half, floor), (Side.ABOVE,), self.requirements.keyway_width, frame)

    def keyway_depth(self) -> Iterable[Figure]:
        """Return dimensions of the depth across bore and keyway, d + t2."""
        body = self.gear.body
        ends = (0.0, -body.bore / 2), (0.0, body.bore / 2 + body.keyway_depth)
        return self._between(*ends, (Side.RIGHT, Side.LEFT), self.requirements.keyway_depth)

    def _between(
        self,
        first: tuple[float, float],
        second: tuple[float, float],
        sides: tuple[Side, ...],
        size: Size | None,
        frame: Figure | None = None,
    ) -> Iterable[Figure]:
        """Yield dimensions between two points of the part, first within the outline, then beyond it."""
        if size is None:
            return
        start, end = ((self.draughting.paper(x), self.draughting.paper(y)) for x, y in (first, second))
        inner = max(self.draughting.paper(radius) for radius in self._within)
        for clear in (inner, self._reach):
            for side in sides:
                yield from linear_dimension(start, end, side, size, self.draughting, clear=clear * side.outwards, frame=frame)

    @property
    def _within(self) -> tuple[float, ...]:
        """Radii (mm of the part) of the opening and the hub."""
        body = self.gear.body
        return body.opening_diameter / 2, body.hub_diameter / 2

    @property
    def _reach(self) -> float:
        """Radius of the tip circle (mm of paper)."""
        return self.draughting.paper(self.gear.tip_diameter / 2)

    def bore(self) -> Iterator[Figure]:
        """Yield the bore's diameter, roughness and cylindricity. It is datum A if tolerances refer to it (ISO 5459: at a size
        the datum is the axis).
        """
        size = self.requirements.bore
        if size is None:
            return
        radius, body = self.draughting.paper(free_bore(self.gear) / 2), self.gear.body
        open_at = math.degrees(keyway_half_angle(body)) + _OFF_KEYWAY if body.keyway_width else 0.0
        ways = [way for way in _WAYS if abs(way - 90.0) >= open_at]
        within = circle_dimension((0.0, 0.0), radius, size, self.draughting, ways)
        beyond = circle_dimension((0.0, 0.0), radius, size, self.draughting, ways, beyond=self._reach - radius)
        demands = {to_right: self._of_bore(to_right) for to_right in (True, False)}
        boxes = {to_right: figure.box for to_right, figure in demands.items()}
        found = []
        for led in chain(within, beyond):
            landing = landing_of(led)
            to_right = landing.end[0] > landing.start[0]
            box = boxes[to_right].moved(*landing.end)
            if self._is_free(box):
                grown = self._growth(Box.of_all((box, landing.box)))
                found.append((grown, led, demands[to_right], landing.end))
        for _, led, figure, end in sorted(found, key=lambda each: each[0]):
            yield led + figure.moved(*end)

    def _growth(self, box: Box) -> float:
        """Return the growth of the view (mm) with a box. Width counts twice as much as height, as views stand beside each
        other.
        """
        wider = max(0.0, box.right - self._reach) + max(0.0, -box.left - self._reach)
        taller = max(0.0, box.top - self._reach) + max(0.0, -box.bottom - self._reach)
        return wider + 0.5 * taller

    def _of_bore(self, to_right: bool) -> Figure:
        """Return the marks on and below the line under the diameter, whose end away from the arrow is at (0, 0)."""
        symbol = roughness_symbol(f"Ra {self.draughting.words.shortest(self.requirements.bore_roughness)}")
        symbol = symbol.moved(_AIR - symbol.box.left if to_right else -_AIR - symbol.box.right, 0.0)
        end = symbol.box.right if to_right else symbol.box.left
        marks, low = [symbol, Figure.of(Line((0.0, 0.0), (end, 0.0), Pen.DIMENSION))], 0.0
        if (deviation := self.requirements.cylindricity) is not None:
            frame = tolerance_frame(Characteristic.CYLINDRICITY, self.draughting.words.shortest(deviation / 1000, 4))
            marks.append(frame.moved(-frame.box.width if to_right else 0.0, -_AIR - FRAME_HEIGHT / 2))
            low = marks[-1].box.bottom
        needed = self.requirements
        if any(each is not None for each in (needed.tip_runout, needed.face_runout, needed.keyway_symmetry)):
            marks.append(next(iter(datum("A", (-FRAME_HEIGHT if to_right else FRAME_HEIGHT, low), Side.BELOW))))
        return Figure.of(*marks)

    def _is_free(self, box: Box) -> bool:
        """Return whether no circle and no centre line of the outline passes through a box, and no hub is under it."""
        across, up = max(box.left, -box.right, 0.0), max(box.bottom, -box.top, 0.0)
        nearest = math.hypot(across, up)
        furthest = math.hypot(max(-box.left, box.right), max(-box.bottom, box.top))
        radii = [each.radius for each in self.figure.shapes if isinstance(each, Circle)]
        crossed = any(nearest < radius < furthest for radius in (*radii, self.draughting.paper(max(self._within))))
        on_axis = box.left < 0.0 < box.right or box.bottom < 0.0 < box.top
        return not crossed and not (on_axis and nearest < self._reach + BEYOND_AXIS)


def section_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """Return the half section: cut above the axis, through the keyway; the end shown by `face_view` is at its left."""
    gear = _external(drawn)
    along = Along.of(gear, draughting.scale, drawn.direction)
    outline = Silhouette(gear, along)
    sizes = SectionSizes(outline, requirements, draughting).sources
    demands = SectionDemands(outline, requirements, draughting).sources
    return View("section", half_section(gear, along), (*sizes, *demands))


def face_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """Return the view from the left of the section, the keyway up: the end with the hub; with two hubs, the front."""
    gear = _external(drawn)
    figure = end_face(gear, draughting.scale, front=drawn.direction < 0)
    return View("face", figure, FaceMarks(gear, figure, requirements, draughting).sources)


def _external(drawn: DrawnGear) -> Gear:
    assert isinstance(drawn.gear, Gear) and not drawn.gear.internal  # rings and racks have views of their own
    return drawn.gear
