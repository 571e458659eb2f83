"""A gear tooth caliper: the chord of a tooth at a depth below its tip, in the normal section, on plain numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

from gearcad.errors import GeometryError, require_number
from gearcad.geometry.bracketed import root_between
from gearcad.geometry.inspection import Inspection

__all__ = ["Chord", "chord_below_tip"]


class Chord(NamedTuple):
    """What a tooth caliper reads, and the diameter on which it touches the flanks (mm)."""

    thickness: float
    diameter: float


def chord_below_tip(teeth: Inspection, addendum: float, height: float) -> Chord:
    """The chord of a tooth of an external gear at a height below its tip circle, `addendum` over the reference circle (mm).

    Taken on the virtual gear of z_v = z/cos^3 beta teeth, as the chordal thickness is: there d_y = d_b/cos alpha_y,
    psi_y = psi + inv alpha_n - inv alpha_y, s = d_y sin psi_y and h = r_a - d_y cos(psi_y)/2. Raises GeometryError for a height
    at which there is no involute.
    """
    require_number("height", height, "mm", above=0)
    if teeth.teeth < 0:
        raise GeometryError("teeth", teeth.teeth, "must be above 0: no tooth caliper goes into a ring")
    virtual = teeth.teeth / math.cos(math.radians(teeth.helix_angle)) ** 3
    reference, angle = virtual * teeth.normal_module, math.radians(teeth.pressure_angle)
    at_base = teeth.normal_tooth_thickness / reference + math.tan(angle) - angle
    base, tip = reference * math.cos(angle), reference / 2 + addendum

    def place(here: float) -> tuple[float, float]:
        """Diameter and half tooth angle (rad) where the pressure angle is `here` (rad)."""
        return base / math.cos(here), at_base - math.tan(here) + here

    def too_deep(here: float) -> float:
        diameter, half = place(here)
        return tip - diameter * math.cos(half) / 2 - height

    highest = math.acos(min(base / (2 * tip), 1.0))
    if not too_deep(0.0) > 0 > too_deep(highest):
        least, most = too_deep(highest) + height, too_deep(0.0) + height
        permitted = f"must be between {max(least, 0.0):.4g} and {max(most, 0.0):.4g} mm, where the involute is"
        raise GeometryError("height", height, permitted, "mm")
    diameter, half = place(root_between(too_deep, 0.0, highest))
    wider = teeth.teeth * teeth.normal_module / math.cos(math.radians(teeth.helix_angle)) - reference
    return Chord(diameter * math.sin(half), diameter + wider)
