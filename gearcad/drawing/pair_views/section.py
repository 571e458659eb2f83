"""The section of a pair through both axes: the pinion's teeth in front, what they hide dashed (ISO 2203)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from gearcad.drawing.assembled import BEYOND_AXIS, Across, balloons, dots, overall_width, section_figure
from gearcad.drawing.layout import View
from gearcad.drawing.pair_views.places import PairPlaces
from gearcad.drawing.shapes import Box, Figure, Line, Pen
from gearcad.drawing.words import Draughting
from gearcad.geometry import GearPair, Rack, RackPair

__all__ = ["pair_section"]


def pair_section(pair: GearPair | RackPair, draughting: Draughting, direction: int = 1) -> View:
    """The axis of the wheel, or a rack's reference line, at height 0; z to the right, or to the left if `direction` is -1."""
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
