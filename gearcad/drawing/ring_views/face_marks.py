"""What stands beside the view of a ring along its axis: its bolt holes and their circle. Each has places, best first."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from gearcad.drawing.marks import Characteristic, circle_dimension, leader, tolerance_frame, with_frame
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.ring_views.face import hole_places
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.shapes import Figure
from gearcad.drawing.words import Draughting

__all__ = ["FaceMarks"]

_BEYOND = (6.0, 12.0, 20.0, 30.0)
"""How far outside the rim a text may be (mm of paper)."""

_OFF_AXIS = 0.15
"""Least sine and cosine of the direction of a leader: not along a centre line."""


@dataclass(frozen=True)
class FaceMarks:
    """Those of a ring."""

    ring: Meridian
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """All of them."""
        return self.bolt_circle, self.bolts

    def bolts(self) -> Iterator[Figure]:
        """To one of the holes, from outside the rim: their number and diameter, and where they are."""
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
        """The frame for where the holes are, to the datum axis A."""
        deviation = self.requirements.bolt_position
        if deviation is None:
            return None
        value = self.draughting.words.shortest(deviation / 1000, 4)
        return tolerance_frame(Characteristic.POSITION, f"⌀{value}", "A")

    def bolt_circle(self) -> Iterator[Figure]:
        """Between holes, its text outside the rim."""
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
