"""What holds the bore of a gear body: a rigid hub, a shaft that gives way, a key, or nothing but shear."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

from gearcad.errors import GeometryError, ParameterError, format_number
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.rating.rim import RIM_LIMIT

__all__ = ["Hold", "Support", "rim_ratio", "support_of"]


_SAME = 1e-9
"""mm: radii that do not differ."""

_THINNEST_SHAFT = 0.98
"""Greatest bore of a shaft, over its diameter."""


class Hold(Enum):
    """What holds the bore of a gear."""

    AUTO = "auto"
    """Rigid where the rim is thick; else free, or by the key if there is a keyway."""

    RIGID = "rigid"
    """Held all round, as by a stiff shaft in a tight fit."""

    SHAFT = "shaft"
    """Bonded to a shaft or hub ring that gives way, whose section the torque enters like St Venant's shear, as r."""

    KEY = "key"
    """Free, but the torque comes from a keyway: stresses are those with the key where it is worst."""

    FREE = "free"
    """Shear all round, as from splines or a thin web, gives torque and force; nothing keeps the bore round."""


@dataclass(frozen=True)
class Support:
    """What holds the bore of a body of `teeth` sectors (not AUTO).

    `shaft` is the shaft's material and `shaft_bore` (mm) its own bore; `key` the half width (rad) of the keyway, seen from the
    axis.
    """

    hold: Hold = Hold.RIGID
    teeth: int = 1
    shaft: Material = field(default_factory=Material)
    shaft_bore: float = 0.0
    key: float = 0.0

    @property
    def floats(self) -> bool:
        """True if the hub follows the bore in the mean, and so is moved by forces as well as by the torque; else it turns."""
        return self.hold is not Hold.RIGID

    @property
    def words(self) -> str:
        """How the body is held, before "diameter ..." in a sentence."""
        return _WORDS[self.hold]

    @property
    def bends(self) -> bool:
        """True if nothing keeps the bore round, so that the whole rim is stressed, not only near the loaded teeth."""
        return self.hold in (Hold.KEY, Hold.FREE)


_WORDS = {
    Hold.RIGID: "held on",
    Hold.SHAFT: "bonded to an elastic shaft on",
    Hold.KEY: "free, but for shear and a key, on",
    Hold.FREE: "free, but for shear, on",
}


def rim_ratio(gear: Gear, held_radius: float) -> float:
    """s_R/h_t: the rim from the root circle down to a radius (mm), or to the keyway if that is the bore, over tooth depth."""
    if gear.internal:
        profile = gear.profile
        return (held_radius - profile.root_diameter / 2) / ((profile.root_diameter - profile.tip_diameter) / 2)
    opening = gear.body.opening_diameter / 2 if abs(held_radius - gear.body.bore / 2) < _SAME else held_radius
    return (gear.root_diameter / 2 - opening) / ((gear.tip_diameter - gear.root_diameter) / 2)


def _support_of_ring(gear: Gear, hold: Hold) -> Support:
    if hold not in (Hold.AUTO, Hold.RIGID):
        raise ParameterError(
            "support", hold.value, f'must be "{Hold.RIGID.value}" for a ring: its rim sits in a housing, it has no bore'
        )
    return Support(Hold.RIGID, gear.tooth_count)


def support_of(
    gear: Gear, held_radius: float, hold: Hold = Hold.AUTO, shaft: Material | None = None, shaft_bore: float = 0.0
) -> Support:
    """What holds a gear at `held_radius` (mm). Raises GeometryError if there is no keyway, or no room for the shaft's bore."""
    if gear.internal:
        return _support_of_ring(gear, hold)
    if hold is Hold.AUTO:
        thin = Hold.KEY if gear.body.keyway_width else Hold.FREE
        hold = Hold.RIGID if rim_ratio(gear, held_radius) >= RIM_LIMIT else thin
    if hold is Hold.KEY and not gear.body.keyway_width:
        raise GeometryError("body.keyway_width", 0.0, "must be given where the key holds the bore", "mm")
    if hold is Hold.SHAFT and shaft_bore > _THINNEST_SHAFT * 2 * held_radius:
        most = format_number(_THINNEST_SHAFT * 2 * held_radius)
        raise GeometryError("shaft_bore", shaft_bore, f"must be at most {most} mm ({_THINNEST_SHAFT} of the gear's bore)", "mm")
    key = math.asin(min(1.0, gear.body.keyway_width / 2 / held_radius))
    return Support(hold, gear.teeth, shaft or Material(), shaft_bore, key)
