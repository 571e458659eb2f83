"""Gears as one sees them along their axes: circles of tip, pitch, hub and bore (ISO 2203). Lengths in mm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.drawing.gear_views.face import opening
from gearcad.drawing.marks import centre_circle
from gearcad.drawing.ring_views.face import hole_places
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.shapes import Circle, Figure, Pen, Point, Shape
from gearcad.geometry import Gear

__all__ = ["BEYOND_AXIS", "Front"]

BEYOND_AXIS = 6.0
"""How far centre lines reach beyond what they belong to (mm of paper)."""


@dataclass(frozen=True)
class Front:
    """A gear seen from its upper end: where its axis is (mm of the part), and the radii of the pitch circles drawn (mm).

    Its keyway or first bolt hole is up. `tip` is the pen of its tip circle; a `bare` one has nothing but tip and pitch circles.
    """

    gear: Gear
    centre: Point = (0.0, 0.0)
    pitch_radii: tuple[float, ...] = ()
    tip: Pen = Pen.OUTLINE
    bare: bool = False

    @property
    def reach(self) -> float:
        """Radius of all of it (mm)."""
        return Meridian(self.gear, 1.0).rim if self.gear.internal else self.gear.tip_diameter / 2

    def figure(self, scale: float) -> Figure:
        """Without centre lines."""
        gear, at = self.gear, (scale * self.centre[0], scale * self.centre[1])
        shapes: list[Shape] = [Circle(at, scale * gear.profile.tip_diameter / 2, self.tip)]
        shapes += (Circle(at, scale * radius, Pen.CENTRE) for radius in self.pitch_radii)
        if self.bare:
            return Figure(tuple(shapes))
        shapes += (shape.moved(*at) for shape in (_rim(gear, scale) if gear.internal else _disc(gear, scale)))
        return Figure(tuple(shapes))


def _disc(gear: Gear, scale: float) -> Iterator[Shape]:
    body = gear.body
    if body.hub_ends[1]:
        yield Circle((0.0, 0.0), scale * body.hub_diameter / 2)
    yield from opening(body, scale)


def _rim(gear: Gear, scale: float) -> Iterator[Shape]:
    ring = Meridian(gear, scale)
    yield Circle((0.0, 0.0), scale * ring.rim, Pen.THIN if ring.is_open else Pen.OUTLINE)
    if ring.holes is not None:
        places = hole_places(ring)
        yield from centre_circle(scale * sum(ring.holes) / 2, places).shapes
        yield from (Circle(place, scale * gear.body.bolt_diameter / 2) for place in places)
