"""What pairs must meet before they are rated: each condition by itself, of many pairs at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.task import SizeTask

__all__ = ["LIMITS", "shift_sums_within", "width_within"]

ROUNDING = 1e-9
"""Of lengths, in normal modules, and of ratios."""

SHIFT_SUMS = (-0.5, 2.0)
"""x_1 + x_2 that takes up a centre distance that is given: what q' of ISO 6336-1 is stated for."""

_NEAR = 0.15
"""How far x_1 + x_2 may be beyond those wanted, for round centre distances."""


def shift_sums_within(task: SizeTask) -> tuple[float, float]:
    """The least and the most x_1 + x_2 where no centre distance is given."""
    return task.shift_sums[0] - _NEAR, task.shift_sums[-1] + _NEAR


def _centre_distance(pairs: ManyPairs, task: SizeTask) -> Bools:
    """Where profile shift takes up the centre distance."""
    total = pairs.shifts.pinion + pairs.shifts.wheel
    least, most = SHIFT_SUMS if task.centre_distance is not None else shift_sums_within(task)
    result: Bools = (total >= least) & (total <= most)  # false of nan
    return result


def _diameter(pairs: ManyPairs, task: SizeTask) -> Bools:
    if task.max_diameter is None:
        return np.ones(len(pairs.key), bool)
    result: Bools = np.maximum(*pairs.tip_diameters) <= task.max_diameter * (1 + ROUNDING)
    return result


def _whole_involutes(pairs: ManyPairs, _task: SizeTask) -> Bools:
    result: Bools = np.minimum(*pairs.form_reach) >= -ROUNDING * pairs.normal_module
    return result


def _thick_tips(pairs: ManyPairs, task: SizeTask) -> Bools:
    parts = zip(pairs.tip_thicknesses, task.tip_thicknesses, strict=True)
    first, second = (thickness >= (least - ROUNDING) * pairs.normal_module for thickness, least in parts)
    return first & second


def _contact_ratio(pairs: ManyPairs, task: SizeTask) -> Bools:
    result: Bools = (pairs.contact_ratio >= task.least_contact_ratio - ROUNDING) & (pairs.contact_ratio < 3)
    return result


def _no_interference(pairs: ManyPairs, _task: SizeTask) -> Bools:
    """Tips meet the involutes of their mates, none below the root form circle."""
    parts = zip(pairs.lowest_contact, pairs.form_reach, strict=True)
    first, second = (low >= form - ROUNDING * pairs.normal_module for low, form in parts)
    return first & second


LIMITS: dict[str, Callable[[ManyPairs, SizeTask], Bools]] = {
    "centre distance": _centre_distance,
    "diameter": _diameter,
    "undercut": _whole_involutes,
    "tip thickness": _thick_tips,
    "contact ratio": _contact_ratio,
    "interference": _no_interference,
}
"""Words of each condition, and where it is met: in this order, each of the pairs that met all before."""


def width_within(width: Floats, pairs: ManyPairs, task: SizeTask) -> Bools:
    """Where a face width is not too much for the module."""
    result: Bools = width <= (task.max_width_in_modules + ROUNDING) * pairs.normal_module
    return result
