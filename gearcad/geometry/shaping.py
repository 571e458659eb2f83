"""Can this shaper cutter, or no cutter at all, make these teeth?

Raises GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

from gearcad.errors import GeometryError
from gearcad.geometry.body import LEAST_FEATURE
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.tooling import corner_radius, full_corner_radius, generating_involute

__all__ = ["check_shaper"]


def check_shaper(gear: GearData) -> None:
    """The cutter must fit inside its ring, roll on it, and have a tip whose corner fits between its flanks."""
    teeth, cutter = gear.cutter.teeth, gear.cutter
    if gear.internal and teeth is not None and teeth >= gear.tooth_count:
        permitted = f"must be at most {gear.tooth_count - 1}: the cutter works inside a ring of {gear.tooth_count} teeth"
        raise GeometryError("cutter.teeth", teeth, permitted)
    if generating_involute(gear) <= 0:
        permitted = "must be such that the cutter meshes: no centre distance does with these profile shifts"
        raise GeometryError("cutter.profile_shift", cutter.profile_shift, permitted)
    full, least = full_corner_radius(gear), _least_radius(gear)
    if full < least:
        raise GeometryError("cutter.teeth", teeth, "must be others: the cutter's flanks meet before its tip reaches the root")
    if cutter.tip_radius is not None and cutter.tip_radius > full:
        permitted = f"must be at most {at_most(full, 4)} (full radius)"
        raise GeometryError("cutter.tip_radius", cutter.tip_radius, permitted)
    if 0 < (radius := corner_radius(gear)) < least:
        permitted = f"must be 0 or at least {at_least(least)} ({LEAST_FEATURE} mm): it is the fillet of a form root"
        raise GeometryError("cutter.tip_radius", radius, permitted)


def _least_radius(gear: GearData) -> float:
    """Least radius of the corner in normal modules that leaves something to see of a form root's fillet."""
    return 0.0 if gear.cutter.teeth else LEAST_FEATURE / gear.normal_module
