"""RackPairData: what one gives of a pinion and a rack, and how they then stand to each other by formula (ISO 21771).

A rack is a gear of infinite diameter: its pitch line rolls on the pinion's reference circle at any distance, and the pressure
angle in mesh is that of the rack.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

from gearcad.geometry.backlash import settled
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.geometry.gear import Gear
from gearcad.geometry.rack import Rack
from gearcad.ranges import Range
from gearcad.schema import Words

__all__ = ["OfPinionAndRack", "RackPairData"]

_DISTANCE = Range("mm", 0, None, ends="(]")


class OfPinionAndRack(NamedTuple):
    """A length that both have (mm)."""

    pinion: float
    rack: float


@dataclass(frozen=True, kw_only=True)
class RackPairData:
    """The fields of a `RackPair`, unchecked, and what needs no path of contact. Lengths in mm, angles in degrees."""

    pinion: Gear
    rack: Rack
    mounting_distance: Annotated[float, _DISTANCE, Words("mounting distance to reference line", "H")] = NOT_GIVEN
    name: Annotated[str, Words("name")] = "pair"

    @property
    def pitch_radius(self) -> float:
        """r of the pinion, on which the rack's pitch line rolls."""
        return self.pinion.reference_diameter / 2

    @property
    def pitch_line_height(self) -> float:
        """Where the pitch line is on the rack, above its reference line: H - r."""
        return self.mounting_distance - self.pitch_radius

    @property
    def back_distance(self) -> float:
        """From the pinion's axis to the rack's back."""
        return self.mounting_distance + self.rack.height

    @property
    def common_width(self) -> float:
        """Width over which they face each other, their middles in one plane."""
        return min(self.pinion.face_width, self.rack.face_width)

    @property
    def shifted_distance(self) -> float:
        """r + x m_n: the mounting distance at which the thinning alone gives the backlash."""
        return self.pitch_radius + self.pinion.profile_shift * self.pinion.normal_module

    @property
    def zero_backlash_distance(self) -> float:
        """The mounting distance without backlash: r + x m_n - (A_s1 + A_s2)/(2 tan alpha_n)."""
        thinning = self.pinion.tooth_thinning + self.rack.tooth_thinning
        return self.shifted_distance - thinning / 2 / math.tan(math.radians(self.pinion.rack.pressure_angle))

    @property
    def tip_alteration(self) -> float:
        """k of the pinion that keeps the rack's tip clearance: (H - r)/m_n - x, never positive ("auto" in a spec)."""
        return min(self.pitch_line_height / self.pinion.normal_module - self.pinion.profile_shift, 0.0)

    @property
    def tip_clearances(self) -> OfPinionAndRack:
        """Clearance of each one's tip in the other's root."""
        return OfPinionAndRack(
            self.mounting_distance + self.rack.root_depth - self.pinion.tip_diameter / 2,
            self.mounting_distance - self.rack.tip_height - self.pinion.root_diameter / 2,
        )

    @property
    def circumferential_backlash(self) -> float:
        """j_wt along the pitch line: 2 tan alpha_t (H - r - x m_n) and both thinnings (transverse)."""
        tangent = math.tan(math.radians(self.pinion.transverse_pressure_angle))
        return settled(2 * tangent * (self.mounting_distance - self.zero_backlash_distance), self.mounting_distance)

    @property
    def normal_backlash(self) -> float:
        """j_bn along the base normal: j_wt cos alpha_t cos beta_b."""
        across = math.cos(math.radians(self.pinion.transverse_pressure_angle))
        return self.circumferential_backlash * across * math.cos(math.radians(self.pinion.base_helix_angle))

    # ------------------------------------------------------------------ motion

    @property
    def travel_per_revolution(self) -> float:
        """pi d: how far the rack moves in a turn of the pinion."""
        return math.pi * self.pinion.reference_diameter

    @property
    def travel_per_degree(self) -> float:
        """How far the rack moves per degree of the pinion."""
        return self.travel_per_revolution / 360

    def rack_force(self, torque: float) -> float:
        """Force (N) on the rack along its length for a torque on the pinion (N·m), without losses: 2000 T/d."""
        return 2000 * torque / self.pinion.reference_diameter

    def torque_for(self, force: float) -> float:
        """Torque on the pinion (N·m) for a force along the rack (N), without losses."""
        return force * self.pinion.reference_diameter / 2000

    def rack_speed(self, speed: float) -> float:
        """Speed of the rack (m/s), which is that of the pitch line, for a speed of the pinion (rpm)."""
        return self.travel_per_revolution * speed / 60_000
