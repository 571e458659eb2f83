"""The sizes beside the view of an external gear along its axis: bore, with what is demanded of it, and keyway."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain

from gearcad.drawing.gear_views.section import BEYOND_AXIS
from gearcad.drawing.marks import (
    FRAME_HEIGHT,
    Characteristic,
    Side,
    circle_dimension,
    datum,
    landing_of,
    linear_dimension,
    roughness_symbol,
    tolerance_frame,
)
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Box, Circle, Figure, Line, Pen
from gearcad.drawing.words import Draughting, Size
from gearcad.geometry import Gear
from gearcad.solids.keyway import keyway_half_angle

__all__ = ["FaceMarks"]

_AIR = 1.0
_OFF_KEYWAY = 4.0
"""Degrees from a corner of the keyway to an arrow at the bore."""

_WAYS = (45.0, 135.0, -45.0, -135.0, 30.0, 150.0, -30.0, -150.0, 60.0, 120.0, -60.0, -120.0, 75.0, 105.0, -75.0, -105.0)


@dataclass(frozen=True)
class FaceMarks:
    """Those of one gear, whose outline is `figure`."""

    gear: Gear
    figure: Figure
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """All of them, the smallest first."""
        return self.keyway_width, self.keyway_depth, self.bore

    def keyway_width(self) -> Iterable[Figure]:
        """With its symmetry to the datum axis A."""
        body = self.gear.body
        half, floor = body.keyway_width / 2, body.bore / 2 + body.keyway_depth
        frame = None
        if (deviation := self.requirements.keyway_symmetry) is not None:
            value = self.draughting.words.shortest(deviation / 1000, 4)
            frame = tolerance_frame(Characteristic.SYMMETRY, value, "A")
        return self._between((-half, floor), (half, floor), (Side.ABOVE,), self.requirements.keyway_width, frame)

    def keyway_depth(self) -> Iterable[Figure]:
        """Across bore and keyway, d + t2."""
        body = self.gear.body
        ends = (0.0, -body.bore / 2), (0.0, body.bore / 2 + body.keyway_depth)
        return self._between(*ends, (Side.RIGHT, Side.LEFT), self.requirements.keyway_depth)

    def _between(
        self,
        first: tuple[float, float],
        second: tuple[float, float],
        sides: tuple[Side, ...],
        size: Size | None,
        frame: Figure | None = None,
    ) -> Iterable[Figure]:
        """A size between two points of the part, where there is room within the outline, else beyond it."""
        if size is None:
            return
        start, end = ((self.draughting.paper(x), self.draughting.paper(y)) for x, y in (first, second))
        inner = max(self.draughting.paper(radius) for radius in self._within)
        for clear in (inner, self._reach):
            for side in sides:
                yield from linear_dimension(start, end, side, size, self.draughting, clear=clear * side.outwards, frame=frame)

    @property
    def _within(self) -> tuple[float, ...]:
        """Radii (mm of the part) of what is about the opening."""
        body = self.gear.body
        return body.opening_diameter / 2, body.hub_diameter / 2

    @property
    def _reach(self) -> float:
        """Of the tip circle on paper."""
        return self.draughting.paper(self.gear.tip_diameter / 2)

    def bore(self) -> Iterator[Figure]:
        """Its diameter, roughness and cylindricity; datum A where run-outs are to it (ISO 5459: at a size it is the axis)."""
        size = self.requirements.bore
        if size is None:
            return
        radius, body = self.draughting.paper(self.gear.body.bore / 2), self.gear.body
        open_at = math.degrees(keyway_half_angle(body)) + _OFF_KEYWAY if body.keyway_width else 0.0
        ways = [way for way in _WAYS if abs(way - 90.0) >= open_at]
        within = circle_dimension((0.0, 0.0), radius, size, self.draughting, ways)
        beyond = circle_dimension((0.0, 0.0), radius, size, self.draughting, ways, beyond=self._reach - radius)
        demands = {to_right: self._of_bore(to_right) for to_right in (True, False)}
        boxes = {to_right: figure.box for to_right, figure in demands.items()}
        found = []
        for led in chain(within, beyond):
            landing = landing_of(led)
            to_right = landing.end[0] > landing.start[0]
            box = boxes[to_right].moved(*landing.end)
            if self._is_free(box):
                grown = self._growth(Box.of_all((box, landing.box)))
                found.append((grown, led, demands[to_right], landing.end))
        for _, led, figure, end in sorted(found, key=lambda each: each[0]):
            yield led + figure.moved(*end)

    def _growth(self, box: Box) -> float:
        """How much more room the view takes with a box: that across counts more, as views stand beside each other."""
        wider = max(0.0, box.right - self._reach) + max(0.0, -box.left - self._reach)
        taller = max(0.0, box.top - self._reach) + max(0.0, -box.bottom - self._reach)
        return wider + 0.5 * taller

    def _of_bore(self, to_right: bool) -> Figure:
        """What stands on and below the line under the diameter, whose end, the one away from the arrow, is at (0, 0)."""
        symbol = roughness_symbol(f"Ra {self.draughting.words.shortest(self.requirements.bore_roughness)}")
        symbol = symbol.moved(_AIR - symbol.box.left if to_right else -_AIR - symbol.box.right, 0.0)
        end = symbol.box.right if to_right else symbol.box.left
        marks, low = [symbol, Figure.of(Line((0.0, 0.0), (end, 0.0), Pen.DIMENSION))], 0.0
        if (deviation := self.requirements.cylindricity) is not None:
            frame = tolerance_frame(Characteristic.CYLINDRICITY, self.draughting.words.shortest(deviation / 1000, 4))
            marks.append(frame.moved(-frame.box.width if to_right else 0.0, -_AIR - FRAME_HEIGHT / 2))
            low = marks[-1].box.bottom
        needed = self.requirements
        if any(each is not None for each in (needed.tip_runout, needed.face_runout, needed.keyway_symmetry)):
            marks.append(next(iter(datum("A", (-FRAME_HEIGHT if to_right else FRAME_HEIGHT, low), Side.BELOW))))
        return Figure.of(*marks)

    def _is_free(self, box: Box) -> bool:
        """Whether no circle and no centre line of the outline passes through a box, and no hub is under it."""
        across, up = max(box.left, -box.right, 0.0), max(box.bottom, -box.top, 0.0)
        nearest = math.hypot(across, up)
        furthest = math.hypot(max(-box.left, box.right), max(-box.bottom, box.top))
        radii = [each.radius for each in self.figure.shapes if isinstance(each, Circle)]
        crossed = any(nearest < radius < furthest for radius in (*radii, self.draughting.paper(max(self._within))))
        on_axis = box.left < 0.0 < box.right or box.bottom < 0.0 < box.top
        return not crossed and not (on_axis and nearest < self._reach + BEYOND_AXIS)
