"""A pair seen along its axes: both tip circles in full, neither hides the other; pitch circles that touch (ISO 2203)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial

from gearcad.drawing.assembled import BEYOND_AXIS, Front, distance_size, overall_height, overall_width
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.marks import Side, centre_line, linear_dimension, zigzag
from gearcad.drawing.pair_views.places import PairPlaces, Placed
from gearcad.drawing.shapes import Box, Figure, Line, Polyline, Shape
from gearcad.drawing.words import Draughting
from gearcad.geometry import GearPair, Rack, RackPair

__all__ = ["pair_face"]

_BEYOND_BREAK = 2.0
"""How far lines where a rack is broken reach beyond it (mm of paper)."""


def pair_face(pair: GearPair | RackPair, draughting: Draughting) -> View:
    """Seen from the upper ends, the pinion above; dimensioned with the distance of the axes and the sizes over all."""
    places, scale = PairPlaces.of(pair), draughting.scale
    outlines = Figure.of(*(_drawn(places, part, scale) for part in places.parts))
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


def _drawn(places: PairPlaces, part: Placed, scale: float) -> Figure:
    """A gear; or the body of a rack up to the tips, broken where it goes on."""
    if not isinstance(part.part, Rack):
        return Front(part.part, (0.0, part.height), (part.pitch,)).figure(scale)
    left, bottom, right, top = _paper(places.front_of(part), scale)
    if not any(places.broken):
        return Figure.of(Polyline.straight([(left, bottom), (right, bottom), (right, top), (left, top)], closed=True))
    ends = [
        zigzag((x, bottom - _BEYOND_BREAK), (x, top + _BEYOND_BREAK)) if broken else Line((x, bottom), (x, top))
        for x, broken in zip((left, right), places.broken, strict=True)
    ]
    return Figure.of(Line((left, bottom), (right, bottom)), Line((left, top), (right, top)), *ends)


def _centre_lines(places: PairPlaces, scale: float) -> Iterator[Shape]:
    """One through both axes, one across each; the pitch line of a rack."""
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
    """From axis to axis, or from the pinion's axis to the rack's reference line, at the ends of the centre lines."""
    scale = draughting.scale
    whole = _paper(places.front, scale)
    for side, edge in ((Side.RIGHT, whole.right), (Side.LEFT, whole.left)):
        ends = []
        for part in places.parts:
            box = _paper(places.front_of(part), scale)
            beyond = 0.0 if isinstance(part.part, Rack) else side.outwards * BEYOND_AXIS
            ends.append(((box.right if side is Side.RIGHT else box.left) + beyond, scale * part.height))
        yield from linear_dimension(ends[0], ends[1], side, distance_size(pair), draughting, clear=edge)
