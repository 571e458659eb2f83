"""Views of a gear pair: the section through both axes, and both parts along their axes (ISO 2203). Lengths in mm of paper.

Heights are in mm over the axis of the wheel or the reference line of a rack; z is that of `wheel_pose` and `rack_pose`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial

from gearcad.drawing.dimensions import Side, linear_dimension
from gearcad.drawing.drawing_symbols import centre_line, zigzag
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.shapes import Box, Figure, Line, Pen, Polyline, Shape
from gearcad.drawing.views.assembly_figures import (
    BEYOND_AXIS,
    Across,
    Cut,
    FrontView,
    Sectioned,
    balloons,
    cut_gear,
    cut_rack,
    distance_size,
    dots,
    overall_height,
    overall_width,
    pitch_lines,
    section_figure,
)
from gearcad.drawing.words import Draughting
from gearcad.geometry import Gear, GearPair, Rack, RackPair

_ANGLES = 45.0, 135.0
"""Angles of the hatching (degrees): pinion, mate."""

_BESIDE, _WORTH = 1.5, 1.6
"""Shown length of a long rack on either side, over the pinion's tip diameter; and the multiple from which a rack is long."""


@dataclass(frozen=True)
class Placed:
    """A part with the height of its axis, the start of its teeth along the axis, and the radius of its drawn pitch circle
    (mm).

    For a rack the height is that of its reference line, and the radius is the height of the pitch line above it.
    """

    part: Gear | Rack
    height: float
    z: float
    pitch: float
    angle: float

    @property
    def cut(self) -> Cut:
        """Section of the part."""
        if isinstance(self.part, Rack):
            return cut_rack(self.part, self.z, self.height)
        return cut_gear(self.part, self.z, self.height)

    @property
    def sectioned(self) -> Sectioned:
        """Section of the part with hatching and pitch lines."""
        low, high = self.z, self.z + self.part.face_width
        if isinstance(self.part, Rack):
            level = self.height + self.pitch
            return Sectioned(self.cut, self.angle, (((low, level), (high, level)),))
        return Sectioned(self.cut, self.angle, pitch_lines(low, high, self.height, self.pitch))

    @property
    def extent(self) -> Box:
        """Box of the part in the plane of the section (z, height; mm)."""
        return Box.around(point for polygon in self.cut.covers for point in polygon)


@dataclass(frozen=True)
class PairPlaces:
    """The places of pinion and mate."""

    pinion: Placed
    mate: Placed
    rack_start: float = 0.0
    """Position of a rack's left end, from the pinion's axis to the right (mm)."""

    @classmethod
    def of(cls, pair: GearPair | RackPair) -> PairPlaces:
        """Return the places of pinion and mate in mesh. The pitch circles are the working ones, which touch."""
        if isinstance(pair, RackPair):
            pose = pair.rack_pose()
            pinion = Placed(pair.pinion, pair.mounting_distance, 0.0, pair.pitch_radius, _ANGLES[0])
            return cls(pinion, Placed(pair.rack, 0.0, pose.z, pair.pitch_line_height, _ANGLES[1]), pose.y)
        radii = pair.working_pitch_diameters.map(lambda diameter: abs(diameter) / 2)
        pinion = Placed(pair.pinion, abs(pair.centre_distance), 0.0, radii.pinion, _ANGLES[0])
        return cls(pinion, Placed(pair.wheel, 0.0, pair.wheel_pose().z, radii.wheel, _ANGLES[1]))

    @property
    def parts(self) -> tuple[Placed, Placed]:
        return self.pinion, self.mate

    @property
    def extent(self) -> Box:
        """Box of both parts in the plane of the section (z, height; mm)."""
        return Box.of_all(part.extent for part in self.parts)

    @property
    def front(self) -> Box:
        """Box of both parts as seen along their axes (to the right, height; mm)."""
        return Box.of_all(self.front_of(part) for part in self.parts)

    def front_of(self, part: Placed) -> Box:
        """Return the box of one part as seen along the axes (to the right, height; mm)."""
        if isinstance(part.part, Rack):
            left, right = self.shown
            return Box(left, -part.part.height, right, part.part.tip_height)
        return Box(0.0, part.height, 0.0, part.height).grown(FrontView(part.part).reach)

    @property
    def shown(self) -> tuple[float, float]:
        """Shown range of a rack (mm from the pinion's axis to the right): all of it, or only the part beside the pinion."""
        assert isinstance(self.mate.part, Rack) and isinstance(self.pinion.part, Gear)
        left, right = self.rack_start, self.rack_start + self.mate.part.length
        beside = _BESIDE * self.pinion.part.tip_diameter
        return (left, right) if right - left < _WORTH * 2 * beside else (max(left, -beside), min(right, beside))

    @property
    def broken(self) -> tuple[bool, bool]:
        """Whether a rack continues beyond the shown range, at the left and at the right."""
        assert isinstance(self.mate.part, Rack)
        left, right = self.shown
        return left > self.rack_start, right < self.rack_start + self.mate.part.length


def pair_section(pair: GearPair | RackPair, draughting: Draughting, direction: int = 1) -> View:
    """Return the section, with the axis of the wheel or a rack's reference line at height 0. z is to the right, or to the left
    if `direction` is -1.
    """
    places = PairPlaces.of(pair)
    extent = places.extent
    across = Across(draughting.scale, (extent.left + extent.right) / 2, direction)
    outlines = section_figure([part.sectioned for part in places.parts], across)
    figure = outlines + Figure(tuple(_axes(places, across)))
    box = Box.around(across.points((extent[:2], extent[2:])))
    items = {number: dots(part.cut.areas, across) for number, part in enumerate(places.parts, 1)}
    return View("section", figure, (partial(overall_width, box, extent.width, draughting), partial(balloons, items, box)))


def _axes(places: PairPlaces, across: Across) -> Iterator[Line]:
    for part in places.parts:
        if not isinstance(part.part, Rack):
            ends = ((part.extent.left, part.height), (part.extent.right, part.height))
            (left, y), (right, _) = sorted(across.points(ends))
            yield Line((left - BEYOND_AXIS, y), (right + BEYOND_AXIS, y), Pen.CENTRE)


_BEYOND_BREAK = 2.0
"""Length of break lines beyond a rack (mm of paper)."""


def pair_face(pair: GearPair | RackPair, draughting: Draughting) -> View:
    """Return the view from the upper ends, the pinion above, with the centre distance and the overall sizes."""
    places, scale = PairPlaces.of(pair), draughting.scale
    outlines = Figure.of(*(_part_figure(places, part, scale) for part in places.parts))
    whole, box = places.front, _paper(places.front, scale)
    inside = isinstance(pair, GearPair) and pair.internal
    marks: list[Candidates] = [
        partial(_distance, pair, places, draughting),
        partial(overall_height, box, whole.height, draughting, "⌀" if inside else ""),
    ]
    if not inside and not (isinstance(pair, RackPair) and any(places.broken)):
        marks.append(partial(overall_width, box, whole.width, draughting))
    return View("face", outlines + Figure(tuple(_centre_lines(places, scale))), tuple(marks))


def _paper(box: Box, scale: float) -> Box:
    return Box(*(scale * side for side in box))


def _part_figure(places: PairPlaces, part: Placed, scale: float) -> Figure:
    """Return the figure of a gear, or of the body of a rack up to the tips, broken where it continues."""
    if not isinstance(part.part, Rack):
        return FrontView(part.part, (0.0, part.height), (part.pitch,)).figure(scale)
    left, bottom, right, top = _paper(places.front_of(part), scale)
    if not any(places.broken):
        return Figure.of(Polyline.straight([(left, bottom), (right, bottom), (right, top), (left, top)], closed=True))
    ends = [
        zigzag((x, bottom - _BEYOND_BREAK), (x, top + _BEYOND_BREAK)) if broken else Line((x, bottom), (x, top))
        for x, broken in zip((left, right), places.broken, strict=True)
    ]
    return Figure.of(Line((left, bottom), (right, bottom)), Line((left, top), (right, top)), *ends)


def _centre_lines(places: PairPlaces, scale: float) -> Iterator[Shape]:
    """Yield a centre line through both axes and one across each; for a rack its pitch line."""
    whole = _paper(places.front, scale)
    racked = isinstance(places.mate.part, Rack)
    bottom = 0.0 if racked else whole.bottom
    levels = [scale * (part.height + (part.pitch if isinstance(part.part, Rack) else 0.0)) for part in places.parts]
    crossings = ((0.0, level) for level in sorted(levels))
    yield from centre_line((0.0, bottom - BEYOND_AXIS), *crossings, (0.0, whole.top + BEYOND_AXIS)).shapes
    for part, level in zip(places.parts, levels, strict=True):
        box = _paper(places.front_of(part), scale)
        ends = (box.left - BEYOND_AXIS, level), (box.right + BEYOND_AXIS, level)
        yield from centre_line(ends[0], (0.0, level), ends[1]).shapes


def _distance(pair: GearPair | RackPair, places: PairPlaces, draughting: Draughting) -> Iterable[Figure]:
    """Yield dimensions of the centre distance, or of the pinion's axis from the rack's reference line, at the ends of the
    centre lines.
    """
    scale = draughting.scale
    whole = _paper(places.front, scale)
    for side, edge in ((Side.RIGHT, whole.right), (Side.LEFT, whole.left)):
        ends = []
        for part in places.parts:
            box = _paper(places.front_of(part), scale)
            beyond = 0.0 if isinstance(part.part, Rack) else side.outwards * BEYOND_AXIS
            ends.append(((box.right if side is Side.RIGHT else box.left) + beyond, scale * part.height))
        yield from linear_dimension(ends[0], ends[1], side, distance_size(pair), draughting, clear=edge)
