"""The view of a ring along its axis, a bolt hole up (ISO 2203)."""

from __future__ import annotations

import math

from gearcad.drawing.marks import centre_circle, centre_star, freehand
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.ring_views.section import BEYOND_AXIS
from gearcad.drawing.shapes import Box, Circle, Figure, Pen, Point, Shape

__all__ = ["end_face", "hole_places"]

_BEYOND_HOLE = 2.0
"""How far the centre line of a hole reaches beyond it (mm of paper)."""

_SIDES = 90
"""Corners of the polygon along which an open rim is drawn by hand."""


def end_face(ring: Meridian) -> Figure:
    """Outlines and centre lines, the axis at the origin."""
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
    """Where the bolt holes are on paper, the first one above the axis."""
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
    """Of the ring and its bolt holes, with their circle."""
    reach, body = ring.scale * ring.rim + BEYOND_AXIS, ring.gear.body
    places = hole_places(ring)
    star = centre_star(Box(-reach, -reach, reach, reach), places, ring.scale * body.bolt_diameter / 2 + _BEYOND_HOLE)
    return star + centre_circle(ring.scale * body.bolt_circle / 2, places) if places else star
