"""Teeth in the bore of a gear that is a splined hub: their outline as a gear, and what bores are without them.

Lengths in mm. What needs the diameter of a bore alone takes the number of `Body.bore`, which is that of the root circle.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_data import GearData


def bore_teeth(gear: GearData) -> Gear | None:
    """Return the teeth in the bore of a gear as a gear: internal, straight, as long as the bore (mm); None of a round bore.

    They begin where the bore does, below z = 0 by the hub there. Their tolerances are those of an engagement over this length.
    Raises InputError where the teeth cannot be made.
    """
    designation = gear.body.bore_spline
    return None if designation is None else _hub_teeth(designation, gear.face_width + sum(gear.body.hub_ends))


@lru_cache(maxsize=64)
def _hub_teeth(designation: str, length: float) -> Gear:
    from gearcad.geometry.spline import SplineJoint  # only here: a spline costs those who have one
    from gearcad.geometry.spline_standards import HUB

    return SplineJoint(designation=designation, length=length).parts[HUB].gear


def free_bore(gear: Gear) -> float:
    """Return the diameter (mm) of the largest cylinder that a bore takes: a splined one by its tips; 0 without a bore."""
    teeth = bore_teeth(gear)
    return gear.body.bore if teeth is None else abs(teeth.tip_diameter)


def with_round_bore(gear: Gear) -> Gear:
    """Return the gear with a round bore of the diameter of the root circle in place of a splined bore."""
    if gear.body.bore_spline is None:
        return gear
    return replace(gear, body=replace(gear.body, bore=float(gear.body.bore)))
