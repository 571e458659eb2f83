"""The sizes beside the half section of an external gear. Each has places, best first."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain

from gearcad.drawing.gear_views.meridian import Corner, overall
from gearcad.drawing.gear_views.silhouette import Silhouette
from gearcad.drawing.marks import Side, leader, linear_dimension
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Figure
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry.body import HubSide
from gearcad.solids.cone import EndCone

__all__ = ["SectionSizes"]

_ABOVE_FIRST, _BELOW_FIRST = (Side.ABOVE, Side.BELOW), (Side.BELOW, Side.ABOVE)

_LONG_EXTENSION = 40.0
"""Extension lines that are longer go to the other side, if there is room (mm of paper)."""

_BEYOND = (8.0, 16.0, 26.0, 40.0)
"""How far beyond the outline a leader from within it may end (mm of paper)."""


_BELOW_TEETH = (7.0, 12.0, 18.0)
"""How far below the teeth it may end."""


@dataclass(frozen=True)
class SectionSizes:
    """Those that a gear has."""

    outline: Silhouette
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """All of them, those nearest to the outline first."""
        lengths = (self.gap_width, self.half_width, self.hub_length, self.face_width, self.hub_width)
        return *lengths, self.hub_diameter, self.tip, self.gap_diameter, self.end_chamfer

    def face_width(self) -> Iterator[Figure]:
        corner, ends = self.outline.corner, (0.0, self.outline.gear.face_width)
        return self._length((ends[0], corner), (ends[1], corner), self._overall, self.requirements.face_width)

    @property
    def _overall(self) -> tuple[Side, ...]:
        """Where lengths over all stand: beyond those of the halves where a gap parts them, whose leader comes from below."""
        return _ABOVE_FIRST if self.requirements.gap_width else _BELOW_FIRST

    def hub_width(self) -> Iterator[Figure]:
        """Over all, where hubs stand out."""
        (low, high), width = overall(self.outline.gear), self.outline.gear.face_width
        hub, corner = self.outline.gear.body.hub_diameter / 2, self.outline.corner
        ends = (low, hub if low < 0 else corner), (high, hub if high > width else corner)
        return self._length(*ends, self._overall, self.requirements.hub_width)

    def hub_length(self) -> Iterator[Figure]:
        """How far one of two hubs stands out; of a single one face width and the width over all say it."""
        body = self.outline.gear.body
        size = Size(value=body.hub_length) if body.hub_length and body.hub_side is HubSide.BOTH else None
        start = self.outline.tooth_ends[0]
        return self._length((self.outline.ends[0], body.hub_diameter / 2), (start, self.outline.corner), _ABOVE_FIRST, size)

    def gap_width(self) -> Iterator[Figure]:
        between = self.outline.gear.half_width, self.outline.gear.face_width - self.outline.gear.half_width
        start, end = ((height, self.outline.corner) for height in between)
        return self._length(start, end, _ABOVE_FIRST, self.requirements.gap_width)

    def half_width(self) -> Iterator[Figure]:
        """Of one half: where the gap is."""
        gear, corner = self.outline.gear, self.outline.corner
        size = Size(value=gear.half_width) if self.requirements.gap_width else None
        lower, upper = (0.0, gear.half_width), (gear.face_width - gear.half_width, gear.face_width)
        for side in _ABOVE_FIRST:
            for start, end in (lower, upper):
                yield from self._length((start, corner), (end, corner), (side,), size)

    def _length(self, start: Corner, end: Corner, sides: tuple[Side, ...], size: Size | None) -> Iterator[Figure]:
        """A size along the axis, above or below the outline."""
        if size is None:
            return
        for side in sides:
            first, second = (self.outline.along.point(height, side.outwards * radius) for height, radius in (start, end))
            yield from linear_dimension(first, second, side, size, self.draughting, clear=self.outline.top * side.outwards)

    def hub_diameter(self) -> Iterable[Figure]:
        """On the side where it stands out."""
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
        """One whose edges are at a height along the axis, at the left or at the right."""
        if size is None:
            return ()
        clear = self.outline.left if side is Side.LEFT else self.outline.right
        low, high = (self.outline.along.point(height, up) for up in (-radius, radius))
        return linear_dimension(low, high, side, size, self.draughting, clear=clear)

    def gap_diameter(self) -> Iterator[Figure]:
        """A leader to the floor of the groove that is seen from outside: out of the groove, else across the teeth."""
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
        """A leader to one of the chamfers, from outside."""
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
