"""PairData: what is given of a pair, its profile shifts, centre distance and backlash (ISO 21771).

On plain numbers, signed as in ISO 21771: teeth of an internal gear, its radii and the centre distance of its pair are negative.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, as_choice, at_least, at_most
from gearcad.core.quantities import NOT_GIVEN, OFFSET, Range, Words
from gearcad.core.records import Floats, PerGear, Role
from gearcad.core.values import (
    Values,
    arccos,
    arctan,
    cos,
    degrees,
    radians,
    smaller,
)
from gearcad.geometry.fits import Backlash, BacklashLimits, backlash, centre_distance_allowance, settled
from gearcad.geometry.gear import Gear
from gearcad.geometry.involute import base_half_angle, inverse_involute, involute, root_between, tangent_length
from gearcad.geometry.path_of_contact import BaseTangent, Mated, MatedPair, PathOfContact
from gearcad.geometry.toothed import GearSizes

_FULL = PerGear(1.0, 1.0)
"""Addenda of both gears by ISO 53, in normal modules."""


class ShiftSplit(Enum):
    """Split of a shift sum: equal shifts, all of it on the pinion, or equal specific sliding at both roots."""

    EQUAL = "equal"
    PINION = "pinion"
    EQUAL_SPECIFIC_SLIDING = "equal_specific_sliding"


def transverse_section(
    normal_module: Values, teeth: Values, helix_angle: Values, pressure_angle: float
) -> tuple[Values, Values, Values]:
    """Reference radius (mm), base radius (mm) and transverse pressure angle (deg)."""
    cosine = cos(radians(helix_angle))
    angle = arctan(math.tan(math.radians(pressure_angle)) / cosine)
    radius = normal_module * teeth / cosine / 2
    return radius, radius * cos(angle), degrees(angle)


def shift_sum_between(teeth: Values, transverse_angle: Values, working_angle: Values, pressure_angle: float) -> Values:
    """x_1 + x_2 = (z_1 + z_2)(inv alpha_wt - inv alpha_t)/(2 tan alpha_n); `teeth` z_1 + z_2, angles in degrees."""
    rise = involute(working_angle) - involute(transverse_angle)
    return teeth * rise / (2 * math.tan(math.radians(pressure_angle)))


def working_involute(shift_sum: Values, teeth: Values, transverse_angle: Values, pressure_angle: float) -> Values:
    """inv alpha_wt = inv alpha_t + 2 tan alpha_n (x_1 + x_2)/(z_1 + z_2); not above 0 where nothing meshes without backlash."""
    limit = _shift_sum_limit(teeth, transverse_angle, pressure_angle)
    return 2 * math.tan(math.radians(pressure_angle)) * (shift_sum - limit) / teeth


def _shift_sum_limit(teeth: Values, transverse_angle: Values, pressure_angle: float) -> Values:
    return -teeth * involute(transverse_angle) / (2 * math.tan(math.radians(pressure_angle)))


def profile_shift_sum(
    *, normal_module: float, teeth: PerGear[int], helix_angle: float, pressure_angle: float, centre_distance: float
) -> float:
    """x_1 + x_2 that meshes without backlash at `centre_distance` (mm); angles in degrees (ISO 21771).

    See `shift_sum_between`. Raises GeometryError where the base circles would overlap.
    """
    _, base, angle = transverse_section(normal_module, float(sum(teeth)), helix_angle, pressure_angle)
    if abs(centre_distance) <= abs(base):
        permitted = f"must be {_beyond(base, teeth)} mm, where the base circles touch"
        raise GeometryError("centre_distance", centre_distance, permitted, "mm")
    return shift_sum_between(float(sum(teeth)), angle, math.degrees(math.acos(base / centre_distance)), pressure_angle)


def zero_backlash_centre_distance(
    *, normal_module: float, teeth: PerGear[int], helix_angle: float, pressure_angle: float, shift_sum: float
) -> float:
    """Return the centre distance (mm) at which teeth with this shift sum mesh without backlash; angles in degrees (ISO 21771).

    a = a_d cos alpha_t/cos alpha_wt, see `working_involute`. Raises GeometryError for a sum so far off that there is none.
    """
    _, base, angle = transverse_section(normal_module, float(sum(teeth)), helix_angle, pressure_angle)
    value = working_involute(shift_sum, float(sum(teeth)), angle, pressure_angle)
    if value <= 0:
        limit = shift_sum_limit(teeth=teeth, helix_angle=helix_angle, pressure_angle=pressure_angle)
        permitted = f"must be {_beyond(limit, teeth)}: no centre distance meshes without backlash"
        raise GeometryError("profile_shift_sum", shift_sum, permitted)
    return base / math.cos(math.radians(inverse_involute(value)))


def shift_sum_limit(*, teeth: PerGear[int], helix_angle: float, pressure_angle: float) -> float:
    """x_1 + x_2 at which inv alpha_wt is 0 and the base circles touch: the least that meshes, or with a ring the most."""
    _, _, angle = transverse_section(1.0, float(sum(teeth)), helix_angle, pressure_angle)
    return _shift_sum_limit(float(sum(teeth)), angle, pressure_angle)


def _beyond(limit: float, teeth: PerGear[int]) -> str:
    """Return, in words, the side of a limit on which the teeth mesh: above for external teeth, below for internal teeth."""
    return f"above {at_least(limit)}" if sum(teeth) > 0 else f"below {at_most(limit)}"


def specific_sliding(
    *, teeth: PerGear[int], base_radii: PerGear[float], tip_radii: PerGear[float], centre_distance: float
) -> PerGear[float]:
    """Return the largest specific sliding at the roots of pinion (in A) and wheel (in E); radii and distance in mm.

    zeta = 1 - (z_own/z_mate) (rho_mate/rho_own). Minus infinity where a tip reaches the base tangent point.
    """
    whole = math.copysign(math.sqrt(centre_distance**2 - sum(base_radii) ** 2), centre_distance)

    def sliding(own: Role) -> float:
        tip, base = tip_radii.pick(own.mate), base_radii.pick(own.mate)
        reach = math.copysign(math.sqrt(max(tip**2 - base**2, 0.0)), base)
        ratio, rest = teeth.pick(own) / teeth.pick(own.mate), whole - reach
        return 1 - ratio * reach / rest if rest * teeth.pick(own) > 0 else -math.inf

    return PerGear.each(sliding)


def split_profile_shift(
    total: float,
    split: ShiftSplit,
    *,
    normal_module: float,
    teeth: PerGear[int],
    helix_angle: float,
    pressure_angle: float,
    centre_distance: float,
    addenda: PerGear[float] = _FULL,
    tip_alteration: float = 0.0,
) -> PerGear[float]:
    """Shifts x_1 and x_2 that add up to `total`, shared by the rule `split`.

    `addenda` h_aP* of both racks and `tip_alteration` k (normal modules) fix the tips for equal specific sliding.
    Raises GeometryError where no split balances the sliding.
    """
    split = as_choice("split", split, ShiftSplit)
    if split is ShiftSplit.EQUAL:
        return PerGear(total / 2, total / 2)
    if split is ShiftSplit.PINION:
        return PerGear(total, 0.0)

    references, bases, _ = zip(*(transverse_section(normal_module, z, helix_angle, pressure_angle) for z in teeth), strict=True)

    def imbalance(first: float) -> float:
        rises = (addendum + x + tip_alteration for addendum, x in zip(addenda, (first, total - first), strict=True))
        tips = PerGear(*(radius + normal_module * rise for radius, rise in zip(references, rises, strict=True)))
        pinion, wheel = specific_sliding(
            teeth=teeth, base_radii=PerGear(*bases), tip_radii=tips, centre_distance=centre_distance
        )
        return math.atan(pinion) - math.atan(wheel)

    low, high = total / 2 - 2.5, total / 2 + 2.5
    if imbalance(low) >= 0 or imbalance(high) <= 0:
        raise GeometryError("profile_shift", "auto", "no split gives equal specific sliding: choose the shifts yourself")
    first = root_between(imbalance, low, high, xtol=1e-14)
    return PerGear(first, total - first)


def farthest_centre_distance(base_diameters: PerGear[float], tip_diameters: PerGear[float]) -> float:
    """Return the centre distance (mm) at which the path of contact vanishes:
    both tip form circles meet on the line of action.
    """
    tangents = PerGear.each(lambda role: tangent_length(tip_diameters.pick(role), base_diameters.pick(role)))
    return math.hypot(sum(base_diameters) / 2, sum(tangents))


class PairSizes(Mated[Values]):
    """Sizes of pairs of gears that follow by formula: of one pair, or arrays of many."""

    centre_distance: Values

    @property
    def gears(self) -> PerGear[GearSizes[Values]]:
        """Pinion and wheel."""
        raise NotImplementedError

    @property
    def _base_pitch(self) -> Values:
        return self.gears.pinion.transverse_base_pitch

    @property
    def gear_ratio(self) -> Values:
        """Gear ratio u = z_2/z_1."""
        return self.gears.wheel.teeth / self.gears.pinion.teeth

    @cached_property
    def working_transverse_pressure_angle(self) -> Values:
        """cos alpha_wt = (d_b1 + d_b2)/(2 a); 0 where the base circles overlap."""
        pinion, wheel = self.gears
        return degrees(arccos(smaller((pinion.base_diameter + wheel.base_diameter) / (2 * self.centre_distance), 1.0)))

    @cached_property
    def base_tangent(self) -> BaseTangent[Values]:
        """The common tangent of the base circles, the line of action."""
        bases, pitch = self.gears.map(lambda gear: gear.base_diameter), self.gears.pinion.transverse_base_pitch
        return BaseTangent(bases, self.centre_distance, self.working_transverse_pressure_angle, pitch)

    @cached_property
    def path_of_contact(self) -> PathOfContact[Values]:
        """A, B, C, D, E on the line of action between the tip (form) circles, as distances from T1 (mm)."""
        return self.base_tangent.path(self.gears.map(lambda gear: gear.tip_form_diameter))

    def rolling_speeds(self, distances: ArrayLike) -> PerGear[Floats]:
        """Velocities (n,) of both flanks along their common tangent (mm per radian of the pinion) at distances (mm) from T1."""
        along = np.atleast_1d(np.asarray(distances, float))
        return PerGear(along, (self.base_tangent.length - along) * self.gears.pinion.teeth / self.gears.wheel.teeth)


def clearance_alteration(apart: Values, normal_module: Values, shift_sum: Values) -> Values:
    """k = (a - a_d)/m_n - (x_1 + x_2) of both gears, that keeps the tip clearance of the rack; `apart` is a - a_d (mm)."""
    return apart / normal_module - shift_sum


_DISTANCE = Range("mm", None, None)


class CommonWidth(NamedTuple):
    """Width (mm) over which the gears face each other, and the offset (mm) of its middle from the pinion's middle.

    Of double helical gears that of both halves together, without the gap.
    """

    width: float
    offset: float


@dataclass(frozen=True, kw_only=True)
class PairData(PairSizes[float], MatedPair):
    """The fields of a `GearPair`, unchecked, and sizes by formula. Lengths in mm, angles in degrees.

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
    def reference_centre_distance(self) -> float:
        """Reference centre distance a_d = (d_1 + d_2)/2."""
        return (self.pinion.reference_diameter + self.wheel.reference_diameter) / 2

    @property
    def profile_shift_sum(self) -> float:
        """Sum of profile shift coefficients x_1 + x_2."""
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
        """Arguments about both gears for the formulas of profile shift and centre distance."""
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
        """Return the one at which these gears would mesh without backlash if x_1 + x_2 were `shift_sum` (no thinning)."""
        return zero_backlash_centre_distance(**self._sizes, shift_sum=shift_sum)

    @property
    def working_pitch_diameters(self) -> PerGear[float]:
        """Working pitch diameters d_w1 = 2 a/(1 + u) and d_w2 = u d_w1."""
        pinion = 2 * self.centre_distance / (1 + self.gear_ratio)
        return PerGear(pinion, self.gear_ratio * pinion)

    @property
    def tip_alteration(self) -> float:
        """k that keeps the rack's tip clearance: (a - a_d)/m_n - (x_1 + x_2), never positive ("auto" in a spec).

        With a ring that is never negative where flanks do not overlap, so there is nothing to shorten.
        """
        if self.internal:
            return 0.0
        apart = self.centre_distance - self.reference_centre_distance
        change = clearance_alteration(apart, self.pinion.normal_module, self.profile_shift_sum)
        return min(settled(change, self._modules), 0.0)

    @property
    def tip_clearances(self) -> PerGear[float]:
        """Clearance of each gear's tip in the mate's root."""
        return PerGear(
            self.centre_distance - (self.pinion.tip_diameter + self.wheel.root_diameter) / 2,
            self.centre_distance - (self.wheel.tip_diameter + self.pinion.root_diameter) / 2,
        )

    @property
    def circumferential_backlash(self) -> float:
        """Circumferential backlash j_wt: working pitch less both tooth thicknesses on the working pitch circles."""
        return self._nominal_backlash.circumferential

    @property
    def normal_backlash(self) -> float:
        """Normal backlash j_bn along the base normal: j_wt cos alpha_wt cos beta_b."""
        return self._nominal_backlash.normal

    @cached_property
    def _nominal_backlash(self) -> Backlash[float]:
        return Backlash(*(settled(each, self.centre_distance) for each in self._backlash()))

    def _backlash(self, thicker: float = 0.0, farther: float = 0.0) -> Backlash[float]:
        """Return the backlash with teeth `thicker` by a share of half their tolerances, and with axes `farther` apart (mm)."""

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
