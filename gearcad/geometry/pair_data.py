"""PairData: what one gives of a pair of gears, and how they then stand to each other by formula (ISO 21771)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, NamedTuple

from gearcad.geometry.backlash import Backlash, BacklashLimits, backlash, settled
from gearcad.geometry.centre_distance_tolerance import centre_distance_allowance
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.geometry.gear import Gear
from gearcad.geometry.profile import base_half_angle
from gearcad.geometry.shift import profile_shift_sum, zero_backlash_centre_distance
from gearcad.per_gear import PerGear
from gearcad.ranges import OFFSET, Range
from gearcad.schema import Words

__all__ = ["CommonWidth", "PairData"]


_DISTANCE = Range("mm", None, None)


class CommonWidth(NamedTuple):
    """Width (mm) over which the gears face each other, and the offset (mm) of its middle from the pinion's middle.

    Of double helical gears that of both halves together, without the gap.
    """

    width: float
    offset: float


@dataclass(frozen=True, kw_only=True)
class PairData:
    """The fields of a `GearPair`, unchecked, and what needs no path of contact. Lengths in mm, angles in degrees.

    With a ring as the wheel gear ratio, centre distance and the wheel's pitch diameter are negative (ISO 21771).
    """

    pinion: Gear
    wheel: Gear
    centre_distance: Annotated[float, _DISTANCE, Words("centre distance", "a", "5.2")] = NOT_GIVEN
    axial_offset: Annotated[float, OFFSET, Words("axial offset of the wheel")] = 0.0
    centre_distance_tolerance: Annotated[str | None, Words("tolerance of the centre distance", "", "DIN 3964")] = None
    name: Annotated[str, Words("name")] = "pair"

    @property
    def gears(self) -> PerGear[Gear]:
        """Pinion and wheel."""
        return PerGear(self.pinion, self.wheel)

    @property
    def internal(self) -> bool:
        """Whether the wheel is a ring."""
        return self.wheel.internal

    @property
    def double_helical(self) -> bool:
        """Whether the teeth of both gears have two halves of opposite hand."""
        return all(gear.double_helix.present for gear in self.gears)

    # ------------------------------------------------------------------ working data

    @property
    def gear_ratio(self) -> float:
        """u = z_2/z_1."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def reference_centre_distance(self) -> float:
        """a_d = (d_1 + d_2)/2."""
        return (self.pinion.reference_diameter + self.wheel.reference_diameter) / 2

    @property
    def profile_shift_sum(self) -> float:
        """x_1 + x_2 of the gears."""
        return self.pinion.profile_shift + self.wheel.profile_shift

    @property
    def zero_backlash_shift_sum(self) -> float:
        """x_1 + x_2 that would mesh without backlash at this centre distance (no thinning)."""
        return settled(profile_shift_sum(**self._sizes, centre_distance=self.centre_distance), self._modules)

    @property
    def _modules(self) -> float:
        """The centre distance in normal modules."""
        return self.centre_distance / self.pinion.normal_module

    @property
    def _sizes(self) -> dict[str, Any]:
        """What the formulas of profile shift and centre distance want to know of both gears."""
        return {
            "normal_module": self.pinion.normal_module,
            "teeth": self.gears.map(lambda gear: gear.teeth),
            "helix_angle": self.pinion.helix_angle,
            "pressure_angle": self.pinion.rack.pressure_angle,
        }

    @property
    def thinning_as_shift(self) -> float:
        """Change of the shift sum that thins the teeth as much as their tooth thinning does."""
        thinning = self.pinion.tooth_thinning + self.wheel.tooth_thinning
        return thinning / (2 * self.pinion.normal_module * math.tan(math.radians(self.pinion.rack.pressure_angle)))

    @cached_property
    def fitting_shift_sum(self) -> float:
        """x_1 + x_2 that would mesh without backlash at this centre distance with the thinning there is."""
        return self.zero_backlash_shift_sum + self.thinning_as_shift

    def centre_distance_for(self, shift_sum: float) -> float:
        """The one at which these gears would mesh without backlash if x_1 + x_2 were `shift_sum` (no thinning)."""
        return zero_backlash_centre_distance(**self._sizes, shift_sum=shift_sum)

    @cached_property
    def working_transverse_pressure_angle(self) -> float:
        """cos alpha_wt = (d_b1 + d_b2)/(2 a)."""
        cosine = (self.pinion.base_diameter + self.wheel.base_diameter) / (2 * self.centre_distance)
        return math.degrees(math.acos(cosine))

    @property
    def working_pitch_diameters(self) -> PerGear[float]:
        """d_w1 = 2 a/(1 + u), d_w2 = u d_w1."""
        pinion = 2 * self.centre_distance / (1 + self.gear_ratio)
        return PerGear(pinion, self.gear_ratio * pinion)

    @property
    def tip_alteration(self) -> float:
        """k that keeps the rack's tip clearance: (a - a_d)/m_n - (x_1 + x_2), never positive ("auto" in a spec).

        With a ring that is never negative where flanks do not overlap, so there is nothing to shorten.
        """
        if self.internal:
            return 0.0
        change = (self.centre_distance - self.reference_centre_distance) / self.pinion.normal_module
        return min(settled(change - self.profile_shift_sum, self._modules), 0.0)

    @property
    def tip_clearances(self) -> PerGear[float]:
        """Clearance of each gear's tip in the mate's root."""
        return PerGear(
            self.centre_distance - (self.pinion.tip_diameter + self.wheel.root_diameter) / 2,
            self.centre_distance - (self.wheel.tip_diameter + self.pinion.root_diameter) / 2,
        )

    @property
    def circumferential_backlash(self) -> float:
        """j_wt: working pitch less both tooth thicknesses on the working pitch circles (transverse)."""
        return self._nominal_backlash.circumferential

    @property
    def normal_backlash(self) -> float:
        """j_bn along the base normal: j_wt cos alpha_wt cos beta_b."""
        return self._nominal_backlash.normal

    @cached_property
    def _nominal_backlash(self) -> Backlash:
        return Backlash(*(settled(each, self.centre_distance) for each in self._backlash()))

    def _backlash(self, thicker: float = 0.0, farther: float = 0.0) -> Backlash:
        """That of teeth `thicker` by a share of half their tolerances, with axes `farther` apart (mm)."""

        def half_angle(gear: Gear) -> float:
            allowance = gear.thickness_allowance
            if allowance is None or not thicker:
                return gear.base_half_angle
            thickness = gear.normal_tooth_thickness + thicker * allowance.tolerance / 2000
            return base_half_angle(gear.teeth, thickness, gear.normal_module, gear.transverse_pressure_angle)

        return backlash(
            teeth=self.gears.map(lambda gear: gear.teeth),
            base_half_angles=self.gears.map(half_angle),
            base_diameters=self.gears.map(lambda gear: gear.base_diameter),
            base_helix_angle=self.pinion.base_helix_angle,
            centre_distance=self.centre_distance + farther,
        )

    @property
    def centre_distance_allowance(self) -> float:
        """A_a (µm, ±) of `centre_distance_tolerance`; 0 without one."""
        name = self.centre_distance_tolerance
        return 0.0 if name is None else centre_distance_allowance(name, self.centre_distance)

    @cached_property
    def backlash_limits(self) -> BacklashLimits | None:
        """Backlash at the least and at the most; None where neither tooth thickness nor centre distance has a tolerance."""
        if self.centre_distance_tolerance is None and not any(gear.tooth_allowance for gear in self.gears):
            return None
        apart = self.centre_distance_allowance / 1000
        # The backlash falls with thicker teeth; with a ring it falls where the axes are farther apart.
        least = min(self._backlash(1.0, farther) for farther in (-apart, apart))
        most = max(self._backlash(-1.0, farther) for farther in (-apart, apart))
        return BacklashLimits(
            self.centre_distance_allowance, least.circumferential, most.circumferential, least.normal, most.normal
        )

    @cached_property
    def common_width(self) -> CommonWidth:
        """Common face width and where its middle lies, seen from the pinion's middle."""
        own, mate = self.pinion.face_width / 2, self.wheel.face_width / 2
        if self.double_helical:
            gap = max(gear.double_helix.gap_width or 0.0 for gear in self.gears)
            return CommonWidth(2 * min(own, mate) - gap, 0.0)
        low, high = max(-own, self.axial_offset - mate), min(own, self.axial_offset + mate)
        return CommonWidth(high - low, (high + low) / 2)
