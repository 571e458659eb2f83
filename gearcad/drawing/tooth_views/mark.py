"""Where the detail of a tooth is taken from: a ring round a tooth, and the letter of the detail (ISO 128-3)."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.drawing.shapes import Anchor, Circle, Figure, Line, Pen, Point, Text
from gearcad.drawing.subject import DrawnGear
from gearcad.geometry import Gear, Rack

__all__ = ["DETAIL", "detail_mark"]

DETAIL = "Z"

_LEAST_RING, _LETTER = 3.0, 5.0
"""Radius of the smallest ring, height of the letter (mm of paper)."""

_AIR = 1.0
_ROUND = (150.0, 120.0, -150.0, -120.0, 30.0, 60.0, -30.0, -60.0)
"""Directions from the axis (degrees) in which a tooth of a gear may be, none of them along a centre line."""

_BESIDE = (60.0, -60.0, -90.0, 90.0, 120.0, -120.0, 0.0, 180.0)
"""Directions from the tooth of a rack to the letter."""


def detail_mark(drawn: DrawnGear, view: Figure, scale: float, letter: str = DETAIL) -> Iterator[Figure]:
    """On the `view` along the axis, the axis at the origin; of a rack on that from its front, whose reference line is at
    height 0."""
    gear = drawn.gear
    places = _of_rack(gear, view, scale) if isinstance(gear, Rack) else _of_gear(gear, scale)
    for centre, radius, (across, up) in places:
        out = radius + 0.8 * _LETTER
        text = Text(letter, (centre[0] + out * across, centre[1] + out * up), _LETTER, Anchor.MIDDLE, pen=Pen.TEXT)
        yield Figure.of(Circle(centre, radius, Pen.THIN), text)


def _of_gear(gear: Gear, scale: float) -> Iterator[tuple[Point, float, Point]]:
    """Middle and radius of rings, and the way from there to the letter: off the teeth."""
    tip, root = (scale * abs(diameter) / 2 for diameter in (gear.tip_diameter, gear.root_diameter))
    side = -1.0 if gear.internal else 1.0
    for way in _ways(gear, (tip + root) / 2, _ring(tip, root) + scale * gear.body.bolt_diameter / 2, scale):
        out = math.cos(math.radians(way)), math.sin(math.radians(way))
        middle = (tip + root) / 2 * out[0], (tip + root) / 2 * out[1]
        yield middle, _ring(tip, root), (side * out[0], side * out[1])


def _ways(gear: Gear, middle: float, reach: float, scale: float) -> list[float]:
    """Return the directions of teeth, those first whose ring, at radius `middle`, is not over a bolt hole (mm of paper)."""
    count, circle = gear.body.bolt_holes, scale * gear.body.bolt_circle / 2
    if not count:
        return list(_ROUND)
    step = 360.0 / count  # the first hole is above the axis

    def overlap(way: float) -> float:
        off = math.radians((way - 90.0 + step / 2) % step - step / 2)
        return max(0.0, reach - math.hypot(circle - middle * math.cos(off), middle * math.sin(off)))

    between = [90.0 + step * (math.floor((way - 90.0) / step) + 0.5) for way in _ROUND]
    return sorted(dict.fromkeys((*_ROUND, *between)), key=overlap)


def _of_rack(rack: Rack, view: Figure, scale: float) -> Iterator[tuple[Point, float, Point]]:
    """A tooth with an upright centre line, of which there are some; the letter above it, or in the body below."""
    top, root = scale * rack.tip_height, -scale * rack.root_depth
    centres = [each for each in view.shapes if isinstance(each, Line) and each.pen is Pen.CENTRE]
    middles = list(dict.fromkeys(each.start[0] for each in centres if each.start[0] == each.end[0]))
    for way in _BESIDE:
        for along in reversed(middles or [0.0]):
            yield (along, (top + root) / 2), _ring(top, root), (math.cos(math.radians(way)), math.sin(math.radians(way)))


def _ring(tip: float, root: float) -> float:
    return max(_LEAST_RING, abs(tip - root) / 2 + _AIR)
