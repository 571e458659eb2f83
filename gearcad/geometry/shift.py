"""The reverse question: which profile shifts give a wanted centre distance, and how to split them between the gears."""

from __future__ import annotations

import math
from enum import Enum

from gearcad.errors import GeometryError, as_choice
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.limits import at_least

__all__ = [
    "ShiftSplit",
    "least_profile_shift_sum",
    "profile_shift_sum",
    "specific_sliding",
    "split_profile_shift",
    "zero_backlash_centre_distance",
]


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
    *, normal_module: float, teeth: tuple[int, int], helix_angle: float, pressure_angle: float, centre_distance: float
) -> float:
    """x_1 + x_2 that meshes without backlash at `centre_distance` (mm); angles in degrees (ISO 21771).

    (z_1 + z_2)(inv alpha_wt - inv alpha_t)/(2 tan alpha_n). Raises GeometryError where the base circles would overlap.
    """
    _, base, angle = _transverse(normal_module, sum(teeth), helix_angle, pressure_angle)
    if centre_distance <= base:
        raise GeometryError(
            "centre_distance", centre_distance, f"must be above {at_least(base)} mm, where the base circles touch", "mm"
        )
    working = math.degrees(math.acos(base / centre_distance))
    return sum(teeth) * (involute(working) - involute(angle)) / (2 * math.tan(math.radians(pressure_angle)))


def zero_backlash_centre_distance(
    *, normal_module: float, teeth: tuple[int, int], helix_angle: float, pressure_angle: float, shift_sum: float
) -> float:
    """Centre distance (mm) at which teeth with this shift sum mesh without backlash; angles in degrees (ISO 21771).

    a = a_d cos alpha_t/cos alpha_wt with inv alpha_wt = inv alpha_t + 2 tan alpha_n (x_1 + x_2)/(z_1 + z_2). Raises
    GeometryError for a sum so negative that there is none.
    """
    base = _transverse(normal_module, sum(teeth), helix_angle, pressure_angle)[1]
    least = least_profile_shift_sum(teeth=teeth, helix_angle=helix_angle, pressure_angle=pressure_angle)
    if shift_sum <= least:
        permitted = f"must be above {at_least(least)}: no centre distance meshes without backlash"
        raise GeometryError("profile_shift_sum", shift_sum, permitted)
    value = 2 * math.tan(math.radians(pressure_angle)) * (shift_sum - least) / sum(teeth)
    return base / math.cos(math.radians(inverse_involute(value)))


def least_profile_shift_sum(*, teeth: tuple[int, int], helix_angle: float, pressure_angle: float) -> float:
    """x_1 + x_2 at which inv alpha_wt is 0 and the base circles touch: the lower bound of all shift sums that mesh."""
    _, _, angle = _transverse(1.0, sum(teeth), helix_angle, pressure_angle)
    return -sum(teeth) * involute(angle) / (2 * math.tan(math.radians(pressure_angle)))


def specific_sliding(
    *, teeth: tuple[int, int], base_radii: tuple[float, float], tip_radii: tuple[float, float], centre_distance: float
) -> tuple[float, float]:
    """Largest specific sliding at the roots of pinion (in A) and wheel (in E), both negative; radii and distance in mm.

    zeta = 1 - (z_own/z_mate) (rho_mate/rho_own). Minus infinity where a tip reaches the base tangent point.
    """
    whole = math.sqrt(centre_distance**2 - sum(base_radii) ** 2)
    reach = [math.sqrt(max(tip**2 - base**2, 0.0)) for tip, base in zip(tip_radii, base_radii, strict=True)]

    def sliding(own: int, mate: int) -> float:
        rest = whole - reach[mate]
        return 1 - teeth[own] / teeth[mate] * reach[mate] / rest if rest > 0 else -math.inf

    return sliding(0, 1), sliding(1, 0)


def split_profile_shift(
    total: float,
    split: ShiftSplit,
    *,
    normal_module: float,
    teeth: tuple[int, int],
    helix_angle: float,
    pressure_angle: float,
    centre_distance: float,
    addenda: tuple[float, float] = (1.0, 1.0),
    tip_alteration: float = 0.0,
) -> tuple[float, float]:
    """Shifts (x_1, x_2) that add up to `total`, shared by the rule `split`.

    `addenda` h_aP* of both racks and `tip_alteration` k (normal modules) fix the tips for equal specific sliding.
    Raises GeometryError where no split balances the sliding.
    """
    split = as_choice("split", split, ShiftSplit)
    if split is ShiftSplit.EQUAL:
        return total / 2, total / 2
    if split is ShiftSplit.PINION:
        return total, 0.0
    from scipy.optimize import brentq

    sizes = [_transverse(normal_module, z, helix_angle, pressure_angle) for z in teeth]
    base = (sizes[0][1], sizes[1][1])

    def imbalance(first: float) -> float:
        shifts = (first, total - first)
        tips = [
            size[0] + normal_module * (addendum + x + tip_alteration)
            for size, addendum, x in zip(sizes, addenda, shifts, strict=True)
        ]
        pinion, wheel = specific_sliding(
            teeth=teeth, base_radii=base, tip_radii=(tips[0], tips[1]), centre_distance=centre_distance
        )
        return math.atan(pinion) - math.atan(wheel)

    low, high = total / 2 - 2.5, total / 2 + 2.5
    if imbalance(low) >= 0 or imbalance(high) <= 0:
        raise GeometryError("profile_shift", "auto", "no split gives equal specific sliding: choose the shifts yourself")
    first = float(brentq(imbalance, low, high, xtol=1e-14))
    return first, total - first
