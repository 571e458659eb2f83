"""The tooth thickness s_t as a dimension on the detail of a tooth, along its reference circle. Lengths in mm of paper."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.drawing.marks import ARROW, Written, arrow, plain, symbol
from gearcad.drawing.shapes import Anchor, Figure, Line, Pen, Point
from gearcad.drawing.tooth_views.placing import Placing
from gearcad.drawing.words import Draughting
from gearcad.geometry import Gear, Rack

__all__ = ["thickness_dimension"]

_TEXT = 2.5
_AIR = 1.2
"""Between text and lines."""

_BELOW, _ABOVE = 6.0, 3.0
"""How far the dimension line is from the reference circle, towards the root: the text stands above the line."""

_LIFT = 0.9
"""From the dimension line to the text above it."""

_OVER = 1.5
"""How far its extension lines go on."""

_TAIL = 7.0
"""Length of the lines behind arrows that stand outside."""


@dataclass(frozen=True)
class _Line:
    """The dimension line: a circle or line at `height` between the places of the flanks, `half` from the middle."""

    place: Placing
    height: float
    half: float

    def point(self, aside: float) -> Point:
        return self.place.point(self.height, aside)

    def arrow(self, end: float, tail: float) -> Figure:
        """An arrow that points from `tail` to `end`."""
        tip, back = self.point(end), self.point(tail)
        return Figure.of(arrow(tip, (tip[0] - back[0], tip[1] - back[1])))

    def line(self, start: float, end: float) -> Figure:
        return Figure.of(self.place.level(self.height, start, end, Pen.DIMENSION))


def thickness_dimension(gear: Gear | Rack, place: Placing, draughting: Draughting) -> Figure:
    """Between the flanks where there is room for its text, else to the left of them.

    In brackets, as its limits are in the gear data. Nothing where the reference circle is not on the tooth.
    """
    reference = 0.0 if isinstance(gear, Rack) else gear.profile.reference_diameter / 2
    half = place.flank(reference)
    if half is None:
        return Figure()
    inwards = _ABOVE if place.root > reference else -_BELOW
    line = _Line(place, reference + inwards / place.scale, half)
    value = plain(draughting.words.number(gear.transverse_tooth_thickness, 3) + ")", _TEXT)
    text = symbol("(s_t", _TEXT).then(value, 1.0)
    room = line.point(half)[0] - line.point(-half)[0]
    over = line.height + (_OVER if inwards > 0 else -_OVER) / place.scale
    extensions = (Line(place.point(reference, side), place.point(over, side), Pen.DIMENSION) for side in (-half, half))
    return Figure.of(*extensions, _between(line, text) if room >= text.width + 2 * _AIR else _aside(line, text, room))


def _between(line: _Line, text: Written) -> Figure:
    x, y = line.point(0.0)
    arrows = line.arrow(-line.half, 0.0), line.arrow(line.half, 0.0)
    return Figure.of(line.line(-line.half, line.half), *arrows, text.at((x, y + _LIFT + text.below), Anchor.CENTRE))


def _aside(line: _Line, text: Written, room: float) -> Figure:
    """The text to the left of the half space."""
    end = line.place.further(-max(line.place.middle_of_space, line.half), -_AIR)
    x, y = line.point(end)
    outline = (*line.place.outline().points, *line.place.limit)
    left = min([x, *(across for across, up in outline if abs(up - y) < text.height)]) - _AIR
    words = Figure.of(Line((x, y), (left, y), Pen.DIMENSION), text.at((left - _AIR, y), Anchor.MIDDLE_RIGHT))
    if room >= 3 * ARROW:
        arrows = line.arrow(-line.half, 0.0), line.arrow(line.half, 0.0)
        return Figure.of(line.line(end, line.half), *arrows, words)
    right = line.place.further(line.half, _TAIL)
    arrows = line.arrow(-line.half, line.place.further(-line.half, -_TAIL)), line.arrow(line.half, right)
    return Figure.of(line.line(end, right), *arrows, words)
