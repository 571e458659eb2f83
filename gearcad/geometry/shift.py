"""The reverse question: which profile shifts give a wanted centre distance, and how to split them between the gears.

On plain numbers, signed as in ISO 21771: teeth of an internal gear, its radii and the centre distance of its pair are negative.
"""

from __future__ import annotations

import math
from enum import Enum

from gearcad.errors import GeometryError, as_choice
from gearcad.geometry.bracketed import root_between
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.limits import at_least, at_most
from gearcad.per_gear import PerGear, Role

__all__ = [
    "ShiftSplit",
    "profile_shift_sum",
    "shift_sum_limit",
    "specific_sliding",
    "split_profile_shift",
    "zero_backlash_centre_distance",
]


_FULL = PerGear(1.0, 1.0)
"""Addenda of ISO 53."""


class ShiftSplit(Enum):
    """How a shift sum is shared: equal shifts, all of it on the pinion, or equal specific sliding at both roots."""

    EQUAL = "equal"
    PINION = "pinion"
    EQUAL_SPECIFIC_SLIDING = "equal_specific_sliding"


def _transverse(normal_module: float, teeth: int, helix_angle: float, pressure_angle: float) -> tuple[float, float, float]:
    """Reference radius (mm), base radius (mm) and transverse pressure angle (deg)."""
    cosine = math.cos(math.radians(helix_angle))
    angle = math.atan(math.tan(math.radians(pressure_angle)) / cosine)
    radius = normal_module * teeth / cosine / 2
    return radius, radius * math.cos(angle), math.degrees(angle)


def profile_shift_sum(
    *, normal_module: float, teeth: PerGear[int], helix_angle: float, pressure_angle: float, centre_distance: float
) -> float:
    """x_1 + x_2 that meshes without backlash at `centre_distance` (mm); angles in degrees (ISO 21771).

    (z_1 + z_2)(inv alpha_wt - inv alpha_t)/(2 tan alpha_n). Raises GeometryError where the base circles would overlap.
    """
    _, base, angle = _transverse(normal_module, sum(teeth), helix_angle, pressure_angle)
    if abs(centre_distance) <= abs(base):
        permitted = f"must be {_beyond(base, teeth)} mm, where the base circles touch"
        raise GeometryError("centre_distance", centre_distance, permitted, "mm")
    working = math.degrees(math.acos(base / centre_distance))
    return sum(teeth) * (involute(working) - involute(angle)) / (2 * math.tan(math.radians(pressure_angle)))


def zero_backlash_centre_distance(
    *, normal_module: float, teeth: PerGear[int], helix_angle: float, pressure_angle: float, shift_sum: float
) -> float:
    """Centre distance (mm) at which teeth with this shift sum mesh without backlash; angles in degrees (ISO 21771).

    a = a_d cos alpha_t/cos alpha_wt with inv alpha_wt = inv alpha_t + 2 tan alpha_n (x_1 + x_2)/(z_1 + z_2). Raises
    GeometryError for a sum so far off that there is none.
    """
    base = _transverse(normal_module, sum(teeth), helix_angle, pressure_angle)[1]
    limit = shift_sum_limit(teeth=teeth, helix_angle=helix_angle, pressure_angle=pressure_angle)
    value = 2 * math.tan(math.radians(pressure_angle)) * (shift_sum - limit) / sum(teeth)
    if value <= 0:
        permitted = f"must be {_beyond(limit, teeth)}: no centre distance meshes without backlash"
        raise GeometryError("profile_shift_sum", shift_sum, permitted)
    return base / math.cos(math.radians(inverse_involute(value)))


def shift_sum_limit(*, teeth: PerGear[int], helix_angle: float, pressure_angle: float) -> float:
    """x_1 + x_2 at which inv alpha_wt is 0 and the base circles touch: the least that meshes, or with a ring the most."""
    _, _, angle = _transverse(1.0, sum(teeth), helix_angle, pressure_angle)
    return -sum(teeth) * involute(angle) / (2 * math.tan(math.radians(pressure_angle)))


def _beyond(limit: float, teeth: PerGear[int]) -> str:
    """On the side of a limit where external teeth mesh, or the other one for internal teeth."""
    return f"above {at_least(limit)}" if sum(teeth) > 0 else f"below {at_most(limit)}"


def specific_sliding(
    *, teeth: PerGear[int], base_radii: PerGear[float], tip_radii: PerGear[float], centre_distance: float
) -> PerGear[float]:
    """Largest specific sliding at the roots of pinion (in A) and wheel (in E); radii and distance in mm.

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

    references, bases, _ = zip(*(_transverse(normal_module, z, helix_angle, pressure_angle) for z in teeth), strict=True)

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
