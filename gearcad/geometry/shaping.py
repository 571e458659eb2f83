"""Can this shaper cutter, or no cutter at all, make these teeth?

Raises GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from dataclasses import fields, replace

from gearcad.errors import GeometryError
from gearcad.geometry.body import LEAST_FEATURE
from gearcad.geometry.derived import is_given
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.involute import inverse_involute, involute, tangent_length
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.tooling import corner_radius, full_corner_radius, generating_involute, line_of_generation, shaper_tip

__all__ = ["check_shaper", "cutter_fits", "tip_words"]

_MOST_CUTTER_TEETH = 2000
"""Of those that are tried, to say which would do."""


def check_shaper(gear: GearData) -> None:
    """The cutter must fit inside its ring, roll on it, reach its root, and generate its flanks up to the tips."""
    teeth, cutter = gear.cutter.teeth, gear.cutter
    if gear.internal and teeth is not None and teeth >= gear.tooth_count:
        permitted = f"must be at most {gear.tooth_count - 1}: the cutter works inside a ring of {gear.tooth_count} teeth"
        raise GeometryError("cutter.teeth", teeth, permitted)
    if teeth is not None:
        _check_shift(gear, teeth)
    full, least = full_corner_radius(gear), _least_radius(gear)
    if full < least:
        raise _cannot_reach(gear)
    if cutter.tip_radius is not None and cutter.tip_radius > full:
        permitted = f"must be at most {at_most(full, 4)} (full radius) {_terms(gear)}"
        raise GeometryError("cutter.tip_radius", cutter.tip_radius, permitted)
    if 0 < (radius := corner_radius(gear)) < least:
        permitted = f"must be 0 or at least {at_least(least)} ({LEAST_FEATURE} mm): it is the fillet of a form root"
        raise GeometryError("cutter.tip_radius", radius, permitted)
    if teeth is not None:
        _check_generated(gear, teeth)


def cutter_fits(gear: GearData) -> bool:
    """Whether its cutter, or none, can make these teeth."""
    try:
        check_shaper(gear)
    except GeometryError:
        return False
    return True


def _least_radius(gear: GearData) -> float:
    """Least radius of the corner in normal modules that leaves something to see of a form root's fillet."""
    return 0.0 if gear.cutter.teeth else LEAST_FEATURE / gear.normal_module


def _terms(gear: GearData) -> str:
    """What the corner's room depends on."""
    teeth = gear.cutter.teeth
    return "for a space of that depth" if teeth is None else f"for a cutter of {teeth} teeth that reaches the root circle"


def _check_shift(gear: GearData, teeth: int) -> None:
    """The cutter has teeth, and meshes at some centre distance."""
    tangent = math.tan(math.radians(gear.rack.pressure_angle))
    least = -(math.pi / 2 + gear.tooth_thinning / gear.normal_module) / (2 * tangent)
    limit = -gear.profile_shift - involute(gear.transverse_pressure_angle) * (gear.teeth + teeth) / (2 * tangent)
    if gear.cutter.profile_shift <= least:
        permitted = f"must be above {at_least(least)}: no tooth of the cutter on its reference circle"
    elif generating_involute(gear, teeth) <= 0:
        side = f"below {at_most(limit)}" if gear.internal else f"above {at_least(limit)}"
        permitted = f"must be {side}: the cutter meshes with these teeth at no centre distance"
    else:
        return
    raise GeometryError("cutter.profile_shift", gear.cutter.profile_shift, permitted)


def _cannot_reach(gear: GearData) -> GeometryError:
    """The fault of a root circle at which the cutter has no tip: inside its base circle, or beyond where its flanks meet."""
    tip = shaper_tip(gear, 0.0)
    owner = "the flanks of the space" if gear.cutter.teeth is None else "the cutter's flanks"
    if shallow := tip.tip_radius <= tip.base_radius:
        radius, why = tip.base_radius, f"where {owner} begin"
    else:
        angle = math.radians(inverse_involute(max(tip.base_half_angle, 0.0)))
        # The corner of least radius needs some flat between the flanks.
        flat = 1.1 * _least_radius(gear) * gear.normal_module * (1 - math.sin(angle)) / max(math.sin(angle), 1e-3)
        radius, why = tip.base_radius / math.cos(angle) - flat, f"where {owner} meet"
    limit = -2 * (tip.centre_distance + radius) if gear.internal else 2 * (tip.centre_distance - radius)
    if is_given(gear.root_diameter):
        side = f"below {at_most(limit)}" if shallow else f"at least {at_least(limit)}"
        return GeometryError("root_diameter", gear.root_diameter, f"must be {side} mm, {why}", "mm")
    dedendum = (gear.reference_diameter - limit) / (2 * gear.normal_module) + gear.profile_shift
    if dedendum <= 0:
        return GeometryError("profile_shift", gear.profile_shift, f"must be smaller: no dedendum of the rack is left, {why}")
    side = f"above {at_least(dedendum)}" if shallow else f"at most {at_most(dedendum)}"
    return GeometryError("rack.dedendum", gear.rack.dedendum, f"must be {side}, {why}")


# ---------------------------------------------------------------------- up to the tips


def tip_words(gear: GearData, limit: float, side: str) -> str:
    """The addendum of the rack that has its tip on a circle (mm, signed), where the tip follows from it."""
    addendum = (limit - gear.reference_diameter) / (2 * gear.normal_module) - gear.profile_shift - gear.tip_alteration
    return "" if is_given(gear.tip_diameter) or addendum <= 0 else f" (rack.addendum {side} {at_most(addendum)})"


def _check_generated(gear: GearData, teeth: int) -> None:
    """The cutter's involute begins on its base circle: it touches no flank beyond the end of the line of action there."""
    if _generates(gear, teeth):
        return
    side = -1 if gear.internal else 1
    limit = side * 2 * math.hypot(gear.base_diameter / 2, line_of_generation(gear, teeth)) + 2 * gear.body.tip_chamfer
    others = range(teeth + 1, gear.tooth_count if gear.internal else _MOST_CUTTER_TEETH + 1)
    more = next((other for other in others if _generates(gear, other) and cutter_fits(_cut_by(gear, other))), None)
    hint = "" if more is None else f"; or cutter.teeth at least {more}"
    words = f"must be at most {at_most(limit)} mm{tip_words(gear, limit, 'at most')}"
    why = "the cutter's involute begins on its base circle and generates no flank beyond that"
    raise GeometryError("tip_diameter", gear.tip_diameter, f"{words}: {why}{hint}", "mm")


def _cut_by(gear: GearData, teeth: int) -> GearData:
    """The gear, unchecked, with another number of teeth of its cutter."""
    given = {each.name: getattr(gear, each.name) for each in fields(GearData)}
    return GearData(**given | {"cutter": replace(gear.cutter, teeth=teeth)})


def _generates(gear: GearData, teeth: int) -> bool:
    """Whether a cutter of so many teeth generates the flanks up to the tip form circle."""
    if generating_involute(gear, teeth) <= 0:
        return False
    length = abs(tangent_length(gear.tip_diameter - 2 * gear.body.tip_chamfer, gear.base_diameter))
    line = line_of_generation(gear, teeth)
    return length >= line if gear.internal else length <= line
