"""Views of a rack, with dimensions and roughness (ISO 2203). Lengths of the part and of paper in mm."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

from gearcad.drawing.dimensions import Characteristic, Side, frame_leader, linear_dimension, tolerance_frame
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.drawing_symbols import centre_line, roughness, roughness_symbol, section_arrows, view_label, zigzag
from gearcad.drawing.layout import View
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Figure, Hatching, Line, Pen, Point, Polyline, Shape, Vertex
from gearcad.drawing.views.tooth_detail import tooth_outline
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import Rack

_SHOWN_LENGTH = 6.0
"""Greatest length that is shown, over the larger of height and face width."""

_PITCHES = 7
"""Least number of pitches that are shown."""

_WORTH = 1.6
"""Least ratio of a rack's length to its shown length at which the rack is drawn broken."""

_GAP = 3.0
"""Distance between the two shown parts (mm of paper)."""

_END_TEETH = 2
"""Number of whole teeth drawn at each end."""

_ROUNDING = 1e-9
"""Share of a pitch that counts as rounding."""


@dataclass(frozen=True)
class RackRange:
    """The shown range of a rack, seen from the end face at z = face width, x to the right. Its middle is at the origin."""

    rack: Rack
    scale: float

    @cached_property
    def kept(self) -> float | None:
        """Length shown at each end (mm of the part); None for a rack that is shown whole."""
        rack = self.rack
        shown = max(_SHOWN_LENGTH * max(rack.total_height, rack.face_width), _PITCHES * rack.transverse_pitch)
        return shown / 2 if rack.length > _WORTH * shown else None

    @property
    def right(self) -> float:
        """Position of the right end (mm of paper); the left end is as far to the left."""
        if self.kept is None:
            return self.scale * self.rack.length / 2
        return self.scale * self.kept + _GAP / 2

    def across(self, place: float) -> float:
        """Return the position on paper (mm) of a place along the rack (mm). A place that is not shown has the position of the
        nearest one shown.
        """
        if self.kept is None or place <= self.rack.length / 2:
            return -self.right + self.scale * (place if self.kept is None else min(place, self.kept))
        return self.right - self.scale * min(self.rack.length - place, self.kept)

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """Shown ranges of the rack (mm from its left end): all of it, or both ends."""
        length = self.rack.length
        return ((0.0, length),) if self.kept is None else ((0.0, self.kept), (length - self.kept, length))

    # ------------------------------------------------------------------ teeth

    @property
    def first_middle(self) -> float:
        """Middle of the first whole tooth at the visible end face (mm from the left end)."""
        pitch = self.rack.transverse_pitch
        shift = (self.rack.drift * self.rack.face_width) % pitch
        near = _ROUNDING * pitch
        return pitch / 2 + (shift if near < shift < pitch - near else 0.0)

    @property
    def whole_teeth(self) -> int:
        """Number of whole teeth at the visible end face."""
        pitch = self.rack.transverse_pitch
        return math.floor((self.rack.length - self.first_middle) / pitch + 0.5 + _ROUNDING)

    @property
    def toothed(self) -> tuple[tuple[float, float], ...]:
        """Ranges with drawn teeth (mm from the left end): both ends, or the whole of a rack with few teeth."""
        pitch = self.rack.transverse_pitch
        low = self.first_middle + (_END_TEETH - 0.5) * pitch
        high = self.first_middle + (self.whole_teeth - _END_TEETH - 0.5) * pitch
        if high - low < pitch:
            return ((0.0, self.rack.length),)
        return (0.0, low), (high, self.rack.length)


_NOTHING = 1e-9


def teeth_between(rack: Rack, low: float, high: float, middle: float) -> tuple[Vertex, ...]:
    """Return the outline of teeth from left to right, cut off at both places (mm); `middle` is the middle of any tooth."""
    pitch, tooth = rack.transverse_pitch, tooth_outline(rack)
    first, last = (math.floor((place - middle) / pitch + 0.5) for place in (low, high))
    row: list[Vertex] = []
    for number in range(first, last + 1):
        row[-1:] = [(x + middle + number * pitch, y, bulge) for x, y, bulge in tooth]
    found: list[Vertex] = []
    for start, end in pairwise(row):
        if end[0] <= low + _NOTHING or start[0] >= high - _NOTHING:
            continue
        begin, finish = max(start[0], low), min(end[0], high)
        whole = begin == start[0] and finish == end[0]
        piece = (start, end) if whole else _cut(start, end, begin, finish)
        found[-1:] = [piece[0], (piece[1][0], piece[1][1], 0.0)]
    return tuple(found)


def _cut(start: Vertex, end: Vertex, low: float, high: float) -> tuple[Vertex, Vertex]:
    """Return the piece of a line or an arc between two places; x rises along it."""
    (x, y, bulge), (to_x, to_y, _) = start, end
    if not bulge:
        heights = [y + (to_y - y) * (place - x) / (to_x - x) for place in (low, high)]
        return (low, heights[0], 0.0), (high, heights[1], 0.0)
    towards = (1 - bulge**2) / (4 * bulge)  # the centre is so many chords to the left of the chord's middle
    centre = (x + to_x) / 2 - towards * (to_y - y), (y + to_y) / 2 + towards * (to_x - x)
    radius = math.dist(centre, (x, y))
    side = -1 if bulge > 0 else 1  # x rises along an arc to the left only below its centre
    heights = [centre[1] + side * math.sqrt(max(radius**2 - (place - centre[0]) ** 2, 0.0)) for place in (low, high)]
    chord = math.dist((low, heights[0]), (high, heights[1]))
    angle = 2 * math.asin(min(1.0, chord / (2 * radius)))
    return (low, heights[0], math.copysign(math.tan(angle / 4), bulge)), (high, heights[1], 0.0)


_BEYOND_PITCH, _BEYOND_BREAK = 3.0, 2.0
"""Length of the reference line and of break lines beyond the outline (mm of paper)."""

SECTION = "B"
"""The letter of the end section: A is the datum."""

_LABEL = 6.0
"""Distance from the outline to the name of the section."""

_HATCH, _FINEST_HATCH, _STROKES = 2.5, 0.7, 4
"""Distance of hatching lines, the least of it, and how many lines a narrow part should have at least."""

_SPACING, _LONGEST, _SHARE = 3.0, 24.0, 0.7
"""Lines for the direction of the teeth: distance, greatest length, and greatest share of the face width."""


# ---------------------------------------------------------------------- front


def front_figure(span: RackRange) -> Figure:
    """Return the front view: teeth at both ends, between them the tip line and a thin root line. The reference line is at
    height 0.
    """
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


def tooth_middles(span: RackRange) -> list[float]:
    """Return the middles of the first two whole teeth (mm of paper)."""
    pitch = span.rack.transverse_pitch
    return [span.across(span.first_middle + number * pitch) for number in range(min(span.whole_teeth, 2))]


def _placed(span: RackRange, outline: tuple[Vertex, ...], back: float) -> Polyline:
    """Return an outline of teeth on paper, with the end face where it begins or ends at one."""
    place = span.across(outline[0][0]) - span.scale * outline[0][0]
    row: list[Vertex] = [(span.scale * x + place, span.scale * y, bulge) for x, y, bulge in outline]
    if outline[0][0] <= 0.0:
        row.insert(0, (row[0][0], back, 0.0))
    if outline[-1][0] >= span.rack.length:
        row.append((row[-1][0], back, 0.0))
    return Polyline(tuple(row))


def _between(span: RackRange) -> Iterator[tuple[float, float]]:
    """Yield the ranges without drawn teeth (mm of paper), one for each shown part."""
    if len(span.toothed) == 1:
        return
    (_, low), (high, _) = span.toothed
    for start, end in span.parts:
        yield span.across(max(start, low)), span.across(min(end, high))


def _breaks(span: RackRange, low: float, high: float) -> Iterator[Shape]:
    """Yield lines with zigzags where the rack is broken."""
    if span.kept is not None:
        for place in (span.kept, span.rack.length - span.kept):
            x = span.across(place)
            yield zigzag((x, low - _BEYOND_BREAK), (x, high + _BEYOND_BREAK))


# ---------------------------------------------------------------------- end


def end_figure(rack: Rack, scale: float) -> Figure:
    """Return the section square to the length, seen along +x. Teeth are not hatched, their root is a thick line."""
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


def plan_figure(span: RackRange) -> Figure:
    """Return the rectangle of length and face width, z downwards, and three thin lines for the direction of helical teeth."""
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


def _tooth_directions(span: RackRange) -> Iterator[Shape]:
    """Yield the lines of the tooth direction, in the middle of the first part. A tooth moves by `drift` along +x where z,
    downwards, grows by 1.
    """
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


_EXTENSIONS = (4.0, 12.0, 20.0, 28.0)
"""Distances of a symbol on the reference line from the outline (mm of paper)."""

_PAST = 2.0
"""Length of the extended line past the symbol (mm of paper)."""

_CUT_OFF = (2.0, 10.0, 18.0, 27.0, 37.0, 50.0, 65.0, 80.0)
"""Distances of the cutting line's ends from the outline (mm of paper)."""

_ALONG_BACK = (0.1, 0.25, 0.4, 0.55, 0.7, 0.05)
_ALONG_TIP = (0.75, 0.9, 0.25, 0.1)
"""Positions of a leader's end along an edge, over its length."""

_CUT_AT = (0.6, 0.75, 0.45, 0.9, 0.3, 0.97)
"""Positions of the cutting line along a shown part, over its length."""

_PLACE_DECIMALS = 2
"""Decimals of the first tooth's place, for which general tolerances hold."""

_Sources = tuple[Callable[[], Iterable[Figure]], ...]


@dataclass(frozen=True)
class FrontMarks:
    """Marks of the front view of a rack."""

    span: RackRange
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> _Sources:
        """Sources of all marks, those nearest to the outline first."""
        return self.first_tooth, self.pitch, self.back, self.cutting_line, self.length

    def length(self) -> Iterator[Figure]:
        """Yield dimensions of the whole length, even if only parts are shown; they have a scale of their own for programs that
        redraw them.
        """
        size, back = self.requirements.length, -self.span.scale * self.span.rack.height
        if size is not None:
            left, right = (-self.span.right, back), (self.span.right, back)
            draughting = replace(self.draughting, scale=2 * self.span.right / self.span.rack.length)
            yield from linear_dimension(left, right, Side.BELOW, size, draughting, clear=back)

    def pitch(self) -> Iterable[Figure]:
        """Return dimensions of the pitch between the first two teeth, in brackets as it follows from module and helix angle."""
        middles = tooth_middles(self.span)
        size = Size(value=self.span.rack.transverse_pitch, reference=True)
        return self._above(middles[0], middles[1], size) if len(middles) > 1 else ()

    def first_tooth(self) -> Iterable[Figure]:
        """Return dimensions from the end to the middle of the first tooth."""
        middles = tooth_middles(self.span)
        size = Size(value=self.span.first_middle, decimals=_PLACE_DECIMALS)
        return self._above(-self.span.right, middles[0], size) if middles else ()

    def back(self) -> Iterator[Figure]:
        """Yield frames of the flatness of the back, which is datum A."""
        if (deviation := self.requirements.back_flatness) is None:
            return
        frame = tolerance_frame(Characteristic.FLATNESS, self.draughting.words.shortest(deviation / 1000, 4))
        back = -self.span.scale * self.span.rack.height
        for low, high in self.span.parts:
            left, right = self.span.across(low), self.span.across(high)
            for part in _ALONG_BACK:
                yield from frame_leader((left + part * (right - left), back), Side.BELOW, frame, datum_letter="A")

    def cutting_line(self) -> Iterator[Figure]:
        """Yield cutting lines of the end section along the rack, as near to it as other marks permit; the length stands below
        it.
        """
        tip, back = self.span.scale * self.span.rack.tip_height, -self.span.scale * self.span.rack.height
        ends = [(self.span.across(low), self.span.across(high)) for low, high in reversed(self.span.parts)]
        for off in _CUT_OFF:
            for left, right in ends:
                for part in _CUT_AT:
                    x = left + part * (right - left)
                    yield section_arrows((x, tip + off), (x, back - off), Side.RIGHT, SECTION)

    def _above(self, left: float, right: float, size: Size) -> Iterator[Figure]:
        tip = self.span.scale * self.span.rack.tip_height
        yield from linear_dimension((left, tip), (right, tip), Side.ABOVE, size, self.draughting, clear=tip)


@dataclass(frozen=True)
class EndMarks:
    """Marks of the end section of a rack."""

    requirements: Requirements
    draughting: Draughting
    half: float
    """Half the face width; this and the next on paper."""

    tip: float
    back: float
    """Heights of tips and back."""

    @property
    def sources(self) -> _Sources:
        """Sources of all marks, those nearest to the outline first."""
        sizes = self.face_width, self.reference_height, self.height
        return *sizes, self.parallelism, self.flank_roughness, self.back_roughness

    def face_width(self) -> Iterator[Figure]:
        left, right = (-self.half, self.back), (self.half, self.back)
        yield from linear_dimension(left, right, Side.BELOW, self.requirements.face_width, self.draughting, clear=self.back)

    def reference_height(self) -> Iterable[Figure]:
        """Return dimensions of the height from the back to the reference line."""
        return self._upright(0.0, self.requirements.reference_height)

    def height(self) -> Iterable[Figure]:
        """Return dimensions of the height from the back to the tips."""
        return self._upright(self.tip, self.requirements.height)

    def _upright(self, top: float, size: Size | None) -> Iterator[Figure]:
        if size is None:
            return
        for side in (Side.RIGHT, Side.LEFT):
            out = side.outwards * self.half
            yield from linear_dimension((out, self.back), (out, top), side, size, self.draughting, clear=out)

    def parallelism(self) -> Iterator[Figure]:
        """Yield frames of the parallelism of the tips to the back, which is datum A: on the tip line, then on its extension."""
        if (deviation := self.requirements.back_parallelism) is None:
            return
        frame = tolerance_frame(Characteristic.PARALLELISM, self.draughting.words.shortest(deviation / 1000, 4), "A")
        for part in _ALONG_TIP:
            yield from frame_leader(((2 * part - 1) * self.half, self.tip), Side.ABOVE, frame)
        for out in _EXTENSIONS:
            for along in (Side.RIGHT, Side.LEFT):
                start, end = along.outwards * self.half, along.outwards * (self.half + out)
                line = Line((start, self.tip), (end + along.outwards * _PAST, self.tip), Pen.DIMENSION)
                for side in (Side.ABOVE, Side.BELOW):
                    yield from (Figure.of(line) + each for each in frame_leader((end, self.tip), side, frame))

    def flank_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of the flanks on the extended reference line (ISO 1302)."""
        flanks = self.requirements.flanks
        symbol = roughness_symbol(flanks.text(self.draughting.words.shortest(flanks.value)))
        box = symbol.box
        for out in _EXTENSIONS:
            for start, left in ((-self.half, -self.half - out - box.width), (self.half, self.half + out)):
                end = left if start < 0 else left + box.width
                yield Figure.of(Line((start, 0.0), (end, 0.0), Pen.DIMENSION), symbol.moved(left - box.left, 0.0))

    def back_roughness(self) -> Iterator[Figure]:
        """Yield the roughness of the back, if it is not the general one."""
        value = self.requirements.face_roughness
        if value != self.requirements.rest_roughness:
            ends: tuple[Point, Point] = ((-self.half, self.back), (self.half, self.back))
            yield from roughness(*ends, Side.BELOW, f"Ra {self.draughting.words.shortest(value)}", self.draughting)


def front_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """Return the view of the end faces at z = face width; the reference line is at height 0."""
    span = RackRange(_rack(drawn), draughting.scale)
    return View("front", front_figure(span), FrontMarks(span, requirements, draughting).sources)


def end_section(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View:
    """Return the section seen from the left of the front view; the reference line is at height 0."""
    rack = _rack(drawn)
    half, tip, back = (draughting.paper(each) for each in (rack.face_width / 2, rack.tip_height, -rack.height))
    marks = EndMarks(requirements, draughting, half, tip, back)
    return View("end", end_figure(rack, draughting.scale), marks.sources)


def plan_view(drawn: DrawnGear, requirements: Requirements, draughting: Draughting) -> View | None:
    """Return the view from above, which shows the direction of the teeth; None for a spur rack."""
    rack = _rack(drawn)
    return View("plan", plan_figure(RackRange(rack, draughting.scale))) if rack.helix_angle else None


def _rack(drawn: DrawnGear) -> Rack:
    assert isinstance(drawn.gear, Rack)
    return drawn.gear
