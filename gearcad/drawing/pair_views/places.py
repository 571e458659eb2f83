"""Where the parts of a pair are on paper: the pinion above, both axes on one upright centre line (ISO 2203).

Heights in mm over the axis of the wheel, or over the reference line of a rack; z as `wheel_pose` and `rack_pose` have it.
"""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.drawing.assembled import Cut, Front, Sectioned, cut_gear, cut_rack, pitch_lines
from gearcad.drawing.shapes import Box
from gearcad.geometry import Gear, GearPair, Rack, RackPair

__all__ = ["PairPlaces", "Placed"]

_ANGLES = 45.0, 135.0
"""Of the hatching: pinion, mate."""

_BESIDE, _WORTH = 1.5, 1.6
"""Of a long rack so much is shown on either side, over the pinion's tip diameter; it is long from so many times that on."""


@dataclass(frozen=True)
class Placed:
    """A part, the height of its axis, where its teeth begin along the axis, and the radius of the pitch circle that is drawn.

    Of a rack the height is that of its reference line, and the radius how far the pitch line is above that.
    """

    part: Gear | Rack
    height: float
    z: float
    pitch: float
    angle: float

    @property
    def cut(self) -> Cut:
        """Its section."""
        if isinstance(self.part, Rack):
            return cut_rack(self.part, self.z, self.height)
        return cut_gear(self.part, self.z, self.height)

    @property
    def sectioned(self) -> Sectioned:
        """Its section with hatching and pitch lines."""
        low, high = self.z, self.z + self.part.face_width
        if isinstance(self.part, Rack):
            level = self.height + self.pitch
            return Sectioned(self.cut, self.angle, (((low, level), (high, level)),))
        return Sectioned(self.cut, self.angle, pitch_lines(low, high, self.height, self.pitch))

    @property
    def extent(self) -> Box:
        """What it takes of the plane of the section (z, height)."""
        return Box.around(point for polygon in self.cut.covers for point in polygon)


@dataclass(frozen=True)
class PairPlaces:
    """Pinion and mate."""

    pinion: Placed
    mate: Placed
    rack_start: float = 0.0
    """Where the left end of a rack is, from the pinion's axis to the right (mm)."""

    @classmethod
    def of(cls, pair: GearPair | RackPair) -> PairPlaces:
        """Those in mesh; the pitch circles are the working ones, which touch."""
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
        """What both take of the plane of the section (z, height)."""
        return Box.of_all(part.extent for part in self.parts)

    @property
    def front(self) -> Box:
        """What both take as one sees them along their axes (to the right, height)."""
        return Box.of_all(self.front_of(part) for part in self.parts)

    def front_of(self, part: Placed) -> Box:
        """What one of them takes."""
        if isinstance(part.part, Rack):
            left, right = self.shown
            return Box(left, -part.part.height, right, part.part.tip_height)
        return Box(0.0, part.height, 0.0, part.height).grown(Front(part.part).reach)

    @property
    def shown(self) -> tuple[float, float]:
        """From where to where a rack is shown: all of it, or of a long one what is beside the pinion."""
        assert isinstance(self.mate.part, Rack) and isinstance(self.pinion.part, Gear)
        left, right = self.rack_start, self.rack_start + self.mate.part.length
        beside = _BESIDE * self.pinion.part.tip_diameter
        return (left, right) if right - left < _WORTH * 2 * beside else (max(left, -beside), min(right, beside))

    @property
    def broken(self) -> tuple[bool, bool]:
        """Whether a rack goes on beyond what is shown, at the left and at the right."""
        assert isinstance(self.mate.part, Rack)
        left, right = self.shown
        return left > self.rack_start, right < self.rack_start + self.mate.part.length
